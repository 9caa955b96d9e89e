//! Formulations with their settings.

use crate::case::expression::Expression;
use crate::case::source::Located;
use crate::operators::GradientForm;
use crate::schemes::{dual_support, elastodynamics, interpolation, transport_velocity, upwind};

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
        match self {
            Self::Upwind(_) => upwind::DESCRIPTION.name,
            Self::TransportVelocity(_) => transport_velocity::NAME,
            Self::DualSupport(_) => dual_support::DESCRIPTION.name,
            Self::Elastodynamics(_) => elastodynamics::DESCRIPTION.name,
            Self::Interpolation(_) => interpolation::DESCRIPTION.name,
        }
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
