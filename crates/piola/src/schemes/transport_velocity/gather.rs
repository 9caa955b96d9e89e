//! The sums of a particle over its neighbours for the accelerations, a group of them at a time.

use piola_formulas::fluid;

use super::{Dilatation, Forces, Side, TransportVelocity};
use crate::Vector;
use crate::operators::{
    LANES, Lanes, Needs, Neighbor, NeighborBlock, NeighborGroup, all_of, total,
};

/// Constants of one pass.
pub(super) struct Constants {
    pub softening: f64,
    pub viscosity: f64,
    /// `alpha h c` of CTVF (28).
    pub artificial: f64,
    pub stress: bool,
    pub dilatation: Dilatation,
    /// `1 / W(dx)` where particles are shifted by SPST.
    pub crowding: f64,
}

/// Sums over neighbours: `T` is `f64`, or [`Lanes`] while they grow. What is of a itself stands
/// outside of those for the corrections.
pub(super) struct Sums<T, const D: usize> {
    pressure: [T; D],
    viscosity: [T; D],
    artificial_viscosity: [T; D],
    walls: [T; D],
    /// `sum V_b grad W_ab`.
    volume: [T; D],
    /// `sum m_b grad W_ab`.
    mass: [T; D],
    /// `sum m_b d_b . grad W_ab`.
    mass_deviation: T,
    /// `sum V_b d_b . grad W_ab`.
    deviation: T,
    /// `sum V_b u_b . grad W_ab`.
    velocity: T,
    /// `sum V_b u_b d_b . grad W_ab`.
    momentum: [T; D],
    crowding: [T; D],
}

impl<const D: usize> TransportVelocity<D> {
    /// The sums of the particle at `place`.
    ///
    /// Returned by value: as no pointer to them leaves the loop, the compiler sees that they are
    /// apart from what it reads.
    #[inline(always)]
    pub(super) fn gather<const CORRECTS: bool, const ARTIFICIAL: bool, const CROWDING: bool>(
        &self,
        place: usize,
        constants: &Constants,
        block: &mut NeighborBlock<D>,
    ) -> Sums<Lanes, D> {
        let me = &self.sides[place];
        let needs = if CROWDING { Needs::Both } else { Needs::Slope };
        let mut sums = Sums::zero();
        let mut rest = self.support.active(place);
        while self.support.fill(&mut rest, needs, block) {
            for group in block.groups() {
                let others = all_of(&self.sides, group.places);
                #[expect(clippy::needless_range_loop, reason = "a lane is the same in all arrays")]
                for lane in 0..LANES {
                    let neighbor = group.neighbor(lane);
                    sums.add_fluid::<ARTIFICIAL>(lane, me, others[lane], &neighbor, constants);
                    sums.carry::<CORRECTS, CROWDING>(lane, others[lane], &neighbor, constants);
                }
            }
        }
        let mut rest = self.support.passive(place);
        while self.support.fill(&mut rest, needs, block) {
            for group in block.groups() {
                self.add_walls::<CORRECTS, CROWDING>(me, &group, constants, &mut sums);
            }
        }
        sums
    }

