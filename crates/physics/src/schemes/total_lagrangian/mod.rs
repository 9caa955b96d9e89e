//! Total Lagrangian solids with displacements as unknowns, of parts that can be chosen.
//! Papers: Dual-support, Elastodynamics.
//!
//! Unknowns of a particle are v and the displacement u. With the coefficients `G_ab` of
//! [`ReferenceGradient`](crate::operators::ReferenceGradient), on supports of any size and on mirror
//! images beyond planes, theory (44) to (49) and (63):
//!
//! ```text
//! E   = sum_a V_a psi(A_a) + sum_a sum_b c_ab |A_a X_ab - u_ab|^2,   A_a = sum_b u_ab (x) G_ab
//! m_a dv_a/dt = - dE/du_a + f_a(viscosity) + A_a t_a - p cof(F_a) N_a + m_a g - m_a d v_a,   du_a/dt = v_a
//! ```
//!
//! the *adjoint* form, for any cloud and dimension. Forces are the exact gradient of E, whatever the
//! supports, the weights and the correction, so that energy and momentum are kept by construction; dual
//! supports come out of the derivative by themselves. Displacements instead of positions keep the digits
//! of small strains.
//!
//! On a row or a box of particles there is the *strong* form of Elastodynamics, `rho dv/dt = X P`, with
//! ghosts that carry displacements and stresses on beyond the edges, theory (64); it has no energy E.
//!
//! Bodies may be rigid: what acts on their particles moves them as one.
//!
//! In statics the potential is stationary, and v is the rate of u by the load factor. Implicit steps
//! are statics with inertia. The two papers are presets: what each of them chooses of the parts.

mod build;
mod check;
mod device;
mod discrete;
mod dissipation;
mod equilibrium;
mod error;
mod evaluate;
mod external;
mod fields;
mod group;
mod inspect;
mod loads;
mod material;
mod matrices;
mod newmark;
mod rigid;
mod scheme;
mod settings;
mod share;
mod solid;
mod split;
mod stable_step;
mod stages;
mod statics;
mod strong;
mod tractions;

pub use build::TotalLagrangianInput;
pub use discrete::Discrete;
pub use error::{Part, TotalLagrangianError};
pub use material::{Material, Mixture};
pub use rigid::RigidBody;
pub use scheme::{DUAL_SUPPORT, ELASTODYNAMICS, TOTAL_LAGRANGIAN};
pub use settings::{Configuration, Dissipation, Form, Gradients, Motion, Settings, Tractions};
pub use solid::Solid;
pub use statics::free_to_move;
pub use statics::{
    InertialStep, Known, Reaction, StaticState, Statics, StaticsError, StaticsInput, Stiffness,
};
pub use strong::Hole;

use std::sync::Arc;

use crate::boundaries::prescribed::PrescribedComponents;
use crate::operators::Strained;
use crate::parallel::Team;
use crate::schemes::ledger::Entry;
use crate::schemes::stages::Stages;
use crate::schemes::{Accounts, SchemeDescription};
use crate::{Tensor, Vector};

use group::Group;
use loads::Loads;
use matrices::Matrices;

/// The formulation bound to its particles.
pub struct TotalLagrangian<const D: usize> {
    description: &'static SchemeDescription,
    solid: Arc<Solid<D>>,
    dissipation: Dissipation,
    matrices: Matrices<D>,
    /// What the matrices are made anew of in each step, where they are.
    updated: Option<strong::Moving<D>>,
    /// Loads and supports, where states are solved for.
    statics: Option<Box<Statics<D>>>,
    /// Whether nothing moves.
    is_static: bool,
    stable: stable_step::Bound,
    /// The last particle seen to have lost its convexity, with its displacement gradient.
    not_convex: Option<(usize, Tensor<D>)>,
    /// Load factors of the first step that may have gone over a limit of the load.
    jumped: Option<[f64; 2]>,
    loads: Loads<D>,
    /// Whether loads or prescribed motion act on any particle, of this rank or of others.
    is_driven: bool,
    /// Whether bodies have images beyond planes, those of this rank or of others.
    has_images: bool,
    /// Who else computes it.
    team: Team,
    prescribed: PrescribedComponents,
    rigid: rigid::RigidBodies<D>,
    /// Particles that act on each other wherever they are, where other ranks have some.
    group: Option<Arc<Group<D>>>,
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
    /// Displacement gradients, and what forces gather.
    strained: Strained<D>,
    /// Rate of the gradient; empty without viscosity.
    gradient_rate: Vec<Tensor<D>>,
    /// Elastic first Piola-Kirchhoff stress of the strong form, which its edges know better.
    stress: Vec<Tensor<D>>,
    /// Internal forces, those on images behind.
    force: Vec<Vector<D>>,
    /// Scratch of the length of a state.
    rate: Vec<f64>,
    /// What holds each particle in the last observation, N.
    reaction: Vec<Vector<D>>,
    /// The state at the start.
    initial: Vec<f64>,
}

/// The energies of the formulation.
const ENERGIES: [&str; 3] = ["kinetic", "strain", "hourglass"];

/// Forces between particles cancel, so that momentum enters by what acts from outside alone.
const LEDGER: Accounts = Accounts {
    mechanisms: &[
        "body_force",
        "traction",
        "pressure",
        "spring",
        "boundary_motion",
        "viscosity",
        "damping",
    ],
    impulses: &["body_force", "traction", "pressure", "spring", "boundary_motion", "damping"],
    is_kicked: true,
};
const BODY_FORCE: Entry = LEDGER.entry("body_force");
const TRACTION: Entry = LEDGER.entry("traction");
const PRESSURE: Entry = LEDGER.entry("pressure");
const SPRING: Entry = LEDGER.entry("spring");
const BOUNDARY_MOTION: Entry = LEDGER.entry("boundary_motion");
const VISCOSITY: Entry = LEDGER.entry("viscosity");
const DAMPING: Entry = LEDGER.entry("damping");

/// Numbers behind the ledger that belong to the last step: iterations of Newton's method, the load
/// factor, and the length in m that displacements have moved by per unit of arc length. Data of edges
/// follow.
const FIGURES: usize = 3;
const ITERATIONS: usize = 0;
const LOAD_FACTOR: usize = 1;
const ARC_SCALE: usize = 2;
