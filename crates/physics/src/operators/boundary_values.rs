//! Ghost values with which an SPH sum takes a prescribed value on a boundary.

use thiserror::Error;

use super::sparse::SparseOperator;
use crate::solve::{Factor, FactorError, SparseMatrix, irregular};

/// The residual over the largest value at which the refinement of a solution stops.
const ROUNDING: f64 = 1e-14;

/// Most corrections of a solution by its residual: factors without exchange of rows may need some.
const MOST_CORRECTIONS: usize = 20;

/// Vectors with which the norm of an inverse is looked for.
const MOST_TRIALS: usize = 5;

/// Condition numbers from which on ghost values overshoot by more than the noise of a result: values
/// of one become -125 to 158 at 1e5.
pub const POOR_CONDITION: f64 = 1e3;

/// Boundary values that cannot be met.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BoundaryValueError {
    /// No ghost changes the sum at the boundary.
    #[error(
        "no ghost changes the sum at particle {particle}: with ghosts on both sides gradients of \
         the cover cancel; use ghosts on one side, or a wider cover"
    )]
    NoGhost {
        /// Index of the particle in memory.
        particle: u32,
    },
    /// The modified SPH matrix has no factors.
    #[error(
        "the modified SPH matrix of {unknowns} values has no solution: {source}; use a narrower cover"
    )]
    Matrix {
        /// Rows of the matrix.
        unknowns: usize,
        /// Why.
        source: FactorError,
    },
    /// Solutions do not settle.
    #[error(
        "boundary values are met to {left:.1e} only, as the modified SPH matrix has a condition \
         number of {condition:.1e}; use a narrower cover, in 2D at most 2.5 spacings"
    )]
    Unsettled {
        /// What is left of the values, over the largest.
        left: f64,
        /// Estimate of the condition number.
        condition: f64,
    },
}

/// What ghosts are raised by, in one dimension, for a sum at a particle to take a value:
/// `f_g += eta W_bg` with `eta = (f_b - <f>_b) / sum_g a_bg W_bg`, theory (61).
///
/// With a the coefficients of W this is Elastodynamics (2.42), with those of X (2.45). Sums are over
/// ghosts only: as printed they are over all particles, and the second one is then exactly zero.
///
/// # Errors
/// [`BoundaryValueError::NoGhost`] where ghosts do not change the sum.
pub fn raise_ghosts(
    sum: &SparseOperator,
    shape: &SparseOperator,
    particle: u32,
    ghosts: &[u32],
    wanted: f64,
    field: &mut [f64],
) -> Result<f64, BoundaryValueError> {
    let row = particle as usize;
    let share = |ghost: &u32| sum.entry(row, *ghost) * shape.entry(row, *ghost);
    let denominator: f64 = ghosts.iter().map(share).sum();
    let largest: f64 = ghosts.iter().map(|ghost| share(ghost).abs()).sum();
    if !(denominator.abs() > 1e-12 * largest) {
        return Err(BoundaryValueError::NoGhost { particle });
    }
    let own: f64 = sum.row(row).map(|(column, value)| value * field[column as usize]).sum();
    let eta = (wanted - own) / denominator;
    for &ghost in ghosts {
        field[ghost as usize] += eta * shape.entry(row, ghost);
    }
    Ok(eta)
}

/// The modified SPH matrix of Elastodynamics (2.46), factorised once: values on the boundary and on
/// ghosts, S, for which the sums there are what is prescribed, `W_SS f_S = fbar_S - W_SI f_I`, theory
/// (62).
///
/// The paper prints W_BB for W_GG, and leaves the second term on the right away, with which alone the
/// sums with particles inside meet the values.
pub struct ModifiedMatrix {
    /// W on all particles.
    value: SparseOperator,
    /// S, ascending.
    selected: Vec<u32>,
    /// Scale of each of S with which W_SS is symmetric.
    root: Vec<f64>,
    factor: Factor,
    condition: f64,
}

