//! The rates of density and pressure.

use multiversion::multiversion;
use piola_formulas::fluid;

use super::{DensityRule, Divergence, PressureRule, Side, TransportVelocity};
use crate::operators::{LANES, Lanes, Needs, Neighbor, NeighborBlock, all_of, total};
use crate::{Vector, parallel};

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

/// Constants of one pass.
struct Constants {
    softening: f64,
    diffusivity: f64,
}

/// Sums over neighbours, a lane each.
struct Sums {
    divergence: Lanes,
    density_transport: Lanes,
    pressure_transport: Lanes,
    pressure_diffusion: Lanes,
}

impl<const D: usize> TransportVelocity<D> {
    /// Fills `rates` from the sides, for the fluid at a time in s.
    pub(super) fn rate_pass(&mut self, time: f64) {
        if self.solids.is_some() {
            return self.solid_rate_pass();
        }
        let mut rates = std::mem::take(&mut self.rates);
        let h = self.support.smoothing_length();
        let corrections = self.settings.corrections;
        let constants = Constants {
            softening: fluid::softening(h),
            diffusivity: match self.settings.pressure {
                PressureRule::Edac { alpha } => {
                    fluid::pressure_diffusivity(alpha, h, self.fluid.wave_speed)
                }
                PressureRule::StateEquation => 0.0,
            },
        };
        let corrects = corrections.density || corrections.pressure;
        let moves = corrections.divergence == Divergence::Transport;
        let fill = match (corrects, moves, !self.body_forces.is_empty()) {
            (true, true, true) => fill::<D, true, true, true>,
            (true, true, false) => fill::<D, true, true, false>,
            (true, false, true) => fill::<D, true, false, true>,
            (true, false, false) => fill::<D, true, false, false>,
            (false, true, true) => fill::<D, false, true, true>,
            (false, true, false) => fill::<D, false, true, false>,
            (false, false, true) => fill::<D, false, false, true>,
            (false, false, false) => fill::<D, false, false, false>,
        };
        parallel::for_each_chunk(&mut rates, |first, rows| {
            fill(self, &constants, time, first, rows);
        });
        self.rates = rates;
    }

    /// Half of the body force g in m/s^2. Times the densities of two particles it is the gradient of
    /// the pressure between them in a fluid at rest, which must not diffuse out of a free surface.
    fn half_of_body_force(&self, place: usize, time: f64) -> Vector<D> {
        let number = self.support.list().numbers()[place] as usize;
        self.body_force_at(number, place, time) * 0.5
    }

    /// The sums of the particle at `place`, returned by value as those of the accelerations.
    #[inline(always)]
    fn gather_rates<const CORRECTS: bool, const MOVES: bool, const FALLS: bool>(
        &self,
        place: usize,
        constants: &Constants,
        half_force: &Vector<D>,
        block: &mut NeighborBlock<D>,
    ) -> Sums {
        let me = &self.sides[place];
        let zero = [0.0; LANES];
        let mut sums = Sums {
            divergence: zero,
            density_transport: zero,
            pressure_transport: zero,
            pressure_diffusion: zero,
        };
        let mut rest = self.support.all(place);
        while self.support.fill(&mut rest, Needs::Slope, block) {
            for group in block.groups() {
                let others = all_of(&self.sides, group.places);
                #[expect(clippy::needless_range_loop, reason = "a lane is the same in all arrays")]
                for lane in 0..LANES {
                    sums.add::<D, CORRECTS, MOVES, FALLS>(
                        lane,
                        me,
                        others[lane],
                        &group.neighbor(lane),
                        constants,
                        half_force,
                    );
                }
            }
        }
        sums
    }

    /// The rates of a particle with these sums.
    #[inline(never)]
    fn rates_of(&self, sums: &Sums) -> Rates {
        let corrections = self.settings.corrections;
        let evolves = self.settings.density != DensityRule::Summation;
        let kept = |is_on: bool, lanes| if is_on { total(lanes) } else { 0.0 };
        Rates {
            divergence: total(sums.divergence),
            density_transport: kept(corrections.density && evolves, sums.density_transport),
            pressure_transport: kept(corrections.pressure, sums.pressure_transport),
            pressure_diffusion: total(sums.pressure_diffusion),
        }
    }
}

impl Sums {
    /// Adds the terms of one neighbour to those of its lane. Always inlined, for the compiler to
    /// turn the loop over lanes into operations on vectors.
    #[inline(always)]
    fn add<const D: usize, const CORRECTS: bool, const MOVES: bool, const FALLS: bool>(
        &mut self,
        lane: usize,
        me: &Side<D>,
        other: &Side<D>,
        neighbor: &Neighbor<D>,
        constants: &Constants,
        half_force: &Vector<D>,
    ) {
        let slope = other.volume * neighbor.slope;
        let mut flow = me.velocity - other.velocity;
        if MOVES {
            flow += me.deviation - other.deviation;
        }
        self.divergence[lane] -= flow.dot(&neighbor.separation) * slope;
        let jump = other.pressure - me.pressure;
        if CORRECTS {
            let carried = other.deviation.dot(&neighbor.separation) * slope;
            self.density_transport[lane] += carried * (other.density - me.density);
            self.pressure_transport[lane] += carried * jump;
        }
        let densities = me.density + other.density;
        let scale = fluid::exchange_scale(densities, neighbor.square, constants.softening);
        let slope = other.mass() * neighbor.slope;
        let exchange = fluid::diffusion(constants.diffusivity, neighbor.square, slope, scale);
        let at_rest = if FALLS { half_force.dot(&neighbor.separation) * densities } else { 0.0 };
        let excess = jump + at_rest;
        self.pressure_diffusion[lane] -= exchange * excess;
    }
}

/// Fills some rows, with or without the transport terms, the deviation in the divergence, and body
/// forces.
#[multiversion(targets("x86_64+avx2"))]
fn fill<const D: usize, const CORRECTS: bool, const MOVES: bool, const FALLS: bool>(
    scheme: &TransportVelocity<D>,
    constants: &Constants,
    time: f64,
    first: usize,
    rows: &mut [Rates],
) {
    let mut block = NeighborBlock::default();
    for (offset, row) in rows.iter_mut().enumerate() {
        let place = first + offset;
        if !scheme.support.list().is_passive(place) {
            let half_force =
                if FALLS { scheme.half_of_body_force(place, time) } else { Vector::zeros() };
            let sums = scheme.gather_rates::<CORRECTS, MOVES, FALLS>(
                place,
                constants,
                &half_force,
                &mut block,
            );
            *row = scheme.rates_of(&sums);
        }
    }
}
