//! Hypoelastic and elastic-plastic solids: a deviatoric stress that is integrated in time beside the
//! pressure, which follows the density.
//!
//! Tensors are always 3 x 3: in plane strain the deviatoric stress has a third component, and the
//! velocity gradient has zeros there. Paper: CTVF, sections 2 and 4.7.

mod deviator;
mod pressure;
mod strength;

pub use deviator::{advance, jaumann_rate, shear_energy, von_mises};
pub use pressure::{EquationOfState, PressureLaw};
pub use strength::{JohnsonCook, Returned, Strength};
