//! Ranks that are processes of MPI.

use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, ThreadId};

use mpi::Count;
use mpi::collective::SystemOperation;
use mpi::datatype::{Equivalence, PartitionMut};
use mpi::environment::{Threading, Universe, initialize_with_threading};
use mpi::request::multiple_scope;
use mpi::topology::{Process, SimpleCommunicator};
use mpi::traits::*;

use piola_ranks::{
    Message, RankError, Ranks, check_exchange, check_length, check_parts, processes,
};

/// What a rank that has panicked, or whose call has failed, ends all with.
const FAILED: i32 = 1;

/// Kinds of messages from one rank to another.
mod tag {
    pub const EXCHANGE: i32 = 0;
    pub const GATHER: i32 = 1;
    pub const SCATTER: i32 = 2;
}

/// A rank that is a process started by `mpirun` or the like.
///
/// Calls come from the thread that has started it (`MPI_THREAD_FUNNELED`), which drops it in the end; it then waits until
/// all ranks do. A rank that fails has to say why and [abort](Self::abort), which ends all. This is done for those that
/// panic, and for those that drop it after a call has failed. Lost ranks are therefore never heard of. Messages have
/// fewer than 2³¹ numbers, and so has all that is gathered to all.
pub struct Mpi {
    universe: Universe,
    rank: usize,
    size: usize,
    thread: ThreadId,
    has_failed: AtomicBool,
}

impl Mpi {
    /// The rank that this process is; `None` if it was not started by `mpirun` or the like.
    ///
    /// # Errors
    /// MPI was started before, does not allow for threads, or is another one than that of `mpirun`.
    pub fn start() -> Result<Option<Self>, RankError> {
        let Some(told) = processes() else { return Ok(None) };
        let (universe, threading) = initialize_with_threading(Threading::Funneled)
            .ok_or(RankError::Mpi("it was started before: start it once"))?;
        if threading < Threading::Funneled {
            return Err(RankError::Mpi("it does not allow for threads: use one that does"));
        }
        let world = universe.world();
        let (rank, size) = (world.rank() as usize, world.size() as usize);
        // Those that another MPI has started do not find each other.
        if size < told {
            return Err(RankError::Mpi(
                "the processes do not find each other: start them by the `mpirun` of the MPI that this program was built \
                 with, or under Slurm by `srun --mpi=pmix`",
            ));
        }
        let thread = thread::current().id();
        Ok(Some(Self { universe, rank, size, thread, has_failed: AtomicBool::new(false) }))
    }

    /// Ends all ranks at once, this one included; `code` is what `mpirun` returns.
    pub fn abort(&self, code: i32) -> ! {
        self.world().abort(code)
    }

    fn world(&self) -> SimpleCommunicator {
        self.universe.world()
    }

    /// Makes a call, unless an earlier one has failed.
    fn attempt<T>(
        &self,
        call: impl FnOnce(&SimpleCommunicator) -> Result<T, RankError>,
    ) -> Result<T, RankError> {
        if self.has_failed.load(Ordering::Relaxed) {
            return Err(RankError::Lost(self.rank));
        }
        let elsewhere =
            "another thread than the one that has started it calls it: call it from that one";
        let called = match thread::current().id() == self.thread {
            true => call(&self.world()),
            false => Err(RankError::Mpi(elsewhere)),
        };
        called.inspect_err(|_| self.has_failed.store(true, Ordering::Relaxed))
    }
}

impl Drop for Mpi {
    /// Others may wait for a rank that has failed, for which the end of MPI would then wait.
    fn drop(&mut self) {
        if thread::panicking() || self.has_failed.load(Ordering::Relaxed) {
            self.abort(FAILED);
        }
    }
}

/// A number of numbers as MPI takes it.
fn count(length: usize) -> Result<Count, RankError> {
    Count::try_from(length).map_err(|_| RankError::TooLong(length))
}

/// A rank, which is known to exist.
fn process(world: &SimpleCommunicator, rank: usize) -> Process<'_> {
    world.process_at_rank(rank as i32)
}

