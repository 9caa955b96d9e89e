//! Who computes: one alone, or several ranks that have a part of the particles each.
//!
//! The particles of a rank are whole chunks of those that follow each other in memory where one computes alone. Behind
//! them stand copies of those of other ranks that its own see. As neighbours keep their order, and sums over chunks are
//! not rounded, every number is the same to the bit for any number of ranks.

use std::cell::{Cell, RefCell};
use std::fmt;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;

use bytemuck::{Pod, cast_slice, cast_slice_mut};
use piola_formulas::pairs::{Of, Record};
use piola_ranks::{Exact, LIMBS, Message, RankError, Ranks};

use super::{
    ExactSums, Parts, Reduce, Sums, add_sums, add_sums_over_parts, for_each_chunk, reduce,
};

/// Those that compute a system together.
#[derive(Clone, Default)]
pub struct Team {
    shared: Option<Arc<Shared>>,
}

impl fmt::Debug for Team {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ranks = self.shared.as_ref().map(|shared| (shared.ranks.rank(), shared.ranks.size()));
        formatter.debug_tuple("Team").field(&ranks).finish()
    }
}

/// What a rank knows of the others.
struct Shared {
    ranks: Arc<dyn Ranks>,
    /// Where the particles of each rank begin among all, and where those of the last end.
    bounds: Vec<usize>,
    /// Particles a chunk.
    chunk: usize,
    plan: Mutex<Plan>,
    limbs: Mutex<Vec<i64>>,
    /// Why the ranks cannot go on, from then on.
    fault: OnceLock<RankError>,
    /// Nanoseconds of telling and waiting, messages and bytes that were sent.
    costs: [AtomicU64; 3],
}

/// Who has copies of whose particles.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Halo {
    /// Ranks that have copies of own particles, with these.
    pub lent: Vec<(usize, Vec<u32>)>,
    /// Ranks of whose particles there are copies, and how many: they follow each other behind own particles.
    pub copied: Vec<(usize, usize)>,
}

impl Halo {
    /// That of ranks each of which wants copies of others, rank by rank: of whom, and by which name that one knows the
    /// particle; `row` is where an own particle with a name stands. All ranks call this together.
    ///
    /// # Errors
    /// A rank is lost.
    pub fn agree(
        ranks: &dyn Ranks,
        wanted: &[(usize, usize)],
        row: impl Fn(usize) -> u32,
    ) -> Result<Self, RankError> {
        let size = ranks.size();
        let of_rank = |rank: usize| {
            let place = |rank: usize| wanted.partition_point(|(owner, _)| *owner < rank);
            &wanted[place(rank)..place(rank + 1)]
        };
        let counts: Vec<f64> = (0..size).map(|rank| of_rank(rank).len() as f64).collect();
        let all = ranks.gather_to_all(&counts)?;
        let others = || (0..size).filter(|&rank| !of_rank(rank).is_empty());
        let names = |rank: usize| of_rank(rank).iter().map(|(_, name)| *name as f64).collect();
        let asked: Vec<Message> =
            others().map(|rank| Message { rank, numbers: names(rank) }).collect();
        let of_others = all.iter().map(|counts| counts[ranks.rank()] as usize);
        let mut lent: Vec<Message> = (of_others.enumerate())
            .filter(|(_, count)| *count > 0)
            .map(|(rank, count)| Message { rank, numbers: vec![0.0; count] })
            .collect();
        ranks.exchange(&asked, &mut lent)?;
        let own = |message: Message| {
            (message.rank, message.numbers.iter().map(|&name| row(name as usize)).collect())
        };
        Ok(Self {
            lent: lent.into_iter().map(own).collect(),
            copied: others().map(|rank| (rank, of_rank(rank).len())).collect(),
        })
    }
}

/// A plan of copies, and the messages that it takes: those that go out, and those that come.
struct Plan {
    halo: Halo,
    messages: [Vec<Message>; 2],
}

impl Plan {
    fn new(halo: Halo) -> Self {
        let message = |rank: usize| Message { rank, numbers: Vec::new() };
        let lent = halo.lent.iter().map(|(rank, _)| message(*rank)).collect();
        let copied = halo.copied.iter().map(|(rank, _)| message(*rank)).collect();
        Self { halo, messages: [lent, copied] }
    }
}

impl Team {
    /// A rank of those whose particles begin and end where `bounds` has it, with a plan of the copies.
    pub fn new(ranks: Arc<dyn Ranks>, bounds: Vec<usize>, halo: Halo) -> Self {
        let all = bounds.last().copied().unwrap_or_default();
        let (chunk, plan) = (super::chunk(all), Mutex::new(Plan::new(halo)));
        let (limbs, fault, costs) = (Mutex::default(), OnceLock::new(), Default::default());
        let shared = Shared { ranks, bounds, chunk, plan, limbs, fault, costs };
        Self { shared: Some(Arc::new(shared)) }
    }

