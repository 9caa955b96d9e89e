//! One page with all of a run: `report.html`, which needs nothing but itself.
//!
//! `page` is the frame and the order of the parts, `charts` draws curves as SVG, `frames`
//! reads the particles and `packed` makes them small, `viewer` puts them beside the program
//! that draws them in a browser. The page is bounded in size whatever the run, makes no request,
//! and its policy lets nothing run but its own two scripts.

mod charts;
mod checks;
mod facts;
mod files;
mod frames;
mod packed;
mod page;
mod pictures;
mod policy;
mod viewer;

use std::path::Path;

use super::plot::Series;
use super::{Column, OutputError, ResultsFolder, RunRecord, Table, atomic};

/// All that a page shows. Particles and pictures are read from the folder.
pub struct Report<'a> {
    /// The folder of the results.
    pub folder: &'a ResultsFolder,
    /// The record in it.
    pub record: &'a RunRecord,
    /// The checks of the case that speak of this run.
    pub checks: Vec<CheckLine>,
    /// Those that need another run.
    pub other_checks: Vec<OtherCheck>,
    /// Curves against time.
    pub charts: Vec<ChartGroup>,
    /// The table of energies; without columns if there is none.
    pub energy: Table,
    /// The field or component that colours the particles at first, as a case writes it.
    pub first_field: Option<String>,
    /// What could not be read.
    pub notes: Vec<String>,
}

/// One check, evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckLine {
    /// The quantity with its reduction.
    pub quantity: String,
    /// What was expected.
    pub expected: String,
    /// How far off the result may be.
    pub tolerance: String,
    /// What the run gave.
    pub got: String,
    /// Whether that is as expected.
    pub verdict: Verdict,
    /// Where the expected value comes from.
    pub source: String,
    /// Why it could not be evaluated.
    pub reason: Option<String>,
}

/// What came of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// As expected.
    Passed,
    /// Not as expected.
    Failed,
    /// Not as expected, for a reason that the case gives.
    Unmet,
    /// The run did not get far enough to say.
    Open,
}

/// A check that needs another run.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherCheck {
    /// The quantity with its reduction.
    pub quantity: String,
    /// What it needs.
    pub needs: String,
    /// Where the expected value comes from.
    pub source: String,
}

/// Charts under one heading.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartGroup {
    /// The heading.
    pub title: String,
    /// Its charts.
    pub charts: Vec<Chart>,
}

/// Curves against time, one panel for each unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What it shows.
    pub title: String,
    /// What they are against.
    pub across: Column,
    /// Its curves and references.
    pub series: Vec<Series>,
    /// Where the references come from.
    pub sources: Vec<String>,
}

/// Writes the page to the file `path` and returns its length in bytes.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, report: &Report) -> Result<u64, OutputError> {
    let page = page::page(report);
    atomic::write_file(path, |out| out.write_all(page.as_bytes()))
}
