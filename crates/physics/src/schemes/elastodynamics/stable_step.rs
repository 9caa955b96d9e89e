//! The largest step of central differences, of the body as it is deformed.

use piola_formulas::tensor;

use super::{Elastodynamics, Matrices, Mixture};
use crate::schemes::StepLimit;
use crate::schemes::look::{MOST_GROWTH, Most, RESONANCE};
use crate::schemes::solid::fastest_mode;
use crate::{Tensor, Vector};

/// By how much the eigenvalues that are found may be too small, as all of Lanczos' values are.
const SAFETY: f64 = 1.002;

/// Stiffening that is rounding.
const ROUND_OFF: f64 = 1e-9;

/// Bounds on frequencies of the discrete body at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bound {
    /// Largest eigenvalue of `M^-1 K`, 1/s^2.
    stiffness: f64,
    /// Largest eigenvalue of `M^-1 C` with the matrix C of the reference viscosity, 1/s.
    viscosity: f64,
    /// Rate of damping, 1/s.
    damping: f64,
    /// The particle that moves most in the fastest mode.
    particle: usize,
}

impl Bound {
    /// The largest step of central differences with dissipation by the velocities half a step back,
    /// theory (67), of a body whose stiffness and whose viscosity have grown by these factors since
    /// rest. It is named by the larger of its two parts.
    ///
    /// Laws that are not linear resonate at three steps a period, which is the limit for them where
    /// dissipation does not set a smaller one.
    pub fn limit(&self, stiffening: Most, thickening: Most, is_linear: bool) -> StepLimit {
        let stiffness = self.stiffness * stiffening.value;
        let dissipation = self.viscosity * thickening.value + self.damping;
        let sum = dissipation + (dissipation * dissipation + 4.0 * stiffness).sqrt();
        let (name, particle) = match dissipation * dissipation > stiffness {
            true => ("dissipation", thickening.particle),
            // The mode at rest tells where small or crowded particles are, until something stiffens.
            false if stiffening.value > 1.0 + ROUND_OFF => ("eigenvalue", stiffening.particle),
            false => ("eigenvalue", self.particle),
        };
        let step = match sum {
            sum if sum.is_nan() => sum,
            sum if sum > 0.0 && is_linear => 4.0 / sum,
            sum if sum > 0.0 => (4.0 / sum).min(RESONANCE * 2.0 / stiffness.sqrt()),
            _ => f64::INFINITY,
        };
        let growth = match dissipation > 0.0 || is_linear {
            true => f64::INFINITY,
            false => MOST_GROWTH,
        };
        StepLimit { name, step, particle, scaled: true, growth }
    }
}

impl<const D: usize> Elastodynamics<D> {
    /// The bounds of the body at rest, without what is prescribed.
    pub(super) fn bound(&mut self) -> Bound {
        let tangents: Vec<_> = self.mixtures.iter().map(Mixture::tangents_at_rest).collect();
        let elastic = |mixture: &Mixture<D>, [kind, _]: [usize; 2], gradient: &Tensor<D>| {
            mixture.stress_at_rest(&tangents[kind], gradient)
        };
        let (stiffness, particle) = self.largest(true, elastic);
        let mut viscosity = 0.0;
        if self.settings.is_viscous() {
            let eta = self.settings.viscosity;
            let bulk = |a: usize| self.reference_viscosity(a) - 2.0 * eta;
            let bulk: Vec<f64> = (0..self.mass.len()).map(bulk).collect();
            let viscous = |_: &Mixture<D>, [_, a]: [usize; 2], rate: &Tensor<D>| {
                (rate + rate.transpose()) * eta + Tensor::identity() * (rate.trace() * bulk[a])
            };
            viscosity = self.largest(false, viscous).0;
        }
        Bound { stiffness, viscosity, damping: self.settings.damping, particle }
    }

