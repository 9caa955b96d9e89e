//! Fluid that gets out: it is named, or removed and accounted for; walls that will not hold it.

use std::sync::atomic::{AtomicBool, Ordering};

use piola::case::{self, Case, Finished, LoadOptions, Session};
use piola::observe::Series;
use piola::schemes::Behind;
use piola::time::{Failure, Outcome, Progress};

use super::device::device;

/// A block of fluid above a floor that it hits at three times its wave speed, so that it goes
/// through.
const BULLET: &str = r#"
version = 1
title = "A block of fluid falls onto a floor"
dimension = 2

[parameters]
speed = 3.0
# Of all lengths.
scale = 1.0
layers = 3
hole = 5.0
gap = 0.1

[[body]]
name = "block"
shape = { kind = "box", min = [0.0, "0.1 * scale"], max = ["0.4 * scale", "0.5 * scale"] }
spacing = "0.05 * scale"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 1.0, viscosity = 0.0 }
initial = { velocity = ["0", "-speed"] }

[[body]]
name = "floor"
shape = { kind = "difference", from = { kind = "box", min = ["-scale", "-0.05 * scale * layers"], max = ["1.4 * scale", 0.0] }, remove = [{ kind = "box", min = ["hole * scale", "-scale"], max = ["(hole + gap) * scale", "scale"] }] }
spacing = "0.05 * scale"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 1.0, viscosity = 0.0 }
wall = { slip = "no" }

[scheme]
kind = "transport_velocity"
free_surface = true

[time]
end = 0.2

[output]
every = 0.1
table_every = 0.01
"#;

fn read(text: &str, set: &[&str]) -> Case {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    case::parse(text, "test", &options).unwrap_or_else(|problems| panic!("{problems}"))
}

pub fn run(text: &str, set: &[&str]) -> Finished {
    let session = Session::new(&read(text, set)).unwrap_or_else(|problems| panic!("{problems}"));
    session.run(&AtomicBool::new(false), &mut |_| {}).expect("no files are written")
}

fn failure(finished: &Finished) -> &Failure {
    match &finished.summary.outcome {
        Outcome::Failed(failure) => failure,
        other => panic!("{other:?}"),
    }
}

pub fn values(finished: &Finished, name: &str) -> Vec<f64> {
    match finished.quantity(name) {
        Some(Series::Curve { values, .. }) => values,
        Some(Series::Number { value, .. }) => vec![value],
        other => panic!("{name}: {other:?}"),
    }
}

#[test]
fn what_goes_through_a_wall_is_named_at_once() {
    let finished = run(BULLET, &[]);
    let Failure::Escaped { escape, time, .. } = failure(&finished) else {
        panic!("{:?}", finished.summary.outcome)
    };
    assert_eq!(escape.behind, Behind::Wall("floor".into()));
    // The first layer stands 0.025 m below the face; in a step the block moves by 0.25 * 0.05 m at
    // most, and no faster than it started by much.
    assert!((-0.05..-0.025).contains(&escape.position[1]), "{escape:?}");
    assert!(*time > 0.03 && *time < 0.1, "it was 0.125 m above: {time}");
    assert!(escape.speed > 0.1 && escape.speed < 30.0);
    let message = failure(&finished).to_string();
    for part in ["`floor`", "scheme.escaped", "m/s"] {
        assert!(message.contains(part), "{message}");
    }
    assert_eq!(finished.summary.outcome.summary(), "failed: escaped");
    // What the fluid does at a speed that walls are for is no escape.
    let slow = run(BULLET, &["parameters.speed=0.2", "time.end=0.6"]);
    assert_eq!(slow.summary.outcome, Outcome::Completed);
}

/// The face of the floor lies on the box around it: which of the two was passed last is round-off, which depends on the
/// numbers of the lengths.
#[test]
fn what_goes_through_a_flat_wall_has_not_come_over_its_end() {
    for scale in [0.65, 0.7, 0.75, 0.8, 0.9, 1.3] {
        let finished = run(BULLET, &[&format!("parameters.scale={scale}")]);
        let Failure::Escaped { escape, .. } = failure(&finished) else {
            panic!("{scale}: {:?}", finished.summary.outcome)
        };
        assert_eq!(escape.behind, Behind::Wall("floor".into()), "{scale}");
    }
}

