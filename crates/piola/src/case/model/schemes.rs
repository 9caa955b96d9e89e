//! Formulations with their settings.

use super::Shape;
use crate::case::expression::Expression;
use crate::case::source::Located;
use crate::operators::{Correction, GradientForm};
use crate::schemes::total_lagrangian::{
    self, Configuration, Dissipation as Dissipative, Form, Tractions,
};
use crate::schemes::upwind::{self, WaveSpeed};
use crate::schemes::{SchemeDescription, interpolation, transport_velocity};

/// The formulation with its settings.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Scheme {
    /// Total Lagrangian mixed formulation with Riemann upwinding.
    Upwind(Upwind),
    /// Weakly compressible fluids with a corrected transport velocity.
    TransportVelocity(TransportVelocity),
    /// Total Lagrangian solids.
    TotalLagrangian(TotalLagrangian),
    /// No motion: sums of a known function.
    Interpolation(Interpolation),
}

impl Scheme {
    /// Its name in a case file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Upwind(_) => upwind::DESCRIPTION.name,
            Self::TransportVelocity(_) => transport_velocity::NAME,
            Self::TotalLagrangian(settings) => settings.preset.description().name,
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
    /// The weights in kernel sums.
    pub weights: Weights,
    /// Strength of the upwinding of velocity, 0 for none.
    pub tau_velocity: f64,
    /// Strength of the upwinding of pressure, 0 for none.
    pub tau_pressure: f64,
    /// Whether it is as derived or as the paper prints it.
    pub dissipation: Located<Dissipation>,
    /// Whether the states at the mid-edge are reconstructed, Upwind (3.53).
    pub reconstruction: bool,
    /// The wave speed of the upwinding.
    pub wave_speed: WaveSpeed,
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
    /// Both as printed.
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
    /// The settings of the formulation itself.
    pub settings: transport_velocity::Settings,
    /// How bodies of solids interact.
    pub contact: transport_velocity::Contact,
    /// The initial distance from which on particles of one body are in contact like those of different bodies, in
    /// particle spacings.
    pub self_contact: Option<Located<f64>>,
    /// Whether velocity gradients of solids are corrected.
    pub corrected_gradients: bool,
    /// Damping rate of the motion of a fluid in 1/s, as an expression of the current position.
    pub damping: Option<Located<Expression>>,
    /// Whether particles that escape are removed; otherwise the run ends.
    pub removes_escaped: bool,
    /// How many more particles may enter than leave before memory is asked for.
    pub reserve: Option<u32>,
    /// The regions of a fluid in each of which the spacing is half of the previous one.
    pub refine: Vec<Located<Shape>>,
}

/// Settings of a total Lagrangian solid.
#[derive(Clone, Debug, PartialEq)]
pub struct TotalLagrangian {
    /// The preset, which supplies the values that the file does not give.
    pub preset: Preset,
    /// Name in the kernel registry.
    pub kernel: Located<String>,
    /// The weights in kernel sums.
    pub weights: Weights,
    /// How large supports are.
    pub support: Located<SupportSize>,
    /// Whether bodies are joined where their particles coincide.
    pub joined: bool,
    /// How the divergence of the stress is taken.
    pub form: Located<Form>,
    /// The configuration in which matrices are computed.
    pub configuration: Configuration,
    /// Coefficients of the deformation gradient; `None` for those of the preset.
    pub gradients: Option<Located<GradientKind>>,
    /// Coefficient of the hourglass energy in units of the shear modulus, if it is given.
    pub hourglass: Option<f64>,
    /// Which particles tractions act on, if it is given.
    pub tractions: Option<Tractions>,
    /// What dissipates energy.
    pub dissipation: Located<Dissipative>,
    /// Whether the case says how viscous it is, be it not at all.
    pub says_viscosity: bool,
}

/// A paper's choice of the parts of a total Lagrangian solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// None: what suits most cases.
    TotalLagrangian,
    /// Dual-support.
    DualSupport,
    /// Elastodynamics.
    Elastodynamics,
}

impl Preset {
    /// All presets.
    pub const ALL: [Self; 3] = [Self::TotalLagrangian, Self::DualSupport, Self::Elastodynamics];

    /// The preset of a name in a case file.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.description().name == name)
    }

    /// The description of the formulation with it.
    pub fn description(self) -> &'static SchemeDescription {
        match self {
            Self::TotalLagrangian => &total_lagrangian::TOTAL_LAGRANGIAN,
            Self::DualSupport => &total_lagrangian::DUAL_SUPPORT,
            Self::Elastodynamics => &total_lagrangian::ELASTODYNAMICS,
        }
    }

    /// The form of the divergence in a dimension.
    pub fn form(self, dimension: usize) -> Form {
        match (self, dimension) {
            (Self::Elastodynamics, 1) => Form::Strong,
            _ => Form::Adjoint,
        }
    }

    /// Whether gradients are plain unless the case says otherwise.
    pub fn is_plain(self) -> bool {
        self == Self::Elastodynamics
    }

    /// The radius of supports in spacings.
    pub fn support(self, form: Form, dimension: usize) -> f64 {
        match (self, form, dimension) {
            (_, Form::Strong, 1) => 5.5,
            (Self::Elastodynamics, ..) | (_, Form::Strong, _) => 2.5,
            _ => 2.05,
        }
    }

    /// The coefficient of the hourglass energy, with plain gradients or others, where particles are those of
    /// meshes and files or of lattices.
    pub fn hourglass(self, is_plain: bool, is_rough: bool) -> f64 {
        match (self, is_plain) {
            (Self::Elastodynamics, _) => 0.05,
            (Self::DualSupport, true) => 1.0,
            (Self::TotalLagrangian, true) if is_rough => 1.0,
            _ => 0.1,
        }
    }

    /// Which particles tractions act on, with plain gradients or others.
    pub fn tractions(self, is_plain: bool) -> Tractions {
        match (self, is_plain) {
            (Self::Elastodynamics, _) | (Self::TotalLagrangian, true) => Tractions::Layers,
            _ => Tractions::Surface,
        }
    }
}

/// Settings of the scheme `interpolation`.
#[derive(Clone, Debug, PartialEq)]
pub struct Interpolation {
    /// The interpolated function of position.
    pub function: Located<Expression>,
    /// Name in the kernel registry.
    pub kernel: Located<String>,
    /// Support radius in particle spacings.
    pub support: Located<f64>,
    /// The weights in kernel sums.
    pub weights: Weights,
    /// The form of kernel gradients.
    pub form: GradientForm,
    /// What ghosts carry.
    pub boundary: interpolation::Boundary,
}

/// How large the support of a particle is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SupportSize {
    /// Its radius in units of the particle spacing.
    Spacings(f64),
    /// Its radius is the distance to the neighbour of this number, counted from the nearest.
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

/// The weights in kernel sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weights {
    /// The volume of a cell of the lattice for every particle, even at a face.
    Lattice,
    /// The quadrature volume of the particle.
    Volume,
}
