//! Direct solution by sparse `L D L^T`.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::ldlt::factor::{LdltParams, LdltRegularization};
use faer::perm::PermRef;
use faer::prelude::default;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};
use sysinfo::System;
use thiserror::Error;

use super::SparseMatrix;

/// The factors of a symmetric matrix on a fixed pattern.
///
/// On one thread: the result is the same for any number of them, and small systems are faster.
pub struct Factor {
    symbolic: Arc<SymbolicCholesky<usize>>,
    /// Nothing of a copy that has not taken a matrix apart.
    room: Option<Room>,
    request: StackReq,
}

/// The factors, and scratch.
struct Room {
    values: Vec<f64>,
    memory: MemBuffer,
}

/// The copy knows the pattern, and has no factors.
impl Clone for Factor {
    fn clone(&self) -> Self {
        Self { symbolic: Arc::clone(&self.symbolic), room: None, request: self.request }
    }
}

/// A matrix that cannot be taken apart.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FactorError {
    /// There is not enough memory, by the number of entries that the factors will have.
    #[error(
        "the factors of {unknowns} unknowns take {:.2} GB, and {:.2} GB are free: set \
         `time.linear_solver = \"krylov\"`, or take fewer particles",
        *needed as f64 / 1e9,
        *free as f64 / 1e9
    )]
    Memory {
        /// Rows of the matrix.
        unknowns: usize,
        /// Bytes that are needed.
        needed: u64,
        /// Bytes that are free.
        free: u64,
    },
    /// A pivot is zero or not a number.
    #[error("the matrix is singular: pivot {index} vanishes or is not a number")]
    Singular {
        /// Number of the unknown.
        index: usize,
    },
}

impl Factor {
    /// Finds where the factors of matrices with the pattern of `matrix` have entries. The order of
    /// the unknowns is kept: number them by [`dissect`](super::dissect).
    ///
    /// # Errors
    /// [`FactorError::Memory`], before that memory is taken.
    pub fn new(matrix: &SparseMatrix) -> Result<Self, FactorError> {
        Self::within(free_memory(), matrix)
    }

    /// The same where this many bytes are free.
    fn within(free: u64, matrix: &SparseMatrix) -> Result<Self, FactorError> {
        let unknowns = matrix.len();
        let too_much = |needed: u64| FactorError::Memory { unknowns, needed, free };
        let (offsets, rows, _) = matrix.parts();
        let pattern = SymbolicSparseColMatRef::new_checked(unknowns, unknowns, offsets, None, rows);
        // The order is that of the unknowns. It is given as a permutation because the analysis of
        // `SymmetricOrdering::Identity` does not find the elimination tree of a lower triangle.
        let order: Vec<usize> = (0..unknowns).collect();
        let order = PermRef::new_checked(&order, &order, unknowns);
        let symbolic = factorize_symbolic_cholesky(
            pattern,
            Side::Lower,
            SymmetricOrdering::Custom(order),
            CholeskySymbolicParams::default(),
        )
        .map_err(|_| too_much(size_of_val(rows) as u64))?;
        let request = symbolic
            .factorize_numeric_ldlt_scratch::<f64>(Par::Seq, parameters())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let mut factor = Self { symbolic: Arc::new(symbolic), room: None, request };
        factor.make_room(free)?;
        Ok(factor)
    }

    /// Takes the memory for the factors, if there is none yet and this many bytes are free.
    fn make_room(&mut self, free: u64) -> Result<&mut Room, FactorError> {
        let room = match self.room.take() {
            Some(room) => room,
            None => {
                let (unknowns, length) = (self.symbolic.nrows(), self.symbolic.len_val());
                let needed = (length * size_of::<f64>() + self.request.size_bytes()) as u64;
                let too_much = || FactorError::Memory { unknowns, needed, free };
                if needed > free {
                    return Err(too_much());
                }
                let memory = MemBuffer::try_new(self.request).map_err(|_| too_much())?;
                let mut values = Vec::new();
                values.try_reserve_exact(length).map_err(|_| too_much())?;
                values.resize(length, 0.0);
                Room { values, memory }
            }
        };
        Ok(self.room.insert(room))
    }

