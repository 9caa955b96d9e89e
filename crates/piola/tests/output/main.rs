//! Files that piola writes, read back by other means than those that wrote them.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

mod folders;
mod image;
mod particle_files;
mod particle_reader;
mod pictures;
mod plots;
mod tables;