    /// Whether there is one rank.
    pub fn is_alone(&self) -> bool {
        self.shared.is_none()
    }

    /// Plans the copies anew, as [`Halo::agree`]. All ranks call this together.
    pub fn renew(&self, wanted: &[(usize, usize)], row: impl Fn(usize) -> u32) {
        let Some(shared) = &self.shared else { return };
        if let Some(halo) = shared.told(|| Halo::agree(shared.ranks.as_ref(), wanted, row)) {
            *shared.plan.lock().unwrap_or_else(PoisonError::into_inner) = Plan::new(halo);
        }
    }

    /// Which of the ranks this is.
    pub fn rank(&self) -> usize {
        self.shared.as_ref().map_or(0, |shared| shared.ranks.rank())
    }

    /// The number of the first particle among those of all ranks.
    pub fn first(&self) -> usize {
        self.shared.as_ref().map_or(0, |shared| shared.bounds[shared.ranks.rank()])
    }

    /// The rank that has the particle with a number among those of all ranks.
    pub fn owner(&self, number: usize) -> usize {
        let Some(shared) = &self.shared else { return 0 };
        shared.bounds.partition_point(|&bound| bound <= number) - 1
    }

    /// Particles a chunk, of `count` here.
    pub fn chunk(&self, count: usize) -> usize {
        self.shared.as_ref().map_or_else(|| super::chunk(count), |shared| shared.chunk)
    }

    /// The particle with a number among those of all ranks, if it is one of `count` here.
    pub fn own(&self, number: usize, count: usize) -> Option<usize> {
        number.checked_sub(self.first()).filter(|&a| a < count)
    }

    /// Which of `count` particles in all this rank has.
    pub fn share_of(&self, count: usize) -> Range<usize> {
        let all = self.shared.as_ref().and_then(|shared| shared.bounds.last().copied());
        debug_assert_eq!(all.unwrap_or(count), count, "these are all particles");
        self.shared.as_ref().map_or(0..count, |shared| shared.share(shared.ranks.rank()))
    }

    /// Which of `count` items this rank computes, where ranks have about as many each.
    pub fn even_share(&self, count: usize) -> Range<usize> {
        let Some(shared) = &self.shared else { return 0..count };
        let (rank, size) = (shared.ranks.rank(), shared.ranks.size());
        count * rank / size..count * (rank + 1) / size
    }

    /// Fills rows of all particles that every rank has, as [`for_each_chunk`]: each rank those of its own particles, which it
    /// then tells the others. Rows are of 64-bit numbers.
    pub fn fill<T: Pod + Send>(&self, rows: &mut [T], body: impl Fn(usize, &mut [T]) + Sync) {
        if rows.is_empty() {
            return;
        }
        let own = self.share_of(rows.len());
        for_each_chunk(&mut rows[own.clone()], |first, rows| body(own.start + first, rows));
        self.complete(rows, |a| a);
    }

    /// Takes from the others what they have filled of rows that every rank has: those of particle `a` begin at `place(a)`.
    /// Where a rank is lost, they are not numbers.
    pub fn complete<T: Pod>(&self, rows: &mut [T], place: impl Fn(usize) -> usize) {
        let Some(shared) = &self.shared else { return };
        let part = |rank: usize| {
            let Range { start, end } = shared.share(rank);
            place(start)..place(end)
        };
        let own = shared.ranks.rank();
        let told = self.parts_of_all(cast_slice(&rows[part(own)]));
        for rank in (0..shared.ranks.size()).filter(|rank| *rank != own) {
            let rows: &mut [f64] = cast_slice_mut(&mut rows[part(rank)]);
            match &told {
                Some(told) => rows.copy_from_slice(&told[rank]),
                None => rows.fill(f64::NAN),
            }
        }
    }

    /// Seconds of telling and waiting, messages and bytes that were sent.
    pub fn costs(&self) -> (f64, [u64; 2]) {
        let Some(shared) = &self.shared else { return Default::default() };
        let [waited, messages, bytes] =
            shared.costs.each_ref().map(|cost| cost.load(Ordering::Relaxed));
        (waited as f64 * 1e-9, [messages, bytes])
    }

    /// Why the ranks cannot go on together: what they have computed since means nothing.
    pub fn fault(&self) -> Option<&RankError> {
        self.shared.as_ref()?.fault.get()
    }

    /// The sums of a loop over the particles of all ranks that changes arrays, as
    /// [`sums_over_parts`](super::sums_over_parts), of which `count` are its own.
    pub fn sums_over_parts<T: Sums, P: Parts>(
        &self,
        count: usize,
        parts: P,
        body: impl Fn(usize, P, &mut T) + Sync,
    ) -> T {
        let mut exact = ExactSums::NONE;
        add_sums_over_parts([count, self.chunk(count)], parts, body, &mut exact);
        self.close(exact)
    }

