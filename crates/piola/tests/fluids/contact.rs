//! Rigid bodies that touch a floor and each other, beside a little water that they do not.

use std::sync::atomic::AtomicBool;

use piola::case::{self, LoadOptions, Session};
use piola::observe::Series;
use piola::time::Outcome;

/// A block and a ball over a floor.
const BLOCK: &str = r#"
version = 1
title = "A block on a floor"
dimension = 2
[parameters]
dx = 0.05
slope = 0.0
friction = 0.0
damping = 0.1
[[body]]
name = "water"
shape = { kind = "box", min = [-2.0, 0.0], max = [-1.6, 0.2] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 40.0 }
[[body]]
name = "floor"
shape = { kind = "union", of = [
  { kind = "box", min = [-2.2, -0.2], max = [4.0, 0.0] },
  { kind = "box", min = [-2.2, -0.2], max = [-2.0, 1.0] },
  { kind = "box", min = [-1.6, -0.2], max = [-1.4, 1.0] },
] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 40.0 }
wall = { slip = "free" }
[[body]]
name = "block"
system = "block"
shape = { kind = "box", min = [0.0, 0.0], max = [0.4, 0.4] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "rigid", density = 2000.0 }
[scheme]
kind = "transport_velocity"
free_surface = true
[[system]]
name = "block"
scheme = { kind = "total_lagrangian" }
friction = "friction"
contact_damping = "damping"
[[load]]
kind = "body_force"
body = "block"
acceleration = ["slope", "-9.81"]
[time]
end = 1.0
[[probe]]
name = "block"
kind = "mean"
body = "block"
field = "velocity"
[[probe]]
name = "corner"
kind = "particle"
body = "block"
at = [0.0, 0.0]
fields = ["displacement", "velocity"]
[output]
every = 10
table_every = 0.01
fields = ["velocity"]
"#;

/// Values of columns over time.
pub fn columns<const N: usize>(text: &str, set: &[&str], names: [&str; N]) -> [Vec<f64>; N] {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let case = case::parse(text, "case.toml", &LoadOptions { overrides, ..LoadOptions::default() });
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).expect("it runs");
    assert_eq!(finished.summary.outcome.summary(), "completed");
    names.map(|name| match finished.quantity(name) {
        Some(Series::Curve { values, .. }) => values.clone(),
        other => panic!("{name}: {other:?}"),
    })
}

/// Coulomb's law: with 3 m/s and a coefficient of 0.3 the block is as fast as friction lets it be, but for 1 % in
/// which the trapezoid of the weight presses in, and hops.
#[test]
fn a_block_that_slides_is_held_back_by_friction() {
    let set = ["parameters.friction=0.3", "body.block.initial={ velocity = [3.0, 0.0] }"];
    let [speed, height] = columns(BLOCK, &set, ["block.velocity.x", "corner.displacement.y"]);
    for (row, speed) in speed.iter().enumerate() {
        let exact = (3.0 - 0.3 * 9.81 * 0.01 * row as f64).max(0.0);
        assert!((speed - exact).abs() < 0.03, "{row}: {speed} for {exact}");
    }
    // It neither sinks nor hops more than what its weight presses in: `g H / c^2` of a spacing, and impacts.
    assert!(height.iter().all(|height| height.abs() < 1e-3), "{height:?}");
}

/// On a plane that is inclined by more than the angle of friction, with the 1 % of above.
#[test]
fn a_block_slides_down_a_floor_that_is_turned() {
    let slope = "{ kind = 'turned', angle = 'angle', of = { kind = 'box', min = [-1.0, -0.2], max = [3.0, 0.0] } }";
    let block = "{ kind = 'turned', angle = 'angle', of = { kind = 'box', min = [2.0, 0.0], max = [2.4, 0.4] } }";
    let wall = "[[body]]\nname = 'slope'\nspacing = 'dx'\nlattice = { on = 'cells' }\n\
                material = { kind = 'weakly_compressible', density = 1000.0, wave_speed = 40.0 }\n\
                wall = { slip = 'free' }\n";
    let text = BLOCK
        .replace("slope = 0.0\n", "slope = 0.0\nangle = 0.5\n")
        .replace("min = [-2.2, -0.2], max = [4.0, 0.0]", "min = [-2.2, -0.2], max = [-1.4, 0.0]")
        .replace("[scheme]\n", &format!("{wall}shape = {slope}\n[scheme]\n"));
    let block = format!("body.block.shape={block}");
    let set = ["parameters.friction=0.3", "time.end=0.5", &block];
    let found = columns(&text, &set, ["block.velocity.x", "block.velocity.y"]);
    let (sine, cosine) = 0.5_f64.sin_cos();
    for (row, (x, y)) in found[0].iter().zip(&found[1]).enumerate() {
        let exact = -9.81 * (sine - 0.3 * cosine) * 0.01 * row as f64;
        assert!((x * cosine + y * sine - exact).abs() < 0.03, "{row}: {x} {y} for {exact}");
        assert!((y * cosine - x * sine).abs() < 0.03, "{row}: {x} {y} off the slope");
    }
}