    /// By how much the viscosity that a wave meets at particle `a` exceeds the reference viscosity.
    ///
    /// Rates `a (x) N` have `d = sym(a (x) m)` with `m = F^-T N`, so that the power of (65) and (66),
    /// `J (2 eta d : d + b (tr d)^2)`, is at most `J |m|^2 (2 eta + b) |a|^2`, for a and m along the
    /// direction of the smallest stretch l, where `|m| = 1/l`. The slope of the quadratic part is
    /// `b = 2 b_2 rho l^2 |tr d|`.
    pub(super) fn thickening(
        &self,
        gradient: &Tensor<D>,
        rate: Option<&Tensor<D>>,
        a: usize,
    ) -> f64 {
        let deformation = gradient + Tensor::identity();
        let shortest = tensor::smallest_eigenvalue(&tensor::right_cauchy_green(&deformation));
        let mut viscosity = 2.0 * self.settings.viscosity + self.artificial_modulus(a);
        if let (Some(rate), Some(inverse)) = (rate, tensor::inverse(&deformation)) {
            let expansion = (rate * inverse).trace();
            viscosity += 2.0 * self.quadratic_modulus(a) * (-expansion).max(0.0);
        }
        tensor::determinant(&deformation).abs() / shortest * viscosity / self.reference_viscosity(a)
    }

    /// What [`Elastodynamics::thickening`] is counted from, Pa s: the sum of all viscosities at rest,
    /// the quadratic one as large as if the spacing closed at half the wave speed.
    fn reference_viscosity(&self, a: usize) -> f64 {
        let [_, quadratic] = self.settings.artificial_viscosity;
        let impedance = self.impedance(a) * self.particles.spacing[a];
        2.0 * self.settings.viscosity + self.artificial_modulus(a) + quadratic * impedance
    }

    /// Largest eigenvalue of `M^-1/2 K M^-1/2` for a stress that is linear in the gradient, which is told the
    /// numbers of mixture and particle, and the particle that moves most in its mode.
    fn largest(
        &mut self,
        is_elastic: bool,
        stress: impl Fn(&Mixture<D>, [usize; 2], &Tensor<D>) -> Tensor<D>,
    ) -> (f64, usize) {
        let count = self.mass.len();
        let mut is_free = vec![true; count * D];
        self.prescribed.iter().for_each(|it| is_free[it.particle * D + it.component] = false);
        // Where no load grows: stresses at edges stay zero, and slopes follow the deformation.
        let behind = self.matrices.behind();
        let no_load = vec![Vector::<D>::zeros(); behind];
        let tangents: Vec<_> =
            self.mixtures.iter().map(|mixture| mixture.tangent(&Tensor::zeros())).collect();
        let mut field = vec![Vector::<D>::zeros(); count + behind];
        let mut all = field.clone();
        let mut tension = vec![Tensor::<D>::zeros(); count + behind];
        let still = [[0.0; 2]; D];
        let no_motion = field.clone();
        let is_free = |a: usize, i: usize| is_free[a * D + i];
        let (square, fastest) = fastest_mode(&self.mass, is_free, |direction, force| {
            field[..count].copy_from_slice(direction);
            match &mut self.matrices {
                Matrices::Adjoint(operator) => operator.continue_field(&still, &mut field),
                Matrices::Strong(edges) => {
                    let of = |a: usize| tangents[self.mixture[a] as usize];
                    edges.continue_rates(&mut field, of, |_| Vector::zeros());
                }
            }
            self.matrices.gradients(&field, &mut tension[..count]);
            for (a, tension) in tension[..count].iter_mut().enumerate() {
                let (gradient, kind) = (*tension, self.mixture[a] as usize);
                *tension =
                    stress(&self.mixtures[kind], [kind, a], &gradient) * self.particles.volume[a];
                if let (Matrices::Adjoint(operator), true) = (&self.matrices, is_elastic) {
                    *tension = operator.tension(a, &gradient, *tension);
                }
            }
            match &mut self.matrices {
                Matrices::Adjoint(operator) => {
                    // The hourglass force is elastic.
                    let field = if is_elastic { &field } else { &no_motion };
                    operator.forces(field, &tension, &mut all);
                    operator.fold(&mut all);
                }
                Matrices::Strong(edges) => {
                    edges.stress.fill(Vector::zeros());
                    edges.overwrite(&mut tension, |_| 1.0);
                    edges.forces(&tension, &no_load, &self.particles.volume, &mut all[..count]);
                }
            }
            force.copy_from_slice(&all[..count]);
        });
        (SAFETY * square, fastest)
    }
}
