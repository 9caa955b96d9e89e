//! Ranks that are threads of one process.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use super::{Message, RankError, Ranks, check_exchange, check_length, check_parts};

/// A rank that is a thread of this process.
///
/// Each thread owns its rank: when it ends or panics, the rank is dropped, and others that wait for it, then or later,
/// are told that it is lost. What a rank has sent before that still arrives. Nobody waits busily.
///
/// ```
/// use piola_ranks::{Ranks, Threads};
///
/// std::thread::scope(|scope| {
///     for rank in Threads::group(3) {
///         scope.spawn(move || assert_eq!(rank.broadcast(vec![rank.rank() as f64]), Ok(vec![0.0])));
///     }
/// });
/// ```
pub struct Threads {
    rank: usize,
    size: usize,
    /// From each rank to each, those from one rank side by side.
    lanes: Arc<[Lane]>,
}

/// The way from one rank to another.
#[derive(Default)]
struct Lane {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    sent: VecDeque<(Call, Vec<f64>)>,
    /// Buffers of messages that have been received, for later ones.
    spare: Vec<Vec<f64>>,
    /// The rank that is to blame if nothing will be sent any more.
    lost: Option<usize>,
}

/// What a message was sent in.
#[derive(Clone, Copy, PartialEq)]
enum Call {
    Exchange,
    Add,
    GatherToAll,
    Gather,
    Scatter,
    Broadcast,
}

impl Call {
    fn name(self) -> &'static str {
        match self {
            Self::Exchange => "exchange",
            Self::Add => "add",
            Self::GatherToAll => "gather_to_all",
            Self::Gather => "gather",
            Self::Scatter => "scatter",
            Self::Broadcast => "broadcast",
        }
    }
}

