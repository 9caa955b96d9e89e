//! One look over a state: is it sound, and how large may the next step be.

use std::ops::Range;

use piola_formulas::volumetric::VolumetricResponse;
use piola_formulas::{riemann, tensor};

use super::Upwind;
use super::fields::Columns;
use crate::parallel::{self, CHUNK, PerChunk};
use crate::schemes::{Health, StepLimit};

/// Figures of one chunk of particles.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChunkFigures {
    health: Health,
    /// Smallest `d_a / c_a` in s and its particle.
    crossing: f64,
    crossing_particle: usize,
    /// Largest referential wave speed in m/s and its particle.
    fastest: f64,
    fastest_particle: usize,
    /// Largest speed of the shock that the dissipation uses, over the reference speed.
    shock_ratio: f64,
}

impl ChunkFigures {
    pub const NEUTRAL: Self = Self {
        health: Health::NEUTRAL,
        crossing: f64::INFINITY,
        crossing_particle: 0,
        fastest: 0.0,
        fastest_particle: 0,
        shock_ratio: 1.0,
    };

    fn worse(self, other: Self) -> Self {
        let slower = other.crossing < self.crossing;
        let faster = other.fastest > self.fastest;
        Self {
            health: self.health.worse(other.health),
            crossing: if slower { other.crossing } else { self.crossing },
            crossing_particle: if slower {
                other.crossing_particle
            } else {
                self.crossing_particle
            },
            fastest: if faster { other.fastest } else { self.fastest },
            fastest_particle: if faster { other.fastest_particle } else { self.fastest_particle },
            shock_ratio: self.shock_ratio.max(other.shock_ratio),
        }
    }
}

impl<const D: usize> Upwind<D> {
    /// The health of `state` and the bounds on the step.
    ///
    /// - `acoustic`: `d_a / c_a`, theory (16), Upwind (4.3) with each particle's own nearest distance and the
    ///   wave speed of the deformed state; scaled by the CFL number.
    /// - `upwind dissipation`: the two stages of an explicit method decay a mode of rate r
    ///   without growth for `r dt <= 2`. By Gershgorin's theorem r is at most twice the row sum
    ///   of the exchange coefficients, so `dt <= 1 / row sum`, theory (17); not scaled.
    pub(super) fn look(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        let mut figures = std::mem::take(&mut self.chunk_figures);
        let (count, at) = (self.particles.len(), self.columns(state));
        parallel::for_each_part(count, PerChunk(&mut figures), |first, PerChunk(figures)| {
            figures.fill(self.look_at_all(first..count.min(first + CHUNK), &at));
        });
        let worst = figures.iter().copied().fold(ChunkFigures::NEUTRAL, ChunkFigures::worse);
        self.chunk_figures = figures;

        limits.clear();
        limits.push(StepLimit {
            name: "acoustic",
            step: worst.crossing,
            particle: worst.crossing_particle,
            scaled: true,
            growth: f64::INFINITY,
        });
        let settings = &self.settings;
        let exchange = self.largest_exchange * worst.shock_ratio;
        let velocity_rate = settings.tau_velocity * exchange * self.fastest_reference;
        // The pressure exchange is the velocity's times (c/c0)^2: it sees the current stiffness.
        let pressure_rate = settings.tau_pressure
            * self.largest_exchange
            * worst.fastest
            * (worst.fastest / self.fastest_reference);
        let rate = velocity_rate.max(pressure_rate);
        if rate > 0.0 {
            limits.push(StepLimit {
                name: "upwind dissipation",
                step: 1.0 / rate,
                particle: worst.fastest_particle,
                scaled: false,
                growth: f64::INFINITY,
            });
        }
        Health { largest_wave_speed: worst.fastest, ..worst.health }
    }

    fn look_at_all(&self, particles: Range<usize>, at: &Columns<'_, D>) -> ChunkFigures {
        let mut worst = ChunkFigures::NEUTRAL;
        for a in particles {
            let is_finite = at.volume_ratio[a].is_finite()
                && at.velocity[a].iter().all(|value| value.is_finite())
                && at.position[a].iter().all(|value| value.is_finite())
                && at.deformation_gradient[a].iter().all(|value| value.is_finite());
            if !is_finite {
                worst.health.first_not_finite.get_or_insert(a);
                continue;
            }
            worst = worst.worse(self.look_at(a, at));
        }
        worst
    }

    #[inline]
    fn look_at(&self, a: usize, at: &Columns<'_, D>) -> ChunkFigures {
        let (evolved, gradient) = (at.volume_ratio[a], &at.deformation_gradient[a]);
        let determinant = tensor::determinant(gradient);
        let speed = at.velocity[a].iter().map(|v| v * v).sum::<f64>().sqrt();
        let health = Health {
            largest_speed: speed,
            largest_speed_particle: a,
            largest_wave_speed: 0.0,
            smallest_ratio: evolved.min(determinant),
            smallest_ratio_particle: a,
            ratio_mismatch: (evolved - determinant).abs(),
            first_not_finite: None,
            first_escaped: None,
        };
        if !(health.smallest_ratio > 0.0) {
            return ChunkFigures { health, ..ChunkFigures::NEUTRAL };
        }
        let smallest = tensor::smallest_eigenvalue(&tensor::right_cauchy_green(gradient));
        let reference = &self.reference[a];
        let acoustic = self.law(a).wave_speed(evolved, reference.density);
        let fastest = riemann::referential_wave_speed(acoustic, determinant, smallest);
        let shock_ratio = match self.settings.wave_speed {
            super::WaveSpeed::Constant => 1.0,
            super::WaveSpeed::Stretch => 1.0 / smallest.sqrt(),
        };
        ChunkFigures {
            health,
            crossing: self.nearest[a] / fastest,
            crossing_particle: a,
            fastest,
            fastest_particle: a,
            shock_ratio,
        }
    }

    /// Wave speed on the reference configuration of each particle in m/s, for output.
    pub(super) fn wave_speed(&self, a: usize, at: &Columns<'_, D>) -> f64 {
        self.look_at(a, at).fastest
    }
}
