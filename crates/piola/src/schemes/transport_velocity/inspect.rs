//! One look over a state: is it sound, and how large may the next step be.

use std::ops::Range;

use super::TransportVelocity;
use crate::parallel::{self, CHUNK, PerChunk};
use crate::schemes::{Health, StepLimit};

/// Figures of one chunk of particles.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChunkFigures {
    health: Health,
    /// Squares of the largest speed and acceleration, with their particles.
    speed: (f64, usize),
    acceleration: (f64, usize),
    /// Largest speed of signals, waves and what carries them, in m/s.
    signal: (f64, usize),
}

impl ChunkFigures {
    pub const NEUTRAL: Self =
        Self { health: Health::NEUTRAL, speed: (0.0, 0), acceleration: (0.0, 0), signal: (0.0, 0) };

    fn worse(self, other: Self) -> Self {
        let larger = |a: (f64, usize), b: (f64, usize)| if b.0 > a.0 { b } else { a };
        Self {
            health: self.health.worse(other.health),
            speed: larger(self.speed, other.speed),
            acceleration: larger(self.acceleration, other.acceleration),
            signal: larger(self.signal, other.signal),
        }
    }
}

impl<const D: usize> TransportVelocity<D> {
    /// The health of `state` and the bounds on the step, CTVF (61) corrected, theory (34):
    ///
    /// - `acoustic`: `h / (c + |u|)` of the largest speed; of solids with the speed of longitudinal waves,
    ///   where the paper has that of bulk waves;
    /// - `viscous`: `h^2 / nu`;
    /// - `acceleration`: `sqrt(h / |du/dt|)` of the largest acceleration, where the paper has
    ///   that of gravity.
    ///
    /// All are scaled by the CFL number, which the paper has as 0.25.
    pub(super) fn look(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        if self.guard.is_some() {
            self.load(state);
        }
        let mut figures = std::mem::take(&mut self.chunk_figures);
        let count = self.particles.len();
        parallel::for_each_part(count, PerChunk(&mut figures), |first, PerChunk(figures)| {
            figures.fill(self.look_at(first..count.min(first + CHUNK), state));
        });
        let worst = figures.iter().copied().fold(ChunkFigures::NEUTRAL, ChunkFigures::worse);
        self.chunk_figures = figures;

        let h = self.support.smoothing_length();
        let growth = f64::INFINITY;
        let limit = |name, step, particle| StepLimit { name, step, particle, scaled: true, growth };
        limits.clear();
        let (fastest, particle) = match self.solids {
            Some(_) => worst.signal,
            None => (self.fluid.wave_speed + worst.speed.0.sqrt(), worst.speed.1),
        };
        limits.push(limit("acoustic", h / fastest, particle));
        if self.fluid.viscosity > 0.0 {
            limits.push(limit("viscous", h * h / self.fluid.viscosity, worst.speed.1));
        }
        if worst.acceleration.0 > 0.0 {
            let step = (h / worst.acceleration.0.sqrt()).sqrt();
            limits.push(limit("acceleration", step, worst.acceleration.1));
        }
        let mut health = worst.health;
        if let Some((guard, _)) = &self.guard
            && !guard.removes
            && health.first_not_finite.is_none()
        {
            health.first_escaped = self.escaped(state).first().copied();
        }
        health
    }

    fn look_at(&self, numbers: Range<usize>, state: &[f64]) -> ChunkFigures {
        let (mut worst, at) = (ChunkFigures::NEUTRAL, self.columns(state));
        for number in numbers {
            let matter = match self.solids {
                Some(_) => self.matter_of(number, state),
                None => &[],
            };
            let vectors = [&at.position, &at.velocity, &at.deviation, &at.kick];
            let mut numbers = vectors.iter().flat_map(|column| column[number].iter());
            let scalars = [at.density[number], at.pressure[number]];
            if numbers.any(|value| !value.is_finite())
                || scalars.iter().chain(matter).any(|value| !value.is_finite())
            {
                worst.health.first_not_finite.get_or_insert(number);
                continue;
            }
            let speed = at.velocity[number].norm_squared();
            if speed > worst.speed.0 {
                worst.speed = (speed, number);
            }
            if self.is_wall[number] {
                continue;
            }
            // The inverse has the sign of the density, and is the volume ratio.
            let ratio = self.reference_density(number) / at.density[number];
            if ratio < worst.health.smallest_ratio {
                worst.health.smallest_ratio = ratio;
                worst.health.smallest_ratio_particle = number;
            }
            if let Some(wave_speed) = self.signal_speed(number, state) {
                let signal = wave_speed + speed.sqrt();
                if signal > worst.signal.0 {
                    worst.signal = (signal, number);
                }
                worst.health.largest_wave_speed = worst.health.largest_wave_speed.max(wave_speed);
            }
            let acceleration = at.kick[number].norm_squared();
            if acceleration > worst.acceleration.0 {
                worst.acceleration = (acceleration, number);
            }
        }
        worst.health.largest_speed = worst.speed.0.sqrt();
        worst.health.largest_speed_particle = worst.speed.1;
        if self.solids.is_none() {
            worst.health.largest_wave_speed = self.fluid.wave_speed;
        }
        worst
    }
}
