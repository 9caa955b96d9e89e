//! The largest step of central differences, of the body as it is deformed.

use super::{Matrices, Mixture, TotalLagrangian};
use crate::operators::one_by_one;
use crate::schemes::StepLimit;
use crate::schemes::look::Most;
use crate::solve::largest_mode;
use crate::{Tensor, Vector, parallel};

/// The share of the stable step at which a mode takes three steps a period, `2 sin(pi/3)/2`: there the
/// quadratic part of a law drives the mode by itself, theory (67).
const RESONANCE: f64 = 0.866_025_403_784_438_6;

/// The largest ratio of a step to the one before of an undamped body, whose bound goes up and down
/// with the vibrations of its stiffest particle: steps that go with them drive them.
const MOST_GROWTH: f64 = 1.01;

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

impl<const D: usize> TotalLagrangian<D> {
    /// The bounds of the body at rest, without what is prescribed.
    pub(super) fn bound(&mut self) -> Bound {
        let tangents: Vec<_> = self.solid.mixtures.iter().map(Mixture::tangents_at_rest).collect();
        let solid = self.solid.clone();
        let (stiffness, particle) = self.largest(true, |a, gradient| {
            let mixture = solid.mixture(a);
            mixture.stress_at_rest(&tangents[solid.mixture[a] as usize], gradient)
        });
        let (mut viscosity, dissipation) = (0.0, self.dissipation);
        if dissipation.is_viscous() {
            let eta = dissipation.viscosity;
            let bulk = |a: usize| dissipation.reference(&solid, a) - 2.0 * eta;
            let bulk: Vec<f64> = (0..solid.len()).map(bulk).collect();
            viscosity = self
                .largest(false, |a, rate| {
                    (rate + rate.transpose()) * eta + Tensor::identity() * (rate.trace() * bulk[a])
                })
                .0;
        }
        Bound { stiffness, viscosity, damping: dissipation.damping, particle }
    }

    /// Largest eigenvalue of `M^-1/2 K M^-1/2` for a stress that is linear in the gradient of a particle,
    /// with or without the hourglass force, which is elastic, and the particle that moves most in its mode.
    fn largest(
        &mut self,
        is_elastic: bool,
        stress: impl Fn(usize, &Tensor<D>) -> Tensor<D> + Sync,
    ) -> (f64, usize) {
        let solid = self.solid.clone();
        let (count, volume) = (solid.len(), &solid.particles.volume);
        let mut is_free = vec![true; count * D];
        self.prescribed.iter().for_each(|it| is_free[it.particle * D + it.component] = false);
        // Where no load grows: stresses at edges stay zero, and slopes follow the deformation.
        let behind = self.matrices.behind();
        let still = vec![Vector::<D>::zeros(); count + behind];
        let (mut field, mut all) = (still.clone(), still.clone());
        let mut strained = self.matrices.strained(count);
        let tension = |a: usize, gradient: &Tensor<D>| stress(a, gradient) * volume[a];
        let is_free = |a: usize, i: usize| is_free[a * D + i];
        let (square, fastest) = fastest_mode(&solid.mass, is_free, |direction, force| {
            field[..count].copy_from_slice(direction);
            self.rigid.project(&solid, &still, &mut field[..count]);
            match &mut self.matrices {
                Matrices::Adjoint(discrete) => {
                    let operator = &discrete.operator;
                    discrete.continue_field(&mut field);
                    // The hourglass force is elastic.
                    let (share, seen) = if is_elastic { (1.0, &field) } else { (0.0, &still) };
                    operator.strain_with(share, &field, &mut strained, one_by_one(tension));
                    operator.forces(seen, &strained.tension, &mut all);
                    operator.fold(&mut all);
                }
                Matrices::Strong(edges) => {
                    let of = |a: usize| solid.mixture(a).tangent(&Tensor::zeros());
                    edges.continue_rates(&mut field, of, |_| Vector::zeros());
                    for (a, own) in strained.tension.iter_mut().enumerate() {
                        *own = tension(a, &edges.gradient.gradient_at(&field, a));
                    }
                    edges.stress.fill(Vector::zeros());
                    edges.overwrite(&mut strained.tension, |_| 1.0);
                    edges.forces(&strained.tension, &still[count..], volume, &mut all[..count]);
                }
            }
            force.copy_from_slice(&all[..count]);
            if !self.rigid.is_empty() {
                force.iter_mut().zip(&solid.mass).for_each(|(force, mass)| *force /= *mass);
                self.rigid.project(&solid, &still, force);
                force.iter_mut().zip(&solid.mass).for_each(|(force, mass)| *force *= *mass);
            }
        });
        (SAFETY * square, fastest)
    }
}

/// The largest eigenvalue of `M^-1/2 K M^-1/2` on the components that are free, in 1/s^2, and the particle
/// that moves most in its mode: `apply` writes `-K u` of a field u.
fn fastest_mode<const D: usize>(
    mass: &[f64],
    is_free: impl Fn(usize, usize) -> bool,
    mut apply: impl FnMut(&[Vector<D>], &mut [Vector<D>]),
) -> (f64, usize) {
    let mut field = vec![Vector::zeros(); mass.len()];
    let mut force = field.clone();
    let mode = largest_mode(mass.len() * D, |direction, product| {
        for (a, (field, mass)) in field.iter_mut().zip(mass).enumerate() {
            let of = |i: usize| direction[a * D + i] / mass.sqrt();
            *field = Vector::from_fn(|i, _| if is_free(a, i) { of(i) } else { 0.0 });
        }
        apply(&field, &mut force);
        for (a, (product, mass)) in product.chunks_exact_mut(D).zip(mass).enumerate() {
            for (i, product) in product.iter_mut().enumerate() {
                *product = if is_free(a, i) { -force[a][i] / mass.sqrt() } else { 0.0 };
            }
        }
    });
    let speed = |a: usize| {
        mode.vector[a * D..][..D].iter().map(|entry| entry * entry).sum::<f64>() / mass[a]
    };
    let fastest = |best: usize, a: usize| if speed(a) > speed(best) { a } else { best };
    (parallel::larger(0.0, mode.value), (0..mass.len()).fold(0, fastest))
}
