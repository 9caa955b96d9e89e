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
    let started = piola_ranks::Mpi::start().map_err(|error| Fault::new(Exit::FailedRun, error))?;
    Ok(started.filter(|ranks| ranks.size() > 1).map(|ranks| Arc::new(ranks) as Arc<dyn Ranks>))
}

/// Variables by which what starts processes tells them how many they are.
#[cfg(not(feature = "mpi"))]
const SIZES: [&str; 2] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"];

/// No rank: the program is built without MPI.
///
/// # Errors
/// There are others, which would all do the same.
#[cfg(not(feature = "mpi"))]
pub fn start() -> Result<Option<Arc<dyn Ranks>>, Fault> {
    let told = SIZES.iter().filter_map(|name| std::env::var(name).ok()?.parse::<usize>().ok());
    match told.max().unwrap_or(1) {
        0 | 1 => Ok(None),
        size => Err(Fault::new(
            Exit::BadCase,
            format_args!(
                "{size} processes were started, but this program is built without MPI, so that each would do all: build \
                 it with `cargo build --release --features mpi`, or start one process with `--ranks {size}`"
            ),
        )),
    }
}
