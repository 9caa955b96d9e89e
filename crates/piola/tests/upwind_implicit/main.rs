//! Implicit steps of the upwind formulation: equations, tangents, and what steps keep.

#[path = "../support/mod.rs"]
mod support;

mod accuracy;
mod equations;
mod failures;
mod problems;
mod steps;
