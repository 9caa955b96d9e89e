//! The preconditioner of blocks on the diagonal.

use piola_formulas::tensor;

use super::{Local, Reduction};
use crate::{Tensor, Vector, parallel};

/// Inverses of the blocks that rows have on the diagonal of a tangent, in their own unknowns, and
/// of the entries there of unknowns that rows share.
#[derive(Clone, Debug, Default)]
pub(super) struct BlockJacobi<const D: usize> {
    inverses: Vec<Tensor<D>>,
    shared: Vec<(u32, f64)>,
}

impl<const D: usize> BlockJacobi<D> {
    /// Of blocks in the axes of space.
    pub fn new(reduction: &Reduction<D>, blocks: &[Tensor<D>]) -> Self {
        let mut holders = vec![0_u32; reduction.unknowns()];
        let mut sums = vec![0.0; holders.len()];
        let turned = |a: usize| reduction.frame(a).tr_mul(&(blocks[a] * reduction.frame(a)));
        for a in 0..blocks.len() {
            let block = turned(a);
            for (i, local) in reduction.locals(a).iter().enumerate() {
                if let &Local::Free(number) = local {
                    holders[number as usize] += 1;
                    sums[number as usize] += block[(i, i)];
                }
            }
        }
        let is_own = |local: &Local| match *local {
            Local::Free(number) => holders[number as usize] == 1,
            Local::Held => false,
        };
        let mut inverses = vec![Tensor::zeros(); blocks.len()];
        parallel::for_each_chunk(&mut inverses, |first, inverses| {
            for (offset, inverse) in inverses.iter_mut().enumerate() {
                let a = first + offset;
                let own = reduction.locals(a).each_ref().map(is_own);
                *inverse = inverse_of(&turned(a), &own);
            }
        });
        let shared = holders.iter().zip(&sums).enumerate().filter(|(_, (count, _))| **count > 1);
        let shared = shared.map(|(k, (_, sum))| (k as u32, 1.0 / sum.abs())).collect();
        Self { inverses, shared }
    }

    /// Applies the inverses in place.
    pub fn apply(&self, reduction: &Reduction<D>, vector: &mut [f64]) {
        for (a, block) in self.inverses.iter().enumerate() {
            let locals = reduction.locals(a);
            let own = |i: usize| match locals[i] {
                Local::Free(number) => vector[number as usize],
                Local::Held => 0.0,
            };
            let scaled = block * Vector::<D>::from_fn(|i, _| own(i));
            for (i, local) in locals.iter().enumerate() {
                if let &Local::Free(number) = local
                    && block[(i, i)] != 0.0
                {
                    vector[number as usize] = scaled[i];
                }
            }
        }
        self.shared.iter().for_each(|&(number, inverse)| vector[number as usize] *= inverse);
    }
}

/// Inverse of a block in its own components, zero elsewhere; of its diagonal where that is not
/// positive definite.
fn inverse_of<const D: usize>(block: &Tensor<D>, own: &[bool; D]) -> Tensor<D> {
    let masked = Tensor::<D>::from_fn(|i, j| match (own[i] && own[j], i == j) {
        (true, _) => 0.5 * (block[(i, j)] + block[(j, i)]),
        (false, true) => 1.0,
        (false, false) => 0.0,
    });
    let is_definite = tensor::smallest_eigenvalue(&masked) > 0.0;
    let inverse = is_definite.then(|| tensor::inverse(&masked)).flatten();
    let diagonal = || Tensor::from_diagonal(&masked.diagonal().map(|d| 1.0 / d.abs()));
    let inverse = inverse.unwrap_or_else(diagonal);
    Tensor::from_fn(|i, j| if own[i] && own[j] { inverse[(i, j)] } else { 0.0 })
}
