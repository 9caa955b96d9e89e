//! Steps of a run that are several of the fluid, and the work that fluid and solids tell of each other.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use piola::case::{self, Case, Finished, LoadOptions, Session};
use piola::time::{Failure, Outcome};

use crate::structures::{DRIFTING, momentum_of};

fn read(text: &str, set: &[&str]) -> Case {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    case::parse(text, "case.toml", &options).unwrap_or_else(|problems| panic!("{problems}"))
}

fn session(case: &Case) -> Session {
    Session::new(case).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The slab of `cases/coupled/slab`, soft and ten times as dense as the water, at small amplitude and without what is of
/// first order in the fluid alone: its drift takes rates where particles begin, and diffusion is an Euler step.
fn slab(set: &[&str]) -> Session {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/coupled/slab/case.toml");
    let common = [
        "parameters.n=8",
        "parameters.g=0",
        "parameters.kick=1e-6",
        "scheme.shifting='none'",
        "scheme.pressure_diffusion=0",
        "system.slab.scheme={ kind = 'dual_support' }",
        "body.slab.material={ kind = 'linear_elastic', density = 10.0, young_modulus = 250.0, poisson_ratio = 0.0 }",
        "time.end=0.2",
        "output.every=0.2",
        "output.table_every=0.2",
    ];
    let overrides = [&common, set].concat().iter().map(|text| (*text).to_owned()).collect();
    let case = case::load(&path, &LoadOptions { overrides, ..LoadOptions::default() });
    session(&case.unwrap_or_else(|problems| panic!("{problems}")))
}

fn finish(session: Session) -> Finished {
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs");
    assert_eq!(finished.summary.outcome.summary(), "completed");
    finished
}

/// Runs of 16, 32 and 64 steps, each of them one of the slab and four of the water. CFL numbers of both are halved, so
/// that neither limit changes how many fit.
fn several() -> [Finished; 3] {
    const COUNT: f64 = 4.0;
    let limits = slab(&["time.step=1e-3", "system.slab.time={ cfl = 0.5 }"]).plan().limits;
    let limit = |name: &str| limits.iter().find(|limit| limit.name == name).expect(name).step;
    let (water, solid) = (limit("acoustic"), limit("most steps of a solid") / 1000.0 / 0.5);
    // A little longer than a 16th of the run, which is cut into equal steps; the slab may go half a step of the
    // water further.
    let step = 0.2 / 15.9;
    let [water, solid] = [step / COUNT / water, step * (1.0 + 0.5 / COUNT) / solid];
    assert!(water < 0.3 && solid < 0.9, "stable steps: {water} {solid}");
    [1.0, 0.5, 0.25].map(|share| {
        let water = format!("time.cfl={}", water * share);
        let solid = format!("system.slab.time={{ cfl = {} }}", solid * share);
        let mut session = slab(&[&water, &solid]);
        let systems = session.scheme().parts().into_iter();
        let counts: Vec<u64> = systems.map(|(it, _)| it.particle_count() as u64).collect();
        let finished = finish(session);
        let steps = (16.0 / share) as u64;
        assert_eq!(finished.summary.evaluations, steps * (4 * counts[0] + counts[1]));
        let expected = [("fluid".to_owned(), 4 * steps), ("slab".to_owned(), steps)];
        assert_eq!((finished.summary.steps, finished.own_steps.as_slice()), (steps, &expected[..]));
        finished
    })
}

/// Runs of steps that are one of the water and one of the slab.
fn single() -> [Finished; 3] {
    [2e-3, 1e-3, 5e-4].map(|step| {
        let step = format!("time.step={step}");
        finish(slab(&[&step, "system.slab.time={ cfl = 0.9 }"]))
    })
}

fn last(finished: &Finished, column: &str) -> f64 {
    let tables = &finished.tables;
    let values = tables.probes.values(column).or_else(|| tables.energy.values(column));
    *values.expect(column).last().expect("there are rows")
}

/// The impulse that the solid gets is the trapezoid over the steps of the fluid, and the walls in between are where a
/// solid of that acceleration is: what a step leaves out is of third order. Halving a step of second order takes three
/// quarters of what it changes.
#[test]
fn steps_of_several_of_the_fluid_are_of_second_order() {
    let [long, middle, short] = several().map(|run| last(&run, "slab.displacement.y"));
    let order = ((long - middle) / (middle - short)).abs().log2();
    assert!((order - 2.0).abs() < 0.1, "order {order}");
}

/// The work of the slab on the water is made of forces at the times of the water and velocities of its walls, that of
/// the water on the slab of what its kicks do to kinetic energy. What one loses the other gains, but for the second order
/// of the step: the sum goes down to a quarter with half the step.
#[test]
fn work_of_both_sides_of_an_interface_is_the_same_to_second_order() {
    for runs in [single(), several()] {
        let works = runs.map(|run| [last(&run, "interface"), last(&run, "slab.interface")]);
        let [long, middle, short] = works.map(|[water, slab]| water + slab);
        for (longer, shorter) in [(long, middle), (middle, short)] {
            let order = (longer / shorter).log2();
            assert!((order - 2.0).abs() < 0.25, "order {order}: {works:?}");
        }
        // The sum of what is not there would be small as well.
        assert!(works[2].iter().all(|work| work.abs() > 10.0 * short.abs()), "{works:?}");
    }
}

/// The soft block of [`DRIFTING`], ten times as heavy, without tables that steps would have to meet.
fn heavy(set: &[&str]) -> Session {
    let light = "density = 3.0";
    assert!(DRIFTING.contains(light));
    let rarely = ["output.every=0.1", "output.table_every=0.1"];
    let text = DRIFTING.replace(light, "density = 30.0");
    session(&read(&text, &[&rarely, set].concat()))
}

/// What the fluid loses in its steps the solid gets in the one that is theirs.
#[test]
fn several_steps_of_the_fluid_keep_momentum() {
    let mut session = heavy(&[]);
    let start = momentum_of(&mut session);
    session.run_until(0.1).expect("it runs");
    let end = momentum_of(&mut session);
    let finished = session.finish().expect("it ends");
    let [fluid, block] = [0, 1].map(|number: usize| finished.own_steps[number].1);
    assert!(fluid >= 2 * block && block == finished.summary.steps, "{fluid} {block}");
    for axis in 0..2 {
        let [before, after] = [start, end].map(|all| all[0][axis] + all[1][axis]);
        assert!((after - before).abs() < 1e-12, "{axis}: {before} {after}");
    }
    let handed_over = end[1][0] - start[1][0];
    assert!(handed_over > 0.01, "the water pushes the block along: {handed_over}");
}

/// How many steps of the fluid are one of the run follows from the state alone: a run that is resumed takes the
/// same, and so does one on another number of threads.
#[test]
fn several_steps_of_the_fluid_are_the_same_resumed_and_on_any_threads() {
    let fine = ["body.water.spacing=0.025", "body.block.spacing=0.02"];
    let bits = |threads: usize, broken: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads start").install(|| {
            let mut run = heavy(&fine);
            run.run_until(0.01).expect("it runs");
            if broken {
                let checkpoint = run.checkpoint();
                run = heavy(&fine);
                run.resume(checkpoint).expect("it fits");
            }
            run.run_until(0.02).expect("it runs");
            let mut all = Vec::new();
            for field in ["position", "velocity", "pressure"] {
                all.extend(run.column(field).expect(field).values.iter().map(|it| it.to_bits()));
            }
            let finished = run.finish().expect("it ends");
            (all, finished.own_steps)
        })
    };
    let whole = bits(1, false);
    assert!(whole.1[0].1 >= 2 * whole.1[1].1, "{:?}", whole.1);
    assert!(whole == bits(2, false), "on two threads");
    assert!(whole == bits(2, true), "resumed");
}