#[test]
fn what_is_removed_leaves_by_ways_of_its_own() {
    for pressure in ["edac", "state_equation"] {
        let law = format!("scheme.pressure='{pressure}'");
        let set = ["scheme.escaped='remove'", law.as_str()];
        let finished = run(BULLET, &set);
        assert_eq!(finished.summary.outcome, Outcome::Completed);
        let removed = values(&finished, "step.removed");
        assert!(removed.windows(2).all(|pair| pair[1] >= pair[0]), "none comes back");
        assert!(removed[0] == 0.0 && removed.last() >= Some(&1.0), "{removed:?}");
        assert_eq!(values(&finished, "run.removed"), removed[removed.len() - 1..]);
        let told = format!("{} of", removed[removed.len() - 1]);
        assert!(finished.warnings.iter().any(|text| text.contains(&told)));
        // 160 kg at 3 m/s: 720 J and 480 kg m/s; the sums are round-off.
        let largest =
            |name: &str| values(&finished, name).iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let taken = values(&finished, "energy.removed");
        assert!(taken.last() < Some(&-0.1), "what is removed moves: {taken:?}");
        assert!(largest("energy.balance") < 1e-9, "{:e}", largest("energy.balance"));
        let impulse = values(&finished, "momentum.removed.linear.y");
        assert!(impulse.last() > Some(&0.01), "it went down: {impulse:?}");
        for component in ["linear.x", "linear.y"] {
            let balance = largest(&format!("momentum.balance.{component}"));
            assert!(balance < 1e-9, "{component}: {balance:e}");
        }
    }
}

/// Fluid that flies over the rim of a wall, which ends there with all else, and falls on the other side of it.
const RIM: &str = r#"
version = 1
title = "Over the rim"
dimension = 2

[[body]]
name = "block"
shape = { kind = "box", min = [-0.5, -0.3], max = [-0.4, -0.1] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 40.0, viscosity = 0.0 }
initial = { velocity = ["1.2", "3.5"] }

[[body]]
name = "wall"
shape = { kind = "box", min = [0.0, -0.5], max = [0.15, 0.0] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 40.0, viscosity = 0.0 }
wall = { slip = "free" }

[scheme]
kind = "transport_velocity"
free_surface = true

[[load]]
kind = "body_force"
acceleration = ["0", "-9.81"]

[time]
end = 0.75

[[probe]]
name = "left"
kind = "extremum"
body = "block"
field = "position.x"
of = "smallest"

[[probe]]
name = "top"
kind = "extremum"
body = "block"
field = "position.y"
of = "largest"

[output]
every = 0.75
table_every = 0.01
"#;

#[test]
fn what_goes_round_a_wall_has_not_gone_through_it() {
    let finished = run(RIM, &[]);
    assert_eq!(finished.summary.outcome, Outcome::Completed);
    // Up to 0.62 m higher and, at the end, below the rim on the far side, a spacing from it at least.
    let last = |name: &str| values(&finished, name).last().copied().expect("rows");
    let [left, top] = ["left.position.x", "top.position.y"].map(last);
    assert!(left > 0.2 && top < 0.0, "{left} {top}");
    assert!(values(&finished, "top.position.y").iter().any(|y| *y > 0.1));
    assert!(values(&finished, "step.behind").iter().all(|count| *count == 0.0));
}

/// Water that hits a wall next to its upper edge. The lattice of the wall is fitted to it: as 0.43 m are 8.6 spacings and
/// 0.315 m are 6.3, its cells are 0.0478 m high and 0.0525 m long, and the particle at the edge is nearer to one of its
/// faces.
const EDGE: &str = r#"
version = 1
title = "Next to an edge"
dimension = 2

[[body]]
name = "water"
shape = { kind = "box", min = [0.35, "0.2 - below"], max = [0.75, "0.6 - below"] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 40.0, viscosity = 0.0 }
initial = { velocity = ["-4", "0"] }

[[body]]
name = "wall"
shape = { kind = "box", min = [0.0, 0.0], max = [0.315, 0.43] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 40.0, viscosity = 0.0 }
wall = { slip = "free" }

[[body]]
name = "ground"
shape = { kind = "union", of = [
  { kind = "box", min = [-0.5, -0.2], max = [1.0, 0.0] },
  { kind = "box", min = [0.8, 0.0], max = [1.0, 0.8] },
] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 40.0, viscosity = 0.0 }
wall = { slip = "free" }

[parameters]
below = 0.0

