//! `piola verify`: all cases below some folders, and one table of their checks.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use piola::case::page::{Attempt, PageCase, Row, SettingRuns};
use piola::case::verify::{NotRun, VariantRun, needed_variants, verify as evaluate};
use piola::case::{Case, Finished, Level, LoadOptions, Session, load};
use piola::time::Outcome;

use super::{locked, refusal, side_by_side};
use crate::arguments::VerifyArguments;
use crate::exit::{Exit, Fault};
use crate::progress::{Audience, Display};
use crate::text::{count, duration};
use crate::{interrupt, table, terminal};

mod page;

/// The rows of a case for the table, with its id.
type Rows = (String, Vec<Row>);

/// Runs the cases and prints the table.
pub fn verify(arguments: &VerifyArguments) -> Result<Exit, Fault> {
    let start = Instant::now();
    let stop = interrupt::listen();
    let today = page::today();
    let page = match &arguments.page {
        Some(file) => Some(Mutex::new(page::Writer::new(file, &arguments.paths)?)),
        None => None,
    };
    let mut paths = discover(&arguments.paths)?;
    if let Some(only) = &arguments.only {
        paths.retain(|path| is_called(path, only));
    }
    let found = Mutex::new(BTreeMap::new());
    side_by_side(paths.len(), arguments.jobs, arguments.threads, &stop, |index| {
        let rows = one(&paths[index], arguments, &stop).rows(&paths[index], page.as_ref(), &today);
        // A page that cannot be written has no use for other cases.
        if matches!(rows, Some(Err(_))) {
            stop.store(true, Ordering::Relaxed);
        }
        locked(&found).extend(rows.map(|rows| (index, rows)));
    });
    let found = std::mem::take(&mut *locked(&found));
    let rows: Vec<Rows> = found.into_values().collect::<Result<_, _>>()?;
    let seconds = start.elapsed().as_secs_f64();
    let all = || rows.iter().flat_map(|(_, rows)| rows);
    let skipped = all().filter(|row| !row.was_run() && !row.is_interrupted).count();
    let total = all().filter(|row| row.was_run()).count();
    let failed = all().filter(|row| row.is_failed()).count();
    let unmet = all().filter(|row| row.was_run() && row.unmet.is_some()).count();
    let passed = total - failed - unmet;
    let known = match unmet {
        0 => String::new(),
        _ => format!("{unmet} known not to be met, "),
    };
    let mut text = format!(
        "{} of {}: {passed} passed, {known}{failed} failed ({})\n",
        count(total as u64, "check"),
        count(rows.len() as u64, "case"),
        duration(seconds)
    );
    let is_interrupted = stop.load(Ordering::Relaxed);
    // An interrupted one has not looked at all cases, and does not know how many more there are.
    if skipped > 0 && !is_interrupted {
        text += &format!("{} with `--long`\n", count(skipped as u64, "more check"));
    }
    terminal::print(&format!("{}\n{text}", render(&rows)))?;
    if is_interrupted {
        terminal::report("interrupted: what was not finished has neither passed nor failed\n");
        return Ok(Exit::Interrupted);
    }
    if let Some(page) = page.filter(|_| !rows.is_empty()) {
        locked(&page).report()?;
    }
    match (total + skipped, failed) {
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

/// Whether the case at `path` has this id, or is in a folder of this name.
fn is_called(path: &Path, only: &str) -> bool {
    folder_name(path) == only
        || load(path, &LoadOptions::default())
            .is_ok_and(|case| case.id.is_some_and(|id| id.eq_ignore_ascii_case(only)))
}

/// What is found at a path.
enum Found {
    /// No check, or no time for any of them before an interruption.
    Nothing,
    /// A case that cannot be read, which is one failed row.
    Unreadable(Box<Rows>),
    /// A case with its runs.
    Case(Box<PageCase>),
}

impl Found {
    /// Its rows for the table, which are written to the page, too.
    fn rows(
        self,
        path: &Path,
        page: Option<&Mutex<page::Writer>>,
        today: &str,
    ) -> Option<Result<Rows, Fault>> {
        let page = page.map(locked);
        let (rows, written) = match self {
            Self::Nothing => return None,
            Self::Unreadable(rows) => {
                let written = page.map(|mut page| page.add_unreadable(&rows, path));
                (*rows, written)
            }
            Self::Case(case) => {
                let rows = (case.id(), case.rows(today));
                (rows, page.map(|mut page| page.add(*case, path, today)))
            }
        };
        Some(written.unwrap_or(Ok(())).map(|()| rows))
    }
}

/// The settings that are run. `--paper` also runs what has the publication's numbers as it stands.
fn levels(arguments: &VerifyArguments) -> &'static [Level] {
    match (arguments.full, arguments.paper) {
        (true, _) => &Level::ALL,
        (false, true) => &[Level::Case, Level::Paper],
        (false, false) => &[Level::Coarse],
    }
}

/// Runs what the checks of one case look at.
fn one(path: &Path, arguments: &VerifyArguments, stop: &AtomicBool) -> Found {
    let read = |variant: Option<&str>, level: Level| -> Result<Case, Fault> {
        let variant = variant.map(str::to_owned);
        let options = LoadOptions { variant, level, ..LoadOptions::default() };
        load(path, &options).map_err(|problems| refusal(path, &problems))
    };
    let folder = folder_name(path);
    let mut found = PageCase {
        name: folder.clone(),
        link: path.display().to_string(),
        pictures: Vec::new(),
        settings: Vec::new(),
    };
    // Settings that are the same case in the end share one run.
    let mut known: Vec<(String, Rc<Finished>)> = Vec::new();
    for level in levels(arguments) {
        let base = match read(None, *level) {
            Ok(base) => base,
            Err(fault) => {
                terminal::report(&terminal::coloured(&fault.report));
                return Found::Unreadable(Box::new((folder, vec![unreadable()])));
            }
        };
        let name = base.id.clone().unwrap_or_else(|| folder.clone());
        let all = needed_variants(&base).len();
        let only_paper = arguments.paper && !arguments.full && *level == Level::Case;
        let mut runs = Vec::new();
        let mut rows = evaluate(&base, &mut |variant| {
            let number = runs.len() + 1;
            let case = read(variant, *level).map_err(|fault| fault.report.trim_end().to_owned())?;
            let traits = base.traits_of(variant);
            let mut missing = |case: &Case, attempt: Attempt, why: &str| {
                runs.push((variant.map(str::to_owned), case.clone(), attempt));
                Err(NotRun { case: Some(Box::new(case.clone())), reason: why.to_owned() })
            };
            if traits.is_long && !arguments.is_long_wanted(variant)
                || only_paper && !traits.is_paper
            {
                return missing(&case, Attempt::Left, "it takes long, and has not been run");
            }
            let same = known.iter().find(|(as_run, _)| *as_run == case.as_run);
            let run = match same {
                Some((_, run)) => Rc::clone(run),
                None if stop.load(Ordering::Relaxed) => {
                    return missing(&case, Attempt::Left, "interrupted before its run");
                }
                None => {
                    let setting = level.name();
                    let label = match variant {
                        Some(variant) => format!("{name} {setting} {variant} ({number} of {all})"),
                        None => format!("{name} {setting} ({number} of {all})"),
                    };
                    let kept = arguments.keep.as_ref();
                    let kept = kept.map(|keep| kept_folder(keep, path, *level, variant));
                    let run = match run_quietly(&case, &label, kept.as_deref(), stop) {
                        Err(reason) => return missing(&case, Attempt::Failed, &reason),
                        Ok(run) if run.summary.outcome == Outcome::Interrupted => {
                            return missing(&case, Attempt::Left, "interrupted");
                        }
                        Ok(run) => Rc::new(run),
                    };
                    known.push((case.as_run.clone(), Rc::clone(&run)));
                    run
                }
            };
            let finished = Attempt::Finished(Rc::clone(&run));
            runs.push((variant.map(str::to_owned), case.clone(), finished));
            Ok(VariantRun { case, run })
        });
        if only_paper {
            rows.retain(|row| row.level == Level::Paper);
        }
        if !rows.is_empty() {
            found.settings.push(SettingRuns { case: base, rows, runs });
        }
    }
    // Of a case that was interrupted before the end of its first run there is nothing to tell.
    match found.settings.is_empty() || stop.load(Ordering::Relaxed) && known.is_empty() {
        true => Found::Nothing,
        false => Found::Case(Box::new(found)),
    }
}

/// Runs a case: without files, or with those of a run that is kept in a folder, which it continues.
fn run_quietly(
    case: &Case,
    label: &str,
    kept: Option<&Path>,
    stop: &AtomicBool,
) -> Result<Finished, String> {
    let mut session =
        Session::new(case).map_err(|problems| problems.to_string().trim_end().to_owned())?;
    let mut display = Display::new(label, Audience::Person);
    let place = match kept {
        Some(folder) if folder.exists() => session.resume_from(folder),
        Some(folder) => session.write_to(folder),
        None => Ok(()),
    };
    let run = || session.run(stop, &mut |progress| display.update(progress));
    place.and_then(|()| run()).map_err(|error| match kept {
        Some(folder) => format!("{}: {error}\nremove that folder to begin anew", folder.display()),
        None => error.to_string(),
    })
}

/// Where a run is kept: below `keep`, at the path of the case, in a folder called after setting and variant.
fn kept_folder(keep: &Path, path: &Path, level: Level, variant: Option<&str>) -> PathBuf {
    let stem = path.with_extension("");
    // Without `..` and the root: what is kept stays below `keep`.
    let is_name = |part: &Component<'_>| matches!(part, Component::Normal(_));
    let mut names: Vec<Component<'_>> = stem.components().filter(is_name).collect();
    names.pop_if(|name| name.as_os_str() == "case");
    let run = [Some(level.name()), variant].into_iter().flatten().collect::<Vec<_>>().join("-");
    names.iter().fold(keep.to_owned(), |folder, name| folder.join(name)).join(run)
}

/// The name of the folder of a case file, which stands for its id where it has none.
fn folder_name(path: &Path) -> String {
    let resolved = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let name = resolved.parent().and_then(Path::file_name);
    name.map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

fn unreadable() -> Row {
    Row {
        quantity: "the case file".to_owned(),
        got: "-".to_owned(),
        expected: "a good case".to_owned(),
        reason: Some("the case cannot be read, see above".to_owned()),
        ..Row::default()
    }
}

/// The table, with the reason under each check that could not be evaluated.
fn render(rows: &[Rows]) -> String {
    let rows = || {
        let all = rows.iter().flat_map(|(id, rows)| rows.iter().map(move |row| (id, row)));
        all.filter(|(_, row)| row.was_run())
    };
    if rows().next().is_none() {
        return String::new();
    }
    let header = ["id", "setting", "quantity", "got", "expected", "tolerance", "source", "pass"];
    let header = header.map(str::to_owned).to_vec();
    let cells = |(id, row): (&String, &Row)| {
        vec![
            id.clone(),
            row.level.name().to_owned(),
            row.name(),
            row.got.clone(),
            row.expected.clone(),
            row.tolerance.clone(),
            row.source.clone(),
            match &row.unmet {
                Some(_) => "no".to_owned(),
                None => terminal::verdict(if row.pass { "yes" } else { "NO" }, row.pass),
            },
        ]
    };
    let table: Vec<Vec<String>> = std::iter::once(header).chain(rows().map(cells)).collect();
    let lines = table::align(&table, terminal::stdout_width(), &[6, 2, 4, 0]);
    let reasons = rows().map(|(_, row)| row.reason.as_deref().or(row.unmet.as_deref()));
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
