//! Runs that several ranks share, compared with those of one.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use std::sync::mpsc;
use std::time::Duration;

use piola::case::{self, Finished, LoadOptions, Session};
use piola::observe::Series;
use piola::time::{Moment, ObserveError, Observer, Schedule};
use rayon::prelude::*;

use super::resume::{cases, on_ranks};

/// What a run leaves.
pub struct Left {
    pub finished: Finished,
    /// Its tables, and what its summary tells of the state.
    tables: String,
    /// Every column of its last state.
    columns: Vec<(String, Vec<u64>)>,
}

/// Runs a case.
fn run(text: &str, set: &[&str], ranks: usize, threads: usize) -> Left {
    let ranks = format!("compute.ranks={ranks}");
    let overrides = set.iter().copied().chain([ranks.as_str()]).map(str::to_owned).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(text, "shared.toml", &options);
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
        while session.step().unwrap() {}
        let finished = session.finish().unwrap();
        assert_eq!(
            finished.summary.outcome.summary(),
            "completed",
            "{:?}",
            finished.summary.outcome
        );
        let summary = &finished.summary;
        assert!(summary.steps > 9, "{} steps", summary.steps);
        let fields = session.scheme().description().fields;
        let columns = fields.iter().map(|field| {
            let values = session.column(field.name).unwrap().values;
            (field.name.to_owned(), values.iter().map(|value| value.to_bits()).collect())
        });
        let columns = columns.collect();
        let told = (summary.step_range, summary.worst, &summary.warnings, &summary.retries);
        Left { tables: format!("{:?} {told:?}", finished.tables), columns, finished }
    })
}

/// The same bits on any number of ranks, with one thread each and with several; the run on one.
pub fn same_on_any_number(text: &str, set: &[&str]) -> Left {
    let alone = run(text, set, 1, 1);
    for (ranks, threads) in [(2, 1), (2, 4), (3, 1), (4, 8), (7, 7)] {
        same(&alone, &run(text, set, ranks, threads), &format!("{set:?} on {ranks} ranks"));
    }
    alone
}

/// The same tables and columns.
#[track_caller]
fn same(alone: &Left, shared: &Left, what: &str) {
    assert!(alone.tables == shared.tables, "{what}: tables differ");
    assert_eq!(alone.finished.notes, shared.finished.notes, "{what}");
    assert_eq!(alone.columns.len(), shared.columns.len(), "{what}");
    for (one, other) in alone.columns.iter().zip(&shared.columns) {
        assert!(one == other, "{what}: {} differs", one.0);
    }
}

/// A plate that is pulled, pressed, held and falls, beside another one.
pub const PLATE: &str = r#"
version = 1
title = "A plate"
dimension = 2
[[body]]
name = "plate"
shape = { kind = "box", min = [0.0, 0.0], max = [2.0, 0.7] }
spacing = 0.05
material = { kind = "neo_hookean", density = 800.0, young_modulus = 3e5, poisson_ratio = 0.23 }
initial = { velocity = ["0.3 * sin(3 * x)", "0.1 * x"] }
[[body]]
name = "other"
shape = { kind = "box", min = [3.0, 2.0], max = [3.6, 2.7] }
spacing = 0.06
lattice = { on = "cells", jitter = 0.1, seed = 4 }
material = { kind = "neo_hookean", density = 500.0, young_modulus = 1e5, poisson_ratio = 0.4 }
[scheme]
kind = "dual_support"
[[load]]
name = "gravity"
body = "plate"
kind = "body_force"
acceleration = ["cos(9 * t)", "-2.0 * x"]
[[load]]
name = "pull"
body = "plate"
kind = "traction"
where = { kind = "plane", point = [2.0, 0.0], normal = [1.0, 0.0] }
traction = ["2e3 * t + 300.0 * y", "100.0"]
[[boundary]]
name = "wall"
body = "plate"
where = { kind = "plane", point = [0.0, 0.0], normal = [-1.0, 0.0] }
velocity = { x = "0.2 * sin(20 * t)", y = "0" }
[[probe]]
name = "near"
kind = "particle"
at = [1.0, 0.35]
fields = ["displacement", "velocity", "stress"]
[time]
end = 0.05
[output]
every = 0.01
table_every = 0.002
"#;

