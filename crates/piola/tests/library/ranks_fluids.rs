//! Fluids, and solids whose particles find new neighbours, that several ranks share, compared with those of one.
//!
//! Runs are so long that the lists of neighbours are renewed several times, and with them the plan of copies.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use piola::observe::Series;

use super::ranks::{failure, same_on_any_number};
use super::reserve::FILLING;

const VORTICES: &str = include_str!("../../../../cases/ctvf/taylor-green/case.toml");

/// 400 particles that move by six skins.
const SHORT: [&str; 3] = ["parameters.side=20", "time.end=0.1", "output.every=0.05"];

#[test]
fn vortices_are_the_same_on_any_number_of_ranks() {
    same_on_any_number(VORTICES, &SHORT);
    let integrated = ["scheme.density='continuity'", "scheme.artificial_viscosity=0.1"];
    same_on_any_number(VORTICES, &[&SHORT[..], &integrated].concat());
    let algebraic = ["scheme.density='continuity'", "scheme.pressure='state_equation'"];
    same_on_any_number(VORTICES, &[&SHORT[..], &algebraic].concat());
}

#[test]
fn all_ways_to_spread_particles_are_the_same_on_any_number_of_ranks() {
    for shifting in ["ipst", "background", "none"] {
        let shifting = format!("scheme.shifting='{shifting}'");
        same_on_any_number(VORTICES, &[&SHORT[..], &[shifting.as_str()]].concat());
    }
}

#[test]
fn vortices_in_space_are_the_same_on_any_number_of_ranks() {
    let vortices = include_str!("../../../../cases/ctvf/taylor-green-3d/case.toml");
    same_on_any_number(vortices, &["parameters.side=8", "time.end=0.4", "output.every=0.2"]);
}

#[test]
fn a_driven_cavity_is_the_same_on_any_number_of_ranks() {
    let cavity = include_str!("../../../../cases/ctvf/cavity/case.toml");
    same_on_any_number(cavity, &["parameters.side=16", "time.end=0.3", "output.every=0.1"]);
}

const DAM: &str = include_str!("../../../../cases/ctvf/dam-break/case.toml");

/// A tank of whose walls the water reaches the end.
const LOW: [&str; 5] = [
    "parameters.dx=0.1",
    "parameters.walls=2.1",
    "parameters.length=2.0",
    "time.end=1.15",
    "output.every=0.5",
];

/// Walls that are touched, a free surface, and drops that fly over the end of a wall and are taken out.
#[test]
fn a_dam_break_is_the_same_on_any_number_of_ranks() {
    same_on_any_number(DAM, &LOW);
    same_on_any_number(DAM, &[&LOW[..], &["scheme.shifting='ipst'", "time.end=0.2"]].concat());
    let damped = ["scheme.damping='x'", "scheme.escaped='stop'", "time.end=0.1"];
    same_on_any_number(DAM, &[&LOW[..], &damped].concat());
}

/// A particle that escapes, and one that is pulled by what is no number, are told in the same words.
#[test]
fn what_goes_wrong_in_a_fluid_is_the_same_on_any_number_of_ranks() {
    let escaped = [&LOW[..], &["scheme.escaped='stop'"]].concat();
    let told = failure(DAM, &escaped, 1, 0);
    assert!(told.contains("Escaped"), "{told}");
    assert_eq!(failure(DAM, &escaped, 3, 0), told);
    let pull = "load+={ kind = 'body_force', acceleration = ['sqrt(0.05 - t) * x', '0'] }";
    let pulled = [&LOW[..], &[pull]].concat();
    let told = failure(DAM, &pulled, 1, 0);
    assert!(told.contains("NotFinite"), "{told}");
    assert_eq!(failure(DAM, &pulled, 4, 0), told);
}

#[test]
fn solids_that_flow_are_the_same_on_any_number_of_ranks() {
    let bar = include_str!("../../../../cases/ctvf/taylor-bar/case.toml");
    same_on_any_number(bar, &["parameters.across=4", "time.end=20e-6", "output.every=10e-6"]);
}

/// What is prescribed of solids takes work that is added up particle by particle.
#[test]
fn a_rod_that_is_pulled_is_the_same_on_any_number_of_ranks() {
    let rod = include_str!("../../../../cases/ctvf/johnson-cook/case.toml");
    let pull = "boundary.all.velocity={ x = 'rate * x * (1 + 1e5 * t)' }";
    same_on_any_number(rod, &["parameters.dx=0.0001", "parameters.end=1e-6", pull]);
}

