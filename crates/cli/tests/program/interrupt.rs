//! Ctrl-C and requests to terminate, on systems that have signals.
#![cfg(unix)]

use std::io::Read;

use crate::running::Program;
use crate::support::{BAR, Place, assert_contains};

/// Overrides for a run that never ends: upwinding damps it, so that it does not blow up either.
const ENDLESS: [&str; 4] =
    ["time.end=1e6", "output.every=100", "output.table_every=100", "scheme.tau_velocity=0.5"];

#[test]
fn an_interrupted_run_leaves_its_state() {
    for signal in ["INT", "TERM"] {
        let place = Place::with_bar();
        let mut program =
            Program::piola(&place, &format!("run bar/case.toml --set {}", ENDLESS.join(" --set ")));
        let series = place.path("results/bar/particles.pvd");
        program.wait_for(&series, |text| text.matches("<DataSet").count() > 1);
        let (code, stdout, _) = program.stop(signal);
        assert_eq!(code, Some(130));
        assert_contains(
            &stdout,
            &["interrupted: t = ", "%) after", "open results/bar/particles.pvd"],
        );
        // The last row and the last particle file are those of the moment it stopped.
        let told = stdout.split("t = ").nth(1).unwrap().split(' ').next().unwrap();
        let told: f64 = told.parse().unwrap();
        let steps = place.read("results/bar/steps.csv");
        let time = steps.lines().last().unwrap().split(',').next().unwrap();
        let time: f64 = time.parse().unwrap();
        assert!(time >= 100.0 && (time - told).abs() <= 1e-5 * time, "{told}\n{steps}");
        let series = place.read("results/bar/particles.pvd");
        let last = series.rsplit("timestep=\"").next().unwrap().split('"').next().unwrap();
        assert_eq!(last.parse::<f64>().unwrap(), time);
    }
}

#[test]
fn an_interrupted_verification_says_so() {
    let place = Place::new();
    let coarse = BAR.replace("set = [\"time.end=0.01\"]", &format!("set = {ENDLESS:?}"));
    place.write("bar/case.toml", coarse);
    let mut program = Program::piola(&place, "verify bar");
    let mut first = [0; 7];
    program.0.stderr.as_mut().unwrap().read_exact(&mut first).unwrap();
    assert_eq!(&first, b"running");
    let (code, _, stderr) = program.stop("INT");
    assert_eq!(code, Some(130));
    assert_contains(&stderr, &["stopping after this step", "interrupted"]);
}

#[test]
fn an_interrupted_sweep_keeps_what_it_has() {
    let place = Place::with_bar();
    let endless = ENDLESS[1..].join(" --set ");
    let arguments =
        format!("sweep bar/case.toml --over time.end=0.01,1e6,2e6 --out out --set {endless}");
    // Outputs are rare enough for the short member too.
    let arguments = arguments.replace("every=100", "every=0.01").replace("1e6", "200");
    let mut program = Program::piola(&place, &arguments.replace("2e6", "201"));
    program.wait_for(&place.path("out/sweep.csv"), |text| text.contains(",completed,"));
    program.wait_for(&place.path("out/time.end=200/steps.csv"), |text| text.lines().count() > 2);
    let (code, stdout, stderr) = program.stop("INT");
    assert_eq!(code, Some(130), "{stdout}{stderr}");
    assert_contains(&stderr, &["stopping after this step", "interrupted: 1 member not run"]);
    let table = place.read("out/sweep.csv");
    let outcomes = ["0.01,time.end=0.01,completed,", "200,time.end=200,interrupted,"];
    assert_contains(&table, &outcomes);
    assert_contains(&table, &["201,time.end=201,not run,,"]);
    assert!(place.path("out/plots/tip.displacement.x.png").exists());
}
