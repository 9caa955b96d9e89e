//! Sums that do not depend on the order of their terms.

/// Number of limbs of an [`Exact`] sum.
pub const LIMBS: usize = 68;

/// The sum of any numbers, without rounding.
#[derive(Clone, Debug)]
pub struct Exact {
    limbs: [i64; LIMBS],
}
