//! The validation page and the results that it is made of are those of the cases.

use std::collections::BTreeSet;
use std::path::Path;

use piola::case::model::Against;
use piola::case::page::{Met, Reproduction, Results, Row};
use piola::case::verify::{CheckRow, Ending, RunResults, VariantRun, verify};
use piola::case::{Case, Level, LoadOptions, Session, load};
use piola::observe::Series;
use piola::time::Outcome;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64;

use super::pages::{below, page, root};

const PAGE: &str = "docs/validation.md";
const RESULTS: &str = "docs/validation.json";
const LIST: &str = "cases/reproduction.toml";
const RENEW: &str =
    "renew it: cargo run --release -- verify cases --full --page docs/validation.md";

/// Evaluations times particles that the sample of rows which is run again may take, all and each:
/// some ten seconds.
const WORK: u64 = 12_000_000;
const WORK_OF_ONE: u64 = 2_500_000;
/// How far a number may be from that of the page, which was made on another machine, whose
/// exponentials differ by the last bit; and what counts as round-off.
const DIFFERENCE: f64 = 1e-4;
const ROUND_OFF: f64 = 1e-8;
/// What of a bound that is for round-off is another in another order of sums.
const LEFT: f64 = 0.1;

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

pub(super) fn results() -> Results {
    serde_json::from_str(&page(RESULTS).text).unwrap_or_else(|error| panic!("{RESULTS}: {error}"))
}

