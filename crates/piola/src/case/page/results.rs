//! The results of checks as they are kept beside the validation page, as JSON: the page is made of
//! nothing else, so that a single case can be run again, and long runs keep their results.

use serde::{Deserialize, Serialize};

use super::super::model::{Against, Level};
use super::super::verify::{CheckRow, Got};
use crate::output::significant;

/// All of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Version of the program.
    pub version: String,
    /// The cases, in the order of the page.
    pub cases: Vec<CaseResults>,
}

/// Those of one case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CaseResults {
    /// Its row of the reproduction list, or the name of its folder.
    pub id: String,
    /// Name of its folder.
    pub name: String,
    /// What it shows.
    pub title: String,
    /// The link to its page or file, relative to the validation page.
    pub link: String,
    /// Number of runs.
    pub runs: usize,
    /// Least and most particles of a run.
    pub particles: [usize; 2],
    /// The checks.
    pub rows: Vec<Row>,
    /// Its charts: name, and file in the folder of the page.
    pub charts: Vec<(String, String)>,
    /// Pictures that its page shows: name, and link relative to the validation page.
    pub pictures: Vec<(String, String)>,
}

/// One check at one setting, of one run or of a line of members of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of the check in the case, from 0.
    pub check: usize,
    /// The setting that was read.
    pub read_at: Level,
    /// The setting that it counts as: the paper's if the run has the publication's numbers.
    pub level: Level,
    /// What was run, as [`CheckRow::run`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub run: Option<String>,
    /// The runs that it uses, `None` for the case itself.
    pub runs: Vec<Option<String>>,
    /// The quantity with its reduction.
    pub quantity: String,
    /// What was expected.
    pub expected: String,
    /// How far off it may be.
    pub tolerance: String,
    /// The result.
    pub got: String,
    /// How far off it is.
    pub off_by: String,
    /// What the expected value is worth as evidence.
    pub against: Option<Against>,
    /// Where it comes from.
    pub source: String,
    /// Why the tolerance, or the bound, is what it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<String>,
    /// Whether the check passes.
    pub pass: bool,
    /// Why it does not, if it is known not to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unmet: Option<String>,
    /// Why it does not, if it is not the number that is off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The results of the members, for a trend.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub members: Option<String>,
    /// Evaluations of the rates times particles, of all its runs.
    pub work: u64,
    /// A fingerprint of the cases that were run.
    pub fingerprint: String,
    /// Whether one of its runs takes long.
    pub is_long: bool,
    /// The day on which a long one was run, `None` for one that was not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// Whether an interruption came before the end of its runs. Such a row is on no page.
    #[serde(skip)]
    pub is_interrupted: bool,
    /// Whether one of its runs takes long and could not begin, or not be continued. It fails, but an earlier result stays
    /// on the page.
    #[serde(skip)]
    pub has_no_run: bool,
}

impl Row {
    /// The row of a check that was evaluated on the case as `read_at` has it, by runs that took
    /// `work` and whose cases have the sum `fingerprint`.
    pub fn new(row: &CheckRow, read_at: Level, work: u64, fingerprint: String) -> Self {
        Self {
            check: row.check,
            read_at,
            level: row.level,
            run: row.run.clone(),
            runs: row.runs.clone(),
            quantity: row.quantity.clone(),
            expected: row.expected.clone(),
            tolerance: row.tolerance.clone(),
            got: row.got.as_ref().map_or_else(|| "-".to_owned(), Got::to_string),
            off_by: row.deviation.clone(),
            against: row.against,
            source: row.source.clone(),
            bound: row.bound.clone(),
            pass: row.pass,
            unmet: row.unmet.clone(),
            reason: row.reason.as_ref().filter(|_| !row.pass).cloned(),
            members: members(row),
            work,
            fingerprint,
            is_long: row.is_long,
            date: None,
            is_interrupted: false,
            has_no_run: false,
        }
    }

    /// What the row is about: the quantity, with what was run in front.
    pub fn name(&self) -> String {
        match &self.run {
            Some(run) => format!("{run}: {}", self.quantity),
            None => self.quantity.clone(),
        }
    }

