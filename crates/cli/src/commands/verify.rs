//! `piola verify`: all cases below some folders, and one table of their checks.

use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use piola::case::build;
use piola::case::page::PageCase;
use piola::case::verify::{CheckRow, VariantRun, needed_variants, verify as evaluate};
use piola::case::{Case, Finished, Level, LoadOptions, load};

use super::{refusal, use_threads};
use crate::arguments::VerifyArguments;
use crate::exit::{Exit, Fault};
use crate::progress::{Audience, Display};
use crate::text::{count, duration};
use crate::{interrupt, table, terminal};

mod page;

/// Runs the cases and prints the table.
pub fn verify(arguments: &VerifyArguments) -> Result<Exit, Fault> {
    use_threads(arguments.threads);
    let start = Instant::now();
    let stop = interrupt::listen();
    let mut rows = Vec::new();
    let mut cases = Vec::new();
    for path in discover(&arguments.paths)? {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let Some(mut found) = one(&path, arguments, &stop) else { continue };
        rows.extend(found.rows.iter().cloned());
        if arguments.page.is_none() {
            found.runs.clear();
        }
        cases.push(found);
    }
    let seconds = start.elapsed().as_secs_f64();
    let failed = rows.iter().filter(|row| !row.pass).count();
    let passed = rows.len() - failed;
    let total = format!(
        "{} of {}: {passed} passed, {failed} failed ({})\n",
        count(rows.len() as u64, "check"),
        count(cases.len() as u64, "case"),
        duration(seconds)
    );
    terminal::print(&format!("{}\n{total}", render(&rows)))?;
    if stop.load(Ordering::Relaxed) {
        terminal::report("interrupted: the other cases have not been run\n");
        return Ok(Exit::Interrupted);
    }
    if let Some(file) = arguments.page.as_ref().filter(|_| !rows.is_empty()) {
        page::write(file, cases, arguments.full)?;
    }
    match (rows.len(), failed) {
        (0, _) => Err(Fault::new(Exit::FailedCheck, nothing_found(arguments))),
        (_, 0) => Ok(Exit::Success),
        _ => Ok(Exit::FailedCheck),
    }
}

fn nothing_found(arguments: &VerifyArguments) -> String {
    let paths: Vec<String> =
        arguments.paths.iter().map(|path| path.display().to_string()).collect();
    let only = arguments.only.as_ref().map(|id| format!(" with the id {id}")).unwrap_or_default();
    format!("there is no check to evaluate in any case.toml below {}{only}", paths.join(", "))
}

