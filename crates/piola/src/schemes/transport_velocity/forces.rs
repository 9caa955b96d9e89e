//! The accelerations.

use piola_formulas::fluid;

use super::{Dilatation, Shifting, Side, TransportVelocity};
use crate::operators::{Needs, Neighbor, NeighborBlock};
use crate::{Vector, parallel};

/// Accelerations of a particle in m/s^2, term by term, and sums that the same pass gathers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forces<const D: usize> {
    /// Of the pressure between particles of the fluid.
    pub pressure: Vector<D>,
    /// Of the viscosity between particles of the fluid.
    pub viscosity: Vector<D>,
    /// Of the artificial viscosity.
    pub artificial_viscosity: Vector<D>,
    /// Of the corrections for the transport velocity.
    pub transport: Vector<D>,
    /// Of pressure and viscosity between fluid and walls.
    pub walls: Vector<D>,
    /// Body forces.
    pub body_force: Vector<D>,
    /// `sum V_b (1 + R (W_ab / W(dx))^4) grad W_ab` of CTVF (35), in 1/m.
    pub crowding: Vector<D>,
    /// `-sum V_b grad W_ab` of CTVF (42), in 1/m.
    pub opening: Vector<D>,
}

impl<const D: usize> Default for Forces<D> {
    fn default() -> Self {
        let zero = Vector::zeros();
        Self {
            pressure: zero,
            viscosity: zero,
            artificial_viscosity: zero,
            transport: zero,
            walls: zero,
            body_force: zero,
            crowding: zero,
            opening: zero,
        }
    }
}

impl<const D: usize> Forces<D> {
    /// The acceleration by all of them together, in m/s^2.
    pub fn total(&self) -> Vector<D> {
        self.terms().into_iter().sum()
    }

    /// The accelerations in the order of the mechanisms.
    pub(super) fn terms(&self) -> [&Vector<D>; super::ACCELERATING] {
        [
            &self.pressure,
            &self.viscosity,
            &self.artificial_viscosity,
            &self.transport,
            &self.walls,
            &self.body_force,
        ]
    }
}

impl<const D: usize> Forces<D> {
    /// The accelerations that do not come in pairs on the line between two particles, in the
    /// order of the ways in which momentum enters.
    pub(super) fn ways_in(&self) -> [&Vector<D>; super::ENTERING] {
        [&self.walls, &self.body_force, &self.viscosity, &self.transport]
    }
}

/// Constants of one pass.
struct Constants {
    softening: f64,
    viscosity: f64,
    /// `alpha h c` of CTVF (28).
    artificial: f64,
    stress: bool,
    dilatation: Dilatation,
    /// Whether there is any of both.
    corrects: bool,
    /// `1 / W(dx)` where particles are shifted by SPST.
    crowding: Option<f64>,
}

