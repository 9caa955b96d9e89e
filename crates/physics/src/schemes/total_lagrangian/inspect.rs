//! One look over a state: is it sound, and how large may the next step be.

use piola_formulas::tensor;

use super::TotalLagrangian;
use super::fields::Columns;
use crate::coordinates;
use crate::schemes::look::{Most, Seen, look};
use crate::schemes::{Health, Particle, StepLimit};
use crate::{Tensor, Vector, parallel};

impl<const D: usize> TotalLagrangian<D> {
    /// The health of `state` and the bound on the step, theory (50) and (67), of the body as it is
    /// deformed: `eigenvalue`, from the largest frequency of the operator at rest, hourglass term
    /// included, times the largest stiffening of a particle since, or `dissipation`, where that of
    /// viscosity and damping is the larger part.
    pub(super) fn look(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        let at = self.columns(state);
        let is_known = self.is_evaluated_at(&at);
        // Velocities have been kicked since forces were taken.
        if !(is_known && self.velocity.is_empty()) {
            self.load(&at);
        }
        if !is_known {
            self.matrices.gradients(&self.displacement, &mut self.strained.gradient);
        }
        let (solid, gradient) = (&self.solid, &self.strained.gradient);
        parallel::for_each_chunk(&mut self.moduli, |first, moduli| {
            solid.wave_moduli(first, &gradient[first..][..moduli.len()], moduli);
        });
        let (health, [stiffening, thickening], soft) = self.look_at_solid(&at);
        if let Some(a) = soft.and_then(|number| self.team.own(number, self.solid.len())) {
            self.not_convex = Some((a, self.strained.gradient[a]));
        }
        self.is_evaluated = is_known;
        limits.clear();
        if self.is_static {
            // Nothing moves: rows hold another rate.
            return Health { largest_speed: 0.0, ..health };
        }
        limits.push(self.stable.limit(stiffening, thickening, self.solid.is_linear()));
        if !self.rigid.is_empty() {
            let read = [at.displacement, at.velocity, at.kick];
            limits
                .extend(self.with_group(read, [], |solid, read, []| self.rigid.limit(solid, read)));
        }
        limits.extend(self.loads.springs.iter().map(|spring| {
            let first = spring.particles.first().map_or(0, |&a| a as usize);
            StepLimit::scaled("spring", spring.stable_step(self.masses()), first)
        }));
        health
    }

    /// The health of the loaded state; the largest modulus of a wave over that at rest, and the largest
    /// thickening; and the particle whose material has lost its convexity most, if there is one.
    fn look_at_solid(&self, at: &Columns<'_, D>) -> (Health, [Most; 2], Option<usize>) {
        let (solid, columns) = (&*self.solid, [at.velocity, at.displacement, at.kick]);
        let velocity = self.velocity(at);
        let least = [0.0, 0.0, f64::NEG_INFINITY];
        let team = &self.team;
        let (health, [stiffening, thickening, softening]) = look(team, solid.len(), least, |a| {
            let is_finite = |column: &&[Vector<D>]| column[a].iter().all(|value| value.is_finite());
            columns.iter().all(is_finite).then(|| {
                let gradient = &self.strained.gradient[a];
                let mixture = solid.mixture(a);
                let at_rest = solid.moduli_at_rest(a);
                let moduli = self.moduli.get(a).copied().unwrap_or(at_rest);
                let thickening = self.thickening_at(a, gradient, velocity);
                Seen {
                    velocity: at.velocity[a],
                    wave_speed: (moduli[1].max(0.0) / mixture.density()).sqrt(),
                    ratio: tensor::determinant(&(gradient + Tensor::identity())),
                    mismatch: 0.0,
                    figures: [moduli[1] / at_rest[1], thickening, -moduli[0] / at_rest[0]],
                }
            })
        });
        let soft = (softening.value > 0.0).then_some(softening.particle);
        (health, [stiffening, thickening], soft)
    }

    /// By how much viscosity has grown at a particle since rest.
    fn thickening_at(&self, a: usize, gradient: &Tensor<D>, velocity: &[Vector<D>]) -> f64 {
        if !self.dissipation.is_viscous() {
            return 0.0;
        }
        let is_quadratic = self.dissipation.artificial_viscosity[1] > 0.0;
        let rate = is_quadratic.then(|| self.matrices.gradient_at(velocity, a));
        self.dissipation.thickening(&self.solid, a, gradient, rate.as_ref())
    }

    /// Whether the gradients at hand are those of the displacements of `state`: after a step they
    /// are, because forces have been taken there.
    pub(super) fn is_evaluated_at(&self, at: &Columns<'_, D>) -> bool {
        let is_known = self.is_evaluated
            && self.updated.is_none()
            && self.displacement[..self.solid.len()] == *at.displacement;
        self.team.all(is_known)
    }
}

/// What the user should know of a particle of which the material has lost its convexity.
pub(super) fn convexity_is_lost<const D: usize>(
    particle: &Particle,
    gradient: &Tensor<D>,
    advice: &str,
) -> String {
    let strain = tensor::right_cauchy_green(&(gradient + Tensor::identity()));
    let stretches =
        [tensor::smallest_eigenvalue(&strain), tensor::largest_eigenvalue(&strain)].map(f64::sqrt);
    format!(
        "the material of particle {} at {} m has lost its convexity, at principal stretches from \
         {:.3} to {:.3}: no waves travel there, strains localise in single layers of particles, \
         and further results depend on the lattice; {advice}",
        particle.id,
        coordinates(&particle.reference),
        stretches[0],
        stretches[1]
    )
}
