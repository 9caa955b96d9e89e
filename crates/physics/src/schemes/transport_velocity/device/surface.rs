//! The passes of free surfaces, CTVF section 3.4.

use piola_device::{Among, Dialect, Gather, Order, Pass, Space, Traced, Use, local, own, through};
use piola_formulas::Number;
use piola_formulas::pairs::sums::{CrowdingWithin, SurfaceNormal};
use piola_formulas::pairs::{Components, One, PairLaw};

use super::super::surface::CONE;
use super::passes::{FORCES, Plan, side, side_width};
use super::walls::forces;
use crate::schemes::device::{Recorded as Vector, one, square, take};

/// The reach where no surface is within the support. It is compared with the smoothing length, which rounds down as often as
/// not in a column of single precision.
const FAR: f64 = f64::INFINITY;

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
        let (mark, continua) = ([own("mark", 1)], self.of_continua());
        let others = [&mark, &*continua].concat();
        let writes = [own("near", 1), own("normal", D), own("surface", 1)];
        Gather::<(One, One), _>::new(dialect, "see", space, Among::Active, Order::Lanes)
            .fold(&continua, &others, Among::All, |meeting, (marks, count)| {
                let (mut me, mut other) = (meeting.me, meeting.other);
                let mark = one(&mut other);
                let own = self.owned(space, &mut me, &mut other);
                *marks += mark * own;
                *count += own;
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
        let seen = [&columns, &*self.of_continua()].concat();
        let rest: Vec<Use> = self.of_rest().into_iter().collect();
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
            .fold(&seen, &seen, Among::All, |meeting, sums| {
                let (mut me, mut other) = (meeting.me, meeting.other);
                let both = [&mut me, &mut other].map(|x| (side::<D>(x), take::<D>(x)));
                let own = self.owned(space, &mut me, &mut other);
                let [me, other] = both.map(|(side, sharp)| ((side, own), sharp));
                law.add(&me, &other, &meeting.pair, sums);
            })
            .close(&[], &rest, &writes, |(density, normal), mut x| {
                let (yes, no) = (Traced::from(1.0), Traced::from(0.0));
                let square = square(normal);
                let length = square.sqrt();
                let unit = |component: &Traced| {
                    Traced::select(square.above(0.0), *component / length, *component)
                };
                let [at_rest, _] = self.rest(&mut x);
                let alone = Traced::select(density.less(at_rest * 0.5), yes, no);
                normal.iter().map(unit).chain([alone]).collect()
            })
    }

    /// Who is on a surface: nobody is in front of it, or it is alone.
    fn cover(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let continua = self.of_continua();
        let mine = [&[own("normal", D)], &*continua].concat();
        let columns = [own("normal", D), own("alone", 1)];
        let writes = [own("surface", 1)];
        Gather::<One, _>::new(dialect, "cover", space, Among::Active, Order::Lanes)
            .only("near")
            .fold(&mine, &continua, Among::All, |meeting, covering| {
                let (mut me, mut other) = (meeting.me, meeting.other);
                let normal: Vector<D> = take(&mut me);
                let own = self.owned(space, &mut me, &mut other);
                let ahead = -meeting.pair.separation.dot(&normal);
                let distance = meeting.pair.square.sqrt();
                let is_in_cone = (Traced::from(CONE) * distance).less(ahead);
                *covering += Traced::select(is_in_cone, own, Traced::from(0.0));
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
        let (surface, continua) = ([own("surface", 1)], self.of_continua());
        let others = [&surface, &*continua].concat();
        let writes = [own("close_by", 1), own("reach", 1)];
        Gather::<One, _>::new(dialect, "see_surfaces", space, Among::Active, Order::Lanes)
            .fold(&continua, &others, Among::Active, |meeting, seen| {
                let (mut me, mut other) = (meeting.me, meeting.other);
                let surface = one(&mut other);
                *seen += surface * self.owned(space, &mut me, &mut other);
            })
            .close(&[], &surface, &writes, |seen, x| {
                let (yes, no) = (Traced::from(1.0), Traced::from(0.0));
                let is_free = x[0].above(0.5);
                let sees = seen.above(0.5) & x[0].below(0.5);
                let far = Traced::from(FAR);
                vec![Traced::select(sees, yes, no), Traced::select(is_free, no, far)]
            })
    }

    /// How far the nearest surface is, `h_b` of CTVF algorithm 1.
    fn reach(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let continua = self.of_continua();
        let others = [&[own("surface", 1)], &*continua].concat();
        Gather::<One, _>::new(dialect, "reach_surfaces", space, Among::Active, Order::Fold)
            .only("close_by")
            .start(&[], |_| Traced::from(f64::INFINITY))
            .fold(&continua, &others, Among::Active, |meeting, nearest| {
                let (mut me, mut other) = (meeting.me, meeting.other);
                let square = meeting.pair.square;
                let surface = one(&mut other) * self.owned(space, &mut me, &mut other);
                let is_nearer = surface.above(0.5) & square.less(*nearest);
                *nearest = Traced::select(is_nearer, square, *nearest);
            })
            .close(&[], &[], &[own("reach", 1)], |nearest, _| {
                let h = Traced::from(self.smoothing_length);
                let reach = nearest.sqrt() / Traced::from(self.kernel.support_over_h());
                vec![Traced::select(reach.less(h), reach, Traced::from(FAR))]
            })
    }

    /// The sum of CTVF (35) with a support that ends at the surface.
    fn crowd(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let continua = self.of_continua();
        let mine = [&[own("reach", 1)], &*continua].concat();
        let others = [&[own("side", side_width(D))], &*continua].concat();
        let law = CrowdingWithin::<D> {
            kernel: self.kernel,
            smoothing_length: self.smoothing_length,
            crowding: self.crowding,
        };
        Gather::<Components<D>, _>::new(dialect, "crowd", space, Among::Active, Order::Single)
            .only("close_by")
            .fold(&mine, &others, Among::All, |meeting, sum| {
                let (mut me, mut other) = (meeting.me, meeting.other);
                let no = Traced::from(0.0);
                let (reach, volume) = (one(&mut me), side::<D>(&mut other).volume);
                let own = self.owned(space, &mut me, &mut other);
                law.add(&((no, no), reach), &((volume, own), no), &meeting.pair, sum);
            })
            .close(&[], &[], &[own("crowd", D)], |sum, _| sum.iter().copied().collect())
    }
}
