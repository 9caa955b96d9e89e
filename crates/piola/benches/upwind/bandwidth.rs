//! How fast memory can be read at all.

use std::hint::black_box;

use rayon::prelude::*;

use crate::clock;

/// Largest array of the probe in bytes.
const LARGEST: usize = 1 << 30;

/// Bytes a second at which the threads at hand read an array of `bytes` bytes from its begin to
/// its end, again and again: as the data of a problem of this size, it comes from the cache that
/// it fits into, or from memory.
pub fn read_rate(bytes: usize) -> f64 {
    let numbers = vec![1_u64; bytes.clamp(1 << 16, LARGEST) / size_of::<u64>()];
    let part = numbers.len().div_ceil(rayon::current_num_threads());
    let sum = |part: &[u64]| part.iter().fold(0_u64, |sum, number| sum.wrapping_add(*number));
    let seconds = clock::best_time(|| {
        let numbers = black_box(&numbers);
        black_box(numbers.par_chunks(part).map(sum).reduce(|| 0, u64::wrapping_add));
    });
    size_of_val(numbers.as_slice()) as f64 / seconds
}
