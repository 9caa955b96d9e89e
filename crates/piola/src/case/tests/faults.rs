//! What faulty case files are told, word by word.

use super::*;
use crate::schemes::SchemeDescription;

/// A small good case that the tests break.
const GOOD: &str = "\
version = 1
title = \"A column\"
dimension = 2

[parameters]
speed = 1.0

[[body]]
name = \"column\"
shape = { kind = \"box\", min = [0.0, 0.0], max = [3.0, 5.0] }
spacing = 0.25
material = { kind = \"linear\", density = 1000.0, bulk_modulus = 1e5 }
initial = { velocity = [\"0\", \"-speed\"] }

[scheme]
kind = \"upwind\"
smoothing_length = 0.7

[time]
end = 3.0
";

/// What is said of the good case with `from` replaced by `to`.
fn broken(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    read_with(&GOOD.replacen(from, to, 1), &[]).expect_err(to).to_string()
}

#[test]
fn of_an_unknown_scheme_nothing_else_is_said() {
    let said = broken(
        "kind = \"upwind\"\nsmoothing_length = 0.7\n",
        "kind = \"upwnd\"\n[output]\nfields = [\"surface\"]\n",
    );
    assert!(said.contains("[scheme] has no kind `upwnd`"), "{said}");
    assert_eq!(said.matches("error:").count(), 1, "{said}");
}

#[test]
fn of_a_probe_of_an_unknown_kind_nothing_else_is_said() {
    let said = broken(
        "[time]",
        "[[probe]]\nname = \"top\"\nkind = \"extremun\"\n[[plot]]\nname = \"top\"\ncurves = [\"top.position.y\"]\n[time]",
    );
    assert!(said.contains("[[probe]] has no kind `extremun`"), "{said}");
    assert_eq!(said.matches("error:").count(), 1, "{said}");
}

#[test]
fn the_good_case_is_good() {
    let case = read_with(GOOD, &[]).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(case.output.every.value, 0.03);
    assert_eq!(
        case.output.fields.len(),
        catalogue::fields(SchemeDescription::of("upwind", "")).len()
    );
}

/// A part of the good case, what it is replaced by, and what is said then; again and again. Names in braces stand for
/// lists that grow.
const FAULTS: &str = include_str!("faults.txt");

#[test]
fn every_fault_is_explained_in_its_place() {
    let parts: Vec<&str> = FAULTS.split("\n=== ").skip(1).collect();
    assert!(parts.len() > 100 && parts.len().is_multiple_of(3));
    let listed = |all: Vec<spec::Choice>| suggest::one_of(all.iter().map(|choice| choice.name));
    let lists = [
        ("{integrators}", listed(catalogue::integrators())),
        ("{kernels}", listed(catalogue::kernels())),
    ];
    for fault in parts.chunks(3) {
        let part = |number: usize, title: &str| {
            fault[number].strip_prefix(title).and_then(|text| text.strip_prefix('\n')).unwrap()
        };
        let (from, to) = (part(0, "replace"), part(1, "by"));
        let said = lists
            .iter()
            .fold(part(2, "said").to_owned(), |said, (name, list)| said.replace(name, list));
        assert_eq!(broken(from, to).trim_end(), said.trim_end(), "for {to}");
    }
}

#[test]
fn long_lines_are_clipped_around_the_fault() {
    let long = "the distance between particles ".repeat(20);
    let shown = broken("spacing = 0.25", &format!("note = \"{long}\""));
    let lines: Vec<&str> = shown.lines().filter(|line| line.contains("the distance")).collect();
    assert!(lines[0].len() < 130 && lines[0].ends_with("..."), "{shown}");
    let shown = broken("bulk_modulus = 1e5 }", &format!("note = \"{long}\", bulk_modulus = 0 }}"));
    assert!(shown.contains("must be above 0, got 0"), "{shown}");
    let lines: Vec<&str> = shown.lines().collect();
    let [.., line, marks] = lines[..] else { panic!("{shown}") };
    assert!(line.starts_with("12 | ...") && line.len() < 130, "{shown}");
    assert_eq!(line.find("0 }"), marks.find('^'), "{shown}");
}

#[test]
fn marks_stand_under_characters_not_bytes() {
    let shown = broken("initial = {", "initial = { pressure = \"0 * späed + é\", ");
    let lines: Vec<&str> = shown.lines().collect();
    let column = |line: &str, c: char| line.chars().position(|found| found == c);
    assert!(lines[1].ends_with("case.toml:13:29"), "{shown}");
    assert_eq!(column(lines[3], 'ä').unwrap() - 2, column(lines[4], '^').unwrap(), "{shown}");
    assert_eq!(lines[4].matches('^').count(), 5, "{shown}");
}

#[test]
fn windows_line_ends_are_no_problem() {
    let text = GOOD.replace('\n', "\r\n");
    assert!(read_with(&text, &[]).is_ok());
    let text = text.replace("spacing = 0.25", "spacing = 0");
    let shown = read_with(&text, &[]).unwrap_err().to_string();
    assert!(shown.contains("case.toml:11:11") && !shown.contains('\u{fffd}'), "{shown}");
}