/// All files called `case.toml` below `paths`, and those of `paths` that are files themselves,
/// sorted and each once. Links to folders are not followed.
fn discover(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Fault> {
    let mut found = Vec::new();
    for path in paths {
        let fault =
            |error| Fault::new(Exit::Io, format!("cannot read {}: {error}", path.display()));
        if path.metadata().map_err(fault)?.is_dir() {
            collect(path, &mut found)?;
        } else {
            found.push(path.clone());
        }
    }
    found.sort();
    found.dedup();
    Ok(found)
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) -> Result<(), Fault> {
    let fault = |error| Fault::new(Exit::Io, format!("cannot read {}: {error}", folder.display()));
    for entry in folder.read_dir().map_err(fault)? {
        let entry = entry.map_err(fault)?;
        let kind = entry.file_type().map_err(fault)?;
        if kind.is_dir() {
            collect(&entry.path(), found)?;
        } else if entry.file_name() == "case.toml" {
            found.push(entry.path());
        }
    }
    Ok(())
}

/// The rows of one case with its runs, `None` where it is not wanted or has no check. A case that
/// cannot be read is one failed row.
fn one(path: &Path, arguments: &VerifyArguments, stop: &AtomicBool) -> Option<PageCase> {
    let read = |variant: Option<&str>| -> Result<Case, Fault> {
        let options = LoadOptions {
            overrides: Vec::new(),
            variant: variant.map(str::to_owned),
            level: if arguments.full { Level::Case } else { Level::Coarse },
        };
        load(path, &options).map_err(|problems| refusal(path, &problems))
    };
    let folder = folder_name(path);
    let is_wanted = |id: Option<&str>| match &arguments.only {
        None => true,
        Some(only) => id.is_some_and(|id| id.eq_ignore_ascii_case(only)) || folder == *only,
    };
    let mut found = PageCase {
        case: None,
        name: folder.clone(),
        link: path.display().to_string(),
        rows: Vec::new(),
        runs: Vec::new(),
        pictures: Vec::new(),
    };
    let base = match read(None) {
        Ok(base) => base,
        Err(_) if !is_wanted(None) => return None,
        Err(fault) => {
            terminal::report(&terminal::coloured(&fault.report));
            found.rows.push(unreadable(folder));
            return Some(found);
        }
    };
    if !is_wanted(base.id.as_deref()) {
        return None;
    }
    let name = base.id.clone().unwrap_or(folder);
    let count = needed_variants(&base).len();
    let mut number = 0;
    // Settings that are the same case in the end share one run.
    let mut known: Vec<(String, Rc<Finished>)> = Vec::new();
    found.rows = evaluate(&base, &mut |variant| {
        number += 1;
        if stop.load(Ordering::Relaxed) {
            return Err("interrupted before its run".to_owned());
        }
        let case = read(variant).map_err(|fault| fault.report.trim_end().to_owned())?;
        let same = known.iter().find(|(as_run, _)| *as_run == case.as_run);
        let run = match same {
            Some((_, run)) => Rc::clone(run),
            None => {
                let label = match variant {
                    Some(variant) => format!("{name} {variant} ({number} of {count})"),
                    None => format!("{name} ({number} of {count})"),
                };
                let run = Rc::new(run_quietly(&case, &label, stop)?);
                known.push((case.as_run.clone(), Rc::clone(&run)));
                run
            }
        };
        found.runs.push((variant.map(str::to_owned), Rc::clone(&run)));
        Ok(VariantRun { case, run })
    });
    if stop.load(Ordering::Relaxed) || found.rows.is_empty() {
        // What was interrupted has neither passed nor failed.
        return None;
    }
    for row in &mut found.rows {
        row.id = Some(name.clone());
    }
    found.case = Some(base);
    Some(found)
}

/// Runs a case without files.
fn run_quietly(case: &Case, label: &str, stop: &AtomicBool) -> Result<Finished, String> {
    let simulation = build(case).map_err(|problems| problems.to_string().trim_end().to_owned())?;
    let mut display = Display::new(label, Audience::Person);
    let finished = simulation.run(None, stop, &mut |progress| display.update(progress));
    finished.map_err(|error| error.to_string())
}

/// The name of the folder of a case file, which stands for its id where it has none.
fn folder_name(path: &Path) -> String {
    let resolved = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let name = resolved.parent().and_then(Path::file_name);
    name.map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

fn unreadable(folder: String) -> CheckRow {
    CheckRow {
        check: 0,
        id: Some(folder),
        run: None,
        quantity: "the case file".to_owned(),
        got: None,
        expected: "a good case".to_owned(),
        tolerance: String::new(),
        deviation: String::new(),
        source: String::new(),
        pass: false,
        reason: Some("the case cannot be read, see above".to_owned()),
        trend: None,
    }
}

/// The table, with the reason under each check that could not be evaluated.
fn render(rows: &[CheckRow]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let header = ["id", "quantity", "got", "expected", "tolerance", "source", "pass"];
    let header = header.map(str::to_owned).to_vec();
    let cells = |row: &CheckRow| {
        let quantity = match &row.run {
            Some(run) => format!("{run}: {}", row.quantity),
            None => row.quantity.clone(),
        };
        vec![
            row.id.clone().unwrap_or_default(),
            quantity,
            row.got.as_ref().map_or_else(|| "-".to_owned(), ToString::to_string),
            row.expected.clone(),
            row.tolerance.clone(),
            row.source.clone(),
            terminal::verdict(if row.pass { "yes" } else { "NO" }, row.pass),
        ]
    };
    let table: Vec<Vec<String>> = std::iter::once(header).chain(rows.iter().map(cells)).collect();
    let lines = table::align(&table, terminal::stdout_width(), &[5, 1, 3, 0]);
    let reasons = rows.iter().map(|row| row.reason.as_deref());
    let mut text = String::new();
    for (line, reason) in lines.iter().zip(std::iter::once(None).chain(reasons)) {
        text.push_str(line);
        text.push('\n');
        for line in reason.into_iter().flat_map(str::lines) {
            text.push_str(&format!("    {line}\n"));
        }
    }
    text
}
