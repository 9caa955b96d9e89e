//! `piola sweep`: a case with every value of one or two keys, side by side.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use piola::case::sweep::{Comparison, MemberResult};
use piola::case::{Case, Session};
use piola::output::OutputError;
use piola::time::Outcome;

use self::members::{Member, members};
use self::progress::Overall;
use super::run::default_folder;
use super::{locked, side_by_side};
use crate::arguments::SweepArguments;
use crate::exit::{Exit, Fault};
use crate::text::{count, duration, significant};
use crate::{interrupt, table, terminal};

mod members;
mod progress;

/// The comparison table, which also marks a folder as that of a sweep.
const TABLE: &str = "sweep.csv";
/// The folder of the charts, beside those of the members.
const PLOTS: &str = "plots";

/// Runs the members and compares them.
pub fn sweep(arguments: &SweepArguments) -> Result<Exit, Fault> {
    let (keys, members) = members(arguments)?;
    let folder = match &arguments.out {
        Some(folder) => folder.clone(),
        None => sweep_folder(&arguments.case.file.case, &members[0].case),
    };
    prepare(&folder)?;
    let stop = interrupt::listen();
    let comparison = Comparison {
        title: members[0].case.title.clone(),
        keys,
        members: members.iter().map(Member::waiting).collect(),
    };
    let sweep = Sweep {
        folder,
        members,
        comparison: Mutex::new((comparison, Vec::new())),
        progress: Overall::new(arguments.quiet),
    };
    sweep.save()?;
    side_by_side(sweep.members.len(), arguments.jobs, arguments.case.threads, &stop, |index| {
        sweep.work(index, &stop);
    });
    sweep.finish(arguments.quiet, stop.load(Ordering::Relaxed))
}

/// `results/` with the name of the case and of its variant, and `-sweep`.
fn sweep_folder(path: &Path, case: &Case) -> PathBuf {
    let variant = case.variant.as_deref().map(|name| name.split('.').next().unwrap_or(name));
    let mut name = default_folder(path, variant).into_os_string();
    name.push("-sweep");
    name.into()
}

/// Makes the folder ready. One that holds something else than a sweep is refused.
fn prepare(folder: &Path) -> Result<(), Fault> {
    let shown = folder.display();
    let fault = |error| Fault::new(Exit::Io, format!("cannot use the folder {shown}: {error}"));
    std::fs::create_dir_all(folder.join(PLOTS)).map_err(fault)?;
    let has_table = folder.join(TABLE).is_file();
    for entry in folder.read_dir().map_err(fault)? {
        let name = entry.map_err(fault)?.file_name();
        if !has_table && name != PLOTS {
            let message = format!(
                "the folder {shown} holds `{}` and no {TABLE} of an earlier sweep; choose another \
                 with --out",
                name.to_string_lossy()
            );
            return Err(Fault::new(Exit::Io, message));
        }
    }
    Ok(())
}

/// A sweep on its way. What went wrong with members is collected beside the comparison.
struct Sweep {
    folder: PathBuf,
    members: Vec<Member>,
    comparison: Mutex<(Comparison, Vec<Trouble>)>,
    progress: Overall,
}

/// What went wrong with a member.
struct Trouble {
    member: usize,
    exit: Exit,
    report: String,
}

impl Sweep {
    /// Runs a member and notes how it ended.
    fn work(&self, index: usize, stop: &AtomicBool) {
        let start = Instant::now();
        let result = self.run(index, &self.members[index], stop);
        let seconds = Some(start.elapsed().as_secs_f64());
        self.note(index, MemberResult { seconds, ..result });
    }

    fn run(&self, index: usize, member: &Member, stop: &AtomicBool) -> MemberResult {
        let failed = |exit: Exit, word: &str, report: String| {
            self.trouble(Trouble { member: index, exit, report });
            MemberResult { outcome: word.to_owned(), ..member.waiting() }
        };
        let mut session = match Session::new(&member.case) {
            Ok(session) => session,
            Err(problems) => {
                return failed(Exit::BadCase, "refused", problems.to_string());
            }
        };
        let folder = self.folder.join(&member.name);
        let mut watch = |progress: &piola::time::Progress| {
            self.progress.update(index, &member.name, progress, self.members.len());
        };
        let place = session.write_to(&folder);
        match place.and_then(|()| session.run(stop, &mut watch)) {
            Ok(finished) => {
                let outcome = &finished.summary.outcome;
                if let Outcome::Failed(failure) = outcome {
                    self.trouble(Trouble {
                        member: index,
                        exit: Exit::FailedRun,
                        report: format!("the run failed: {failure}"),
                    });
                }
                let outcome = outcome.summary();
                MemberResult { outcome, finished: Some(finished), ..member.waiting() }
            }
            Err(error) => failed(Exit::Io, "no files", error.to_string()),
        }
    }