    /// Adds the terms of wall particles.
    #[inline(always)]
    fn add_walls<const CORRECTS: bool, const CROWDING: bool>(
        &self,
        me: &Side<D>,
        group: &NeighborGroup<'_, D>,
        constants: &Constants,
        sums: &mut Sums<Lanes, D>,
    ) {
        let others = all_of(&self.sides, group.places);
        let shears = all_of(&self.shear, group.places);
        for lane in 0..LANES {
            let neighbor = group.neighbor(lane);
            let velocities = [&me.velocity, shears[lane]];
            let force = wall_force([me, others[lane]], velocities, &neighbor, constants);
            for i in 0..D {
                sums.walls[i][lane] += force[i];
            }
            sums.carry::<CORRECTS, CROWDING>(lane, others[lane], &neighbor, constants);
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
    ((velocity - other_velocity) * exchange - neighbor.separation * pressure) * other.mass
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
            volume: [zero; D],
            mass: [zero; D],
            mass_deviation: zero,
            deviation: zero,
            velocity: zero,
            momentum: [zero; D],
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
        let gradient = neighbor.separation * neighbor.slope;
        let jump = me.velocity - other.velocity;
        let densities = me.density + other.density;
        let scale = fluid::exchange_scale(densities, neighbor.square, constants.softening);
        let exchange =
            fluid::diffusion(constants.viscosity, neighbor.square, neighbor.slope, scale);
        let pressure = gradient * (other.mass * (me.load + other.load));
        let viscosity = jump * (other.mass * exchange);
        for i in 0..D {
            self.pressure[i][lane] -= pressure[i];
            self.viscosity[i][lane] += viscosity[i];
        }
        if ARTIFICIAL {
            let approach = jump.dot(&neighbor.separation);
            let artificial = fluid::artificial_viscosity(constants.artificial, approach, scale);
            let artificial = gradient * (other.mass * artificial);
            for i in 0..D {
                self.artificial_viscosity[i][lane] -= artificial[i];
            }
        }
    }

    /// Adds what the corrections and the shifting need to the sums of one lane.
    #[inline(always)]
    fn carry<const CORRECTS: bool, const CROWDING: bool>(
        &mut self,
        lane: usize,
        other: &Side<D>,
        neighbor: &Neighbor<D>,
        constants: &Constants,
    ) {
        let gradient = neighbor.separation * neighbor.slope;
        let area = gradient * other.volume;
        for i in 0..D {
            self.volume[i][lane] += area[i];
        }
        if CORRECTS {
            let carried = other.deviation.dot(&area);
            for i in 0..D {
                self.mass[i][lane] += gradient[i] * other.mass;
                self.momentum[i][lane] += other.velocity[i] * carried;
            }
            self.deviation[lane] += carried;
            self.mass_deviation[lane] += carried * other.density;
            self.velocity[lane] += other.velocity.dot(&area);
        }
        if CROWDING {
            let factor = fluid::repulsion(neighbor.value * constants.crowding);
            for i in 0..D {
                self.crowding[i][lane] += area[i] * factor;
            }
        }
    }

    /// The sums over all lanes. Not inlined: what follows is work on single numbers, and mixed
    /// with it the compiler takes the lanes apart in the loop, too.
    #[inline(never)]
    pub fn total(&self) -> Sums<f64, D> {
        Sums {
            pressure: self.pressure.map(total),
            viscosity: self.viscosity.map(total),
            artificial_viscosity: self.artificial_viscosity.map(total),
            walls: self.walls.map(total),
            volume: self.volume.map(total),
            mass: self.mass.map(total),
            mass_deviation: total(self.mass_deviation),
            deviation: total(self.deviation),
            velocity: total(self.velocity),
            momentum: self.momentum.map(total),
            crowding: self.crowding.map(total),
        }
    }
}

impl<const D: usize> Sums<f64, D> {
    /// The accelerations of a particle with these sums, without body forces.
    pub fn forces(&self, me: &Side<D>, constants: &Constants) -> Forces<D> {
        Forces {
            pressure: self.pressure.into(),
            viscosity: self.viscosity.into(),
            artificial_viscosity: self.artificial_viscosity.into(),
            transport: self.transport(me, constants),
            walls: self.walls.into(),
            body_force: Vector::zeros(),
            crowding: self.crowding.into(),
            opening: -Vector::from(self.volume),
        }
    }

    /// The corrections of the momentum equation.
    fn transport(&self, me: &Side<D>, constants: &Constants) -> Vector<D> {
        let mut sum = Vector::zeros();
        if constants.stress {
            let mine = me.deviation.dot(&Vector::from(self.mass)) / me.density;
            sum += me.velocity * mine + Vector::from(self.momentum);
        }
        let volume = Vector::from(self.volume);
        let mine = me.deviation.dot(&volume);
        sum + me.velocity
            * match constants.dilatation {
                Dilatation::None => 0.0,
                Dilatation::Deviation => mine - self.mass_deviation / me.density,
                Dilatation::Transport => {
                    mine - self.deviation + me.velocity.dot(&volume) - self.velocity
                }
            }
    }
}
