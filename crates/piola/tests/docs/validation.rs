//! The validation page is that of the cases: every case, every check, with what it expects.

use std::path::Path;

use piola::case::verify::{CheckRow, Ending, RunResults, VariantRun, verify};
use piola::case::{LoadOptions, load};
use piola::observe::Series;
use piola::time::Outcome;

use super::pages::{below, page, root};

const PAGE: &str = "docs/validation.md";
const RENEW: &str =
    "renew it: cargo run --release -- verify cases --full --page docs/validation.md";

/// A run of which nothing is known: enough to tell which rows there have to be.
struct NotRun;

impl RunResults for NotRun {
    fn ending(&self) -> Ending {
        Ending::from(&Outcome::Completed)
    }

    fn quantity(&self, _: &str) -> Option<Series> {
        None
    }
}

/// The rows that the case at `path` has at the full setting.
fn planned(path: &Path) -> (String, Vec<CheckRow>) {
    let read = |variant: Option<&str>| {
        let options = LoadOptions { variant: variant.map(str::to_owned), ..LoadOptions::default() };
        load(path, &options).unwrap_or_else(|problems| panic!("{problems}"))
    };
    let base = read(None);
    let rows = verify(&base, &mut |variant| Ok(VariantRun { case: read(variant), run: NotRun }));
    (format!("### {}: {}", base.id.as_deref().unwrap_or_default(), base.title), rows)
}

/// The cells of the rows of a section of the page.
fn rows(section: &str) -> Vec<Vec<String>> {
    let lines = section.lines().filter_map(|line| line.strip_prefix("| ")?.strip_suffix(" |"));
    lines
        .skip(1)
        .map(|line| line.split(" | ").map(|cell| cell.trim().to_owned()).collect())
        .collect()
}

/// The numbers of a cell, without units and names.
fn numbers(cell: &str) -> Vec<f64> {
    let cell = cell.split(" along ").next().unwrap_or_default();
    cell.split([' ', ',']).filter_map(|word| word.parse().ok()).collect()
}

/// The section of the page under a heading.
fn section<'a>(text: &'a str, heading: &str) -> &'a str {
    let start =
        text.find(&format!("\n{heading}\n")).unwrap_or_else(|| panic!("{heading}: {RENEW}"));
    let rest = &text[start + 1 + heading.len()..];
    rest.split("\n### ").next().unwrap_or(rest).split("\n## ").next().unwrap_or_default()
}

#[test]
fn the_page_has_every_case_and_every_check() {
    let text = page(PAGE).text;
    assert!(text.contains(&format!("version {} wrote it, at the full", env!("CARGO_PKG_VERSION"))));
    let cases = below("cases", &["/case.toml"]);
    let mut total = 0;
    for case in &cases {
        let (heading, planned) = planned(&root().join(&case.name));
        let shown = rows(section(&text, &heading));
        assert_eq!(shown.len(), planned.len(), "{heading}: {RENEW}");
        total += shown.len();
        for (shown, planned) in shown.iter().zip(&planned) {
            let run = planned.run.as_ref().map_or(String::new(), |run| format!("{run}: "));
            assert_eq!(shown[0], format!("{run}{}", planned.quantity), "{RENEW}");
            assert_eq!(shown[5], planned.source, "{RENEW}");
            let comparison = ["less than", "more than"];
            if !comparison.iter().any(|relation| planned.expected.starts_with(relation)) {
                assert_eq!(numbers(&shown[1]), numbers(&planned.expected), "{shown:?}: {RENEW}");
            }
            assert_eq!(numbers(&shown[2]), numbers(&planned.tolerance), "{shown:?}: {RENEW}");
            assert_eq!(shown[6], "yes", "{shown:?}");
        }
    }
    let head = format!("{total} of {total} results in {} cases are as expected.", cases.len());
    assert!(text.contains(&head), "{head} {RENEW}");
    assert_eq!(text.matches("\n### ").count(), cases.len(), "{RENEW}");
}

#[test]
fn the_charts_of_the_page_are_there_and_no_others() {
    let text = page(PAGE).text;
    let mut shown: Vec<&str> =
        text.split("](validation/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    shown.sort_unstable();
    let folder = root().join("docs/validation");
    let mut there: Vec<String> = std::fs::read_dir(folder)
        .expect("the charts have a folder")
        .map(|entry| entry.expect("it can be read").file_name().to_string_lossy().into_owned())
        .collect();
    there.sort();
    assert_eq!(there, shown, "{RENEW}");
}
