//! What laws of one particle read from the numbers of a pass.

use nalgebra::{SMatrix, SVector};
use piola_device::Traced;
use piola_formulas::Number;

use crate::schemes::Health;
use crate::schemes::look::{Most, judged};

/// A vector of numbers that are recorded.
pub(crate) type Recorded<const D: usize> = SVector<Traced, D>;

/// Takes a vector from the front of some numbers.
pub(crate) fn take<const D: usize>(numbers: &mut &[Traced]) -> Recorded<D> {
    let (own, rest) = numbers.split_at(D);
    *numbers = rest;
    SVector::from_column_slice(own)
}

/// Takes a number from the front.
pub(crate) fn one(numbers: &mut &[Traced]) -> Traced {
    let (own, rest) = numbers.split_at(1);
    *numbers = rest;
    own[0]
}

/// Takes a tensor from the front, row by row.
pub(crate) fn tensor<const D: usize>(numbers: &mut &[Traced]) -> SMatrix<Traced, D, D> {
    let (own, rest) = numbers.split_at(D * D);
    *numbers = rest;
    SMatrix::from_row_slice(own)
}

/// The numbers of a tensor, row by row.
pub(crate) fn entries<const D: usize>(tensor: &SMatrix<Traced, D, D>) -> Vec<Traced> {
    (0..D * D).map(|k| tensor[(k / D, k % D)]).collect()
}

/// What the kind of a particle makes of something, as `of` does for the number of a kind: the first one, or that of
/// `kind` among so many.
pub(crate) fn by_kind<const K: usize>(
    kinds: usize,
    kind: Option<Traced>,
    of: impl Fn(usize) -> [Traced; K],
) -> [Traced; K] {
    let first = of(0);
    let Some(kind) = kind else { return first };
    (1..kinds).fold(first, |before, number| {
        let (own, is_own) = (of(number), kind.above(number as f64 - 0.5));
        std::array::from_fn(|k| Traced::select(is_own, own[k], before[k]))
    })
}

/// The square of a length.
pub(crate) fn square<const D: usize>(vector: &Recorded<D>) -> Traced {
    vector.dot(vector)
}

/// Whether all of some numbers are finite.
pub(crate) fn are_finite(numbers: &[Traced]) -> <Traced as Number>::Mask {
    let finite = |number: &Traced| number.abs().at_most(Traced::from(f64::MAX));
    let (first, rest) = numbers.split_first().expect("there are numbers to look at");
    rest.iter().fold(finite(first), |all, number| all & finite(number))
}

/// What a look over a state has found largest: whether something is not finite, the squared speed, the speed of waves,
/// the negative volume ratio and the mismatch, and the figures of the formulation, which are no less than `least`.
pub(crate) fn sighted<const N: usize>(
    all: &[(f64, usize)],
    least: [f64; N],
) -> (Health, [Most; N]) {
    let most = |&(value, particle): &(f64, usize)| match value > f64::NEG_INFINITY {
        true => Most { value, particle },
        false => Most::NOTHING,
    };
    let first = (all[0].0 > 0.0).then_some(all[0].1);
    let common = std::array::from_fn(|k| most(&all[1 + k]));
    let own = std::array::from_fn(|k| most(&all[5 + k]));
    judged(first, common, own, least)
}
