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
fn check_tells_what_ranks_have() {
    let place = Place::with_bar();
    // 201 particles in chunks of 16, of which each sees one on either side.
    let set = "--set body.bar.spacing=0.005 --set time.integrator='ssp_rk3' --ranks 3";
    let (stdout, _) = place.run(&format!("check bar/case.toml {set}"), 0);
    let ranks: Vec<&str> = stdout.lines().filter(|line| line.contains("copies of")).collect();
    assert_eq!(ranks.len(), 3, "{stdout}");
    for (number, line) in ranks.iter().enumerate() {
        assert_contains(
            line,
            &[&format!(" {number}: "), if number == 1 { "2 of 2 ranks," } else { "1 of 1 rank," }],
        );
        let fields: Vec<&str> = line.split(", ").collect();
        let number = |field: usize| {
            let mut words = fields[field].split_whitespace().filter_map(|word| word.parse().ok());
            words.next().unwrap_or_else(|| panic!("{line}"))
        };
        assert!(
            fields[1].ends_with(" B an evaluation") && fields[2].ends_with(" B a step"),
            "{line}"
        );
        // Three evaluations of the rates.
        let [evaluation, step, load, efficiency]: [f64; 4] = [1, 2, 3, 4].map(number);
        assert_eq!(step, 3.0 * evaluation, "{line}");
        assert!((load - 1.0).abs() < 0.1 && efficiency > 0.0 && efficiency < 1.0, "{line}");
    }
    assert_contains(
        &stdout,
        &["of all, predicted for ranks with as many threads each as this one"],
    );
    let (_, stderr) = place.run("check bar/case.toml --ranks 2", 2);
    let sentence = "2 ranks are too many for 6 particles, of which each rank needs at least a chunk of 16: leave out \
                    `--ranks`";
    assert_contains(&stderr, &[sentence]);
    assert!(!place.run("check bar/case.toml", 0).0.contains("ranks"));
}

#[test]
fn check_shows_the_stages_of_a_step() {
    let place = Place::with_bar();
    let (table, _) = place.run("check bar/case.toml --stages", 0);
    assert_contains(&table, &["part", "gathers", "rates", "local", "pairs", "boundary"]);
    // Velocity, J, position, F, X and three reference values are 8 numbers, the body an index, and a side of 7 numbers takes 64 bytes.
    let local = table.lines().find(|line| line.contains("local")).expect("it is listed");
    assert_eq!(
        local.split_whitespace().collect::<Vec<_>>()[..5],
        ["rates", "local", "132", "0", "132"]
    );
    assert!(table.lines().last().is_some_and(|line| line.starts_with("step ")), "{table}");
    let (drawing, _) = place.run("check bar/case.toml --stages=dot", 0);
    assert_contains(&drawing, &["digraph rates {", "\"local\" -> \"pairs\"", "style=bold"]);
    place.run("check bar/case.toml --stages=chart", 2);
    // The record of a run has the time of each.
    place.run("run bar/case.toml --out results", 0);
    let record: serde_json::Value = serde_json::from_str(&place.read("results/run.json")).unwrap();
    let passes = record["passes"].as_array().unwrap();
    assert!(passes.iter().any(|pass| pass["name"] == "rates: pairs" && pass["calls"] != 0));
    // That of all six particles.
    assert!(passes.iter().any(|pass| pass["name"] == "rates: local" && pass["bytes"] == 792.0));
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
