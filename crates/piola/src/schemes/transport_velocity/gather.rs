//! The sums of a particle over its neighbours for the accelerations, a group of them at a time.

use piola_formulas::fluid;

use super::{Corrections, Dilatation, Forces, Side, TransportVelocity};
use crate::Vector;
use crate::operators::{
    LANES, Lanes, Needs, Neighbor, NeighborBlock, NeighborGroup, all_of, total,
};

/// Which corrections of the momentum equation a loop is made for: none of them,
pub(super) const NONE: u8 = 0;
/// the stress with the dilatation of the deviation,
pub(super) const FULL: u8 = 1;
/// or any of them, by the factors of [`Constants`].
pub(super) const MIXED: u8 = 2;

/// The loop that a set of corrections needs.
pub(super) fn kind_of(corrections: &Corrections) -> u8 {
    match (corrections.stress, corrections.dilatation) {
        (false, Dilatation::None) => NONE,
        (true, Dilatation::Deviation) => FULL,
        _ => MIXED,
    }
}

/// Constants of one pass.
pub(super) struct Constants {
    pub softening: f64,
    pub viscosity: f64,
    /// `alpha h c` of CTVF (28).
    pub artificial: f64,
    /// 1 for each correction that is on: the stress, and the dilatation of the deviation or that
    /// of the transport velocity.
    pub stress: f64,
    pub deviation: f64,
    pub transport: f64,
    /// `1 / W(dx)` where particles are shifted by SPST.
    pub crowding: f64,
}

/// Sums over neighbours: `T` is `f64`, or [`Lanes`] while they grow.
pub(super) struct Sums<T, const D: usize> {
    pressure: [T; D],
    viscosity: [T; D],
    artificial_viscosity: [T; D],
    walls: [T; D],
    /// `sum V_b u_b d_b . grad W_ab`.
    carried: [T; D],
    /// What stands before `u_a` in the corrections.
    stretch: T,
    /// `sum V_b grad W_ab`.
    volume: [T; D],
    crowding: [T; D],
}

/// What the particle itself brings to its sums.
struct Center<'a, const D: usize> {
    side: &'a Side<D>,
    /// `1 / rho_a`.
    inverse_density: f64,
}

impl<const D: usize> TransportVelocity<D> {
    /// The sums of the particle at `place`.
    ///
    /// Returned by value: as no pointer to them leaves the loop, the compiler sees that they are
    /// apart from what it reads.
    #[inline(always)]
    pub(super) fn gather<const CORRECTS: u8, const ARTIFICIAL: bool, const CROWDING: bool>(
        &self,
        place: usize,
        constants: &Constants,
        block: &mut NeighborBlock<D>,
    ) -> Sums<Lanes, D> {
        let side = &self.sides[place];
        let me = Center { side, inverse_density: 1.0 / side.density };
        let needs = if CROWDING { Needs::Both } else { Needs::Slope };
        let mut sums = Sums::zero();
        let mut rest = self.support.active(place);
        while self.support.fill(&mut rest, needs, block) {
            for group in block.groups() {
                let others = all_of(&self.sides, group.places);
                #[expect(clippy::needless_range_loop, reason = "a lane is the same in all arrays")]
                for lane in 0..LANES {
                    let neighbor = group.neighbor(lane);
                    let other = others[lane];
                    sums.add_fluid::<ARTIFICIAL>(lane, side, other, &neighbor, constants);
                    sums.carry::<CORRECTS, CROWDING>(lane, &me, other, &neighbor, constants);
                }
            }
        }
        let mut rest = self.support.passive(place);
        while self.support.fill(&mut rest, needs, block) {
            for group in block.groups() {
                self.add_walls::<CORRECTS, CROWDING>(&me, &group, constants, &mut sums);
            }
        }
        sums
    }

    /// Adds the terms of wall particles.
    #[inline(always)]
    fn add_walls<const CORRECTS: u8, const CROWDING: bool>(
        &self,
        me: &Center<D>,
        group: &NeighborGroup<'_, D>,
        constants: &Constants,
        sums: &mut Sums<Lanes, D>,
    ) {
        let others = all_of(&self.sides, group.places);
        let shears = all_of(&self.shear, group.places);
        for lane in 0..LANES {
            let neighbor = group.neighbor(lane);
            let velocities = [&me.side.velocity, shears[lane]];
            let force = wall_force([me.side, others[lane]], velocities, &neighbor, constants);
            for i in 0..D {
                sums.walls[i][lane] += force[i];
            }
            sums.carry::<CORRECTS, CROWDING>(lane, me, others[lane], &neighbor, constants);
        }
    }
}

/// Pressure and viscosity between fluid and wall. There is no artificial viscosity, which
/// would hold back a fluid that slides.
#[inline(always)]
pub(super) fn wall_force<const D: usize>(
    [me, other]: [&Side<D>; 2],
    [velocity, other_velocity]: [&Vector<D>; 2],
    neighbor: &Neighbor<D>,
    constants: &Constants,
) -> Vector<D> {
    let densities = me.density + other.density;
    let scale = fluid::exchange_scale(densities, neighbor.square, constants.softening);
    let exchange = fluid::diffusion(constants.viscosity, neighbor.square, neighbor.slope, scale);
    let pressure = neighbor.slope * (me.load + other.load);
    ((velocity - other_velocity) * exchange - neighbor.separation * pressure) * other.mass()
}