fn read(path: &Path, variant: Option<&str>, level: Level) -> Case {
    let variant = variant.map(str::to_owned);
    let options = LoadOptions { variant, level, ..LoadOptions::default() };
    load(path, &options).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The rows that the case at `path` has at a setting.
fn planned(path: &Path, level: Level) -> Vec<CheckRow> {
    let base = read(path, None, level);
    verify(&base, &mut |name| Ok(VariantRun { case: read(path, name, level), run: NotRun }))
}

/// The numbers of a cell, without units and names.
fn numbers(cell: &str) -> Vec<f64> {
    let cell = cell.split(" along ").next().unwrap_or_default();
    cell.split([' ', ',']).filter_map(|word| word.parse().ok()).collect()
}

/// Whether a kept row is of what the case plans today.
fn is_of(row: &Row, planned: &CheckRow) -> bool {
    let is_comparison = ["less than", "more than"];
    let is_comparison = is_comparison.iter().any(|words| planned.expected.starts_with(words));
    let name = |quantity: &str| -> String {
        let end = if row.was_run() { None } else { quantity.find(" from ") };
        quantity[..end.unwrap_or(quantity.len())].to_owned()
    };
    row.check == planned.check
        && (&row.run, name(&row.quantity)) == (&planned.run, name(&planned.quantity))
        && (row.against, &row.source, &row.bound)
            == (planned.against, &planned.source, &planned.bound)
        // Of what was not run the window and the bound are those of the case itself.
        && (is_comparison || !row.was_run() || numbers(&row.expected) == numbers(&planned.expected))
        && numbers(&row.tolerance) == numbers(&planned.tolerance)
}

#[test]
fn the_results_are_of_every_check_of_every_case_as_it_is() {
    let results = results();
    let cases = below("cases", &["/case.toml"]);
    assert_eq!(results.cases.len(), cases.len(), "{RENEW}");
    for case in &cases {
        let path = root().join(&case.name);
        let folder = path.parent().and_then(Path::file_name).expect("a case lies in a folder");
        let id = read(&path, None, Level::Case).id.unwrap_or_default();
        let kept = results.cases.iter().find(|kept| *kept.name == *folder && kept.id == id);
        let kept = kept.unwrap_or_else(|| panic!("{}: {RENEW}", case.name));
        let mut fresh = BTreeSet::new();
        for level in Level::ALL {
            let planned = planned(&path, level);
            let base = read(&path, None, level);
            for row in kept.rows.iter().filter(|row| row.read_at == level) {
                let known = planned.iter().any(|planned| is_of(row, planned));
                assert!(known, "{}: no check makes {row:?}: {RENEW}", case.name);
                let names = row.runs.iter().map(Option::as_deref);
                let sums: Vec<String> =
                    names.map(|name| read(&path, name, level).fingerprint()).collect();
                let name = format!("{}: {}", case.name, row.name());
                assert_eq!(row.fingerprint, sums.join(" "), "{name}");
                let known = base.checks[row.check].unmet.as_ref().filter(|_| !row.pass);
                assert!(!row.was_run() || row.unmet.as_ref() == known, "{name}: {RENEW}");
                assert!(!row.is_failed(), "{name}: it is not met, and does not say why");
                fresh.insert((row.check, row.run.clone()));
            }
            // What is the same at the coarse setting and as it stands is there once.
            for row in planned.iter().filter(|_| level != Level::Coarse) {
                let there = fresh.contains(&(row.check, row.run.clone()));
                assert!(there, "{}: {} is missing: {RENEW}", case.name, row.quantity);
            }
        }
    }
}

#[test]
fn the_page_is_made_of_the_results() {
    let list = Reproduction::read(&page(LIST).text).unwrap_or_else(|error| panic!("{error}"));
    assert!(results().page(&list, "validation") == page(PAGE).text, "{RENEW}");
}

/// How many digits numbers of the page have, and differences of them.
const DIGITS: f64 = 1.1e-5;
const DIGITS_OF_DIFFERENCE: f64 = 6e-3;

/// Whether what a row says of its result is true of the numbers that it shows: how far it is off, and whether it passes.
fn is_consistent(row: &Row) -> bool {
    let (Some(got), None) = (value(&row.got), &row.reason) else { return true };
    let about = |a: f64, b: f64, by: f64| (a - b).abs() <= by;
    let numbers = (value(&row.expected), value(&row.tolerance), value(&row.off_by));
    if let (Some(expected), Some(tolerance), Some(off)) = numbers {
        let unit = if row.off_by.ends_with('%') { 100.0 / expected.abs() } else { 1.0 };
        let rounding = DIGITS * got.abs().max(expected.abs()) * unit;
        let is_off =
            about((got - expected) * unit, off, rounding + DIGITS_OF_DIFFERENCE * off.abs());
        let is_close = about(off.abs(), tolerance, rounding + DIGITS_OF_DIFFERENCE * tolerance);
        return is_off && (is_close || row.pass == (off.abs() <= tolerance));
    }
    let words: Vec<&str> = row.expected.split([' ', ',']).collect();
    let bounds = words.windows(2).filter_map(|pair| Some((pair[0], value(pair[1])?)));
    let mut bounds = bounds.filter(|(word, _)| ["least", "most"].contains(word)).peekable();
    if bounds.peek().is_none() {
        return true;
    }
    let is_met =
        |(word, bound): (&str, f64)| if word == "least" { got >= bound } else { got <= bound };
    let bounds: Vec<(&str, f64)> = bounds.collect();
    let is_close = bounds.iter().any(|(_, bound)| about(got, *bound, DIGITS * bound.abs()));
    is_close || row.pass == bounds.into_iter().all(is_met)
}

#[test]
fn rows_say_what_is_true_of_their_numbers() {
    let results = results();
    let rows = results.cases.iter().flat_map(|case| case.rows.iter().map(move |row| (case, row)));
    let wrong = rows.filter(|(_, row)| row.was_run() && !is_consistent(row));
    let wrong: Vec<String> =
        wrong.map(|(case, row)| format!("{} {}: {row:?}", case.name, row.read_at.name())).collect();
    assert!(wrong.is_empty(), "{RENEW}\n{}", wrong.join("\n"));
    let texts = |got: &str, expected: &str, tolerance: &str, off_by: &str, pass| {
        let [got, expected, tolerance, off_by] =
            [got, expected, tolerance, off_by].map(str::to_owned);
        Row { got, expected, tolerance, off_by, pass, ..Row::default() }
    };
    assert!(is_consistent(&texts("1.01 m", "1 m", "2 %", "1 %", true)));
    assert!(!is_consistent(&texts("1.02 m", "1 m", "2 %", "1 %", true)));
    assert!(!is_consistent(&texts("1.01 m", "1 m", "0.5 %", "1 %", true)));
    assert!(!is_consistent(&texts("7.2507 m", "4.11 m", "0.0758 m", "0.0807 m", true)));
    assert!(is_consistent(&texts("3", "at least 2, at most 4", "", "", true)));
    assert!(!is_consistent(&texts("5", "at least 2, at most 4", "", "", true)));
    assert!(!is_consistent(&texts("3", "at most 4", "", "", false)));
}

/// A row of the list says that it is met only where every check of its cases from outside is.
#[test]
fn no_row_is_said_to_be_met_of_which_a_check_is_not() {
    let list = Reproduction::read(&page(LIST).text).unwrap_or_else(|error| panic!("{error}"));
    let results = results();
    for row in list.iter().filter(|row| row.met == Met::Yes) {
        let id = row.checks_of.as_ref().unwrap_or(&row.id);
        let cases = results.cases.iter().filter(|case| case.id == *id);
        for check in cases.flat_map(|case| &case.rows) {
            let is_outside = check.against.is_some_and(Against::is_outside);
            let is_met = check.pass || !check.was_run() || !is_outside;
            assert!(is_met, "{}: {} is not met", row.id, check.name());
        }
    }
}

/// A number with what stands behind it, apart.
fn value(text: &str) -> Option<f64> {
    text.split(' ').next()?.parse().ok()
}

#[test]
fn a_sample_of_the_results_comes_out_again() {
    let results = results();
    let cases = results.cases.iter();
    let rows = cases.flat_map(|case| case.rows.iter().map(move |row| (case, row)));
    let mut rows: Vec<_> = rows
        .filter(|(_, row)| row.work <= WORK_OF_ONE && row.was_run() && row.got != "-")
        .collect();
    // Another page, another sample.
    let seed = page(RESULTS)
        .text
        .bytes()
        .fold(0_u64, |sum, byte| sum.wrapping_mul(0x0100_0000_01b3).wrapping_add(u64::from(byte)));
    rows.shuffle(&mut Pcg64::seed_from_u64(seed));
    let mut work = 0;
    let mut count = 0;
    for (case, row) in rows {
        if work + row.work > WORK {
            continue;
        }
        let path = root().join("docs").join(&case.link).with_file_name("case.toml");
        let base = read(&path, None, row.read_at);
        let again = verify(&base, &mut |name| {
            if !row.runs.iter().any(|run| run.as_deref() == name) {
                return Err("no run of this row".to_owned().into());
            }
            let case = read(&path, name, row.read_at);
            let session = Session::new(&case).map_err(|problems| problems.to_string())?;
            let run = session.run(&Default::default(), &mut |_| {});
            Ok(VariantRun { case, run: run.map_err(|error| error.to_string())? })
        });
        let again = again.iter().find(|again| is_of(row, again)).expect("the check is there");
        let got = again.got.as_ref().map_or_else(|| "-".to_owned(), ToString::to_string);
        // Round-off is another where sums are rounded otherwise.
        let is_round_off = row.bound.as_ref().is_some_and(|why| why.contains("round-off"));
        let most = row.expected.strip_prefix("at most ").and_then(value);
        let left = most.filter(|_| is_round_off).map_or(ROUND_OFF, |most| LEFT * most);
        let is_same = match (value(&row.got), value(&got)) {
            (Some(old), Some(new)) => {
                (old - new).abs() <= (DIFFERENCE * old.abs()).max(ROUND_OFF.max(left))
            }
            _ => row.got == got,
        };
        let name = format!("{} {}: {}", case.name, row.read_at.name(), row.name());
        assert!(is_same, "{name}: the page has {}, a run {got}: {RENEW}", row.got);
        assert_eq!(row.pass, again.pass, "{name}: {RENEW}");
        work += row.work;
        count += 1;
    }
    assert!(count >= 10, "the sample has {count} rows");
}

#[test]
fn every_check_says_what_it_is_worth_and_why_its_bound_is_what_it_is() {
    for case in below("cases", &["/case.toml"]) {
        let tree: toml::Table = case.text.parse().expect("case files are TOML");
        for check in tree.get("check").and_then(toml::Value::as_array).into_iter().flatten() {
            let has = |key: &str| check.get(key).is_some();
            let what = &check["quantity"];
            assert!(has("against"), "{}: {what}: `against` is missing", case.name);
            let bounds = ["tolerance", "at_least", "at_most", "order", "ratio"];
            let is_bound = bounds.into_iter().any(has);
            assert!(!is_bound || has("reason"), "{}: {what}: `reason` is missing", case.name);
        }
    }
}

#[test]
fn what_compares_runs_with_each_other_is_no_evidence_from_outside() {
    for case in below("cases", &["/case.toml"]) {
        let tree: toml::Table = case.text.parse().expect("case files are TOML");
        for check in tree.get("check").and_then(toml::Value::as_array).into_iter().flatten() {
            let has = |key: &str| check.get(key).is_some();
            let compares = ["monotone", "ratio", "less_than", "more_than"].into_iter().any(has);
            let is_inward =
                compares && !has("expected") || check["quantity"].as_str() == Some("run.outcome");
            let worth = check["against"].as_str().unwrap_or_default();
            let is_outside = ["exact", "independent", "paper"].contains(&worth);
            assert!(!(is_inward && is_outside), "{}: {check} is called `{worth}`", case.name);
        }
    }
}

/// Whether `text` names a script that there is, from the root or from `folder`, or a publication:
/// a year in brackets behind a name.
fn names_where_it_comes_from(text: &str, folder: &str) -> bool {
    let script = |word: &str| {
        let is_there = |base: &Path| base.join(word).is_file();
        word.ends_with(".py") && (is_there(&root()) || is_there(&root().join(folder)))
    };
    let is_year = |word: &str| word.len() == 4 && word.bytes().all(|byte| byte.is_ascii_digit());
    let words = || text.split_whitespace();
    let bare = |word: &str| {
        let end = word.trim_end_matches([',', ';', ':', ')', '.']);
        end.trim_start_matches('(').to_owned()
    };
    let published = words().zip(words().skip(1)).any(|(name, year)| {
        let year = year.trim_end_matches([',', ';', ':', '.']);
        let year = year.strip_prefix('(').and_then(|year| year.strip_suffix(')'));
        name.starts_with(|c: char| c.is_ascii_uppercase()) && year.is_some_and(is_year)
    });
    published || words().any(|word| script(&bare(word)))
}

#[test]
fn independent_checks_name_their_script_or_publication() {
    let mut without = BTreeSet::new();
    for case in below("cases", &["/case.toml"]) {
        let folder = case.name.trim_end_matches("/case.toml");
        let tree: toml::Table = case.text.parse().expect("case files are TOML");
        for check in tree.get("check").and_then(toml::Value::as_array).into_iter().flatten() {
            let text = |key: &str| check.get(key).and_then(toml::Value::as_str).unwrap_or_default();
            let source = text("source");
            if text("against") == "independent" && !names_where_it_comes_from(source, folder) {
                without.insert(format!("{}: {source}", case.name));
            }
        }
    }
    assert!(without.is_empty(), "neither a script nor a publication:\n{without:#?}");
    assert!(!names_where_it_comes_from("finite elements (nowhere.py), by Hand, 2002", "cases"));
    assert!(names_where_it_comes_from("as in Martin and Moyce (1952), on a bed", "cases"));
}

#[test]
fn every_variant_has_a_check() {
    for case in below("cases", &["/case.toml"]) {
        let tree: toml::Table = case.text.parse().expect("case files are TOML");
        let list = |key: &str| tree.get(key).and_then(toml::Value::as_array).into_iter().flatten();
        let used = |name: &toml::Value, key: &str| {
            let of_check = list("check").any(|check| check.get(key) == Some(name));
            let compared = ["less_than", "more_than"];
            let compared =
                list("check").any(|check| compared.iter().any(|key| check.get(key) == Some(name)));
            let of_sweep = list("sweep").any(|sweep| sweep.get(key) == Some(name));
            of_check || compared || of_sweep
        };
        for (table, key) in [("variant", "variant"), ("sweep", "sweep")] {
            for entry in list(table) {
                assert!(used(&entry["name"], key), "{}: no check of {}", case.name, entry["name"]);
            }
        }
    }
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
