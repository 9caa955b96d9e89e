//! The transport-velocity formulation.

mod escapes;
mod operators;
mod runs;
mod support;
mod surfaces;
mod taylor_green;
mod walls;