impl Ranks for Mpi {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn exchange(&self, send: &[Message], receive: &mut [Message]) -> Result<(), RankError> {
        self.attempt(|world| {
            check_exchange(send, receive, self.rank, self.size)?;
            send.iter().chain(&*receive).try_for_each(|m| count(m.numbers.len()).map(drop))?;
            let mut lengths = Ok(());
            multiple_scope(send.len() + receive.len(), |scope, requests| {
                for Message { rank, numbers } in send {
                    let process = process(world, *rank);
                    requests.add(process.immediate_send_with_tag(
                        scope,
                        &numbers[..],
                        tag::EXCHANGE,
                    ));
                }
                for Message { rank, numbers } in receive {
                    // A message that is too long for its receiver would end the process.
                    let (message, status) =
                        process(world, *rank).matched_probe_with_tag(tag::EXCHANGE);
                    let got = status.count(f64::equivalent_datatype()) as usize;
                    match check_length(*rank, numbers.len(), got) {
                        Ok(()) => {
                            let numbers = &mut numbers[..];
                            requests.add(message.immediate_matched_receive_into(scope, numbers));
                        }
                        wrong => {
                            // Its sender waits until somebody takes it.
                            message.matched_receive_into(&mut vec![0.0; got][..]);
                            lengths = lengths.clone().and(wrong);
                        }
                    }
                }
                requests.wait_all(&mut Vec::new());
            });
            lengths
        })
    }

    fn add(&self, numbers: &mut [i64]) -> Result<(), RankError> {
        self.attempt(|world| {
            count(numbers.len())?;
            // Sums of unsigned integers wrap around.
            let own: Vec<u64> = numbers.iter().map(|n| n.cast_unsigned()).collect();
            let mut sums = vec![0u64; own.len()];
            world.all_reduce_into(&own[..], &mut sums[..], SystemOperation::sum());
            numbers.iter_mut().zip(sums).for_each(|(number, sum)| *number = sum.cast_signed());
            Ok(())
        })
    }

    fn gather_to_all(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError> {
        self.attempt(|world| {
            let mut lengths = vec![0u64; self.size];
            world.all_gather_into(&(own.len() as u64), &mut lengths[..]);
            // All ranks refuse what is too long.
            let whole = lengths.iter().sum::<u64>() as usize;
            count(whole)?;
            let counts: Vec<Count> = lengths.iter().map(|&length| length as Count).collect();
            let starts: Vec<Count> = counts
                .iter()
                .scan(0, |next, count| Some(std::mem::replace(next, *next + count)))
                .collect();
            let mut all = vec![0.0; whole];
            world.all_gather_varcount_into(
                own,
                &mut PartitionMut::new(&mut all[..], &counts[..], &starts[..]),
            );
            let part = |(&start, &count): (&Count, &Count)| {
                all[start as usize..][..count as usize].to_vec()
            };
            Ok(starts.iter().zip(&counts).map(part).collect())
        })
    }

    fn gather(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError> {
        self.attempt(|world| {
            count(own.len())?;
            if self.rank > 0 {
                process(world, 0).send_with_tag(own, tag::GATHER);
                return Ok(Vec::new());
            }
            let others =
                (1..self.size).map(|rank| process(world, rank).receive_vec_with_tag(tag::GATHER).0);
            Ok(std::iter::once(own.to_vec()).chain(others).collect())
        })
    }

    fn scatter(&self, all: &[Vec<f64>]) -> Result<Vec<f64>, RankError> {
        self.attempt(|world| {
            if self.rank > 0 {
                return Ok(process(world, 0).receive_vec_with_tag(tag::SCATTER).0);
            }
            check_parts(all, self.size)?;
            all.iter().try_for_each(|part| count(part.len()).map(drop))?;
            for (rank, part) in all.iter().enumerate().skip(1) {
                process(world, rank).send_with_tag(&part[..], tag::SCATTER);
            }
            Ok(all[0].clone())
        })
    }

    fn broadcast(&self, mut said: Vec<f64>) -> Result<Vec<f64>, RankError> {
        self.attempt(|world| {
            let root = process(world, 0);
            let mut length = said.len() as u64;
            root.broadcast_into(&mut length);
            // All ranks refuse what is too long.
            count(length as usize)?;
            said.resize(length as usize, 0.0);
            root.broadcast_into(&mut said[..]);
            Ok(said)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_into_31_bits_is_refused() {
        assert_eq!(count((1 << 31) - 1), Ok(i32::MAX));
        assert_eq!(count(1 << 31), Err(RankError::TooLong(1 << 31)));
        assert_eq!(count(usize::MAX), Err(RankError::TooLong(usize::MAX)));
    }
}
