//! What passes find of a particle, term by term.

use super::ledger::ACCELERATIONS;
use crate::Vector;

/// Rates of change of a particle's pressure, term by term, with those of its density, see
/// [`super`](crate::schemes::transport_velocity).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rates<T = f64> {
    /// `div u` in 1/s, or `div uhat`, as the corrections say.
    pub divergence: T,
    /// `d . grad p` in Pa/s.
    pub pressure_transport: T,
    /// Diffusion of the pressure in Pa/s.
    pub pressure_diffusion: T,
}

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
    /// `sum m_b W_ab` in kg/m^3 of all neighbours, where a fluid is shifted by (35).
    pub filling: f64,
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
            filling: 0.0,
        }
    }
}

impl<const D: usize> Forces<D> {
    /// The acceleration by all of them together, in m/s^2.
    pub fn total(&self) -> Vector<D> {
        self.terms().into_iter().sum()
    }

    /// The accelerations in the order of the ledger.
    pub(super) fn terms(&self) -> [&Vector<D>; ACCELERATIONS] {
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
