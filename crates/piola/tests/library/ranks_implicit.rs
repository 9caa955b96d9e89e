//! Runs whose equations several ranks solve together, compared with those of one.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use super::ranks::{BLOCK, PLATE, failure, same_on_any_number};
use super::ranks_coupled::TANK;

const KRYLOV: &str = "time.linear_solver='krylov'";

/// Implicit steps of two plates.
const STEPS: [&str; 5] =
    [KRYLOV, "time.integrator='newmark'", "time.step=1e-3", "time.end=0.012", "output.every=0.006"];

#[test]
fn implicit_steps_of_displacements_are_the_same_on_any_number_of_ranks() {
    let alone = same_on_any_number(PLATE, &STEPS).finished;
    let costs = alone.linear.expect("equations are solved");
    assert!(!costs.direct && costs.steps > 20, "{costs:?}");
    // The equations are not symmetric, and the plates have images.
    let pressure = "load.pull={ kind = 'pressure', body = 'plate', where = { kind = 'plane', point = [2.0, 0.0], normal = [1.0, 0.0] }, \
                    pressure = '4e3 * (1 + y)' }";
    let mirrored = [
        pressure,
        "boundary+={ name = 'bottom', where = { kind = 'plane', point = [0.0, 0.0], normal = [0.0, -1.0] }, \
         velocity = { y = '0' }, mirror = true }",
        "boundary.wall.velocity={ x = '0.2 * sin(20 * t)' }",
        "body.other.shape={ kind = 'box', min = [3.0, 0.0], max = [3.6, 0.7] }",
        "body.other.lattice={}",
    ];
    same_on_any_number(PLATE, &[&STEPS[..], &mirrored].concat());
}

/// Steps are as long as their error allows, and some are taken again.
#[test]
fn steps_with_a_bound_on_their_error_are_the_same_on_any_number_of_ranks() {
    let sets = [
        &STEPS[..],
        &["time.error=1e-4", "time.step=0.004", "time.integrator='generalised_alpha'"],
    ]
    .concat();
    let [shortest, longest] = same_on_any_number(PLATE, &sets).finished.summary.step_range;
    assert!(longest > 1.5 * shortest, "{shortest} {longest}");
}

/// What is held and pulled in space, by load steps.
#[test]
fn statics_is_the_same_on_any_number_of_ranks() {
    let tension = include_str!("../../../../cases/dual-support/tension/case.toml");
    let sets = [
        KRYLOV,
        "parameters.dx=0.5",
        "time.step=0.1",
        "body.beam.material={ kind = 'neo_hookean', density = 7850.0, young_modulus = '30 * stress', poisson_ratio = 'nu' }",
    ];
    let alone = same_on_any_number(tension, &sets).finished;
    assert!(alone.linear.is_some_and(|costs| !costs.direct && costs.steps > 20));
}

/// An arch snaps through, with a warning where loads grow, and along the path of equilibria.
#[test]
fn a_snap_through_is_the_same_on_any_number_of_ranks() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/dual-support/arch/");
    let arch = include_str!("../../../../cases/dual-support/arch/case.toml");
    let mesh = format!("body.arch.shape.file='{folder}arch-909.msh'");
    let sets = [KRYLOV, &mesh, "time.end=1.0", "output.every=0.5", "picture="];
    same_on_any_number(arch, &sets);
    let jump = ["time.integrator='static'", "time.end=1.2", "time.step=0.1", "plot=", "check="];
    let alone = same_on_any_number(arch, &[&sets[..], &jump].concat()).finished;
    let warnings = &alone.summary.warnings;
    assert!(warnings.iter().any(|warning| warning.contains("snap-through")), "{warnings:?}");
}

#[test]
fn implicit_steps_of_upwind_are_the_same_on_any_number_of_ranks() {
    let steps = [KRYLOV, "time.integrator='crank_nicolson'", "time.step=0.01", "time.end=0.11"];
    // With volume ratios among the unknowns, and without.
    same_on_any_number(BLOCK, &[&steps[..], &["body.block.spacing=0.15"]].concat());
    let plain = ["scheme.tau_pressure=0.0", "time.integrator='backward_euler'"];
    let alone = same_on_any_number(BLOCK, &[&steps[..], &plain].concat()).finished;
    assert!(alone.linear.is_some_and(|costs| !costs.direct && costs.steps > 20));
}

/// A solid in water that solves for its steps does so on each rank.
#[test]
fn a_solid_in_implicit_steps_in_water_is_the_same_on_any_number_of_ranks() {
    let sets = [
        "system.plate.time={ integrator = 'newmark' }",
        "time.end=0.02",
        "output.every=0.02",
        "output.table_every=0.001",
    ];
    same_on_any_number(TANK, &sets);
}

/// A solid in water that finds no state ends the run, or lets it go back, in the middle of a step of all.
#[test]
fn a_solid_in_water_without_a_solution_is_the_same_on_any_number_of_ranks() {
    let sets = [
        "system.plate.time={ integrator = 'newmark', tolerance = 1e-13 }",
        "body.plate.initial={ velocity = ['4e3 * (y - 0.1)', '0'] }",
        "time.max_speed=1e9",
        "time.on_failure='retry'",
        "time.retries=2",
    ];
    let told = failure(TANK, &sets, 1, 2);
    assert_eq!(failure(TANK, &sets, 3, 2), told);
}

/// Equations without a solution are told in the same words, after as many attempts with shorter steps.
#[test]
fn steps_without_a_solution_are_the_same_on_any_number_of_ranks() {
    let sets = [
        &STEPS[..],
        &[
            "load.pull.traction=['-1e9 * t', '0']",
            "time.step=0.004",
            "time.on_failure='retry'",
            "time.retries=2",
        ],
    ]
    .concat();
    let told = failure(PLATE, &sets, 1, 2);
    assert_eq!(failure(PLATE, &sets, 3, 2), told);
}
