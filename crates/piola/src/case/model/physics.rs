//! Materials, schemes, time, loads and boundaries.

use std::sync::Arc;

use piola_formulas::hyperelastic::HyperelasticLaw;
use piola_formulas::volumetric::{self, StressState};

use super::Region;
use crate::boundaries::History;
use crate::case::expression::Expression;
use crate::case::source::{Located, Place};
use crate::operators::GradientForm;
use crate::schemes::{
    ImplicitRule, dual_support, elastodynamics, interpolation, transport_velocity, upwind,
};
use crate::solve::LinearMethod;
use crate::time::IntegratorKind;

/// What a body is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// Pressure linear in the volume ratio, `p = -kappa (J - 1)`, Upwind (3.11) and (3.12) corrected.
    Linear {
        /// Reference density in kg/m^3.
        density: f64,
        /// How its bulk modulus is given.
        stiffness: Stiffness,
    },
    /// `p = kappa (J^-gamma - 1)`, Upwind (6.30).
    GammaLaw {
        /// Reference density in kg/m^3.
        density: f64,
        /// Exponent, at least 1.
        gamma: f64,
        /// How its bulk modulus is given, never by Young's modulus.
        stiffness: Stiffness,
    },
    /// A fluid with `p = kappa (rho / rho0 - 1)`, CTVF (8).
    WeaklyCompressible {
        /// Reference density in kg/m^3.
        density: f64,
        /// How its bulk modulus is given, never by Young's modulus.
        stiffness: Stiffness,
        /// Kinematic viscosity in m^2/s.
        viscosity: f64,
    },
    /// An elastic solid with a strain energy.
    Hyperelastic {
        /// Reference density in kg/m^3.
        density: f64,
        /// Its strain energy in three dimensions.
        law: HyperelasticLaw,
        /// What the directions that the case does not have do. Without meaning in 3D.
        plane: PlaneState,
    },
    /// A solid whose stress is integrated in time, CTVF (4).
    Hypoelastic(transport_velocity::Solid),
}

impl Material {
    /// What bodies are made of of which no one asks.
    pub const PLACEHOLDER: Self =
        Self::Linear { density: 1.0, stiffness: Stiffness::BulkModulus(1.0) };

    /// Reference density in kg/m^3.
    pub fn density(&self) -> f64 {
        match *self {
            Self::Linear { density, .. }
            | Self::GammaLaw { density, .. }
            | Self::WeaklyCompressible { density, .. }
            | Self::Hyperelastic { density, .. } => density,
            Self::Hypoelastic(solid) => solid.state.density,
        }
    }

    /// The modulus kappa of the pressure law in Pa, in a case of `dimension` dimensions; of an elastic
    /// solid that of small strains.
    ///
    /// A given wave speed c of the reference state yields `kappa = rho c^2 / gamma`, which is
    /// Upwind (6.31) solved for kappa, with gamma = 1 for the linear law.
    pub fn bulk_modulus(&self, dimension: usize) -> f64 {
        let (density, gamma, stiffness) = match *self {
            Self::Linear { density, stiffness } => (density, 1.0, stiffness),
            Self::GammaLaw { density, gamma, stiffness } => (density, gamma, stiffness),
            Self::WeaklyCompressible { density, stiffness, .. } => (density, 1.0, stiffness),
            Self::Hyperelastic { law, .. } => return law.small_strain().bulk_modulus(),
            Self::Hypoelastic(solid) => return solid.bulk_modulus(),
        };
        match stiffness {
            Stiffness::BulkModulus(modulus) => modulus,
            Stiffness::WaveSpeed(speed) => density * speed * speed / gamma,
            Stiffness::Young { modulus, poisson_ratio, plane } => {
                plane.bulk_modulus(modulus, poisson_ratio, dimension)
            }
        }
    }
}

/// The ways to give a bulk modulus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stiffness {
    /// The modulus kappa itself, in Pa.
    BulkModulus(f64),
    /// The wave speed in the reference state, in m/s.
    WaveSpeed(f64),
    /// Young's modulus and Poisson's ratio.
    Young {
        /// Young's modulus in Pa.
        modulus: f64,
        /// Poisson's ratio.
        poisson_ratio: f64,
        /// What the directions that the case does not have do. Without meaning in 3D.
        plane: PlaneState,
    },
}

