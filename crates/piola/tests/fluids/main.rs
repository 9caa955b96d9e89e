//! The transport-velocity formulation.

mod operators;
mod runs;
mod support;
mod taylor_green;
