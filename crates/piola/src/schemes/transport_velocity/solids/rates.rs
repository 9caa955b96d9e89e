//! Velocity gradients of solids, and what the transport velocity carries.

use multiversion::multiversion;
use piola_formulas::fluid;

use super::{Contact, MATTER, Matter, PLASTIC, Solids, Tension, XZ, YZ, ZZ};
use crate::operators::{LANES, Lanes, Needs, Neighbor, NeighborBlock, all_of, total};
use crate::schemes::transport_velocity::{
    Divergence, PressureRule, Rates, Side, TransportVelocity,
};
use crate::{Tensor, parallel};

/// Rates of a particle of a solid that are not in [`Rates`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidRates<const D: usize> {
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
        Self { gradient: Tensor::zeros(), transport: [0.0; MATTER], heating: 0.0 }
    }
}

/// What a loop is made for: one elastic body whose pressure follows its density,
const ALONE: u8 = 0;
/// several of them,
const ELASTIC: u8 = 1;
/// or any solids, with what flows, heats and diffuses.
const ANY: u8 = 2;

/// Whether a loop carries an entry of [`Matter`]: in 1D and 2D there is no shear across, what is
/// elastic carries nothing but its stress, and zz is what makes the trace of that zero.
const fn is_carried(dimension: usize, kind: u8, entry: usize) -> bool {
    match entry {
        PLASTIC.. => kind == ANY,
        ZZ => false,
        YZ | XZ => dimension == 3,
        _ => true,
    }
}

/// Constants of one pass.
struct Constants {
    softening: f64,
    /// `alpha h` of CTVF (28).
    artificial: f64,
    /// `alpha h / 8` of CTVF (24), to be multiplied by a wave speed.
    diffusion: f64,
    /// 1 where the approach of other bodies compresses.
    couples: f64,
    /// 1 where gradients are those of the transport velocity.
    moves: f64,
    /// 1 where the transport terms of density and pressure are on.
    density: f64,
    pressure: f64,
}

/// Sums over neighbours, a lane each.
struct Sums<const D: usize> {
    gradient: [[Lanes; D]; D],
    contact: Lanes,
    density: Lanes,
    pressure: Lanes,
    diffusion: Lanes,
    heating: Lanes,
    carried: [Lanes; MATTER],
}

/// A neighbour, as gradients see it.
struct Other<'a, const D: usize> {
    side: &'a Side<D>,
    matter: &'a Matter,
    wave_speed: f64,
    /// 1 if it belongs to the same body or to a wall, 0 otherwise.
    own: f64,
}

impl<const D: usize> TransportVelocity<D> {
    /// Fills the rates of solids from what has been loaded.
    pub(in super::super) fn solid_rate_pass(&mut self) {
        let Some(solids) = &mut self.solids else { return };
        let mut rates = std::mem::take(&mut solids.rates);
        let (couples, is_elastic) = (solids.contact, solids.is_elastic());
        let several = self.continua.are_several();
        let mut common = std::mem::take(&mut self.rates);
        let (h, corrections) = (self.support.smoothing_length(), self.settings.corrections);
        let one_if = |is_on: bool| f64::from(u8::from(is_on));
        let constants = Constants {
            softening: fluid::softening(h),
            artificial: self.settings.artificial_viscosity * h,
            diffusion: match self.settings.pressure {
                PressureRule::Edac { alpha } => fluid::pressure_diffusivity(alpha, h, 1.0),
                PressureRule::StateEquation => 0.0,
            },
            couples: one_if(couples == Contact::Repulsive),
            moves: one_if(corrections.divergence == Divergence::Transport),
            density: one_if(corrections.density),
            pressure: one_if(corrections.pressure),
        };
        let carries = corrections.density || corrections.pressure;
        let is_plain = is_elastic && self.settings.pressure == PressureRule::StateEquation;
        let fill = match (is_plain, several, carries) {
            (true, false, false) => fill::<D, ALONE, false>,
            (true, false, true) => fill::<D, ALONE, true>,
            (true, true, false) => fill::<D, ELASTIC, false>,
            (true, true, true) => fill::<D, ELASTIC, true>,
            (false, _, false) => fill::<D, ANY, false>,
            (false, _, true) => fill::<D, ANY, true>,
        };
        parallel::for_each_pair_of_chunks(&mut rates, &mut common, |first, rates, common| {
            fill(self, &constants, first, rates, common);
        });
        self.rates = common;
        if let Some(solids) = &mut self.solids {
            solids.rates = rates;
        }
    }

    /// The sums of the particle at `place`.
    #[inline(always)]
    fn gather_gradients<const KIND: u8, const CARRIES: bool>(
        &self,
        solids: &Solids<D>,
        place: usize,
        constants: &Constants,
        block: &mut NeighborBlock<D>,
    ) -> Sums<D> {
        let zero = [0.0; LANES];
        let mut sums = Sums {
            gradient: [[zero; D]; D],
            contact: zero,
            density: zero,
            pressure: zero,
            diffusion: zero,
            heating: zero,
            carried: [zero; MATTER],
        };
        let (me, matter) = (&self.sides[place], &solids.matter[place]);
        let speed = solids.tensions[place].wave_speed;
        let mut rest = self.support.all(place);
        while self.support.fill(&mut rest, Needs::Slope, block) {
            for group in block.groups() {
                let sides = all_of(&self.sides, group.places);
                let matters = all_of(&solids.matter, group.places);
                let tensions: [&Tension<D>; LANES] = all_of(&solids.tensions, group.places);
                let own = match KIND {
                    ALONE => [1.0; LANES],
                    _ => self.continua.own(place, group.places),
                };
                for lane in 0..LANES {
                    let other = Other {
                        side: sides[lane],
                        matter: matters[lane],
                        wave_speed: match KIND {
                            ANY => 0.5 * (speed + tensions[lane].wave_speed),
                            _ => 0.0,
                        },
                        own: own[lane],
                    };
                    let neighbor = group.neighbor(lane);
                    sums.add::<KIND, CARRIES>(lane, (me, matter), &other, &neighbor, constants);
                }
            }
        }
        sums
    }

