//! Loops over particles on all threads, with results that do not depend on their number.
//!
//! A loop is cut into chunks of a fixed length. Each chunk writes its own rows; sums are taken
//! chunk by chunk, and over the chunks without rounding. Neither depends on the number of threads,
//! so results are the same to the bit.

mod sums;
mod team;

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

pub use sums::{ExactSums, Reduce, Sums};
pub use team::{Halo, Team};

/// Most particles a chunk. Long enough that handing it to a thread costs nothing, short enough that
/// many threads share small problems.
pub const CHUNK: usize = 1024;

/// Particles a chunk of `count` in all: [`CHUNK`], or less of few, of which several ranks can have whole chunks then.
pub fn chunk(count: usize) -> usize {
    (count / 64).next_power_of_two().clamp(16, CHUNK)
}

/// Calls `body(first, rows)` for chunks of `rows`, where `first` is the number of the first row.
pub fn for_each_chunk<T: Send>(rows: &mut [T], body: impl Fn(usize, &mut [T]) + Sync) {
    for_each_part(rows.len(), rows, body);
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

/// No array: only the number of particles counts.
struct Counted;

impl Parts for Counted {
    fn split(self, _middle: usize) -> (Self, Self) {
        (Self, Self)
    }
}

/// An array with one entry for each chunk of this many particles.
pub struct PerChunk<'a, T>(pub &'a mut [T], pub usize);

impl<T: Send> Parts for PerChunk<'_, T> {
    fn split(self, middle: usize) -> (Self, Self) {
        let Self(all, chunk) = self;
        let (own, later) = all.split_at_mut(middle.div_ceil(chunk));
        (Self(own, chunk), Self(later, chunk))
    }
}

/// Calls `body(first, parts)` for chunks of the arrays of `count` particles.
pub fn for_each_part<P: Parts>(count: usize, parts: P, body: impl Fn(usize, P) + Sync) {
    hand_out(count, [CHUNK; 2], parts, &body);
}

/// Hands out arrays of `count` entries in pieces of `grain`, the last of which may be shorter, to all threads, or to as
/// many as there is `work` for.
///
/// A thread that has nothing to do takes a part of what is left, long at first and short in the end, so that
/// all of them end together and rarely wait for one another.
///
/// Bodies are called through a pointer, so that this is compiled once for arrays of a kind and not for every loop, but
/// for those over spans.
fn hand_out<P: Parts>(
    count: usize,
    [grain, work]: [usize; 2],
    parts: P,
    body: &(dyn Fn(usize, P) + Sync),
) {
    let shares = 4 * rayon::current_num_threads();
    let rest = Mutex::new((0, Some(parts)));
    let take = || {
        let mut rest = rest.lock().unwrap_or_else(PoisonError::into_inner);
        let (first, parts) = (rest.0, rest.1.take()?);
        let length = ((count - first) / (shares * grain)).max(1) * grain;
        if first + length >= count {
            return Some((first, count - first, parts));
        }
        let (own, later) = parts.split(length);
        *rest = (first + length, Some(later));
        Some((first, length, own))
    };
    on_threads(count.div_ceil(work), &|| {
        while let Some((mut first, length, parts)) = take() {
            let (end, mut rest) = (first + length, Some(parts));
            while let Some(parts) = rest.take() {
                let own = if end - first > grain {
                    let (own, later) = parts.split(grain);
                    rest = Some(later);
                    own
                } else {
                    parts
                };
                body(first, own);
                first += grain;
            }
        }
    });
}

/// Calls `work` on all threads, or on as many as there are pieces of work.
///
/// All loops of a step ask the library of threads here, through a pointer to a function: its code is compiled
/// once and not for every loop.
fn on_threads(pieces: usize, work: &(dyn Fn() + Sync)) {
    match pieces.min(rayon::current_num_threads()) {
        0 | 1 => work(),
        threads => (0..threads).into_par_iter().for_each(|_| work()),
    }
}

