//! The pass that finds slopes for the reconstruction at mid-edges, Upwind (3.50) to (3.53).

use std::ops::Mul;

use nalgebra::{SMatrix, SVector};
use piola_formulas::Number;
use piola_formulas::pairs::Periods;
use piola_formulas::pairs::upwind::{Slope, Slopes, UpwindSlope};

use super::Upwind;
use crate::operators::{Among, Term, gather};

impl<const D: usize> Upwind<D> {
    /// How far it is round the box.
    pub(super) fn periods(&self) -> Periods<D> {
        Periods::new(self.support.domain.periods())
    }

    /// Fills the slopes from the sides of the local pass, if the formulation reconstructs.
    pub(super) fn slope_pass(&mut self) {
        let Some(least_squares) = &self.least_squares else { return };
        let law = Slopes(self.periods());
        let sum = Term { law, source: &*self.sides, among: Among::All };
        let count = self.particles.len();
        gather(&self.areas.pairs, &sum, &mut self.slopes[..count], Some, |a, moments, slope| {
            *slope = solved(moments, least_squares.inverse(a));
        });
        self.team.refresh_records::<UpwindSlope<D>>(&mut self.slopes, count);
    }
}

/// The slope of these moments.
pub(super) fn solved<T, I: Copy, const D: usize>(
    moments: &Slope<T, D>,
    inverse: &SMatrix<I, D, D>,
) -> Slope<T, D>
where
    T: Number + Mul<I, Output = T>,
{
    let along = |row: &dyn Fn(usize) -> T, j: usize| {
        let mut sum = row(0) * inverse[(0, j)];
        for k in 1..D {
            sum += row(k) * inverse[(k, j)];
        }
        sum
    };
    Slope {
        velocity: SMatrix::from_fn(|i, j| along(&|k| moments.velocity[(i, k)], j)),
        // The inverse is symmetric.
        pressure: SVector::from_fn(|j, _| along(&|k| moments.pressure[k], j)),
    }
}