    /// The sums of a loop over the particles of all ranks, as [`sums`](super::sums), of which `count` are its own.
    pub fn sums<T: Sums>(&self, count: usize, add: impl Fn(usize, &mut T) + Sync) -> T {
        let mut exact = ExactSums::NONE;
        add_sums([count, self.chunk(count)], add, &mut exact);
        self.close(exact)
    }

    /// The sum of a few terms of all ranks, added one after the other in the order of ranks.
    pub fn sum_in_order<T: Sums>(&self, own: impl Iterator<Item = T>) -> T {
        let mut total = T::ZERO;
        if self.is_alone() {
            own.for_each(|term| total.add(&term));
            return total;
        }
        let mut numbers = Vec::new();
        own.for_each(|mut term| term.each(&mut |number| numbers.push(*number)));
        for term in self.rows_of_all(numbers).chunks_exact(T::NUMBERS) {
            let (mut part, mut rest) = (T::ZERO, term.iter());
            part.each(&mut |number| *number = rest.next().copied().unwrap_or_default());
            total.add(&part);
        }
        total
    }

    /// What all ranks have, in the order of ranks.
    pub fn rows_of_all<T: Pod>(&self, own: Vec<T>) -> Vec<T> {
        if self.is_alone() {
            return own;
        }
        let told = self.parts_of_all(cast_slice(&own));
        told.iter().flatten().flat_map(|part| cast_slice::<f64, T>(part)).copied().collect()
    }

    /// What each rank has, if none is lost.
    pub fn parts_of_all(&self, own: &[f64]) -> Option<Vec<Vec<f64>>> {
        let Some(shared) = &self.shared else { return Some(vec![own.to_vec()]) };
        let others = shared.ranks.size() as u64 - 1;
        shared.count([0, others, others * size_of_val(own) as u64]);
        shared.told(|| shared.ranks.gather_to_all(own))
    }

    /// The largest of what all ranks have, number by number.
    pub fn largest<const N: usize>(&self, own: [f64; N]) -> [f64; N] {
        if self.is_alone() {
            return own;
        }
        let all = self.rows_of_all(own.to_vec());
        let larger =
            |own: [f64; N], other: &[f64]| std::array::from_fn(|k| super::larger(own[k], other[k]));
        all.chunks_exact(N).fold(own, larger)
    }

    /// The smallest of what ranks have, if any has something.
    pub fn least(&self, own: Option<usize>) -> Option<usize> {
        let none = f64::NEG_INFINITY;
        let [most] = self.largest([own.map_or(none, |own| -(own as f64))]);
        (most > none).then_some(-most as usize)
    }

    /// The sum of terms of all ranks, none of which is rounded.
    pub fn total<T: Sums>(&self, terms: impl Iterator<Item = T>) -> T {
        let mut exact = ExactSums::NONE;
        terms.for_each(|term| exact.add(&term));
        self.close(exact)
    }

    /// The sum over all ranks of what has been added on each.
    pub fn close<T: Sums>(&self, exact: ExactSums) -> T {
        let [total] = self.close_all([exact]);
        total
    }

    /// The same of several, told at once.
    pub fn close_all<T: Sums, const K: usize>(&self, mut exact: [ExactSums; K]) -> [T; K] {
        if let (Some(shared), true) = (&self.shared, T::NUMBERS > 0) {
            shared.add(&mut exact.each_mut().map(|sums| sums.parts::<T>()));
        }
        exact.map(|sums| sums.total())
    }

    /// What rows have together over the particles of all ranks, in their order, as [`reduce`](super::reduce). Numbers of `pack` tell the others what own
    /// particles have, and `unpack` reads those.
    pub fn reduce<T: Reduce>(
        &self,
        count: usize,
        add: impl Fn(Range<usize>, &mut T) + Sync,
        pack: impl Fn(&T) -> Vec<f64>,
        unpack: impl Fn(&[f64]) -> T,
    ) -> T {
        let own = reduce(count, add);
        let Some(shared) = &self.shared else { return own };
        let mut all = T::ZERO;
        let told = shared.told(|| shared.ranks.gather_to_all(&pack(&own)));
        told.iter().flatten().for_each(|part| all.add(&unpack(part)));
        all
    }

    /// Whether all ranks say so.
    pub fn all(&self, own: bool) -> bool {
        let Some(shared) = &self.shared else { return own };
        let mut against = [i64::from(!own)];
        shared.told(|| shared.ranks.add(&mut against));
        against == [0]
    }

