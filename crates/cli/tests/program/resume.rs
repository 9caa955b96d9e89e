//! Runs that are killed, and runs that programs watch.
#![cfg(unix)]

use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use serde_json::Value;

use crate::running::send;
use crate::support::{BAR, Place, assert_contains};

/// The tiny bar for some ten thousand steps, with a checkpoint every thousand.
fn long_bar() -> Place {
    let place = Place::new();
    let checkpoint = "\n[checkpoint]\nevery_steps = 1000\n[[boundary]]";
    let text = BAR
        .replace("end = 0.02", "end = 200.0")
        .replace("cfl = 0.2", "cfl = 0.2\nmin_step = 1e-12")
        .replace("every = 0.02\n", "every = 50.0\n")
        .replace("table_every = 0.002", "table_every = 10.0")
        .replace("smoothing_length = 1.0", "smoothing_length = 1.0\ntau_velocity = 0.5")
        .replacen("\n[[boundary]]", checkpoint, 1);
    place.write("bar/case.toml", text);
    place
}

/// Killed a hundred times, while it starts and just after it has written a checkpoint, a run loses
/// what came after its last checkpoint and nothing else, and its results have the bytes of the run
/// that nobody disturbed.
#[test]
fn a_run_survives_a_hundred_kills() {
    let place = long_bar();
    place.run("run bar/case.toml --out whole", 0);
    // Moments from a small generator: random enough, and the same at every run of the test.
    let mut seed = 20_261_121_u64;
    let mut newest = None;
    let mut under_way = 0;
    for count in 0..100 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_piola"));
        command.args(["run", "bar/case.toml", "--resume", "--set", "checkpoint.every_steps=100"]);
        command.current_dir(place.path("")).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // How far a run comes in a time depends on the machine: every second kill waits for a
        // checkpoint instead, and hits a run that has some and goes on.
        let waits = count % 2 == 1;
        let mut ended = None;
        while waits && ended.is_none() && place.newest_checkpoint("results/bar") <= newest {
            ended = child.try_wait().unwrap();
        }
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        sleep(Duration::from_micros((seed >> 33) % if waits { 1_000 } else { 20_000 }));
        ended = child.try_wait().unwrap();
        // SIGKILL: no handler, no clean-up.
        child.kill().unwrap();
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(!stderr.contains("panicked") && !stderr.contains("error"), "{count}: {stderr}");
        let now = place.newest_checkpoint("results/bar");
        assert!(now >= newest, "kill {count}: {now:?} after {newest:?}");
        under_way += u64::from(now.is_some() && ended.is_none());
        newest = now;
    }
    assert!(under_way > 10, "kills of runs with checkpoints: {under_way}");
    let (stdout, _) = place.run("run bar/case.toml --resume", 0);
    assert_contains(&stdout, &["completed", "resumed     from t = "]);
    assert_eq!(place.results("results/bar"), place.results("whole"));
}

#[test]
fn a_terminated_run_goes_on_where_it_stopped() {
    let place = long_bar();
    place.run("run bar/case.toml --out whole", 0);
    let mut command = Command::new(env!("CARGO_BIN_EXE_piola"));
    command.args(["run", "bar/case.toml", "--set", "checkpoint.every_steps=1000000000"]);
    command.current_dir(place.path("")).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    while !place.path("results/bar/particles.pvd").exists() {
        sleep(Duration::from_millis(1));
    }
    send("TERM", child.id());
    let output = child.wait_with_output().unwrap();
    let stdout = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(130), "{stdout}");
    assert!(place.newest_checkpoint("results/bar").is_some(), "{stdout}");
    // Its extra frame at the moment it stopped is none of the whole run's.
    let (stdout, _) = place.run("run bar/case.toml --resume", 0);
    assert_contains(&stdout, &["completed", "resumed     from t = "]);
    assert_eq!(place.results("results/bar"), place.results("whole"));
    let record: Value = serde_json::from_str(&place.read("results/bar/run.json")).unwrap();
    assert_eq!(record["resumed_at"].as_array().unwrap().len(), 1);
}

#[test]
fn resuming_another_case_is_refused() {
    let place = long_bar();
    place.run("run bar/case.toml", 0);
    let before = place.results("results/bar");
    let (_, stderr) = place.run("run bar/case.toml --resume --set scheme.tau_velocity=0.25", 2);
    assert_contains(&stderr, &["belongs to another case", "nothing was changed", "--out"]);
    assert_eq!(place.results("results/bar"), before);
}

/// Every line is an object with an `event`, in the order start, progress, end.
#[test]
fn programs_read_the_progress() {
    let place = long_bar();
    let (stdout, stderr) = place.run("run bar/case.toml --json-progress", 0);
    assert_eq!(stderr, "");
    let events: Vec<Value> =
        stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let (start, end) = (events.first().unwrap(), events.last().unwrap());
    assert_eq!((start["event"].as_str(), start["end"].as_f64()), (Some("start"), Some(200.0)));
    for event in &events[1..events.len() - 1] {
        assert_eq!(event["event"], "progress");
        assert!(event["share"].as_f64().unwrap() <= 1.0 && event["step"].as_u64().unwrap() > 0);
        assert!(event["limiter"].is_string() && event["step_size"].as_f64().unwrap() > 0.0);
    }
    assert_eq!((end["event"].as_str(), end["outcome"].as_str()), (Some("end"), Some("completed")));
    assert!(end["energy"]["balance"].is_f64() && end["momentum"]["linear.x"].is_f64());
    assert!(end["stages"]["step"].as_f64().unwrap() > 0.0);
    let files = end["files"].as_array().unwrap();
    assert!(files.iter().any(|file| file == "energy.csv"));

    let fault = "run bar/case.toml --json-progress --set body.bar.spacing=-1";
    let (stdout, stderr) = place.run(fault, 2);
    let event: Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((event["event"].as_str(), event["exit_code"].as_u64()), (Some("error"), Some(2)));
    assert!(event["message"].as_str().unwrap().contains("must be above 0"));
    assert_contains(&stderr, &["must be above 0"]);
}
