//! What all ranks do alike of all particles.

use super::{Common, WeaklyCompressible};

impl<const D: usize> WeaklyCompressible<D> {
    /// Lets `change` see and change a state of the particles of all ranks, which each of them does in the same way, and keeps
    /// what it makes of those of this rank and of what stands behind them. Nothing where a rank is lost.
    pub(super) fn on_whole<T: Default>(
        &mut self,
        common: &Common<D>,
        state: &mut [f64],
        change: impl FnOnce(&mut Self, &Common<D>, &mut [f64]) -> T,
    ) -> T {
        let Some(rows) = &common.rows else { return change(self, common, state) };
        let Some(parts) = common.team().parts_of_all(state) else { return T::default() };
        let mut whole = rows.whole(&parts);
        let result = change(self, common, &mut whole);
        state.copy_from_slice(&rows.part(common.team().rank(), &whole));
        result
    }
}