/// A stiffer block, and steps that are too long for it.
const TOO_LONG: [&str; 4] = [
    "body.block.material={ kind = 'neo_hookean_logarithmic', density = 30.0, young_modulus = 3000.0, poisson_ratio = 0.3 }",
    "time.cfl=0.1",
    "system.block.time={ cfl = 1.7 }",
    "time.end=0.2",
];

/// What is said of a run that has failed is found by taking its last steps once more, with as many steps of each system
/// in them as they had: the particle ends with the speed that has stopped the run.
#[test]
fn the_trace_of_several_steps_is_what_happened() {
    let finished = heavy(&TOO_LONG).run(&AtomicBool::new(false), &mut |_| {}).expect("it is told");
    let Outcome::Failed(Failure::TooFast { speed, .. }) = &finished.summary.outcome else {
        panic!("{:?}", finished.summary.outcome)
    };
    let [fluid, block] = [0, 1].map(|number: usize| finished.own_steps[number].1);
    assert!(fluid >= 3 * block, "{fluid} {block}");
    let trace = finished.summary.trace.as_ref().expect("steps were taken");
    let place = |name: &str| trace.columns.iter().position(|it| it.0 == name).expect(name);
    let [x, y, is_bad] = ["velocity.x", "velocity.y", "is_bad"].map(place);
    let mut rows = trace.numbers.chunks_exact(trace.columns.len());
    let last = rows.rfind(|row| row[is_bad] == 1.0).expect("the particle is in it");
    assert_eq!((last[x] * last[x] + last[y] * last[y]).sqrt(), *speed);
}

