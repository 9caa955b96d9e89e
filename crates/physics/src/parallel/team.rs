//! Who computes: one alone, or several ranks that have a part of the particles each.
//!
//! The particles of a rank are whole chunks of those that follow each other in memory where one computes alone. Behind
//! them stand copies of those of other ranks that its own see. As neighbours keep their order, and sums over chunks are
//! not rounded, every number is the same to the bit for any number of ranks.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use bytemuck::{Pod, cast_slice, cast_slice_mut};
use piola_ranks::{Exact, Message, RankError, Ranks};

use super::{ExactSums, Parts, Reduce, Sums, add_sums, add_sums_over_parts, reduce};

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
    halo: Halo,
    messages: Mutex<[Vec<Message>; 2]>,
    /// Why the ranks cannot go on, from then on.
    fault: OnceLock<RankError>,
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
    /// A rank whose first particle has the number `first` among all, with a plan of the copies.
    pub fn new(ranks: Arc<dyn Ranks>, first: usize, halo: Halo) -> Self {
        let message = |rank: usize| Message { rank, numbers: Vec::new() };
        let lent = halo.lent.iter().map(|(rank, _)| message(*rank)).collect();
        let copied = halo.copied.iter().map(|(rank, _)| message(*rank)).collect();
        let messages = Mutex::new([lent, copied]);
        let shared = Shared { ranks, first, halo, messages, fault: OnceLock::new() };
        Self { shared: Some(Arc::new(shared)) }
    }

    /// Whether one computes alone.
    pub fn is_alone(&self) -> bool {
        self.shared.is_none()
    }

    /// The number of particle `a` among those of all ranks.
    pub fn number(&self, a: usize) -> usize {
        self.shared.as_ref().map_or(a, |shared| shared.first + a)
    }

    /// The particle with a number among those of all ranks, if it is one of `count` here.
    pub fn own(&self, number: usize, count: usize) -> Option<usize> {
        let first = self.shared.as_ref().map_or(0, |shared| shared.first);
        number.checked_sub(first).filter(|&a| a < count)
    }

    /// Why the ranks cannot go on together: what they have computed since means nothing.
    pub fn fault(&self) -> Option<&RankError> {
        self.shared.as_ref()?.fault.get()
    }

    /// The sum of `term` over the particles of all ranks, of which `count` are its own, as [`sum`](super::sum).
    pub fn sum(&self, count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
        self.sums(count, |i, sum: &mut f64| *sum += term(i))
    }

    /// The sums of what rows have over the particles of all ranks, as [`sums`](super::sums).
    pub fn sums<T: Sums>(&self, count: usize, add: impl Fn(usize, &mut T) + Sync) -> T {
        if self.is_alone() {
            return super::sums(count, add);
        }
        let mut exact = ExactSums::default();
        add_sums(count, add, &mut exact);
        self.close(exact)
    }

    /// The same of a loop that changes arrays, as [`sums_over_parts`](super::sums_over_parts).
    pub fn sums_over_parts<T: Sums, P: Parts>(
        &self,
        count: usize,
        parts: P,
        body: impl Fn(usize, P, &mut T) + Sync,
    ) -> T {
        let mut exact = ExactSums::default();
        add_sums_over_parts(count, parts, body, &mut exact);
        self.close(exact)
    }

    /// The sum over all ranks of what has been added on each.
    pub fn close<T: Sums>(&self, mut exact: ExactSums) -> T {
        if let (Some(shared), true) = (&self.shared, T::NUMBERS > 0) {
            shared.add(exact.parts::<T>());
        }
        exact.total()
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
        let mut messages = shared.messages.lock().unwrap_or_else(PoisonError::into_inner);
        let [send, receive] = &mut *messages;
        for (message, (_, lent)) in send.iter_mut().zip(&shared.halo.lent) {
            message.numbers.clear();
            for &a in lent {
                let row = &own[a as usize * width..][..width];
                message.numbers.extend_from_slice(cast_slice(row));
            }
        }
        let length = width * size_of::<T>() / size_of::<f64>();
        for (message, (_, copied)) in receive.iter_mut().zip(&shared.halo.copied) {
            message.numbers.resize(copied * length, 0.0);
        }
        shared.told(|| shared.ranks.exchange(send, receive));
        let mut rest: &mut [f64] = cast_slice_mut(copies);
        for message in receive {
            let (own, others) = rest.split_at_mut(message.numbers.len());
            own.copy_from_slice(&message.numbers);
            rest = others;
        }
    }
}

impl Shared {
    /// What the ranks say, unless they cannot go on.
    fn told<T>(&self, ask: impl FnOnce() -> Result<T, RankError>) -> Option<T> {
        if self.fault.get().is_some() {
            return None;
        }
        let fault = match ask() {
            Ok(told) => return Some(told),
            Err(fault) => fault,
        };
        // The first fault is the cause of those that follow.
        self.fault.get_or_init(|| fault);
        None
    }

    /// Adds the sums of the other ranks.
    fn add(&self, exact: &mut [Exact]) {
        let mut limbs: Vec<i64> =
            exact.iter_mut().flat_map(|part| part.limbs_mut().to_vec()).collect();
        self.told(|| self.ranks.add(&mut limbs));
        let mut rest = limbs.as_slice();
        for part in exact {
            let own = part.limbs_mut();
            let (added, others) = rest.split_at(own.len());
            own.copy_from_slice(added);
            rest = others;
        }
    }
}
