//! One look over a state: is it sound, and how large may the next step be.

use std::ops::Range;

use bytemuck::cast_slice;
use multiversion::multiversion;
use nalgebra::SMatrix;
use piola_formulas::{Lanes4, Number as _, WIDTH, tensor};

use super::fields::Columns;
use super::{Mixture, TotalLagrangian};
use crate::coordinates;
use crate::schemes::look::{Most, Seen, Sight4, look_at_fours};
use crate::schemes::{Health, Particle, StepLimit};
use crate::{Tensor, Vector};

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
        let least = [0.0, 0.0, f64::NEG_INFINITY];
        let see = |own: Range<usize>, sight: &mut Sight4<3>| {
            for (mixture, run) in self.solid.runs(own) {
                for first in run.clone().step_by(BLOCK) {
                    let own = first..(first + BLOCK).min(run.end);
                    see_block(&self.block(mixture, own, at), sight);
                }
            }
        };
        let (health, [stiffening, thickening, softening]) =
            look_at_fours(&self.team, self.solid.len(), least, see);
        let soft = (softening.value > 0.0).then_some(softening.particle);
        (health, [stiffening, thickening], soft)
    }

    /// What there is to see of some particles of a mixture.
    fn block<'a>(
        &'a self,
        mixture: &Mixture<D>,
        own: Range<usize>,
        at: &Columns<'a, D>,
    ) -> Block<'a, D> {
        let columns = [at.velocity, at.displacement, at.kick].map(|column| &column[own.clone()]);
        let gradient = &self.strained.gradient[own.clone()];
        let (density, at_rest) = (mixture.density(), self.solid.moduli_at_rest(own.start));
        let (mut moduli, mut thickening) = ([at_rest; BLOCK], [0.0; BLOCK]);
        if !mixture.is_linear() {
            mixture.all_wave_moduli(gradient, &mut moduli[..gradient.len()]);
        }
        if self.dissipation.is_viscous() {
            let velocity = self.velocity(at);
            for ((a, gradient), thickening) in own.clone().zip(gradient).zip(&mut thickening) {
                *thickening = self.thickening_at(a, gradient, velocity);
            }
        }
        Block { first: own.start, columns, gradient, density, at_rest, moduli, thickening }
    }

    /// By how much viscosity has grown at a particle since rest.
    fn thickening_at(&self, a: usize, gradient: &Tensor<D>, velocity: &[Vector<D>]) -> f64 {
        let is_quadratic = self.dissipation.artificial_viscosity[1] > 0.0;
        let rate = is_quadratic.then(|| self.matrices.gradient_at(velocity, a));
        self.dissipation.thickening(&self.solid, a, gradient, rate.as_ref())
    }

    /// Whether the gradients at hand are those of the displacements of `state`: after a step they
    /// are, because forces have been taken there.
    pub(super) fn is_evaluated_at(&self, at: &Columns<'_, D>) -> bool {
        let is_known = self.is_evaluated
            && self.updated.is_none()
            && cast_slice::<_, f64>(&self.displacement[..self.solid.len()])
                == cast_slice(at.displacement);
        self.team.all(is_known)
    }
}

/// Most particles that are looked at together.
const BLOCK: usize = 64;

/// Particles of one mixture that follow each other.
struct Block<'a, const D: usize> {
    /// The first of them.
    first: usize,
    /// Velocities, displacements and accelerations.
    columns: [&'a [Vector<D>]; 3],
    gradient: &'a [Tensor<D>],
    /// Of the mixture, kg/m^3.
    density: f64,
    /// Smallest and largest modulus of a wave at rest, Pa.
    at_rest: [f64; 2],
    /// The same of each particle as it is.
    moduli: [[f64; 2]; BLOCK],
    /// By how much viscosity has grown at each since rest.
    thickening: [f64; BLOCK],
}

/// Sees particles four at a time: how much their stiffness and viscosity have grown, and how far they have softened.
#[multiversion(targets("x86_64+avx2"))]
fn see_block<const D: usize>(block: &Block<'_, D>, sight: &mut Sight4<3>) {
    let moduli: &[Vector<2>] = cast_slice(&block.moduli);
    let thickening: &[Vector<1>] = cast_slice(&block.thickening);
    let [least_at_rest, most_at_rest] = block.at_rest.map(Lanes4::from);
    let (zero, count) = (Lanes4::from(0.0), block.gradient.len());
    for first in (0..count).step_by(WIDTH) {
        let own = first..(first + WIDTH).min(count);
        let columns = block.columns.map(|column| tensor::lanes(&column[own.clone()]));
        // Zero times a number is zero if that is finite.
        let mut nothing = zero;
        for number in columns.iter().flatten() {
            nothing += *number * 0.0;
        }
        let gradient = tensor::lanes(&block.gradient[own.clone()]);
        let [least, most] = tensor::lanes(&moduli[own.clone()]).into();
        let [thickening] = tensor::lanes(&thickening[own]).into();
        let seen = Seen {
            velocity: columns[0],
            wave_speed: (Lanes4::select(most.above(0.0), most, zero) / block.density).sqrt(),
            ratio: tensor::determinant(&(gradient + SMatrix::identity())),
            mismatch: zero,
            figures: [most / most_at_rest, thickening, -least / least_at_rest],
        };
        sight.see(block.first + first, nothing.at_most(zero), &seen);
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
