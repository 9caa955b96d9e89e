//! Profiles along lines: what they hold, when they come, and how checks and plots see them.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use piola::case::verify::{self, CheckRow, Got, VariantRun};
use piola::case::{self, Case, Finished, Level, LoadOptions, Session};
use piola::observe::Series;
use piola::output::Table;
use piola::time::{Outcome, Progress};

/// A body whose velocity and pressure are linear in the place at the start.
const CASE: &str = r#"
version = 1
title = "A linear velocity"
dimension = 2

[[body]]
name = "block"
shape = { kind = "box", min = [0.0, 0.0], max = [1.0, 2.0] }
spacing = 0.1
lattice = { on = "cells", jitter = 0.1 }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 10.0 }
initial = { velocity = ["y", "1 - 3 * x"], pressure = "100 * y" }

[scheme]
kind = "transport_velocity"

[time]
end = 0.01
step = 0.001

[output]
every = 0.004
fields = []

[[probe]]
name = "up"
kind = "line"
from = [0.5, 0.0]
to = [0.5, 2.0]
points = 21
fields = ["velocity", "pressure"]

[[probe]]
name = "across"
kind = "line"
from = [0.2, 0.4]
to = [0.8, 1.2]
points = 11
times = [0.0, 0.003]
fields = ["velocity"]

[[plot]]
name = "up"
curves = ["up.velocity.x"]

[[plot]]
name = "map"
curves = ["across.velocity.y"]
over_time = true
"#;

fn parse(text: &str, folder: Option<&Path>) -> Case {
    let file = folder.map_or(PathBuf::from("case.toml"), |folder| folder.join("case.toml"));
    let options = LoadOptions::default();
    match folder {
        None => case::parse(text, "case.toml", &options),
        Some(_) => {
            fs::write(&file, text).unwrap();
            case::load(&file, &options)
        }
    }
    .unwrap_or_else(|problems| panic!("{problems}"))
}

fn run(case: &Case, folder: Option<&Path>) -> Finished {
    let mut session = Session::new(case).unwrap();
    folder.into_iter().for_each(|folder| session.write_to(folder).unwrap());
    session.run(&AtomicBool::new(false), &mut |_| {}).unwrap()
}

/// The files of a line in the results, with their tables.
fn profiles(out: &Path, line: &str) -> Vec<Table> {
    let mut files: Vec<PathBuf> = fs::read_dir(out.join("profiles"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.file_name().unwrap().to_string_lossy().starts_with(line))
        .collect();
    files.sort();
    files.iter().map(|file| Table::read_csv(file).unwrap()).collect()
}

fn values(finished: &Finished, name: &str) -> (Vec<f64>, Vec<f64>) {
    match finished.quantity(name) {
        Some(Series::Curve { against, abscissa, values, .. }) => {
            assert_eq!(against.header(), "distance [m]");
            (abscissa, values)
        }
        other => panic!("{name}: {other:?}"),
    }
}

#[test]
fn a_linear_field_is_met_along_a_line_to_its_ends() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    run(&parse(CASE, None), Some(&out));
    // Both ends lie on the edge of the body, half a spacing outside of the last particles.
    let up = &profiles(&out, "up")[0];
    let names: Vec<String> = up.columns().iter().map(|column| column.header()).collect();
    let fields = ["up.velocity.x [m/s]", "up.velocity.y [m/s]", "up.pressure [Pa]"];
    assert_eq!(names, [&["distance [m]", "x [m]", "y [m]"][..], &fields].concat());
    assert_eq!(up.len(), 21);
    for (number, row) in up.rows().enumerate() {
        let [distance, x, y, u, v, p] = row.try_into().unwrap();
        let expected = 0.1 * number as f64;
        assert!((distance - expected).abs() < 1e-15 && (y - expected).abs() < 1e-15 && x == 0.5);
        assert!((u - y).abs() < 1e-12 && (v + 0.5).abs() < 1e-12, "{row:?}");
        assert!((p - 100.0 * y).abs() < 1e-10, "{row:?}");
    }
    let across = &profiles(&out, "across")[0];
    for row in across.rows() {
        assert!((row[0] - (row[1] - 0.2).hypot(row[2] - 0.4)).abs() < 1e-15, "{row:?}");
        assert!((row[3] - row[2]).abs() < 1e-12 && (row[4] - 1.0 + 3.0 * row[1]).abs() < 1e-12);
    }
}

