//! The corrected transport-velocity formulation of weakly compressible fluids with a diffused
//! (EDAC) or algebraic pressure. Paper: CTVF, sections 2 and 3.
//!
//! Particles carry a momentum velocity u and move with the transport velocity uhat = u + d, whose
//! deviation d keeps them evenly spread. With `r_ab = r_a - r_b`, `u_ab = u_a - u_b`,
//! `V = m / rho` and the kernel gradient `grad W_ab` at a, the equations solved are
//!
//! ```text
//! drho_a/dt = rho_a sum V_b u_ab . grad W_ab + sum V_b (rho_b - rho_a) d_b . grad W_ab + E_a / c^2
//!   dp_a/dt = rho_a c^2 sum V_b u_ab . grad W_ab + sum V_b (p_b - p_a) d_b . grad W_ab + E_a
//!   du_a/dt = - sum m_b (p_a / rho_a^2 + p_b / rho_b^2 + Pi_ab) grad W_ab + N_a + g
//!             + sum m_b (u_a d_a / rho_a + u_b d_b / rho_b) . grad W_ab
//!             + u_a / rho_a sum V_b (rho d)_ab . grad W_ab
//! ```
//!
//! with the exchange of pressure E, of momentum N and the artificial viscosity Pi of
//! [`piola_formulas::pairs::fluid`]: theory (20) to (22), which say where the paper departs. They follow from CTVF (12), (19) and (23); the printed (25), (26),
//! (27) have other signs. The first two lines are theirs with the terms of uhat collected:
//! `rho_a uhat_ab - (rho d)_ab = rho_a u_ab + (rho_b - rho_a) d_b`, and likewise for p.
//!
//! E exchanges what pressures are beyond those of a fluid at rest,
//! `p_b - p_a - (rho_a + rho_b)/2 g . (r_b - r_a)` for the paper's `p_b - p_a`. Inside a fluid that is the
//! same; at a free surface, which has neighbours below only, the pressure of depth would diffuse out
//! without end. The density takes `E_a / c^2`, which ties it to the pressure.
//!
//! Instead of a fluid there may be elastic and elastic-plastic bodies, see [`Solid`]; what is said of the
//! fluid of neighbours, walls, surfaces, shifting and time holds for them.
//!
//! Walls are layers of ghost particles, CTVF (46) to (52). Everything that a state needs to go on
//! is in its columns: r, u, rho, p, du/dt and d.

mod barrier;
mod build;
mod density;
mod device;
mod drift;
mod escape;
mod fields;
mod forces;
mod inspect;
mod ledger;
mod sample;
mod scheme;
mod settings;
mod shifting;
mod sides;
mod solids;
mod split;
mod stages;
mod surface;
mod walls;

use crate::Vector;
use crate::boundaries::{BodyForce, prescribed::PrescribedComponents};
use crate::geometry::Particles;
use crate::operators::MovingSupport;
use crate::schemes::Accounts;
use crate::schemes::ledger::Entry;
use crate::schemes::stages::Stages;

pub use build::{TransportVelocityError, TransportVelocityInput, Wall};
pub use drift::Rates;
pub use escape::Guard;
pub use forces::Forces;
pub use scheme::DESCRIPTION;
pub use settings::{
    AtSurface, Corrections, DensityRule, Dilatation, Divergence, Fluid, PressureRule, Settings,
    Shifting, Slip,
};
pub use solids::{Contact, Heat, Solid, SolidRates, SolidsInput};

use barrier::Hold;
use fields::{Columns, ColumnsMut};
use shifting::Iteration;
use sides::Side;
use solids::{Continua, Solids};
use stages::Pass;
use surface::Opening;
use walls::{WallParticle, WallValues};

