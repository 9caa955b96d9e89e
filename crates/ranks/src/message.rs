//! What goes from one rank to another.

use thiserror::Error;

/// Numbers for a rank, or of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Message {
    /// The other rank.
    pub rank: usize,
    /// What is told.
    pub numbers: Vec<f64>,
}

/// Why ranks cannot go on together. A rank whose call has failed has left the others, and is lost to them.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum RankError {
    /// A rank has ended or failed.
    #[error("rank {0} is lost: it has failed or was ended")]
    Lost(usize),
    /// A message has another length than its receiver expects.
    #[error(
        "rank {rank} has sent {got} numbers where {expected} were expected: make the message that receives as long as \
         the one that is sent"
    )]
    Length {
        /// The rank that has sent it.
        rank: usize,
        /// Numbers there is room for.
        expected: usize,
        /// Numbers sent.
        got: usize,
    },
    /// Two ranks do not make the same calls in the same order.
    #[error(
        "rank {rank} has called `{got}` where this one calls `{expected}`: make the same calls in the same order on all \
         ranks"
    )]
    Call {
        /// The other rank.
        rank: usize,
        /// What this rank calls.
        expected: &'static str,
        /// What the other one does.
        got: &'static str,
    },
    /// A message for nobody, or of nobody.
    #[error("there is no rank {rank}: take one below {size}")]
    Nobody {
        /// The rank asked for.
        rank: usize,
        /// How many there are.
        size: usize,
    },
    /// A rank that is sending to itself does not receive as much, or the other way around.
    #[error(
        "this rank sends {sent} messages to itself, and receives {received} of itself: receive each of them once"
    )]
    Own {
        /// Messages to itself.
        sent: usize,
        /// Messages of itself.
        received: usize,
    },
    /// What rank 0 shares out is not one part for each rank.
    #[error("there are {got} parts for {expected} ranks: share out one for each")]
    Parts {
        /// Ranks.
        expected: usize,
        /// Parts.
        got: usize,
    },
    /// MPI counts in 31 bits.
    #[error("MPI does not take {0} numbers at once: take more ranks, so that each has fewer")]
    TooLong(usize),
    /// MPI is not there, or is used in a way that it does not allow.
    #[error("MPI cannot be used: {0}")]
    Mpi(&'static str),
}

/// Refuses an exchange that no rank `rank` of `size` can make, whatever the others do.
///
/// # Errors
/// [`RankError::Nobody`] and [`RankError::Own`].
pub fn check_exchange(
    send: &[Message],
    receive: &[Message],
    rank: usize,
    size: usize,
) -> Result<(), RankError> {
    match send.iter().chain(receive).find(|message| message.rank >= size) {
        Some(message) => Err(RankError::Nobody { rank: message.rank, size }),
        None => {
            let own = |messages: &[Message]| messages.iter().filter(|m| m.rank == rank).count();
            let (sent, received) = (own(send), own(receive));
            if sent == received { Ok(()) } else { Err(RankError::Own { sent, received }) }
        }
    }
}

/// Refuses a message of another length than there is room for.
///
/// # Errors
/// [`RankError::Length`].
pub fn check_length(rank: usize, expected: usize, got: usize) -> Result<(), RankError> {
    if got == expected { Ok(()) } else { Err(RankError::Length { rank, expected, got }) }
}

/// Refuses to share out anything but one part for each rank.
///
/// # Errors
/// [`RankError::Parts`].
pub fn check_parts(all: &[Vec<f64>], size: usize) -> Result<(), RankError> {
    if all.len() == size {
        Ok(())
    } else {
        Err(RankError::Parts { expected: size, got: all.len() })
    }
}
