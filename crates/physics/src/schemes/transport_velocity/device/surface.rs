//! The passes of free surfaces, CTVF section 3.4.

use piola_device::{Among, Dialect, Gather, Order, Pass, Space, Traced, local, own, through};
use piola_formulas::Number;
use piola_formulas::pairs::sums::{CrowdingWithin, SurfaceNormal};
use piola_formulas::pairs::{Components, One, PairLaw};

use super::super::surface::CONE;
use super::Plan;
use super::passes::{FORCES, side, side_width};
use super::walls::forces;
use crate::schemes::device::{Recorded as Vector, one, square, take};

impl<const D: usize> Plan<D> {
    /// Passes that look for free surfaces.
    pub(super) fn surface_passes(&self, dialect: Dialect, space: &Space<D>) -> Vec<Pass> {
        match self.seeks_surfaces {
            true => vec![
                self.sharpen(dialect),
                self.see(dialect, space),
                self.normals(dialect, space),
                self.cover(dialect, space),
                self.see_surfaces(dialect, space),
                self.reach(dialect, space),
                self.crowd(dialect, space),
            ],
            false => Vec::new(),
        }
    }

    /// Sharp normals, and who has one.
    fn sharpen(&self, dialect: Dialect) -> Pass {
        let reads = [through("numbers", "wall", 1), own("force", FORCES * D)];
        let writes = [own("sharp", D), own("mark", 1)];
        local(dialect, "sharpen", &[], &reads, &writes, |mut x| {
            let wall = one(&mut x);
            let opening = forces::<D>(&mut x)[7];
            let length = square(&opening).sqrt();
            let least = Traced::from(0.25 / self.smoothing_length);
            let is_marked = least.at_most(length) & wall.below(0.5);
            let if_marked = |yes: Traced| Traced::select(is_marked, yes, Traced::from(0.0));
            let sharp = opening.iter().map(|component| if_marked(*component / length));
            sharp.chain([if_marked(Traced::from(1.0))]).collect()
        })
    }

    /// Who has or sees a sharp normal, or has few neighbours. There is no surface elsewhere.
    fn see(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let mark = [own("mark", 1)];
        let writes = [own("near", 1), own("normal", D), own("surface", 1)];
        Gather::<(One, One), _>::new(dialect, "see", space, Among::Active, Order::Lanes)
            .fold(&[], &mark, Among::All, |meeting, (marks, count)| {
                *marks += meeting.other[0];
                *count += Traced::from(1.0);
            })
            .close(&[], &mark, &writes, |(marks, count), x| {
                let few = (*count * 2.0).below(self.even_count);
                let is_near = x[0].above(0.5) | marks.above(0.5) | few;
                let (yes, no) = (Traced::from(1.0), Traced::from(0.0));
                let near = Traced::select(is_near, yes, no);
                [near].into_iter().chain((0..=D).map(|_| no)).collect()
            })
    }

    /// Smoothed normals, and who is alone.
    fn normals(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let columns = [own("side", side_width(D)), own("sharp", D)];
        type Sums<const D: usize> = (One, Components<D>);
        let law = SurfaceNormal::<D>;
        let centre = self.kernel.value(D, 0.0, self.smoothing_length);
        let writes = [own("normal", D), own("alone", 1)];
        Gather::<Sums<D>, _>::new(dialect, "normals", space, Among::Active, Order::Single)
            .only("near")
            .start(&columns, |mut x| {
                let me = side::<D>(&mut x);
                let sharp: Vector<D> = take(&mut x);
                (me.mass() * centre, sharp * (me.volume * centre))
            })
            .fold(&columns, &columns, Among::All, |meeting, sums| {
                let of = |mut x: &[Traced]| {
                    let side = side::<D>(&mut x);
                    ((side, Traced::from(1.0)), take::<D>(&mut x))
                };
                law.add(&of(meeting.me), &of(meeting.other), &meeting.pair, sums);
            })
            .close(&[], &[], &writes, |(density, normal), _| {
                let (yes, no) = (Traced::from(1.0), Traced::from(0.0));
                let square = square(normal);
                let length = square.sqrt();
                let unit = |component: &Traced| {
                    Traced::select(square.above(0.0), *component / length, *component)
                };
                let alone = Traced::select(density.below(0.5 * self.fluid.density), yes, no);
                normal.iter().map(unit).chain([alone]).collect()
            })
    }

