//! The rates of the pressure, which over `c^2` are those of the density.

use piola_formulas::fluid;
use piola_formulas::pairs::fluid::{RateConstants, RateSums, Rates as Law};

use super::{Common, Rates, WeaklyCompressible};
use crate::Vector;
use crate::operators::{Among, OfCenter, Term, gather};
use crate::schemes::transport_velocity::Divergence;

impl<const D: usize> WeaklyCompressible<D> {
    /// Fills `rates` from the sides, for the fluid at a time in s.
    pub(super) fn rate_pass(&mut self, common: &Common<D>, time: f64) {
        let mut rates = std::mem::take(&mut self.rates);
        let (constants, kind) = self.rate_law(common);
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
        fill(self, common, constants, time, &mut rates);
        self.rates = rates;
    }

    /// The constants of the law of rates, and which one it is: whether the deviation carries it,
    /// whether the divergence is that of the transport velocity, whether there are body forces.
    pub(in super::super) fn rate_law(
        &self,
        common: &Common<D>,
    ) -> (RateConstants, (bool, bool, bool)) {
        let h = common.support.smoothing_length();
        let corrections = common.settings.corrections;
        let constants = RateConstants {
            softening: fluid::softening(h),
            diffusivity: common.settings.diffusivity(h, self.fluid.wave_speed),
        };
        let moves = corrections.divergence == Divergence::Transport;
        (constants, (corrections.transport, moves, !common.body_forces.is_empty()))
    }

    fn gather_rates<const CORRECTS: bool, const MOVES: bool, const FALLS: bool>(
        &self,
        common: &Common<D>,
        constants: RateConstants,
        time: f64,
        rates: &mut [Rates],
    ) {
        let half_force = OfCenter(|place: usize| match FALLS {
            true => half_of_body_force(common, place, time),
            false => Vector::zeros(),
        });
        let law = Law::<D, CORRECTS, MOVES, FALLS>(constants);
        let sum = Term { law, source: (common.sides.as_slice(), half_force), among: Among::All };
        let close = |_: usize, sums: &RateSums<f64, D>, row: &mut Rates| {
            *row = Rates {
                divergence: sums.divergence,
                pressure_transport: sums.pressure_transport,
                pressure_diffusion: sums.pressure_diffusion,
            };
        };
        gather(&common.support, &sum, rates, |place| common.active(place), close);
    }
}

/// Half of the body force g in m/s^2. Times the densities of two particles it is the gradient of
/// the pressure between them in a fluid at rest, which must not diffuse out of a free surface.
fn half_of_body_force<const D: usize>(common: &Common<D>, place: usize, time: f64) -> Vector<D> {
    let number = common.support.list().numbers()[place] as usize;
    common.body_force_at(number, place, time) * 0.5
}
