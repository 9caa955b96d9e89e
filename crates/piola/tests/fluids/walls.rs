//! Walls: what slips along them, what sticks to them, and water at rest between them.

use piola::time::Outcome;

use super::escapes::{run, values};

/// Fluid that flows along a channel.
const CHANNEL: &str = r#"
version = 1
title = "A fluid flows between two plates"
dimension = 2

[parameters]
jitter = 0.0

[domain]
periodic = { x = [0.0, 0.5] }

[[body]]
name = "fluid"
shape = { kind = "box", min = [0.0, 0.0], max = [0.5, 0.5] }
spacing = 0.05
lattice = { on = "cells", jitter = "jitter" }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 10.0, viscosity = 0.1 }
initial = { velocity = ["1", "0"] }

[[body]]
name = "plates"
shape = { kind = "union", of = [{ kind = "box", min = [0.0, -0.15], max = [0.5, 0.0] }, { kind = "box", min = [0.0, 0.5], max = [0.5, 0.65] }] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 10.0, viscosity = 0.1 }
wall = { slip = "free" }

[scheme]
kind = "transport_velocity"

[time]
end = 0.1

[[probe]]
name = "plates"
kind = "sum"
body = "plates"
field = "force"

[output]
table_every = 0.01
"#;

#[test]
fn a_fluid_slips_along_a_free_slip_wall() {
    for (jitter, most) in [("0.0", 1e-4), ("0.1", 0.01)] {
        let finished = run(CHANNEL, &[&format!("parameters.jitter={jitter}")]);
        assert_eq!(finished.summary.outcome, Outcome::Completed);
        let momentum = values(&finished, "momentum.linear.x");
        let last = momentum.last().expect("there are rows");
        // What is left is how particles that even out their distances rub against the wall; a wall
        // without slip takes more than a third of the momentum, see below.
        assert!((last / 0.25 - 1.0).abs() < most, "{last}");
    }
}

#[test]
fn a_fluid_sticks_to_a_no_slip_wall() {
    let finished = run(CHANNEL, &["body.plates.wall.slip='no'"]);
    let momentum = values(&finished, "momentum.linear.x");
    let last = momentum.last().expect("there are rows");
    // Plane flow that comes to rest: mean speed sum 8 / (n pi)^2 exp(-nu (n pi / L)^2 t), odd n.
    let modes = (0..50).map(|k| {
        let wave = f64::from(2 * k + 1) * std::f64::consts::PI;
        8.0 / (wave * wave) * (-0.1 * (wave / 0.5).powi(2) * 0.1).exp()
    });
    let expected = 0.25 * modes.sum::<f64>();
    assert!(expected < 0.25 * 0.66);
    assert!((last / expected - 1.0).abs() < 0.03, "{last} instead of {expected} kg m/s");
}

/// Water in a tank under its weight.
const TANK: &str = r#"
version = 1
title = "Water stands in a tank"
dimension = 2

[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [0.5, 0.5] }
spacing = 0.05
lattice = { on = "cells", jitter = 0.02 }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
initial = { pressure = "9810 * (0.5 - y)" }

[[body]]
name = "tank"
shape = { kind = "difference", from = { kind = "box", min = [-0.15, -0.15], max = [0.65, 0.6] }, remove = [{ kind = "box", min = [0.0, 0.0], max = [0.5, 1.0] }] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
wall = { slip = "free" }

[scheme]
kind = "transport_velocity"
artificial_viscosity = 0.05
free_surface = true
shifting = "ipst"

[[load]]
kind = "body_force"
acceleration = ["0", "-9.81"]

[[probe]]
name = "tank"
kind = "sum"
body = "tank"
field = "force"

[[probe]]
name = "pressure"
kind = "error"
body = "water"
field = "pressure"
exact = "9810 * (0.5 - y)"

[time]
end = 1.0

[output]
table_every = 0.05
"#;

#[test]
fn iterated_shifting_keeps_water_at_rest_between_walls() {
    let finished = run(TANK, &[]);
    assert_eq!(finished.summary.outcome, Outcome::Completed);
    let passes = values(&finished, "step.shifting_passes");
    assert!(passes.iter().any(|passes| *passes >= 1.0), "it shifts: {passes:?}");
    let error = *values(&finished, "pressure.error").last().expect("there are rows");
    assert!(error < 0.02, "pressure off by {error}");
    let force = *values(&finished, "tank.force.y").last().expect("there are rows");
    let weight = 9810.0 * 0.25;
    assert!((force / -weight - 1.0).abs() < 0.02, "{force} N of a weight of {weight} N");
}

/// A jet of 1 m x 1 m x 0.5 m that hits a pillar of half its width, until its films along the walls are
/// thinner than a particle.
const JET: &str = r#"
version = 1
title = "A jet parts at a pillar"
dimension = 3

[[body]]
name = "jet"
shape = { kind = "box", min = [-1.0, -0.5, 0.0], max = [0.0, 0.5, 0.5] }
spacing = 0.125
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 70.0, viscosity = 0.0 }
initial = { velocity = ["7", "0", "0"] }

