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
        // Where the numbers of a particle stand in the columns of `count` of them.
        let numbers_of = |row: usize, count: usize| {
            FIELDS.iter().flat_map(move |field| {
                let column = column(&FIELDS, D, count, field);
                let components = column.len() / count;
                (0..components).map(move |k| column.start + row * components + k)
            })
        };
        let (count, all, wide) = (common.count(), common.particles.len(), width(&FIELDS, D));
        // What a rank tells is its particles one after another, and a state has column after column.
        let rows = |from: &[f64], count: usize| {
            let numbers = (0..count).flat_map(|row| numbers_of(row, count));
            numbers.map(|number| from[number]).collect::<Vec<f64>>()
        };
        let mut told = common.team().rows_of_all(rows(state, count));
        // Where a rank is lost, nothing that follows counts.
        told.resize(all * wide, 0.0);
        let mut whole = vec![0.0; all * wide];
        let numbers = (0..all).flat_map(|row| numbers_of(row, all));
        numbers.zip(&told).for_each(|(number, told)| whole[number] = *told);
        whole.extend_from_slice(&state[count * wide..]);
        let result = change(self, common, &mut whole);
        for row in 0..count {
            let of_all = numbers_of(common.first() + row, all);
            numbers_of(row, count).zip(of_all).for_each(|(own, of_all)| state[own] = whole[of_all]);
        }
        state[count * wide..].copy_from_slice(&whole[all * wide..]);
        result
    }
}
