//! The inverse of a root without a root and without a division.

/// Half of the bits of a number from this are those of the inverse of its root to 3.5 %.
const GUESS: u64 = 0x5fe6_eb50_c7b5_37a9;

/// Corrections by Newton's method: they leave 2e-3, 5e-6, 3e-11 and round-off.
const CORRECTIONS: usize = 4;

/// `1 / sqrt(square)` of a normal positive number, to one or two units in the last place.
///
/// Products only, so that a loop over squares is bound by how many of these a processor does at a time:
/// roots and divisions are done a few at a time. Each is exactly rounded, so that all processors agree.
#[inline(always)]
pub(super) fn inverse_root(square: f64) -> f64 {
    let half = 0.5 * square;
    let mut root = f64::from_bits(GUESS - (square.to_bits() >> 1));
    for _ in 0..CORRECTIONS {
        root *= 1.5 - half * root * root;
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_roots_are_right_to_two_units_in_the_last_place() {
        let mut worst = 0.0_f64;
        for step in 0..200_000 {
            // Over all exponents of lengths, and all mantissas.
            let square = 10f64.powf(-60.0 + 0.0006 * f64::from(step));
            let error = inverse_root(square) * square.sqrt() - 1.0;
            worst = worst.max(error.abs());
        }
        assert!(worst < 2.5 * f64::EPSILON, "{worst:e}");
        assert_eq!(inverse_root(4.0), 0.5);
    }
}
