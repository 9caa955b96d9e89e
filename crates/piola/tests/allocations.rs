//! Steps after the first allocate nothing, whatever is switched on.

mod support;

use std::path::Path;

use piola::Vector;
use piola::case::{self, LoadOptions};
use piola::schemes::Scheme;
use piola::schemes::upwind::{Settings, WaveSpeed};
use piola::time::{Integrator, IntegratorKind};
use piola_formulas::volumetric::VolumetricLaw;
use support::{Choice, PLAIN, jittered};

/// Allocations of two steps, each with the look at its state that the executor takes, after a
/// first one.
fn allocations(scheme: &mut dyn Scheme, integrator: &mut dyn Integrator) -> u64 {
    let state = scheme.initial_state();
    let mut new = state.clone();
    let mut limits = Vec::new();
    let mut step = |count: usize| {
        scheme.inspect(&state, &mut limits);
        integrator
            .step(scheme, 1e-6 * count as f64, 1e-6, &state, &mut new)
            .expect("explicit methods always find a state");
    };
    step(0);
    allocation_counter::measure(|| (1..=2).for_each(&mut step)).count_total
}

fn check<const D: usize>(lengths: [f64; D], intervals: [usize; D], settings: Settings) {
    let law = VolumetricLaw::gamma_law_from_wave_speed(10.0, 1000.0, 7.0).expect("a sound law");
    let particles = jittered(lengths, intervals, 0.1);
    // More than one chunk, so that the loops are the parallel ones.
    assert!(particles.len() > piola::parallel::CHUNK);
    let mut choice = Choice::new(particles, law);
    choice.smoothing_ratio = 1.2;
    choice.settings = settings;
    let mut scheme = choice.build(|_| Vector::zeros());
    let mut integrator = IntegratorKind::TvdRk2.build(&mut scheme).expect("it has rates");
    let count = allocations(&mut scheme, &mut *integrator);
    assert_eq!(count, 0, "{D}D {settings:?}");
}

/// On a pool of one thread, which is the one that counts: with several, the queues of the pool
/// grow now and then, which is no matter of the scheme.
#[test]
fn steps_after_the_first_allocate_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    pool.install(|| {
        let control = allocation_counter::measure(|| drop(std::hint::black_box(vec![0_u8; 100])));
        assert_eq!(control.count_total, 1, "allocations of the pool's thread are counted");
        for [tau_velocity, tau_pressure] in [[0.0, 0.0], [0.7, 0.0], [0.0, 0.4], [0.7, 0.4]] {
            for reconstruction in [false, true] {
                for wave_speed in [WaveSpeed::Constant, WaveSpeed::Stretch] {
                    let settings = Settings {
                        tau_velocity,
                        tau_pressure,
                        reconstruction,
                        wave_speed,
                        ..PLAIN
                    };
                    check([10.0], [1100], settings);
                    check([1.0, 1.0], [33, 33], settings);
                    check([1.0, 1.0, 1.0], [10, 10, 10], settings);
                }
            }
        }
    });
}

/// Allocations of a few steps of a case after the first ones, with the look at each state that the
/// executor takes.
fn of_case(name: &str, overrides: &[&str]) -> u64 {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    let overrides = overrides.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::load(&path.join("case.toml"), &options);
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let mut simulation = case::build(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let scheme = simulation.scheme();
    let count = scheme.particle_count();
    // Several chunks, so that the loops are the parallel ones.
    assert!(count > 3 * piola::parallel::CHUNK, "{name}: {count}");
    let kind = IntegratorKind::from_name(&case.time.integrator).expect("a known integrator");
    let mut state = scheme.initial_state();
    let mut integrator = kind.build(scheme).expect("it moves the scheme");
    let (mut new, mut limits) = (state.clone(), Vec::with_capacity(8));
    let mut time = 0.0;
    let mut step = || {
        scheme.inspect(&state, &mut limits);
        let stable = limits.iter().map(|limit| limit.step).fold(f64::INFINITY, f64::min);
        let step = 0.1 * stable;
        integrator.step(scheme, time, step, &state, &mut new).expect("explicit steps are found");
        std::mem::swap(&mut state, &mut new);
        time += step;
    };
    (0..3).for_each(|_| step());
    allocation_counter::measure(|| (0..5).for_each(|_| step())).count_total
}

/// Every scheme that takes explicit steps, at about 5000 particles.
#[test]
fn steps_of_all_schemes_allocate_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    let counts = pool.install(|| {
        [
            ("upwind/column-impact", &["parameters.n=70"][..]),
            ("ctvf/taylor-green", &["parameters.side=71"]),
            ("ctvf/dam-break", &["parameters.dx=0.025"]),
            ("ctvf/swinging-plate", &[]),
            ("ctvf/rings", &[]),
            ("dual-support/free-vibration", &["parameters.dx=0.2"]),
            ("elastodynamics/pulse", &["parameters.cells=5000"]),
            ("elastodynamics/wave-2d", &["parameters.dx=0.0004"]),
        ]
        .map(|(name, overrides)| (name, of_case(name, overrides)))
    });
    assert!(counts.iter().all(|(_, count)| *count == 0), "{counts:?}");
}