    /// Who is on a surface: nobody is in front of it, or it is alone.
    fn cover(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let mine = [own("normal", D)];
        let columns = [own("normal", D), own("alone", 1)];
        let writes = [own("surface", 1)];
        Gather::<One, _>::new(dialect, "cover", space, Among::Active, Order::Lanes)
            .only("near")
            .fold(&mine, &[], Among::All, |meeting, covering| {
                let normal = Vector::<D>::from_column_slice(meeting.me);
                let ahead = -meeting.pair.separation.dot(&normal);
                let distance = meeting.pair.square.sqrt();
                let is_in_cone = (Traced::from(CONE) * distance).less(ahead);
                *covering += Traced::select(is_in_cone, Traced::from(1.0), Traced::from(0.0));
            })
            .close(&[], &columns, &writes, |covering, mut x| {
                let normal: Vector<D> = take(&mut x);
                let alone = one(&mut x);
                let is_free = square(&normal).above(0.0) & covering.below(0.5);
                vec![Traced::select(is_free, Traced::from(1.0), alone)]
            })
    }

    /// Who sees a surface and is not on it, and how far surfaces are for all others.
    fn see_surfaces(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let surface = [own("surface", 1)];
        let writes = [own("close_by", 1), own("reach", 1)];
        Gather::<One, _>::new(dialect, "see_surfaces", space, Among::Active, Order::Lanes)
            .fold(&[], &surface, Among::Active, |meeting, seen| *seen += meeting.other[0])
            .close(&[], &surface, &writes, |seen, x| {
                let (yes, no) = (Traced::from(1.0), Traced::from(0.0));
                let is_free = x[0].above(0.5);
                let sees = seen.above(0.5) & x[0].below(0.5);
                let h = Traced::from(self.smoothing_length);
                vec![Traced::select(sees, yes, no), Traced::select(is_free, no, h)]
            })
    }

    /// How far the nearest surface is, `h_b` of CTVF algorithm 1.
    fn reach(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let surface = [own("surface", 1)];
        Gather::<One, _>::new(dialect, "reach_surfaces", space, Among::Active, Order::Fold)
            .only("close_by")
            .start(&[], |_| Traced::from(f64::INFINITY))
            .fold(&[], &surface, Among::Active, |meeting, nearest| {
                let square = meeting.pair.square;
                let is_nearer = meeting.other[0].above(0.5) & square.less(*nearest);
                *nearest = Traced::select(is_nearer, square, *nearest);
            })
            .close(&[], &[], &[own("reach", 1)], |nearest, _| {
                let h = Traced::from(self.smoothing_length);
                let reach = nearest.sqrt() / Traced::from(self.kernel.support_over_h());
                vec![Traced::select(reach.less(h), reach, h)]
            })
    }

    /// The sum of CTVF (35) with a support that ends at the surface.
    fn crowd(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let (mine, others) = ([own("reach", 1)], [own("side", side_width(D))]);
        let law = CrowdingWithin::<D> {
            kernel: self.kernel,
            smoothing_length: self.smoothing_length,
            crowding: self.force_constants.crowding,
        };
        Gather::<Components<D>, _>::new(dialect, "crowd", space, Among::Active, Order::Single)
            .only("close_by")
            .fold(&mine, &others, Among::All, |meeting, sum| {
                let mut other = meeting.other;
                let (yes, no) = (Traced::from(1.0), Traced::from(0.0));
                let volume = side::<D>(&mut other).volume;
                law.add(&((no, no), meeting.me[0]), &((volume, yes), no), &meeting.pair, sum);
            })
            .close(&[], &[], &[own("crowd", D)], |sum, _| sum.iter().copied().collect())
    }
}
