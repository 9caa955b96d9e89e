//! The start of a run: velocity and prestress.

/// Initial values of the particles of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Initial<const D: usize> {
    /// Velocity of each particle in m/s.
    pub velocity: Vec<crate::Vector<D>>,
    /// Pressure of each particle in Pa that the reference configuration is under, for example
    /// the hydrostatic one. The material is then `psi(J0 J) / J0` with `p(J0)` this
    /// pressure, theory (7).
    pub pressure: Vec<f64>,
}
