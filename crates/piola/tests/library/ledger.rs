//! The ledger of a run against what is known of it by hand.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use std::sync::atomic::AtomicBool;

use piola::case::{self, Finished, LoadOptions, Session};

/// A block of 2 by 1 m in free flight, with a weight, a dead traction on its top, and dissipation.
const FLIGHT: &str = r#"
version = 1
title = "A block in flight"
dimension = 2
[[body]]
name = "block"
shape = { kind = "box", min = [0.0, 0.0], max = [2.0, 1.0] }
spacing = 0.2
material = { kind = "gamma_law", density = 1000.0, gamma = 7.0, wave_speed = 20.0 }
initial = { velocity = ["1 - 2 * y", "2 * x"] }
[scheme]
kind = "upwind"
smoothing_length = 0.7
tau_velocity = 0.5
[time]
end = 0.2
cfl = 0.3
[[load]]
kind = "body_force"
acceleration = [0.0, -9.81]
[[load]]
kind = "traction"
where = { kind = "plane", point = [0.0, 1.0], normal = [0.0, 1.0] }
traction = [300.0, "100 * t"]
[output]
every = 0.1
table_every = 0.05
"#;

/// The left side of the block swings up and down as something outside wants.
const SHAKEN: &str = r#"
[[boundary]]
name = "left"
where = { kind = "plane", point = [0.0, 0.0], normal = [-1.0, 0.0] }
velocity = { x = 0.0, y = "sin(40 * t)" }
"#;

fn run(text: &str, set: &[&str]) -> Finished {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let case = case::parse(text, "case.toml", &options).unwrap_or_else(|it| panic!("{it}"));
    let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    session.run(&AtomicBool::new(false), &mut |_| {}).unwrap()
}

fn last(finished: &Finished, name: &str) -> f64 {
    *finished.tables.momentum.values(name).unwrap().last().unwrap()
}

/// The weight of 2000 kg for 0.2 s, and a traction of 300 Pa and one that rises on 2 m: the
/// impulses are integrals that the two stages of the integrator take without error.
#[test]
fn impulses_are_what_the_loads_give() {
    let finished = run(FLIGHT, &[]);
    let mass = 2000.0;
    for (name, expected) in [
        ("body_force.linear.x", 0.0),
        ("body_force.linear.y", -9.81 * mass * 0.2),
        ("traction.linear.x", 300.0 * 2.0 * 0.2),
        ("traction.linear.y", 100.0 * 2.0 * 0.5 * 0.2 * 0.2),
        ("boundary_motion.linear.x", 0.0),
        ("boundary_motion.angular.z", 0.0),
    ] {
        let got = last(&finished, name);
        assert!((got - expected).abs() <= 1e-11 * mass, "{name}: {got} instead of {expected}");
    }
    // At the start: the centre is at (1, 1/2), and the block turns about it by 2 rad/s besides.
    let start = |name: &str| finished.tables.momentum.values(name).unwrap()[0];
    assert!(start("linear.x").abs() < 1e-9 * mass);
    assert!((start("linear.y") - 2.0 * mass).abs() < 1e-11 * mass);
    // sum m (x v_y - y v_x) with lumped masses on the lattice: second moments are those of the
    // trapezoidal rule, l^2/3 (1 + dx^2 / 2 l^2) each way.
    let second = |length: f64| length * length / 3.0 + 0.2 * 0.2 / 6.0;
    let expected = mass * (2.0 * second(2.0) - 0.5 + 2.0 * second(1.0));
    assert!((start("angular.z") - expected).abs() < 1e-10 * expected, "{expected}");
}

/// Linear momentum balances to round-off however large the steps are; angular momentum, a product of
/// two unknowns, to the second order of the integrator.
#[test]
fn momentum_balances() {
    let off = |finished: &Finished, name: &str| last(finished, &format!("balance.{name}")).abs();
    let [coarse, fine] = [0.4, 0.1].map(|cfl| run(FLIGHT, &[&format!("time.cfl={cfl}")]));
    for finished in [&coarse, &fine] {
        for name in ["linear.x", "linear.y"] {
            assert!(off(finished, name) < 1e-12 * 4000.0, "{name}");
        }
    }
    let [coarse, fine] = [coarse, fine].map(|finished| off(&finished, "angular.z"));
    assert!(coarse / fine > 12.0 && coarse < 1e-3 * 4000.0, "{coarse} {fine}");
}

/// A moved boundary gives what the rest of the balance needs: its own values are prescribed, so that
/// the balance shows by how much their integrated rate misses them.
#[test]
fn a_moved_boundary_is_accounted_for() {
    let text = format!("{FLIGHT}{SHAKEN}");
    let off = |cfl: f64, name: &str| {
        let finished = run(&text, &[&format!("time.cfl={cfl}")]);
        assert!(last(&finished, "boundary_motion.linear.y").abs() > 100.0);
        last(&finished, &format!("balance.{name}")).abs()
    };
    // Held at rest along x, the side takes an impulse without any such error.
    assert!(off(0.4, "linear.x") < 1e-12 * 4000.0);
    for name in ["linear.y", "angular.z"] {
        let (coarse, fine) = (off(0.4, name), off(0.1, name));
        assert!(coarse / fine > 12.0 && coarse < 40.0, "{name}: {coarse} {fine}");
    }
}

/// Three angular components in 3D: a cube that spins about a skew axis keeps them.
#[test]
fn angular_momentum_in_space() {
    let text = r#"
version = 1
title = "A spinning cube"
dimension = 3
[[body]]
name = "cube"
shape = { kind = "box", min = [-0.5, -0.5, -0.5], max = [0.5, 0.5, 0.5] }
spacing = 0.25
material = { kind = "gamma_law", density = 1000.0, gamma = 7.0, wave_speed = 20.0 }
initial = { velocity = ["2 * z - 3 * y", "3 * x - z", "y - 2 * x"] }
[scheme]
kind = "upwind"
smoothing_length = 0.7
tau_velocity = 0.5
[time]
end = 0.05
cfl = 0.2
"#;
    let finished = run(text, &[]);
    // L = I w with w = (1, 2, 3), I = 2 m l^2 / 12 with the second moment of the trapezoidal rule.
    let moment = 1000.0 * 2.0 * (1.0 / 12.0 + 0.25 * 0.25 / 6.0);
    for (name, rate) in [("angular.x", 1.0), ("angular.y", 2.0), ("angular.z", 3.0)] {
        let values = finished.tables.momentum.values(name).unwrap();
        assert!((values[0] - moment * rate).abs() < 1e-10 * moment, "{name}: {}", values[0]);
        let balance = last(&finished, &format!("balance.{name}"));
        assert!(balance.abs() < 1e-5 * moment, "{name}: {balance}");
    }
}
