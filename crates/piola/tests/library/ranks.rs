//! Runs that several ranks share, compared with those of one.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use piola::case::{self, LoadOptions, Session};

/// What a run leaves: its tables, and every column of its last state.
fn run(
    text: &str,
    set: &[&str],
    ranks: usize,
    threads: usize,
) -> (String, Vec<(String, Vec<u64>)>) {
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
        assert!(finished.summary.steps > 20, "{} steps", finished.summary.steps);
        let fields = session.scheme().description().fields;
        let columns = fields.iter().map(|field| {
            let values = session.column(field.name).unwrap().values;
            (field.name.to_owned(), values.iter().map(|value| value.to_bits()).collect())
        });
        let columns = columns.collect();
        (format!("{:?}", finished.tables), columns)
    })
}

/// The same bits on any number of ranks, with one thread each and with several.
fn same_on_any_number(text: &str, set: &[&str]) {
    let alone = run(text, set, 1, 1);
    for (ranks, threads) in [(2, 1), (2, 4), (3, 1), (4, 8), (7, 7)] {
        let shared = run(text, set, ranks, threads);
        assert!(alone.0 == shared.0, "{set:?}: tables on {ranks} ranks differ");
        for (one, other) in alone.1.iter().zip(&shared.1) {
            assert!(one == other, "{set:?}: {} on {ranks} ranks differs", one.0);
        }
    }
}

/// A plate that is pulled, pressed, held and falls, beside another one.
const PLATE: &str = r#"
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

#[test]
fn mirrors_are_the_same_on_any_number_of_ranks() {
    // Below the plane that moves there is another that does not.
    let sets = [
        "boundary+={ name = 'bottom', body = 'plate', where = { kind = 'plane', point = [0.0, 0.0], normal = [0.0, -1.0] }, \
         velocity = { y = '0.1 * sin(30 * t)' }, mirror = true }",
        "boundary+={ name = 'top', body = 'plate', where = { kind = 'plane', point = [0.0, 0.7], normal = [0.0, 1.0] }, \
         velocity = { y = '0' }, mirror = true }",
        "boundary.wall.velocity={ x = '0.2 * sin(20 * t)' }",
    ];
    same_on_any_number(PLATE, &sets);
    same_on_any_number(PLATE, &[&sets[..], &["scheme.viscosity=25.0"]].concat());
}

/// A block that hits a wall and shears.
const BLOCK: &str = r#"
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