[scheme]
kind = "transport_velocity"
free_surface = true

[time]
end = 0.2

[output]
every = 0.2
table_every = 0.002
"#;

#[test]
fn both_faces_of_an_edge_hold_where_cells_are_longer_than_high() {
    for below in [0.0, 0.01, 0.02, 0.03, 0.04] {
        let finished = run(EDGE, &[&format!("parameters.below={below}")]);
        assert_eq!(finished.summary.outcome, Outcome::Completed, "{below}");
        assert!(values(&finished, "step.behind").iter().all(|count| *count == 0.0), "{below}");
    }
}

/// A piston that stands on a floor and is drawn back.
const PISTON: &str = r#"
version = 1
title = "A piston is drawn back"
dimension = 2

[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [0.5, 0.3] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 20.0, viscosity = 0.0 }
initial = { velocity = ["-1", "0"] }

[[body]]
name = "piston"
shape = { kind = "box", min = [-0.2, 0.0], max = [0.0, 0.6] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 20.0, viscosity = 0.0 }
wall = { slip = "free" }

[[body]]
name = "floor"
shape = { kind = "box", min = [-0.9, -0.2], max = [0.7, 0.0] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 20.0, viscosity = 0.0 }
wall = { slip = "free" }

[scheme]
kind = "transport_velocity"
free_surface = true

[[load]]
kind = "body_force"
acceleration = ["0", "-20"]

[[boundary]]
name = "back"
body = "piston"
where = { kind = "all" }
velocity = { x = "-1" }

[time]
end = 0.15

[[probe]]
name = "left"
kind = "extremum"
body = "water"
field = "position.x"
of = "smallest"

[output]
every = 0.15
table_every = 0.002
"#;

/// The floor holds where the piston stood what is thrown at it, at up to a quarter of the wave speed, theory (80): it has the
/// faces there that it has alone.
#[test]
fn a_floor_holds_where_a_wall_has_moved_away() {
    for fall in [1.0, 5.0] {
        let finished = run(PISTON, &[&format!("body.water.initial.velocity=['-1', '-{fall}']")]);
        assert_eq!(finished.summary.outcome, Outcome::Completed);
        assert!(values(&finished, "step.behind").iter().all(|count| *count == 0.0), "{fall}");
        // Water stands on what the piston has left.
        assert!(*values(&finished, "left.position.x").last().expect("rows") < -0.1, "{fall}");
    }
}

/// The wall ends where everything does, and has no face there: what falls on its end is told as that, once it is in the
/// wall and not before.
#[test]
fn what_falls_on_the_end_of_a_wall_has_not_gone_through_it() {
    // It is back at the height of the rim after 0.65 s, in the middle of the wall.
    let falls = "body.block.initial.velocity=['0.845', '3.5']";
    let finished = run(RIM, &[falls]);
    let Failure::Escaped { escape, .. } = failure(&finished) else {
        panic!("{:?}", finished.summary.outcome)
    };
    assert_eq!(escape.behind, Behind::End("wall".into()));
    // In a step it falls by 2.9 m/s * 0.25 * 1.3 * 0.05 m / 40 m/s.
    assert!((-0.0012..0.0).contains(&escape.position[1]), "{escape:?}");
    let message = failure(&finished).to_string();
    for part in ["over the end of the wall `wall`", "longer", "scheme.escaped"] {
        assert!(message.contains(part), "{message}");
    }
    let finished = run(RIM, &[falls, "scheme.escaped='remove'"]);
    assert_eq!(finished.summary.outcome, Outcome::Completed);
    assert_eq!(values(&finished, "run.removed"), [8.0]);
    assert!(values(&finished, "top.position.y").iter().any(|y| *y > 0.1));
}

#[test]
fn what_leaves_the_box_is_named() {
    let set = ["body.block.initial.velocity=['0', '20']", "time.end=1", "time.max_speed=100"];
    let finished = run(BULLET, &set);
    let Failure::Escaped { escape, .. } = failure(&finished) else {
        panic!("{:?}", finished.summary.outcome)
    };
    // The walls end half a spacing below 0 and everything is 2.35 m wide.
    assert_eq!(escape.behind, Behind::Box);
    assert!((2.3..2.6).contains(&escape.position[1]), "{escape:?}");
    assert!(failure(&finished).to_string().contains("left the bounding box"));
}