    /// Whether both are of the same check of the same runs of the same case.
    fn is_same(&self, other: &Self) -> bool {
        // The unit of a bound is only known from values.
        let bound = |row: &Self| row.tolerance.split(' ').next().map(str::to_owned);
        let key = |row: &Self| (row.read_at, row.name(), bound(row), row.source.clone());
        key(self) == key(other) && self.fingerprint == other.fingerprint
    }

    /// Whether it was run and is not met without a known reason.
    pub fn is_failed(&self) -> bool {
        self.was_run() && !self.pass && self.unmet.is_none()
    }

    /// Whether it was run at all.
    pub fn was_run(&self) -> bool {
        !self.is_interrupted && (!self.is_long || self.date.is_some())
    }
}

impl CaseResults {
    /// Takes what `earlier` has of runs that were not run again, since they take long, came after an interruption or could
    /// not begin, of the case as it is now.
    pub fn keep(&mut self, earlier: &Self) {
        let is_part =
            self.rows.iter().any(|row| row.is_long || row.is_interrupted || row.has_no_run);
        let mut keeps = false;
        for row in self.rows.iter_mut().filter(|row| !row.was_run() || row.has_no_run) {
            let same = || earlier.rows.iter().filter(|known| known.was_run() && known.is_same(row));
            // Two checks may ask for different bounds of one quantity, and a check may have moved.
            // Units are only known from values: what is asked are words among those of the row that is known.
            let asks = |known: &&Row| {
                let mut words = known.expected.split([' ', ',']);
                row.expected.split([' ', ',']).all(|asked| words.any(|word| word == asked))
            };
            let known = same().find(|known| asks(known) && known.check == row.check);
            let known = known.or_else(|| same().find(asks));
            let known = known.or_else(|| same().find(|_| !row.is_interrupted));
            if let Some(known) = known {
                keeps = true;
                // What the check says today of the value and its worth stays; why it is not met is only told of values.
                let (against, bound) = (row.against, row.bound.clone());
                let unmet = row.unmet.as_ref().or(known.unmet.as_ref()).filter(|_| !known.pass);
                let unmet = unmet.cloned();
                *row = Row { check: row.check, against, bound, unmet, ..known.clone() };
            }
        }
        if keeps {
            self.runs = self.runs.max(earlier.runs);
            let [[least, most], [earlier_least, earlier_most]] =
                [self.particles, earlier.particles];
            self.particles = [least.min(earlier_least), most.max(earlier_most)];
        }
        let kept = earlier.charts.iter().filter(|_| is_part);
        let new: Vec<_> = kept.filter(|chart| !self.charts.contains(chart)).cloned().collect();
        self.charts.extend(new);
    }

    /// Checks that passed, and all that were run, with this worth. One that was evaluated at several settings of
    /// a case counts once, as at the last.
    pub fn count(&self, against: Option<Against>) -> [usize; 2] {
        // Members of a sweep may be others at another setting.
        let is_repeated = |row: &Row| {
            let is_later = |other: &Row| other.read_at > row.read_at && other.was_run();
            self.rows.iter().any(|other| other.check == row.check && is_later(other))
        };
        let own = self.rows.iter().filter(|row| row.against == against && row.was_run());
        let own = own.filter(|row| !is_repeated(row));
        [own.clone().filter(|row| row.pass).count(), own.count()]
    }
}

/// What the members of a sweep gave, from which its order, ratio or direction was taken.
fn members(row: &CheckRow) -> Option<String> {
    let data = row.trend.as_ref()?;
    let each = data.points.iter().map(|point| {
        let number = point.error.filter(|_| data.of_error).unwrap_or(point.value);
        format!("{} at {}", significant(number, 4), point.text)
    });
    let unit = if data.unit == "1" { String::new() } else { format!(", in {}", data.unit) };
    Some(format!("{}{unit}: {}", row.quantity, each.collect::<Vec<_>>().join("; ")))
}