/// Particles enter and leave, and of both openings some ranks have a part of the buffer and others none.
#[test]
fn a_channel_is_the_same_on_any_number_of_ranks() {
    let channel = include_str!("../../../../cases/open/channel/case.toml");
    let short = ["parameters.across=10", "time.end=0.5", "output.every=0.25"];
    let left = same_on_any_number(channel, &short);
    for name in ["step.entered", "step.left"] {
        let Some(Series::Curve { values, .. }) = left.finished.quantity(name) else {
            panic!("{name}")
        };
        // Several rows of particles.
        assert!(*values.last().unwrap() > 0.2, "{name}: {values:?}");
    }
    let shifted = [&short[..], &["scheme.shifting='ipst'", "time.end=0.2"]].concat();
    same_on_any_number(channel, &shifted);
}

/// Fluid goes through a duct in space, whose inlet pulsates, and out of its roof, too.
#[test]
fn a_duct_in_space_is_the_same_on_any_number_of_ranks() {
    let left = same_on_any_number(DUCT, &[]);
    let Some(Series::Curve { values, .. }) = left.finished.quantity("step.entered") else {
        panic!("the mass is a curve")
    };
    assert!(values.windows(2).filter(|pair| pair[0] < pair[1]).count() > 2, "{values:?}");
}

const DUCT: &str = r#"
version = 1
title = "A duct"
dimension = 3
[parameters]
dx = 0.1
[domain]
periodic = { y = [0.0, 0.8] }
[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0, 0.0], max = [1.0, 0.8, 0.4] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 2.0, wave_speed = 20.0, viscosity = 0.02 }
initial = { velocity = ["1", "0.1 * sin(9 * x)", "0"] }
[[body]]
name = "inlet"
shape = { kind = "box", min = [-0.4, 0.0, 0.0], max = [0.0, 0.8, 0.4] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 2.0, wave_speed = 20.0, viscosity = 0.02 }
opening = { normal = [1.0, 0.0, 0.0], velocity = ["1 + 0.5 * sin(20 * t)", "0", "0"] }
[[body]]
name = "outlet"
shape = { kind = "box", min = [1.0, 0.0, 0.0], max = [1.4, 0.8, 0.4] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 2.0, wave_speed = 20.0, viscosity = 0.02 }
opening = { normal = [-1.0, 0.0, 0.0], pressure = "0.1 * t" }
[[body]]
name = "vent"
shape = { kind = "box", min = [0.4, 0.0, 0.4], max = [0.8, 0.8, 0.8] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 2.0, wave_speed = 20.0, viscosity = 0.02 }
opening = { normal = [0.0, 0.0, -1.0], pressure = "0" }
[[body]]
name = "walls"
shape = { kind = "union", of = [
  { kind = "box", min = [-0.4, 0.0, -0.4], max = [1.4, 0.8, 0.0] },
  { kind = "box", min = [-0.4, 0.0, 0.4], max = [0.4, 0.8, 0.8] },
  { kind = "box", min = [0.8, 0.0, 0.4], max = [1.4, 0.8, 0.8] },
] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 2.0, wave_speed = 20.0, viscosity = 0.02 }
wall = {}
[scheme]
kind = "transport_velocity"
[time]
end = 0.4
[output]
every = 0.2
table_every = 0.05
"#;

/// A run that fails after particles have entered goes back before some of them did, and then ends in the same words.
#[test]
fn what_goes_wrong_in_a_tank_that_is_filled_is_the_same_on_any_number_of_ranks() {
    let late = "load+={ kind = 'body_force', acceleration = ['0 * sqrt(0.2 - t)', '0'] }";
    let sets = ["scheme.reserve=3", late];
    let told = failure(FILLING, &sets, 1, 2);
    assert!(told.contains("NotFinite"), "{told}");
    assert_eq!(failure(FILLING, &sets, 3, 2), told);
    assert_eq!(failure(FILLING, &sets, 2, 2), told);
}

/// Fluid falls into a tank, with enough particles in reserve and with so few that the run is built anew.
#[test]
fn a_tank_that_is_filled_is_the_same_on_any_number_of_ranks() {
    let enough = same_on_any_number(FILLING, &["scheme.reserve=400", "time.end=0.4"]);
    let grown = same_on_any_number(FILLING, &["scheme.reserve=3", "time.end=0.4"]);
    assert_eq!(enough.finished.notes.len(), 0);
    assert!(grown.finished.notes[0].contains("the reserve ran out"));
}
