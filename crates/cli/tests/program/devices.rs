use crate::support::{Place, assert_contains};

/// Sound in a periodic tube.
const TUBE: &str = r#"
version = 1
title = "Sound in a tube"
dimension = 1

[domain]
periodic = { x = [0.0, 1.0] }

[[body]]
name = "gas"
shape = { kind = "box", min = [0.0], max = [1.0] }
spacing = 0.1
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1.0, wave_speed = 10.0, viscosity = 0.01 }
initial = { velocity = ["sin(2 * pi * x)"] }

[scheme]
kind = "transport_velocity"

[compute]
device = "cuda:99"

[time]
end = 0.1

[output]
every = 0.1
table_every = 0.1
"#;

/// The acceleration changes the velocity of what is not a wall.
const KICK: &str = r#"/* 4 operations */
LAW void kick_velocities_law(real duration, real velocity_0, real kick_0, real wall_0, real *new_velocity_0)
{
    const real t4 = kick_0 * duration;
    const real t5 = velocity_0 + t4;
    const int t7 = wall_0 < 0.5;
    const real t8 = t7 ? t5 : velocity_0;
    *new_velocity_0 = t8;
}
KERNEL void kick_velocities(const int n, const real duration, GLOBAL real *__restrict__ velocity, GLOBAL const real *__restrict__ kick, GLOBAL const real *__restrict__ wall)
{
    EACH(a, n) {
        const real velocity_0 = velocity[a];
        const real kick_0 = kick[a];
        const real wall_0 = wall[a];
        real new_velocity_0;
        kick_velocities_law(duration, velocity_0, kick_0, wall_0, &new_velocity_0);
        velocity[a] = new_velocity_0;
    }
}
"#;

fn tube() -> Place {
    let place = Place::new();
    place.write("tube/case.toml", TUBE);
    place
}

#[test]
fn the_passes_of_a_case_are_shown_without_a_device() {
    let (table, _) = tube().run("devices show tube/case.toml", 0);
    let row = |pass: &str| {
        let mut rows = table.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        rows.find(|cells| cells.contains(&pass)).unwrap_or_else(|| panic!("{pass}: {table}"))
    };
    // Velocity, acceleration and wall are read and the velocity is written: 4 numbers of 8 bytes.
    let columns = ["velocity", "kick", "wall", "velocity"];
    assert_eq!(
        row("kick_velocities"),
        [&["kick", "kick_velocities", "4", "32"], &columns[..]].concat()
    );
    assert_eq!(row("advance")[0], "move");
    let forces = row("forces");
    assert_eq!(forces[..2], ["forces", "forces"]);
    // The place and a side of 6 numbers of each neighbour, with its index of 4 bytes.
    assert_eq!(forces[5], "60", "{forces:?}");
    for absent in ["hold_off", "fall", "tell_escaped", "densities", "crowd"] {
        assert!(!table.contains(absent), "{absent}: {table}");
    }
}

#[test]
fn bounds_follow_from_data_sheets() {
    let (table, _) = tube().run("devices bounds tube/case.toml", 0);
    let row = table.lines().find(|line| line.contains("kick_velocities"));
    let cells: Vec<&str> = row.expect("it is listed").split_whitespace().collect();
    // A product and a sum of 32 bytes: 32 MB for a million particles, at 3.35, 4.8, 2.039, 1.008, 1.638 and 5.3 TB/s.
    let times = ["0.010", "0.007", "0.016", "0.032", "0.020", "0.006"];
    let counts = ["kick", "kick_velocities", "1", "1", "0", "0", "0", "32"];
    assert_eq!(cells, [&counts[..], &times].concat());
    assert_contains(&table, &["neighbours per particle", "nothing is measured"]);
    tube().run("devices bounds tube/case.toml --precision half", 2);
}

#[test]
fn the_text_of_a_stage_is_shown_in_each_language() {
    let place = tube();
    let of = |arguments: &str| place.run(&format!("devices show tube/case.toml {arguments}"), 0).0;
    assert_eq!(of("kick"), KICK);
    assert_eq!(of("kick_velocities --language cuda"), KICK);
    // These have no word for pointers that nothing else points to.
    assert_eq!(of("kick --language opencl"), KICK.replace("__restrict__ ", ""));
    assert_eq!(of("kick --language c"), KICK.replace("__restrict__ ", ""));
    // With pairs in single precision a neighbour shows half the bytes, and its place as a whole number of 4 bytes.
    let table = of("--precision single");
    let forces = table.lines().find(|line| line.starts_with("forces")).expect("it has forces");
    assert!(forces.split_whitespace().any(|cell| cell == "32"), "{forces}");
    // By eight threads and by one.
    assert_contains(&of("forces"), &["KERNEL void forces(", "__shfl_down_sync"]);
    assert_contains(&of("forces --language c"), &["EACH(a, n) if (passive[numbers[a]] == 0)"]);
}

#[test]
fn what_has_no_text_is_told_with_what_has() {
    let place = tube();
    let refused = |arguments: &str| place.run(&format!("devices show {arguments}"), 2).1;
    let there =
        "one of the stages kick, load, rates, move, equation_of_state, forces, shift, store, look";
    assert_contains(&refused("tube/case.toml boil"), &["neither a stage nor a pass `boil`", there]);
    let falls = "--set load+={kind='body_force',acceleration=['t']}";
    let text = refused(&format!("tube/case.toml body_forces {falls}"));
    assert_contains(&text, &["the stage `body_forces` has no pass of its own on a device"]);
    let text = refused("tube/case.toml --set scheme.shifting='ipst'");
    assert_contains(&text, &["the stage `iterate` does not run on devices yet"]);
    place.write("bar/case.toml", crate::support::BAR);
    let text = refused("bar/case.toml --set time.integrator='backward_euler' --set time.step=0.01");
    assert_contains(&text, &["the integrator `backward_euler` does not run on devices"]);
    refused("tube/case.toml kick --language fortran");
}
