//! The rates of density and pressure.

use piola_formulas::fluid;
use piola_formulas::pairs::fluid::{RateConstants, RateSums, Rates as Law};

use super::{DensityRule, Divergence, TransportVelocity};
use crate::Vector;
use crate::operators::{Among, OfCenter, Term, gather};

/// Rates of change of a particle's density and pressure, term by term, see
/// [`super`](crate::schemes::transport_velocity).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rates {
    /// `div u` in 1/s, or `div uhat`, as the corrections say.
    pub divergence: f64,
    /// `d . grad rho` in kg/(m^3 s).
    pub density_transport: f64,
    /// `d . grad p` in Pa/s.
    pub pressure_transport: f64,
    /// Diffusion of the pressure in Pa/s.
    pub pressure_diffusion: f64,
}

impl<const D: usize> TransportVelocity<D> {
    /// Fills `rates` from the sides, for the fluid at a time in s.
    pub(super) fn rate_pass(&mut self, time: f64) {
        if self.solids.is_some() {
            return self.solid_rate_pass();
        }
        let mut rates = std::mem::take(&mut self.rates);
        let (constants, kind) = self.rate_law();
        let fill = match kind {
            (true, true, true) => Self::gather_rates::<true, true, true>,
            (true, true, false) => Self::gather_rates::<true, true, false>,
            (true, false, true) => Self::gather_rates::<true, false, true>,
            (true, false, false) => Self::gather_rates::<true, false, false>,
            (false, true, true) => Self::gather_rates::<false, true, true>,
            (false, true, false) => Self::gather_rates::<false, true, false>,
            (false, false, true) => Self::gather_rates::<false, false, true>,
            (false, false, false) => Self::gather_rates::<false, false, false>,
        };
        fill(self, constants, time, &mut rates);
        self.rates = rates;
    }

    /// The constants of the law of rates, and which one it is: whether the deviation carries them,
    /// whether the divergence is that of the transport velocity, whether there are body forces.
    pub(super) fn rate_law(&self) -> (RateConstants, (bool, bool, bool)) {
        let h = self.support.smoothing_length();
        let corrections = self.settings.corrections;
        let constants = RateConstants {
            softening: fluid::softening(h),
            diffusivity: self.settings.diffusivity(h, self.fluid.wave_speed),
        };
        let corrects = corrections.density || corrections.pressure;
        let moves = corrections.divergence == Divergence::Transport;
        (constants, (corrects, moves, !self.body_forces.is_empty()))
    }

    fn gather_rates<const CORRECTS: bool, const MOVES: bool, const FALLS: bool>(
        &self,
        constants: RateConstants,
        time: f64,
        rates: &mut [Rates],
    ) {
        let half_force = OfCenter(|place: usize| match FALLS {
            true => self.half_of_body_force(place, time),
            false => Vector::zeros(),
        });
        let law = Law::<D, CORRECTS, MOVES, FALLS>(constants);
        let sum = Term { law, source: (self.sides.as_slice(), half_force), among: Among::All };
        let corrections = self.settings.corrections;
        let evolves = self.settings.density != DensityRule::Summation;
        let close = |_: usize, sums: &RateSums<f64, D>, row: &mut Rates| {
            let kept = |is_on: bool, sum| if is_on { sum } else { 0.0 };
            *row = Rates {
                divergence: sums.divergence,
                density_transport: kept(corrections.density && evolves, sums.density_transport),
                pressure_transport: kept(corrections.pressure, sums.pressure_transport),
                pressure_diffusion: sums.pressure_diffusion,
            };
        };
        gather(&self.support, &sum, rates, |place| self.active(place), close);
    }

    /// Half of the body force g in m/s^2. Times the densities of two particles it is the gradient of
    /// the pressure between them in a fluid at rest, which must not diffuse out of a free surface.
    fn half_of_body_force(&self, place: usize, time: f64) -> Vector<D> {
        let number = self.support.list().numbers()[place] as usize;
        self.body_force_at(number, place, time) * 0.5
    }
}
