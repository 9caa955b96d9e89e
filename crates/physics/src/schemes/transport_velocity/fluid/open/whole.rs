//! What all ranks do alike of all particles.

use super::super::FIELDS;
use super::{Common, WeaklyCompressible};
use crate::fields::{column, width};

impl<const D: usize> WeaklyCompressible<D> {
    /// Lets `change` see and change a state of the particles of all ranks, which each of them does in the same way, and keeps
    /// what it makes of those of this rank and of what stands behind them.
    pub(super) fn on_whole<T>(
        &mut self,
        common: &Common<D>,
        state: &mut [f64],
        change: impl FnOnce(&mut Self, &Common<D>, &mut [f64]) -> T,
    ) -> T {
        if common.team().is_alone() {
            return change(self, common, state);
        }
        let (count, all, wide) = (common.count(), common.particles.len(), width(&FIELDS, D));
        let own = |field| column(&FIELDS, D, count, field);
        let mut whole = Vec::with_capacity(all * wide + state.len() - count * wide);
        for field in &FIELDS {
            whole.extend(common.team().rows_of_all(state[own(field)].to_vec()));
        }
        // Where a rank is lost, nothing that follows counts.
        whole.resize(all * wide, 0.0);
        whole.extend_from_slice(&state[count * wide..]);
        let result = change(self, common, &mut whole);
        for field in &FIELDS {
            let components = own(field).len() / count.max(1);
            let first = column(&FIELDS, D, all, field).start + common.first() * components;
            let length = own(field).len();
            state[own(field)].copy_from_slice(&whole[first..first + length]);
        }
        state[count * wide..].copy_from_slice(&whole[all * wide..]);
        result
    }
}
