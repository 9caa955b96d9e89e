//! Steps after the first allocate nothing, whatever is switched on.

mod support;

use std::path::Path;

use piola::Vector;
use piola::case::{self, LoadOptions, Session};
use piola::observe::Series;
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
    assert!(particles.len() >= MANY);
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
                    check([10.0], [5100], settings);
                    check([1.0, 1.0], [71, 71], settings);
                    check([1.0, 1.0, 1.0], [17, 17, 17], settings);
                }
            }
        }
    });
}

/// Fewest particles of explicit steps.
const MANY: usize = 5000;

/// Fewest particles of others: more than one chunk, so that the loops are the parallel ones.
const SOME: usize = piola::parallel::CHUNK + 1;

/// A slab that is heavy and soft, for which one step is several of the water.
const SOFT: &str = "body.slab.material={ kind='linear_elastic', density='10 * rho', young_modulus='2.5 * rho * c^2', poisson_ratio=0 }";

/// A case at its start, which records nothing before its end.
fn session(name: &str, variant: Option<&str>, overrides: &[&str]) -> Session {
    let never = ["output.every=1e9", "output.table_every=1e9"];
    recording(name, variant, &[overrides, &never].concat())
}

/// A case at its start, which records what it asks for.
fn recording(name: &str, variant: Option<&str>, overrides: &[&str]) -> Session {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    let overrides = overrides.iter().map(|text| (*text).to_owned()).collect();
    let variant = variant.map(str::to_owned);
    let options = LoadOptions { overrides, variant, ..LoadOptions::default() };
    let case = case::load(&path.join("case.toml"), &options);
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Particles of a case, of which there are no fewer than `least`, and the allocations of each of some steps after the first
/// ones, with all that a run does between steps but for its output.
fn of_case(
    (name, overrides): (&str, &[&str]),
    least: usize,
    [before, measured]: [u32; 2],
) -> (u64, Vec<u64>) {
    let mut session = session(name, None, overrides);
    let count = session.scheme().particle_count();
    if overrides.contains(&SOFT) {
        assert!(session.plan().own_steps[0].1 > 1, "steps are several of the water");
    }
    assert!(count >= least, "{name}: {count}");
    let mut step = || assert!(session.step().expect("nothing is written"), "{name} goes on");
    (0..before).for_each(|_| step());
    let counts = (0..measured).map(|_| allocation_counter::measure(&mut step).count_total);
    (count as u64, counts.collect())
}

/// Looks at the allocations of each step of each case, on one thread, with its number of particles.
fn each(
    cases: &[(&str, &[&str])],
    least: usize,
    steps: [u32; 2],
    is_right: impl Fn(u64, &[u64]) -> bool + Sync,
) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    let wrong: Vec<String> = pool.install(|| {
        let count = |&(name, set): &(_, _)| (name, set, of_case((name, set), least, steps));
        let counts = cases.iter().map(count);
        let wrong = counts.filter(|(_, _, (particles, counts))| !is_right(*particles, counts));
        wrong.map(|(name, set, counts)| format!("{name} {set:?}: {counts:?}")).collect()
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every formulation with every integrator that takes explicit steps, with its options. Among the steps
/// is one with a mark to go back to.
///
/// What flows has a new neighbour list every few steps, in the arrays of the one before. A list may be longer than all before
/// it: then these grow, with some room to spare.
#[test]
fn explicit_steps_of_all_schemes_allocate_nothing() {
    let undamped = "scheme={ kind='upwind', smoothing_length=0.7 }";
    let cells = "parameters.n=72";
    let beam = "parameters.dx=0.2";
    let (fine, narrow) = ("parameters.n=100", "parameters.width='42 * dx'");
    let upwind = "system.slab.scheme={ kind='upwind', smoothing_length=0.7 }";
    let law = "body.slab.material={ kind='linear', density='rho', bulk_modulus='25 * rho * c^2' }";
    let hypoelastic = "system.slab.scheme={ kind='transport_velocity' }";
    let rates = "body.slab.material={ kind='hypoelastic', density='rho', young_modulus='25 * rho * c^2', poisson_ratio=0 }";
    let elastic = "system.slab.scheme={ kind='dual_support' }";
    let rings = [
        "parameters.dx=0.0009",
        "body.left.spacing='dx'",
        "body.left.shape={ kind='annulus', center=[-0.042, 0], inner=0.03, outer=0.04 }",
        "body.right.spacing='dx'",
        "body.right.shape={ kind='annulus', center=[0.042, 0], inner=0.03, outer=0.04 }",
    ];
    let gtvf =
        [&rings[..], &["scheme.shifting='background'", "scheme.corrections='gtvf'"]].concat();
    let flows: [(&str, &[&str]); 15] = [
        ("coupled/slab", &[fine, narrow]),
        ("coupled/slab", &[fine, narrow, upwind, law]),
        ("coupled/slab", &[fine, narrow, hypoelastic, rates]),
        ("coupled/slab", &[fine, narrow, elastic, SOFT]),
        ("ctvf/taylor-green", &["parameters.side=72"]),
        ("ctvf/taylor-green", &["parameters.side=72", "scheme.shifting='ipst'"]),
        ("ctvf/dam-break", &["parameters.dx=0.025"]),
        ("ctvf/cavity", &["parameters.side=66"]),
        ("ctvf/drop", &["parameters.dx=0.025"]),
        ("ctvf/jet", &["parameters.dx=0.004"]),
        ("ctvf/swinging-plate", &["parameters.across=24"]),
        ("ctvf/rings", &rings),
        ("ctvf/rings", &gtvf),
        ("ctvf/taylor-bar", &[]),
        ("ctvf/johnson-cook", &["parameters.dx=2e-6"]),
    ];
    let rest: [(&str, &[&str]); 9] = [
        ("upwind/column-impact", &[cells]),
        ("upwind/column-impact", &[cells, "time.integrator='ssp_rk3'"]),
        ("upwind/column-impact", &[cells, "time.on_failure='retry'"]),
        ("upwind/column-impact", &[cells, undamped, "time.integrator='kick_drift_kick'"]),
        ("dual-support/free-vibration", &[beam]),
        ("dual-support/free-vibration", &[beam, "time.integrator='tvd_rk2'"]),
        ("elastodynamics/pulse", &["parameters.cells=5000"]),
        ("elastodynamics/wave-2d", &["parameters.dx=0.0004"]),
        ("elastodynamics/wave-3d", &["parameters.dx=0.001"]),
    ];
    let is_none = |_, counts: &[u64]| counts.iter().all(|count| *count == 0);
    each(&rest, MANY, [3, 15], is_none);
    // Its finest mesh.
    each(&[("elastodynamics/hole", &[])], SOME, [3, 15], is_none);
    each(&flows, MANY, [3, 60], arrays_grow_once);
}

/// Whether no more is allocated than if each array of a neighbour list grows once: the rows of each chunk of particles, all
/// rows, and those inside the support with where they begin.
fn arrays_grow_once(particles: u64, counts: &[u64]) -> bool {
    counts.iter().sum::<u64>() <= particles.div_ceil(piola::parallel::CHUNK as u64) + 3
}

/// Particles of an inlet and an outlet have places in reserve.
#[test]
fn steps_in_which_particles_enter_and_leave_allocate_nothing() {
    let channel: [(&str, &[&str]); 1] = [("open/channel", &["parameters.across=52"])];
    each(&channel, MANY, [150, 150], |particles, counts| {
        let with_list = counts.iter().filter(|count| **count > 0).count();
        2 * with_list < counts.len() && counts.iter().all(|count| *count < particles)
    });
    // In as many steps particles enter and leave.
    let mut session = session(channel[0].0, None, channel[0].1);
    (0..300).for_each(|_| assert!(session.step().expect("nothing is written")));
    let finished = session.finish().expect("nothing is written");
    for name in ["step.entered", "step.left"] {
        let Some(Series::Curve { values, .. }) = finished.quantity(name) else { panic!("{name}") };
        assert!(values.last().is_some_and(|count| *count > 0.0), "{name}: {values:?}");
    }
}

/// Implicit and static steps make the vectors of Newton's method, of Krylov methods and of load steps anew
/// in each step: some an iteration, but none a particle.
#[test]
fn steps_that_solve_equations_allocate_nothing_a_particle() {
    let (column, pace) = ("parameters.n=35", "parameters.dt=0.02");
    let (beam, quarter) = ("parameters.dx=0.4", "time.step=0.125");
    let krylov = "time.linear_solver='krylov'";
    let newmark = "time={ end=0.25, integrator='newmark', step=0.001 }";
    let cases: [(&str, &[&str]); 9] = [
        ("upwind/stiff-column", &[column, pace]),
        ("upwind/stiff-column", &[column, pace, krylov]),
        ("upwind/stiff-column", &[column, pace, "time.integrator='crank_nicolson'"]),
        ("upwind/stiff-column", &[column, pace, "time.error=0.1"]),
        ("dual-support/free-vibration", &[beam, newmark]),
        ("dual-support/free-vibration", &[beam, newmark, krylov]),
        ("dual-support/tension", &[beam, quarter]),
        ("dual-support/tension", &[beam, quarter, krylov]),
        ("dual-support/arch", &[]),
    ];
    each(&cases, SOME, [3, 3], |particles, counts| counts.iter().all(|count| *count < particles));
}

/// Takes steps, and returns by how many bytes more is held after them.
fn grown(session: &mut Session, steps: u32) -> i64 {
    let mut run = || (0..steps).for_each(|_| assert!(session.step().expect("it goes on")));
    allocation_counter::measure(&mut run).bytes_current
}

/// What a run holds between its outputs does not grow with its steps: the four cases whose energy is checked over a
/// million steps, each for a tenth of that. The arrays of the neighbours of water are as long as they happen to be, and grow
/// until the lattice of the start has fallen into disorder.
#[test]
fn over_many_steps_memory_does_not_grow() {
    let held = |(name, most): (&str, i64)| {
        let mut session = session(name, Some("million"), &[]);
        grown(&mut session, 20_000);
        let grown = grown(&mut session, 80_000);
        assert!(grown <= most, "{name}: {grown} bytes more");
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    let cases = [
        ("upwind/piston", 0),
        ("dual-support/plate", 0),
        ("elastodynamics/wave-2d", 0),
        ("ctvf/still-water", 10_000),
    ];
    pool.install(|| cases.into_iter().for_each(held));
}

/// With its probes and tables, the memory of a run grows by their rows alone, for which there is room for twice as many at
/// most.
#[test]
fn over_many_steps_memory_grows_by_tables_alone() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    pool.install(|| {
        let mut session = recording("upwind/piston", Some("million"), &[]);
        grown(&mut session, 1000);
        let grown = grown(&mut session, 100_000);
        let tables = session.tables().lock().clone();
        assert!(tables.probes.len() > 200 && tables.probes.columns().len() > 1);
        let numbers: usize = tables.all().iter().map(|table| table.numbers().len()).sum();
        let room = (2 * numbers * size_of::<f64>()) as i64;
        assert!((1..=room).contains(&grown), "{grown} bytes more, {room} for rows");
    });
}
