//! The corrected transport-velocity formulation of weakly compressible fluids with a diffused
//! (EDAC) or algebraic pressure. Paper: CTVF, sections 2 and 3.
//!
//! Particles carry a momentum velocity u and move with the transport velocity uhat = u + d, whose
//! deviation d keeps them evenly spread. With `r_ab = r_a - r_b`, `u_ab = u_a - u_b`,
//! `V = m / rho` and the kernel gradient `grad W_ab` at a, the equations solved are
//!
//! ```text
//! drho_a/dt = rho_a sum V_b u_ab . grad W_ab + sum V_b (rho_b - rho_a) d_a . grad W_ab + E_a / c^2
//!   dp_a/dt = rho_a c^2 sum V_b u_ab . grad W_ab + sum V_b (p_b - p_a) d_a . grad W_ab + E_a
//!   du_a/dt = - sum m_b (p_a / rho_a^2 + p_b / rho_b^2 + Pi_ab) grad W_ab + N_a + g
//!             + sum V_b (u_b - u_a) d_a . grad W_ab
//! ```
//!
//! with the exchange of pressure E, of momentum N and the artificial viscosity Pi of
//! [`piola_formulas::pairs::fluid`]: theory (20) to (22), which say how they depart from the paper. They follow from
//! CTVF (12), (18) and (23); the printed (25), (26), (27) have other signs, and (27) has sums that slow a uniform stream,
//! theory (22).
//!
//! Below free surfaces the density relaxes to the summation density, theory (108).
//!
//! E exchanges what pressures are beyond those of a fluid at rest,
//! `p_b - p_a - (rho_a + rho_b)/2 g . (r_b - r_a)` for the paper's `p_b - p_a`. Inside a fluid that is the
//! same; at a free surface, which has neighbours below only, the pressure of depth would diffuse out
//! without end. The density takes `E_a / c^2`, so that the first two lines are one but for `c^2`: the second is
//! integrated, and the law of state gives the density.
//!
//! There are two systems: a fluid, [`WeaklyCompressible`], and elastic and elastic-plastic bodies,
//! [`Hypoelastic`]. What is said of the fluid of neighbours, walls, surfaces, shifting and time holds for both.
//!
//! Walls are layers of ghost particles, CTVF (46) to (52). Everything that a state needs to go on
//! is in its columns: r, u, rho, p, du/dt, d, and by how much the summation density of a fluid is above rho.

mod barrier;
mod build;
mod common;
mod continua;
mod continuum;
mod device;
mod escape;
mod extent;
mod fields;
mod fluid;
mod forces;
mod inspect;
mod interface;
mod ledger;
mod levels;
mod sample;
mod scheme;
mod settings;
mod share;
mod shifting;
mod sides;
mod solids;
mod split;
mod stages;
mod surface;
mod walls;

use crate::schemes::stages::Stages;

pub use build::{TransportVelocityError, TransportVelocityInput, Wall};
pub use escape::Guard;
pub use fluid::{
    DESCRIPTION as FLUIDS, Flow, Nesting, OpenBoundaries, OpenBoundary, Refined, WeaklyCompressible,
};
pub use forces::{Forces, Rates};
pub(crate) use interface::{Guide, WallSelection};
pub use levels::{Levels, refined};
pub use settings::{
    AtSurface, Corrections, DensityRule, Divergence, Fluid, Gradients, Momentum, PressureRule,
    Settings, Shifting, Slip, Viscous,
};
pub use solids::{
    Contact, DESCRIPTION as SOLIDS, Heat, Hypoelastic, Solid, SolidRates, SolidsInput,
};

use common::{AtRest, Common};
use continua::Continua;
pub use continuum::Continuum;
use fields::{Columns, ColumnsMut};
use interface::Guided;
use sides::Side;
use stages::Pass;
use surface::Opening;

/// The name of the formulation in a case file.
pub const NAME: &str = "transport_velocity";

/// The formulation bound to its particles, and these to their matter.
pub struct TransportVelocity<const D: usize, M: Continuum<D> = WeaklyCompressible<D>> {
    common: Common<D>,
    matter: M,
    /// The state at the start, with its accelerations.
    start: Vec<f64>,
    /// The stages of a step.
    drift: Stages<Pass<M::Own>>,
    accelerate: Stages<Pass<M::Own>>,
}

impl<const D: usize, M: Continuum<D>> TransportVelocity<D, M> {
    /// How often the neighbour list has been made, for those who watch its cost.
    pub fn list_builds(&self) -> u64 {
        self.common.support.list().builds()
    }

    /// Whether a particle (index in memory) belongs to a wall.
    pub fn is_wall(&self, index: u32) -> bool {
        self.common.is_wall.get(index as usize).copied().unwrap_or(false)
    }

    /// Lets the scheme look for particles that escape. Without walls there is nothing to escape
    /// from.
    ///
    /// A particle has gone through a wall if it is behind the plane of the nearest wall particle, at
    /// an edge behind all of them, and not beyond the end of the wall. It has left the box around everything if it is further from that
    /// of the walls, along an axis that is not periodic, than everything is wide at the start.
    pub fn guard(&mut self, guard: Guard) {
        self.common.guard(guard);
    }
}
