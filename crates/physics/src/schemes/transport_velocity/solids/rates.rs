//! Velocity gradients of solids, and what the transport velocity carries.

use nalgebra::SMatrix;
use piola_formulas::pairs::One;
use piola_formulas::pairs::solid::{ALONE, ANY, ELASTIC, RateConstants, RateSums, Rates as Law};
use piola_formulas::{Number, fluid};

use super::{Common, Contact, Hypoelastic, MATTER};
use crate::Tensor;
use crate::operators::{Among, Same, Source, Term, gather};
use crate::schemes::transport_velocity::{Divergence, Rates};

/// Rates of a particle of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidRates<const D: usize, T = f64> {
    /// Those that a fluid has, too.
    pub common: Rates<T>,
    /// Velocity gradient `d u_i / d x_j` in 1/s, CTVF (31), corrected or not; of uhat with
    /// [`Divergence::Transport`].
    pub gradient: SMatrix<T, D, D>,
    /// `d . grad rho` in kg/(m^3 s).
    pub density_transport: T,
    /// What the deviation carries of deviatoric stress (xx, yy, zz, yz, xz, xy, in Pa/s), plastic
    /// strain, temperature and specific energy, a second each: `d . grad` of them, theory (68).
    pub transport: [T; MATTER],
    /// Heat of the artificial viscosity in W/kg.
    pub heating: T,
}

impl<const D: usize> Default for SolidRates<D> {
    fn default() -> Self {
        let (common, gradient) = (Rates::default(), Tensor::zeros());
        let (density_transport, heating) = (0.0, 0.0);
        Self { common, gradient, density_transport, transport: [0.0; MATTER], heating }
    }
}

/// What of the sums of rates counts: each 1 or 0.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Counted {
    /// The divergence by other bodies.
    couples: f64,
    /// What the deviation carries of density and pressure.
    transport: f64,
}

impl<const D: usize, T: Number> SolidRates<D, T> {
    /// The rates of these sums, with the correction of gradients where they are corrected.
    #[inline]
    pub(in super::super) fn of<const KIND: u8, const CARRIES: bool>(
        sums: &RateSums<T, D>,
        correction: Option<&SMatrix<T, D, D>>,
        counted: &Counted,
    ) -> Self {
        let gradient = match correction {
            Some(correction) => sums.gradient * *correction,
            None => sums.gradient,
        };
        let common = Rates {
            divergence: match KIND {
                ALONE => gradient.trace(),
                _ => gradient.trace() + sums.contact * counted.couples,
            },
            pressure_transport: sums.pressure * counted.transport,
            pressure_diffusion: sums.diffusion,
        };
        let transport = Law::<D, KIND, CARRIES>::transport(sums);
        let density_transport = sums.density * counted.transport;
        Self { common, gradient, density_transport, transport, heating: sums.heating }
    }
}

impl<const D: usize> Hypoelastic<D> {
    /// The constants of the law of rates, what of its sums counts, and which law it is: for what solids, and whether the
    /// deviation carries anything.
    pub(in super::super) fn rate_law(
        &self,
        common: &Common<D>,
    ) -> (RateConstants, Counted, (u8, bool)) {
        let (h, corrections) = (common.support.smoothing_length(), common.settings.corrections);
        let one_if = |is_on: bool| f64::from(u8::from(is_on));
        let constants = RateConstants {
            softening: fluid::softening(h),
            artificial: common.settings.artificial_viscosity * h,
            diffusion: common.settings.diffusivity(h, 1.0),
            moves: one_if(corrections.divergence == Divergence::Transport),
        };
        let counted = Counted {
            couples: one_if(self.contact == Contact::Repulsive),
            transport: one_if(corrections.transport),
        };
        let is_plain = self.is_elastic() && common.settings.is_algebraic();
        let kind = match (is_plain, common.continua.are_several()) {
            (true, false) => ALONE,
            (true, true) => ELASTIC,
            (false, _) => ANY,
        };
        (constants, counted, (kind, corrections.transport))
    }

    /// Fills the rates of solids from what has been loaded.
    pub(super) fn rate_pass(&mut self, common: &Common<D>) {
        let mut rates = std::mem::take(&mut self.rates);
        let (constants, counted, kind) = self.rate_law(common);
        let law = (constants, counted);
        let (own, out) = (&common.continua, rates.as_mut_slice());
        match kind {
            (ALONE, false) => self.gather_rates::<ALONE, false>(common, law, Same(1.0), out),
            (ALONE, true) => self.gather_rates::<ALONE, true>(common, law, Same(1.0), out),
            (ELASTIC, false) => self.gather_rates::<ELASTIC, false>(common, law, own, out),
            (ELASTIC, true) => self.gather_rates::<ELASTIC, true>(common, law, own, out),
            (_, false) => self.gather_rates::<ANY, false>(common, law, own, out),
            (_, true) => self.gather_rates::<ANY, true>(common, law, own, out),
        }
        self.rates = rates;
    }

    fn gather_rates<const KIND: u8, const CARRIES: bool>(
        &self,
        common: &Common<D>,
        (constants, counted): (RateConstants, Counted),
        own: impl Source<One>,
        rates: &mut [SolidRates<D>],
    ) {
        let sides = (common.sides.as_slice(), self.tensions.as_slice());
        let source = (sides, (self.matter.as_slice(), own));
        let sum = Term { law: Law::<D, KIND, CARRIES>(constants), source, among: Among::All };
        let close = |place: usize, sums: &RateSums<f64, D>, row: &mut SolidRates<D>| {
            let correction = self.corrections.get(place);
            *row = SolidRates::of::<KIND, CARRIES>(sums, correction, &counted);
        };
        gather(&common.support, &sum, rates, |place| common.active(place), close);
    }
}
