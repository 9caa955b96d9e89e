//! Loops over particles on all threads, with results that do not depend on their number.
//!
//! A loop is cut into chunks of a fixed length. Each chunk writes its own rows; sums are taken
//! chunk by chunk and then over the chunks in order. Neither depends on the number of threads,
//! so results are the same to the bit.

use rayon::prelude::*;

/// Particles a chunk. Long enough that handing it to a thread costs nothing, short enough that
/// many threads share small problems.
pub const CHUNK: usize = 1024;

/// Calls `body(first, rows)` for chunks of `rows`, where `first` is the number of the first row.
pub fn for_each_chunk<T: Send>(rows: &mut [T], body: impl Fn(usize, &mut [T]) + Sync) {
    if rows.len() <= CHUNK {
        return body(0, rows);
    }
    rows.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, rows)| body(chunk * CHUNK, rows));
}

/// Calls `body(first, rows, others)` for chunks of `rows` and of the `others` beside them.
pub fn for_each_pair_of_chunks<T: Send, U: Send>(
    rows: &mut [T],
    others: &mut [U],
    body: impl Fn(usize, &mut [T], &mut [U]) + Sync,
) {
    for_each_part(rows.len(), (rows, others), |first, (rows, others)| body(first, rows, others));
}

/// Writes `from` to `to`, of the same length.
pub fn copy<T: Copy + Send + Sync>(to: &mut [T], from: &[T]) {
    for_each_chunk(to, |first, to| to.copy_from_slice(&from[first..][..to.len()]));
}

/// Arrays beside each other that can be cut at a particle.
pub trait Parts: Send + Sized {
    /// Those of the first `middle` particles, and the rest.
    fn split(self, middle: usize) -> (Self, Self);
}

impl<T: Send> Parts for &mut [T] {
    fn split(self, middle: usize) -> (Self, Self) {
        self.split_at_mut(middle)
    }
}

impl<A: Parts, B: Parts> Parts for (A, B) {
    fn split(self, middle: usize) -> (Self, Self) {
        let ((a, later_a), (b, later_b)) = (self.0.split(middle), self.1.split(middle));
        ((a, b), (later_a, later_b))
    }
}

/// An array with one entry for each chunk of particles.
pub struct PerChunk<'a, T>(pub &'a mut [T]);

impl<T: Send> Parts for PerChunk<'_, T> {
    fn split(self, middle: usize) -> (Self, Self) {
        let (own, later) = self.0.split_at_mut(middle / CHUNK);
        (Self(own), Self(later))
    }
}

/// Calls `body(first, parts)` for chunks of the arrays of `count` particles.
pub fn for_each_part<P: Parts>(count: usize, parts: P, body: impl Fn(usize, P) + Sync) {
    split_parts(0, count, parts, &body);
}

/// Halves the chunks until each is alone, as a list of them would have to be allocated.
fn split_parts<P: Parts>(first: usize, count: usize, parts: P, body: &(impl Fn(usize, P) + Sync)) {
    if count <= CHUNK {
        return body(first, parts);
    }
    let middle = count.div_ceil(CHUNK) / 2 * CHUNK;
    let (own, later) = parts.split(middle);
    rayon::join(
        || split_parts(first, middle, own, body),
        || split_parts(first + middle, count - middle, later, body),
    );
}

/// Calls `body(number, item)` for each item, of which each is worth a thread's while.
pub fn for_each_item<T: Send>(items: &mut [T], body: impl Fn(usize, &mut T) + Sync) {
    items.par_iter_mut().enumerate().for_each(|(number, item)| body(number, item));
}

/// `make(i)` for each i below `count`, or the first error.
///
/// # Errors
/// That of the smallest i that has one.
pub fn try_map<T: Send, E: Send>(
    count: usize,
    make: impl Fn(usize) -> Result<T, E> + Send + Sync,
) -> Result<Vec<T>, E> {
    let all: Vec<Result<T, E>> = (0..count).into_par_iter().with_min_len(CHUNK).map(make).collect();
    all.into_iter().collect()
}

/// What is added up over particles, or of which the largest is kept.
pub trait Sums: Copy + Send + Sync {
    /// Nothing yet.
    const ZERO: Self;

    /// Adds another sum.
    fn add(&mut self, other: &Self);
}

impl Sums for f64 {
    const ZERO: Self = 0.0;

    #[inline]
    fn add(&mut self, other: &Self) {
        *self += other;
    }
}

impl<T: Sums, const N: usize> Sums for [T; N] {
    const ZERO: Self = [T::ZERO; N];

    #[inline]
    fn add(&mut self, other: &Self) {
        self.iter_mut().zip(other).for_each(|(sum, part)| sum.add(part));
    }
}

/// Sums `term(i)` over `0..count` in an order that does not depend on the number of threads.
pub fn sum(count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    let partial = |chunk: usize| -> f64 {
        (chunk * CHUNK..((chunk + 1) * CHUNK).min(count)).map(&term).sum()
    };
    if count <= CHUNK {
        return partial(0);
    }
    sums_of_chunks(count.div_ceil(CHUNK), partial)
}