/// With retries the run goes back and takes shorter steps, several of the fluid in each as before. Nothing of momentum is
/// lost on the way, and a run that is resumed behind it ends the same, whether or not somebody asks for its plan.
#[test]
fn a_run_that_goes_back_keeps_several_steps_of_the_fluid() {
    let set = [&TOO_LONG[..], &["time.on_failure='retry'"]].concat();
    let end = |mut run: Session| {
        run.run_until(0.2).expect("it runs");
        let momentum = momentum_of(&mut run);
        let values = run.column("position").expect("it is there").values;
        let bits: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        (momentum, bits, run.finish().expect("it ends"))
    };
    let mut whole = heavy(&set);
    let start = momentum_of(&mut whole);
    // Where it is interrupted it has gone back already.
    whole.run_until(0.1).expect("it runs");
    let mut resumed = heavy(&set);
    resumed.resume(whole.checkpoint()).expect("it fits");
    whole.plan();
    let [(momentum, bits, finished), (_, resumed_bits, _)] = [whole, resumed].map(end);
    let retries = &finished.summary.retries;
    assert!(retries.first().is_some_and(|retry| retry.time < 0.1), "{retries:?}");
    let [fluid, block] = [0, 1].map(|number: usize| finished.own_steps[number].1);
    assert!(fluid >= 3 * block, "{fluid} {block}");
    for axis in 0..2 {
        let [before, after] = [&start, &momentum].map(|all| all[0][axis] + all[1][axis]);
        assert!((after - before).abs() < 1e-12, "{axis}: {before} {after}");
    }
    assert!(bits == resumed_bits);
}

/// A gel on water in a box that is periodic along x, its rows and columns of particles shaken against each other.
const GEL: &str = r#"
version = 1
title = "Gel on water"
dimension = 2
[domain]
periodic = { x = [0.0, 0.5] }
[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [0.5, 0.3] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 100.0 }
[[body]]
name = "floor"
shape = { kind = "box", min = [0.0, -0.2], max = [0.5, 0.0] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 100.0 }
wall = { slip = "free" }
[[body]]
name = "gel"
system = "gel"
shape = { kind = "box", min = [0.0, 0.3], max = [0.5, 0.6] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "neo_hookean_logarithmic", density = 1100.0, young_modulus = 2e4, poisson_ratio = 0.3 }
initial = { velocity = ["0", "0.01 * sin(pi * x / 0.05) * sin(pi * y / 0.05) + 0.01 * sin(4 * pi * x)"] }
[scheme]
kind = "transport_velocity"
[[system]]
name = "gel"
scheme = { kind = "total_lagrangian" }
slip = "free"
[time]
end = 1.0
[output]
every = 1.0
table_every = 0.1
"#;

/// The bound by the waves of the fluid that stop a layer of the solid is what keeps light solids stable: a gel as dense as
/// water takes four steps of the water at once, not the sixteen that its own waves would allow. What is unstable grows
/// from step to step, which two thousand of them would show. Nothing drives it, so that the energy stays below that of the
/// start, but for the square of the phase of the fastest waves in a step of the water, 0.06.
#[test]
fn a_light_gel_is_stable_in_several_steps_of_the_water() {
    let finished = finish(session(&read(GEL, &[])));
    let [water, gel] = [0, 1].map(|number: usize| finished.own_steps[number].1 as f64);
    assert!(water / gel > 3.5 && water / gel <= 5.0, "{water} {gel}");
    assert!(finished.summary.steps > 1500, "{}", finished.summary.steps);
    let energy = finished.tables.energy.values("total").expect("there are energies");
    let most = energy.iter().fold(0.0, |most: f64, value| most.max(*value));
    assert!(energy[0] > 0.0 && most <= 1.06 * energy[0], "{energy:?}");
}

/// Contact is as stiff as a step of the water allows: a gel under a lid that it may touch takes none that are longer. Points
/// see each other within a spacing along the surface and one and a half across.
#[test]
fn solids_that_may_touch_take_steps_of_the_water() {
    let steps = |gap: f64| {
        let (low, high) = (0.6 + gap, 0.8 + gap);
        let lid = format!(
            "\n[[body]]\nname = 'lid'\nshape = {{ kind = 'box', min = [0.0, {low}], max = [0.5, {high}] }}\n\
             spacing = 0.05\nlattice = {{ on = 'cells' }}\nwall = {{ slip = 'free' }}\n\
             material = {{ kind = 'weakly_compressible', density = 1000.0, wave_speed = 100.0 }}\n[scheme]\n"
        );
        let plan = session(&read(&GEL.replacen("[scheme]\n", &lid, 1), &[])).plan();
        plan.own_steps.iter().map(|(_, count)| *count).collect::<Vec<u64>>()
    };
    assert_eq!(steps(0.05), [1, 1]);
    assert_eq!(steps(0.15), [4, 1]);
}