/// Without damping a block comes back to where it fell from, as contact is a function of places.
#[test]
fn a_block_that_falls_comes_back() {
    let set = [
        "parameters.damping=0",
        "body.block.shape={ kind = 'box', min = [0.0, 0.1], max = [0.4, 0.5] }",
    ];
    let [height, side] = columns(BLOCK, &set, ["corner.displacement.y", "corner.displacement.x"]);
    // Free fall for 0.1 m and as long up again: three bounces.
    let way = 2.0 * (2.0 * 0.1 / 9.81_f64).sqrt();
    for bounce in 1..=3 {
        let row = (f64::from(bounce) * way / 0.01).round() as usize;
        let near = &height[row - 4..=row + 4];
        let top = near.iter().copied().fold(f64::MIN, f64::max);
        // What the contact lasts shifts the times, and 1 % of the height is the energy of 4 % of the step.
        assert!(top > -0.002 * f64::from(bounce), "{bounce}: {top}");
    }
    assert!(side.iter().all(|side| side.abs() < 1e-9), "no side is another");
}

/// A disc rolls down a slope with `1 / (1 + I / (m R^2))` of the acceleration of one that slides, two thirds of it for a
/// disc. The inertia here is that of the particles, 0.516 in place of a half; contact that is damped and creeps takes some
/// hundredths.
#[test]
fn a_disc_rolls() {
    let disc = "body.block.shape={ kind = 'ball', center = [0.4, 0.4], radius = 0.4 }";
    let places =
        (-8..8).flat_map(|i| (-8..8).map(move |j| (f64::from(i) + 0.5, f64::from(j) + 0.5)));
    let squares = places.map(|(x, y)| (x * x + y * y) / 64.0).filter(|square| *square <= 1.0);
    let inertia = squares.clone().sum::<f64>() / squares.count() as f64;
    for (friction, share) in [(0.6, 1.0 / (1.0 + inertia)), (0.0, 1.0)] {
        let friction = format!("parameters.friction={friction}");
        let set = [disc, "parameters.slope=1.0", "parameters.damping=1", &friction];
        let [speed] = columns(BLOCK, &set, ["block.velocity.x"]);
        let speed = speed.last().expect("rows");
        assert!((speed / share - 1.0).abs() < 0.03, "{friction}: {speed} for {share}");
    }
}

