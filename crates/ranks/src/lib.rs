//! Ranks that compute a run together: threads of one process with a memory of their own each, or processes, as those of
//! MPI are in the crate `piola-mpi`.
//!
//! A rank owns a part of the particles and has copies of those of other ranks that its own see. What ranks tell each
//! other goes through [`Ranks`], and nothing that a run computes depends on how many there are: sums over particles
//! are [`Exact`].

mod alone;
mod exact;
mod message;
mod processes;
mod threads;

pub use alone::Alone;
pub use exact::{Exact, LIMBS};
pub use message::{Message, RankError, check_exchange, check_length, check_parts};
pub use processes::processes;
pub use threads::Threads;

/// What a rank can tell the others. All ranks make the same calls in the same order, but for the partners of an exchange.
/// All bits of numbers arrive, also of those that are NaN. Calls fail, too, if they do not fit together: [`RankError`].
pub trait Ranks: Send + Sync {
    /// The number of this rank, from 0.
    fn rank(&self) -> usize;

    /// How many there are.
    fn size(&self) -> usize;

    /// Sends numbers to other ranks, and fills the messages that come from others. Both sides know how long a message
    /// is; a rank takes no part in messages that it neither sends nor receives.
    ///
    /// # Errors
    /// A rank is lost.
    fn exchange(&self, send: &[Message], receive: &mut [Message]) -> Result<(), RankError>;

    /// Adds up what all ranks have, entry by entry and wrapping around; each gets the sums.
    ///
    /// # Errors
    /// A rank is lost.
    fn add(&self, numbers: &mut [i64]) -> Result<(), RankError>;

    /// What each rank has, by rank; all get all of it. Ranks may have different lengths.
    ///
    /// # Errors
    /// A rank is lost.
    fn gather_to_all(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError>;

    /// What each rank has, by rank, for rank 0; the others get nothing.
    ///
    /// # Errors
    /// A rank is lost.
    fn gather(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError>;

    /// What rank 0 has for each rank, by rank: each gets its own. Of others than rank 0 nothing is taken.
    ///
    /// # Errors
    /// A rank is lost.
    fn scatter(&self, all: &[Vec<f64>]) -> Result<Vec<f64>, RankError>;

    /// What rank 0 says to all; of others nothing is taken.
    ///
    /// # Errors
    /// A rank is lost.
    fn broadcast(&self, said: Vec<f64>) -> Result<Vec<f64>, RankError>;
}