    /// The rates of a particle with these sums.
    #[inline(never)]
    fn solid_rates_of<const KIND: u8, const CARRIES: bool>(
        &self,
        solids: &Solids<D>,
        place: usize,
        constants: &Constants,
        sums: &Sums<D>,
    ) -> (SolidRates<D>, Rates) {
        let raw = Tensor::<D>::from_fn(|i, j| total(sums.gradient[i][j]));
        let gradient = match solids.corrections.get(place) {
            Some(correction) => raw * correction,
            None => raw,
        };
        let mut transport = [0.0; MATTER];
        for (k, transport) in transport.iter_mut().enumerate() {
            if CARRIES && is_carried(D, KIND, k) {
                *transport = total(sums.carried[k]);
            }
        }
        transport[ZZ] = -transport[0] - transport[1];
        let rates = SolidRates {
            gradient,
            transport,
            heating: if KIND == ANY { total(sums.heating) } else { 0.0 },
        };
        let common = Rates {
            divergence: match KIND {
                ALONE => gradient.trace(),
                _ => gradient.trace() + constants.couples * total(sums.contact),
            },
            density_transport: constants.density * total(sums.density),
            pressure_transport: match KIND {
                ANY => constants.pressure * total(sums.pressure),
                _ => 0.0,
            },
            pressure_diffusion: if KIND == ANY { total(sums.diffusion) } else { 0.0 },
        };
        (rates, common)
    }
}

impl<const D: usize> Sums<D> {
    /// Adds the terms of one neighbour to those of its lane.
    #[inline(always)]
    fn add<const KIND: u8, const CARRIES: bool>(
        &mut self,
        lane: usize,
        (me, matter): (&Side<D>, &Matter),
        other: &Other<'_, D>,
        neighbor: &Neighbor<D>,
        constants: &Constants,
    ) {
        let side = other.side;
        let area = side.volume * neighbor.slope;
        let own = area * other.own;
        let jump = me.velocity - side.velocity;
        let flow = jump + (me.deviation - side.deviation) * constants.moves;
        for i in 0..D {
            for j in 0..D {
                self.gradient[i][j][lane] -= flow[i] * neighbor.separation[j] * own;
            }
        }
        let approach = jump.dot(&neighbor.separation);
        if KIND != ALONE {
            let opening = -flow.dot(&neighbor.separation) * (area - own);
            // Where forces are cut, (75), parting does nothing either: it would make energy.
            self.contact[lane] +=
                if me.load + side.load < 0.0 { opening.min(0.0) } else { opening };
        }
        if KIND == ANY {
            let densities = me.density + side.density;
            let scale = fluid::exchange_scale(densities, neighbor.square, constants.softening);
            let slope = side.mass() * neighbor.slope;
            let strength = constants.artificial * other.wave_speed;
            let artificial = fluid::artificial_viscosity(strength, approach, scale);
            self.heating[lane] += 0.5 * artificial * approach * slope;
            let diffusivity = constants.diffusion * other.wave_speed * other.own;
            let exchange = fluid::diffusion(1.0, neighbor.square, slope, scale) * diffusivity;
            self.diffusion[lane] -= exchange * (side.pressure - me.pressure);
        }
        if CARRIES {
            let carried = side.deviation.dot(&neighbor.separation) * own;
            self.density[lane] += carried * (side.density - me.density);
            if KIND == ANY {
                self.pressure[lane] += carried * (side.pressure - me.pressure);
            }
            for (k, sum) in self.carried.iter_mut().enumerate() {
                if is_carried(D, KIND, k) {
                    sum[lane] += carried * (other.matter[k] - matter[k]);
                }
            }
        }
    }
}

/// Fills some rows, with or without the transport terms.
#[multiversion(targets("x86_64+avx2"))]
fn fill<const D: usize, const KIND: u8, const CARRIES: bool>(
    scheme: &TransportVelocity<D>,
    constants: &Constants,
    first: usize,
    rates: &mut [SolidRates<D>],
    common: &mut [Rates],
) {
    let Some(solids) = scheme.solids.as_deref() else { return };
    let mut block = NeighborBlock::default();
    for (offset, (rates, common)) in rates.iter_mut().zip(common).enumerate() {
        let place = first + offset;
        if !scheme.support.list().is_passive(place) {
            let sums =
                scheme.gather_gradients::<KIND, CARRIES>(solids, place, constants, &mut block);
            (*rates, *common) =
                scheme.solid_rates_of::<KIND, CARRIES>(solids, place, constants, &sums);
        }
    }
}
