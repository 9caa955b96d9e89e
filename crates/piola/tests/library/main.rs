//! The library as those see it who build on it: schemes and operators against exact results, runs,
//! failures, resumption.
//!
//! One program, as the code of the library that is generic over the dimension is compiled anew for each.

mod convergence;
mod deformed_steps;
mod derivatives;
#[path = "../support/device.rs"]
mod device;
mod devices;
mod devices_single;
mod devices_solids;
mod elastodynamics;
mod executor;
mod failures;
#[path = "../support/fields.rs"]
mod fields;
mod fuzz;
mod histories;
mod integrators;
mod ledger;
mod loads;
mod matrices;
mod operators;
mod pair_pass;
mod profiles;
mod ranks;
mod ranks_coupled;
mod ranks_fluids;
mod ranks_implicit;
mod reserve;
mod resume;
mod sensitivity;
mod session;
mod strong_form;
#[path = "../support/mod.rs"]
mod support;
mod traffic;
mod upwind;
