//! The report of a run, made from its results folder alone.
//!
//! A run calls [`write()`] when all its other files are there, and `piola report` calls the same, so
//! that both make the same page to the byte. What the case says (checks, plots, pictures) is read
//! from the case as run, which the record holds.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::model::{Case, Check, ProbeKind};
use super::recorded;
use super::verify::{CheckRow, Ending, RunResults, VariantRun, verify};
use crate::observe::{Series, Tables};
use crate::output::report::{self, Chart, ChartGroup, CheckLine, OtherCheck, Report, Verdict};
use crate::output::{
    self, Column, Curve, OutputError, RecordError, ResultsFolder, RunRecord, Table,
};

pub(super) mod charts;

/// A report could not be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The folder holds no results.
    #[error(
        "{source}. Give the folder of results of an earlier run, the one with `run.json` in it"
    )]
    NoRun {
        /// What is wrong with the record.
        source: RecordError,
    },
    /// The page could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Writes `report.html` into the results folder `folder`, and returns its path. What is damaged or
/// missing in the folder is left out, and the page says so.
///
/// # Errors
/// The folder holds no record of a run, or the page cannot be written.
pub fn write(folder: &Path) -> Result<PathBuf, ReportError> {
    let (folder, record) =
        ResultsFolder::of_run(folder).map_err(|source| ReportError::NoRun { source })?;
    let mut notes = Vec::new();
    let mut tables = tables(&folder, &mut notes);
    let case = recorded(&record.case_text, record.variant.as_deref());
    let mut case = case
        .inspect_err(|_| {
            notes.push(
                "The case in the record cannot be read by this version of the program, so checks \
                 and the plots of the case are left out."
                    .into(),
            );
        })
        .ok();
    if let Some(case) = &mut case {
        case.is_changed = !record.overrides.is_empty();
        find_references(case, &folder, &record);
        tables.profiles = profiles(case, &folder);
    }
    let run = Recorded { record: &record, tables };
    let page = Report {
        checks: case.as_ref().map_or_else(Vec::new, |case| checks(case, &run)),
        other_checks: case.as_ref().map_or_else(Vec::new, |case| other_checks(case, &run)),
        charts: charts::groups(case.as_ref(), &run.tables),
        energy: run.tables.energy.clone(),
        first_field: case.as_ref().and_then(first_field),
        notes,
        record: &record,
        folder: &folder,
    };
    let path = folder.report();
    report::write(&path, &page)?;
    Ok(path)
}

/// The tables in the folder; empty ones for those that are missing or damaged.
fn tables(folder: &ResultsFolder, notes: &mut Vec<String>) -> Tables {
    let mut read = |path: PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !path.exists() {
            notes.push(format!("There is no {name}."));
            return Table::default();
        }
        Table::read_csv(&path).unwrap_or_else(|_| {
            notes.push(format!("{name} is damaged and left out."));
            Table::default()
        })
    };
    Tables {
        probes: read(folder.probes()),
        energy: read(folder.energy()),
        momentum: read(folder.momentum()),
        steps: read(folder.steps()),
        profiles: Vec::new(),
        over_time: Vec::new(),
    }
}

/// The newest profile of each line of the case that has one.
fn profiles(case: &Case, folder: &ResultsFolder) -> Vec<Table> {
    let lines = case.probes.iter().filter(|probe| matches!(probe.kind, ProbeKind::Line { .. }));
    let files = lines.filter_map(|line| folder.last_profile(&line.name));
    files.filter_map(|file| Table::read_csv(&file).ok()).collect()
}

/// Turns the names of reference curves into the paths of their copies.
fn find_references(case: &mut Case, folder: &ResultsFolder, record: &RunRecord) {
    for check in &mut case.checks {
        let Some(file) = check.reduce.reference_mut() else { continue };
        let name = file.to_string_lossy();
        let copy = record.references.iter().find(|reference| reference.path == name);
        let copy = copy.and_then(|reference| folder.inside(&reference.file));
        // A name that leads nowhere makes the check say that its reference cannot be read.
        file.value = copy.unwrap_or_else(|| folder.path().join("references").join("missing"));
    }
}

/// A run as its folder tells of it.
struct Recorded<'a> {
    record: &'a RunRecord,
    tables: Tables,
}

impl RunResults for Recorded<'_> {
    fn ending(&self) -> Ending {
        Ending { summary: self.record.outcome.clone(), message: self.record.message.clone() }
    }

    fn quantity(&self, name: &str) -> Option<Series> {
        let Some(figure) = name.strip_prefix("run.") else { return self.tables.curve(name) };
        if figure == "outcome" {
            return Some(Series::Text(self.record.outcome.clone()));
        }
        let found = self.record.figures.iter().find(|known| known.name == figure)?;
        let unit = ["s", "m/s"].into_iter().find(|unit| *unit == found.unit).unwrap_or("1");
        Some(Series::Number { value: found.value, unit })
    }
}

/// What is said of a check that looks at another run.
const NOT_THIS_RUN: &str = "not this run";

/// The table of all checks, in which those that need another run say so.
fn rows(case: &Case, run: &Recorded) -> Vec<CheckRow> {
    verify(case, &mut |variant| {
        if variant != run.record.variant.as_deref() {
            return Err(NOT_THIS_RUN.to_owned().into());
        }
        let run = Recorded { record: run.record, tables: run.tables.clone() };
        Ok(VariantRun { case: case.clone(), run })
    })
}

/// Whether this row can be evaluated on this run alone.
fn is_own(row: &CheckRow) -> bool {
    !row.reason.as_ref().is_some_and(|reason| reason.ends_with(NOT_THIS_RUN))
}

fn checks(case: &Case, run: &Recorded) -> Vec<CheckLine> {
    let own = rows(case, run).into_iter().filter(is_own);
    own.map(|row| CheckLine {
        got: row.got.map_or_else(|| "nothing".into(), |got| got.to_string()),
        verdict: match (run.record.outcome.as_str(), row.pass) {
            (_, true) => Verdict::Passed,
            ("interrupted" | "running", false) => Verdict::Open,
            _ if row.unmet.is_some() => Verdict::Unmet,
            _ => Verdict::Failed,
        },
        quantity: row.quantity,
        expected: row.expected,
        tolerance: row.tolerance,
        source: row.source,
        reason: row.unmet.or(row.reason),
    })
    .collect()
}

fn other_checks(case: &Case, run: &Recorded) -> Vec<OtherCheck> {
    let others = rows(case, run).into_iter().filter(|row| !is_own(row));
    others
        .map(|row| OtherCheck {
            needs: match (&row.run, row.run == run.record.variant) {
                (_, true) => row.expected,
                (Some(other), _) if other.starts_with("sweep ") => other.clone(),
                (Some(variant), _) => format!("variant {variant}"),
                (None, _) => "the case itself".into(),
            },
            quantity: row.quantity,
            source: row.source,
        })
        .collect()
}

/// The field that colours the first picture, which is what the author looks at.
fn first_field(case: &Case) -> Option<String> {
    let picture = case.pictures.first()?;
    Some(picture.field.name(case.dimension))
}
