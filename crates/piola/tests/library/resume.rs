//! Runs that are interrupted and resumed, compared with runs that are not.
#![allow(clippy::unwrap_used, reason = "a test that cannot set itself up has failed")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use piola::case::{self, Case, Finished, Level, LoadOptions, RunError, Session};
use piola::output::checkpoint;
use piola::time::{Outcome, Progress};

use super::ranks_coupled::TANK;

pub fn load(path: &Path, variant: Option<&str>, set: &[&str]) -> Case {
    let overrides = set.iter().map(|text| (*text).to_owned()).collect();
    let options = LoadOptions {
        overrides,
        variant: variant.map(str::to_owned),
        level: Level::Coarse,
        ..LoadOptions::default()
    };
    case::load(path, &options).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A run on `threads` threads that is stopped after `last` steps, or never.
pub fn run(case: &Case, folder: &Path, resume: bool, threads: usize, last: u64) -> Finished {
    try_run(case, folder, resume, threads, last).unwrap()
}

fn try_run(
    case: &Case,
    folder: &Path,
    resume: bool,
    threads: usize,
    last: u64,
) -> Result<Finished, RunError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut session = Session::new(case).unwrap_or_else(|problems| panic!("{problems}"));
        let stop = AtomicBool::new(false);
        let mut progress = |progress: &Progress| {
            stop.store(progress.step >= last, Ordering::Relaxed);
        };
        match resume {
            true => session.resume_from(folder)?,
            false => session.write_to(folder)?,
        }
        session.run(&stop, &mut progress)
    })
}

/// All files of a run by their names, but for the record, which tells times of day, and for
/// checkpoints, which tell how long the run has taken.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    fn walk(root: &Path, folder: &Path, all: &mut BTreeMap<PathBuf, Vec<u8>>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(root, &path, all);
            } else {
                let name = path.strip_prefix(root).unwrap().to_owned();
                all.insert(name, fs::read(path).unwrap());
            }
        }
    }
    let mut all = BTreeMap::new();
    walk(folder, folder, &mut all);
    let told = ["run.json", "report.html"];
    all.retain(|name, _| {
        !name.starts_with("checkpoints") && !told.iter().any(|it| name == Path::new(it))
    });
    all
}

pub fn assert_same(whole: &Path, broken: &Path, what: &str) {
    let (whole, broken) = (files(whole), files(broken));
    let names = |files: &BTreeMap<PathBuf, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&whole), names(&broken), "{what}");
    for (name, bytes) in &whole {
        assert!(*bytes == broken[name], "{what}: {} differs", name.display());
    }
}

