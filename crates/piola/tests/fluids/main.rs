//! The transport-velocity formulation.

mod support;
mod taylor_green;
