//! The passes of walls.

use piola_device::{Among, Dialect, Gather, Order, Pass, Space, Traced, Use, local, own, through};
use piola_formulas::pairs::fluid::Side;
use piola_formulas::pairs::wall::{Around, Ghost};
use piola_formulas::pairs::{Components, One};
use piola_formulas::{Number, fluid};

use super::super::barrier::TOUCH;
use super::super::escape::{Room, TOLERANCE};
use super::super::extent::Extent;
use super::super::ledger::ACCELERATIONS;
use super::super::walls::{BESIDE, is_in_cell};
use super::moving::ends;
use super::passes::{FORCES, Plan, flat, side, side_width};
use crate::schemes::device::{Recorded as Vector, one, square, take};

/// The faces of a wall particle as numbers: how many they are, whether the wall lets slip, the normal between
/// them, and how deep it is behind each, with its normal.
struct Faces<const D: usize> {
    count: Traced,
    slips: Traced,
    between: Vector<D>,
    all: Vec<(Traced, Vector<D>)>,
}

/// Numbers of the faces of a wall particle with this many normals.
pub(super) const fn faces_width(dimension: usize, normals: usize) -> usize {
    2 + dimension + normals * (1 + dimension)
}

impl<const D: usize> Faces<D> {
    fn take(numbers: &mut &[Traced], count: usize) -> Self {
        Self {
            count: one(numbers),
            slips: one(numbers),
            between: take(numbers),
            all: (0..count).map(|_| (one(numbers), take(numbers))).collect(),
        }
    }

    /// As [`crate::geometry::Faces::towards`].
    fn towards(&self, direction: &Vector<D>) -> Vector<D> {
        let zero = Traced::from(0.0);
        let mut sum = Vector::<D>::repeat(zero);
        for (k, (_, normal)) in self.all.iter().enumerate() {
            let along = direction.dot(normal);
            let part = normal * Traced::select(along.above(0.0), along, zero);
            let is_face = self.count.above(k as f64 + 0.5);
            for axis in 0..D {
                sum[axis] = Traced::select(is_face, sum[axis] + part[axis], sum[axis]);
            }
        }
        let length = square(&sum).sqrt();
        let least = square(direction).sqrt() * 1e-6;
        let is_between = self.count.below(1.5) | length.at_most(least);
        pick(is_between, &self.between, &(sum / length))
    }

    /// As [`super::super::Common::over`]: whether a place is over a face, how far in front of
    /// it, and the normal.
    fn over(&self, way: &Vector<D>, spacing: f64) -> (<Traced as Number>::Mask, Traced, Vector<D>) {
        let height = |(depth, normal): &(Traced, Vector<D>)| way.dot(normal) - *depth;
        let mut best = (height(&self.all[0]), self.all[0].1);
        for (k, face) in self.all.iter().enumerate().skip(1) {
            let (other, normal) = (height(face), &face.1);
            let is_better = self.count.above(k as f64 + 0.5) & best.0.less(other);
            best = (Traced::select(is_better, other, best.0), pick(is_better, normal, &best.1));
        }
        let (height, normal) = best;
        let along = way.dot(&normal);
        let aside = square(way) - along * along;
        let reach = BESIDE * spacing;
        let is_over = self.count.above(0.5) & aside.at_most(Traced::from(reach * reach));
        (is_over, height, normal)
    }
}

/// What a wall particle makes of the matter around it.
pub(super) struct GhostOf<const D: usize> {
    pub of_fluid: Ghost<Traced, D>,
    /// Whether there is any.
    pub is_wet: <Traced as Number>::Mask,
    /// Whether the wall lets slip.
    pub slips: <Traced as Number>::Mask,
    /// The normal towards the matter.
    pub normal: Vector<D>,
    /// Velocity with which the wall moves, and that of its surface, in m/s.
    motion: Vector<D>,
    pub surface: Vector<D>,
    /// The volume that it fills in m^D.
    volume: Traced,
    at_rest: [Traced; 2],
}

/// One of two vectors.
pub(super) fn pick<const D: usize>(
    mask: <Traced as Number>::Mask,
    yes: &Vector<D>,
    no: &Vector<D>,
) -> Vector<D> {
    Vector::from_fn(|axis, _| Traced::select(mask, yes[axis], no[axis]))
}

impl<const D: usize> Plan<D> {
    fn faces_width(&self) -> usize {
        faces_width(D, self.normals)
    }

    /// Passes of walls, and of what touches them.
    pub(super) fn wall_passes(&self, dialect: Dialect, space: &Space<D>) -> Vec<Pass> {
        if self.normals == 0 {
            return Vec::new();
        }
        let mut all =
            vec![self.hold_off(dialect, space), self.add_holds(dialect), self.bear(dialect, space)];
        all.extend(self.room.as_ref().map(|room| self.escape(dialect, space, room)));
        all.extend(self.removes.then(|| self.tell_escaped(dialect)));
        all
    }

