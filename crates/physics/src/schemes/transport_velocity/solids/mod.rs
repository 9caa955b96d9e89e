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
mod material;
mod rates;
mod system;

use nalgebra::SMatrix;
use piola_formulas::Number;
use piola_formulas::hypoelastic::Strength;
pub(super) use piola_formulas::pairs::solid::MATTER;

use super::{Common, TransportVelocity};
use crate::Tensor;
use crate::boundaries::PrescribedVelocity;
use crate::boundaries::prescribed::PrescribedComponents;

pub use material::{Heat, Solid};
pub use rates::SolidRates;
pub use system::DESCRIPTION;

pub(super) use held::hold;
pub(super) use material::{Moved, Step};
pub(super) use rates::Counted;
pub(super) use system::Stress;

use fracture::Bonds;
use system::{Stored, StoredMut};

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

    /// The material of each body.
    pub(super) fn materials(&self) -> &[Solid] {
        &self.materials
    }

    /// The prescribed velocities.
    pub(super) fn held(&self) -> &PrescribedComponents {
        &self.held
    }

    /// Whether velocity gradients are corrected.
    pub(super) fn corrects(&self) -> bool {
        !self.corrections.is_empty()
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
fn full<T: Number>(stored: &[T]) -> SMatrix<T, 3, 3> {
    SMatrix::from_fn(|i, j| stored[entry(i, j)])
}

/// Stores a symmetric matrix.
#[inline]
fn store<T: Number>(tensor: &SMatrix<T, 3, 3>, stored: &mut [T]) {
    for (i, j) in [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)] {
        stored[entry(i, j)] = tensor[(i, j)];
    }
}

/// The Cauchy stress in Pa of a pressure in Pa and a material state.
#[inline]
pub(super) fn cauchy_stress<T: Number, const D: usize>(
    pressure: T,
    matter: &[T; MATTER],
) -> SMatrix<T, D, D> {
    SMatrix::from_fn(|i, j| {
        let deviator = matter[entry(i, j)];
        if i == j { deviator - pressure } else { deviator }
    })
}

/// The mirror image of a stored deviatoric stress across the plane with a normal: of a wall that lets slide it is the
/// stress behind its face, so that there is no shear at that.
#[inline]
pub(super) fn mirrored<T: Number, const D: usize>(
    deviator: &[T; 6],
    normal: &SMatrix<T, D, 1>,
) -> [T; 6] {
    let normal = SMatrix::<T, 3, 1>::from_fn(|i, _| if i < D { normal[i] } else { T::zero() });
    let mirror = SMatrix::<T, 3, 3>::identity() - normal * normal.transpose() * T::from(2.0);
    let mut image = [T::zero(); 6];
    store(&(mirror * full(deviator) * mirror), &mut image);
    image
}