#[test]
fn profiles_come_when_they_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let finished = run(&parse(CASE, None), Some(&out));
    // With the particle files, 0, 4 and 8 ms, and at the end; and at 0 and 3 ms only.
    assert_eq!(profiles(&out, "up").len(), 4);
    assert_eq!(profiles(&out, "across").len(), 2);
    // The tables hold the newest, with files and without.
    let alone = run(&parse(CASE, None), None);
    assert_eq!(finished.tables, alone.tables);
    for (number, line) in ["up", "across"].into_iter().enumerate() {
        let last = profiles(&out, line).pop().unwrap();
        assert_eq!(last, finished.tables.profiles[number]);
        assert_ne!(last, profiles(&out, line)[0], "{line} has changed");
    }
    assert!(out.join("plots/up.png").is_file());
    // What a map is drawn of is kept at all times.
    assert!(out.join("plots/map.png").is_file());
    let [kept] = &finished.tables.over_time[..] else { panic!("one map") };
    assert_eq!(
        (kept.column.name.as_str(), &kept.times[..]),
        ("across.velocity.y", &[0.0, 0.003][..])
    );
    let all = profiles(&out, "across");
    let written = all.iter().flat_map(|profile| profile.rows().map(|row| row[4]));
    assert_eq!(kept.values, written.collect::<Vec<f64>>());
    // The report reads them from the folder.
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("data-x-name=\"distance\"") && page.contains("across.velocity.y"));
}

fn assert_mean(mean: &Table, samples: &[Table]) {
    for (place, row) in mean.rows().enumerate() {
        let rows = samples.iter().map(|sample| sample.rows().nth(place).unwrap());
        for (column, value) in row.iter().enumerate() {
            let expected = rows.clone().map(|row| row[column]).sum::<f64>() / samples.len() as f64;
            let is_same = (value - expected).abs() <= 1e-14 * (1.0 + expected.abs());
            assert!(is_same || value.is_nan() && expected.is_nan(), "{value} for {expected}");
        }
    }
}

#[test]
fn a_profile_may_be_a_mean_over_time() {
    // Each sample by a profile of its own, and their means: of 2, 3, 4 ms, and since then, of 5 and 6 ms.
    let text = CASE.replace("every = 0.004", "every = 0.004\ntable_every = 0.001");
    let every = text.replace("[0.0, 0.003]", "[0.002, 0.003, 0.004, 0.005, 0.006]");
    let means = text.replace("[0.0, 0.003]", "[0.004, 0.006]\nmean_over = 0.002");
    let folder = tempfile::tempdir().unwrap();
    let of = |name: &str, text: &str| {
        let out = folder.path().join(name);
        let finished = run(&parse(text, None), Some(&out));
        let all = profiles(&out, "across");
        assert_eq!(*all.last().unwrap(), finished.tables.profiles[1]);
        all
    };
    let (samples, means) = (of("every", &every), of("means", &means));
    assert_eq!((samples.len(), means.len()), (5, 2));
    for (mean, own) in means.iter().zip([&samples[..3], &samples[3..]]) {
        assert_mean(mean, own);
    }
    // The last step before a profile is due, and after it: a run that goes on there has the same.
    for steps in [3, 5] {
        let out = folder.path().join(format!("broken-{steps}"));
        let case = parse(&text.replace("[0.0, 0.003]", "[0.004, 0.006]\nmean_over = 0.002"), None);
        let stop = AtomicBool::new(false);
        let mut session = Session::new(&case).unwrap();
        session.write_to(&out).unwrap();
        let mut halt = |it: &Progress| stop.store(it.step >= steps, Ordering::Relaxed);
        let part = session.run(&stop, &mut halt).unwrap();
        assert_eq!(part.summary.outcome, Outcome::Interrupted);
        let mut session = Session::new(&case).unwrap();
        session.resume_from(&out).unwrap();
        session.run(&AtomicBool::new(false), &mut |_| {}).unwrap();
        assert_eq!(profiles(&out, "across"), means, "{steps}");
    }
    let text = CASE.replace("points = 21", "points = 21\nmean_over = 1");
    let problems = case::parse(&text, "case.toml", &LoadOptions::default()).unwrap_err();
    assert!(problems.to_string().contains("`mean_over` needs the times"), "{problems}");
}

#[test]
fn a_place_far_from_all_particles_has_no_value() {
    let text = CASE.replace("to = [0.5, 2.0]", "to = [0.5, 4.0]");
    let finished = run(&parse(&text, None), None);
    let (distance, values) = values(&finished, "up.velocity.x");
    for (distance, value) in distance.iter().zip(values) {
        // The support of the default kernel is three spacings.
        assert_eq!(value.is_nan(), *distance > 2.3, "{value} at {distance}");
        // Where a straight line cannot be trusted it is the mean: no overshoot far outside.
        assert!(!(value > 2.2), "{value} at {distance}");
    }
}

/// What a check of the line `up` gives.
fn row(lines: &str) -> CheckRow {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("line.csv"), "y,u\n0,0\n2,2\n").unwrap();
    let text = format!("{CASE}\n[[check]]\nsource = \"s\"\n{lines}\n");
    let text = text.replace("end = 0.01\nstep = 0.001", "end = 1e-9");
    let case = parse(&text, Some(folder.path()));
    let mut rows = verify::verify(&case, &mut |_| {
        Ok(VariantRun { run: run(&case, None), case: case.clone() })
    });
    assert_eq!(rows.len(), 1);
    rows.remove(0)
}

