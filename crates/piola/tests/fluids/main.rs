//! The transport-velocity formulation.

mod background;
mod bodies;
mod clamps;
mod contact;
#[path = "../support/device.rs"]
mod device;
mod edac;
mod escapes;
#[path = "../support/fields.rs"]
mod fields;
mod held;
mod layers;
mod levels;
mod open;
mod operators;
mod planning;
mod probes;
mod removal;
mod runs;
mod shapes;
mod solids;
mod speeds;
mod stiff;
mod structures;
mod subcycles;
mod support;
mod surfaces;
mod taylor_green;
mod touching;
mod walls;
mod waves;