/// Two blocks that meet off their middles, without gravity: linear momentum is kept to round-off, angular momentum
/// to how far the points are apart that act on each other.
#[test]
fn blocks_that_meet_keep_their_momentum() {
    let second = r#"
[[body]]
name = "other"
system = "other"
shape = { kind = "box", min = [0.5, 1.15], max = [0.8, 1.55] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "rigid", density = 1000.0 }
initial = { velocity = [-2.0, 0.0] }
[[system]]
name = "other"
scheme = { kind = "total_lagrangian" }
friction = 0.2
"#;
    let text = format!("{BLOCK}{second}");
    let set = [
        "load=",
        "parameters.friction=0.2",
        "time.end=0.3",
        "body.block.initial={ velocity = [1.0, 0.0] }",
        "body.block.shape={ kind = 'box', min = [0.0, 1.05], max = [0.4, 1.45] }",
    ];
    let case = {
        let overrides = set.iter().map(|text| (*text).to_owned()).collect();
        let options = LoadOptions { overrides, ..LoadOptions::default() };
        case::parse(&text, "case.toml", &options).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let mut session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let mut momentum = || {
        let velocity = session.column("velocity").expect("it is there").values;
        let place = session.column("position").expect("it is there").values;
        let bodies = session.scheme().bodies().to_vec();
        let mut all = [[0.0; 3]; 4];
        for (a, (v, x)) in velocity.chunks_exact(2).zip(place.chunks_exact(2)).enumerate() {
            let mass = session.scheme().mass(a);
            let own = &mut all[bodies[a] as usize];
            let parts = [v[0], v[1], x[0] * v[1] - x[1] * v[0]];
            own.iter_mut().zip(parts).for_each(|(sum, part)| *sum += mass * part);
        }
        session.run_until(0.3).expect("it runs");
        [all[2], all[3]]
    };
    let (start, end) = (momentum(), momentum());
    let sum = |all: [[f64; 3]; 2], k: usize| all[0][k] + all[1][k];
    let given = start[0][0] - end[0][0];
    assert!(given > 200.0, "they meet: {given} kg m/s");
    // Of 320 kg m/s, as often as there are steps.
    for axis in 0..2 {
        assert!((sum(end, axis) - sum(start, axis)).abs() < 1e-9, "{axis}: {start:?} {end:?}");
    }
    // A spacing times the impulse is 16 kg m2/s.
    let turned = sum(end, 2) - sum(start, 2);
    assert!(turned.abs() < 0.1 * 0.05 * given, "{turned} of {given}");
}

/// A floor whose lattice does not end where it does: 1.17 m are 23 cells of 0.0509 m, and its first layer lies deep below
/// it. The block stands on it all the same, and what holds it is its weight.
#[test]
fn a_block_stands_on_any_floor() {
    let text = BLOCK.replace("min = [-2.2, -0.2]", "min = [-2.2, -0.17]");
    let probe = r#"
[[probe]]
name = "stand"
kind = "force"
body = "block"
field = "contact_force"
about = [0.2, 0.0]
"#;
    let text = format!("{text}{probe}");
    let names = ["corner.displacement.y", "stand.contact_force.y", "stand.moment.z"];
    let [height, force, moment] = columns(&text, &["parameters.damping=1"], names);
    let last = |column: &[f64]| *column.last().expect("rows");
    assert!(last(&height) < 0.0 && last(&height) > -0.1 * 0.05, "{height:?}");
    let weight = 0.16 * 2000.0 * 9.81;
    assert!((last(&force) / weight - 1.0).abs() < 0.01, "{force:?}");
    assert!(last(&moment).abs() < 0.01 * weight * 0.2, "{moment:?}");
}

/// A block on the edge of a step, with its rear face a quarter of a spacing inside of it and no weight: were the two
/// faces to touch, each of their points would push with `A rho c^2 / 4`. Nothing does but round-off.
#[test]
fn faces_that_cross_at_an_edge_do_not_touch() {
    let step = BLOCK
        .replace("min = [-2.2, -0.2], max = [4.0, 0.0]", "min = [-2.2, -0.6], max = [0.0, 0.0]");
    let probe = r#"
[[probe]]
name = "edge"
kind = "force"
body = "block"
field = "contact_force"
"#;
    let shape = "body.block.shape={ kind = 'box', min = [-0.0125, 0.0], max = [0.3875, 0.4] }";
    let set = ["time.end=0.001", "load=", shape];
    let text = format!("{step}{probe}");
    let found = columns(&text, &set, ["edge.contact_force.x", "edge.contact_force.y"]);
    let push = 0.05 * 2000.0 * 1600.0 / 4.0;
    for force in found.iter().flatten() {
        assert!(force.abs() < 1e-6 * push, "{found:?}");
    }
}

/// A piston beside its cylinder: all that there is at the edge is the other face. Normals are the directions of the
/// shortest ways, whose lengths are compared to 1e-12: they are off by the root of that.
#[test]
fn what_slides_past_an_edge_is_not_held_by_it() {
    let pillar = BLOCK
        .replace("min = [-2.2, -0.2], max = [4.0, 0.0]", "min = [-2.2, -0.6], max = [0.0, 0.0]")
        .replace(
            "density = 2000.0 }\n",
            "density = 2000.0 }\ninitial = { velocity = [0.0, -3.0] }\n",
        );
    let shape = "body.block.shape={ kind = 'box', min = [0.0, 0.1], max = [0.4, 0.5] }";
    let names = ["corner.velocity.x", "corner.velocity.y", "corner.displacement.y"];
    let [across, along, way] = columns(&pillar, &["time.end=0.2", "load=", shape], names);
    assert!((way[way.len() - 1] + 0.6).abs() < 1e-6, "{way:?}");
    for (across, along) in across.iter().zip(&along) {
        assert!(across.abs() < 1e-6 && (along + 3.0).abs() < 1e-6, "{across} {along}");
    }
}

/// What goes through a floor that is too soft for it ends the run by name.
#[test]
fn a_body_that_goes_through_a_floor_is_told() {
    let set =
        ["body.block.initial={ velocity = [0.0, -30.0] }", "system.block.contact_stiffness=0.01"];
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(BLOCK, "case.toml", &options).unwrap_or_else(|error| panic!("{error}"));
    let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let finished = session.run(&AtomicBool::new(false), &mut |_| {}).expect("it is told");
    let Outcome::Failed(failure) = &finished.summary.outcome else {
        panic!("{:?}", finished.summary.outcome)
    };
    let said = failure.to_string();
    for part in ["has passed through the surface that it touches", "`contact_stiffness`"] {
        assert!(said.contains(part), "{said}");
    }
}

/// A beam of rubber that falls on its side: it neither sinks in nor is kept away, by its own steps.
#[test]
fn what_bends_touches_too() {
    let set = [
        "body.block.shape={ kind = 'box', min = [0.0, 0.05], max = [1.0, 0.25] }",
        "body.block.material={ kind = 'neo_hookean_logarithmic', density = 1500.0, young_modulus = 1e6, poisson_ratio = 0.4 }",
        "parameters.damping=1",
        "parameters.friction=0.5",
    ];
    let [height] = columns(BLOCK, &set, ["corner.displacement.y"]);
    let rest = &height[60..];
    assert!(rest.iter().all(|height| (height + 0.05).abs() < 0.2 * 0.05), "{rest:?}");
}

/// What is near is looked for anew after a checkpoint, which changes no bit of where a block slides with friction, on a
/// damper: on a floor that stands, on one that is shaken, and on one whose surface runs.
#[test]
fn contact_resumes_to_the_bit() {
    let spring = r#"
[[load]]
name = "damper"
kind = "spring"
body = "block"
to = [3.0, 0.5]
stiffness = 500.0
damping = 20.0
"#;
    let text = format!("{BLOCK}{spring}");
    let shaken = "\n[[boundary]]\nname = 'floor'\nbody = 'floor'\nwhere = { kind = 'all' }\n\
                  velocity = { x = '2 * sin(90 * t)', y = '0' }\n";
    let runs = "slip = \"free\", sliding = { x = '2 * sin(90 * t)' }";
    let ends = [
        resumed_end(&text),
        resumed_end(&format!("{text}{shaken}")),
        resumed_end(&text.replace("slip = \"free\"", runs)),
    ];
    // What the floor does takes the block with it.
    assert!(ends[0] != ends[1] && ends[0] != ends[2] && ends[1] != ends[2]);
}

/// The bits of where the block is in the end, which are the same whether the run is interrupted, resumed, or neither.
fn resumed_end(text: &str) -> Vec<u64> {
    let overrides = [
        "parameters.friction=0.3",
        "body.block.initial={ velocity = ['3 - y', 'x'] }",
        "time.end=0.1",
    ];
    let overrides = overrides.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(text, "case.toml", &options).unwrap_or_else(|error| panic!("{error}"));
    let open = || Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    let end = |mut session: Session| -> Vec<u64> {
        session.run_until(0.1).expect("it runs");
        let values = session.column("position").expect("it is there").values;
        let bits: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
        // The block has the last particles, eight by eight.
        bits[bits.len() - 2 * 64..].to_vec()
    };
    let mut broken = open();
    broken.run_until(0.037).expect("it runs");
    let mut resumed = open();
    resumed.resume(broken.checkpoint()).expect("it fits");
    let whole = end(open());
    assert!(whole == end(broken), "steps that end at a time change the ones after it");
    assert!(whole == end(resumed));
    whole
}
