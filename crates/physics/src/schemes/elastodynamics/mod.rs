//! The elastodynamics formulation: total Lagrangian solids on SPH matrices.
//! Paper: Elastodynamics.
//!
//! Unknowns of a particle are v and the displacement u. A step takes two products with the matrices
//! of [`ReferenceGradient`](crate::operators::ReferenceGradient): one for the displacement gradient, one
//! for the forces, theory (63):
//!
//! ```text
//! A = X u,   P = P(I + A),   m dv/dt = -X^T (V P) + H u + loads,   du/dt = v
//! ```
//!
//! the *adjoint* form, for any cloud and dimension, or on a row or a box of particles the *strong* form
//! of the paper, `rho dv/dt = X P`, with ghosts that carry displacements and stresses on beyond the
//! edges, theory (64). Both are stepped by central differences, Elastodynamics (4.4), as kicks and drifts.

mod build;
mod dissipation;
mod edges;
mod evaluate;
mod external;
mod fields;
mod ghosts;
mod holes;
mod inspect;
mod matrices;
mod scheme;
mod settings;
mod slopes;
mod split;
mod stable_step;
mod stages;
mod tractions;

pub use build::{ElastodynamicsError, ElastodynamicsInput};
pub use holes::Hole;
pub use scheme::DESCRIPTION;
pub use settings::{Configuration, Form, Mixture, Settings};

use piola_formulas::kernels::Kernel;

use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{BodyForce, traction::Loaded};
use crate::geometry::Particles;
use crate::neighbors::Domain;
use crate::operators::Mirror;
use crate::schemes::Accounts;
use crate::schemes::ledger::Entry;
use crate::schemes::stages::Stages;
use crate::{Tensor, Vector};

use matrices::Matrices;

/// The elastodynamics formulation bound to its particles.
pub struct Elastodynamics<const D: usize> {
    particles: Particles<D>,
    kernel: Kernel,
    radius: Vec<f64>,
    group: Vec<u32>,
    domain: Domain<D>,
    settings: Settings,
    mixtures: Vec<Mixture<D>>,
    /// Which mixture each particle is made of.
    mixture: Vec<u32>,
    mass: Vec<f64>,
    matrices: Matrices<D>,
    /// Symmetry planes and rollers, each with a particle that lies on it.
    mirrors: Vec<(Mirror, usize)>,
    stable: stable_step::Bound,
    /// Moduli of the slowest and the fastest wave at rest of each mixture, Pa.
    moduli_at_rest: Vec<[f64; 2]>,
    /// A particle of the last look that has lost its convexity, with its displacement gradient.
    not_convex: Option<(usize, Tensor<D>)>,
    body_forces: Vec<BodyForce<D>>,
    loaded: Vec<Loaded<D>>,
    prescribed: PrescribedComponents,
    /// Whether gradients and forces are those of the displacements at hand.
    is_evaluated: bool,
    /// Whether there are matrices at the places of the moment.
    has_matrices: bool,
    /// The stages of an evaluation.
    stages: Stages<stages::Pass>,
    /// Displacements, with values of images or data of edges behind.
    displacement: Vec<Vector<D>>,
    /// The same of velocities, empty where they are not needed, and in the strong form of accelerations.
    velocity: Vec<Vector<D>>,
    acceleration: Vec<Vector<D>>,
    gradient: Vec<Tensor<D>>,
    /// Rate of the gradient; empty without dissipation.
    gradient_rate: Vec<Tensor<D>>,
    /// Elastic first Piola-Kirchhoff stress.
    stress: Vec<Tensor<D>>,
    /// What forces gather, zero for images.
    tension: Vec<Tensor<D>>,
    /// Internal forces, those on images behind.
    force: Vec<Vector<D>>,
    /// Scratch of the length of a state.
    rate: Vec<f64>,
    /// The state at the start.
    initial: Vec<f64>,
}

/// The energies of the formulation.
const ENERGIES: [&str; 3] = ["kinetic", "strain", "hourglass"];

const LEDGER: Accounts = Accounts {
    mechanisms: &["body_force", "traction", "boundary_motion", "viscosity", "damping"],
    impulses: &["body_force", "traction", "boundary_motion", "damping"],
    is_kicked: true,
};
const BODY_FORCE: Entry = LEDGER.entry("body_force");
const TRACTION: Entry = LEDGER.entry("traction");
const BOUNDARY_MOTION: Entry = LEDGER.entry("boundary_motion");
const VISCOSITY: Entry = LEDGER.entry("viscosity");
const DAMPING: Entry = LEDGER.entry("damping");
