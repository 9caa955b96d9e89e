//! Recorded laws have the bits of the functions they were recorded of, here and as compiled text.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod bits;
mod compiled;
mod devices;
mod functions;
mod lists;
mod rows;
mod text;

/// Numbers in [0, 1) that are the same on every machine.
pub fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Fails with the first numbers whose bits differ.
pub fn assert_bits(name: &str, got: &[f64], expected: &[f64], inputs: &[f64]) {
    let bits = |numbers: &[f64]| -> Vec<u64> {
        // Which of the many NaN it is does not matter.
        numbers.iter().map(|x| if x.is_nan() { f64::NAN } else { *x }.to_bits()).collect()
    };
    assert_eq!(bits(got), bits(expected), "{name} of {inputs:?}: {got:?}, not {expected:?}");
}
