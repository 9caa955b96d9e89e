//! Velocity gradients of solids, and what the transport velocity carries.

use piola_formulas::fluid;
use piola_formulas::pairs::One;
use piola_formulas::pairs::solid::{
    ALONE, ANY, ELASTIC, RateConstants, RateSums, Rates as Law, is_carried,
};

use super::{Contact, MATTER, Solids, ZZ};
use crate::Tensor;
use crate::operators::{Among, Same, Source, Term, gather};
use crate::schemes::transport_velocity::{Divergence, Rates, TransportVelocity};

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

impl<const D: usize> TransportVelocity<D> {
    /// Fills the rates of solids from what has been loaded.
    pub(in super::super) fn solid_rate_pass(&mut self) {
        let Some(solids) = &mut self.solids else { return };
        let mut rates = std::mem::take(&mut solids.rates);
        let Some(solids) = self.solids.as_deref() else { return };
        let (h, corrections) = (self.support.smoothing_length(), self.settings.corrections);
        let constants = RateConstants {
            softening: fluid::softening(h),
            artificial: self.settings.artificial_viscosity * h,
            diffusion: self.settings.diffusivity(h, 1.0),
            moves: f64::from(u8::from(corrections.divergence == Divergence::Transport)),
        };
        let carries = corrections.density || corrections.pressure;
        let is_plain = solids.is_elastic() && self.settings.is_algebraic();
        let (own, out) = (&self.continua, rates.as_mut_slice());
        match (is_plain, own.are_several(), carries) {
            (true, false, false) => {
                self.rates_of_solids::<ALONE, false>(solids, constants, Same(1.0), out)
            }
            (true, false, true) => {
                self.rates_of_solids::<ALONE, true>(solids, constants, Same(1.0), out)
            }
            (true, true, false) => {
                self.rates_of_solids::<ELASTIC, false>(solids, constants, own, out)
            }
            (true, true, true) => {
                self.rates_of_solids::<ELASTIC, true>(solids, constants, own, out)
            }
            (false, _, false) => self.rates_of_solids::<ANY, false>(solids, constants, own, out),
            (false, _, true) => self.rates_of_solids::<ANY, true>(solids, constants, own, out),
        }
        if let Some(solids) = &mut self.solids {
            solids.rates = rates;
        }
    }

    fn rates_of_solids<const KIND: u8, const CARRIES: bool>(
        &self,
        solids: &Solids<D>,
        constants: RateConstants,
        own: impl Source<One>,
        rates: &mut [SolidRates<D>],
    ) {
        let one_if = |is_on: bool| f64::from(u8::from(is_on));
        let corrections = self.settings.corrections;
        let couples = one_if(solids.contact == Contact::Repulsive);
        let [density, pressure] = [corrections.density, corrections.pressure].map(one_if);
        let sides = (self.sides.as_slice(), solids.tensions.as_slice());
        let source = (sides, (solids.matter.as_slice(), own));
        let sum = Term { law: Law::<D, KIND, CARRIES>(constants), source, among: Among::All };
        let close = |place: usize, sums: &RateSums<f64, D>, row: &mut SolidRates<D>| {
            let gradient = match solids.corrections.get(place) {
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
        gather(&self.support, &sum, rates, |place| self.active(place), close);
    }
}