[[body]]
name = "pillar"
shape = { kind = "box", min = [0.0, -0.25, -1.0], max = [0.5, 0.25, 1.5] }
spacing = 0.125
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 70.0, viscosity = 0.0 }
wall = { slip = "free" }

[scheme]
kind = "transport_velocity"
artificial_viscosity = 0.05
free_surface = true

[time]
end = 0.06

[output]
table_every = 0.02
"#;

#[test]
fn a_jet_parts_at_the_edges_of_a_pillar() {
    // What goes through a wall ends the run: with normals halfway between the sides behind the
    // edges it did so at 0.031 s.
    for slip in ["free", "no"] {
        let finished = run(JET, &[&format!("body.pillar.wall.slip='{slip}'")]);
        assert_eq!(finished.summary.outcome, Outcome::Completed, "{slip}");
        let behind = values(&finished, "step.behind");
        assert!(behind.iter().all(|count| *count == 0.0), "{slip}: {behind:?}");
    }
}

/// A jet that hits a wall which moves towards it or not, until its films are thinner than a particle.
const FILM: &str = r#"
version = 1
title = "A jet on a wall"
dimension = 2

[[body]]
name = "jet"
shape = { kind = "box", min = [-0.24, -0.04], max = [0.0, 0.04] }
spacing = 0.01
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 800.0, wave_speed = 30.0, viscosity = 0.0 }
initial = { velocity = ["3", "0"] }

[[body]]
name = "wall"
shape = { kind = "box", min = [0.0, -0.8], max = [0.04, 0.8] }
spacing = 0.01
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 800.0, wave_speed = 30.0, viscosity = 0.0 }
wall = { slip = "free" }

[scheme]
kind = "transport_velocity"
artificial_viscosity = 0.05
free_surface = true

[time]
end = 0.12

[output]
table_every = 0.002
"#;

#[test]
fn films_stay_in_front_of_walls() {
    let settings: [&[&str]; 5] = [
        &[],
        &["body.wall.wall.slip='no'", "scheme.smoothing_length=1.3"],
        &["scheme.shifting='ipst'"],
        &["scheme.shifting='none'", "scheme.pressure='state_equation'"],
        &["scheme.artificial_viscosity=0.2", "scheme.corrections='none'"],
    ];
    for set in settings {
        let finished = run(FILM, set);
        assert_eq!(finished.summary.outcome, Outcome::Completed, "{set:?}");
        let behind = values(&finished, "step.behind");
        assert!(behind.iter().all(|count| *count == 0.0), "{set:?}: {behind:?}");
        // 800 * 3 * 0.24 * 0.08 = 46 kg m/s, and 69 J.
        for (name, most) in [("momentum.balance.linear.x", 1e-10), ("energy.balance", 1e-9)] {
            let balance = values(&finished, name).iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            assert!(balance < most, "{set:?}: {name} {balance:e}");
        }
    }
}

