//! The program as a user meets it: exit codes, messages, files.

mod bad_cases;
mod check_and_new;
mod generated;
mod interrupt;
mod run;
mod support;
mod verify;