    /// Fetches the copies behind the `count` own rows of a column of `width` entries a particle.
    pub fn refresh<T: Pod>(&self, column: &mut [T], count: usize, width: usize) {
        let Some(shared) = &self.shared else { return };
        let (own, copies) = column.split_at_mut(count * width);
        let copies: &mut [f64] = cast_slice_mut(copies);
        let show = |a: usize, numbers: &mut Vec<f64>| {
            numbers.extend_from_slice(cast_slice(&own[a * width..][..width]));
        };
        let length = width * size_of::<T>() / size_of::<f64>();
        shared.exchange(length, show, |copy, numbers| {
            copies[copy * length..][..length].copy_from_slice(numbers);
        });
    }

    /// Fetches the copies behind the `count` own rows of a column of records.
    pub fn refresh_records<R: Record>(&self, column: &mut [Of<R, f64>], count: usize) {
        let Some(shared) = &self.shared else { return };
        let (own, copies) = column.split_at_mut(count);
        let show = |a: usize, numbers: &mut Vec<f64>| {
            let numbers = RefCell::new(numbers);
            R::map([&own[a]], &|[number]: [f64; 1]| {
                numbers.borrow_mut().push(number);
                number
            });
        };
        shared.exchange(R::NUMBERS, show, |copy, numbers| {
            let next = Cell::new(0);
            copies[copy] =
                R::map([&R::zero::<f64>()], &|_: [f64; 1]| numbers[next.replace(next.get() + 1)]);
        });
    }

    /// Fetches `length` numbers of each copy: `show` appends those of an own particle, and `take` has those of a copy,
    /// counted from 0.
    pub fn refresh_numbers(
        &self,
        length: usize,
        show: impl Fn(usize, &mut Vec<f64>),
        take: impl FnMut(usize, &[f64]),
    ) {
        if let Some(shared) = &self.shared {
            shared.exchange(length, show, take);
        }
    }
}

impl Shared {
    /// The particles of a rank.
    fn share(&self, rank: usize) -> Range<usize> {
        self.bounds[rank]..self.bounds[rank + 1]
    }

    /// Tells other ranks what they have copies of, and takes what they tell: `length` numbers a particle, which `show`
    /// appends of an own one and `take` has of a copy.
    fn exchange(
        &self,
        length: usize,
        show: impl Fn(usize, &mut Vec<f64>),
        mut take: impl FnMut(usize, &[f64]),
    ) {
        let mut plan = self.plan.lock().unwrap_or_else(PoisonError::into_inner);
        let Plan { halo, messages: [send, receive] } = &mut *plan;
        for (message, (_, lent)) in send.iter_mut().zip(&halo.lent) {
            message.numbers.clear();
            lent.iter().for_each(|&a| show(a as usize, &mut message.numbers));
        }
        for (message, (_, copied)) in receive.iter_mut().zip(&halo.copied) {
            message.numbers.resize(copied * length, 0.0);
        }
        let sent: usize = send.iter().map(|message| message.numbers.len()).sum();
        self.count([0, send.len() as u64, (sent * size_of::<f64>()) as u64]);
        if self.told(|| self.ranks.exchange(send, receive)).is_none() {
            return;
        }
        let rows = receive.iter().flat_map(|message| message.numbers.chunks_exact(length));
        rows.enumerate().for_each(|(copy, numbers)| take(copy, numbers));
    }

    /// What the ranks say, unless they cannot go on.
    fn told<T>(&self, ask: impl FnOnce() -> Result<T, RankError>) -> Option<T> {
        if self.fault.get().is_some() {
            return None;
        }
        let start = Instant::now();
        let told = ask();
        self.count([start.elapsed().as_nanos() as u64, 0, 0]);
        let fault = match told {
            Ok(told) => return Some(told),
            Err(fault) => fault,
        };
        // The first fault is the cause of those that follow.
        self.fault.get_or_init(|| fault);
        None
    }

    /// Adds to the costs.
    fn count(&self, more: [u64; 3]) {
        for (cost, more) in self.costs.iter().zip(more) {
            cost.fetch_add(more, Ordering::Relaxed);
        }
    }

    /// Adds the sums of the other ranks.
    fn add(&self, exact: &mut [&mut [Exact]]) {
        let mut limbs = self.limbs.lock().unwrap_or_else(PoisonError::into_inner);
        limbs.clear();
        for part in exact.iter_mut().flat_map(|sums| sums.iter_mut()) {
            limbs.extend_from_slice(part.limbs_mut());
        }
        self.count([0, 1, size_of_val(limbs.as_slice()) as u64]);
        self.told(|| self.ranks.add(&mut limbs));
        let parts = exact.iter_mut().flat_map(|sums| sums.iter_mut());
        for (part, added) in parts.zip(limbs.chunks_exact(LIMBS)) {
            part.limbs_mut().copy_from_slice(added);
        }
    }
}

#[cfg(test)]
mod tests;
