//! The dual-support formulation of elastic solids: total Lagrangian, from one discrete energy.
//! Paper: Dual-support.
//!
//! Unknowns of a particle are v and the displacement u. With the coefficients `G_ab` of
//! [`crate::operators::DualGradient`] on supports of any size, theory (44) to (49):
//!
//! ```text
//! E   = sum_a V_a psi(A_a) + sum_a sum_b c_ab |A_a X_ab - u_ab|^2,   A_a = sum_b u_ab (x) G_ab
//! m_a dv_a/dt = - dE/du_a + A_a t_a + m_a g,   du_a/dt = v_a
//! ```
//!
//! Forces are the exact gradient of E, whatever the supports, the weights and the correction, so
//! that energy and momentum are kept by construction; dual supports come out of the derivative by
//! themselves. Displacements instead of positions keep the digits of small strains.
//!
//! In statics the potential is stationary, and v is the rate of u by the load factor. Implicit steps
//! are statics with inertia.

mod build;
mod discrete;
mod equilibrium;
mod external;
mod fields;
mod inspect;
mod newmark;
mod scheme;
mod settings;
mod split;
mod stable_step;
mod stages;
mod statics;

pub use build::{DualSupportError, DualSupportInput};
pub use discrete::Discrete;
pub use scheme::DESCRIPTION;
pub use settings::{Gradients, Motion, Settings};
pub use statics::free_to_move;
pub use statics::{
    InertialStep, Known, Reaction, StaticState, Statics, StaticsError, StaticsInput, Stiffness,
};

use std::sync::Arc;

pub use super::solid::Material;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::boundaries::{BodyForce, pressure::Pressed, traction::Loaded};
use crate::operators::Strained;
use crate::schemes::Accounts;
use crate::schemes::ledger::Entry;
use crate::schemes::stages::Stages;
use crate::{Tensor, Vector};

/// The dual-support formulation bound to its particles.
pub struct DualSupport<const D: usize> {
    discrete: Arc<Discrete<D>>,
    /// The stages of an evaluation.
    stages: Stages<stages::Pass>,
    /// Loads and supports, where states are solved for.
    statics: Option<Box<Statics<D>>>,
    /// Whether nothing moves.
    is_static: bool,
    /// Mass of each particle in kg (per unit of the missing dimensions).
    mass: Vec<f64>,
    initial_velocity: Vec<Vector<D>>,
    /// Largest stable step of central differences at rest, s, and where it is felt most.
    stable_step: f64,
    stiffest: usize,
    /// Moduli of the slowest and the fastest wave at rest of each material, Pa.
    moduli_at_rest: Vec<[f64; 2]>,
    /// The last particle seen to have lost its convexity, with its displacement gradient.
    not_convex: Option<(usize, Tensor<D>)>,
    /// Load factors of the first step that may have gone over a limit of the load.
    jumped: Option<[f64; 2]>,
    body_forces: Vec<BodyForce<D>>,
    loaded: Vec<Loaded<D>>,
    pressed: Vec<Pressed<D>>,
    prescribed: PrescribedComponents,
    strained: Strained<D>,
    force: Vec<Vector<D>>,
    /// Scratch of the length of a state.
    rate: Vec<f64>,
    /// What holds each particle in the last observation, N.
    reaction: Vec<Vector<D>>,
}

/// The energies of the formulation.
const ENERGIES: [&str; 3] = ["kinetic", "strain", "hourglass"];

/// Momentum enters by all mechanisms, since forces between particles cancel.
const LEDGER: Accounts = Accounts { mechanisms: &OUTSIDE, impulses: &OUTSIDE, is_kicked: true };
const OUTSIDE: [&str; 4] = ["body_force", "traction", "pressure", "boundary_motion"];
const BODY_FORCE: Entry = LEDGER.entry("body_force");
const TRACTION: Entry = LEDGER.entry("traction");
const PRESSURE: Entry = LEDGER.entry("pressure");
const BOUNDARY_MOTION: Entry = LEDGER.entry("boundary_motion");

/// Numbers behind the ledger that belong to its last step: iterations of Newton's method, the load
/// factor, and the length in m that displacements have moved by per unit of arc length.
const FIGURES: usize = 3;
const ITERATIONS: usize = 0;
const LOAD_FACTOR: usize = 1;
const ARC_SCALE: usize = 2;
