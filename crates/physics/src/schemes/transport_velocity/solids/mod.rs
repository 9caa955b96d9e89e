//! Elastic and elastic-plastic solids in the transport-velocity formulation, CTVF sections 3.2 and
//! 4.4 to 4.7.
//!
//! ```text
//! drho_a/dt = - rho_a tr L_a + sum V_b (rho_b - rho_a) d_b . grad W_ab
//!   ds_a/dt = 2 G dev sym L_a + Omega_a s_a - s_a Omega_a + sum V_b (s_b - s_a) d_b . grad W_ab
//!   du_a/dt = sum m_b [ sigma_a / rho_a^2 + sigma_b / rho_b^2 - Pi_ab ] . grad W_ab + g
//!      L_a  = - sum V_b u_ab (x) grad W_ab
//! ```
//!
//! with `sigma = s - p` and the pressure of an equation of state: theory (68) to (75), which say
//! where the paper departs. L is made of the momentum velocity; with [`Divergence::Transport`] of the transport
//! velocity, as GTVF has it.
//! Gradients, surfaces and shifting see only the particle's own body and walls; what other bodies
//! do is [`Contact`]. Beside the columns of all matter there are those of [`Matter`].

mod advance;
mod correction;
mod forces;
mod fracture;
mod held;
mod load;
mod rates;
mod system;

use piola_formulas::hypoelastic::{EquationOfState, Strength};
pub(super) use piola_formulas::pairs::solid::MATTER;

use super::{Common, TransportVelocity};
use crate::boundaries::PrescribedVelocity;
use crate::boundaries::prescribed::PrescribedComponents;
use crate::{Tensor, Vector};

pub use rates::SolidRates;
pub use system::DESCRIPTION;

use fracture::Bonds;
use system::{Stored, StoredMut};

/// The material of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Pressure, with the density in kg/m^3 and the bulk wave speed in m/s at rest.
    pub state: EquationOfState,
    /// Shear modulus in Pa.
    pub shear_modulus: f64,
    /// When it flows.
    pub strength: Strength,
    /// What plastic work does to the temperature.
    pub heat: Heat,
}

/// How plastic work heats a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heat {
    /// Temperature at the start in K.
    pub temperature: f64,
    /// Specific heat in J/(kg K).
    pub specific_heat: f64,
    /// Share of the plastic work that becomes heat.
    pub share: f64,
}

impl Heat {
    /// Room temperature and a solid that does not warm up.
    pub const NONE: Self = Self { temperature: 293.15, specific_heat: 1.0, share: 0.0 };
}

impl Solid {
    /// Bulk modulus at rest in Pa.
    pub fn bulk_modulus(&self) -> f64 {
        self.state.density * self.state.wave_speed * self.state.wave_speed
    }
}

/// What particles of different bodies do to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contact {
    /// They approach and part as matter would, so that density and pressure rise between them, and
    /// the pressure acts where it pushes. With it bodies come apart again.
    Repulsive,
    /// All that particles of one body do to each other, as the paper has it: bodies can weld.
    Full,
    /// A spring where they are closer than one spacing.
    Penalty {
        /// Its stiffness in units of the mean bulk modulus times `dx^(D-2)`.
        stiffness: f64,
    },
}

/// All that the formulation needs to know of solids.
pub struct SolidsInput {
    /// Material of each body, of walls too.
    pub materials: Vec<Solid>,
    /// What bodies do to each other.
    pub contact: Contact,
    /// How far apart in m particles of one body must have begun to touch as those of two bodies do; without
    /// it, and with [`Contact::Full`], bodies do not touch themselves.
    pub self_contact: Option<f64>,
    /// Whether velocity gradients are corrected to be exact for linear fields, with the momentum
    /// equation that is conjugate to that, theory (74).
    pub corrected: bool,
    /// Velocity components of particles of solids that are prescribed.
    pub held: Vec<PrescribedVelocity>,
}

/// The deviatoric stress in Pa as xx, yy, zz, yz, xz, xy, the plastic strain, the temperature in K and the
/// specific internal energy in J/kg.
pub(super) type Matter = [f64; MATTER];

const ZZ: usize = 2;
const PLASTIC: usize = 6;
const TEMPERATURE: usize = 7;
const ENERGY: usize = 8;

/// What forces gather of a particle of a solid beside its side.
type Tension<const D: usize> = piola_formulas::pairs::solid::Tension<f64, D>;

/// Solids bound to their particles, with scratch by place.
pub struct Hypoelastic<const D: usize> {
    materials: Vec<Solid>,
    contact: Contact,
    held: PrescribedComponents,
    bonds: Bonds,
    matter: Vec<Matter>,
    /// For which places, counted by lists of neighbours, constants stand in `tensions`.
    builds: Option<u64>,
    tensions: Vec<Tension<D>>,
    rates: Vec<SolidRates<D>>,
    /// Corrections of gradients, if they are corrected.
    corrections: Vec<Tensor<D>>,
}

impl<const D: usize> Hypoelastic<D> {
    /// Whether bulk waves are as fast in all solids.
    fn is_uniform(&self) -> bool {
        let speeds = || self.materials.iter().map(|solid| solid.state.wave_speed);
        speeds().all(|speed| speeds().next() == Some(speed))
    }

    /// Whether no solid flows or heats up.
    fn is_elastic(&self) -> bool {
        let is_elastic =
            |solid: &Solid| solid.strength == Strength::Elastic && !solid.state.is_caloric();
        self.materials.iter().all(is_elastic)
    }

    /// The solid that a particle (number) is of.
    fn solid(&self, common: &Common<D>, number: usize) -> &Solid {
        &self.materials[common.particles.body[number] as usize]
    }
}

impl<const D: usize> TransportVelocity<D, Hypoelastic<D>> {
    /// The velocity gradients and other rates of solids of the last pass, by number, for those who
    /// want to see them apart.
    pub fn solid_rates(&self) -> Vec<SolidRates<D>> {
        let places = self.common.support.list().places().iter();
        places.map(|&place| self.matter.rates[place as usize]).collect()
    }
}

/// The entry of a symmetric 3 x 3 tensor that is stored as xx, yy, zz, yz, xz, xy.
#[inline]
fn entry(i: usize, j: usize) -> usize {
    if i == j { i } else { 6 - i - j }
}

/// A stored tensor as a matrix.
#[inline]
fn full(stored: &[f64]) -> Tensor<3> {
    Tensor::<3>::from_fn(|i, j| stored[entry(i, j)])
}

/// Stores a symmetric matrix.
#[inline]
fn store(tensor: &Tensor<3>, stored: &mut [f64]) {
    for (i, j) in [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)] {
        stored[entry(i, j)] = tensor[(i, j)];
    }
}

/// The normal of a plane in three dimensions.
fn padded<const D: usize>(vector: &Vector<D>) -> Vector<3> {
    Vector::<3>::from_fn(|i, _| if i < D { vector[i] } else { 0.0 })
}