impl<const D: usize> TransportVelocity<D> {
    /// Fills `forces` from the sides, without body forces. On wall particles it is the reaction
    /// of the fluid.
    pub(super) fn force_pass(&mut self) {
        let mut forces = std::mem::take(&mut self.forces);
        let h = self.support.smoothing_length();
        let constants = Constants {
            softening: fluid::softening(h),
            viscosity: self.fluid.viscosity,
            artificial: self.settings.artificial_viscosity * h * self.fluid.wave_speed,
            stress: self.settings.corrections.stress,
            dilatation: self.settings.corrections.dilatation,
            corrects: self.settings.corrections.stress
                || self.settings.corrections.dilatation != Dilatation::None,
            crowding: match self.settings.shifting {
                Shifting::Sun { .. } => Some(1.0 / self.value_at_spacing(h)),
                _ => None,
            },
        };
        let list = self.support.list();
        parallel::for_each_chunk(&mut forces, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                *row = match list.is_passive(place) {
                    true => self.reaction_at(place, &constants, &mut block),
                    false => self.forces_at(place, &constants, &mut block),
                };
            }
        });
        self.forces = forces;
    }

    fn forces_at(
        &self,
        place: usize,
        constants: &Constants,
        block: &mut NeighborBlock<D>,
    ) -> Forces<D> {
        let me = &self.sides[place];
        let needs = if constants.crowding.is_some() { Needs::Both } else { Needs::Slope };
        let mut sum = Forces::default();
        let mut carried = Carried::default();
        let mut rest = self.support.active(place);
        while self.support.fill(&mut rest, needs, block) {
            for neighbor in block.iter() {
                let other = &self.sides[neighbor.place];
                let gradient = neighbor.separation * neighbor.slope;
                sum.pressure -= gradient * (other.mass * (me.load + other.load));
                let scale = fluid::exchange_scale(
                    me.density + other.density,
                    neighbor.square,
                    constants.softening,
                );
                let jump = me.velocity - other.velocity;
                let exchange =
                    fluid::diffusion(constants.viscosity, neighbor.square, neighbor.slope, scale);
                sum.viscosity += jump * (other.mass * exchange);
                if constants.artificial > 0.0 {
                    let approach = jump.dot(&neighbor.separation);
                    let artificial =
                        fluid::artificial_viscosity(constants.artificial, approach, scale);
                    sum.artificial_viscosity -= gradient * (other.mass * artificial);
                }
                carried.add(other, &neighbor, gradient, constants);
            }
        }
        let mut rest = self.support.passive(place);
        while self.support.fill(&mut rest, needs, block) {
            for neighbor in block.iter() {
                let shear = &self.shear[neighbor.place];
                sum.walls += self.wall_force(me, &me.velocity, &neighbor, shear, constants);
                let gradient = neighbor.separation * neighbor.slope;
                carried.add(&self.sides[neighbor.place], &neighbor, gradient, constants);
            }
        }
        sum.transport = carried.acceleration(me, constants);
        sum.opening = -carried.volume;
        sum.crowding = carried.crowding;
        sum
    }

    /// The force of the fluid on a wall particle, over its mass: what it does to the fluid, turned
    /// round.
    fn reaction_at(
        &self,
        place: usize,
        constants: &Constants,
        block: &mut NeighborBlock<D>,
    ) -> Forces<D> {
        let (me, mut sum) = (&self.sides[place], Forces::default());
        let mut rest = self.support.active(place);
        while self.support.fill(&mut rest, Needs::Slope, block) {
            for neighbor in block.iter() {
                let other = &self.sides[neighbor.place];
                sum.walls +=
                    self.wall_force(me, &self.shear[place], &neighbor, &other.velocity, constants);
            }
        }
        sum
    }

    /// Pressure and viscosity between fluid and wall. There is no artificial viscosity, which
    /// would hold back a fluid that slides.
    #[inline]
    fn wall_force(
        &self,
        me: &Side<D>,
        velocity: &Vector<D>,
        neighbor: &Neighbor<D>,
        other_velocity: &Vector<D>,
        constants: &Constants,
    ) -> Vector<D> {
        let other = &self.sides[neighbor.place];
        let densities = me.density + other.density;
        let scale = fluid::exchange_scale(densities, neighbor.square, constants.softening);
        let exchange =
            fluid::diffusion(constants.viscosity, neighbor.square, neighbor.slope, scale);
        let pressure = neighbor.slope * (me.load + other.load);
        ((velocity - other_velocity) * exchange - neighbor.separation * pressure) * other.mass
    }
}

/// Sums over all neighbours for the corrections and the shifting. What is of a itself stands
/// outside of them.
struct Carried<const D: usize> {
    /// `sum V_b grad W_ab`.
    volume: Vector<D>,
    /// `sum m_b grad W_ab`.
    mass: Vector<D>,
    /// `sum m_b d_b . grad W_ab`, or with V_b for the dilatation of uhat.
    deviation: f64,
    /// `sum V_b u_b . grad W_ab`.
    velocity: f64,
    /// `sum V_b u_b d_b . grad W_ab`.
    momentum: Vector<D>,
    crowding: Vector<D>,
}

impl<const D: usize> Default for Carried<D> {
    fn default() -> Self {
        let zero = Vector::zeros();
        let (volume, mass, momentum, crowding) = (zero, zero, zero, zero);
        Self { volume, mass, deviation: 0.0, velocity: 0.0, momentum, crowding }
    }
}

impl<const D: usize> Carried<D> {
    #[inline]
    fn add(
        &mut self,
        other: &Side<D>,
        neighbor: &Neighbor<D>,
        gradient: Vector<D>,
        constants: &Constants,
    ) {
        let area = gradient * other.volume;
        self.volume += area;
        if constants.corrects {
            self.mass += gradient * other.mass;
            let carried = other.deviation.dot(&area);
            self.momentum += other.velocity * carried;
            if constants.dilatation == Dilatation::Transport {
                self.deviation += carried;
                self.velocity += other.velocity.dot(&area);
            } else {
                self.deviation += carried * other.density;
            }
        }
        if let Some(inverse) = constants.crowding {
            self.crowding += area * fluid::repulsion(neighbor.value * inverse);
        }
    }

    /// The corrections of the momentum equation for a particle with these sums.
    fn acceleration(&self, me: &Side<D>, constants: &Constants) -> Vector<D> {
        let mut sum = Vector::zeros();
        if constants.stress {
            let mine = me.velocity * (me.deviation.dot(&self.mass) / me.density);
            sum += mine + self.momentum;
        }
        let mine = me.deviation.dot(&self.volume);
        sum + me.velocity
            * match constants.dilatation {
                Dilatation::None => 0.0,
                Dilatation::Deviation => mine - self.deviation / me.density,
                Dilatation::Transport => {
                    mine - self.deviation + me.velocity.dot(&self.volume) - self.velocity
                }
            }
    }
}