pub fn cases() -> Vec<PathBuf> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        let entries = fs::read_dir(folder).unwrap();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        for path in paths {
            if path.is_dir() {
                walk(&path, found);
            } else if path.file_name().is_some_and(|name| name == "case.toml") {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    walk(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases"), &mut found);
    assert!(found.len() >= 10);
    found
}

/// Every case, interrupted twice, on other numbers of threads each time, and of ranks where it can be shared: every file
/// of the results has the bytes of the run that was never interrupted.
#[test]
fn every_case_resumes_to_the_bit() {
    side_by_side(&cases(), |path| resumes_to_the_bit(path, None, &[]));
}

/// Does this with each, as many at a time as there are cores: most of a run is on one thread. Not by rayon, a thread of
/// which begins with the next one while it waits for a pool of threads that a run has for itself.
fn side_by_side<T: Sync>(all: &[T], each: impl Fn(&T) + Sync) {
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(it) = all.get(next.fetch_add(1, Ordering::Relaxed)) {
            each(it);
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
}

/// The case on as many ranks as it can be shared among, up to 7.
pub fn on_ranks(path: &Path, variant: Option<&str>, set: &[&str]) -> Option<Case> {
    for ranks in [7, 4, 3, 2] {
        let more = format!("compute.ranks={ranks}");
        let case = load(path, variant, &[set, &[more.as_str()]].concat());
        let refusal = match Session::new(&case) {
            Ok(_) => return Some(case),
            Err(refusal) => refusal.to_string(),
        };
        if refusal.contains("on several ranks yet") {
            return None;
        }
        assert!(refusal.contains("ranks are too many"), "{}: {refusal}", path.display());
    }
    None
}

/// The integrators that no base case has.
#[test]
fn implicit_steps_resume_to_the_bit() {
    let all = cases();
    // Several ranks share what Krylov methods take.
    let krylov = &["time.linear_solver='krylov'"][..];
    let runs = [
        ("free-vibration/case.toml", "implicit", &[][..]),
        ("free-vibration/case.toml", "damped", krylov),
        ("piston/case.toml", "implicit", &[]),
        ("piston-gamma/case.toml", "accurate", krylov),
    ];
    side_by_side(&runs, |(name, variant, set)| {
        let path = all.iter().find(|path| path.ends_with(name)).unwrap();
        assert_eq!(on_ranks(path, Some(variant), set).is_some(), !set.is_empty(), "{name}");
        resumes_to_the_bit(path, Some(variant), set);
    });
}

/// Systems in a fluid that the base cases do not have: what each keeps must survive that another one has changed its
/// velocities.
#[test]
fn solids_of_each_kind_in_a_fluid_resume_to_the_bit() {
    let all = cases();
    let slab = all.iter().find(|path| path.ends_with("slab/case.toml")).unwrap();
    let variants = ["upwind", "upwind-damped", "upwind-implicit", "hypoelastic-fine"];
    side_by_side(&variants, |variant| resumes_to_the_bit(slab, Some(variant), &[]));
}

/// A fluid with solids that touch what moves, broken off on two ranks, continued on three and ended on one; the same with
/// a thin plate that moves on without turning.
#[test]
fn a_fluid_with_solids_goes_on_on_another_number_of_ranks() {
    goes_on_on_another_number_of_ranks(&[]);
    goes_on_on_another_number_of_ranks(&[
        "boundary.foot=",
        "body.plate.material={ kind = 'rigid', density = 1500.0 }",
        "system.plate.scheme={ kind = 'total_lagrangian' }",
        "body.plate.shape.min=[0.5, 0.1]",
        "body.plate.initial={ velocity = ['1', '0'] }",
    ]);
}

fn goes_on_on_another_number_of_ranks(set: &[&str]) {
    let on = |ranks: usize| {
        let overrides = set.iter().map(|text| (*text).to_owned());
        let more = [format!("compute.ranks={ranks}"), "output.compression='none'".to_owned()];
        let overrides = overrides.chain(more).collect();
        let options = LoadOptions { overrides, ..LoadOptions::default() };
        case::parse(TANK, "tank.toml", &options).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let folder = tempfile::tempdir().unwrap();
    let [whole, broken] = ["whole", "broken"].map(|name| folder.path().join(name));
    let unbroken = run(&on(1), &whole, false, 1, u64::MAX);
    let steps = unbroken.summary.steps;
    run(&on(2), &broken, false, 2, steps / 3);
    let second = run(&on(3), &broken, true, 3, 2 * steps / 3);
    assert_eq!(second.summary.resumed.map(|(_, step)| step), Some(steps / 3));
    let last = run(&on(1), &broken, true, 1, u64::MAX);
    assert_eq!(last.summary.resumed.map(|(_, step)| step), Some(2 * steps / 3));
    assert_same(&whole, &broken, "a tank");
    assert_eq!(last.tables, unbroken.tables);
}

/// Steps of particles after which a run ends here: what a state has to keep shows early. In explicit and in implicit
/// steps, of which each takes as long as many.
const MOST: [f64; 2] = [1e6, 1e4];

/// When a run ends of as many steps as [`MOST`] allows, and of 30 at least.
fn early_end(case: &Case) -> f64 {
    let mut session = Session::new(case).unwrap_or_else(|problems| panic!("{problems}"));
    let most = MOST[usize::from(case.time.rule.is_some())];
    let most = (most / session.scheme().particle_count() as f64).max(30.0);
    *case.time.end * (most / session.plan().steps as f64).min(1.0)
}

fn resumes_to_the_bit(path: &Path, variant: Option<&str>, set: &[&str]) {
    // What is drawn and packed only takes time here; one picture and five files have it all.
    let set = [set, &["output.compression='none'"]].concat();
    let case = load(path, variant, &set);
    if *case.time.end == 0.0 {
        // Nothing moves, and there is nothing to break off.
        return;
    }
    let end = early_end(&case);
    let sparse = |mut case: Case| {
        case.time.end.value = end;
        case.output.every.value = end / 5.0;
        // Steps of loads are large, each of them takes a whole iteration.
        let rows = if *case.time.integrator == "static" { 10.0 } else { 50.0 };
        case.output.table_every.value = end / rows;
        case.pictures.truncate(1);
        case.pictures.iter_mut().for_each(|picture| picture.times.retain(|time| **time <= end));
        case
    };
    let (case, shared) = (sparse(case), on_ranks(path, variant, &set).map(sparse));
    let on_several = shared.as_ref().unwrap_or(&case);
    let folder = tempfile::tempdir().unwrap();
    let (whole, broken) = (folder.path().join("whole"), folder.path().join("broken"));
    let unbroken = run(&case, &whole, false, 1, u64::MAX);
    let steps = unbroken.summary.steps;
    assert!(steps >= 4, "{}", path.display());

    let first = run(on_several, &broken, false, 2, steps / 3);
    assert_eq!(first.summary.outcome, Outcome::Interrupted, "{}", path.display());
    let second = run(&case, &broken, true, 1, 3 * steps / 4);
    assert_eq!(second.summary.resumed, Some((first.summary.time, first.summary.steps)));
    let last = run(on_several, &broken, true, 3, u64::MAX);
    assert_eq!(last.summary.resumed.map(|(_, steps)| steps), Some(3 * steps / 4));

    assert_same(&whole, &broken, &path.display().to_string());
    assert_eq!(last.tables, unbroken.tables, "{}", path.display());
    let (mut last, unbroken) = (last.summary, unbroken.summary);
    assert!(unbroken.trace.is_some() == matches!(unbroken.outcome, Outcome::Failed(_)));
    (last.timings, last.resumed) = (unbroken.timings.clone(), None);
    last.phases = unbroken.phases.clone();
    assert_eq!(last.ranks.is_empty(), shared.is_none(), "{}", path.display());
    last.ranks.clear();
    assert_eq!(last, unbroken, "{}", path.display());
}

/// A wave in a bar that is over in a blink, in a folder of its own.
struct Bar {
    folder: tempfile::TempDir,
}

const BAR: &str = r#"
version = 1
title = "A bar"
dimension = 1
[[body]]
name = "bar"
shape = { kind = "box", min = [0.0], max = [1.0] }
spacing = 0.1
material = { kind = "linear", density = 1000.0, bulk_modulus = 1e5 }
initial = { velocity = ["x"] }
[scheme]
kind = "upwind"
smoothing_length = 1.0
[time]
end = 1.0
cfl = 0.2
[checkpoint]
every_steps = 10
keep = 3
[[probe]]
name = "tip"
kind = "particle"
at = [1.0]
fields = ["displacement"]
[output]
every = 0.5
table_every = 0.1
"#;

impl Bar {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("case.toml"), BAR).unwrap();
        Self { folder }
    }

    fn case(&self, set: &[&str]) -> Case {
        let overrides = set.iter().map(|text| (*text).to_owned()).collect();
        let options = LoadOptions { overrides, ..LoadOptions::default() };
        let path = self.folder.path().join("case.toml");
        case::load(&path, &options).unwrap_or_else(|problems| panic!("{problems}"))
    }

    fn out(&self) -> PathBuf {
        self.folder.path().join("out")
    }

    /// The checkpoints, the newest first.
    fn checkpoints(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.out().join("checkpoints")).unwrap();
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        paths.reverse();
        paths
    }

    /// Breaks the case off after 45 steps: checkpoints are those of steps 45, 40 and 30.
    fn broken_off(&self) -> Case {
        let case = self.case(&[]);
        run(&case, &self.out(), false, 1, 45);
        let names: Vec<_> =
            self.checkpoints().iter().map(|path| path.file_name().unwrap().to_owned()).collect();
        assert_eq!(names, ["step_000000000045", "step_000000000040", "step_000000000030"]);
        case
    }

    fn resume(&self, case: &Case) -> Result<Finished, RunError> {
        try_run(case, &self.out(), true, 1, u64::MAX)
    }
}

#[test]
fn a_damaged_checkpoint_is_passed_over_with_a_warning() {
    let bar = Bar::new();
    let case = bar.broken_off();
    let paths = bar.checkpoints();
    let mut bytes = fs::read(&paths[0]).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 4;
    fs::write(&paths[0], bytes).unwrap();
    fs::write(&paths[1], "something else").unwrap();
    let finished = bar.resume(&case).unwrap();
    assert_eq!(finished.summary.outcome, Outcome::Completed);
    assert_eq!(finished.summary.resumed.map(|(_, step)| step), Some(30));
    assert_eq!(finished.warnings.len(), 2, "{:?}", finished.warnings);
    assert!(finished.warnings[0].contains("step_000000000045 is damaged: its checksum"));
    assert!(finished.warnings[1].contains("step_000000000040 is not a checkpoint of piola"));
    let whole = bar.folder.path().join("whole");
    run(&case, &whole, false, 1, u64::MAX);
    assert_same(&whole, &bar.out(), "from the third checkpoint");
}

#[test]
fn without_any_sound_checkpoint_nothing_is_touched() {
    let bar = Bar::new();
    let case = bar.broken_off();
    for path in bar.checkpoints() {
        fs::write(path, "").unwrap();
    }
    let before = files(&bar.out());
    let error = bar.resume(&case).unwrap_err();
    assert!(matches!(error, RunError::NoCheckpoint { .. }), "{error}");
    assert!(error.to_string().contains("it ends after 0 bytes"), "{error}");
    assert_eq!(files(&bar.out()), before);
}

#[test]
fn a_checkpoint_of_another_case_is_refused() {
    let bar = Bar::new();
    bar.broken_off();
    for set in ["scheme.tau_velocity=0.5", "body.bar.spacing=0.05", "output.every=0.25"] {
        let error = bar.resume(&bar.case(&[set])).unwrap_err().to_string();
        assert!(error.contains("belongs to another case, or to this one with other"), "{error}");
    }
    // What a run does not depend on before its end may change.
    let longer = bar.case(&["time.end=1.5", "title='Longer'", "checkpoint.keep=1"]);
    let finished = bar.resume(&longer).unwrap();
    assert_eq!((finished.summary.time, finished.summary.resumed.is_some()), (1.5, true));
    let whole = bar.folder.path().join("whole");
    run(&longer, &whole, false, 1, u64::MAX);
    assert_same(&whole, &bar.out(), "a later end");
}

#[test]
fn a_checkpoint_after_the_end_is_refused() {
    let bar = Bar::new();
    bar.broken_off();
    let error = bar.resume(&bar.case(&["time.end=0.01"])).unwrap_err();
    assert!(error.to_string().contains("the run goes from 0 to 0.01 s"), "{error}");
}

#[test]
fn without_a_checkpoint_a_resumed_run_starts() {
    let bar = Bar::new();
    let finished = bar.resume(&bar.case(&[])).unwrap();
    assert_eq!(finished.summary.outcome, Outcome::Completed);
    assert!(finished.warnings[0].contains("no checkpoint to resume from"));
}

/// The one at the end is there on request, and a later end continues from it.
#[test]
fn a_completed_run_can_be_extended() {
    let bar = Bar::new();
    run(&bar.case(&["checkpoint.at_end=true"]), &bar.out(), false, 1, u64::MAX);
    let longer = bar.case(&["time.end=2.0"]);
    let finished = bar.resume(&longer).unwrap();
    assert_eq!(finished.summary.resumed.map(|(time, _)| time), Some(1.0));
    assert_eq!(finished.summary.time, 2.0);
}

/// Checkpoints by simulated time come at the first step after each multiple, and neither kind
/// changes what is computed.
#[test]
fn results_do_not_depend_on_checkpoints() {
    let bar = Bar::new();
    let plain = run(&bar.case(&["checkpoint.every_steps=1000000"]), &bar.out(), false, 1, u64::MAX);
    for set in [
        ["checkpoint.every=0.3", "checkpoint.every_steps=1000000"],
        ["checkpoint.every_wall=1e-9", "checkpoint.keep=1000000"],
    ] {
        let other = bar.folder.path().join("other");
        let finished = run(&bar.case(&set), &other, false, 1, u64::MAX);
        assert_eq!(finished.tables, plain.tables);
        assert_same(&bar.out(), &other, set[0]);
        let count = fs::read_dir(other.join("checkpoints")).unwrap().count() as u64;
        // At 0.3, 0.6 and 0.9 s, or after every step but the last.
        let expected = if set[0].contains("wall") { plain.summary.steps - 1 } else { 3 };
        assert_eq!(count, expected, "{set:?}");
    }
}

/// Every single flipped bit and every length that is too short is noticed before anything is
/// read into memory that the file does not have.
#[test]
fn no_damage_goes_unnoticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("step");
    let identity = [7; 32];
    checkpoint::write(&path, &identity, b"a payload of some bytes").unwrap();
    let sound = fs::read(&path).unwrap();
    let read = || checkpoint::read(&path, &identity, 1000);
    assert_eq!(read().unwrap(), b"a payload of some bytes");
    for bit in 0..8 * sound.len() {
        let mut bytes = sound.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        fs::write(&path, bytes).unwrap();
        assert!(read().is_err(), "bit {bit}");
    }
    for length in 0..sound.len() {
        fs::write(&path, &sound[..length]).unwrap();
        assert!(read().is_err(), "length {length}");
        fs::write(&path, [&sound[..], &sound[..=length]].concat()).unwrap();
        assert!(read().is_err(), "{} more", length + 1);
    }
    fs::write(&path, &sound).unwrap();
    assert!(
        checkpoint::read(&path, &[8; 32], 1000).unwrap_err().to_string().contains("another case")
    );
    assert!(checkpoint::read(&path, &identity, 22).unwrap_err().to_string().contains("more than"));
    assert!(checkpoint::read(folder.path(), &identity, 1000).is_err(), "a folder");
}

#[test]
fn another_version_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("step");
    checkpoint::write(&path, &[0; 32], b"").unwrap();
    let mut bytes = fs::read(&path).unwrap();
    bytes[12..17].copy_from_slice(b"9.8.7");
    fs::write(&path, bytes).unwrap();
    let error = checkpoint::read(&path, &[0; 32], 1000).unwrap_err().to_string();
    assert!(error.contains("was written by piola 9.8.7 in format 9, and this is piola"), "{error}");
}