#[test]
fn displacements_are_the_same_on_any_number_of_ranks() {
    same_on_any_number(PLATE, &[]);
    // Velocities are gathered, too, and each evaluation has its own rates.
    let viscous = ["scheme.viscosity=40.0", "scheme.damping=3.0", "time.integrator='tvd_rk2'"];
    same_on_any_number(PLATE, &viscous);
}

#[test]
fn a_pressure_that_follows_is_the_same_on_any_number_of_ranks() {
    let pressure = "load.pull={ kind = 'pressure', body = 'plate', where = { kind = 'plane', point = [2.0, 0.0], normal = [1.0, 0.0] }, \
                    pressure = '4e3 * (1 + y)' }";
    same_on_any_number(PLATE, &[pressure, "scheme.gradients='plain'", "scheme.hourglass=0.3"]);
}

/// A spring with a damper pulls on the centre of all particles of a body, and a rigid body turns: each rank has some of their
/// particles.
#[test]
fn springs_and_rigid_bodies_are_the_same_on_any_number_of_ranks() {
    let spring = "load.pull={ kind = 'spring', body = 'plate', to = [0.0, -1.0], stiffness = 3e4, damping = 200.0 }";
    let rigid = [
        "scheme.kind='total_lagrangian'",
        "body.other.material={ kind = 'rigid', density = 500.0 }",
        "body.other.spacing=0.03",
        "body.other.initial={ velocity = ['1 - 5 * y', '5 * x'] }",
    ];
    let alone = same_on_any_number(PLATE, &[&[spring][..], &rigid].concat());
    for name in ["spring", "boundary_motion"] {
        let Some(Series::Curve { values, .. }) = alone.finished.quantity(&format!("energy.{name}"))
        else {
            panic!("{name} is a curve");
        };
        assert!(values.iter().any(|work| work.abs() > 1e-3), "{name}: {values:?}");
    }
    // Velocities that are gathered stand in front of copies of others.
    same_on_any_number(PLATE, &[&[spring][..], &rigid, &["scheme.viscosity=25.0"]].concat());
    // It is turned as a clock says, and held at a point.
    let turned = "boundary+={ name = 'axle', body = 'other', where = { kind = 'all' }, velocity = { x = '0', y = 't' }, \
                  angular_velocity = { z = '3 * cos(40 * t)' } }";
    same_on_any_number(PLATE, &[&rigid[..], &[turned]].concat());
}

/// A block in space that tumbles, which is prescribed about two axes, beside one that is not rigid.
#[test]
fn a_rigid_body_in_space_is_the_same_on_any_number_of_ranks() {
    let text = r#"
version = 1
title = "Two blocks"
dimension = 3
[[body]]
name = "rigid"
shape = { kind = "box", min = [0.0, 0.0, 0.0], max = [0.5, 0.3, 0.2] }
spacing = 0.05
material = { kind = "rigid", density = 700.0 }
initial = { velocity = ["2 * y - z", "z - 2 * x", "x - y"] }
[[body]]
name = "soft"
shape = { kind = "box", min = [2.0, 0.0, 0.0], max = [2.4, 0.3, 0.3] }
spacing = 0.06
material = { kind = "neo_hookean", density = 500.0, young_modulus = 1e5, poisson_ratio = 0.3 }
initial = { velocity = ["y", "-z", "0.0"] }
[scheme]
kind = "total_lagrangian"
viscosity = 30.0
[[boundary]]
name = "clock"
body = "rigid"
where = { kind = "all" }
angular_velocity = { x = "3 + sin(50 * t)", y = "t" }
[time]
end = 0.04
[output]
every = 0.02
table_every = 0.002
"#;
    same_on_any_number(text, &[]);
    same_on_any_number(text, &["boundary="]);
}