/// The formulation bound to its particles.
pub struct TransportVelocity<const D: usize> {
    /// Reference state; the number of a particle is its index here.
    particles: Particles<D>,
    support: MovingSupport<D>,
    settings: Settings,
    fluid: Fluid,
    /// Mass by number, kg.
    mass: Vec<f64>,
    is_wall: Vec<bool>,
    walls: Vec<WallParticle<D>>,
    /// What walls do to fluid that touches them, by place; empty without walls, and of solids.
    holds: Vec<Hold<D>>,
    wall_values: Vec<WallValues<D>>,
    /// Velocity with which walls move, and with which their surface slides where it is.
    motion: PrescribedComponents,
    sliding: PrescribedComponents,
    body_forces: Vec<BodyForce<D>>,
    /// The state at the start, with its accelerations.
    start: Vec<f64>,
    /// The stages of a step.
    drift: Stages<Pass>,
    accelerate: Stages<Pass>,
    /// The largest speed that the last pass over densities has seen, in m/s.
    fastest: f64,
    // Scratch, by place.
    sides: Vec<Side<D>>,
    densities: Vec<f64>,
    rates: Vec<Rates>,
    forces: Vec<Forces<D>>,
    /// Velocity of each wall particle that viscous forces see.
    shear: Vec<Vector<D>>,
    /// Where free surfaces are, if they are looked for, and scratch of the search.
    openings: Vec<Opening<D>>,
    found: Vec<(Vector<D>, bool)>,
    marks: Vec<bool>,
    iteration: Iteration<D>,
    /// Who looks for particles that escape, with the width of everything at the start in m.
    guard: Option<(Guard, f64)>,
    /// What there is besides where particles are of solids.
    solids: Option<Box<Solids<D>>>,
    /// To which continuum a particle belongs, by place.
    continua: Continua<D>,
    /// The particles that have been removed, by number; empty where none ever is. They are passive,
    /// as walls are.
    removed: Vec<bool>,
    /// The first particle whose place was no number, if the neighbours could not be found.
    lost: Option<usize>,
}

/// The energies of the formulation.
const ENERGIES: [&str; 3] = ["kinetic", "compression", "shear"];

/// The ledger of the formulation.
///
/// `pressure` is what the exchange between kinetic energy and that of compression fails to
/// conserve: the discrete force and divergence are not exact adjoints. Of solids it is all stress.
///
/// Viscous forces act along `u_ab` and turn the fluid; the corrections neither come in pairs, nor do
/// particles move along their velocity. What is removed takes its momentum along.
const LEDGER: Accounts = Accounts {
    mechanisms: &[
        "pressure",
        "viscosity",
        "artificial_viscosity",
        "transport",
        "walls",
        "body_force",
        "pressure_diffusion",
        "removed",
        "plasticity",
    ],
    impulses: &["walls", "body_force", "viscosity", "corrections", "removed"],
    is_kicked: true,
};
const PRESSURE: Entry = LEDGER.entry("pressure");
const VISCOSITY: Entry = LEDGER.entry("viscosity");
const ARTIFICIAL_VISCOSITY: Entry = LEDGER.entry("artificial_viscosity");
const TRANSPORT: Entry = LEDGER.entry_by("transport", "corrections");
const WALLS: Entry = LEDGER.entry("walls");
const BODY_FORCE: Entry = LEDGER.entry("body_force");
const PRESSURE_DIFFUSION: Entry = LEDGER.entry("pressure_diffusion");
const REMOVED: Entry = LEDGER.entry("removed");
const PLASTICITY: Entry = LEDGER.entry("plasticity");

/// The mechanisms that accelerate.
const ACCELERATING: [Entry; 6] =
    [PRESSURE, VISCOSITY, ARTIFICIAL_VISCOSITY, TRANSPORT, WALLS, BODY_FORCE];

/// The mechanisms of a drift.
const DRIFTING: [Entry; 4] = [PRESSURE, TRANSPORT, PRESSURE_DIFFUSION, PLASTICITY];

impl<const D: usize> TransportVelocity<D> {
    /// How often the neighbour list has been made, for those who watch its cost.
    pub fn list_builds(&self) -> u64 {
        self.support.list().builds()
    }

    /// Whether a particle (index in memory) belongs to a wall.
    pub fn is_wall(&self, index: u32) -> bool {
        self.is_wall.get(index as usize).copied().unwrap_or(false)
    }

    /// The columns of a state, and its tail.
    fn columns<'a>(&self, state: &'a [f64]) -> Columns<'a, D> {
        Columns::of(state, self.particles.len())
    }

    /// The same, to be changed.
    fn parts<'a>(&self, state: &'a mut [f64]) -> (ColumnsMut<'a, D>, &'a mut [f64]) {
        ColumnsMut::of(state, self.particles.len())
    }
}
