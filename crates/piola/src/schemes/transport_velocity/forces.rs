//! The accelerations.

use multiversion::multiversion;
use piola_formulas::fluid;

use super::gather::{Constants, FULL, MIXED, NONE, kind_of, wall_force};
use super::{Dilatation, Shifting, TransportVelocity};
use crate::operators::{Needs, NeighborBlock};
use crate::{Vector, parallel};

/// Accelerations of a particle in m/s^2, term by term, and sums that the same pass gathers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forces<const D: usize> {
    /// Of the pressure between particles of the fluid, of the stress between those of solids.
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
    /// `-sum V_b grad W_ab` of CTVF (42), in 1/m, where particles are shifted by (35).
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

impl<const D: usize> TransportVelocity<D> {
    /// Fills `forces` from the sides, without body forces. On wall particles it is the reaction
    /// of the fluid.
    pub(super) fn force_pass(&mut self) {
        if self.solids.is_some() {
            self.tension_pass();
            return self.solid_force_pass();
        }
        let mut forces = std::mem::take(&mut self.forces);
        let h = self.support.smoothing_length();
        let corrections = &self.settings.corrections;
        let one_if = |is_on: bool| f64::from(u8::from(is_on));
        let crowding = match self.settings.shifting {
            Shifting::Sun { .. } => Some(1.0 / self.value_at_spacing(h)),
            _ => None,
        };
        let constants = Constants {
            softening: fluid::softening(h),
            viscosity: self.fluid.viscosity,
            artificial: self.settings.artificial_viscosity * h * self.fluid.wave_speed,
            stress: one_if(corrections.stress),
            deviation: one_if(corrections.dilatation == Dilatation::Deviation),
            transport: one_if(corrections.dilatation == Dilatation::Transport),
            crowding: crowding.unwrap_or(0.0),
        };
        let fill = match (kind_of(corrections), constants.artificial > 0.0, crowding.is_some()) {
            (NONE, false, false) => fill::<D, NONE, false, false>,
            (NONE, false, true) => fill::<D, NONE, false, true>,
            (NONE, true, false) => fill::<D, NONE, true, false>,
            (NONE, true, true) => fill::<D, NONE, true, true>,
            (FULL, false, false) => fill::<D, FULL, false, false>,
            (FULL, false, true) => fill::<D, FULL, false, true>,
            (FULL, true, false) => fill::<D, FULL, true, false>,
            (FULL, true, true) => fill::<D, FULL, true, true>,
            (_, false, false) => fill::<D, MIXED, false, false>,
            (_, false, true) => fill::<D, MIXED, false, true>,
            (_, true, false) => fill::<D, MIXED, true, false>,
            (_, true, true) => fill::<D, MIXED, true, true>,
        };
        parallel::for_each_chunk(&mut forces, |first, rows| fill(self, &constants, first, rows));
        self.forces = forces;
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
                let velocities = [&self.shear[place], &other.velocity];
                sum.walls += wall_force([me, other], velocities, &neighbor, constants);
            }
        }
        sum
    }
}

/// Fills some rows, with or without the terms of the corrections, the artificial viscosity and
/// the shifting.
#[multiversion(targets("x86_64+avx2"))]
fn fill<const D: usize, const CORRECTS: u8, const ARTIFICIAL: bool, const CROWDING: bool>(
    scheme: &TransportVelocity<D>,
    constants: &Constants,
    first: usize,
    rows: &mut [Forces<D>],
) {
    let mut block = NeighborBlock::default();
    let has_walls = !scheme.walls.is_empty();
    for (offset, row) in rows.iter_mut().enumerate() {
        let place = first + offset;
        if scheme.support.list().is_passive(place) {
            *row = scheme.reaction_at(place, constants, &mut block);
            continue;
        }
        let sums = scheme.gather::<CORRECTS, ARTIFICIAL, CROWDING>(place, constants, &mut block);
        *row = sums.total::<ARTIFICIAL>(has_walls).forces(&scheme.sides[place]);
    }
}