/// What happens in the directions that a case of one or two dimensions does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneState {
    /// No stress there.
    Stress,
    /// No strain there.
    Strain,
}

impl PlaneState {
    /// Ratio of pressure to relative change of length, area or volume of an isotropic elastic body
    /// ([`volumetric::bulk_modulus`]); in three dimensions nothing is left to choose. NaN where it
    /// does not exist, which no reader of cases lets pass.
    pub fn bulk_modulus(self, young_modulus: f64, poisson_ratio: f64, dimension: usize) -> f64 {
        let state = self.stress_state(dimension);
        volumetric::bulk_modulus(young_modulus, poisson_ratio, state).unwrap_or(f64::NAN)
    }

    /// The stress state in a case of `dimension` dimensions.
    pub fn stress_state(self, dimension: usize) -> StressState {
        match (dimension, self) {
            (1, Self::Stress) => StressState::UniaxialStress,
            (1, Self::Strain) => StressState::UniaxialStrain,
            (2, Self::Stress) => StressState::PlaneStress,
            (2, Self::Strain) => StressState::PlaneStrain,
            _ => StressState::ThreeDimensional,
        }
    }
}

/// The formulation with its settings.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Scheme {
    /// Total Lagrangian mixed formulation with Riemann upwinding.
    Upwind(Upwind),
    /// Weakly compressible fluids with a corrected transport velocity.
    TransportVelocity(TransportVelocity),
    /// Elastic solids from one discrete energy.
    DualSupport(DualSupport),
    /// Elastic solids on SPH matrices.
    Elastodynamics(Elastodynamics),
    /// No motion: sums of a known function.
    Interpolation(Interpolation),
}

impl Scheme {
    /// Its name in a case file.
    pub fn name(&self) -> &'static str {
        let description = match self {
            Self::Upwind(_) => upwind::DESCRIPTION,
            Self::TransportVelocity(_) => transport_velocity::DESCRIPTION,
            Self::DualSupport(_) => dual_support::DESCRIPTION,
            Self::Elastodynamics(_) => elastodynamics::DESCRIPTION,
            Self::Interpolation(_) => interpolation::DESCRIPTION,
        };
        description.name
    }
}

/// Settings of the scheme `upwind`.
#[derive(Clone, Debug, PartialEq)]
pub struct Upwind {
    /// Name in the kernel registry.
    pub kernel: Located<String>,
    /// Smoothing length in particle spacings.
    pub smoothing_length: Located<f64>,
    /// Correction of the kernel.
    pub correction: Located<Correction>,
    /// What is summed under the kernel.
    pub weights: Weights,
    /// Share of the upwinding of velocity, 0 for none.
    pub tau_velocity: f64,
    /// Share of the upwinding of pressure, 0 for none.
    pub tau_pressure: f64,
    /// Whether it is as derived or as the paper prints it.
    pub dissipation: Located<Dissipation>,
    /// Whether the states at the mid-edge are reconstructed, Upwind (3.53).
    pub reconstruction: bool,
    /// The wave speed of the upwinding.
    pub wave_speed: ReferenceWaveSpeed,
}

/// Which form the upwinding has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dissipation {
    /// As derived: theory (12) and (13).
    Corrected,
    /// Upwind (3.38) as printed.
    WithoutDensity,
    /// Upwind (3.42) as printed.
    TurnedArea,
    /// With both as printed.
    AsPrinted,
}

impl Dissipation {
    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Corrected => "corrected",
            Self::WithoutDensity => "printed_3_38",
            Self::TurnedArea => "printed_3_42",
            Self::AsPrinted => "as_printed",
        }
    }

    /// Whether it lacks the density.
    pub fn lacks_density(self) -> bool {
        matches!(self, Self::WithoutDensity | Self::AsPrinted)
    }

    /// Whether the area of the upwinding of pressure has the other sign.
    pub fn turns_area(self) -> bool {
        matches!(self, Self::TurnedArea | Self::AsPrinted)
    }
}

