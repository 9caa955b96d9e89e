//! `piola run`.

use std::ffi::OsString;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use piola::case::{self, RunError, Session, Unserved};
use piola::time::{Outcome, Progress};
use piola_ranks::Ranks;

use super::{assemble, read, refusal, use_threads};
use crate::arguments::RunArguments;
use crate::exit::{Exit, Fault};
use crate::progress::{Audience, Display};
use crate::summary::summary;
use crate::text::count;
use crate::{events, interrupt, ranks, terminal};

/// Runs a case and writes its results.
pub fn run(arguments: &RunArguments) -> Result<Exit, Fault> {
    let ranks = ranks::start()?;
    let ended = match ranks.as_ref().filter(|ranks| ranks.rank() > 0) {
        Some(ranks) => serve(arguments, ranks),
        None => execute(arguments, ranks.as_ref()),
    };
    let Err(fault) = ended else { return ended };
    if arguments.json_progress && !fault.report.is_empty() {
        events::error(&fault);
    }
    // Ranks that have failed are ended with the last that knows of them: what there is to tell is told before.
    terminal::report(&terminal::coloured(&fault.report));
    Err(Fault { report: String::new(), ..fault })
}

fn execute(arguments: &RunArguments, ranks: Option<&Arc<dyn Ranks>>) -> Result<Exit, Fault> {
    use_threads(arguments.case.threads);
    let decline = |fault: &Fault| {
        ranks.iter().for_each(|ranks| case::decline(ranks.as_ref(), &fault.report));
    };
    let case = read(&arguments.case).inspect_err(decline)?;
    let path = &arguments.case.file.case;
    let folder = match &arguments.out {
        Some(folder) => folder.clone(),
        None => default_folder(path, case.variant.as_deref()),
    };
    let audience = match (arguments.quiet, arguments.json_progress) {
        (true, _) => Audience::Nobody,
        (false, true) => Audience::Program,
        (false, false) => Audience::Person,
    };
    let stop = interrupt::listen();
    let mut session = match ranks {
        Some(ranks) => {
            Session::on_ranks(&case, ranks.clone()).map_err(|problems| refusal(path, &problems))?
        }
        None => assemble(path, &case)?,
    };
    let end = *case.time.end;
    if audience == Audience::Program {
        events::start(path, &folder, end);
    }

    let mut display = Display::new("", audience);
    let start = Instant::now();
    let mut update = |progress: &Progress| display.update(progress);
    let place = match arguments.resume {
        true => session.resume_from(&folder),
        false => session.write_to(&folder),
    };
    let finished = place.and_then(|()| session.run(&stop, &mut update));
    let finished = finished.map_err(|error| Fault::new(code(&error), error))?;
    drop(display);
    let seconds = start.elapsed().as_secs_f64();
    match audience {
        Audience::Person => terminal::print(&summary(&finished, end, &folder, seconds))?,
        Audience::Program => events::end(&finished, &folder, seconds),
        Audience::Nobody => {}
    }
    match &finished.summary.outcome {
        Outcome::Completed => Ok(Exit::Success),
        Outcome::Interrupted => Ok(Exit::Interrupted),
        Outcome::Failed(failure) => {
            let mut text = format!("the run failed: {failure}");
            if let Some(retries @ 1..) = Some(finished.summary.retries.len()) {
                let _ =
                    write!(text, "\nit had already gone back {}", count(retries as u64, "time"));
            }
            let _ = write!(text, "\nthe last good state is in {}", folder.display());
            if finished.summary.trace.is_some() {
                text.push_str(
                    ", the last steps of the particle and its neighbours in failure.csv there",
                );
            }
            Err(Fault::new(Exit::FailedRun, text))
        }
    }
}

/// Takes part in the run of rank 0, which tells of it, and of what keeps any of them from beginning.
fn serve(arguments: &RunArguments, ranks: &Arc<dyn Ranks>) -> Result<Exit, Fault> {
    use_threads(arguments.case.threads);
    let case = read(&arguments.case).map_err(|fault| {
        case::decline(ranks.as_ref(), &fault.report);
        Fault { report: String::new(), ..fault }
    })?;
    let stop = interrupt::listen_quietly();
    case::serve(&case, ranks.clone(), stop).map_err(|unserved| match unserved {
        Unserved::Refused => Fault { exit: Exit::BadCase, report: String::new() },
        Unserved::Ended => Fault { exit: Exit::FailedRun, report: String::new() },
        Unserved::Lost(lost) => {
            Fault::new(Exit::FailedRun, format_args!("rank {}: {lost}", ranks.rank()))
        }
    })?;
    Ok(Exit::Success)
}

/// What a run that cannot write or go on ends with.
fn code(error: &RunError) -> Exit {
    match error {
        RunError::NoCheckpoint { .. } | RunError::Misfit(_) => Exit::BadCase,
        _ => Exit::Io,
    }
}

/// `results/` with the name of the case's folder, or of the case file if it is not called
/// `case.toml`, and of the variant.
pub(super) fn default_folder(path: &Path, variant: Option<&str>) -> PathBuf {
    Path::new("results").join(default_name(path, variant))
}

/// The name of the folder of results of a case.
pub(crate) fn default_name(path: &Path, variant: Option<&str>) -> OsString {
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let name = match path.file_stem() {
        Some(stem) if stem != "case" => Some(stem),
        _ => path.parent().and_then(Path::file_name),
    };
    let mut name = name.map_or_else(|| OsString::from("case"), OsString::from);
    if let Some(variant) = variant {
        name.push("-");
        name.push(variant);
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_named_after_the_case() {
        for (path, variant, folder) in [
            ("cases/upwind/impact/case.toml", None, "results/impact"),
            ("cases/upwind/impact/case.toml", Some("fine"), "results/impact-fine"),
            ("cases/impact/wall.toml", None, "results/wall"),
            ("/case.toml", None, "results/case"),
        ] {
            assert_eq!(default_folder(Path::new(path), variant), Path::new(folder));
        }
    }
}