#[test]
fn a_particle_that_touches_a_wall_comes_to_rest_in_front_of_it() {
    // One particle, a fifth of the wave speed towards the wall and pulled on: it stops after u dx/c, a fifth of a
    // spacing, from a quarter of a spacing on. Pressures of single particles of the wall push it along a little.
    let drop = [
        "body.jet.shape.min=[-0.02, 0.0]",
        "body.jet.shape.max=[-0.01, 0.01]",
        "body.jet.initial.velocity=['6', '1']",
        "scheme.free_surface=false",
        "scheme.shifting='none'",
        "scheme.pressure='state_equation'",
        "time.end=0.02",
    ];
    let wall = "load+={ kind = 'body_force', acceleration = ['9', '0'] }";
    let finished = run(FILM, &[&drop[..], &[wall]].concat());
    assert_eq!(finished.summary.outcome, Outcome::Completed);
    assert!(values(&finished, "step.behind").iter().all(|count| *count == 0.0));
    let speed = *values(&finished, "momentum.linear.y").last().expect("there are rows") / 0.08;
    assert!((speed - 1.0).abs() < 0.02, "nothing holds it along the wall: {speed}");
}

/// With an odd number of particles across one is on the axis of the bar, and its neighbours flow out to all sides.
/// Nothing but (80) stops it: after 12 us it was 0.6 spacings behind the face.
#[test]
fn the_axis_of_a_flattened_bar_stays_in_front_of_the_wall() {
    let bar = include_str!("../../../../cases/ctvf/taylor-bar/case.toml");
    let finished = run(bar, &["parameters.across=5", "time.end=20e-6"]);
    assert_eq!(finished.summary.outcome, Outcome::Completed);
    let bottom = values(&finished, "bottom.position.z");
    assert!(bottom.iter().all(|z| *z > 0.0), "{bottom:?}");
}

/// Fluid between two cylinders of radii 1/2 and 1, of which the surface of the inner one runs with 1/2: between them
/// `u = (1/r - r)/3`, and the outer one has the moment `4 pi mu/3`.
const CYLINDERS: &str = r#"
version = 1
title = "Fluid between two cylinders"
dimension = 2

[parameters]
dx = 0.05

[[body]]
name = "fluid"
shape = { kind = "annulus", center = [0.0, 0.0], inner = 0.5, outer = 1.0 }
spacing = "dx"
lattice = { kind = "concentric", on = "cells" }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 5.0, viscosity = 0.1 }
initial = { velocity = ["-(1/(x^2 + y^2) - 1)/3*y", "(1/(x^2 + y^2) - 1)/3*x"] }

[[body]]
name = "outer"
shape = { kind = "annulus", center = [0.0, 0.0], inner = 1.0, outer = "1 + 4*dx" }
spacing = "dx"
lattice = { kind = "concentric", on = "cells" }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 5.0, viscosity = 0.1 }
wall = {}

[[body]]
name = "inner"
shape = { kind = "ball", center = [0.0, 0.0], radius = 0.5 }
spacing = "dx"
lattice = { kind = "concentric", on = "cells" }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 5.0, viscosity = 0.1 }
wall = { sliding = { x = "-y", y = "x" } }

[scheme]
kind = "transport_velocity"

[time]
end = 1.0

[[probe]]
name = "outer"
kind = "force"
body = "outer"

[[probe]]
name = "error"
kind = "error"
body = "fluid"
field = "velocity"
norm = "square"
components = { x = "-(1/(x^2 + y^2) - 1)/3*y", y = "(1/(x^2 + y^2) - 1)/3*x" }

[output]
table_every = 0.1
"#;

/// Slow modes have died out by `exp(-nu (pi/gap)^2)`, a fiftieth, at the end. A spacing is a tenth of the gap, and
/// half of one is what a lattice does not know of a wall: 5 %.
#[test]
fn layers_follow_round_walls() {
    let exact = 0.1 * 4.0 * std::f64::consts::PI / 3.0;
    let [rings, lattice] = ["concentric", "square"].map(|kind| {
        let finished = run(&CYLINDERS.replace("concentric", kind), &[]);
        assert_eq!(finished.summary.outcome, Outcome::Completed);
        let moment = values(&finished, "outer.moment.z").pop().expect("there are rows");
        let error = values(&finished, "error.error").pop().expect("there are rows");
        assert!((moment / exact - 1.0).abs() < 0.05 && error < 0.05, "{kind}: {moment}, {error}");
        error
    });
    assert!(rings < lattice, "{rings} by rings, {lattice} by a lattice");
}
