//! The largest step of central differences.

use super::Elastodynamics;
use crate::solve::largest_mode;
use crate::{Tensor, Vector};

/// By how much the eigenvalues that are found may be too small, as all of Lanczos' values are.
const SAFETY: f64 = 1.002;

/// Bounds on frequencies of the discrete body at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bound {
    /// Largest eigenvalue of `M^-1 K`, 1/s^2.
    stiffness: f64,
    /// Largest eigenvalue of `M^-1 C` with the matrix C of all dissipation, 1/s.
    dissipation: f64,
    /// The particle that moves most in the fastest mode.
    pub particle: usize,
}

impl Bound {
    /// Largest step in s of central differences with dissipation by the velocities half a step back,
    /// theory (67), of a body that has become stiffer by a factor.
    pub fn step(&self, stiffening: f64) -> f64 {
        let (stiffness, dissipation) = (self.stiffness * stiffening, self.dissipation);
        if !(stiffness > 0.0) {
            return if dissipation > 0.0 { 2.0 / dissipation } else { f64::INFINITY };
        }
        4.0 / (dissipation + (dissipation * dissipation + 4.0 * stiffness).sqrt())
    }
}

impl<const D: usize> Elastodynamics<D> {
    /// The bounds of the body at rest, without what is prescribed.
    pub(super) fn bound(&mut self) -> Bound {
        let tangents: Vec<_> = self.mixtures.iter().map(super::Mixture::tangents_at_rest).collect();
        let elastic = |scheme: &Self, gradient: &Tensor<D>, a: usize| {
            let kind = scheme.mixture[a] as usize;
            scheme.mixtures[kind].stress_at_rest(&tangents[kind], gradient)
        };
        let (stiffness, particle) = self.largest(true, elastic);
        let mut dissipation = self.settings.damping;
        if self.settings.is_viscous() {
            let viscous = |scheme: &Self, rate: &Tensor<D>, a: usize| {
                (rate + rate.transpose()) * scheme.settings.viscosity
                    + Tensor::identity() * (rate.trace() * scheme.artificial_modulus(a))
            };
            dissipation += self.largest(false, viscous).0;
        }
        Bound { stiffness, dissipation, particle }
    }

    /// Largest eigenvalue of `M^-1/2 K M^-1/2` for a stress that is linear in the gradient, and the
    /// particle that moves most in its mode.
    fn largest(
        &mut self,
        is_elastic: bool,
        stress: impl Fn(&Self, &Tensor<D>, usize) -> Tensor<D>,
    ) -> (f64, usize) {
        let count = self.mass.len();
        let root: Vec<f64> = self.mass.iter().map(|mass| mass.sqrt()).collect();
        let mut is_free = vec![true; count * D];
        self.prescribed.iter().for_each(|it| is_free[it.particle * D + it.component] = false);
        let still = [[0.0; 2]; D];
        // Where no load grows: stresses at edges stay zero, and slopes follow the deformation.
        let mut edges = self.edges.take();
        let data = edges.as_ref().map_or(0, |edges| edges.slots.len());
        let no_load = vec![Vector::<D>::zeros(); data];
        let tangents: Vec<_> =
            self.mixtures.iter().map(|mixture| mixture.tangent(&Tensor::zeros())).collect();
        let mut field = vec![Vector::<D>::zeros(); count + data];
        let mut force = vec![Vector::<D>::zeros(); count];
        let mut tension = vec![Tensor::<D>::zeros(); count];
        let mode = largest_mode(count * D, |direction, product| {
            for (a, field) in field[..count].iter_mut().enumerate() {
                *field = Vector::from_fn(|i, _| {
                    if is_free[a * D + i] { direction[a * D + i] / root[a] } else { 0.0 }
                });
            }
            if let Some(edges) = &mut edges {
                let of = |a: usize| tangents[self.mixture[a] as usize];
                edges.continue_rates(&self.matrix, &mut field, of, |_| Vector::zeros());
            }
            self.matrix.gradient(&field, &still, &mut tension);
            for (a, tension) in tension.iter_mut().enumerate() {
                let gradient = *tension;
                *tension = stress(self, &gradient, a) * self.particles.volume[a];
                if let (Some(hourglass), true) = (&self.hourglass, is_elastic) {
                    let shape = self.matrix.shape(a);
                    *tension -= gradient * shape * (2.0 * hourglass.coefficient(a));
                }
            }
            match &mut edges {
                Some(edges) => {
                    edges.stress.fill(Vector::zeros());
                    edges.overwrite(&mut tension, |_| 1.0);
                    edges.forces(&tension, &no_load, &self.particles.volume, &mut force);
                }
                None => self.matrix.forces(&tension, &mut force),
            }
            if let (Some(hourglass), true) = (&self.hourglass, is_elastic) {
                hourglass.add_forces(&field, &still, &mut force);
            }
            for (entry, product) in product.iter_mut().enumerate() {
                let a = entry / D;
                *product = if is_free[entry] { -force[a][entry % D] / root[a] } else { 0.0 };
            }
        });
        self.edges = edges;
        let speed = |a: usize| {
            mode.vector[a * D..][..D].iter().map(|entry| entry * entry).sum::<f64>() / self.mass[a]
        };
        let fastest = |best: usize, a: usize| if speed(a) > speed(best) { a } else { best };
        (SAFETY * mode.value.max(0.0), (0..count).fold(0, fastest))
    }
}
