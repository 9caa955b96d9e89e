//! What bodies are made of.

use std::sync::Arc;

use piola_formulas::hyperelastic::{Constant, HyperelasticLaw, LameConstants};
use piola_formulas::volumetric::{self, StressState, VolumetricLaw};

use crate::boundaries::History;
use crate::case::expression::Expression;
use crate::schemes::transport_velocity;

/// What a body is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// A material whose energy depends on the volume ratio alone.
    Volumetric {
        /// Reference density in kg/m^3.
        density: f64,
        /// Its law.
        law: VolumetricLaw,
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
        /// The constants that it is given by, with their keys.
        constants: Vec<(String, Constant)>,
        /// The condition in the directions that the case does not resolve. Without meaning in 3D.
        plane: PlaneState,
    },
    /// A body that moves as one.
    Rigid {
        /// Density in kg/m^3.
        density: f64,
    },
    /// A solid whose stress is integrated in time, CTVF (4).
    Hypoelastic(transport_velocity::Solid),
}

impl Material {
    /// A placeholder for bodies whose material is never used.
    pub const PLACEHOLDER: Self =
        Self::Volumetric { density: 1.0, law: VolumetricLaw::Linear { bulk_modulus: 1.0 } };

    /// Reference density in kg/m^3.
    pub fn density(&self) -> f64 {
        match *self {
            Self::Volumetric { density, .. }
            | Self::WeaklyCompressible { density, .. }
            | Self::Hyperelastic { density, .. }
            | Self::Rigid { density } => density,
            Self::Hypoelastic(solid) => solid.state.density,
        }
    }

    /// The modulus kappa of the pressure law in Pa, in a case of `dimension` dimensions; for an elastic solid that at
    /// small strains; a rigid one has none.
    pub fn bulk_modulus(&self, dimension: usize) -> f64 {
        match self {
            Self::Volumetric { law, .. } => law.modulus(),
            Self::WeaklyCompressible { density, stiffness, .. } => {
                stiffness.modulus(*density, 1.0, dimension)
            }
            Self::Hyperelastic { law, .. } => law.small_strain().bulk_modulus(),
            Self::Hypoelastic(solid) => solid.bulk_modulus(),
            Self::Rigid { .. } => f64::INFINITY,
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
        /// The condition in the directions that the case does not resolve. Without meaning in 3D.
        plane: PlaneState,
    },
}

impl Stiffness {
    /// The modulus kappa in Pa, in a case of `dimension` dimensions, for a density in kg/m^3.
    ///
    /// A given wave speed c of the reference state yields `kappa = rho c^2 / gamma`, which is
    /// Upwind (6.31) solved for kappa: gamma is the modulus of small changes of volume over kappa.
    pub fn modulus(self, density: f64, gamma: f64, dimension: usize) -> f64 {
        match self {
            Self::BulkModulus(modulus) => modulus,
            Self::WaveSpeed(speed) => density * speed * speed / gamma,
            Self::Young { modulus, poisson_ratio, plane } => {
                plane.bulk_modulus(modulus, poisson_ratio, dimension)
            }
        }
    }
}

/// The condition in the directions that a case of one or two dimensions does not resolve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneState {
    /// No stress there.
    Stress,
    /// No strain there.
    Strain,
}

impl PlaneState {
    /// Density times the square of the speed of waves of pressure in an isotropic elastic body in Pa.
    pub fn pressure_wave_modulus(self, constants: &LameConstants, dimension: usize) -> f64 {
        let LameConstants { lambda, mu } = *constants;
        match (self, dimension) {
            (Self::Stress, 1) => mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu),
            (Self::Stress, 2) => 4.0 * mu * (lambda + mu) / (lambda + 2.0 * mu),
            _ => lambda + 2.0 * mu,
        }
    }

    /// Ratio of pressure to relative change of length, area or volume of an isotropic elastic body
    /// ([`volumetric::bulk_modulus`]); in three dimensions there is no choice. NaN if it does not exist, which is
    /// refused when a case is read.
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

/// What makes a body the buffer of an open boundary.
#[derive(Clone, Debug)]
pub struct Opening {
    /// Unit normal into the fluid.
    pub normal: Vec<f64>,
    /// What is prescribed.
    pub flow: OpenFlow,
    /// Factor by the distance from a point within the plane.
    pub profile: Option<Profile>,
    /// Factor over time.
    pub history: Option<Arc<History>>,
    /// The relaxation time of mean pressures in s.
    pub relaxation: Option<f64>,
}

/// A factor by the distance from a point within a plane.
#[derive(Clone, Debug)]
pub struct Profile {
    /// The factor against the distance in m; none if the text of the case does not come from a file.
    pub factor: Option<Arc<History>>,
    /// The point in m.
    pub from: Vec<f64>,
}

/// What is prescribed at an open boundary.
#[derive(Clone, Debug)]
pub enum OpenFlow {
    /// The velocity in m/s, by component.
    Velocity(Vec<Expression>),
    /// The volume that enters per time, in m^D/s.
    Rate(Expression),
    /// The pressure in Pa.
    Pressure(Expression),
}

impl OpenFlow {
    /// All expressions.
    pub fn expressions(&self) -> &[Expression] {
        match self {
            Self::Velocity(velocity) => velocity,
            Self::Rate(one) | Self::Pressure(one) => std::slice::from_ref(one),
        }
    }
}

/// What makes a body a wall.
#[derive(Clone, Debug)]
pub struct Wall {
    /// The condition for viscous forces along it.
    pub slip: transport_velocity::Slip,
    /// Velocity of its surface, which slides in place, by component, in m/s.
    pub sliding: Vec<Option<Expression>>,
}
