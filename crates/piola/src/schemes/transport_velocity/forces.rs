//! The accelerations.

use piola_formulas::fluid;
use piola_formulas::pairs::fluid::{
    FULL, ForceConstants, ForceSums, Forces as Law, MIXED, NONE, Wall, WallForces,
};

use super::{ACCELERATING, Dilatation, Shifting, Side, TransportVelocity};
use crate::Vector;
use crate::operators::{Among, Term, gather};

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

    /// The accelerations in the order of [`ACCELERATING`].
    pub(super) fn terms(&self) -> [&Vector<D>; ACCELERATING.len()] {
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
    /// The accelerations of a particle with these sums, without body forces.
    fn new(sums: &ForceSums<f64, D>, me: &Side<D>) -> Self {
        Self {
            pressure: sums.pressure,
            viscosity: sums.viscosity,
            artificial_viscosity: sums.artificial_viscosity,
            transport: me.velocity * sums.stretch + sums.carried,
            walls: sums.walls,
            body_force: Vector::zeros(),
            crowding: sums.crowding,
            opening: -sums.volume,
        }
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// Fills `forces` from the sides, without body forces. On wall particles it is the reaction
    /// of the fluid.
    pub(super) fn force_pass(&mut self) {
        if self.solids.is_some() {
            return self.solid_force_pass();
        }
        let mut forces = std::mem::take(&mut self.forces);
        let (constants, kind) = self.force_law();
        let fill = match kind {
            (NONE, false, false) => Self::gather_forces::<NONE, false, false>,
            (NONE, false, true) => Self::gather_forces::<NONE, false, true>,
            (NONE, true, false) => Self::gather_forces::<NONE, true, false>,
            (NONE, true, true) => Self::gather_forces::<NONE, true, true>,
            (FULL, false, false) => Self::gather_forces::<FULL, false, false>,
            (FULL, false, true) => Self::gather_forces::<FULL, false, true>,
            (FULL, true, false) => Self::gather_forces::<FULL, true, false>,
            (FULL, true, true) => Self::gather_forces::<FULL, true, true>,
            (_, false, false) => Self::gather_forces::<MIXED, false, false>,
            (_, false, true) => Self::gather_forces::<MIXED, false, true>,
            (_, true, false) => Self::gather_forces::<MIXED, true, false>,
            (_, true, true) => Self::gather_forces::<MIXED, true, true>,
        };
        fill(self, constants, &mut forces);
        if !self.walls.is_empty() {
            self.react(&constants, &mut forces);
        }
        self.forces = forces;
    }

    /// The constants of the law between particles of a fluid, and which one it is: its corrections,
    /// whether there is artificial viscosity, whether particles are shifted by SPST.
    pub(super) fn force_law(&self) -> (ForceConstants, (u8, bool, bool)) {
        let h = self.support.smoothing_length();
        let corrections = &self.settings.corrections;
        let one_if = |is_on: bool| f64::from(u8::from(is_on));
        let crowding = match self.settings.shifting {
            Shifting::Sun { .. } => Some(1.0 / self.value_at_spacing(h)),
            _ => None,
        };
        let constants = ForceConstants {
            softening: fluid::softening(h),
            viscosity: self.fluid.viscosity,
            artificial: self.settings.artificial_viscosity * h * self.fluid.wave_speed,
            stress: one_if(corrections.stress),
            dilatation: one_if(corrections.dilatation == Dilatation::Deviation),
            transport: one_if(corrections.dilatation == Dilatation::Transport),
            crowding: crowding.unwrap_or(0.0),
        };
        let kind = match (corrections.stress, corrections.dilatation) {
            (false, Dilatation::None) => NONE,
            (true, Dilatation::Deviation) => FULL,
            _ => MIXED,
        };
        (constants, (kind, constants.artificial > 0.0, crowding.is_some()))
    }

    fn gather_forces<const CORRECTS: u8, const ARTIFICIAL: bool, const CROWDING: bool>(
        &self,
        constants: ForceConstants,
        forces: &mut [Forces<D>],
    ) {
        let law = Law::<D, CORRECTS, ARTIFICIAL, CROWDING>(constants);
        let (sides, shear) = (self.sides.as_slice(), self.shear.as_slice());
        let fluid = Term { law, source: sides, among: Among::Active };
        let walls = Term { law: WallForces(law), source: (sides, shear), among: Among::Passive };
        let close = |place: usize, sums: &_, row: &mut _| *row = Forces::new(sums, &sides[place]);
        gather(&self.support, &(fluid, walls), forces, |place| self.active(place), close);
    }

    /// The forces of the fluid on wall particles, over their mass: what they do to the fluid, turned
    /// round.
    fn react(&self, constants: &ForceConstants, forces: &mut [Forces<D>]) {
        let ForceConstants { softening, viscosity, .. } = *constants;
        let law = Wall::<D> { softening, viscosity };
        let source = (self.sides.as_slice(), self.shear.as_slice());
        let sum = Term { law, source, among: Among::Active };
        let close = |_: usize, walls: &Vector<D>, row: &mut _| {
            *row = Forces { walls: *walls, ..Forces::default() };
        };
        gather(&self.support, &sum, forces, |place| self.passive(place), close);
    }

    /// A place, if the particle there is not passive.
    pub(super) fn active(&self, place: usize) -> Option<usize> {
        (!self.support.list().is_passive(place)).then_some(place)
    }

    /// A place, if the particle there is passive: of a wall, or removed.
    pub(super) fn passive(&self, place: usize) -> Option<usize> {
        self.support.list().is_passive(place).then_some(place)
    }
}
