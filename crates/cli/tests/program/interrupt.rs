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
fn an_interrupted_verification_keeps_the_rows_that_it_has() {
    let place = Place::new();
    let bar = BAR.replace("time.end=0.01", "output.every=0.03");
    let endless = format!("\n[[variant]]\nname = \"endless\"\nset = {ENDLESS:?}\n");
    let check = |variant: &str| {
        format!(
            "\n[[check]]\nvariant = \"{variant}\"\nquantity = \"tip.displacement.x\"\nreduce = \"final\"\n\
             at_least = -1.0\nagainst = \"invariant\"\nsource = \"of {variant}\"\n"
        )
    };
    place.write("bar/case.toml", bar.clone() + &endless + &check("fast"));
    place.run("verify bar --page page.md", 0);
    // The other variant keeps its row, of the case as it was run then; the next time it has changed.
    for (speed, kept) in [("2.0", &["at rest again", "of fast"][..]), ("3.0", &["at rest again"])] {
        let case =
            bar.replace("at rest", "at rest again").replace("speed=2.0", &format!("speed={speed}"));
        place.write("bar/case.toml", case + &endless + &check("endless") + &check("fast"));
        let mut program = Program::piola(&place, "verify bar --page page.md");
        let (mut told, mut next) = (String::new(), [0]);
        while !told.contains("endless") {
            program.0.stderr.as_mut().unwrap().read_exact(&mut next).unwrap();
            told.push(char::from(next[0]));
        }
        let (code, stdout, stderr) = program.stop("INT");
        assert_eq!(code, Some(130), "{stdout}{stderr}");
        assert_contains(
            &stderr,
            &["interrupted: what was not finished has neither passed nor failed"],
        );
        assert_contains(&stdout, &["1 check of 1 case: 1 passed, 0 failed"]);
        let results: serde_json::Value = serde_json::from_str(&place.read("page.json")).unwrap();
        let rows = results["cases"][0]["rows"].as_array().unwrap();
        let sources: Vec<_> = rows.iter().map(|row| row["source"].as_str().unwrap()).collect();
        let expected: Vec<String> =
            kept.iter().map(|end| end.replace("at rest", "it starts at rest")).collect();
        assert_eq!(sources, expected);
        let page = place.read("page.md");
        kept.iter().for_each(|source| assert_contains(&page, &[source]));
        assert!(!page.contains("endless") && !page.contains("not run"), "{page}");
    }
    // Before the end of a first run there is nothing to tell, and the page stays.
    let page = place.read("page.md");
    let other = BAR.replace("set = [\"time.end=0.01\"]", &format!("set = {ENDLESS:?}"));
    place.write("bar/case.toml", other);
    let mut program = Program::piola(&place, "verify bar --page page.md");
    program.0.stderr.as_mut().unwrap().read_exact(&mut [0; 7]).unwrap();
    assert_eq!(program.stop("INT").0, Some(130));
    assert_eq!(place.read("page.md"), page);
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
