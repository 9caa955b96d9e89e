//! Pairs in single precision, on a device.
//!
//! They need a device, see `device`.

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use piola::case::{self, LoadOptions, RunError, Session};
use piola::time::{Outcome, Progress};

use super::device::device;
use super::devices::{load, session};

const SINGLE: &str = "compute.precision='single'";

/// A column moved by this in m, with the planes that hold it.
fn far_away(distance: f64) -> [String; 3] {
    let plane = |name: &str| {
        format!(
            "boundary.{name}.where={{ kind = 'plane', point = [{distance}, 0.0], normal = [-1.0, 0.0] }}"
        )
    };
    let body = format!(
        "body.water.shape={{ kind = 'box', min = [{distance}, 0.0], max = ['{distance} + L', 'L'] }}"
    );
    [body, plane("wall"), plane("gate")]
}

/// Two rings that touch each other and themselves, moved by this in m along x, with the particles that are looked at.
fn rings_far_away(distance: f64) -> Vec<String> {
    let [left, right, hit] = [-0.0405, 0.0405, -0.001].map(|x| distance + x);
    let ring = |name: &str, x: f64| {
        let shape =
            format!("{{ kind = 'annulus', center = [{x}, 0], inner = 0.03, outer = 0.04 }}");
        [format!("body.{name}.spacing='dx'"), format!("body.{name}.shape={shape}")]
    };
    let probes = [format!("probe.A.at=[{hit}, 0.0]"), format!("probe.B.at=[{left}, 0.04]")];
    let set = ["parameters.dx=0.0025", "scheme.self_contact=10.0"].map(String::from);
    [ring("left", left), ring("right", right), probes, set].concat()
}

/// The largest difference of a column, and the largest of its numbers.
fn difference(sessions: &mut [Session; 2], column: &str) -> [f64; 2] {
    let [single, double] =
        sessions.each_mut().map(|session| session.column(column).expect("all have it").values);
    let apart = single.iter().zip(&double).map(|(one, other)| (one - other).abs());
    [apart.fold(0.0, f64::max), double.iter().fold(0.0, |most, one| one.abs().max(most))]
}

/// How far velocities of a case are from those in double precision after 40 steps, and the largest of them, in m/s.
fn apart(name: &str, set: &[&str], device: &str) -> [f64; 2] {
    let set: Vec<&str> = set.iter().copied().chain(["time.max_steps=60"]).collect();
    let single: Vec<&str> = set.iter().copied().chain([SINGLE]).collect();
    let mut both = [(&single, device), (&set, "processor")]
        .map(|(set, device)| session(&load(name, set, device)));
    for session in &mut both {
        (0..40).for_each(|_| drop(session.step()));
    }
    difference(&mut both, "velocity")
}

/// A sum over 128 neighbours, more than any of these has, of which each is rounded by half of `2^-23`, may be off by 128 of
/// these halves, and so may speeds that follow from it.
#[test]
fn single_precision_costs_no_more_than_its_rounding() {
    let Some(device) = device() else { return };
    let bound = 128.0 * 0.5 * f64::from(f32::EPSILON);
    for (name, set) in [
        ("ctvf/taylor-green", &[][..]),
        ("ctvf/dam-break-3d", &[]),
        // Its smoothing length of 0.04 m is rounded down; that of the other is a number in single precision.
        ("ctvf/dam-break", &[]),
        ("ctvf/dam-break", &["scheme.corrected_gradients=true"]),
        ("ctvf/dam-break", &["scheme.shifting='background'"]),
        ("ctvf/dam-break", &["scheme.pressure='state_equation'"]),
        ("ctvf/taylor-green", &["scheme.pressure='state_equation'"]),
        ("ctvf/swinging-plate", &[]),
        ("ctvf/rings", &[]),
        ("dual-support/free-vibration", &["parameters.dx=1"]),
        ("total-lagrangian/presets", &["scheme.artificial_viscosity=[1, 2]"]),
        ("upwind/bar-sine", &[]),
        ("upwind/dam-break", &[]),
    ] {
        let [apart, most] = apart(name, set, &device);
        assert!(apart > 0.0, "{name}: it is in double precision");
        assert!(apart <= bound * most, "{name} {set:?}: {apart:e} m/s of {most:e} m/s");
    }
}

/// Of places only differences count: 1 km away they are rounded as at the origin, but for the rounding of places in double
/// precision, so that no more digits are lost. The factor is for those that are rounded the other way then.
#[test]
fn where_a_body_stands_costs_no_digits() {
    let Some(device) = device() else { return };
    let far = far_away(1000.0);
    let far: Vec<&str> =
        far.iter().map(String::as_str).chain(["probe.top.at=[1000.0, 'L']"]).collect();
    let [near, far] = [&[][..], &far].map(|set| apart("upwind/dam-break", set, &device)[0]);
    assert!(far <= 2.0 * near, "{far:e} m/s 1 km away, {near:e} m/s at the origin");
    let [near, far] = [0.0, 1000.0].map(|distance| {
        let set = rings_far_away(distance);
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        apart("ctvf/rings", &set, &device)[0]
    });
    assert!(far <= 2.0 * near, "rings: {far:e} m/s 1 km away, {near:e} m/s at the origin");
}

#[test]
fn single_precision_needs_a_device() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/ctvf/cavity/case.toml");
    let options = LoadOptions { overrides: vec![SINGLE.into()], ..LoadOptions::default() };
    let problems = case::load(&path, &options).expect_err("it has no device").to_string();
    assert!(problems.contains("the processor computes in double precision"), "{problems}");
}

/// What is broken off in one precision goes on in the same, whether it is named or not.
#[test]
fn a_run_goes_on_in_its_precision_only() {
    let Some(device) = device() else { return };
    let folder = tempfile::tempdir().expect("there is a place for temporary files");
    let run = |out: &str, resumes: bool, device: &str, set: &[&str]| {
        let set: Vec<&str> =
            ["time.max_steps=40", "checkpoint.every_steps=5"].iter().chain(set).copied().collect();
        let (mut session, stop) =
            (session(&load("upwind/bar-sine", &set, device)), AtomicBool::new(false));
        let out = folder.path().join(out);
        match resumes {
            true => session.resume_from(&out)?,
            false => session.write_to(&out)?,
        }
        let last = if resumes { u64::MAX } else { 20 };
        let mut progress =
            |progress: &Progress| stop.store(progress.step >= last, Ordering::Relaxed);
        Ok::<_, RunError>(session.run(&stop, &mut progress)?.summary)
    };
    let begun = run("double", false, "processor", &[]).expect("it runs");
    assert_eq!(begun.outcome, Outcome::Interrupted);
    let error = run("double", true, &device, &[SINGLE]).unwrap_err().to_string();
    assert!(error.contains("in another precision"), "{error}");
    let ended =
        run("double", true, &device, &["compute.precision='double'"]).expect("it is the same");
    assert!(ended.resumed.is_some() && ended.steps == 40, "{ended:?}");
    run("single", false, &device, &[SINGLE]).expect("it runs");
    let error = run("single", true, &device, &[]).unwrap_err().to_string();
    assert!(error.contains("in another precision"), "{error}");
    assert!(run("single", true, &device, &[SINGLE]).expect("it is the same").resumed.is_some());
}
