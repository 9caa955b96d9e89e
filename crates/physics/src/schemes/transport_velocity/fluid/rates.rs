//! The rates of the pressure, which over `c^2` are those of the density.

use piola_formulas::fluid;
use piola_formulas::pairs::corrected::{CorrectedRateSums, CorrectedRates};
use piola_formulas::pairs::fluid::{FluidSide, RateConstants, RateSums, Rates as Law};
use piola_formulas::pairs::{Components, MovingPair, Of, PairLaw};

use super::{Common, Rates, WeaklyCompressible};
use crate::Vector;
use crate::operators::{Among, OfCenter, Term, gather};
use crate::schemes::transport_velocity::{Divergence, Side};

impl<const D: usize> WeaklyCompressible<D> {
    /// Fills `rates` from the sides, for the fluid at a time in s.
    pub(super) fn rate_pass(&mut self, common: &Common<D>, time: f64) {
        let mut rates = std::mem::take(&mut self.rates);
        let (constants, kind) = self.rate_law(common);
        let corrected = common.settings.corrects_gradients();
        let fill = match kind {
            (_, _, true) if corrected => Self::gather_corrected_rates::<true>,
            (_, _, false) if corrected => Self::gather_corrected_rates::<false>,
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
        let law = Law::<D, CORRECTS, MOVES, FALLS>(constants);
        fill_rates::<D, FALLS, _>(common, time, law, rates, |_, sums| *sums);
    }

    /// The same with corrected gradients, theory (109).
    fn gather_corrected_rates<const FALLS: bool>(
        &self,
        common: &Common<D>,
        constants: RateConstants,
        time: f64,
        rates: &mut [Rates],
    ) {
        let law = CorrectedRates::<D, FALLS>(constants);
        let of = |side: &Side<D>, sums: &CorrectedRateSums<_, D>| sums.rates(&side.deviation);
        fill_rates::<D, FALLS, _>(common, time, law, rates, of);
    }
}

/// Gathers the sums of a law, and fills `rates` with what `of` makes of them and of the side of a particle.
fn fill_rates<const D: usize, const FALLS: bool, L>(
    common: &Common<D>,
    time: f64,
    law: L,
    rates: &mut [Rates],
    of: impl Fn(&Side<D>, &Of<L::Sums, f64>) -> RateSums<f64, D> + Sync,
) where
    L: PairLaw<Pair = MovingPair<D>, Side = (FluidSide<D>, Components<D>)>,
{
    // Times the densities of two particles, half of the body force g in m/s^2 is the gradient of the pressure between them
    // in a fluid at rest, which must not diffuse out of a free surface.
    let half_force = OfCenter(|place: usize| match FALLS {
        true => {
            let number = common.support.list().numbers()[place] as usize;
            common.body_force_at(number, place, time) * 0.5
        }
        false => Vector::zeros(),
    });
    let sum = Term { law, source: (common.sides.as_slice(), half_force), among: Among::All };
    let close = |place: usize, sums: &Of<L::Sums, f64>, row: &mut Rates| {
        let RateSums { divergence, pressure_transport, pressure_diffusion } =
            of(&common.sides[place], sums);
        *row = Rates { divergence, pressure_transport, pressure_diffusion };
    };
    gather(&common.support, &sum, rates, |place| common.active(place), close);
}
