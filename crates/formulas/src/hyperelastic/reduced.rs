//! A law of three dimensions where fewer are resolved.

use nalgebra::{Matrix3, SMatrix};
use num_dual::Dual64;
use num_traits::Zero as _;

use super::{HyperelasticLaw, HyperelasticResponse};
use crate::volumetric::StressState;
use crate::{Number, Scalar, Slope, tensor};

/// Derivatives of the first Piola-Kirchhoff stress: entry `[k][l]` is `dP/dF_kl`, Pa.
pub type Tangent<const D: usize> = [[SMatrix<f64, D, D>; D]; D];

/// A law in `D` dimensions, with what holds the others: theory (43).
///
/// Where the material is held, the missing stretches are one. Where it is free they are what makes
/// the stress across vanish, found by Newton's method from the energy itself, and so for any law;
/// dual numbers pass through the solution with their first two derivatives. Energies are per
/// volume of a body of 1 m in each of the missing dimensions.
///
/// ```
/// use nalgebra::Matrix1;
/// use piola_formulas::hyperelastic::{HyperelasticLaw, LameConstants, Reduced};
/// use piola_formulas::volumetric::StressState;
///
/// let law = HyperelasticLaw::linear_elastic(LameConstants::from_young(5.0, 0.25)?);
/// let bar = Reduced::<1>::new(law, StressState::UniaxialStress)?;
/// assert!((bar.stress(&Matrix1::new(0.01_f64))[(0, 0)] - 0.05).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced<const D: usize> {
    law: HyperelasticLaw,
    state: StressState,
}

/// A stress state that does not belong to a dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{state:?} does not exist in {dimension} dimensions")]
pub struct ReducedError {
    /// The state asked for.
    pub state: StressState,
    /// Resolved dimensions.
    pub dimension: usize,
}

/// Steps after which a stretch across is given up; laws in use need up to ten.
const MOST_STEPS: usize = 200;

/// Step, over the stretch across, that is rounding; the steps of derivatives are further ones.
const ROUND_OFF: f64 = 16.0 * f64::EPSILON;

/// Trials for a bracket of the stretch across, each with a larger factor than the one before.
const WIDEST_BRACKET: u32 = 16;

/// Steps that carry derivatives: each makes one more order of them exact.
const STEPS_OF_DERIVATIVES: usize = 3;

impl<const D: usize> Reduced<D> {
    /// The law in this state.
    ///
    /// # Errors
    /// When the state belongs to another dimension.
    pub fn new(law: HyperelasticLaw, state: StressState) -> Result<Self, ReducedError> {
        match state.dimension() == D {
            true => Ok(Self { law, state }),
            false => Err(ReducedError { state, dimension: D }),
        }
    }

    /// The law without strain in the missing dimensions.
    pub fn without_strain(law: HyperelasticLaw) -> Self {
        let state = match D {
            1 => StressState::UniaxialStrain,
            2 => StressState::PlaneStrain,
            _ => StressState::ThreeDimensional,
        };
        Self { law, state }
    }

    /// The law in three dimensions.
    pub fn law(&self) -> &HyperelasticLaw {
        &self.law
    }

    /// What holds the missing dimensions.
    pub fn state(&self) -> StressState {
        self.state
    }

    /// Strain energy per reference volume, J/m^3, of a displacement gradient.
    ///
    /// NaN where no stretch across is free of stress.
    pub fn energy<T: Scalar>(&self, displacement_gradient: &SMatrix<T, D, D>) -> T {
        self.law.energy(&self.in_three(displacement_gradient))
    }

    /// First Piola-Kirchhoff stress, Pa; NaN where no stretch across is free of stress.
    pub fn stress<T: Scalar>(&self, displacement_gradient: &SMatrix<T, D, D>) -> SMatrix<T, D, D> {
        let stress = self.law.stress(&self.in_three(displacement_gradient));
        SMatrix::from_fn(|i, j| stress[(i, j)])
    }

    /// Stress, and the tangent `dP/dF`, exact by dual numbers: Dual-support (33).
    pub fn tangent(&self, displacement_gradient: &SMatrix<f64, D, D>) -> Tangent<D> {
        let mut tangent = [[SMatrix::zeros(); D]; D];
        for (k, row) in tangent.iter_mut().enumerate() {
            for (l, entry) in row.iter_mut().enumerate() {
                let mut seeded = displacement_gradient.map(Dual64::from_re);
                seeded[(k, l)] = seeded[(k, l)].derivative();
                *entry = self.stress(&seeded).map(|stress| stress.eps);
            }
        }
        tangent
    }

