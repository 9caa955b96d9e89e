//! The program as a user meets it: exit codes, messages, files.

#![allow(clippy::unwrap_used, reason = "the helpers of tests may panic as tests do")]

mod bad_cases;
mod check_and_new;
mod devices;
mod generated;
mod interrupt;
mod mcp;
#[cfg(unix)]
mod mpi;
mod page;
mod report;
mod repository;
mod resume;
mod run;
mod running;
mod support;
mod sweep;
mod verify;