/// Settings of the scheme `transport_velocity`.
#[derive(Clone, Debug, PartialEq)]
pub struct TransportVelocity {
    /// Name in the kernel registry.
    pub kernel: Located<String>,
    /// Smoothing length in particle spacings.
    pub smoothing_length: Located<f64>,
    /// All that the formulation itself knows.
    pub settings: transport_velocity::Settings,
    /// What bodies of solids do to each other.
    pub contact: transport_velocity::Contact,
    /// How far apart particles of one body must have begun to touch, in particle spacings.
    pub self_contact: Option<Located<f64>>,
    /// Whether velocity gradients of solids are corrected.
    pub corrected_gradients: bool,
    /// Whether particles that escape are removed; otherwise the run ends.
    pub removes_escaped: bool,
}

/// Settings of the scheme `dual_support`.
#[derive(Clone, Debug, PartialEq)]
pub struct DualSupport {
    /// Name in the kernel registry.
    pub kernel: Located<String>,
    /// What weighs a kernel.
    pub weights: Weights,
    /// How large supports are.
    pub support: Located<SupportSize>,
    /// Coefficients of the deformation gradient; `None` for the better ones that there are.
    pub gradients: Option<Located<GradientKind>>,
    /// Coefficient of the hourglass energy in units of the shear modulus, if it is given.
    pub hourglass: Option<f64>,
}

/// Settings of the scheme `elastodynamics`.
#[derive(Clone, Debug, PartialEq)]
pub struct Elastodynamics {
    /// Name in the kernel registry.
    pub kernel: Located<String>,
    /// Support radius in particle spacings.
    pub support: Located<f64>,
    /// What is summed under the kernel.
    pub weights: Weights,
    /// All that the formulation itself knows.
    pub settings: Located<elastodynamics::Settings>,
}

/// Settings of the scheme `interpolation`.
#[derive(Clone, Debug, PartialEq)]
pub struct Interpolation {
    /// What is interpolated, of the position.
    pub function: Located<Expression>,
    /// Name in the kernel registry.
    pub kernel: Located<String>,
    /// Support radius in particle spacings.
    pub support: Located<f64>,
    /// What is summed under the kernel.
    pub weights: Weights,
    /// What kernel gradients are made into.
    pub form: GradientForm,
    /// What ghosts carry.
    pub boundary: interpolation::Boundary,
}

/// How large the support of a particle is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SupportSize {
    /// Its radius in units of the particle spacing.
    Spacings(f64),
    /// It reaches to the so many-th neighbour.
    Neighbors(usize),
}

/// Coefficients of the deformation gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GradientKind {
    /// Those of the paper.
    Plain,
    /// Corrected so that constant stress is in equilibrium.
    PatchConsistent,
}

/// What makes a body a wall.
#[derive(Clone, Debug)]
pub struct Wall {
    /// What viscosity does along it.
    pub slip: transport_velocity::Slip,
    /// Velocity of its surface where it is, by component, in m/s.
    pub sliding: Vec<Option<Expression>>,
}

/// Correction of kernel and gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Correction {
    /// The kernel as it is.
    None,
    /// Gradients exact for linear fields.
    Gradient,
    /// Kernel exact for constants and gradients exact for linear fields.
    KernelAndGradient,
}

/// What is summed under a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weights {
    /// The volume of a cell of the lattice for every particle, also at a face.
    Lattice,
    /// The quadrature volume of the particle.
    Volume,
}

/// The wave speed that the upwinding of the scheme `upwind` uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceWaveSpeed {
    /// That of the reference state.
    Constant,
    /// Divided by the stretch, Upwind (3.57).
    Stretch,
}

/// Clock and integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct Time {
    /// Time at which the run ends, in s. It starts at 0.
    pub end: Located<f64>,
    /// Name of the integrator.
    pub integrator: Located<String>,
    /// Its rule, if it takes implicit steps.
    pub rule: Option<ImplicitRule>,
    /// Error of a step that is allowed, if the file says it.
    pub error: Option<f64>,
    /// Relative residual at which Newton's method has arrived, if the file says it.
    pub tolerance: Option<f64>,
    /// How linear equations are solved.
    pub linear_solver: LinearMethod,
    /// How long a step is.
    pub step: Located<StepControl>,
    /// The run fails after so many steps.
    pub max_steps: Option<u64>,
    /// The run fails when the stable step falls below, in s.
    pub min_step: Option<f64>,
    /// The run fails when a particle is faster, in m/s.
    pub max_speed: Option<f64>,
    /// How often the run may go back and on with half the step.
    pub retries: u64,
}

