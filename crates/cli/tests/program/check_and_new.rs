use std::fs;

use crate::support::{Place, assert_contains};

#[test]
fn check_says_what_will_happen_and_runs_nothing() {
    let place = Place::with_bar();
    let (stdout, stderr) = place.run("check bar/case.toml --variant fast --set time.end=0.03", 0);
    assert_eq!(stderr, "");
    // Six particles 0.2 m apart on a length of 1 m; each has up to 2 h = 0.4 m in sight.
    // The wave speed is 10 m/s, so the step is 0.2 * 0.2 / 10 s.
    assert_contains(
        &stdout,
        &[
            "T1: A tiny bar (1D, variant fast)",
            "6 particles",
            "spacing 0.2 m",
            "volume 1 m",
            "acoustic",
            "0.004 s",
            "8 to t = 0.03 s",
            "particle evaluations per second",
            "2 particle files",
            "16 rows of the tables",
        ],
    );
    let (stdout, _) = place.run("check bar/case.toml --set time.end=0.03 --set output.every=1", 0);
    assert_contains(&stdout, &["1 particle file,"]);
    let (_, stderr) = place.run("check bar/case.toml --set time.end=1.5s", 2);
    assert_contains(&stderr, &["numbers have no units"]);
    assert_eq!(fs::read_dir(place.path("")).unwrap().count(), 1);
}

#[test]
fn check_shows_the_stages_of_a_step() {
    let place = Place::with_bar();
    let (table, _) = place.run("check bar/case.toml --stages", 0);
    assert_contains(&table, &["part", "gathers", "rates", "local", "pairs", "boundary"]);
    let (drawing, _) = place.run("check bar/case.toml --stages=dot", 0);
    assert_contains(&drawing, &["digraph rates {", "\"local\" -> \"pairs\"", "style=bold"]);
    place.run("check bar/case.toml --stages=chart", 2);
    // The record of a run has the time of each.
    place.run("run bar/case.toml --out results", 0);
    let record: serde_json::Value = serde_json::from_str(&place.read("results/run.json")).unwrap();
    let passes = record["passes"].as_array().unwrap();
    assert!(passes.iter().any(|pass| pass["name"] == "rates: pairs" && pass["calls"] != 0));
}

#[test]
fn a_new_case_can_be_checked_run_and_verified() {
    let place = Place::new();
    let (stdout, _) = place.run("new first", 0);
    assert_contains(&stdout, &["wrote first/case.toml", "piola check first/case.toml"]);
    let text = place.read("first/case.toml");
    assert!(text.contains("title = \"first\""), "{text}");

    place.run("check first/case.toml", 0);
    let tiny = "--set parameters.spacing=0.5 --set time.end=0.02 --set output.every=0.02 \
                --set picture.0.times=[0.02]";
    place.run(&format!("run first/case.toml {tiny}"), 0);
    assert!(place.path("results/first/particles.pvd").exists());
    let (stdout, _) = place.run("verify first", 0);
    assert_contains(&stdout, &["0 failed"]);
}

#[test]
fn new_replaces_nothing() {
    let place = Place::with_bar();
    let before = place.read("bar/case.toml");
    let (stdout, stderr) = place.run("new bar", 4);
    assert_contains(&stderr, &["bar/case.toml exists already"]);
    assert_eq!(stdout, "");
    assert_eq!(place.read("bar/case.toml"), before);
    // A folder without a case is no hindrance, a file in its place is.
    fs::create_dir(place.path("empty")).unwrap();
    place.run("new empty", 0);
    place.write("file", "");
    let (_, stderr) = place.run("new file", 4);
    assert_contains(&stderr, &["file"]);
    place.run("new deep/er/still", 0);
    assert!(place.read("deep/er/still/case.toml").contains("title = \"still\""));
}
