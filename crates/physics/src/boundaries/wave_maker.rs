//! Pistons that make waves, theory (93) and (94).

use std::f64::consts::TAU;
use std::sync::Arc;

use piola_formulas::waves::{
    Solitary, height_over_stroke, jonswap, ramp, second_harmonic, wave_number,
};
use rand::SeedableRng;
use rand_pcg::Pcg64;

use super::function::SpaceTime;
use crate::geometry::uniform;

/// Bounds of the frequencies of a spectrum over that of its peak: below the first there is nothing, above the second 1.5 % of the energy
/// of the spectrum of Pierson and Moskowitz, which goes to the others.
const BAND: [f64; 2] = [0.5, 3.0];

/// A part of the motion of a piston, `s sin(omega t + phase)` in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    /// s in m.
    pub amplitude: f64,
    /// omega in 1/s.
    pub frequency: f64,
    /// The phase at the start in rad.
    pub phase: f64,
}

/// The velocity over time with which a piston makes waves that go the way it pushes.
#[derive(Clone, Debug, PartialEq)]
pub enum WaveMaker {
    /// Harmonics that grow within the time of a ramp in s.
    Harmonics {
        /// All of them.
        all: Vec<Harmonic>,
        /// The time in s.
        ramp: f64,
    },
    /// A solitary wave whose crest is at the piston at a time in s.
    Solitary {
        /// The wave.
        wave: Solitary,
        /// The time.
        crest: f64,
    },
}

/// The water that waves are made on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Water {
    /// Its depth in m.
    pub depth: f64,
    /// Gravity in m/s^2.
    pub gravity: f64,
}

impl Water {
    /// `k d` for an angular frequency in 1/s.
    pub fn kd(&self, frequency: f64) -> f64 {
        wave_number(frequency, self.depth, self.gravity) * self.depth
    }
}

/// A sea of long crests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sea {
    /// Significant height Hs in m, four times the root of the variance of the surface.
    pub significant_height: f64,
    /// Period of the peak of the spectrum in s.
    pub peak_period: f64,
    /// By how much the spectrum of JONSWAP raises the peak; 1 for that of Pierson and Moskowitz.
    pub gamma: f64,
    /// Number of components.
    pub components: u32,
    /// Where their random frequencies and phases start.
    pub seed: u64,
}

impl Sea {
    /// The components of the surface with their amplitudes in m, of which `sum a^2 / 2 = Hs^2 / 16`: each has a share of the band, equally
    /// wide, and in it a frequency and a phase at random.
    pub fn surface(&self) -> Vec<Harmonic> {
        let (peak, count) = (1.0 / self.peak_period, f64::from(self.components));
        let width = (BAND[1] - BAND[0]) * peak / count;
        let mut source = Pcg64::seed_from_u64(self.seed);
        let mut component = |k: u32| {
            let place = f64::from(k) + uniform(&mut source);
            let frequency = BAND[0] * peak + width * place;
            let amplitude = jonswap(frequency, peak, self.gamma).sqrt();
            Harmonic { amplitude, frequency: TAU * frequency, phase: TAU * uniform(&mut source) }
        };
        let mut all: Vec<Harmonic> = (0..self.components).map(&mut component).collect();
        let squares: f64 = all.iter().map(|it| it.amplitude * it.amplitude).sum();
        let scale = self.significant_height / (8.0 * squares).sqrt();
        all.iter_mut().for_each(|it| it.amplitude *= scale);
        all
    }
}

impl WaveMaker {
    /// Whether its motion can be computed.
    pub fn is_finite(&self) -> bool {
        match self {
            Self::Harmonics { all, .. } => {
                all.iter().all(|it| it.amplitude.is_finite() && it.frequency.is_finite())
            }
            Self::Solitary { crest, .. } => crest.is_finite(),
        }
    }

    /// Regular waves of a height in m and a period in s that begin within a ramp in s: of second order, without free second
    /// harmonics.
    pub fn regular(height: f64, period: f64, water: Water, ramp: f64) -> Self {
        let frequency = TAU / period;
        let kd = water.kd(frequency);
        let first = 0.5 * height / height_over_stroke(kd);
        let second = second_harmonic(height, water.depth, kd);
        let harmonic = |amplitude, times: f64| Harmonic {
            amplitude,
            frequency: times * frequency,
            phase: 0.0,
        };
        Self::Harmonics { all: vec![harmonic(first, 1.0), harmonic(second, 2.0)], ramp }
    }

    /// The waves of a sea that begins within a ramp in s, each component by Biesel's stroke.
    pub fn sea(sea: &Sea, water: Water, ramp: f64) -> Self {
        let stroke = |wave: Harmonic| Harmonic {
            amplitude: wave.amplitude / height_over_stroke(water.kd(wave.frequency)),
            ..wave
        };
        Self::Harmonics { all: sea.surface().into_iter().map(stroke).collect(), ramp }
    }

    /// A solitary wave of a height in m. The piston begins where kappa c t is `-(3.8 + H/d)`, as Goring has it: the about 0.05 % of
    /// the stroke that lie before are left out.
    pub fn solitary(height: f64, water: Water) -> Self {
        let wave = Solitary { height, depth: water.depth, gravity: water.gravity };
        let crest = (3.8 + height / water.depth) / (wave.narrowness() * wave.speed());
        Self::Solitary { wave, crest }
    }

