//! The formulations, one folder each, and what each of them offers to the rest of the program.

pub mod dual_support;
mod equilibrium;
mod initial;
pub mod momentum;
mod scheme;
mod split;
pub mod transport_velocity;
pub mod upwind;

pub use equilibrium::{Missed, NoEquilibrium, StaticScheme};
pub use initial::Initial;
pub use momentum::{MomentumComponent, momentum_components};
pub use scheme::{Escape, Health, Ledger, Particle, Scheme, StepLimit, snapshot};
pub use split::SplitScheme;
