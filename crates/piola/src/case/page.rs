//! The validation page: every check of many cases with its result and its value as evidence, and charts, as Markdown.
//!
//! The same results give the same bytes: except for the dates of long runs, it contains no time of day, wall time or
//! machine.

use std::fmt::Write;
use std::rc::Rc;

use super::finished::Finished;
use super::model::{Against, Case, Level};
use super::verify::CheckRow;
use crate::output::Plot;
pub use reproduction::{Met, Reproduction};
pub use results::{CaseResults, Results, Row};

mod charts;
mod reproduction;
mod results;

/// A case with its rows and runs.
pub struct PageCase {
    /// Name of its folder, which names its charts, and is used as its id if it has none.
    pub name: String,
    /// The link to its page or file, relative to the validation page.
    pub link: String,
    /// Pictures that its page shows: name, and link relative to the validation page.
    pub pictures: Vec<(String, String)>,
    /// What was run, the quickest setting first.
    pub settings: Vec<SettingRuns>,
}

/// The runs of a case at one setting.
pub struct SettingRuns {
    /// The case at this setting.
    pub case: Case,
    /// The checks.
    pub rows: Vec<CheckRow>,
    /// What was run, `None` for the case itself, each with the case as it was run.
    pub runs: Vec<(Option<String>, Case, Attempt)>,
}

/// What came of a run.
pub enum Attempt {
    /// Its results.
    Finished(Rc<Finished>),
    /// It was not asked for, or interrupted.
    Left,
    /// It could not begin, or not be continued.
    Failed,
}

impl Attempt {
    fn finished(&self) -> Option<&Finished> {
        match self {
            Self::Finished(run) => Some(run),
            Self::Left | Self::Failed => None,
        }
    }
}

impl SettingRuns {
    /// The runs that there are, by name.
    fn finished(&self) -> impl Iterator<Item = (&Option<String>, &Finished)> {
        self.runs.iter().filter_map(|(name, _, run)| Some((name, run.finished()?)))
    }
}

/// The papers by the letter of their ids in the list of reproductions.
const PAPERS: [(char, &str); 4] = [
    ('U', "Upwind: Pilotto (2025)"),
    ('T', "CTVF: Adepu and Ramachandran (2021)"),
    ('S', "Dual-support: Ren, Zhuang, Rabczuk and Zhu (2023)"),
    ('E', "Elastodynamics: Ismail (2009)"),
];
const NO_PAPER: &str = "Other cases";

impl PageCase {
    /// The results of its checks, and its charts with the names of their files. `today` dates what
    /// takes long. `None` where nothing was run.
    pub fn results(&self, today: &str) -> Option<(CaseResults, Vec<(String, Plot)>)> {
        // Charts are of the case as it stands, where that was run.
        let main = self.settings.iter().find(|setting| setting.case.level == Level::Case);
        let main = main.or(self.settings.first())?;
        let mut charts = Vec::new();
        for setting in &self.settings {
            let suffix = match setting.case.level {
                Level::Paper => "-paper",
                level if level == main.case.level => "",
                _ => continue,
            };
            for (chart, plot) in charts::charts(setting) {
                let name = format!("{chart}{suffix}");
                let file = format!("{}-{}-{name}.png", self.id(), self.name);
                charts.push((name, file, plot));
            }
        }
        let finished = self.settings.iter().flat_map(|setting| &setting.runs);
        let particles = finished.filter_map(|(.., run)| Some(run.finished()?.particles));
        let results = CaseResults {
            id: self.id(),
            name: self.name.clone(),
            title: main.case.title.clone(),
            link: self.link.clone(),
            runs: particles.clone().count(),
            particles: [particles.clone().min(), particles.max()].map(Option::unwrap_or_default),
            rows: self.rows(today),
            charts: charts.iter().map(|(name, file, _)| (name.clone(), file.clone())).collect(),
            pictures: self.pictures.clone(),
        };
        Some((results, charts.into_iter().map(|(_, file, plot)| (file, plot)).collect()))
    }