#[test]
fn a_fixed_step_above_a_limit_is_refused_with_the_limit() {
    let finished = run(BULLET, &["parameters.speed=0.5", "time.step=0.05"]);
    let Failure::FixedStepTooLarge { step, stable, limiter, .. } = failure(&finished) else {
        panic!("{:?}", finished.summary.outcome)
    };
    // h / (c + |u|) = 0.05 / 1.5 s, theory (34).
    assert_eq!((*step, *limiter), (0.05, "acoustic"));
    assert!((stable - 0.05 / 1.5).abs() < 1e-12);
    assert!(failure(&finished).to_string().contains("3.3333e-2 s"));
    assert_eq!(finished.summary.steps, 0);
}

#[test]
fn passes_of_the_iterated_shifting_are_counted() {
    let set = [
        "parameters.speed=0.4",
        "time.end=0.5",
        "scheme.shifting='ipst'",
        "scheme.shifting_passes=4",
    ];
    let passes = values(&run(BULLET, &set), "step.shifting_passes");
    assert!(passes.iter().all(|passes| (0.0..=4.0).contains(passes) && passes.fract() == 0.0));
    assert!(passes.iter().any(|passes| *passes >= 1.0), "{passes:?}");
    let none = values(&run(BULLET, &["parameters.speed=0.2"]), "step.shifting_passes");
    assert!(none.iter().all(|passes| *passes == 0.0));
}

#[test]
fn walls_that_will_not_hold_are_warned_of() {
    let warnings = |set: &[&str]| {
        let mut session = Session::new(&read(BULLET, set)).expect("the case can be built");
        session.plan().warnings
    };
    let has = |warnings: &[String], part: &str| warnings.iter().any(|text| text.contains(part));
    let sound = warnings(&["parameters.speed=0.2"]);
    assert!(sound.is_empty(), "three layers are as thick as the support: {sound:?}");
    let thin = warnings(&["parameters.speed=0.2", "parameters.layers=2"]);
    assert!(has(&thin, "`floor` is about") && has(&thin, "3 layers"), "{thin:?}");
    let hole = warnings(&["parameters.speed=0.2", "parameters.hole=1.0"]);
    assert!(has(&hole, "`floor` has a gap of about 1.000e-1 m at (0.9"), "{hole:?}");
    let wide = warnings(&["parameters.speed=0.2", "parameters.hole=1.0", "parameters.gap=0.2"]);
    assert!(wide.is_empty(), "wider than the support: {wide:?}");
}

/// A device sees it in the same step, and tells the same of it.
#[test]
fn what_escapes_on_a_device_is_named_as_on_the_processor() {
    let Some(device) = device() else { return };
    let of = |device: &str, more: &str| {
        let finished = run(BULLET, &[&format!("compute.device='{device}'"), more]);
        let behind = values(&finished, "step.behind");
        (finished.summary.outcome.clone(), finished.summary.steps, behind)
    };
    for more in ["time.cfl=0.25", "time.on_failure='retry'"] {
        let expected = of("processor", more);
        assert!(matches!(expected.0, Outcome::Failed(Failure::Escaped { .. })), "{:?}", expected.0);
        assert_eq!(of(&device, more), expected);
    }
}

/// Of the first eight particles that go through the floor two are taken out in step 22 and six in step 23.
#[test]
fn what_is_removed_on_a_device_is_counted_as_on_the_processor_wherever_the_run_ends() {
    let Some(device) = device() else { return };
    for steps in [21, 22, 23, 30, u64::MAX] {
        let [expected, got] = ["processor", &device].map(|device| {
            let set = [&format!("compute.device='{device}'"), "scheme.escaped='remove'"];
            let session = Session::new(&read(BULLET, &set)).expect("the case can be built");
            let stop = AtomicBool::new(false);
            let mut progress =
                |progress: &Progress| stop.store(progress.step >= steps, Ordering::Relaxed);
            session.run(&stop, &mut progress).expect("no files are written")
        });
        assert_eq!(got.tables, expected.tables, "{steps}");
        let last = |name: &str| values(&got, name).pop();
        let told = [last("step.removed"), last("step.behind")].map(|number| number.expect("rows"));
        let expected = match steps {
            21 => [0.0, 8.0],
            22 => [2.0, 6.0],
            23 => [8.0, 0.0],
            30 => [16.0, 0.0],
            _ => [64.0, 0.0],
        };
        assert_eq!(told, expected, "{steps}");
    }
}
