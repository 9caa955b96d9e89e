//! What fuzzers feed with bytes: the four things that piola reads from files and does not trust.
//!
//! Each of these functions takes whatever it is given, and says whether it was good; a panic, an
//! overflow, or memory and time that the input does not justify is a fault. `fuzz/run` looks for
//! such inputs with a fuzzer that watches which code they reach; a test of the library feeds them
//! a fixed number of damaged seeds.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use piola::case::model::{Case, Shape};
use piola::case::{self, LoadOptions, RunError, Session};
use piola::geometry::{self, CloudPoints, CloudSpec, CloudVolumes};
use piola::output::checkpoint;
use piola::time::Progress;
use tempfile::TempDir;

/// A case file: read, and built and planned if it is good and has few particles.
pub fn case_file(data: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(data) else { return false };
    let Ok(case) = case::parse(text, "case.toml", &LoadOptions::default()) else { return false };
    if is_small(&case)
        && let Ok(mut session) = Session::new(&case)
    {
        session.plan();
    }
    true
}

/// A user may ask for a billion particles, a fuzzer may not.
fn is_small(case: &Case) -> bool {
    const MOST: f64 = 400.0;
    case.bodies.iter().all(|body| {
        let spacing = body.spacing.iter().copied().fold(f64::INFINITY, f64::min);
        let extents = extents(&body.shape);
        extents.iter().map(|extent| extent.abs() / spacing + 2.0).product::<f64>() < MOST
    })
}

/// Edges of a box around a shape in m.
fn extents(shape: &Shape) -> Vec<f64> {
    match shape {
        Shape::Box { min, max } => min.iter().zip(max).map(|(min, max)| max - min).collect(),
        Shape::Ball { center, radius } => vec![2.0 * radius; center.len()],
        Shape::Annulus { center, outer, .. } => vec![2.0 * outer; center.len()],
        // What is made of others is not looked into.
        _ => vec![f64::INFINITY],
    }
}

/// A point cloud, in each dimension.
pub fn point_cloud(data: &[u8]) -> bool {
    let path = place().join("points.csv");
    fs::write(&path, data).expect("the scratch folder can be written");
    let line = geometry::from_points::<1>(&path).is_ok();
    let plane = geometry::from_points::<2>(&path).is_ok();
    geometry::from_points::<3>(&path).is_ok() || plane || line
}

/// A mesh, in each dimension, as nodes and as cells.
pub fn mesh(data: &[u8]) -> bool {
    let path = place().join("mesh");
    fs::write(&path, data).expect("the scratch folder can be written");
    let mut is_good = false;
    for points in [CloudPoints::Nodes, CloudPoints::Cells] {
        for volumes in [CloudVolumes::Nearest, CloudVolumes::Array("volume".into())] {
            let spec = CloudSpec { points, volumes, spacings: None, part: None };
            is_good |= geometry::from_mesh::<1>(&path, &spec).is_ok();
            is_good |= geometry::from_mesh::<2>(&path, &spec).is_ok();
            is_good |= geometry::from_mesh::<3>(&path, &spec).is_ok();
        }
    }
    is_good
}

/// A checkpoint: the file as it is, and the same bytes as what a sound file holds, from which a run
/// goes on for some steps.
pub fn checkpoint(data: &[u8]) -> bool {
    static OWNER: OnceLock<checkpoint::Identity> = OnceLock::new();
    let folder = place().join("out");
    let identity = OWNER.get_or_init(|| {
        let sound = fs::read(broken_off(&folder)).expect("it has just been written");
        sound[28..60].try_into().expect("the identity stands after magic, format and version")
    });
    let raw = place().join("raw");
    fs::write(&raw, data).expect("the scratch folder can be written");
    // Its checksum would have to be guessed.
    assert!(checkpoint::read(&raw, identity, 1 << 20).is_err());

    // An earlier input may have left newer ones.
    let checkpoints = folder.join("checkpoints");
    for entry in fs::read_dir(&checkpoints).expect("the folder is there").flatten() {
        fs::remove_file(entry.path()).expect("the scratch folder can be written");
    }
    let path = checkpoints.join("step_000000000020");
    checkpoint::write(&path, identity, data).expect("the scratch folder can be written");
    match run(&folder, true, 3) {
        Ok(()) => true,
        Err(RunError::NoCheckpoint { .. } | RunError::Misfit(_)) => false,
        Err(other) => panic!("{other}"),
    }
}

/// The payload of a real checkpoint, from which others are made.
pub fn checkpoint_seed() -> Vec<u8> {
    let sound = fs::read(broken_off(&place().join("seed"))).expect("it has just been written");
    sound[68..sound.len() - 32].to_vec()
}

/// A case with a checkpoint every 20 steps, retries, and all kinds of output.
const BAR: &str = include_str!("../corpus/case_file/bar.toml");

/// Breaks off a run after 20 steps; its checkpoint.
fn broken_off(folder: &Path) -> PathBuf {
    run(folder, false, 20).expect("the scratch folder can be written");
    folder.join("checkpoints/step_000000000020")
}

fn run(folder: &Path, resume: bool, steps: u64) -> Result<(), RunError> {
    let case = case::parse(BAR, "case.toml", &LoadOptions::default()).expect("the seed is good");
    let mut session = Session::new(&case).expect("the seed can be built");
    let (stop, mut taken) = (AtomicBool::new(false), 0);
    let mut progress = |_: &Progress| {
        taken += 1;
        stop.store(taken >= steps, Ordering::Relaxed);
    };
    match resume {
        true => session.resume_from(folder)?,
        false => session.write_to(folder)?,
    }
    session.run(&stop, &mut progress).map(|_| ())
}

/// A folder of this process, in memory where the system has such.
fn place() -> &'static Path {
    static PLACE: OnceLock<TempDir> = OnceLock::new();
    let make = || tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir());
    PLACE.get_or_init(|| make().expect("a scratch folder can be made")).path()
}