    /// Whether nothing is free in the missing dimensions, so that no stretch across has to be found.
    pub fn is_held(&self) -> bool {
        D == 3 || !self.state.is_free_across()
    }

    /// The stress where the law [is held](Self::is_held), in numbers of any type.
    #[inline(always)]
    pub fn held_stress<T: Number>(
        &self,
        displacement_gradient: &SMatrix<T, D, D>,
    ) -> SMatrix<T, D, D> {
        let stress = self.law.stress(&self.embedded(displacement_gradient, T::zero()));
        tensor::of_entries(|i, j| stress[(i, j)])
    }

    /// Smallest and largest modulus of plane waves that travel in the principal directions, Pa: eigenvalues
    /// of the acoustic tensors `N . dP/dF . N`. Where the smallest is negative the law has lost its
    /// convexity there, and no wave travels.
    ///
    /// Of an isotropic law, with derivatives W_i of its energy by the principal stretches l_i, they are
    /// `W_ii` along, and across `(l_i W_i - l_j W_j)/(l_i^2 - l_j^2)`, which for equal stretches is
    /// `(W_ii - W_ij + W_i/l_i)/2`.
    pub fn wave_moduli(&self, displacement_gradient: &SMatrix<f64, D, D>) -> [f64; 2] {
        if self.is_held() {
            return self.held_wave_moduli(displacement_gradient);
        }
        let stretches = principal_stretches(displacement_gradient);
        let mut slopes = [SMatrix::zeros(); D];
        for (axis, own) in slopes.iter_mut().enumerate() {
            *own = self.stress(&stretched(&stretches, axis));
        }
        moduli_of(&stretches, &slopes)
    }

    /// The same where the law [is held](Self::is_held), in numbers of any type.
    #[inline(always)]
    pub fn held_wave_moduli<T: Number>(&self, displacement_gradient: &SMatrix<T, D, D>) -> [T; 2] {
        if let HyperelasticLaw::NeoHookeanLogarithmic(own) = &self.law {
            return own.wave_moduli(displacement_gradient);
        }
        let stretches = principal_stretches(displacement_gradient);
        let mut slopes = [SMatrix::zeros(); D];
        for (axis, own) in slopes.iter_mut().enumerate() {
            *own = self.held_stress(&stretched(&stretches, axis));
        }
        moduli_of(&stretches, &slopes)
    }

    /// The displacement gradient in all three dimensions.
    pub fn in_three<T: Scalar>(&self, resolved: &SMatrix<T, D, D>) -> Matrix3<T> {
        let real = self.embedded(&resolved.map(T::re), 0.0);
        let embedded = self.embedded(resolved, T::zero());
        if self.is_held() {
            return embedded;
        }
        let Some((across, slope)) = self.strain_across(real) else {
            return Matrix3::from_element(T::from(f64::NAN));
        };
        let mut across = T::from(across);
        // With the slope of the real part alone each step still gains one order of derivatives,
        // because what it misses is infinitesimal.
        for _ in 0..STEPS_OF_DERIVATIVES {
            let stress = self.law.stress(&self.embedded(resolved, across))[(2, 2)];
            across -= stress * (1.0 / slope);
        }
        self.embedded(resolved, across)
    }

    #[inline(always)]
    fn embedded<T: Number>(&self, resolved: &SMatrix<T, D, D>, across: T) -> Matrix3<T> {
        tensor::of_entries(|i, j| match (i < D && j < D, i == j) {
            (true, _) => resolved[(i, j)],
            (false, true) => across,
            (false, false) => T::zero(),
        })
    }

    /// Stress across and its slope at a strain across, `gradient` being the resolved part.
    fn stress_across(&self, mut gradient: Matrix3<Dual64>, across: f64) -> Dual64 {
        let strain = Dual64::from_re(across).derivative();
        (D..3).for_each(|axis| gradient[(axis, axis)] = strain);
        self.law.stress(&gradient)[(2, 2)]
    }

