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

/// Why ranks cannot go on together.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum RankError {
    /// A rank has ended or failed.
    #[error("rank {0} is lost: it has failed or was ended")]
    Lost(usize),
}
