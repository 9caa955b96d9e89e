//! One look over a state: is it sound, and how large may the next step be.

use super::{Continuum, TransportVelocity};
use crate::schemes::look::{Most, Seen, look};
use crate::schemes::{Health, StepLimit};

/// The bounds on a step for a smoothing length in m and the largest viscosity of a compression in m^2/s, by the speed of
/// signals and the largest speed in m/s, and the squared acceleration.
pub(super) fn step_limits(
    h: f64,
    viscosity: f64,
    [signal, fastest, acceleration]: [Most; 3],
    limits: &mut Vec<StepLimit>,
) {
    limits.clear();
    limits.push(StepLimit::scaled("acoustic", h / signal.value, signal.particle));
    if viscosity > 0.0 {
        limits.push(StepLimit::scaled("viscous", h * h / viscosity, fastest.particle));
    }
    if acceleration.value > 0.0 {
        let step = (h / acceleration.value.sqrt()).sqrt();
        limits.push(StepLimit::scaled("acceleration", step, acceleration.particle));
    }
}

impl<const D: usize, M: Continuum<D>> TransportVelocity<D, M> {
    /// The health of `state` and the bounds on the step, CTVF (61) corrected, theory (34):
    ///
    /// - `acoustic`: `h / (c + |u|)` of the largest speed; of solids with the speed of longitudinal waves,
    ///   where the paper has that of bulk waves;
    /// - `viscous`: `h^2 / nu`, with `viscous_force = "stress"` a third of it, as a compression meets 3 nu; the
    ///   diffusion of velocities, theory (112), has a bound of `8 h / c` at least, above the acoustic one;
    /// - `acceleration`: `sqrt(h / |du/dt|)` of the largest acceleration, where the paper has
    ///   that of gravity;
    /// - `damping`: the inverse of the largest rate of damping.
    ///
    /// All are scaled by the CFL number, which the paper has as 0.25.
    pub(super) fn look(&mut self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        self.matter.follow(&mut self.common, state);
        if self.common.guard.is_some() {
            self.common.find_neighbors(state);
        }
        let mut health = self.bound_step(state, limits);
        let common = &self.common;
        if let Some((guard, _)) = &common.guard
            && !guard.removes
            && health.first_not_finite.is_none()
        {
            health.first_escaped = common.team().least(common.escaped(state).first().copied());
        }
        health
    }

    /// The same, without a look for particles that have escaped.
    fn bound_step(&self, state: &[f64], limits: &mut Vec<StepLimit>) -> Health {
        let common = &self.common;
        let (mut health, [signal, acceleration, damping]) =
            look(common.team(), common.count(), [0.0; 3], |row| self.look_at(row, state));
        let fastest = Most { value: health.largest_speed, particle: health.largest_speed_particle };
        let signal = match self.matter.wave_speed() {
            None => signal,
            Some(wave_speed) => {
                health.largest_wave_speed = wave_speed;
                Most { value: wave_speed + fastest.value, ..fastest }
            }
        };
        let h = common.support.smoothing_length();
        let viscosity = self.matter.viscosity() * common.settings.viscous.along();
        step_limits(h, viscosity, [signal, fastest, acceleration], limits);
        if damping.value > 0.0 {
            limits.push(StepLimit::scaled("damping", damping.value.recip(), damping.particle));
        }
        health
    }

    /// What a particle (row) contributes: the speed of signals, waves and what carries them, in m/s, its
    /// squared acceleration, and the rate of its damping in 1/s.
    #[inline]
    fn look_at(&self, row: usize, state: &[f64]) -> Option<Seen<D, 3>> {
        let common = &self.common;
        let at = common.columns(state);
        let vectors = [&at.position, &at.velocity, &at.deviation, &at.kick];
        let mut vectors = vectors.iter().flat_map(|column| column[row].iter());
        let scalars = [at.density[row], at.pressure[row]];
        if !vectors.all(|value| value.is_finite()) || !scalars.iter().all(|value| value.is_finite())
        {
            return None;
        }
        let (velocity, wave_speed) =
            (at.velocity[row], self.matter.wave_speed_of(common, row, state)?);
        let mut seen = Seen {
            velocity,
            wave_speed: 0.0,
            ratio: f64::INFINITY,
            mismatch: 0.0,
            figures: [0.0; 3],
        };
        let number = common.first() + row;
        if !common.is_wall[number] {
            // The inverse has the sign of the density, and is the volume ratio.
            seen.ratio = common.at_rest(number).density / at.density[row];
            seen.wave_speed = wave_speed;
            let damping = self.matter.damping_at(&at.position[row]);
            seen.figures = [wave_speed + velocity.norm(), at.kick[row].norm_squared(), damping];
        }
        Some(seen)
    }
}
