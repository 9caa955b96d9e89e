//! The commands of the program, one file each, and the steps that they share.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use piola::case::{Case, LoadOptions, Problems, Session, load};

use crate::arguments::{CaseArguments, CaseFile};
use crate::exit::{Exit, Fault};
use crate::terminal;
use crate::text::count;

pub mod check;
pub mod devices;
pub mod generate;
pub mod new;
pub mod report;
pub mod run;
pub mod sweep;
pub mod verify;

/// Sets the number of threads of all loops.
fn use_threads(threads: Option<u16>) {
    let Some(threads) = threads else { return };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads));
    // Results do not depend on the number of threads, so the run may go on with another.
    if let Err(error) = pool.build_global() {
        terminal::report(&format!("warning: cannot use {threads} threads: {error}\n"));
    }
}

/// Calls `work(i)` for each i below `count`, `jobs` of them at a time, each with an even share of the `threads`: no more
/// than there are threads. None is begun once `stop` is set.
fn side_by_side(
    count: usize,
    jobs: u16,
    threads: Option<u16>,
    stop: &AtomicBool,
    work: impl Fn(usize) + Sync,
) {
    let threads = threads.map_or_else(rayon::current_num_threads, usize::from);
    let jobs = usize::from(jobs).min(count).min(threads).max(1);
    let next = AtomicUsize::new(0);
    let one_after_another = || {
        while !stop.load(Ordering::Relaxed) {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return;
            }
            // Results do not depend on the number of threads, so another will do.
            match rayon::ThreadPoolBuilder::new().num_threads((threads / jobs).max(1)).build() {
                Ok(pool) => pool.install(|| work(index)),
                Err(_) => work(index),
            }
        }
    };
    std::thread::scope(|scope| (0..jobs).for_each(|_| drop(scope.spawn(one_after_another))));
}

/// What a job that panicked while it held the lock left is whole: rows are put in at once, and files are whole or not
/// there.
fn locked<T>(it: &Mutex<T>) -> MutexGuard<'_, T> {
    it.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Changes of the case by its flags: those of `--set`, and who computes.
fn overrides(arguments: &CaseArguments) -> Vec<String> {
    // A JSON string is one of TOML, too.
    let quoted = |name: &String| serde_json::Value::from(name.as_str()).to_string();
    let device = arguments.device.iter().map(|name| format!("compute.device={}", quoted(name)));
    let precision = arguments.precision.map(|it| format!("compute.precision='{}'", it.name()));
    let ranks = arguments.ranks.iter().map(|count| format!("compute.ranks={count}"));
    arguments.file.set.iter().cloned().chain(device).chain(precision).chain(ranks).collect()
}

/// Reads the case as it stands.
fn read(arguments: &CaseArguments) -> Result<Case, Fault> {
    read_with(&arguments.file, overrides(arguments))
}

/// Reads a case file with these changes.
fn read_with(file: &CaseFile, overrides: Vec<String>) -> Result<Case, Fault> {
    let variant = file.variant.clone();
    let options = LoadOptions { overrides, variant, ..LoadOptions::default() };
    load(&file.case, &options).map_err(|problems| refusal(&file.case, &problems))
}

/// Builds what was read from `path`.
fn assemble(path: &Path, case: &Case) -> Result<Session, Fault> {
    Session::new(case).map_err(|problems| refusal(path, &problems))
}

/// All problems of the case file `path`, with their number.
fn refusal(path: &Path, problems: &Problems) -> Fault {
    let exit = if problems.is_io() { Exit::Io } else { Exit::BadCase };
    let number = count(problems.len() as u64, "problem");
    Fault { exit, report: format!("{problems}\n{number} in {}\n", path.display()) }
}