/// Calls `body(number, item)` for each item, of which each is worth a thread's while.
pub fn for_each_item<T: Send>(items: &mut [T], body: impl Fn(usize, &mut T) + Sync) {
    hand_out(items.len(), [1; 2], items, &|first, items: &mut [T]| {
        items.iter_mut().enumerate().for_each(|(k, item)| body(first + k, item));
    });
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

/// Sums `term(i)` over `0..count`: terms in their order within chunks, and what chunks have without rounding, so that the
/// result depends neither on the number of threads nor on who has which chunks.
pub fn sum(count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    sums(count, |i, sum: &mut f64| *sum += term(i))
}

/// Adds up what a row has over `0..count`, as [`sum`]: `add(i, sums)` adds the terms of row i.
pub fn sums<T: Sums>(count: usize, add: impl Fn(usize, &mut T) + Sync) -> T {
    let mut exact = ExactSums::NONE;
    add_sums([count, chunk(count)], add, &mut exact);
    exact.total()
}

/// As [`sums`] over chunks of this many rows, for others to add theirs.
pub fn add_sums<T: Sums>(
    rows: [usize; 2],
    add: impl Fn(usize, &mut T) + Sync,
    exact: &mut ExactSums,
) {
    each_chunk(rows, |own, part| own.for_each(|i| add(i, part)), &mut |part| exact.add(part));
}

/// Puts together what rows have over `0..count`, in their order: `add(rows, all)` adds that of some that follow each other.
pub fn reduce<T: Reduce>(count: usize, add: impl Fn(Range<usize>, &mut T) + Sync) -> T {
    let mut all = T::ZERO;
    each_chunk([count, CHUNK], add, &mut |part| all.add(part));
    all
}

/// Chunks whose sums are kept side by side until they are added, so that none are allocated.
const SIDE_BY_SIDE: usize = 64;

/// Shows what the rows of each chunk have, in the order of chunks.
fn each_chunk<T: Reduce>(
    [count, chunk]: [usize; 2],
    add: impl Fn(Range<usize>, &mut T) + Sync,
    see: &mut dyn FnMut(&T),
) {
    let own = |first: usize| first..(first + chunk).min(count);
    over_chunks([count, chunk], Counted, &|first, Counted, part| add(own(first), part), see);
}

/// Calls `body(first, parts, own)` for chunks of the arrays of `count` particles, which changes them and adds to what the
/// chunk has, and shows that, in the order of chunks.
fn over_chunks<T: Reduce, P: Parts>(
    [count, chunk]: [usize; 2],
    parts: P,
    body: &(dyn Fn(usize, P, &mut T) + Sync),
    see: &mut dyn FnMut(&T),
) {
    let mut kept = [T::ZERO; SIDE_BY_SIDE];
    let (mut first, mut rest) = (0, Some(parts));
    while let (Some(parts), true) = (rest.take(), first < count) {
        let length = (SIDE_BY_SIDE * chunk).min(count - first);
        let (block, later) = parts.split(length);
        let kept = &mut kept[..length.div_ceil(chunk)];
        let all = (block, PerChunk(kept, chunk));
        hand_out(length, [chunk, CHUNK], all, &|offset, (parts, PerChunk(part, _))| {
            let mut own = T::ZERO;
            body(first + offset, parts, &mut own);
            part.fill(own);
        });
        kept.iter().for_each(&mut *see);
        first += length;
        rest = Some(later);
    }
}

/// The larger of two numbers, infinite where the second is not a number.
pub fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// The largest `term(i)` over `0..count`, at least `least`. A term that is not a number makes the
/// result infinite.
pub fn maximum(count: usize, least: f64, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    let chunk = |first: usize| (first..(first + CHUNK).min(count)).map(&term).fold(least, larger);
    largest(count, Counted, |first, Counted| chunk(first))
}

/// The largest of what `body(first, parts)` returns for chunks of the arrays of `count` particles.
fn largest<P: Parts>(count: usize, parts: P, body: impl Fn(usize, P) -> f64 + Sync) -> f64 {
    let all = Mutex::new(f64::NEG_INFINITY);
    for_each_part(count, parts, |first, parts| {
        let own = body(first, parts);
        let mut all = all.lock().unwrap_or_else(PoisonError::into_inner);
        *all = larger(*all, own);
    });
    all.into_inner().unwrap_or_else(PoisonError::into_inner)
}

/// Calls `body(first, parts, sums)` for chunks of the arrays of `count` particles, which changes them and
/// adds its terms to sums, as those of [`sums`].
pub fn sums_over_parts<T: Sums, P: Parts>(
    count: usize,
    parts: P,
    body: impl Fn(usize, P, &mut T) + Sync,
) -> T {
    let mut exact = ExactSums::NONE;
    add_sums_over_parts([count, chunk(count)], parts, body, &mut exact);
    exact.total()
}

/// As [`sums_over_parts`] over chunks of this many rows, for others to add theirs.
pub fn add_sums_over_parts<T: Sums, P: Parts>(
    rows: [usize; 2],
    parts: P,
    body: impl Fn(usize, P, &mut T) + Sync,
    exact: &mut ExactSums,
) {
    over_chunks(rows, parts, &body, &mut |part| exact.add(part));
}

/// Calls `body(first, rows, others)` for chunks of `rows` and of the `others` beside them, and
/// returns the largest of what it returns, at least `least`.
pub fn maximum_of_chunks<T: Send, U: Send>(
    rows: &mut [T],
    others: &mut [U],
    least: f64,
    body: impl Fn(usize, &mut [T], &mut [U]) -> f64 + Sync,
) -> f64 {
    largest(rows.len(), (rows, others), |first, (rows, others)| body(first, rows, others))
        .max(least)
}

/// Calls `body(first, values, rows)` for chunks of `rows`, with those `values` that belong to them:
/// row `k` has the values from `start(k)` on, and those of the last row end the array.
pub fn for_each_span<V: Send, T: Send>(
    values: &mut [V],
    rows: &mut [T],
    start: &(impl Fn(usize) -> usize + Sync),
    body: impl Fn(usize, &mut [V], &mut [T]) + Sync,
) {
    let (count, first) = (rows.len(), 0);
    for_each_part(count, Spans { first, values, rows, start }, |first, spans| {
        body(first, spans.values, spans.rows);
    });
}

/// As [`for_each_span`], of rows each of which is worth a thread's while: `body(values, row)`.
pub fn for_each_long_span<V: Send, T: Send>(
    values: &mut [V],
    rows: &mut [T],
    start: &(impl Fn(usize) -> usize + Sync),
    body: impl Fn(&mut [V], &mut T) + Sync,
) {
    let (count, first) = (rows.len(), 0);
    hand_out(
        count,
        [1; 2],
        Spans { first, values, rows, start },
        &|_, spans: Spans<'_, V, T, _>| {
            spans.rows.iter_mut().for_each(|row| body(spans.values, row));
        },
    );
}

