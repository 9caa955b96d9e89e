//! The program as a user meets it: exit codes, messages, files.

#![allow(clippy::unwrap_used, reason = "the helpers of tests may panic as tests do")]

mod bad_cases;
mod check_and_new;
mod generated;
mod interrupt;
mod mcp;
mod page;
mod report;
mod repository;
mod resume;
mod run;
mod support;
mod sweep;
mod verify;