#[test]
fn checks_look_along_the_line() {
    for (lines, got) in [
        ("reduce = \"curve\"\nreference = \"line.csv\"\nat_most = 1e-6", 0.0),
        ("reduce = \"curve_rms\"\nreference = \"line.csv\"\nat_most = 1e-6", 0.0),
        ("reduce = \"at\"\nat = 1.25\nexpected = 1.25\ntolerance = 1e-6", 1.25),
        ("reduce = \"maximum\"\nexpected = 2\ntolerance = 1e-6", 2.0),
        ("expected = 2\ntolerance = 1e-6", 2.0),
        ("reduce = \"mean\"\nexpected = 1\ntolerance = 1e-6", 1.0),
    ] {
        let row = row(&format!("quantity = \"up.velocity.x\"\n{lines}"));
        let Some(Got::Number(value, unit)) = &row.got else { panic!("{row:?}") };
        assert!(row.pass && (value - got).abs() < 1e-6 && unit == "m/s", "{row:?}");
    }
    let lines =
        "quantity = \"up.velocity.y\"\nreduce = \"curve\"\nreference = \"line.csv\"\nat_most = 1";
    let row = row(lines);
    // -0.5 against 2 at the end of the line.
    let Some(Got::Number(value, _)) = row.got else { panic!("{row:?}") };
    assert!(!row.pass && (value - 2.5).abs() < 1e-6, "{value}");
}

#[test]
fn a_run_that_goes_back_or_is_resumed_keeps_its_profiles() {
    let folder = tempfile::tempdir().unwrap();
    let dam = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/upwind/dam-break/case.toml");
    let line = "\n[[probe]]\nname = \"level\"\nkind = \"line\"\nfrom = [0.0, 0.1]\nto = [1.5, 0.1]\n\
                fields = [\"pressure\"]\n";
    // Means, and what they are of.
    let numbers =
        |every: usize| (1..=80 / every).map(move |it| format!("{}", (it * every) as f64 / 100.0));
    let times = |every| numbers(every).collect::<Vec<String>>().join(", ");
    let samples = line.replace("level", "samples") + &format!("times = [{}]\n", times(1));
    let means =
        line.replace("level", "means") + &format!("times = [{}]\nmean_over = 0.03\n", times(4));
    let text = fs::read_to_string(dam).unwrap() + line + &samples + &means;
    let file = folder.path().join("case.toml");
    fs::write(&file, text).unwrap();
    // Too large a step: it fails, goes back and on with half of it.
    let set = [
        "body.water.spacing=0.1",
        "time.cfl=2",
        "time.on_failure='retry'",
        "output.table_every=0.01",
    ];
    let overrides = set.map(str::to_owned).to_vec();
    let options = LoadOptions { overrides, level: Level::Coarse, ..LoadOptions::default() };
    let case = case::load(&file, &options).unwrap_or_else(|problems| panic!("{problems}"));
    let out = folder.path().join("out");
    let whole = run(&case, Some(&out));
    assert!(!whole.summary.retries.is_empty());
    let frames = fs::read_dir(out.join("particles")).unwrap().count();
    assert_eq!(profiles(&out, "level").len(), frames);
    assert_eq!(profiles(&out, "level").last(), whole.tables.profiles.first());
    let (samples, means) = (profiles(&out, "samples"), profiles(&out, "means"));
    let retry = &whole.summary.retries[0];
    // It goes back past a mean, into the time that it is of.
    let is_between = |time: f64| retry.back_to < time && time < retry.time;
    assert!((1..=20).any(|number| is_between(0.04 * f64::from(number))), "{retry:?}");
    assert_eq!((samples.len(), means.len()), (80, 20));
    for (mean, own) in means.iter().zip(samples.chunks_exact(4)) {
        assert_mean(mean, own);
    }
    let stop = AtomicBool::new(false);
    let mut until = |progress: &Progress| {
        stop.store(progress.step + 2 >= retry.step, Ordering::Relaxed);
    };
    let broken = folder.path().join("broken");
    let mut session = Session::new(&case).unwrap();
    session.write_to(&broken).unwrap();
    let first = session.run(&stop, &mut until).unwrap();
    assert_eq!(first.summary.outcome, Outcome::Interrupted);
    stop.store(false, Ordering::Relaxed);
    let mut session = Session::new(&case).unwrap();
    session.resume_from(&broken).unwrap();
    let last = session.run(&stop, &mut |_| {}).unwrap();
    assert_eq!(last.tables, whole.tables);
    for line in ["level", "samples", "means"] {
        assert_eq!(profiles(&broken, line), profiles(&out, line));
    }
}
