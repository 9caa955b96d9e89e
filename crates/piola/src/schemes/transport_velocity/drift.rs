//! The rates of density and pressure.

use piola_formulas::fluid;

use super::{DensityRule, Divergence, PressureRule, Side, TransportVelocity};
use crate::operators::{Needs, NeighborBlock};
use crate::parallel;

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
        let mut rates = std::mem::take(&mut self.rates);
        let list = self.support.list();
        parallel::for_each_chunk(&mut rates, |first, rows| {
            let mut block = NeighborBlock::default();
            for (offset, row) in rows.iter_mut().enumerate() {
                let place = first + offset;
                if !list.is_passive(place) {
                    *row = self.rates_at(place, time, &mut block);
                }
            }
        });
        self.rates = rates;
    }

    #[inline]
    fn rates_at(&self, place: usize, time: f64, block: &mut NeighborBlock<D>) -> Rates {
        let me = &self.sides[place];
        let h = self.support.smoothing_length();
        let softening = fluid::softening(h);
        let diffusivity = match self.settings.pressure {
            PressureRule::Edac { alpha } => {
                fluid::pressure_diffusivity(alpha, h, self.fluid.wave_speed)
            }
            PressureRule::StateEquation => 0.0,
        };
        // A fluid at rest has the gradient rho g, which must not diffuse out of a free surface.
        let number = self.support.list().numbers()[place] as usize;
        let at_rest = self.body_force_at(number, place, time) * self.fluid.density;
        let moves = self.settings.corrections.divergence == Divergence::Transport;
        let corrections = self.settings.corrections;
        let corrects = corrections.density || corrections.pressure;
        let flow = |side: &Side<D>| match moves {
            true => side.velocity + side.deviation,
            false => side.velocity,
        };
        let mine = flow(me);
        let mut sum = Rates::default();
        let mut rest = self.support.all(place);
        while self.support.fill(&mut rest, Needs::Slope, block) {
            for neighbor in block.iter() {
                let other = &self.sides[neighbor.place];
                let gradient = neighbor.separation * neighbor.slope;
                sum.divergence -= other.volume * (mine - flow(other)).dot(&gradient);
                let jump = other.pressure - me.pressure;
                if corrects {
                    let carried = other.volume * other.deviation.dot(&gradient);
                    sum.density_transport += carried * (other.density - me.density);
                    sum.pressure_transport += carried * jump;
                }
                let scale =
                    fluid::exchange_scale(me.density + other.density, neighbor.square, softening);
                let exchange =
                    fluid::diffusion(diffusivity, neighbor.square, neighbor.slope, scale);
                let excess = jump + at_rest.dot(&neighbor.separation);
                sum.pressure_diffusion -= other.mass * exchange * excess;
            }
        }
        if !corrections.density || self.settings.density == DensityRule::Summation {
            sum.density_transport = 0.0;
        }
        if !corrections.pressure {
            sum.pressure_transport = 0.0;
        }
        sum
    }
}
