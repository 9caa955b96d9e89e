//! Ranks that are processes of MPI, with the feature `mpi`. Without it there is nothing here, and no MPI is needed.

#[cfg(feature = "mpi")]
mod process;

#[cfg(feature = "mpi")]
pub use process::Mpi;