    /// The columns of what a wall particle makes of the matter around it.
    pub(super) fn of_ghosts(&self) -> Vec<Use> {
        let of = |column, width| through("numbers", column, width);
        let mut columns = vec![
            of("mass", 1),
            of("sliding", D),
            of("faces", self.faces_width()),
            of("gravity", D),
        ];
        if self.moves {
            columns.extend([of("motion", D), of("motion_rate", D)]);
        }
        columns.extend(self.of_rest());
        // What has been removed is passive, too, and stays as it is.
        columns.extend(self.removes.then_some(own("side", side_width(D))));
        columns
    }

    /// What it makes of that, of numbers of these columns, of which those of a side that has been removed are left.
    pub(super) fn ghost(&self, around: &Around<Traced, D>, x: &mut &[Traced]) -> GhostOf<D> {
        let (volume, sliding) = (one(x), take(x));
        let faces = Faces::<D>::take(x, self.normals);
        let gravity: Vector<D> = take(x);
        let (motion, lift) = match self.moves {
            true => (take(x), gravity - take(x)),
            false => (Vector::<D>::repeat(Traced::from(0.0)), gravity),
        };
        let normal = faces.towards(&-around.arm);
        GhostOf {
            of_fluid: around.ghost([&motion, &sliding], &lift, &normal),
            surface: if self.moves { motion + sliding } else { sliding },
            is_wet: around.weight.above(0.0),
            slips: faces.slips.above(0.5),
            at_rest: self.rest(x),
            normal,
            motion,
            volume,
        }
    }

    /// The numbers of the side of a wall particle with a velocity and a deviation in m/s. Without matter around it moves with
    /// the wall and bears no pressure.
    pub(super) fn ghost_side(
        &self,
        ghost: &GhostOf<D>,
        [velocity, deviation]: [Vector<D>; 2],
        x: &mut &[Traced],
    ) -> Vec<Traced> {
        let (zero, is_wet) = (Traced::from(0.0), ghost.is_wet);
        let rest = Vector::<D>::repeat(zero);
        let pressure = Traced::select(is_wet, ghost.of_fluid.pressure, zero);
        let mut side: Side<Traced, D> = Side {
            velocity: pick(is_wet, &velocity, &ghost.motion),
            deviation: pick(is_wet, &deviation, &rest),
            density: zero,
            pressure,
            load: zero,
            volume: zero,
        };
        let [density, wave_speed] = ghost.at_rest;
        let density = fluid::density(pressure, density, wave_speed);
        side.set(ghost.volume * density, density, pressure);
        let side = flat(&side);
        match self.removes {
            true => {
                let before = super::passes::side::<D>(x);
                let is_out = before.density.abs().at_most(zero);
                let pick = |(old, new): (Traced, Traced)| Traced::select(is_out, old, new);
                flat(&before).into_iter().zip(side).map(pick).collect()
            }
            false => side,
        }
    }

    /// What walls do to fluid that touches them, theory (80).
    fn hold_off(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let mut mine = vec![own("side", side_width(D)), own("force", FORCES * D)];
        mine.extend(self.of_rest());
        let mut others = vec![through("numbers", "faces", self.faces_width())];
        others.extend(self.moves.then_some(through("numbers", "motion", D)));
        let spacing = self.spacing;
        let writes = [own("hold", 2 * D + 1), own("side", side_width(D))];
        type Holds<const D: usize> = ((Components<D>, Components<D>), One);
        Gather::<Holds<D>, _>::new(dialect, "hold_off", space, Among::Active, Order::Fold)
            .start(&[], |_| {
                let nothing = Vector::<D>::repeat(Traced::from(0.0));
                ((nothing, nothing), Traced::from(-1.0))
            })
            .fold(&mine, &others, Among::Passive, |meeting, ((acceleration, deviation), wall)| {
                let (mut mine, mut other) = (meeting.me, meeting.other);
                let me: Side<Traced, D> = side(&mut mine);
                let load = total(&forces(&mut mine));
                let faces = Faces::<D>::take(&mut other, self.normals);
                let way = meeting.pair.separation;
                let (is_over, height, normal) = faces.over(&way, spacing);
                let touches = is_over
                    & Traced::from(-spacing).at_most(height)
                    & height.below(TOUCH * spacing);
                let shift = (me.deviation - *deviation).dot(&normal);
                let shift = Traced::select(shift.below(0.0), shift, Traced::from(0.0));
                let relative = match self.moves {
                    true => me.velocity - take::<D>(&mut other),
                    false => me.velocity,
                };
                let mut approach = relative.dot(&normal);
                if self.shifts {
                    *deviation = pick(touches, &(*deviation + normal * shift), deviation);
                } else {
                    approach += shift;
                }
                let [_, wave_speed] = self.rest(&mut mine);
                let rate = wave_speed / spacing;
                let push = -(load + *acceleration).dot(&normal) - approach * rate;
                let acts = touches & push.above(0.0);
                *acceleration = pick(acts, &(*acceleration + normal * push), acceleration);
                *wall = Traced::select(acts, meeting.slots[1], *wall);
            })
            .close(&[], &[own("side", side_width(D))], &writes, |hold, mut x| {
                let ((acceleration, deviation), wall) = hold;
                let mut me: Side<Traced, D> = side(&mut x);
                if self.shifts {
                    me.deviation -= deviation;
                }
                let vectors = acceleration.iter().chain(deviation.iter()).copied();
                vectors.chain([*wall]).chain(flat(&me)).collect()
            })
    }

