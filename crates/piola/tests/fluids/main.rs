//! The transport-velocity formulation.

mod operators;
mod support;
mod taylor_green;
