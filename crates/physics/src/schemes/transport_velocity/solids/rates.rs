//! Velocity gradients of solids, and what the transport velocity carries.

use piola_formulas::fluid;
use piola_formulas::pairs::One;
use piola_formulas::pairs::solid::{
    ALONE, ANY, ELASTIC, RateConstants, RateSums, Rates as Law, is_carried,
};

use super::{Common, Contact, Hypoelastic, MATTER, ZZ};
use crate::Tensor;
use crate::operators::{Among, Same, Source, Term, gather};
use crate::schemes::transport_velocity::{Divergence, Rates};

/// Rates of a particle of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidRates<const D: usize> {
    /// Those that a fluid has, too.
    pub common: Rates,
    /// Velocity gradient `d u_i / d x_j` in 1/s, CTVF (31), corrected or not; of uhat with
    /// [`Divergence::Transport`].
    pub gradient: Tensor<D>,
    /// What the deviation carries of deviatoric stress (xx, yy, zz, yz, xz, xy, in Pa/s), plastic
    /// strain, temperature and specific energy, a second each: `d . grad` of them, theory (68).
    pub transport: [f64; MATTER],
    /// Heat of the artificial viscosity in W/kg.
    pub heating: f64,
}

impl<const D: usize> Default for SolidRates<D> {
    fn default() -> Self {
        let (common, gradient) = (Rates::default(), Tensor::zeros());
        Self { common, gradient, transport: [0.0; MATTER], heating: 0.0 }
    }
}

impl<const D: usize> Hypoelastic<D> {
    /// Fills the rates of solids from what has been loaded.
    pub(super) fn rate_pass(&mut self, common: &Common<D>) {
        let mut rates = std::mem::take(&mut self.rates);
        let (h, corrections) = (common.support.smoothing_length(), common.settings.corrections);
        let constants = RateConstants {
            softening: fluid::softening(h),
            artificial: common.settings.artificial_viscosity * h,
            diffusion: common.settings.diffusivity(h, 1.0),
            moves: f64::from(u8::from(corrections.divergence == Divergence::Transport)),
        };
        let carries = corrections.density || corrections.pressure;
        let is_plain = self.is_elastic() && common.settings.is_algebraic();
        let (own, out) = (&common.continua, rates.as_mut_slice());
        match (is_plain, own.are_several(), carries) {
            (true, false, false) => {
                self.gather_rates::<ALONE, false>(common, constants, Same(1.0), out)
            }
            (true, false, true) => {
                self.gather_rates::<ALONE, true>(common, constants, Same(1.0), out)
            }
            (true, true, false) => self.gather_rates::<ELASTIC, false>(common, constants, own, out),
            (true, true, true) => self.gather_rates::<ELASTIC, true>(common, constants, own, out),
            (false, _, false) => self.gather_rates::<ANY, false>(common, constants, own, out),
            (false, _, true) => self.gather_rates::<ANY, true>(common, constants, own, out),
        }
        self.rates = rates;
    }

    fn gather_rates<const KIND: u8, const CARRIES: bool>(
        &self,
        common: &Common<D>,
        constants: RateConstants,
        own: impl Source<One>,
        rates: &mut [SolidRates<D>],
    ) {
        let one_if = |is_on: bool| f64::from(u8::from(is_on));
        let corrections = common.settings.corrections;
        let couples = one_if(self.contact == Contact::Repulsive);
        let [density, pressure] = [corrections.density, corrections.pressure].map(one_if);
        let sides = (common.sides.as_slice(), self.tensions.as_slice());
        let source = (sides, (self.matter.as_slice(), own));
        let sum = Term { law: Law::<D, KIND, CARRIES>(constants), source, among: Among::All };
        let close = |place: usize, sums: &RateSums<f64, D>, row: &mut SolidRates<D>| {
            let gradient = match self.corrections.get(place) {
                Some(correction) => sums.gradient * correction,
                None => sums.gradient,
            };
            let mut transport = sums.carried;
            for (k, transport) in transport.iter_mut().enumerate() {
                if !(CARRIES && is_carried(D, KIND, k)) {
                    *transport = 0.0;
                }
            }
            transport[ZZ] = -transport[0] - transport[1];
            let common = Rates {
                divergence: match KIND {
                    ALONE => gradient.trace(),
                    _ => gradient.trace() + couples * sums.contact,
                },
                density_transport: density * sums.density,
                pressure_transport: pressure * sums.pressure,
                pressure_diffusion: sums.diffusion,
            };
            *row = SolidRates { gradient, transport, heating: sums.heating, common };
        };
        gather(&common.support, &sum, rates, |place| common.active(place), close);
    }
}
