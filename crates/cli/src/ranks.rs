//! Ranks that are processes, which something like `mpirun` has started.

use std::sync::Arc;

use piola_ranks::Ranks;

use crate::exit::{Exit, Fault};

/// The rank that this process is, if there are others.
///
/// # Errors
/// MPI cannot be used.
#[cfg(feature = "mpi")]
pub fn start() -> Result<Option<Arc<dyn Ranks>>, Fault> {
    let started = piola_mpi::Mpi::start().map_err(|error| Fault::new(Exit::FailedRun, error))?;
    Ok(started.filter(|ranks| ranks.size() > 1).map(|ranks| Arc::new(ranks) as Arc<dyn Ranks>))
}

/// No rank: the program is built without MPI.
///
/// # Errors
/// There are others, which would all do the same.
#[cfg(not(feature = "mpi"))]
pub fn start() -> Result<Option<Arc<dyn Ranks>>, Fault> {
    match piola_ranks::processes() {
        None | Some(0 | 1) => Ok(None),
        Some(size) => Err(Fault::new(
            Exit::BadCase,
            format_args!(
                "this is one of {size} processes, but the program is built without MPI, so that each of them would do \
                 the whole run: build it with `cargo build --release --features mpi`, or start a single process, with \
                 `--ranks {size}`"
            ),
        )),
    }
}
