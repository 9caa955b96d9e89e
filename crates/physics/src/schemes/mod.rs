//! The formulations, one folder each, and what each of them offers to the rest of the program.

pub mod blend;
mod compiled;
pub(crate) mod coupled;
mod description;
mod device;
mod equilibrium;
mod initial;
pub(crate) mod input;
pub mod interpolation;
pub(crate) mod ledger;
mod look;
pub mod momentum;
mod newmark;
mod observation;
mod outside;
mod parts;
mod ranks;
mod rule;
mod scheme;
pub(crate) mod split;
pub(crate) mod stages;
mod theta;
pub mod total_lagrangian;
mod traffic;
pub mod transport_velocity;
pub mod upwind;
pub mod world;

#[doc(hidden)]
pub use compiled::{Doors, compiled};
pub use coupled::CoupledScheme;
pub use description::{Capability, NEWTON_ITERATIONS, SchemeDescription};
pub use device::{DeviceMethod, DeviceRefusal, DeviceStage, DeviceSteps, StepsError};
pub use equilibrium::{Inaccurate, Missed, NoSensitivity, NoSolution, Sensitivity, StaticScheme};
pub use initial::Initial;
pub use input::InputError;
pub use ledger::{Accounts, Filled, Ledger, LedgerFault};
pub use momentum::{MomentumComponent, momentum_components};
pub use newmark::{Newmark, NewmarkScheme, UnstableWeights};
pub use observation::Observation;
pub use ranks::{Part, RankCosts, RankRefusal, RankRows, RankShare};
pub use rule::ImplicitRule;
pub use scheme::{Behind, Escape, Health, Particle, Passage, Scheme, StepLimit};
pub use split::{PartitionedScheme, SplitScheme};
pub use stages::{Phase, Stage, StageFault, Watch};
pub use theta::{Theta, ThetaScheme, UnstableTheta};
pub use traffic::{Array, Traffic};