    /// Velocity in m/s and acceleration in m/s^2 at a time in s.
    fn motion(&self, time: f64) -> [f64; 2] {
        match self {
            Self::Harmonics { all, ramp: length } => {
                let [share, slope, bend] = ramp(time, *length);
                let mut sums = [0.0; 2];
                for Harmonic { amplitude, frequency, phase } in all {
                    let (sine, cosine) = (frequency * time + phase).sin_cos();
                    let (fast, faster) = (frequency * cosine, frequency * frequency * sine);
                    sums[0] += amplitude * (share * fast + slope * sine);
                    sums[1] += amplitude * (bend * sine + 2.0 * slope * fast - share * faster);
                }
                sums
            }
            Self::Solitary { wave, crest } => {
                let theta = wave.phase_at_piston(time - crest);
                let (eta, whole) = (wave.surface(theta), wave.depth);
                let velocity = wave.speed() * eta / (whole + eta);
                // d eta/dt = -2 eta tanh(theta) dtheta/dt, dtheta/dt = kappa (c - velocity).
                let turn = wave.narrowness() * (wave.speed() - velocity);
                let growth = -2.0 * eta * theta.tanh() * turn;
                [velocity, wave.speed() * whole / (whole + eta).powi(2) * growth]
            }
        }
    }
}

/// What of a wave maker's velocity is along an axis.
pub struct Push {
    /// The wave maker.
    pub maker: Arc<WaveMaker>,
    /// The component of its direction.
    pub share: f64,
}

impl SpaceTime for Push {
    fn value(&self, _x: [f64; 3], t: f64) -> f64 {
        self.share * self.maker.motion(t)[0]
    }

    fn rate(&self, _x: [f64; 3], t: f64) -> f64 {
        self.share * self.maker.motion(t)[1]
    }

    fn is_steady(&self) -> bool {
        false
    }

    fn is_uniform(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WATER: Water = Water { depth: 1.0, gravity: 9.81 };
    const SEA: Sea =
        Sea { significant_height: 0.2, peak_period: 2.0, gamma: 3.3, components: 100, seed: 7 };

    #[test]
    fn a_sea_has_the_variance_of_its_significant_height_and_its_peak() {
        for gamma in [1.0, 3.3] {
            let all = Sea { gamma, ..SEA }.surface();
            let variance: f64 = all.iter().map(|it| 0.5 * it.amplitude * it.amplitude).sum();
            assert!((variance / (0.04 / 16.0) - 1.0).abs() < 1e-14, "{variance}");
            let largest = all.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
            let ratio = largest.expect("components").frequency * 2.0 / TAU;
            assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
            assert!(all.windows(2).all(|pair| pair[0].frequency < pair[1].frequency));
        }
    }

    #[test]
    fn equal_seeds_make_equal_seas_and_others_do_not() {
        assert_eq!(SEA.surface(), SEA.surface());
        assert_ne!(SEA.surface(), Sea { seed: 8, ..SEA }.surface());
    }

    /// A period of 2 s on water of 1 m has kd = 1.2086 in linear theory.
    #[test]
    fn a_regular_wave_takes_the_stroke_of_biesel() {
        let kd = WATER.kd(TAU / 2.0);
        assert!((kd * kd.tanh() - (TAU / 2.0).powi(2) / 9.81).abs() < 1e-12);
        let WaveMaker::Harmonics { all, .. } = WaveMaker::regular(0.1, 2.0, WATER, 4.0) else {
            panic!("harmonics");
        };
        let ratio = 4.0 * kd.sinh().powi(2) / ((2.0 * kd).sinh() + 2.0 * kd);
        assert!((2.0 * all[0].amplitude * ratio - 0.1).abs() < 1e-14);
        assert_eq!(all[1].frequency, 2.0 * all[0].frequency);
    }

    #[test]
    fn pistons_begin_at_rest_and_rates_are_those_of_their_velocities() {
        let all = [
            WaveMaker::regular(0.1, 2.0, WATER, 4.0),
            WaveMaker::sea(&SEA, WATER, 4.0),
            WaveMaker::solitary(0.3, WATER),
        ];
        for maker in all {
            let start = maker.motion(0.0)[0];
            // A solitary wave is there from the start by 4 H e^(-7.6), and the piston goes with c/d of it.
            let most = (9.81_f64 * 1.3).sqrt() * 4.0 * 0.3 * (-7.6_f64).exp();
            assert!(start.abs() < most, "{start}");
            let push = Push { maker: Arc::new(maker), share: -0.6 };
            for time in [0.3, 1.7, 2.6, 5.5] {
                let value = |t: f64| push.value([0.0; 3], t);
                let rate = (value(time + 1e-5) - value(time - 1e-5)) / 2e-5;
                assert!((rate - push.rate([0.0; 3], time)).abs() < 1e-6, "at {time}");
            }
        }
    }

    /// Goring's piston moves by `2 H / (kappa d)` in all.
    #[test]
    fn the_stroke_of_a_solitary_wave_is_that_of_its_volume() {
        let maker = WaveMaker::solitary(0.3, WATER);
        let WaveMaker::Solitary { wave, crest } = &maker else { panic!("a solitary wave") };
        let step = 1e-3 * crest;
        let stroke: f64 =
            (0..2000).map(|k| step * maker.motion((f64::from(k) + 0.5) * step)[0]).sum();
        let whole = 2.0 * 0.3 / wave.narrowness();
        assert!((stroke / whole - 1.0).abs() < 2e-3, "{stroke} of {whole}");
    }
}