    /// Adds what walls do to the forces on the fluid.
    fn add_holds(&self, dialect: Dialect) -> Pass {
        let reads =
            [through("numbers", "wall", 1), own("hold", 2 * D + 1), own("force", FORCES * D)];
        let writes = [own("force", FORCES * D)];
        local(dialect, "add_holds", &[], &reads, &writes, |mut x| {
            let wall = one(&mut x);
            let acceleration: Vector<D> = take(&mut x);
            let _: Vector<D> = take(&mut x);
            let _ = one(&mut x);
            let mut all = x.to_vec();
            for axis in 0..D {
                let held = all[4 * D + axis] + acceleration[axis];
                all[4 * D + axis] = super::passes::if_fluid(wall, held, all[4 * D + axis]);
            }
            all
        })
    }

    /// What wall particles get for what they do.
    fn bear(&self, dialect: Dialect, space: &Space<D>) -> Pass {
        let mine = [own("side", side_width(D))];
        let others = [own("hold", 2 * D + 1), own("side", side_width(D))];
        let force = [own("force", FORCES * D)];
        Gather::<Components<D>, _>::new(dialect, "bear", space, Among::Passive, Order::Fold)
            .start(&force, |mut x| forces::<D>(&mut x)[4])
            .fold(&mine, &others, Among::Active, |meeting, sum| {
                let (mut mine, mut other) = (meeting.me, meeting.other);
                let me: Side<Traced, D> = side(&mut mine);
                let acceleration: Vector<D> = take(&mut other);
                let _: Vector<D> = take(&mut other);
                let wall = one(&mut other);
                let its: Side<Traced, D> = side(&mut other);
                let mine = meeting.slots[0];
                let is_mine = wall.at_most(mine) & mine.at_most(wall);
                let ratio = its.mass() / me.mass();
                *sum = pick(is_mine, &(*sum - acceleration * ratio), sum);
            })
            .close(&[], &force, &force, |walls, x| {
                let mut all = x.to_vec();
                all[4 * D..5 * D].copy_from_slice(walls.as_slice());
                all
            })
    }

    /// Which particles have gone through a wall, or out of the box around everything.
    fn escape(&self, dialect: Dialect, space: &Space<D>, room: &Room<D>) -> Pass {
        let others = [through("numbers", "faces", self.faces_width())];
        let ends = if self.moves { ends::<D>() } else { Vec::new() };
        let spacing = self.spacing;
        Gather::<(One, One), _>::new(dialect, "escape", space, Among::Active, Order::Fold)
            .start(&[], |_| (Traced::from(f64::INFINITY), Traced::from(0.0)))
            .fold(&[], &others, Among::Passive, |meeting, (nearest, is_through)| {
                let mut other = meeting.other;
                let faces = Faces::<D>::take(&mut other, self.normals);
                let way = meeting.pair.separation;
                let (is_over, _, normal) = faces.over(&way, spacing);
                let passed = is_over
                    & is_in_cell(&way, spacing)
                    & way.dot(&normal).below(-TOLERANCE * spacing);
                let (yes, no) = (Traced::from(1.0), Traced::from(0.0));
                let is_nearer = meeting.pair.square.less(*nearest);
                *is_through =
                    Traced::select(is_nearer, Traced::select(passed, yes, no), *is_through);
                *nearest = Traced::select(is_nearer, meeting.pair.square, *nearest);
            })
            .close(&ends, &[own("place", D)], &[own("escaped", 1)], |(_, is_through), mut x| {
                let fixed =
                    |extent: &Extent<D>| [extent.low, extent.high].map(|end| end.map(Traced::from));
                let extents: [[Vector<D>; 2]; 2] = match self.moves {
                    true => [[take(&mut x), take(&mut x)], [take(&mut x), take(&mut x)]],
                    false => [fixed(&room.walls), fixed(&room.bounds)],
                };
                let mut escaped = *is_through;
                for ([low, high], outside) in extents.into_iter().zip([0.0, 1.0]) {
                    for axis in (0..D).filter(|axis| self.periods[*axis].is_none()) {
                        let [low, high] = [low[axis], high[axis]];
                        let is_inside = low.at_most(x[axis]) & x[axis].at_most(high);
                        escaped = Traced::select(is_inside, escaped, Traced::from(outside));
                    }
                }
                vec![escaped]
            })
    }
}

/// Takes the accelerations of a particle from the front of some numbers.
pub(super) fn forces<const D: usize>(numbers: &mut &[Traced]) -> [Vector<D>; FORCES] {
    std::array::from_fn(|_| take(numbers))
}

/// The acceleration by all mechanisms.
pub(super) fn total<const D: usize>(forces: &[Vector<D>; FORCES]) -> Vector<D> {
    let nothing = Vector::<D>::repeat(Traced::from(0.0));
    forces[..ACCELERATIONS].iter().fold(nothing, |sum, force| sum + force)
}