    /// The strain across that is free of stress, with the slope of that stress there.
    ///
    /// Stress per current area times stretch is negative at small stretches across and positive at
    /// large ones in all objective laws here, so that a bracket exists; the law that is not
    /// objective is linear.
    fn strain_across(&self, gradient: Matrix3<f64>) -> Option<(f64, f64)> {
        let gradient = gradient.map(Dual64::from_re);
        let (mut low, mut high) = match self.law.is_objective() {
            true => self.bracket(gradient)?,
            false => (f64::NEG_INFINITY, f64::INFINITY),
        };
        let mut across = if low <= 0.0 && 0.0 <= high { 0.0 } else { 0.5 * (low + high) };
        for _ in 0..MOST_STEPS {
            let stress = self.stress_across(gradient, across);
            if stress.re < 0.0 {
                low = across;
            } else {
                high = across;
            }
            let newton = across - stress.re / stress.eps;
            if (newton - across).abs() <= ROUND_OFF * (1.0 + across).abs().min(1.0) {
                return Some((newton, stress.eps));
            }
            // Ends of the bracket are excluded, between which rounding could send the steps for ever.
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if !next.is_finite() {
                return None;
            }
            if next == across {
                return Some((next, stress.eps));
            }
            across = next;
        }
        None
    }

    /// Strains across of compression and tension, one a factor of stretch from the other.
    fn bracket(&self, gradient: Matrix3<Dual64>) -> Option<(f64, f64)> {
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        for power in 0..WIDEST_BRACKET {
            let factor = f64::from(1_u32 << power);
            let at_low = self.stress_across(gradient, low).re;
            if at_low <= 0.0 {
                let at_high = self.stress_across(gradient, high).re;
                if at_high >= 0.0 {
                    return Some((low, high));
                }
                (low, high) = (high, (1.0 + high) * 2.0_f64 * factor - 1.0);
            } else {
                (high, low) = (low, (1.0 + low) / (2.0 * factor) - 1.0);
            }
        }
        None
    }
}

/// The displacement gradient of principal stretches, with its derivative by one of them.
#[inline(always)]
fn stretched<T: Number, const D: usize>(
    stretches: &[T; D],
    axis: usize,
) -> SMatrix<Slope<T>, D, D> {
    tensor::of_entries(|k, l| match (k == l, k == axis) {
        (true, true) => Slope::variable(stretches[k] - 1.0),
        (true, false) => Slope::constant(stretches[k] - 1.0),
        _ => Slope::zero(),
    })
}

/// The extreme wave moduli at principal stretches, of the stresses with their derivatives by each of them.
#[inline(always)]
fn moduli_of<T: Number, const D: usize>(
    stretches: &[T; D],
    slopes: &[SMatrix<Slope<T>, D, D>; D],
) -> [T; 2] {
    let mut moduli = [f64::INFINITY, f64::NEG_INFINITY].map(T::from);
    let mut see = |modulus: T| moduli = [smaller(modulus, moduli[0]), larger(modulus, moduli[1])];
    for i in 0..D {
        see(slopes[i][(i, i)].slope);
        for j in 0..i {
            let (along, across) = (slopes[i][(i, i)], slopes[j][(j, j)]);
            let [one, other] = [stretches[i], stretches[j]];
            see(T::choose(
                (one * SAME_STRETCH).less((one - other).abs()),
                || (one * along.value - other * across.value) / (one * one - other * other),
                || (along.slope - slopes[i][(j, j)].slope + along.value / one) * 0.5,
            ));
        }
    }
    moduli
}

/// Stretches closer than this share are one: the difference of stresses is rounding.
const SAME_STRETCH: f64 = 1e-6;

/// Principal stretches of a displacement gradient.
#[inline(always)]
fn principal_stretches<T: Number, const D: usize>(gradient: &SMatrix<T, D, D>) -> [T; D] {
    let strain = tensor::right_cauchy_green(&(gradient + SMatrix::identity()));
    let [least, most] = tensor::extreme_eigenvalues(&strain);
    let squares = [least, most, strain.trace() - least - most];
    std::array::from_fn(|i| larger(squares[i], T::zero()).sqrt())
}

/// The smaller of two numbers; the second one where the first is none.
#[inline(always)]
pub(super) fn smaller<T: Number>(one: T, other: T) -> T {
    T::select(one.less(other), one, other)
}

/// The larger of two numbers; the second one where the first is none.
#[inline(always)]
pub(super) fn larger<T: Number>(one: T, other: T) -> T {
    T::select(other.less(one), one, other)
}
