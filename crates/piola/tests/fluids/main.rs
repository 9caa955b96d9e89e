//! The transport-velocity formulation.

mod bodies;
mod escapes;
mod operators;
mod runs;
mod solids;
mod support;
mod surfaces;
mod taylor_green;
mod walls;