impl ModifiedMatrix {
    /// Takes W apart on `selected`, boundary and ghosts, with the kernel weights `V` of all.
    ///
    /// # Errors
    /// [`BoundaryValueError::Matrix`] for a matrix without an inverse.
    pub fn new(
        value: &SparseOperator,
        selected: &[u32],
        weight: &[f64],
    ) -> Result<Self, BoundaryValueError> {
        let mut selected = selected.to_vec();
        selected.sort_unstable();
        selected.dedup();
        let unknowns = selected.len();
        // `W_pq V_q` is symmetric times sqrt(V_p/V_q).
        let root: Vec<f64> = selected.iter().map(|&p| weight[p as usize].sqrt()).collect();
        let column = |j: usize| -> Vec<(usize, f64)> {
            let row = value.row(selected[j] as usize);
            row.filter_map(|(q, entry)| {
                let i = selected.binary_search(&q).ok()?;
                (i >= j).then(|| (i, entry * root[j] / root[i]))
            })
            .collect()
        };
        let columns: Vec<_> = (0..unknowns).map(column).collect();
        let rows = columns.iter().map(|column| column.iter().map(|(row, _)| *row).collect());
        let mut matrix = SparseMatrix::of_columns(rows);
        matrix.set_values(columns.iter().flatten().map(|(_, value)| *value).collect());
        let refuse = |source| BoundaryValueError::Matrix { unknowns, source };
        let mut factor = Factor::new(&matrix).map_err(refuse)?;
        factor.factorise(&matrix).map_err(refuse)?;
        let norm = largest_column(&columns, unknowns);
        let condition = norm * inverse_norm(&mut factor, unknowns);
        Ok(Self { value: value.clone(), selected, root, factor, condition })
    }

    /// Estimate of the condition number in the 1-norm, from below, seldom by more than a factor of
    /// three.
    pub fn condition(&self) -> f64 {
        self.condition
    }

    /// Number of values on the boundary and on ghosts.
    pub fn len(&self) -> usize {
        self.selected.len()
    }

    /// Whether there is no boundary.
    pub fn is_empty(&self) -> bool {
        self.selected.is_empty()
    }

    /// Changes the values on boundary and ghosts in `field` so that its interpolation there is
    /// `wanted`, one a particle in ascending order.
    ///
    /// # Errors
    /// [`BoundaryValueError::Unsettled`] if it is not met to 1e-12 of the largest value.
    pub fn impose(&mut self, wanted: &[f64], field: &mut [f64]) -> Result<(), BoundaryValueError> {
        let largest = wanted.iter().fold(f64::MIN_POSITIVE, |largest, f| largest.max(f.abs()));
        let mut left = f64::INFINITY;
        for _ in 0..MOST_CORRECTIONS {
            let mut residual: Vec<f64> = (self.selected.iter().zip(wanted))
                .map(|(&p, wanted)| {
                    let row = self.value.row(p as usize);
                    wanted - row.map(|(q, entry)| entry * field[q as usize]).sum::<f64>()
                })
                .collect();
            let before = left;
            left = residual.iter().fold(0.0_f64, |left, r| left.max(r.abs())) / largest;
            if left <= ROUNDING || (left <= 1e-12 && left > 0.5 * before) {
                return Ok(());
            }
            residual.iter_mut().zip(&self.root).for_each(|(r, root)| *r *= root);
            self.factor.solve(&mut residual);
            for ((&p, change), root) in self.selected.iter().zip(&residual).zip(&self.root) {
                field[p as usize] += change / root;
            }
        }
        match left <= 1e-12 {
            true => Ok(()),
            false => Err(BoundaryValueError::Unsettled { left, condition: self.condition }),
        }
    }
}

/// The 1-norm of a symmetric matrix of which the lower triangle is known by columns.
fn largest_column(columns: &[Vec<(usize, f64)>], size: usize) -> f64 {
    let mut sums = vec![0.0; size];
    for (j, column) in columns.iter().enumerate() {
        for &(i, value) in column {
            sums[j] += value.abs();
            if i != j {
                sums[i] += value.abs();
            }
        }
    }
    sums.into_iter().fold(0.0, f64::max)
}

/// Estimate of the 1-norm of the inverse of a symmetric matrix by Hager's method.
fn inverse_norm(factor: &mut Factor, size: usize) -> f64 {
    let sum = |vector: &[f64]| vector.iter().map(|entry| entry.abs()).sum::<f64>();
    let mut trial: Vec<f64> = (0..size).map(irregular).collect();
    let scale = sum(&trial);
    trial.iter_mut().for_each(|entry| *entry /= scale);
    let mut best = 0.0_f64;
    for _ in 0..MOST_TRIALS {
        let mut solution = trial.clone();
        factor.solve(&mut solution);
        let norm = sum(&solution);
        if !(norm > best) {
            break;
        }
        best = norm;
        let mut signs: Vec<f64> = solution.iter().map(|entry| 1.0_f64.copysign(*entry)).collect();
        factor.solve(&mut signs);
        let by_size = |&a: &usize, &b: &usize| signs[a].abs().total_cmp(&signs[b].abs());
        let Some(largest) = (0..size).max_by(by_size) else { break };
        trial = vec![0.0; size];
        trial[largest] = 1.0;
    }
    best
}