    /// Takes a matrix with the pattern apart and returns how many pivots are negative: as many as
    /// the matrix has negative eigenvalues.
    ///
    /// # Errors
    /// [`FactorError::Singular`].
    pub fn factorise(&mut self, matrix: &SparseMatrix) -> Result<usize, FactorError> {
        let (offsets, rows, values) = matrix.parts();
        let unknowns = matrix.len();
        let pattern = SymbolicSparseColMatRef::new_checked(unknowns, unknowns, offsets, None, rows);
        let matrix = SparseColMatRef::new(pattern, values);
        let free = if self.room.is_some() { u64::MAX } else { free_memory() };
        let symbolic = Arc::clone(&self.symbolic);
        let Room { values, memory } = self.make_room(free)?;
        let stack = MemStack::new(memory);
        symbolic
            .factorize_numeric_ldlt(
                values,
                matrix,
                Side::Lower,
                LdltRegularization::default(),
                Par::Seq,
                stack,
                parameters(),
            )
            .map_err(|faer::linalg::cholesky::ldlt::factor::LdltError::ZeroPivot { index }| {
                FactorError::Singular { index }
            })?;
        let (mut negative, mut broken) = (0, None);
        self.pivots(|index, pivot| {
            if !(pivot != 0.0 && pivot.is_finite()) {
                broken.get_or_insert(index);
            }
            negative += usize::from(pivot < 0.0);
        });
        broken.map_or(Ok(negative), |index| Err(FactorError::Singular { index }))
    }

    /// Solves in place, with the factors of the last matrix.
    pub fn solve(&mut self, right: &mut [f64]) {
        let unknowns = right.len();
        let Some(Room { values, memory }) = &mut self.room else { return };
        let stack = MemStack::new(memory);
        let right = MatMut::from_column_major_slice_mut(right, unknowns, 1);
        let factors = LdltRef::new(&self.symbolic, values);
        factors.solve_in_place_with_conj(Conj::No, right, Par::Seq, stack);
    }

    /// Entries of the factor L.
    pub fn entries(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Shows all entries of D.
    fn pivots(&self, mut see: impl FnMut(usize, f64)) {
        let Some(Room { values, .. }) = &self.room else { return };
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(factor) => {
                let starts = &factor.col_ptr()[..factor.ncols()];
                starts.iter().enumerate().for_each(|(index, &at)| see(index, values[at]));
            }
            SymbolicCholeskyRaw::Supernodal(factor) => {
                for node in 0..factor.n_supernodes() {
                    let first = factor.supernode_begin()[node];
                    let columns = factor.supernode_end()[node] - first;
                    let rows = columns + factor.supernode(node).pattern().len();
                    let start = factor.col_ptr_for_val()[node];
                    (0..columns).for_each(|j| see(first + j, values[start + j * rows + j]));
                }
            }
        }
    }
}

fn parameters() -> Spec<LdltParams, f64> {
    default()
}

/// Bytes of free memory; there is no bound where the system does not report it.
fn free_memory() -> u64 {
    let mut system = System::new();
    system.refresh_memory();
    let free = system.available_memory();
    let of_group = system.cgroup_limits().map_or(u64::MAX, |limits| limits.free_memory);
    if free == 0 { u64::MAX } else { free.min(of_group) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of unknowns, each coupled to the next.
    #[test]
    fn what_does_not_fit_is_refused_beforehand() {
        let columns = (0..1000).map(|k| if k == 999 { vec![k] } else { vec![k, k + 1] });
        let matrix = SparseMatrix::of_columns(columns);
        let factor = Factor::new(&matrix).expect("it is small");
        assert!(factor.entries() >= 1999, "{}", factor.entries());
        let error = Factor::within(1000, &matrix).err().expect("it does not fit");
        let FactorError::Memory { unknowns: 1000, needed, free: 1000 } = error else {
            panic!("{error}")
        };
        assert!(needed >= 8 * 1999, "{needed}");
        assert!(error.to_string().contains("`time.linear_solver = \"krylov\"`"), "{error}");
    }
}