/// Rows from `first` on, and the values that belong to them.
struct Spans<'a, V, T, S> {
    first: usize,
    values: &'a mut [V],
    rows: &'a mut [T],
    start: &'a S,
}

impl<V: Send, T: Send, S: Fn(usize) -> usize + Sync> Parts for Spans<'_, V, T, S> {
    fn split(self, middle: usize) -> (Self, Self) {
        let Self { first, values, rows, start } = self;
        let (own_rows, rows) = rows.split_at_mut(middle);
        let (own_values, values) = values.split_at_mut(start(first + middle) - start(first));
        let own = Self { first, values: own_values, rows: own_rows, start };
        (own, Self { first: first + middle, values, rows, start })
    }
}

#[cfg(test)]
mod tests {
    use piola_ranks::Exact;

    use super::*;

    /// Below, at and above whole chunks, and more of them than sums are kept side by side.
    const COUNTS: [usize; 7] =
        [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 9 * CHUNK + 7, SIDE_BY_SIDE * CHUNK + 5];

    /// What `run` returns on one thread, which is what it returns on any other number of them.
    fn on_any_number<T: PartialEq + std::fmt::Debug + Send>(run: impl Fn() -> T + Sync) -> T {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads can be had").install(&run)
        };
        let alone = on(1);
        [2, 3, 8].iter().for_each(|&threads| assert_eq!(on(threads), alone, "{threads} threads"));
        alone
    }

    #[test]
    fn every_row_is_handed_out_once_in_whole_chunks() {
        for count in COUNTS {
            let rows = on_any_number(|| {
                let (mut rows, mut calls) = (vec![0; count], vec![0; count.div_ceil(CHUNK)]);
                for_each_part(
                    count,
                    (&mut rows[..], PerChunk(&mut calls, CHUNK)),
                    |first, parts| {
                        let (rows, PerChunk(calls, _)) = parts;
                        assert_eq!(first % CHUNK, 0);
                        assert_eq!(rows.len(), CHUNK.min(count - first));
                        rows.iter_mut().enumerate().for_each(|(k, row)| *row += first + k + 1);
                        calls.iter_mut().for_each(|call| *call += 1);
                    },
                );
                assert!(calls.iter().all(|&call| call == 1));
                rows
            });
            assert!(rows.iter().enumerate().all(|(k, &row)| row == k + 1), "{count}");
        }
    }

    #[test]
    fn values_go_with_their_rows() {
        let start = |row: usize| 3 * row + row % 3;
        for count in &COUNTS[1..6] {
            let values = on_any_number(|| {
                let (mut rows, mut values) = (vec![0; *count], vec![0; start(*count)]);
                for_each_span(&mut values, &mut rows, &start, |first, values, rows| {
                    let end = first + rows.len();
                    assert_eq!(values.len(), start(end) - start(first));
                    values.iter_mut().enumerate().for_each(|(k, value)| *value = start(first) + k);
                });
                values
            });
            assert!(values.iter().enumerate().all(|(k, &value)| value == k));
        }
    }

    #[test]
    fn sums_and_maxima_do_not_depend_on_the_number_of_threads() {
        // Terms of which the rounded sum depends on the order.
        let term = |i: usize| 1.0 / (i as f64 + 0.3);
        for count in COUNTS {
            let length = chunk(count);
            let of_chunk =
                |first: usize| (first..(first + length).min(count)).map(term).sum::<f64>();
            let mut expected = Exact::default();
            (0..count).step_by(length).for_each(|first| expected.add(of_chunk(first)));
            let expected = expected.total();
            assert_eq!(on_any_number(|| sum(count, term)), expected);
            let beside = on_any_number(|| {
                let (mut rows, mut calls) = (vec![0.0; count], vec![0; count.div_ceil(length)]);
                let parts = (&mut rows[..], PerChunk(&mut calls, length));
                let total = sums_over_parts(count, parts, |first, parts, total: &mut f64| {
                    let (rows, PerChunk(calls, _)) = parts;
                    rows.iter_mut().enumerate().for_each(|(k, row)| *row = term(first + k));
                    *total += rows.iter().sum::<f64>();
                    calls.iter_mut().for_each(|call| *call += 1);
                });
                assert!(calls.iter().all(|&call| call == 1));
                assert!(rows.iter().enumerate().all(|(k, &row)| row == term(k)));
                total
            });
            assert_eq!(beside, expected);
            let all = on_any_number(|| sums(count, |i, sums: &mut [f64; 2]| sums[1] += term(i)));
            assert_eq!(all, [0.0, expected]);
            let most = if count == 0 { 2.0 } else { term(0).max(2.0) };
            assert_eq!(on_any_number(|| maximum(count, 2.0, term)), most);
            let nothing = |i: usize| if i + 1 == count { f64::NAN } else { term(i) };
            let most = if count == 0 { 2.0 } else { f64::INFINITY };
            assert_eq!(on_any_number(|| maximum(count, 2.0, nothing)), most);
        }
    }

    #[test]
    fn items_are_handed_out_one_by_one() {
        let items = on_any_number(|| {
            let mut items = vec![0; 1000];
            for_each_item(&mut items, |number, item| *item += number);
            items
        });
        assert!(items.iter().enumerate().all(|(number, &item)| item == number));
    }
}
