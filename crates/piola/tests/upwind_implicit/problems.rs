//! Bodies that several of these tests step through time.

use piola::Vector;
use piola::operators::Correction;
use piola::schemes::upwind::{ImplicitSettings, Settings, Upwind, WaveSpeed};
use piola::schemes::{Scheme, Theta, ThetaScheme};
use piola_formulas::volumetric::VolumetricLaw;

use crate::support::{Choice, jittered, lattice};

pub fn gamma() -> VolumetricLaw {
    VolumetricLaw::gamma_law_from_wave_speed(10.0, 1000.0, 7.0).expect("a sound material")
}

pub fn linear(modulus: f64) -> VolumetricLaw {
    VolumetricLaw::linear(modulus).expect("a sound material")
}

/// Every term of the formulation.
pub const EVERYTHING: Settings = Settings {
    correction: Correction::Gradient,
    tau_velocity: 0.7,
    tau_pressure: 0.4,
    reconstruction: true,
    wave_speed: WaveSpeed::Stretch,
};

/// Every term that leaves the volume ratios to follow from the velocities.
pub const ALL_BUT_PRESSURE: Settings = Settings { tau_pressure: 0.0, ..EVERYTHING };

/// A choice for implicit steps.
pub fn implicit<const D: usize>(mut choice: Choice<D>, settings: Settings) -> Choice<D> {
    choice.settings = settings;
    choice.implicit = Some(ImplicitSettings::default());
    choice
}

/// A bar, a plate and a block without order, under gravity, held at one end.
pub fn bar() -> Choice<1> {
    held(Choice::new(jittered([10.0], [20], 0.2), gamma()))
}

pub fn plate() -> Choice<2> {
    held(Choice::new(jittered([1.0, 2.0], [5, 9], 0.15), gamma()))
}

pub fn block() -> Choice<3> {
    held(Choice::new(jittered([1.0, 1.0, 1.5], [3, 3, 4], 0.1), gamma()))
}

fn held<const D: usize>(mut choice: Choice<D>) -> Choice<D> {
    choice.smoothing_ratio = 1.2;
    choice.gravity = Vector::from_element(-9.81);
    choice.fix(0, |x| x[0] < 0.1)
}

/// A column between walls on a floor that starts with a velocity, along which all is one-dimensional.
pub fn column(law: VolumetricLaw) -> Upwind<2> {
    let choice = implicit(Choice::new(lattice([2.0, 5.0], [4, 10]), law), crate::support::PLAIN);
    choice
        .fix(0, |x| x[0] < 1e-9 || x[0] > 2.0 - 1e-9)
        .fix(1, |x| x[1] < 1e-9)
        .build(|x| Vector::<2>::new(0.0, 0.4 * (0.3 * x[1]).sin()))
}

/// Takes steps of `rule` from the start and shows each.
pub fn walk<S: ThetaScheme>(
    scheme: &mut S,
    rule: &Theta,
    step: f64,
    steps: usize,
    mut show: impl FnMut(&S, &[f64]),
) -> Vec<f64> {
    let mut state = scheme.initial_state();
    scheme.constrain(0.0, &mut state);
    let mut new = state.clone();
    for count in 0..steps {
        scheme
            .advance(rule, count as f64 * step, step, &state, &mut new)
            .unwrap_or_else(|error| panic!("step {count}: {error}"));
        std::mem::swap(&mut state, &mut new);
        show(scheme, &state);
    }
    state
}

/// The largest difference between rows of two states, over the largest number of the first.
pub fn difference<S: Scheme>(scheme: &S, a: &[f64], b: &[f64]) -> f64 {
    let rows = scheme.particle_count() * scheme.width();
    let largest = a[..rows].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    a[..rows].iter().zip(&b[..rows]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
}
