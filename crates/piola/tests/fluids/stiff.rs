//! Stiff solids in a fluid, which take many own steps in one of the fluid.

use std::sync::atomic::AtomicBool;

use piola::case::{self, Finished, LoadOptions, Session};

/// A plate that is clamped below and holds back water that is at rest.
const DAM: &str = r#"
version = 1
title = "Dam"
dimension = 2
[parameters]
dx = 0.05
thickness = 0.15
pd = 0.05 / 3
[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [0.5, 0.5] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
initial = { pressure = "1000 * 9.81 * (0.5 - y)" }
[[body]]
name = "tank"
shape = { kind = "difference", from = { kind = "box", min = [-0.2, -0.2], max = [1.2, 1.0] }, remove = [ { kind = "box", min = [0.0, 0.0], max = [1.0, 1.2] } ] }
spacing = "dx"
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 30.0 }
wall = {}
[[body]]
name = "plate"
system = "plate"
shape = { kind = "box", min = [0.5, 0.0], max = ["0.5 + thickness", 0.8] }
spacing = "pd"
lattice = { on = "cells" }
material = { kind = "neo_hookean_logarithmic", density = 1100.0, young_modulus = 5e8, poisson_ratio = 0.3 }
[scheme]
kind = "transport_velocity"
free_surface = true
[[system]]
name = "plate"
scheme = { kind = "total_lagrangian" }
[[load]]
kind = "body_force"
acceleration = ["0", "-9.81"]
[[boundary]]
name = "foot"
body = "plate"
where = { kind = "half_space", point = [0.0, 0.06], normal = [0.0, -1.0] }
velocity = { x = "0", y = "0" }
[time]
end = 0.1
[output]
every = 0.1
table_every = 0.001
"#;

/// The same with implicit steps, one of which spans one of the water.
const IMPLICIT: &str = "system.plate.time={ integrator = 'newmark' }";

/// Vibrations stay as they are.
const INVISCID: &str = "system.plate.scheme.viscosity=0";

fn session(set: &[&str]) -> Session {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(DAM, "case.toml", &options);
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"))
}

fn run(set: &[&str]) -> Finished {
    let finished = session(set).run(&AtomicBool::new(false), &mut |_| {}).expect("it runs");
    assert_eq!(finished.summary.outcome.summary(), "completed");
    finished
}

fn column<'a>(finished: &'a Finished, name: &str) -> &'a [f64] {
    finished.tables.energy.values(name).expect(name)
}

/// The largest energy of the plate in J.
fn most(finished: &Finished) -> f64 {
    let parts =
        ["plate.kinetic", "plate.strain", "plate.hourglass"].map(|name| column(finished, name));
    (0..parts[0].len()).map(|row| parts.iter().map(|part| part[row]).sum()).fold(0.0, f64::max)
}

/// How many steps the plate takes in one of the water.
fn own_steps(finished: &Finished) -> f64 {
    let [water, plate] = [0, 1].map(|number: usize| finished.own_steps[number].1);
    plate as f64 / water as f64
}

/// Water at rest does not set a plate into vibration, whatever the frequencies of the plate are in steps of the water:
/// impulses once a step would drive those with a whole number of periods in it, at 5e8 Pa to the 300 times of what the same
/// plate has in implicit steps. The load comes at once, which makes the plate vibrate by itself, and what implicit steps lose
/// of that, as the fluid sees it, is less than a half.
#[test]
fn water_at_rest_does_not_drive_a_plate() {
    let thin = ["parameters.thickness=0.1", "parameters.pd=0.05"];
    let aluminium = "body.plate.material={ kind = 'neo_hookean_logarithmic', density = 2700.0, young_modulus = 67e9, poisson_ratio = 0.33 }";
    let light = "body.plate.material={ kind = 'neo_hookean_logarithmic', density = 300.0, young_modulus = 2e8, poisson_ratio = 0.3 }";
    let cases: [&[&str]; 6] = [
        &[],
        &["body.plate.material.young_modulus=3e8"],
        &["time.cfl=0.2"],
        &[thin[0], thin[1], "body.plate.material.young_modulus=2e8"],
        &[aluminium, "parameters.pd=0.05", "time.end=0.05", "output.every=0.05"],
        &[light],
    ];
    for set in cases {
        let [explicit, implicit] = [run(set), run(&[set, &[IMPLICIT]].concat())];
        assert!(own_steps(&explicit) > 4.0 && own_steps(&implicit) == 1.0, "{set:?}");
        let [own, reference] = [&explicit, &implicit].map(most);
        println!("{set:?} {own} {reference} {}", own_steps(&explicit));
        assert!(own < 2.0 * reference, "{set:?}: {own} {reference}");
        // Nothing moves the tank.
        let totals = column(&explicit, "total");
        let scale = totals.iter().fold(0.0, |most: f64, total| most.max(total.abs()));
        let balance = column(&explicit, "balance").last().expect("there are rows");
        assert!(balance.abs() < 1e-3 * scale, "{set:?}: {balance} {scale}");
    }
}