    /// The rows of all settings, of which `today` dates what takes long. What is the same run at two settings stands there once, as that of
    /// the case as it stands.
    pub fn rows(&self, today: &str) -> Vec<Row> {
        let mut rows: Vec<Row> = Vec::new();
        for setting in &self.settings {
            for row in &setting.rows {
                let known = |name: &Option<String>| setting.runs.iter().find(|run| run.0 == *name);
                let runs: Vec<_> = row.runs.iter().filter_map(known).collect();
                let finished = runs.iter().filter_map(|(.., run)| run.finished());
                let work = finished.map(|run| run.summary.evaluations).sum();
                let is_left = runs.iter().any(|(.., run)| matches!(run, Attempt::Left));
                // Of a case that cannot be read there is no run.
                let has_failed = runs.len() < row.runs.len()
                    || runs.iter().any(|(.., run)| matches!(run, Attempt::Failed));
                let sums: Vec<String> =
                    runs.iter().map(|(_, case, _)| case.fingerprint()).collect();
                let mut new = Row::new(row, setting.case.level, work, sums.join(" "));
                new.is_interrupted = !row.is_long && is_left;
                new.has_no_run = row.is_long && has_failed;
                if row.is_long && (has_failed || !is_left) {
                    new.date = Some(today.to_owned());
                }
                rows.retain(|other| {
                    let is_same = other.check == new.check && other.name() == new.name();
                    !(is_same && other.fingerprint == new.fingerprint)
                });
                rows.push(new);
            }
        }
        rows.sort_by_key(|row| (row.check, row.read_at));
        rows
    }

    /// Its id, or the name of its folder.
    pub fn id(&self) -> String {
        let id = self.settings.first().and_then(|setting| setting.case.id.clone());
        id.unwrap_or_else(|| self.name.clone())
    }
}

impl Results {
    /// Puts the results of a case in the place of earlier ones, of which those of runs that take
    /// long, or that an interruption has left out, are kept where the case has not changed since.
    pub fn put(&mut self, mut case: CaseResults) {
        let is_same = |known: &CaseResults| known.link == case.link;
        if let Some(index) = self.cases.iter().position(is_same) {
            case.keep(&self.cases[index]);
            self.cases.remove(index);
        }
        case.rows.retain(|row| !row.is_interrupted);
        self.cases.push(case);
        self.cases.sort_by_key(|case| (place(&case.id), case.name.clone()));
    }

    /// The page, with its charts in the folder `charts` beside it, and what is said of the rows of
    /// the reproduction list.
    pub fn page(&self, list: &[Reproduction], charts: &str) -> String {
        let mut page = String::new();
        head(&mut page, self);
        reproduction::table(&mut page, list, self);
        let mut paper = None;
        for case in &self.cases {
            let own = title(&case.id);
            if paper != Some(own) {
                push(&mut page, &format!("\n## {own}\n"));
                paper = Some(own);
            }
            section(&mut page, case, charts);
        }
        page
    }

    /// Checks that passed, and all that were run, with one of these worths.
    fn count(&self, worths: &[Option<Against>]) -> [usize; 2] {
        let each = self.cases.iter().flat_map(|case| worths.iter().map(|worth| case.count(*worth)));
        each.fold([0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]])
    }
}

/// The paper of an id: a letter with a number behind it.
fn paper_of(id: &str) -> Option<(usize, u32)> {
    let mut letters = id.chars();
    let letter = letters.next()?;
    let number = letters.as_str().parse().ok()?;
    Some((PAPERS.iter().position(|(known, _)| *known == letter)?, number))
}

fn title(id: &str) -> &'static str {
    paper_of(id).map_or(NO_PAPER, |(paper, _)| PAPERS[paper].1)
}

/// Where a case stands: by paper, number and id.
fn place(id: &str) -> (usize, u32, String) {
    let (paper, number) = paper_of(id).unwrap_or((PAPERS.len(), 0));
    (paper, number, id.to_owned())
}

fn push(page: &mut String, text: &str) {
    page.push_str(text);
}

fn head(page: &mut String, results: &Results) {
    let of = |worths: &[Option<Against>]| {
        let [met, all] = results.count(worths);
        format!("{met} of {all}")
    };
    let outside = Against::ALL.into_iter().filter(|worth| worth.is_outside()).map(Some);
    let outside: Vec<_> = outside.collect();
    let unsaid = match results.count(&[None]) {
        [_, 0] => String::new(),
        [met, all] => format!("; {met} of {all} do not say what they compare with"),
    };
    let not_run = results.cases.iter().flat_map(|case| &case.rows).filter(|row| !row.was_run());
    let not_run = match not_run.count() {
        0 => String::new(),
        count => format!(" {count} more take long and have not been run."),
    };
    push(
        page,
        &format!(
            "# Validation\n\n\
             Every check of every case with its result, as written by `piola verify --page` of \
             version {}. How much a check proves depends on where its expected value comes from.\n\n\
             **{} checks against something outside the program are met**: {} against an exact \
             solution, {} against another method or program, {} against the papers. In addition, {} \
             balances, symmetries and outcomes are as required, and {} comparisons with other runs \
             of piola agree (no evidence of correctness){unsaid}.{not_run} A check that was \
             evaluated both at the coarse setting and in the case as it stands is counted once, as \
             the latter.\n\n\
             Three settings: `coarse` for tests, `case` as the case file has it, `paper` with the \
             particle numbers, steps and parameters of the publication. A row of a variant or a \
             sweep begins with its name; rows of a whole sweep tell how the results of its \
             members depend on a key. \"Off by\" is the result minus the expected value, in the \
             terms of the tolerance. Rows of long runs have the date of the run beside their \
             setting.\n",
            results.version,
            of(&outside),
            of(&[Some(Against::Exact)]),
            of(&[Some(Against::Independent)]),
            of(&[Some(Against::Paper)]),
            of(&[Some(Against::Invariant)]),
            of(&[Some(Against::Own)]),
        ),
    );
    let names = Against::ALL.map(Against::name).join(" | ");
    push(page, &format!("\n| id | case | {names} |\n|---|---|---|---|---|---|---|\n"));
    for case in &results.cases {
        let counts = Against::ALL.map(|worth| match case.count(Some(worth)) {
            [_, 0] => String::new(),
            [met, all] => format!("{met} of {all}"),
        });
        let row =
            format!("| {} | {} | {} |\n", cell(&case.id), cell(&case.name), counts.join(" | "));
        push(page, &row);
    }
}