/// Adds up what a row has over `0..count`: `add(i, sums)` adds the terms of row i. The order
/// does not depend on the number of threads.
pub fn sums<T: Sums>(count: usize, add: impl Fn(usize, &mut T) + Sync) -> T {
    let partial = |chunk: usize| {
        let mut sums = T::ZERO;
        (chunk * CHUNK..((chunk + 1) * CHUNK).min(count)).for_each(|i| add(i, &mut sums));
        sums
    };
    if count <= CHUNK {
        return partial(0);
    }
    sums_of_chunks(count.div_ceil(CHUNK), partial)
}

/// Chunks whose sums are kept side by side until they are added, so that none are allocated.
const SIDE_BY_SIDE: usize = 64;

/// Adds up the sums of all chunks in their order.
fn sums_of_chunks<T: Sums>(chunks: usize, partial: impl Fn(usize) -> T + Sync) -> T {
    let mut kept = [T::ZERO; SIDE_BY_SIDE];
    let mut sums = T::ZERO;
    for first in (0..chunks).step_by(SIDE_BY_SIDE) {
        let kept = &mut kept[..SIDE_BY_SIDE.min(chunks - first)];
        kept.par_iter_mut().enumerate().for_each(|(k, part)| *part = partial(first + k));
        kept.iter().for_each(|part| sums.add(part));
    }
    sums
}

/// The larger of two numbers, infinite where the second is not a number.
pub fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// The largest `term(i)` over `0..count`, at least `least`. A term that is not a number makes the
/// result infinite.
pub fn maximum(count: usize, least: f64, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    let largest = |range: std::ops::Range<usize>| range.map(&term).fold(least, larger);
    if count <= CHUNK {
        return largest(0..count);
    }
    let chunks = (0..count.div_ceil(CHUNK)).into_par_iter();
    chunks
        .map(|chunk| largest(chunk * CHUNK..((chunk + 1) * CHUNK).min(count)))
        .reduce(|| least, f64::max)
}

/// Calls `body(first, parts, sums)` for chunks of the arrays of `count` particles, which changes them and
/// adds its terms to sums, in the order of [`sums`].
pub fn sums_over_parts<T: Sums, P: Parts>(
    count: usize,
    parts: P,
    body: impl Fn(usize, P, &mut T) + Sync,
) -> T {
    let mut sums = T::ZERO;
    if count <= CHUNK {
        body(0, parts, &mut sums);
        return sums;
    }
    let mut kept = [T::ZERO; SIDE_BY_SIDE];
    let (mut first, mut rest) = (0, Some(parts));
    while let Some(parts) = rest.take() {
        let length = (SIDE_BY_SIDE * CHUNK).min(count - first);
        let (block, later) = parts.split(length);
        let kept = &mut kept[..length.div_ceil(CHUNK)];
        for_each_part(length, (block, PerChunk(kept)), |offset, (parts, PerChunk(part))| {
            let mut own = T::ZERO;
            body(first + offset, parts, &mut own);
            part.fill(own);
        });
        kept.iter().for_each(|part| sums.add(part));
        first += length;
        rest = (first < count).then_some(later);
    }
    sums
}

/// Calls `body(first, rows, others)` for chunks of `rows` and of the `others` beside them, and
/// returns the largest of what it returns, at least `least`.
pub fn maximum_of_chunks<T: Send, U: Send>(
    rows: &mut [T],
    others: &mut [U],
    least: f64,
    body: impl Fn(usize, &mut [T], &mut [U]) -> f64 + Sync,
) -> f64 {
    if rows.len() <= CHUNK {
        return body(0, rows, others).max(least);
    }
    let chunks = rows.par_chunks_mut(CHUNK).zip(others.par_chunks_mut(CHUNK)).enumerate();
    let largest = chunks.map(|(chunk, (rows, others))| body(chunk * CHUNK, rows, others));
    largest.reduce(|| least, f64::max)
}

/// Calls `body(first, values, rows)` for chunks of `rows`, with those `values` that belong to them:
/// row `k` has the values from `start(k)` on, and those of the last row end the array.
pub fn for_each_span<V: Send, T: Send>(
    values: &mut [V],
    rows: &mut [T],
    start: &(impl Fn(usize) -> usize + Sync),
    body: impl Fn(usize, &mut [V], &mut [T]) + Sync,
) {
    split_spans(0, values, rows, start, &body);
}

/// Halves the chunks until each is alone, as a list of them would have to be allocated.
fn split_spans<V: Send, T: Send>(
    first: usize,
    values: &mut [V],
    rows: &mut [T],
    start: &(impl Fn(usize) -> usize + Sync),
    body: &(impl Fn(usize, &mut [V], &mut [T]) + Sync),
) {
    if rows.len() <= CHUNK {
        return body(first, values, rows);
    }
    let middle = rows.len().div_ceil(CHUNK) / 2 * CHUNK;
    let (rows, later_rows) = rows.split_at_mut(middle);
    let (values, later_values) = values.split_at_mut(start(first + middle) - start(first));
    rayon::join(
        || split_spans(first, values, rows, start, body),
        || split_spans(first + middle, later_values, later_rows, start, body),
    );
}
