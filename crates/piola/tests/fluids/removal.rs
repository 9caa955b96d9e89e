//! Drops that fly over the rim of a tank and are removed: on a device as on the processor.
//!
//! They need a device, see `device`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use piola::case::{self, Case, Finished, LoadOptions, Session};
use piola::time::{Outcome, Progress};

use super::device::device;
use super::escapes::values;

/// Some of the drops fly over the rim and some fall onto it, four of them before 0.35 s and four after 0.46 s.
const TANK: &str = r#"
version = 1
title = "Drops over the rim"
dimension = 2

[[body]]
name = "water"
shape = { kind = "box", min = [0.0, 0.0], max = [0.6, 0.15] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 8.0, viscosity = 1e-3 }

[[body]]
name = "drops"
shape = { kind = "box", min = [0.2, 0.25], max = [0.6, 0.45] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 8.0, viscosity = 1e-3 }
initial = { velocity = ["8 * x - 1", "1"] }

[[body]]
name = "tank"
shape = { kind = "difference", from = { kind = "box", min = [-0.15, -0.15], max = [0.75, 0.3] }, remove = [{ kind = "box", min = [0.0, 0.0], max = [0.6, 1.0] }] }
spacing = 0.05
lattice = { on = "cells" }
material = { kind = "weakly_compressible", density = 1000.0, wave_speed = 8.0, viscosity = 1e-3 }
wall = { slip = "no" }

[scheme]
kind = "transport_velocity"
free_surface = true
artificial_viscosity = 0.05
escaped = "remove"

[[load]]
kind = "body_force"
acceleration = ["0", "-9.81"]

[time]
end = 0.5

[[probe]]
name = "tank"
kind = "sum"
body = "tank"
field = "force"

[output]
every = 0.1
table_every = 0.01
fields = ["velocity", "pressure", "density", "surface", "wall"]
"#;

/// The steps when four drops have been removed and four have not.
const BETWEEN: u64 = 363;

fn tank(device: &str, set: &[&str]) -> Case {
    let device = format!("compute.device='{device}'");
    let overrides = set.iter().map(|text| (*text).to_owned()).chain([device]).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    case::parse(TANK, "test", &options).unwrap_or_else(|problems| panic!("{problems}"))
}

fn session(device: &str) -> Session {
    Session::new(&tank(device, &[])).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A run into a folder that is stopped after some steps.
fn run(device: &str, folder: &Path, resumes: bool, last: u64) -> Finished {
    let (mut session, stop) = (session(device), AtomicBool::new(false));
    match resumes {
        true => session.resume_from(folder).expect("there is a checkpoint"),
        false => session.write_to(folder).expect("the folder is new"),
    }
    let mut progress = |progress: &Progress| stop.store(progress.step >= last, Ordering::Relaxed);
    session.run(&stop, &mut progress).expect("files can be written")
}

/// Tables and particle files by their names.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let folders = [folder.to_owned(), folder.join("particles")];
    let entries = folders.iter().flat_map(|folder| fs::read_dir(folder).expect("it is there"));
    let paths = entries.map(|entry| entry.expect("it can be read").path());
    let is_result =
        |path: &PathBuf| path.extension().is_some_and(|end| end == "csv" || end == "vtp");
    let named = paths.filter(is_result).map(|path| {
        let bytes = fs::read(&path).expect("it can be read");
        (path.strip_prefix(folder).expect("it is in there").to_owned(), bytes)
    });
    named.collect()
}

fn assert_same(expected: &Path, got: &Path, what: &str) {
    let (expected, got) = (files(expected), files(got));
    assert!(expected.keys().eq(got.keys()) && expected.len() >= 7, "{what}: {:?}", got.keys());
    for (name, bytes) in &expected {
        assert!(*bytes == got[name], "{what}: {} differs", name.display());
    }
}

#[test]
fn what_a_device_removes_leaves_the_files_of_the_processor() {
    let Some(device) = device() else { return };
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let of = |name: &str| folder.path().join(name);
    let whole = run("processor", &of("whole"), false, u64::MAX);
    assert_eq!(whole.summary.outcome, Outcome::Completed);
    assert_eq!(values(&whole, "run.removed"), [8.0]);
    // Their energy and momentum leave with them, and nothing else does.
    let last = |name: &str| *values(&whole, name).last().expect("rows");
    assert!(last("energy.removed") < -10.0 && last("energy.balance").abs() < 1e-10);
    assert!(last("momentum.removed.linear.x") < -10.0);
    // What is broken off and what then goes on elsewhere.
    let computers = [device.as_str(), "processor"];
    for computer in computers {
        let begun = run(computer, &of(computer), false, BETWEEN);
        assert_eq!(begun.summary.outcome, Outcome::Interrupted);
        assert_eq!(values(&begun, "run.removed"), [4.0]);
    }
    assert_same(&of("processor"), &of(&device), "broken off");
    for (first, then) in [(0, 1), (1, 0)] {
        let what = format!("from {} to {}", computers[first], computers[then]);
        run(computers[then], &of(computers[first]), true, u64::MAX);
        assert_same(&of("whole"), &of(computers[first]), &what);
    }
}

/// With corrected gradients, and with pressures by the law of state and background pressures.
#[test]
fn other_forces_remove_what_they_do_on_the_processor() {
    let Some(device) = device() else { return };
    let pushed = ["scheme.pressure='state_equation'", "scheme.shifting='background'"];
    for set in [&["scheme.corrected_gradients=true"][..], &pushed] {
        let [here, there] = ["processor", &device].map(|device| {
            let case = tank(device, set);
            let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
            session.run(&AtomicBool::new(false), &mut |_| {}).expect("no file is written")
        });
        assert!(values(&here, "run.removed")[0] > 0.0, "{set:?}");
        assert_eq!(here.tables, there.tables, "{set:?}");
    }
}

#[test]
fn what_was_removed_is_back_in_an_earlier_state() {
    let Some(device) = device() else { return };
    let [mut here, mut there] = ["processor", &device].map(session);
    let run_until = |session: &mut Session, time: f64| {
        session.run_until(time).expect("no file is written");
        let checkpoint = session.checkpoint();
        let mut all = serde_json::to_value(&checkpoint).expect("it can be written");
        // How long it has taken.
        all.as_object_mut().expect("it has parts").remove("tally");
        (checkpoint, all)
    };
    let [early, expected] = [&mut here, &mut there].map(|session| run_until(session, 0.2));
    assert!(early.1 == expected.1, "before anything is removed");
    let [late, expected] = [&mut here, &mut there].map(|session| run_until(session, 0.35));
    assert!(late.1 == expected.1, "four are removed");
    there.resume(early.0).expect("it is of the same case");
    assert!(run_until(&mut there, 0.35).1 == expected.1, "once more");
}