fn section(page: &mut String, case: &CaseResults, folder: &str) {
    push(page, &format!("\n### {}: {}\n\n", case.id, cell(&case.title)));
    let mut line = format!("[{}]({})", cell(&case.name), case.link);
    if case.runs > 0 {
        let [least, most] = case.particles;
        let range = if least == most { most.to_string() } else { format!("{least} to {most}") };
        let plural = if case.runs == 1 { "" } else { "s" };
        // Writing to a string does not fail.
        let _ = write!(line, ", {} run{plural} of {range} particles", case.runs);
    }
    push(page, &format!("{line}.\n\n"));
    push(
        page,
        "| setting | quantity | expected | tolerance | got | off by | against | source | met |\n",
    );
    push(page, "|---|---|---|---|---|---|---|---|---|\n");
    for row in &case.rows {
        push(page, &format!("| {} |\n", cells(row).map(|text| cell(&text)).join(" | ")));
    }
    let reasons = case.rows.iter().filter(|row| !row.pass && row.was_run()).filter_map(|row| {
        let first = row.unmet.as_ref().or(row.reason.as_ref())?.lines().next()?;
        Some(format!("- {}: {}\n", cell(&row.name()), cell(first)))
    });
    let reasons: Vec<String> = reasons.collect();
    list(page, "Not met, and why:", &reasons);
    let orders = case.rows.iter().filter(|row| row.expected.starts_with("order "));
    let orders = orders.filter_map(|row| {
        let run = row.run.as_ref().map(|run| format!("{run}: ")).unwrap_or_default();
        Some(format!("- {}{}\n", cell(&run), cell(row.members.as_ref()?)))
    });
    list(page, "Results behind the orders:", &orders.collect::<Vec<_>>());
    for (name, file) in &case.charts {
        push(page, &format!("\n![{}, {}]({folder}/{file})\n", case.name, cell(name)));
    }
    for (name, link) in &case.pictures {
        push(page, &format!("\n![{}, {}]({link})\n", case.name, cell(name)));
    }
}

fn list(page: &mut String, title: &str, lines: &[String]) {
    if !lines.is_empty() {
        push(page, &format!("\n{title}\n\n{}", lines.concat()));
    }
}

/// The columns of a row.
fn cells(row: &Row) -> [String; 9] {
    let setting = match &row.date {
        Some(date) => format!("{}, {date}", row.level.name()),
        None => row.level.name().to_owned(),
    };
    let source = match &row.bound {
        Some(bound) => format!("{}. Bound: {bound}", row.source.trim_end_matches('.')),
        None => row.source.clone(),
    };
    let met = match (row.was_run(), row.pass) {
        (false, _) => "not run",
        (_, true) => "yes",
        (_, false) => "**no**",
    };
    [
        setting,
        row.name(),
        if row.was_run() { row.expected.clone() } else { String::new() },
        row.tolerance.clone(),
        row.got.clone(),
        row.off_by.clone(),
        row.against.map_or(String::new(), |against| against.name().to_owned()),
        source,
        met.to_owned(),
    ]
}

/// `text` as it can stand in a table.
fn cell(text: &str) -> String {
    let text = text.replace(['\n', '\r'], " ");
    text.replace('\\', "\\\\").replace('|', "\\|").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_stand_by_paper_and_number() {
        let mut ids = ["custom", "E2", "U10", "S1", "U9", "T3", "Upper"];
        ids.sort_by_key(|id| place(id));
        assert_eq!(ids, ["U9", "U10", "T3", "S1", "E2", "Upper", "custom"]);
        assert_eq!((title("U9"), title("X1")), (PAPERS[0].1, NO_PAPER));
    }

    #[test]
    fn cells_keep_the_table_whole() {
        assert_eq!(cell("|a|\nb < c \\"), "\\|a\\| b &lt; c \\\\");
    }
}