#[test]
fn a_periodic_plate_is_the_same_on_any_number_of_ranks() {
    let sets = [
        "domain={ periodic = { y = [0.0, 0.7] } }",
        "body.plate.lattice={ on = 'cells', jitter = 0.2, seed = 5 }",
        "load.pull={ kind = 'body_force', body = 'plate', acceleration = ['0', 'x'] }",
        "boundary.wall.where={ kind = 'ball', center = [0.1, 0.3], radius = 0.2 }",
    ];
    same_on_any_number(PLATE, &sets);
}

/// A sheet of two rows, and a body of six particles: each of seven ranks has copies of most that its neighbours have, and
/// one has a whole body.
#[test]
fn bodies_thinner_than_a_halo_are_the_same_on_any_number_of_ranks() {
    let sets = [
        "body.plate.shape={ kind = 'box', min = [0.0, 0.0], max = [2.6, 0.05] }",
        "body.other.shape={ kind = 'box', min = [3.0, 2.0], max = [3.2, 2.1] }",
        "body.other.spacing=0.1",
        "body.other.lattice={}",
        "load.pull.where.point=[2.6, 0.0]",
        "probe.near.at=[1.0, 0.05]",
        "scheme.gradients='plain'",
        "scheme.viscosity=40.0",
    ];
    same_on_any_number(PLATE, &sets);
}

#[test]
fn mirrors_are_the_same_on_any_number_of_ranks() {
    // Below the plane that moves there is another that does not.
    let sets = [
        "body.other.shape={ kind = 'box', min = [3.0, 0.0], max = [3.6, 0.7] }",
        "body.other.lattice={}",
        "boundary+={ name = 'bottom', where = { kind = 'plane', point = [0.0, 0.0], normal = [0.0, -1.0] }, \
         velocity = { y = '0.1 * sin(30 * t)' }, mirror = true }",
        "boundary+={ name = 'top', where = { kind = 'plane', point = [0.0, 0.7], normal = [0.0, 1.0] }, \
         velocity = { y = '0' }, mirror = true }",
        "boundary.wall.velocity={ x = '0.2 * sin(20 * t)' }",
    ];
    same_on_any_number(PLATE, &sets);
    same_on_any_number(PLATE, &[&sets[..], &["scheme.viscosity=25.0"]].concat());
}