/// When checkpoints are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkpoint {
    /// Steps between them.
    pub every_steps: Option<u64>,
    /// Simulated time between them in s.
    pub every: Option<f64>,
    /// Wall time between them in s.
    pub every_wall: Option<f64>,
    /// How many are kept.
    pub keep: u64,
    /// Whether one is written at the end.
    pub at_end: bool,
}

impl Default for Checkpoint {
    /// Every five minutes, two of them.
    fn default() -> Self {
        Self { every_steps: None, every: None, every_wall: Some(300.0), keep: 2, at_end: false }
    }
}

impl Time {
    /// No time at all, for a case in which nothing moves.
    pub fn none(place: Place) -> Self {
        Self {
            end: Located::new(0.0, place),
            integrator: Located::new(IntegratorKind::TvdRk2.name().to_owned(), place),
            rule: None,
            error: None,
            tolerance: None,
            linear_solver: LinearMethod::Automatic,
            step: Located::new(StepControl::AtMost(1.0), place),
            max_steps: None,
            min_step: None,
            max_speed: None,
            retries: 0,
        }
    }
}

/// How long a time step is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// This share of the stable step.
    Cfl(f64),
    /// This many seconds, checked against the stable step.
    Fixed(f64),
    /// At most this many seconds, whatever is stable, or this much of the load factor.
    AtMost(f64),
}

/// A force on particles.
#[derive(Clone, Debug)]
pub struct Load {
    /// Name for overrides and messages.
    pub name: Option<Located<String>>,
    /// Number of the body that it acts on, `None` for all.
    pub body: Option<Located<usize>>,
    /// Factor over time of all its expressions.
    pub history: Option<Arc<History>>,
    /// What acts.
    pub kind: LoadKind,
}

/// The kinds of load.
#[derive(Clone, Debug)]
pub enum LoadKind {
    /// Acceleration in m/s^2, as expressions of the reference position and time.
    BodyForce {
        /// One expression a component.
        acceleration: Vec<Expression>,
    },
    /// Force per reference area in Pa that keeps its direction, on a part of a body's surface.
    Traction {
        /// The particles that carry it.
        region: Located<Region>,
        /// One expression of the reference position and time a component.
        traction: Vec<Expression>,
    },
    /// Pressure that follows a part of a body's surface.
    Pressure {
        /// The particles or faces that it acts on.
        region: Located<Region>,
        /// Pa, of the reference position and time.
        pressure: Expression,
    },
}

impl LoadKind {
    /// The expressions of the load: one a component, or the only one.
    pub fn components(&self) -> &[Expression] {
        match self {
            Self::BodyForce { acceleration } => acceleration,
            Self::Traction { traction, .. } => traction,
            Self::Pressure { pressure, .. } => std::slice::from_ref(pressure),
        }
    }
}

/// Prescribed velocities or displacements on a selection of particles.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// Unique name.
    pub name: Located<String>,
    /// Number of the body, `None` for all.
    pub body: Option<Located<usize>>,
    /// The particles.
    pub region: Located<Region>,
    /// Factor over time of all its expressions.
    pub history: Option<Arc<History>>,
    /// Per component, the velocity in m/s as an expression of the reference position and time, or
    /// `None` where the particle is free.
    pub velocity: Vec<Option<Expression>>,
    /// Whether the body is continued by mirror images beyond the plane of the region.
    pub mirror: Option<Located<bool>>,
    /// In statics, per component, the displacement in m as an expression of the reference position
    /// and the load factor, or `None` where the particle is free.
    pub displacement: Vec<Option<Expression>>,
    /// In statics, a plane that the particles can only move along.
    pub roller: Option<Roller>,
    /// In statics, the components, from 0, that all particles have in common.
    pub tied: Vec<Located<usize>>,
}

/// A roller on a plane of any inclination.
#[derive(Clone, Debug)]
pub struct Roller {
    /// The unit normal of the plane.
    pub normal: Vec<f64>,
    /// Displacement along it in m, as an expression of the reference position and the load factor.
    pub displacement: Expression,
}