    fn trouble(&self, trouble: Trouble) {
        locked(&self.comparison).1.push(trouble);
    }

    fn note(&self, index: usize, result: MemberResult) {
        let line = format!(
            "{}: {}, {}",
            result.name,
            result.outcome,
            duration(result.seconds.unwrap_or_default())
        );
        locked(&self.comparison).0.members[index] = result;
        self.progress.ended(index, &line, self.members.len());
        // What cannot be written now cannot be written at the end, where it is reported.
        let _ = self.save();
    }

    fn save(&self) -> Result<(), Fault> {
        let fault = |error: OutputError| Fault::new(Exit::Io, error);
        locked(&self.comparison).0.write_csv(&self.folder.join(TABLE)).map_err(fault)?;
        Ok(())
    }

    /// Writes table and charts, shows what there is, and says how the program ends.
    fn finish(self, quiet: bool, interrupted: bool) -> Result<Exit, Fault> {
        self.progress.clear();
        self.save()?;
        let (comparison, mut troubles) =
            self.comparison.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        let plots = self.folder.join(PLOTS);
        let charts = comparison.charts();
        for (name, chart) in &charts {
            let path = plots.join(format!("{name}.png"));
            chart.write_png(&path).map_err(|error| Fault::new(Exit::Io, error))?;
        }
        if !quiet {
            let folder = self.folder.display();
            let charts = count(charts.len() as u64, "chart");
            let text =
                format!("{}\nin {folder}: {TABLE}, {PLOTS} ({charts})\n", render(&comparison));
            terminal::print(&text)?;
        }
        troubles.sort_by_key(|trouble| trouble.member);
        for trouble in &troubles {
            let name = &comparison.members[trouble.member].name;
            let report = trouble.report.trim_end();
            let report = report.strip_prefix("error: ").unwrap_or(report);
            let report = format!("error: {name}: {report}\n");
            terminal::report(&terminal::coloured(&report));
        }
        if interrupted {
            let left = comparison.members.iter().filter(|member| member.finished.is_none());
            let left = count(left.count() as u64, "member");
            terminal::report(&format!("interrupted: {left} not run\n"));
            return Ok(Exit::Interrupted);
        }
        let exits = [Exit::Io, Exit::FailedRun, Exit::BadCase];
        let worst = exits.into_iter().find(|exit| troubles.iter().any(|it| it.exit == *exit));
        Ok(worst.unwrap_or(Exit::Success))
    }
}

/// The table for a screen: last values of the probes and of the total energy.
fn render(comparison: &Comparison) -> String {
    let columns = comparison.headlines();
    let mut header = comparison.keys.clone();
    header.extend(["outcome", "steps", "wall time"].map(str::to_owned));
    header.extend(columns.iter().map(|name| format!("{name} at end")));
    let row = |member: &MemberResult| {
        let mut cells: Vec<String> = member.values.iter().map(|value| value.text.clone()).collect();
        let steps = member.finished.as_ref().map(|finished| finished.summary.steps.to_string());
        cells.push(terminal::verdict(&member.outcome, member.outcome == "completed"));
        cells.push(steps.unwrap_or_else(|| "-".to_owned()));
        cells.push(member.seconds.map_or_else(|| "-".to_owned(), duration));
        cells.extend(columns.iter().map(|name| match comparison.last(member, name) {
            Some((value, unit)) => format!("{} {unit}", significant(value, 6)),
            None => "-".to_owned(),
        }));
        cells
    };
    let rows: Vec<Vec<String>> =
        std::iter::once(header).chain(comparison.members.iter().map(row)).collect();
    let keys = comparison.keys.len();
    let shrinkable: Vec<usize> = (keys + 3..rows[0].len()).rev().chain(0..keys).collect();
    table::align(&rows, terminal::stdout_width(), &shrinkable).join("\n") + "\n"
}
