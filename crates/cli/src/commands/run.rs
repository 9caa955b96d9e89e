//! `piola run`.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Instant;

use piola::time::Outcome;

use super::{assemble, read, use_threads};
use crate::arguments::RunArguments;
use crate::exit::{Exit, Fault};
use crate::progress::Display;
use crate::summary::summary;
use crate::{interrupt, terminal};

/// Runs a case and writes its results.
pub fn run(arguments: &RunArguments) -> Result<Exit, Fault> {
    use_threads(arguments.case.threads);
    let case = read(&arguments.case)?;
    let path = &arguments.case.case;
    let folder = match &arguments.out {
        Some(folder) => folder.clone(),
        None => default_folder(path, case.variant.as_deref()),
    };
    let stop = interrupt::listen();
    let simulation = assemble(path, &case)?;
    let end = *case.time.end;

    let mut display = Display::new("", arguments.quiet);
    let start = Instant::now();
    let finished = simulation
        .run(Some(&folder), &stop, &mut |progress| display.update(progress))
        .map_err(|error| Fault::new(Exit::Io, error))?;
    drop(display);
    if !arguments.quiet {
        terminal::print(&summary(&finished, end, &folder, start.elapsed().as_secs_f64()))?;
    }
    match &finished.summary.outcome {
        Outcome::Completed => Ok(Exit::Success),
        Outcome::Interrupted => Ok(Exit::Interrupted),
        Outcome::Failed(failure) => Err(Fault::new(
            Exit::FailedRun,
            format!("the run failed: {failure}\nthe last good state is in {}", folder.display()),
        )),
    }
}

/// `results/` with the name of the case's folder, or of the case file if it is not called
/// `case.toml`, and of the variant.
pub(super) fn default_folder(path: &Path, variant: Option<&str>) -> PathBuf {
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
    Path::new("results").join(name)
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
