//! The upwind formulation: total Lagrangian, mixed in velocity and volume ratio, stabilised by
//! an acoustic Riemann solver. Paper: Upwind, equations (3.39) to (3.57).
//!
//! Unknowns of a particle are v, J, x and F. Reference density is `rho`, quadrature volume V,
//! `G_ab` the corrected gradient of [`crate::operators::GradientOperator`], H = cof F and
//! p = p(J) of the evolved J, theory (8) to (11):
//!
//! ```text
//! rho dv_a/dt = 1/V_a sum_b p_b V_b H_b G_ba + A_a t_a / V_a + rho g + D_v / V_a
//!     dJ_a/dt = H_a : dF_a/dt + D_p / V_a
//!     dF_a/dt = sum_b (v_b - v_a) (x) G_ab
//!     dx_a/dt = v_a
//! ```
//!
//! The first sum runs over a itself too, which makes it the exact adjoint of the third: internal
//! power is `-sum_a V_a p_a dJ_a/dt` to round-off, whatever the correction and the weights, and
//! a free surface needs no treatment.

mod build;
mod device;
mod fields;
mod folding;
mod implicit;
mod inspect;
mod local;
mod pairs;
mod partitioned;
mod passes;
mod reconstruction;
mod scheme;
mod settings;
mod share;

use piola_formulas::pairs::upwind::{Side, Slope};
use piola_formulas::volumetric::{Prestressed, VolumetricLaw};

use crate::Vector;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::traction::Loaded;
use crate::geometry::Particles;
use crate::operators::{LeastSquares, PairAreas, Support};
use crate::parallel::Team;
use crate::schemes::ledger::Entry;
use crate::schemes::stages::Stages;
use crate::schemes::{Accounts, NEWTON_ITERATIONS};

pub use build::{UpwindError, UpwindInput};
pub use implicit::{ImplicitSettings, StepEquations};
pub use scheme::DESCRIPTION;
pub use settings::{Material, Settings, WaveSpeed};

pub use crate::boundaries::BodyForce;
pub use crate::schemes::Initial;

use implicit::Implicit;

/// The upwind formulation bound to its particles.
pub struct Upwind<const D: usize> {
    particles: Particles<D>,
    support: Support<D>,
    areas: PairAreas<D>,
    least_squares: Option<LeastSquares<D>>,
    settings: Settings,
    /// One a body.
    materials: Vec<Material>,
    reference: Vec<Reference>,
    initial_velocity: Vec<Vector<D>>,
    /// Distance to the nearest neighbour in the reference, m.
    nearest: Vec<f64>,
    /// Largest `1/V_a sum_b 1/2 |N . C_ab|` over all particles, 1/m: see `inspect`.
    largest_exchange: f64,
    /// Largest wave speed of the reference state, m/s.
    fastest_reference: f64,
    body_forces: Vec<BodyForce<D>>,
    prescribed: PrescribedComponents,
    /// Whether tractions or prescribed motion act on any particle, of this rank or of others.
    is_driven: bool,
    /// Who else computes it.
    team: Team,
    /// Acceleration by body forces: constant in time if all of them are steady.
    body_acceleration: Vec<Vector<D>>,
    steady_body_force: bool,
    /// The stages of an evaluation.
    stages: Stages<passes::Pass>,
    /// External force of the tractions on each particle in N, with the particles that have one.
    loaded: Vec<Loaded<D>>,
    sides: Vec<Side<f64, D>>,
    slopes: Vec<Slope<f64, D>>,
    /// Rates of the last observation that asked for them.
    observed: Vec<f64>,
    /// What implicit steps need, if it was built for them.
    implicit: Option<Box<Implicit<D>>>,
}

/// Reference values of a particle that its material and its start give.
#[derive(Clone, Copy, Debug)]
struct Reference {
    /// Density of the (prestressed) reference in kg/m^3.
    density: f64,
    /// Volume ratio J0 of the prestress against the stress-free state.
    ratio: f64,
    /// Wave speed at the reference in m/s.
    wave_speed: f64,
}

/// The energies of the formulation.
const ENERGIES: [&str; 2] = ["kinetic", "strain"];

/// Pairs exchange what one of them loses, so that momentum enters neither by internal forces nor by
/// dissipation.
const LEDGER: Accounts = Accounts {
    mechanisms: &[
        "body_force",
        "traction",
        "boundary_motion",
        "upwind_velocity",
        "upwind_pressure",
    ],
    impulses: &["body_force", "traction", "boundary_motion"],
    is_kicked: false,
};
const BODY_FORCE: Entry = LEDGER.entry("body_force");
const TRACTION: Entry = LEDGER.entry("traction");
const BOUNDARY_MOTION: Entry = LEDGER.entry("boundary_motion");
const UPWIND_VELOCITY: Entry = LEDGER.entry("upwind_velocity");
const UPWIND_PRESSURE: Entry = LEDGER.entry("upwind_pressure");

/// What the table of steps has besides: of implicit steps, which the state keeps behind its ledger, and
/// whether the lattice has folded.
const FIGURES: [(&str, &str); 3] =
    [(NEWTON_ITERATIONS, "1"), ("linear_steps", "1"), ("least_corner", "1")];

/// Those that the state keeps.
const KEPT: usize = 2;

impl<const D: usize> Upwind<D> {
    /// The law of particle a with its prestress.
    #[inline]
    fn law(&self, a: usize) -> Prestressed {
        let law: VolumetricLaw = self.materials[self.particles.body[a] as usize].law;
        Prestressed { law, reference_ratio: self.reference[a].ratio }
    }

    /// Mass of particle a in kg (per unit of the missing dimensions).
    #[inline]
    fn mass(&self, a: usize) -> f64 {
        self.reference[a].density * self.particles.volume[a]
    }
}
