//! The formulation without dissipation: kicks of its velocities, drifts of all the rest, and how
//! fast its fastest mode is.

use piola_formulas::tensor;

use super::Upwind;
use super::fields::ColumnsMut;
use crate::parallel;
use crate::schemes::split::advance;
use crate::schemes::{PartitionedScheme, Scheme};

/// Iterations of the power method. Modes crowd at the highest frequency of a lattice, so that few
/// do: 16 come within a few per cent of it.
const ITERATIONS: usize = 16;

/// How far a mode is displaced for its forces, over the spacing.
const SMALL: f64 = 1e-6;

impl<const D: usize> Upwind<D> {
    /// Whether nothing in it dissipates, so that forces depend on places alone.
    pub(super) fn is_conservative(&self) -> bool {
        self.settings.tau_velocity == 0.0 && self.settings.tau_pressure == 0.0
    }

    /// The largest frequency of small oscillations about `state` by the power method: a velocity
    /// field v makes the displacement `v dt`, and that the acceleration `-w^2 v dt` in a mode.
    pub(super) fn largest_frequency(&mut self, state: &[f64]) -> f64 {
        let count = self.particles.len();
        let mut rate = vec![0.0; state.len()];
        self.rates(0.0, state, &mut rate);
        let rest = rate.clone();
        let mut moved = state.to_vec();
        // A field without symmetry has a share of every mode.
        let mut mode: Vec<f64> =
            (0..count * D).map(|i| (1.0 + 1.7 * i as f64 * i as f64).sin()).collect();
        let mut square = 0.0;
        for _ in 0..ITERATIONS {
            self.clear_prescribed(&mut mode);
            let size = |field: &[f64]| {
                parallel::sum(count, |a| {
                    self.mass(a) * field[a * D..][..D].iter().map(|v| v * v).sum::<f64>()
                })
            };
            let norm = size(&mode).sqrt();
            let largest = mode.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            if !(norm > 0.0) {
                return 0.0;
            }
            let spacing = self.nearest.iter().copied().fold(f64::INFINITY, f64::min);
            let duration = SMALL * spacing / largest;
            moved.copy_from_slice(state);
            let (own, _) = ColumnsMut::<D>::of(&mut moved, count);
            bytemuck::cast_slice_mut(own.velocity).copy_from_slice(&mode);
            self.rates(0.0, &moved, &mut rate);
            self.drift(duration, &rate, &mut moved);
            self.rates(0.0, &moved, &mut rate);
            let numbers = |rate| -> &[f64] { bytemuck::cast_slice(self.columns(rate).velocity) };
            let pairs = numbers(&rest).iter().zip(numbers(&rate));
            let response: Vec<f64> = pairs.map(|(rest, rate)| (rest - rate) / duration).collect();
            let product = parallel::sum(count, |a| {
                let pairs = mode[a * D..][..D].iter().zip(&response[a * D..][..D]);
                self.mass(a) * pairs.map(|(v, r)| v * r).sum::<f64>()
            });
            square = product / (norm * norm);
            mode = response;
        }
        square.max(0.0).sqrt()
    }

    /// A prescribed component takes no part in a mode.
    fn clear_prescribed(&self, mode: &mut [f64]) {
        for entry in self.prescribed.iter() {
            mode[entry.particle * D + entry.component] = 0.0;
        }
    }
}

impl<const D: usize> PartitionedScheme for Upwind<D> {
    #[inline(never)]
    fn kick(&self, duration: f64, rate: &[f64], state: &mut [f64]) {
        let rate = self.columns(rate);
        let (own, _) = ColumnsMut::<D>::of(state, self.particles.len());
        advance(own.velocity, rate.velocity, duration);
    }

    /// x and F are linear in time then, and J follows F: `dJ/dt = cof F : dF/dt` is the rate of the
    /// determinant, so that J takes its whole change without any error of the step.
    #[inline(never)]
    fn drift(&self, duration: f64, rate: &[f64], state: &mut [f64]) {
        let (count, rate) = (self.particles.len(), self.columns(rate));
        let (own, _) = ColumnsMut::<D>::of(state, count);
        parallel::for_each_part(count, own, |first, own| {
            for (k, deformation) in own.deformation_gradient.iter_mut().enumerate() {
                let before = tensor::determinant(deformation);
                own.position[k] += rate.position[first + k] * duration;
                *deformation += rate.deformation_gradient[first + k] * duration;
                own.volume_ratio[k] += tensor::determinant(deformation) - before;
            }
        });
    }
}
