//! One look over a state: is it sound, and how large may the next step be.

use piola_formulas::volumetric::VolumetricResponse;
use piola_formulas::{riemann, tensor};

use super::fields::Columns;
use super::{Settings, Upwind, WaveSpeed};
use crate::schemes::look::{Most, Seen, look};
use crate::schemes::{Health, StepLimit};

impl<const D: usize> Upwind<D> {
    /// The health of `state` and the bounds on the step.
    ///
    /// - `acoustic`: `d_a / c_a`, theory (16), Upwind (4.3) with each particle's own nearest distance and the
    ///   wave speed of the deformed state; scaled by the CFL number.
    /// - `upwind dissipation`: the two stages of an explicit method decay a mode of rate r
    ///   without growth for `r dt <= 2`. By Gershgorin's theorem r is at most twice the row sum
    ///   of the exchange coefficients, so `dt <= 1 / row sum`, theory (17); not scaled.
    pub(super) fn look(&self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        let at = self.columns(state);
        let (health, figures) =
            look(&self.team, self.particles.len(), LEAST, |a| self.look_at(a, &at));
        self.bounds().write(figures, limits);
        health
    }

    /// What bounds steps, whatever the state.
    pub(super) fn bounds(&self) -> Bounds {
        let Self { settings, largest_exchange, fastest_reference, .. } = *self;
        Bounds { settings, largest_exchange, fastest_reference }
    }

    /// What particle `a` contributes: the negative of the time in s in which a wave crosses `d_a`, the
    /// wave speed on the reference configuration in m/s, and the speed of the shock that the dissipation
    /// uses over the reference speed.
    #[inline]
    fn look_at(&self, a: usize, at: &Columns<'_, D>) -> Option<Seen<D, 3>> {
        let (evolved, gradient) = (at.volume_ratio[a], &at.deformation_gradient[a]);
        let mut vectors = at.velocity[a].iter().chain(&at.position[a]).chain(gradient);
        if !(evolved.is_finite() && vectors.all(|value| value.is_finite())) {
            return None;
        }
        let determinant = tensor::determinant(gradient);
        let mut seen = Seen {
            velocity: at.velocity[a],
            wave_speed: 0.0,
            ratio: evolved.min(determinant),
            mismatch: (evolved - determinant).abs(),
            figures: LEAST,
        };
        if !(seen.ratio > 0.0) {
            return Some(seen);
        }
        let smallest = tensor::smallest_eigenvalue(&tensor::right_cauchy_green(gradient));
        let acoustic = self.law(a).wave_speed(evolved, self.reference[a].density);
        seen.wave_speed = riemann::referential_wave_speed(acoustic, determinant, smallest);
        let shock_ratio = match self.settings.wave_speed {
            WaveSpeed::Constant => 1.0,
            WaveSpeed::Stretch => 1.0 / smallest.sqrt(),
        };
        seen.figures = [-self.nearest[a] / seen.wave_speed, seen.wave_speed, shock_ratio];
        Some(seen)
    }

    /// Wave speed on the reference configuration of each particle in m/s, for output.
    pub(super) fn wave_speed(&self, a: usize, at: &Columns<'_, D>) -> f64 {
        self.look_at(a, at).map_or(0.0, |seen| seen.wave_speed)
    }
}

/// What bounds steps, whatever the state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    settings: Settings,
    largest_exchange: f64,
    fastest_reference: f64,
}

impl Bounds {
    /// The limits of a state, of what [`Upwind::look_at`] has found most of.
    pub fn write(&self, [crossing, fastest, shock]: [Most; 3], limits: &mut Vec<StepLimit>) {
        limits.clear();
        limits.push(StepLimit::scaled("acoustic", -crossing.value, crossing.particle));
        let settings = &self.settings;
        let exchange = self.largest_exchange * shock.value;
        let velocity_rate = settings.tau_velocity * exchange * self.fastest_reference;
        // The pressure exchange is the velocity's times (c/c0)^2: it sees the current stiffness.
        let pressure_rate = settings.tau_pressure
            * self.largest_exchange
            * fastest.value
            * (fastest.value / self.fastest_reference);
        let rate = velocity_rate.max(pressure_rate);
        if rate > 0.0 {
            let limit = StepLimit::scaled("upwind dissipation", 1.0 / rate, fastest.particle);
            limits.push(StepLimit { scaled: false, ..limit });
        }
    }
}

/// Figures of nothing.
pub(super) const LEAST: [f64; 3] = [f64::NEG_INFINITY, 0.0, 1.0];