impl Lane {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The first message, as soon as there is one.
    fn take(&self) -> Result<(Call, Vec<f64>), RankError> {
        let mut state = self.lock();
        loop {
            if let Some(message) = state.sent.pop_front() {
                return Ok(message);
            }
            if let Some(lost) = state.lost {
                return Err(RankError::Lost(lost));
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Threads {
    /// Ranks for `size` threads, by number.
    pub fn group(size: usize) -> Vec<Self> {
        let lanes: Arc<[Lane]> = (0..size * size).map(|_| Lane::default()).collect();
        (0..size).map(|rank| Self { rank, size, lanes: lanes.clone() }).collect()
    }

    fn lane(&self, from: usize, to: usize) -> &Lane {
        &self.lanes[from * self.size + to]
    }

    /// The others, by number.
    fn others(&self) -> impl Iterator<Item = usize> {
        let own = self.rank;
        (0..self.size).filter(move |&rank| rank != own)
    }

    /// Sends a copy of numbers.
    fn send(
        &self,
        call: Call,
        to: usize,
        numbers: impl Iterator<Item = f64>,
    ) -> Result<(), RankError> {
        if let Some(lost) = self.lane(to, self.rank).lock().lost {
            return Err(RankError::Lost(lost));
        }
        let lane = self.lane(self.rank, to);
        let mut buffer = lane.lock().spare.pop().unwrap_or_default();
        buffer.clear();
        buffer.extend(numbers);
        lane.lock().sent.push_back((call, buffer));
        lane.changed.notify_one();
        Ok(())
    }

    fn receive(&self, expected: Call, from: usize) -> Result<Vec<f64>, RankError> {
        let (call, numbers) = self.lane(from, self.rank).take()?;
        if call == expected {
            return Ok(numbers);
        }
        Err(RankError::Call { rank: from, expected: expected.name(), got: call.name() })
    }

    /// Gives a buffer to later messages.
    fn reuse(&self, from: usize, buffer: Vec<f64>) {
        self.lane(from, self.rank).lock().spare.push(buffer);
    }

    /// What each rank has, by rank, of which the others have sent theirs.
    fn collect(&self, call: Call, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError> {
        let of = |rank| match rank == self.rank {
            true => Ok(own.to_vec()),
            false => self.receive(call, rank),
        };
        (0..self.size).map(of).collect()
    }

    /// Makes a call, unless an earlier one has failed; leaves the others if it does.
    fn attempt<T>(&self, call: impl FnOnce() -> Result<T, RankError>) -> Result<T, RankError> {
        if let Some(lost) = self.lane(self.rank, self.rank).lock().lost {
            return Err(RankError::Lost(lost));
        }
        call().inspect_err(|error| match error {
            RankError::Lost(lost) => self.leave(*lost),
            _ => self.leave(self.rank),
        })
    }

    /// Tells the others that nothing will be sent any more, and who is to blame; the first one stays.
    fn leave(&self, lost: usize) {
        for to in 0..self.size {
            let lane = self.lane(self.rank, to);
            lane.lock().lost.get_or_insert(lost);
            lane.changed.notify_all();
        }
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        self.leave(self.rank);
    }
}

impl Ranks for Threads {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn exchange(&self, send: &[Message], receive: &mut [Message]) -> Result<(), RankError> {
        self.attempt(|| {
            check_exchange(send, receive, self.rank, self.size)?;
            for message in send {
                self.send(Call::Exchange, message.rank, message.numbers.iter().copied())?;
            }
            for message in receive {
                let numbers = self.receive(Call::Exchange, message.rank)?;
                check_length(message.rank, message.numbers.len(), numbers.len())?;
                self.reuse(message.rank, std::mem::replace(&mut message.numbers, numbers));
            }
            Ok(())
        })
    }

    fn add(&self, numbers: &mut [i64]) -> Result<(), RankError> {
        // Integers travel as the numbers that have their bits.
        let send = |to, numbers: &[i64]| {
            self.send(Call::Add, to, numbers.iter().map(|n| f64::from_bits(n.cast_unsigned())))
        };
        let each = |from, numbers: &mut [i64], then: fn(i64, i64) -> i64| {
            let others = self.receive(Call::Add, from)?;
            check_length(from, numbers.len(), others.len())?;
            let pairs = numbers.iter_mut().zip(&others);
            pairs.for_each(|(own, other)| *own = then(*own, other.to_bits().cast_signed()));
            self.reuse(from, others);
            Ok(())
        };
        self.attempt(|| {
            if self.rank > 0 {
                send(0, numbers)?;
                return each(0, numbers, |_own, sum| sum);
            }
            self.others().try_for_each(|from| each(from, numbers, i64::wrapping_add))?;
            self.others().try_for_each(|to| send(to, numbers))
        })
    }

    fn gather_to_all(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError> {
        self.attempt(|| {
            self.others()
                .try_for_each(|to| self.send(Call::GatherToAll, to, own.iter().copied()))?;
            self.collect(Call::GatherToAll, own)
        })
    }

    fn gather(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError> {
        self.attempt(|| match self.rank {
            0 => self.collect(Call::Gather, own),
            _ => self.send(Call::Gather, 0, own.iter().copied()).map(|()| Vec::new()),
        })
    }

    fn scatter(&self, all: &[Vec<f64>]) -> Result<Vec<f64>, RankError> {
        self.attempt(|| {
            if self.rank > 0 {
                return self.receive(Call::Scatter, 0);
            }
            check_parts(all, self.size)?;
            self.others()
                .try_for_each(|to| self.send(Call::Scatter, to, all[to].iter().copied()))?;
            Ok(all[0].clone())
        })
    }

    fn broadcast(&self, said: Vec<f64>) -> Result<Vec<f64>, RankError> {
        self.attempt(|| {
            if self.rank > 0 {
                return self.receive(Call::Broadcast, 0);
            }
            self.others()
                .try_for_each(|to| self.send(Call::Broadcast, to, said.iter().copied()))?;
            Ok(said)
        })
    }
}
