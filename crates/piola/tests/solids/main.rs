//! Total Lagrangian solids.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

#[path = "../support/fields.rs"]
mod fields;
#[path = "../support/mod.rs"]
mod support;

mod clouds;
mod combinations;
mod energy;
mod gradients;
mod implicit;
mod joined;
mod rigid;
mod rigid_refusals;
mod runs;
mod scalar;
mod statics;
mod stretch;
mod turned;