impl<const D: usize> Sums<Lanes, D> {
    #[inline(always)]
    fn zero() -> Self {
        let zero = [0.0; LANES];
        Self {
            pressure: [zero; D],
            viscosity: [zero; D],
            artificial_viscosity: [zero; D],
            walls: [zero; D],
            carried: [zero; D],
            stretch: zero,
            volume: [zero; D],
            crowding: [zero; D],
        }
    }

    /// Adds the forces between particles of the fluid to those of one lane.
    ///
    /// It is always inlined: a loop over lanes without calls and conditions is what the compiler
    /// turns into operations on vectors.
    #[inline(always)]
    fn add_fluid<const ARTIFICIAL: bool>(
        &mut self,
        lane: usize,
        me: &Side<D>,
        other: &Side<D>,
        neighbor: &Neighbor<D>,
        constants: &Constants,
    ) {
        let slope = other.mass() * neighbor.slope;
        let jump = me.velocity - other.velocity;
        let densities = me.density + other.density;
        let scale = fluid::exchange_scale(densities, neighbor.square, constants.softening);
        let exchange = fluid::diffusion(constants.viscosity, neighbor.square, slope, scale);
        let pressure = neighbor.separation * (slope * (me.load + other.load));
        let viscosity = jump * exchange;
        for i in 0..D {
            self.pressure[i][lane] -= pressure[i];
            self.viscosity[i][lane] += viscosity[i];
        }
        if ARTIFICIAL {
            let approach = jump.dot(&neighbor.separation);
            let artificial = fluid::artificial_viscosity(constants.artificial, approach, scale);
            let artificial = neighbor.separation * (slope * artificial);
            for i in 0..D {
                self.artificial_viscosity[i][lane] -= artificial[i];
            }
        }
    }

    /// Adds what the corrections and the shifting need to the sums of one lane.
    #[inline(always)]
    fn carry<const CORRECTS: u8, const CROWDING: bool>(
        &mut self,
        lane: usize,
        me: &Center<D>,
        other: &Side<D>,
        neighbor: &Neighbor<D>,
        constants: &Constants,
    ) {
        let slope = other.volume * neighbor.slope;
        if CORRECTS != NONE {
            // V_b d_b . grad W_ab, and the same with the deviation of a.
            let carried = other.deviation.dot(&neighbor.separation) * slope;
            let mine = me.side.deviation.dot(&neighbor.separation) * slope;
            let ratio = other.density * me.inverse_density;
            if CORRECTS == FULL {
                for i in 0..D {
                    self.carried[i][lane] += other.velocity[i] * carried;
                }
                self.stretch[lane] += mine + (mine - carried) * ratio;
            } else {
                let Constants { stress, deviation, transport, .. } = constants;
                let jump = me.side.velocity - other.velocity;
                let opening = jump.dot(&neighbor.separation) * slope;
                for i in 0..D {
                    self.carried[i][lane] += other.velocity[i] * carried * stress;
                }
                self.stretch[lane] += mine * ratio * stress
                    + (mine - carried * ratio) * deviation
                    + (mine - carried + opening) * transport;
            }
        }
        if CROWDING {
            let factor = fluid::repulsion(neighbor.value * constants.crowding);
            let area = neighbor.separation * slope;
            for i in 0..D {
                self.volume[i][lane] += area[i];
                self.crowding[i][lane] += area[i] * factor;
            }
        }
    }

    /// The sums over all lanes. Not inlined: what follows is work on single numbers, and mixed
    /// with it the compiler takes the lanes apart in the loop, too.
    #[inline(never)]
    pub fn total<const ARTIFICIAL: bool>(&self, has_walls: bool) -> Sums<f64, D> {
        Sums {
            pressure: self.pressure.map(total),
            viscosity: self.viscosity.map(total),
            artificial_viscosity: match ARTIFICIAL {
                true => self.artificial_viscosity.map(total),
                false => [0.0; D],
            },
            walls: if has_walls { self.walls.map(total) } else { [0.0; D] },
            carried: self.carried.map(total),
            stretch: total(self.stretch),
            volume: self.volume.map(total),
            crowding: self.crowding.map(total),
        }
    }
}

impl<const D: usize> Sums<f64, D> {
    /// The accelerations of a particle with these sums, without body forces.
    pub fn forces(&self, me: &Side<D>) -> Forces<D> {
        Forces {
            pressure: self.pressure.into(),
            viscosity: self.viscosity.into(),
            artificial_viscosity: self.artificial_viscosity.into(),
            transport: me.velocity * self.stretch + Vector::from(self.carried),
            walls: self.walls.into(),
            body_force: Vector::zeros(),
            crowding: self.crowding.into(),
            opening: -Vector::from(self.volume),
        }
    }
}
