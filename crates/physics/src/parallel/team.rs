//! Who computes: one alone, or several ranks that have a part of the particles each.
//!
//! The particles of a rank are whole chunks of those that follow each other in memory where one computes alone. Behind
//! them stand copies of those of other ranks that its own see. As neighbours keep their order, and sums over chunks are
//! not rounded, every number is the same to the bit for any number of ranks.

use std::cell::{Cell, RefCell};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;

use bytemuck::{Pod, cast_slice, cast_slice_mut};
use piola_formulas::pairs::{Of, Record};
use piola_ranks::{Exact, LIMBS, Message, RankError, Ranks};

use super::{ExactSums, Parts, Reduce, Sums, add_sums_over_parts, reduce};

/// Those that compute a system together.
#[derive(Clone, Default)]
pub struct Team {
    shared: Option<Arc<Shared>>,
}

/// What a rank knows of the others.
struct Shared {
    ranks: Arc<dyn Ranks>,
    /// Number of its first particle among all.
    first: usize,
    /// Particles a chunk.
    chunk: usize,
    halo: Halo,
    messages: Mutex<[Vec<Message>; 2]>,
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

impl Team {
    /// A rank whose first particle has the number `first` among `all`, with a plan of the copies.
    pub fn new(ranks: Arc<dyn Ranks>, [first, all]: [usize; 2], halo: Halo) -> Self {
        let message = |rank: usize| Message { rank, numbers: Vec::new() };
        let lent = halo.lent.iter().map(|(rank, _)| message(*rank)).collect();
        let copied = halo.copied.iter().map(|(rank, _)| message(*rank)).collect();
        let messages = Mutex::new([lent, copied]);
        let (chunk, fault) = (super::chunk(all), OnceLock::new());
        let costs = Default::default();
        let limbs = Mutex::default();
        let shared = Shared { ranks, first, chunk, halo, messages, limbs, fault, costs };
        Self { shared: Some(Arc::new(shared)) }
    }

    /// The number of particle `a` among those of all ranks.
    pub fn number(&self, a: usize) -> usize {
        self.shared.as_ref().map_or(a, |shared| shared.first + a)
    }

    /// Particles a chunk, of `count` here.
    pub fn chunk(&self, count: usize) -> usize {
        self.shared.as_ref().map_or_else(|| super::chunk(count), |shared| shared.chunk)
    }

    /// The particle with a number among those of all ranks, if it is one of `count` here.
    pub fn own(&self, number: usize, count: usize) -> Option<usize> {
        let first = self.shared.as_ref().map_or(0, |shared| shared.first);
        number.checked_sub(first).filter(|&a| a < count)
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

    /// What rows have together over the particles of all ranks, in their order. Numbers of `pack` tell the others what own
    /// particles have, and `unpack` reads those.
    pub fn reduce<T: Reduce>(
        &self,
        count: usize,
        add: impl Fn(usize, &mut T) + Sync,
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
}

impl Shared {
    /// Tells other ranks what they have copies of, and takes what they tell: `length` numbers a particle, which `show`
    /// appends of an own one and `take` has of a copy.
    fn exchange(
        &self,
        length: usize,
        show: impl Fn(usize, &mut Vec<f64>),
        mut take: impl FnMut(usize, &[f64]),
    ) {
        let mut messages = self.messages.lock().unwrap_or_else(PoisonError::into_inner);
        let [send, receive] = &mut *messages;
        for (message, (_, lent)) in send.iter_mut().zip(&self.halo.lent) {
            message.numbers.clear();
            lent.iter().for_each(|&a| show(a as usize, &mut message.numbers));
        }
        for (message, (_, copied)) in receive.iter_mut().zip(&self.halo.copied) {
            message.numbers.resize(copied * length, 0.0);
        }
        let sent: usize = send.iter().map(|message| message.numbers.len()).sum();
        self.count([0, send.len() as u64, (sent * size_of::<f64>()) as u64]);
        self.told(|| self.ranks.exchange(send, receive));
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
