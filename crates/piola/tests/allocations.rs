//! Steps after the first allocate nothing, whatever is switched on.

mod support;

use piola::Vector;
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
    let mut integrator = IntegratorKind::TvdRk2.build(scheme.initial_state().len());
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
