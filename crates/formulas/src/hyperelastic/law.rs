//! The registry of elastic solids.

use nalgebra::Matrix3;

use super::constants::positive;
use super::{
    EnergyFunction, HyperelasticResponse, LameConstants, LinearElastic, MooneyRivlin, NeoHookean,
    NeoHookeanLogarithmic, Ogden, OgdenTerm, SaintVenantKirchhoff,
};
use crate::Number;
use crate::volumetric::MaterialError;

/// An elastic solid by name.
///
/// The constructors check parameters; build variants directly only from checked ones.
///
/// ```
/// use nalgebra::Matrix3;
/// use piola_formulas::hyperelastic::{HyperelasticLaw, HyperelasticResponse, LameConstants};
///
/// let constants = LameConstants::from_young(30e9, 0.3)?;
/// let law = HyperelasticLaw::neo_hookean(constants);
/// assert_eq!(law.stress(&Matrix3::<f64>::zeros()), Matrix3::zeros());
/// # Ok::<(), piola_formulas::volumetric::MaterialError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum HyperelasticLaw {
    /// See [`LinearElastic`].
    LinearElastic(LinearElastic),
    /// See [`SaintVenantKirchhoff`].
    SaintVenantKirchhoff(SaintVenantKirchhoff),
    /// See [`NeoHookean`].
    NeoHookean(NeoHookean),
    /// See [`NeoHookeanLogarithmic`].
    NeoHookeanLogarithmic(NeoHookeanLogarithmic),
    /// See [`MooneyRivlin`].
    MooneyRivlin(MooneyRivlin),
    /// See [`Ogden`].
    Ogden(Ogden),
    /// See [`EnergyFunction`].
    Energy(EnergyFunction),
}

impl HyperelasticLaw {
    /// Names of all laws, as in a case file.
    pub const NAMES: [&'static str; 7] = [
        "linear_elastic",
        "saint_venant_kirchhoff",
        "neo_hookean",
        "neo_hookean_logarithmic",
        "mooney_rivlin",
        "ogden",
        "hyperelastic",
    ];

    /// The law's name in a case file, one of [`HyperelasticLaw::NAMES`].
    pub fn name(&self) -> &'static str {
        match self {
            Self::LinearElastic(_) => Self::NAMES[0],
            Self::SaintVenantKirchhoff(_) => Self::NAMES[1],
            Self::NeoHookean(_) => Self::NAMES[2],
            Self::NeoHookeanLogarithmic(_) => Self::NAMES[3],
            Self::MooneyRivlin(_) => Self::NAMES[4],
            Self::Ogden(_) => Self::NAMES[5],
            Self::Energy(_) => Self::NAMES[6],
        }
    }

    /// Hooke's law, Dual-support (44).
    pub fn linear_elastic(constants: LameConstants) -> Self {
        Self::LinearElastic(LinearElastic(constants))
    }

    /// St. Venant and Kirchhoff's law, Elastodynamics (3.50).
    pub fn saint_venant_kirchhoff(constants: LameConstants) -> Self {
        Self::SaintVenantKirchhoff(SaintVenantKirchhoff(constants))
    }

    /// The neo-Hookean law of Dual-support (46), with `kappa = lambda + 2/3 mu`.
    pub fn neo_hookean(constants: LameConstants) -> Self {
        Self::NeoHookean(NeoHookean(constants))
    }

    /// The neo-Hookean law of Dual-support (50).
    pub fn neo_hookean_logarithmic(constants: LameConstants) -> Self {
        Self::NeoHookeanLogarithmic(NeoHookeanLogarithmic(constants))
    }

    /// Mooney and Rivlin's law of its two constants and the bulk modulus, Pa. One of the two may
    /// be negative, their sum not.
    ///
    /// # Errors
    /// When the sum or the bulk modulus is not positive and finite.
    pub fn mooney_rivlin(c10: f64, c01: f64, bulk_modulus: f64) -> Result<Self, MaterialError> {
        positive("c10 + c01", c10 + c01)?;
        let bulk_modulus = positive("bulk_modulus", bulk_modulus)?;
        Ok(Self::MooneyRivlin(MooneyRivlin { c10, c01, bulk_modulus }))
    }

    /// Ogden's law of one to three pairs of modulus in Pa and exponent, and the bulk modulus, Pa.
    ///
    /// # Errors
    /// When the number of pairs is another, when modulus times exponent is not positive and finite
    /// in one of them, or the bulk modulus is not.
    pub fn ogden(terms: &[(f64, f64)], bulk_modulus: f64) -> Result<Self, MaterialError> {
        if terms.is_empty() || terms.len() > 3 {
            return Err(MaterialError::OgdenTerms { count: terms.len() });
        }
        let mut all = [OgdenTerm { modulus: 0.0, exponent: 2.0 }; 3];
        for (term, &(modulus, exponent)) in all.iter_mut().zip(terms) {
            positive("modulus * exponent", modulus * exponent)?;
            *term = OgdenTerm { modulus, exponent };
        }
        let bulk_modulus = positive("bulk_modulus", bulk_modulus)?;
        Ok(Self::Ogden(Ogden { terms: all, bulk_modulus }))
    }

    /// Lame's constants of small strains.
    pub fn small_strain(&self) -> LameConstants {
        let of = |mu: f64, kappa: f64| LameConstants { lambda: kappa - 2.0 / 3.0 * mu, mu };
        match self {
            Self::LinearElastic(law) => law.0,
            Self::SaintVenantKirchhoff(law) => law.0,
            Self::NeoHookean(law) => law.0,
            Self::NeoHookeanLogarithmic(law) => law.0,
            Self::MooneyRivlin(law) => of(2.0 * (law.c10 + law.c01), law.bulk_modulus),
            Self::Ogden(law) => {
                let products = law.terms.iter().map(|term| term.modulus * term.exponent);
                of(0.5 * products.sum::<f64>(), law.bulk_modulus)
            }
            Self::Energy(law) => law.small_strain(),
        }
    }

    /// Whether a rotation neither costs energy nor changes the answer to a strain.
    pub fn is_objective(&self) -> bool {
        !matches!(self, Self::LinearElastic(_))
    }
}

impl HyperelasticResponse for HyperelasticLaw {
    #[inline]
    fn energy<T: Number>(&self, a: &Matrix3<T>) -> T {
        match self {
            Self::LinearElastic(law) => law.energy(a),
            Self::SaintVenantKirchhoff(law) => law.energy(a),
            Self::NeoHookean(law) => law.energy(a),
            Self::NeoHookeanLogarithmic(law) => law.energy(a),
            Self::MooneyRivlin(law) => law.energy(a),
            Self::Ogden(law) => law.energy(a),
            Self::Energy(law) => law.energy(a),
        }
    }

    #[inline(always)]
    fn stress<T: Number>(&self, a: &Matrix3<T>) -> Matrix3<T> {
        match self {
            Self::LinearElastic(law) => law.stress(a),
            Self::SaintVenantKirchhoff(law) => law.stress(a),
            Self::NeoHookean(law) => law.stress(a),
            Self::NeoHookeanLogarithmic(law) => law.stress(a),
            Self::MooneyRivlin(law) => law.stress(a),
            Self::Ogden(law) => law.stress(a),
            Self::Energy(law) => law.stress(a),
        }
    }
}