/// A block that hits a wall and shears.
pub const BLOCK: &str = r#"
version = 1
title = "A block"
dimension = 3
[[body]]
name = "block"
shape = { kind = "box", min = [0.0, 0.0, 0.0], max = [1.0, 0.6, 0.5] }
spacing = 0.1
material = { kind = "gamma_law", density = 1000.0, gamma = 5.0, wave_speed = 14.0 }
initial = { velocity = ["-1.0 - 0.2 * y", "0.1 * z", "0.0"] }
[scheme]
kind = "upwind"
smoothing_length = 1.1
tau_velocity = 0.4
tau_pressure = 0.3
reconstruction = true
[[load]]
name = "gravity"
kind = "body_force"
acceleration = ["0", "-9.0 * sin(t)", "1.0"]
[[load]]
name = "push"
kind = "traction"
where = { kind = "plane", point = [1.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }
traction = ["-3e3 * y", "0", "10.0"]
[[boundary]]
name = "wall"
where = { kind = "plane", point = [0.0, 0.0, 0.0], normal = [-1.0, 0.0, 0.0] }
velocity = { x = "0" }
[time]
end = 0.2
[output]
every = 0.05
table_every = 0.01
"#;

#[test]
fn upwind_is_the_same_on_any_number_of_ranks() {
    same_on_any_number(BLOCK, &[]);
    same_on_any_number(BLOCK, &["scheme.reconstruction=false", "time.integrator='ssp_rk3'"]);
}

#[test]
fn steps_that_nothing_damps_are_the_same_on_any_number_of_ranks() {
    let sets =
        ["scheme.reconstruction=false", "scheme.tau_velocity=0.0", "scheme.tau_pressure=0.0"];
    same_on_any_number(BLOCK, &sets);
}

/// More than a thread's work for each rank.
#[test]
fn many_particles_are_the_same_on_any_number_of_ranks() {
    let sets = ["body.plate.spacing=0.017", "time.end=8e-3", "output.table_every=2e-3"];
    let alone = run(PLATE, &sets, 1, 1);
    for (ranks, threads) in [(2, 4), (3, 9)] {
        same(&alone, &run(PLATE, &sets, ranks, threads), &format!("{ranks} ranks"));
    }
}

/// What is changed between two steps goes to all ranks, also if it is that of some.
#[test]
fn what_is_set_between_steps_reaches_all_ranks() {
    let changed = |ranks: usize| {
        let overrides = [
            format!("compute.ranks={ranks}"),
            "scheme.tau_velocity=0.0".into(),
            "scheme.tau_pressure=0.0".into(),
        ];
        let options = LoadOptions { overrides: overrides.to_vec(), ..LoadOptions::default() };
        let case =
            case::parse(BLOCK, "shared.toml", &options).unwrap_or_else(|told| panic!("{told}"));
        let mut session = Session::new(&case).unwrap_or_else(|told| panic!("{told}"));
        session.run_until(0.02).unwrap();
        let mut velocity = session.column("velocity").unwrap().values;
        velocity[..30].iter_mut().for_each(|component| *component *= 0.5);
        session.set("velocity", &velocity).unwrap();
        session.run_until(0.06).unwrap();
        session.column("velocity").unwrap().values.into_iter().map(f64::to_bits).collect::<Vec<_>>()
    };
    let alone = changed(1);
    assert!(changed(3) == alone && changed(4) == alone);
}

/// How a run ends that fails after as many retries, in words.
pub fn failure(text: &str, sets: &[&str], ranks: usize, retries: usize) -> String {
    let overrides = sets.iter().map(|set| (*set).to_owned());
    let overrides = overrides.chain([format!("compute.ranks={ranks}")]).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(text, "shared.toml", &options).unwrap_or_else(|told| panic!("{told}"));
    let mut session = Session::new(&case).unwrap_or_else(|told| panic!("{told}"));
    while session.step().unwrap() {}
    let summary = session.finish().unwrap().summary;
    assert_eq!(summary.retries.len(), retries, "{:?}", summary.outcome);
    let told = format!("{:?} {:?} {:?}", summary.outcome, summary.retries, summary.warnings);
    assert!(told.contains("Failed"), "{told}");
    told
}

/// A body that is pressed until it collapses fails in the same words, and retries as often.
#[test]
fn failures_are_the_same_on_any_number_of_ranks() {
    let sets = [
        "body.block.initial={ velocity = ['-60.0 * x', '-30.0 * y', '0'] }",
        "body.block.material={ kind = 'linear', density = 1000.0, bulk_modulus = 2e5 }",
        "time.on_failure='retry'",
        "time.retries=2",
    ];
    assert_eq!(failure(BLOCK, &sets, 3, 2), failure(BLOCK, &sets, 1, 2));
}

/// An observer that panics.
struct Panicking;

impl Observer for Panicking {
    fn schedule(&self) -> &Schedule {
        &Schedule::Every(0.01)
    }

    fn observe(&mut self, _: &mut Moment<'_, '_>) -> Result<(), ObserveError> {
        panic!("an observer panics");
    }
}

/// The ranks of a run that panics end with it.
#[test]
fn a_panic_does_not_leave_ranks_waiting() {
    let (told, ended) = mpsc::channel();
    std::thread::spawn(move || {
        let unwound = std::panic::catch_unwind(|| {
            let options =
                LoadOptions { overrides: vec!["compute.ranks=3".into()], ..LoadOptions::default() };
            let case =
                case::parse(BLOCK, "shared.toml", &options).unwrap_or_else(|told| panic!("{told}"));
            let mut session = Session::new(&case).unwrap_or_else(|told| panic!("{told}"));
            session.observe(Box::new(Panicking));
            session.step().map(drop)
        });
        told.send(unwound.is_err())
    });
    assert_eq!(ended.recv_timeout(Duration::from_secs(60)), Ok(true));
}

#[test]
fn what_does_not_run_on_several_ranks_is_named() {
    let refused = |text: &str, set: &[&str], what: &str| {
        let overrides =
            ["compute.ranks=2"].iter().chain(set).map(|set| (*set).to_owned()).collect();
        let options = LoadOptions { overrides, ..LoadOptions::default() };
        let case =
            case::parse(text, "shared.toml", &options).unwrap_or_else(|told| panic!("{told}"));
        let told = match Session::new(&case) {
            Ok(_) => panic!("accepted: {what}"),
            Err(told) => told.to_string(),
        };
        assert!(told.contains(what), "{told}");
    };
    let implicit = ["time.integrator='newmark'", "time.step=1e-3"];
    let direct = "the direct linear solver does not run on several ranks yet: set `time.linear_solver = \"krylov\"`";
    refused(PLATE, &implicit, direct);
    refused(BLOCK, &["time.integrator='backward_euler'", "time.step=1e-3"], direct);
    let few = "body.block.spacing=0.3";
    refused(BLOCK, &[few, "compute.ranks=9"], "ranks are too many for");
    refused(BLOCK, &[few, "compute.ranks=9"], "a chunk of 16: take 3 ranks or fewer");
    let two = "body.block.spacing=0.35";
    refused(BLOCK, &[two, "compute.ranks=9"], "a chunk of 16: take 2 ranks");
    refused(
        BLOCK,
        &["body.block.spacing=0.5"],
        "2 ranks are too many for 12 particles, of which each rank needs at least a chunk of 16: \
         leave out `--ranks`",
    );
    let refined = include_str!("../../../../cases/open/resolution/case.toml");
    let finer =
        "regions of finer spacing do not run on several ranks yet: leave out `scheme.refine`";
    refused(refined, &[], finer);
}

/// Which cases run on several ranks.
#[test]
fn cases_are_shared_but_for_factors_and_what_is_refused() {
    let cases = cases();
    let shared = cases.par_iter().filter(|path| on_ranks(path, None, &[]).is_some());
    let names = shared.filter_map(|path| path.parent()?.file_name()?.to_str());
    assert_eq!(names.collect::<Vec<&str>>(), SHARED);
}

/// The cases of which several ranks have a part each.
const SHARED: [&str; 64] = [
    "dam-break-box",
    "dam-break-plate",
    "dam-break-plate-3d",
    "floating-box",
    "gate",
    "hull",
    "leaflet",
    "plate",
    "plate-3d",
    "ring",
    "slab",
    "wedge",
    "cavity",
    "compression",
    "contact",
    "couette",
    "dam-break",
    "dam-break-3d",
    "drop",
    "free-surface",
    "free-surface-3d",
    "impact",
    "impact-3d",
    "jet",
    "jet-3d",
    "plane-shock",
    "poiseuille",
    "rings",
    "rings-3d",
    "still-water",
    "swinging-plate",
    "swinging-plate-3d",
    "taylor-bar",
    "taylor-green",
    "taylor-green-3d",
    "cube",
    "free-vibration",
    "biaxial",
    "hole",
    "pulse-3d",
    "reflection-3d",
    "wave-2d",
    "wave-3d",
    "channel",
    "cylinder",
    "solitary",
    "standing-wave",
    "step",
    "turek-hron",
    "turek-hron-flow",
    "vessel",
    "wave-tank",
    "waves",
    "presets",
    "bar-sine",
    "bar-step",
    "column-impact",
    "column-impact-3d",
    "dam-break",
    "dam-break-3d",
    "drop-3d",
    "impact-linear",
    "piston",
    "piston-steps",
];
