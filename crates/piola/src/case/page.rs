//! The validation page: every check of many cases with its result, and charts, as Markdown.
//!
//! The same results give the same bytes: nothing in it tells time of day, wall time or machine.

use std::fmt::Write;
use std::rc::Rc;

use super::model::Case;
use super::simulation::Finished;
use super::verify::{CheckRow, significant};
use crate::output::Plot;

mod charts;

/// A case with its rows and runs.
pub struct PageCase {
    /// The case, `None` where it could not be read.
    pub case: Option<Case>,
    /// Name of its folder, which names its charts and stands for its id where it has none.
    pub name: String,
    /// The link to its page or file, relative to the validation page.
    pub link: String,
    /// The checks.
    pub rows: Vec<CheckRow>,
    /// What was run, `None` for the case itself.
    pub runs: Vec<(Option<String>, Rc<Finished>)>,
    /// Pictures that its page shows: name, and link relative to the validation page.
    pub pictures: Vec<(String, String)>,
}

/// A page and the charts that it shows.
pub struct Page {
    /// The text.
    pub markdown: String,
    /// Charts with their file names, in the folder that was asked for.
    pub charts: Vec<(String, Plot)>,
}

/// The papers by the letter of their ids in the list of reproductions.
const PAPERS: [(char, &str); 4] = [
    ('U', "Upwind: Pilotto (2025)"),
    ('T', "CTVF: Adepu and Ramachandran (2021)"),
    ('S', "Dual-support: Ren, Zhuang, Rabczuk and Zhu (2023)"),
    ('E', "Elastodynamics: Ismail (2009)"),
];
const NO_PAPER: &str = "Other cases";

/// Makes the page of `cases`, run at the full setting or the coarse one, with its charts in the
/// folder `charts` beside it.
pub fn page(mut cases: Vec<PageCase>, full: bool, charts: &str) -> Page {
    cases.sort_by_key(|case| (place(&case.id()), case.name.clone()));
    let mut page = Page { markdown: String::new(), charts: Vec::new() };
    head(&mut page.markdown, &cases, full);
    let mut paper = None;
    for case in &cases {
        let own = title(&case.id());
        if paper != Some(own) {
            push(&mut page.markdown, &format!("\n## {own}\n"));
            paper = Some(own);
        }
        section(&mut page, case, charts);
    }
    page
}

impl PageCase {
    fn id(&self) -> String {
        self.case.as_ref().and_then(|case| case.id.clone()).unwrap_or_else(|| self.name.clone())
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

fn head(page: &mut String, cases: &[PageCase], full: bool) {
    let rows = cases.iter().map(|case| case.rows.len()).sum::<usize>();
    let passed = cases.iter().flat_map(|case| &case.rows).filter(|row| row.pass).count();
    let (setting, flag) = if full { ("full", " --full") } else { ("coarse", "") };
    let version = env!("CARGO_PKG_VERSION");
    push(
        page,
        &format!(
            "# Validation\n\n\
             Every check of every case with what came of it, as `piola verify{flag} --page` of \
             version {version} wrote it, at the {setting} setting. A row that stands for a variant \
             or a sweep says so in front; a sweep's own rows say how its members follow each other \
             along a key. \"Off by\" is the result minus the expected value, in the terms of the \
             tolerance.\n\n\
             {passed} of {rows} results in {} cases are as expected.\n\n\
             | id | case | results | as expected |\n|---|---|---|---|\n",
            cases.len()
        ),
    );
    for case in cases {
        let good = case.rows.iter().filter(|row| row.pass).count();
        let row = format!(
            "| {} | {} | {} | {good} |\n",
            cell(&case.id()),
            cell(&case.name),
            case.rows.len()
        );
        push(page, &row);
    }
}

fn section(page: &mut Page, case: &PageCase, folder: &str) {
    let text = &mut page.markdown;
    let what = case.case.as_ref().map_or("", |case| case.title.as_str());
    push(text, &format!("\n### {}: {}\n\n", case.id(), cell(what)));
    let mut line = format!("[{}]({})", cell(&case.name), case.link);
    let particles = case.runs.iter().map(|(_, run)| run.particles);
    if let (Some(least), Some(most)) = (particles.clone().min(), particles.max()) {
        let runs = case.runs.len();
        let range = if least == most { most.to_string() } else { format!("{least} to {most}") };
        let plural = if runs == 1 { "" } else { "s" };
        // Writing to a string does not fail.
        let _ = write!(line, ", {runs} run{plural} of {range} particles");
    }
    push(text, &format!("{line}.\n\n"));
    push(text, "| quantity | expected | tolerance | got | off by | source | |\n");
    push(text, "|---|---|---|---|---|---|---|\n");
    for row in &case.rows {
        push(text, &format!("| {} |\n", cells(row).map(|text| cell(&text)).join(" | ")));
    }
    let reasons = case.rows.iter().filter(|row| !row.pass).filter_map(|row| {
        let first = row.reason.as_ref()?.lines().next()?;
        Some(format!("- {}: {}\n", cell(&name(row)), cell(first)))
    });
    let reasons: Vec<String> = reasons.collect();
    list(text, "Not as expected:", &reasons);
    list(text, "Behind the orders:", &orders(&case.rows));
    let Some(read) = &case.case else { return };
    for (name, chart) in charts::charts(read, case) {
        let mut file = format!("{}-{name}.png", case.name);
        if page.charts.iter().any(|(known, _)| *known == file) {
            file = format!("{}-{}-{name}.png", case.id(), case.name);
        }
        push(
            &mut page.markdown,
            &format!("\n![{}, {}]({folder}/{file})\n", case.name, cell(&name)),
        );
        page.charts.push((file, chart));
    }
    for (name, link) in &case.pictures {
        push(&mut page.markdown, &format!("\n![{}, {}]({link})\n", case.name, cell(name)));
    }
}

fn list(page: &mut String, title: &str, lines: &[String]) {
    if !lines.is_empty() {
        push(page, &format!("\n{title}\n\n{}", lines.concat()));
    }
}

/// What the members gave from which orders of convergence were taken.
fn orders(rows: &[CheckRow]) -> Vec<String> {
    let orders = rows.iter().filter(|row| row.expected.starts_with("order "));
    let lines = orders.filter_map(|row| {
        let data = row.trend.as_ref()?;
        let each = data.points.iter().map(|point| {
            let number = point.error.filter(|_| data.of_error).unwrap_or(point.value);
            format!("{} at {}", significant(number, 4), point.text)
        });
        let unit = if data.unit == "1" { String::new() } else { format!(", in {}", data.unit) };
        let each = each.collect::<Vec<_>>().join("; ");
        Some(format!("- {}{}: {}\n", cell(&name(row)), cell(&unit), cell(&each)))
    });
    lines.collect()
}

/// What a row is about: the quantity, with what was run in front.
fn name(row: &CheckRow) -> String {
    match &row.run {
        Some(run) => format!("{run}: {}", row.quantity),
        None => row.quantity.clone(),
    }
}

/// The columns of a row.
fn cells(row: &CheckRow) -> [String; 7] {
    [
        name(row),
        row.expected.clone(),
        row.tolerance.clone(),
        row.got.as_ref().map_or_else(|| "-".to_owned(), ToString::to_string),
        row.deviation.clone(),
        row.source.clone(),
        if row.pass { "yes" } else { "**no**" }.to_owned(),
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
