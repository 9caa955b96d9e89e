//! Integer powers by repeated squaring.

use crate::Number;

/// `base^exponent`, the same to the bit on every machine and free of loops where the exponent is
/// a constant; `powi` promises neither.
#[inline]
pub(crate) fn integer_power<T: Number>(base: T, exponent: u32) -> T {
    let mut remaining = exponent;
    let mut square = base;
    let mut product = T::one();
    while remaining > 0 {
        if remaining & 1 == 1 {
            product *= square;
        }
        remaining >>= 1;
        if remaining > 0 {
            square *= square;
        }
    }
    product
}
