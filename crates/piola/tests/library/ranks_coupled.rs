//! Fluids with solids in them that several ranks share, compared with those of one.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use piola::observe::Series;

use super::ranks::{failure, same_on_any_number};

/// Water on both sides of a plate that is so thin that each side has wall particles of its own, on a floor that is shaken,
/// and two blocks that slide and fall on it beside the tank. The order of the systems is not that of their places.
pub const TANK: &str = r#"
version = 1
title = "A plate in a tank, and blocks beside it"
dimension = 2
[parameters]
dx = 0.05
[[body]]
name = "left"
shape = { kind = "box", min = [0.0, 0.0], max = [0.5, 0.4] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
initial = { velocity = ["2 * x", "-2 * y"] }
[[body]]
name = "right"
shape = { kind = "box", min = [0.65, 0.0], max = [1.15, 0.3] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
initial = { velocity = ["-0.5", "0"] }
[[body]]
name = "floor"
shape = { kind = "box", min = [-0.2, -0.2], max = [2.6, 0.0] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
wall = { slip = "free" }
[[body]]
name = "sides"
shape = { kind = "union", of = [
  { kind = "box", min = [-0.2, 0.0], max = [0.0, 0.6] },
  { kind = "box", min = [1.15, 0.0], max = [1.35, 0.6] },
] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
wall = { slip = "free" }
[[body]]
name = "plate"
system = "plate"
shape = { kind = "box", min = [0.5, 0.0], max = [0.65, 0.6] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "linear_elastic", density = 1500.0, young_modulus = 2e5, poisson_ratio = 0.3 }
[[body]]
name = "block"
system = "block"
shape = { kind = "box", min = [1.36, 0.0], max = [1.66, 0.3] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "rigid", density = 2000.0 }
initial = { velocity = ["-1", "-1"] }
[[body]]
name = "gel"
system = "gel"
shape = { kind = "box", min = [1.5, 0.31], max = [1.9, 0.55] }
spacing = 0.04
lattice = { on = "cells" }
material = { kind = "neo_hookean_logarithmic", density = 1100.0, young_modulus = 1e5, poisson_ratio = 0.3 }
initial = { velocity = ["0", "-2"] }
[scheme]
kind = "transport_velocity"
free_surface = true
escaped = "remove"
[[system]]
name = "gel"
scheme = { kind = "total_lagrangian" }
friction = 0.2
[[system]]
name = "block"
scheme = { kind = "total_lagrangian" }
friction = 0.3
[[system]]
name = "plate"
scheme = { kind = "elastodynamics" }
slip = "free"
[[load]]
name = "gravity"
kind = "body_force"
acceleration = ["0", "-9.81"]
[[load]]
name = "damper"
kind = "spring"
body = "block"
to = [3.0, 0.5]
stiffness = 500.0
damping = 20.0
[[boundary]]
name = "floor"
body = "floor"
where = { kind = "all" }
velocity = { x = "0.5 * sin(90 * t)", y = "0" }
[[boundary]]
name = "foot"
body = "plate"
where = { kind = "half_space", point = [0.0, 0.1], normal = [0.0, -1.0] }
velocity = { x = "0", y = "0" }
[[probe]]
name = "touch"
kind = "force"
body = "block"
field = "contact_force"
[[probe]]
name = "plate"
kind = "force"
body = "plate"
[[probe]]
name = "gel"
kind = "mean"
body = "gel"
field = "velocity"
[time]
end = 0.05
[output]
every = 0.025
table_every = 0.005
fields = ["velocity", "pressure", "contact_force"]
"#;

#[test]
fn a_tank_with_solids_is_the_same_on_any_number_of_ranks() {
    let alone = same_on_any_number(TANK, &[]).finished;
    let Some(Series::Curve { values, .. }) = alone.quantity("touch.contact_force.y") else {
        panic!("the probe is a curve");
    };
    assert!(values.iter().any(|force| *force > 0.0), "the block lands");
}

/// A thin plate that turns, and with it the sides on which its wall particles are seen.
#[test]
fn a_plate_that_turns_is_the_same_on_any_number_of_ranks() {
    let sets = [
        "boundary.foot=",
        "body.plate.material={ kind = 'rigid', density = 1500.0 }",
        "system.plate.scheme={ kind = 'total_lagrangian' }",
        "body.plate.shape.min=[0.5, 0.1]",
        "body.plate.initial={ velocity = ['-25 * (y - 0.35)', '25 * (x - 0.575)'] }",
        "time.end=0.04",
    ];
    same_on_any_number(TANK, &sets);
}

/// A floor that stands is known to all ranks, and told no more; its surface runs.
#[test]
fn solids_on_a_floor_that_stands_are_the_same_on_any_number_of_ranks() {
    let sets = [
        "boundary.floor=",
        "body.floor.wall.sliding={ x = '2 * sin(90 * t)' }",
        "scheme.shifting='ipst'",
        "time.end=0.02",
    ];
    same_on_any_number(TANK, &sets);
}

/// A beam behind a cylinder, in a stream that enters and leaves.
#[test]
fn a_beam_in_a_stream_is_the_same_on_any_number_of_ranks() {
    let beam = include_str!("../../../../cases/open/turek-hron/case.toml");
    let sets = [
        "parameters.length=0.8",
        "body.inlet.opening={ normal = [1.0, 0.0], velocity = ['0.8', '0'] }",
        "time.end=0.03",
        "output.every=0.015",
        "output.table_every=0.005",
    ];
    let left = same_on_any_number(beam, &sets);
    let Some(Series::Curve { values, .. }) = left.finished.quantity("step.entered") else {
        panic!("the mass is a curve");
    };
    assert!(values.iter().any(|mass| *mass > 0.0), "particles enter");
    // Nothing leaves, and few wait.
    let closed = "body.outlet.opening={ normal = [-1.0, 0.0], velocity = ['0', '0'] }";
    let few = [&sets[..], &[closed, "scheme.reserve=1"]].concat();
    let notes = same_on_any_number(beam, &few).finished.notes;
    assert!(notes.iter().any(|note| note.contains("the reserve ran out")), "{notes:?}");
}

/// A gate that opens, and a plate under the weight of water.
#[test]
fn gates_and_plates_are_the_same_on_any_number_of_ranks() {
    let gate = include_str!("../../../../cases/coupled/gate/case.toml");
    same_on_any_number(gate, &["parameters.across=2", "time.end=1e-3", "output.every=1e-3"]);
    let plate = include_str!("../../../../cases/coupled/plate/case.toml");
    let coarse = ["parameters.across=1", "parameters.layers=3", "time.end=3e-3"];
    same_on_any_number(plate, &coarse);
}

const SLAB: &str = include_str!("../../../../cases/coupled/slab/case.toml");

/// A slab of each kind: with several steps of its own in one of the water, and the other way round.
#[test]
fn slabs_of_each_kind_are_the_same_on_any_number_of_ranks() {
    let short = ["parameters.n=10", "time.end=0.1", "output.every=0.05"];
    let upwind = [
        "system.slab.scheme={ kind = 'upwind', smoothing_length = 0.7, tau_velocity = 0.5 }",
        "system.slab.time={ integrator = 'tvd_rk2' }",
        "body.slab.material={ kind = 'gamma_law', density = 'ratio * rho', bulk_modulus = '25 * ratio * rho * c^2', gamma = 2.0 }",
    ];
    let flowing = [
        "system.slab.scheme={ kind = 'transport_velocity' }",
        "body.slab.material={ kind = 'hypoelastic', density = 'ratio * rho', young_modulus = '25 * ratio * rho * c^2', poisson_ratio = 0.0 }",
    ];
    let heavy = ["parameters.ratio=100", "body.slab.material.young_modulus=100.0"];
    // The water takes steps of its own round a heavy slab, and the others in one of the water.
    for (kind, system) in [(&upwind[..], 1), (&flowing, 1), (&heavy, 0)] {
        let alone = same_on_any_number(SLAB, &[&short[..], kind].concat()).finished;
        let steps = alone.own_steps[system].1;
        assert!(steps >= 2 * alone.summary.steps, "{kind:?}: {:?}", alone.own_steps);
    }
}

/// A rigid box in water in space.
#[test]
fn a_box_that_floats_is_the_same_on_any_number_of_ranks() {
    let floating = include_str!("../../../../cases/coupled/floating-box/case.toml");
    same_on_any_number(floating, &["parameters.n=4", "time.end=0.04"]);
}

/// A plate with too long steps of its own: the run goes back, and goes on with shorter ones of all systems.
#[test]
fn a_run_that_goes_back_is_the_same_on_any_number_of_ranks() {
    let sets = [
        "time.on_failure='retry'",
        "system.plate.time={ cfl = 1.5 }",
        "body.plate.material.young_modulus=1e8",
        "time.end=0.02",
        "output.every=0.02",
    ];
    let alone = same_on_any_number(TANK, &sets).finished;
    assert!(!alone.summary.retries.is_empty(), "it goes back");
}

/// A block that goes through a floor which is too soft is told in the same words, after as many attempts with shorter
/// steps.
#[test]
fn what_goes_wrong_in_a_tank_is_the_same_on_any_number_of_ranks() {
    let sets = [
        "body.block.initial.velocity=['0', '-20']",
        "system.block.contact_stiffness=0.01",
        "time.on_failure='retry'",
        "time.retries=2",
    ];
    let told = failure(TANK, &sets, 1, 2);
    assert!(told.contains("Surface"), "{told}");
    assert_eq!(failure(TANK, &sets, 3, 2), told);
    // Water that goes through the floor is on one of the ranks.
    let fast = ["scheme.escaped='stop'", "body.right.initial.velocity=['0', '-60']"];
    let told = failure(TANK, &fast, 1, 0);
    assert!(told.contains("Wall(\"floor\")"), "{told}");
    assert_eq!(failure(TANK, &fast, 3, 0), told);
}
