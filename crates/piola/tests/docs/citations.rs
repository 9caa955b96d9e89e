//! Every equation and every source that is cited exists.

use std::collections::BTreeSet;

use super::pages::{Page, all_that_cite, page};

/// The text in one line, without the marks of comments, so that a citation may be broken.
fn in_one_line(text: &str) -> String {
    let content = |line| {
        let line: &str = str::trim(line);
        ["//!", "///", "//", "#"].iter().find_map(|mark| line.strip_prefix(mark)).unwrap_or(line)
    };
    let words: Vec<&str> = text.lines().map(content).flat_map(str::split_whitespace).collect();
    words.join(" ")
}

/// The number `12` or `3.40a` in brackets that `text` starts with, and what follows it.
fn bracketed(text: &str) -> Option<(&str, &str)> {
    let (inside, rest) = text.strip_prefix('(')?.split_once(')')?;
    let digits = inside.strip_suffix(|c: char| c.is_ascii_lowercase()).unwrap_or(inside);
    let is_short_number = |part: &str| {
        (1..=3).contains(&part.len()) && part.chars().all(|digit| digit.is_ascii_digit())
    };
    let parts: Vec<&str> = digits.split('.').collect();
    (parts.len() <= 2 && parts.into_iter().all(is_short_number)).then_some((inside, rest))
}

/// The numbers behind each `theory`, also of lists and ranges: `theory (2), (4) to (6)`.
fn cited_equations(text: &str) -> Vec<String> {
    let mut numbers: Vec<u32> = Vec::new();
    for mut rest in text.split("theory ").skip(1) {
        let mut first = None;
        while let Some((number, after)) = bracketed(rest) {
            let number: u32 = number.parse().unwrap_or_default();
            numbers.extend(first.map_or(number, |first| first + 1)..=number);
            let list = [", ", " and "].iter().find_map(|word| after.strip_prefix(word));
            let range = after.strip_prefix(" to ");
            first = range.map(|_| number);
            rest = range.or(list).unwrap_or_default();
        }
    }
    numbers.iter().map(u32::to_string).collect()
}

/// The words in front of numbers in brackets that are names: `Upwind (3.39)`.
fn cited_sources(text: &str) -> Vec<String> {
    let before_brackets = text.match_indices(" (").filter_map(|(place, _)| {
        bracketed(&text[place + 1..])?;
        text[..place].rsplit(|c: char| !c.is_ascii_alphanumeric() && c != '-').next()
    });
    let is_name =
        |word: &&str| word.starts_with(|c: char| c.is_ascii_uppercase()) && word.len() > 1;
    before_brackets.filter(is_name).map(str::to_owned).collect()
}

/// The numbers at the right end of lines with equations.
fn equations(theory: &str) -> Vec<String> {
    let numbers = theory.lines().filter_map(|line| {
        let (equation, number) = line.rsplit_once("  ")?;
        let (number, rest) = bracketed(number.trim_start())?;
        (rest.is_empty() && !equation.trim().is_empty()).then(|| number.to_owned())
    });
    numbers.collect()
}

fn keys(bibliography: &str) -> BTreeSet<String> {
    let entries = bibliography.lines().filter(|line| line.starts_with('@'));
    let key = |line: &str| Some(line.split_once('{')?.1.split(',').next()?.to_owned());
    entries.filter_map(key).collect()
}

/// What `cited` finds in each file, with the file's name.
fn found(cited: fn(&str) -> Vec<String>) -> Vec<(String, String)> {
    let in_file = |Page { name, text }: Page| {
        cited(&in_one_line(&text)).into_iter().map(move |what| (name.clone(), what))
    };
    // This file holds examples.
    let others = all_that_cite().into_iter().filter(|page| !page.name.ends_with("citations.rs"));
    others.flat_map(in_file).collect()
}

#[test]
fn cited_equations_exist() {
    let theory = page("docs/theory.md");
    let numbered = equations(&theory.text);
    let in_order: Vec<String> = (1..=numbered.len()).map(|number| number.to_string()).collect();
    assert_eq!(numbered, in_order, "the equations of docs/theory.md count up from 1");
    let cited = found(cited_equations);
    let lost: Vec<_> = cited.iter().filter(|(_, number)| !numbered.contains(number)).collect();
    assert!(lost.is_empty(), "these equations are not in docs/theory.md: {lost:?}");
    for number in &numbered {
        let is_cited = cited.iter().any(|(_, cited)| cited == number);
        assert!(is_cited, "nothing cites theory ({number}); cite it where the code computes it");
    }
}

#[test]
fn cited_sources_are_in_the_bibliography() {
    let keys = keys(&page("docs/refs.bib").text);
    let cited = found(cited_sources);
    let lost: Vec<_> = cited.iter().filter(|(_, source)| !keys.contains(source)).collect();
    assert!(lost.is_empty(), "these sources are not in docs/refs.bib: {lost:?}");
    let texts: Vec<String> = all_that_cite().into_iter().map(|page| page.text).collect();
    for key in &keys {
        assert!(texts.iter().any(|text| text.contains(key)), "nothing mentions {key}");
    }
}

#[test]
fn citations_are_read_as_they_are_meant() {
    let text = in_one_line(
        "/// by theory (2), (3) and\n/// (17); Upwind (3.40b), theory\n/// (4) to (6), (103)",
    );
    assert_eq!(cited_equations(&text), ["2", "3", "17", "4", "5", "6", "103"]);
    let text = in_one_line("//! Dual-support\n//! (19), [Upwind (4.1)], Ito (2008), f (3), A (1)");
    assert_eq!(cited_sources(&text), ["Dual-support", "Upwind"]);
    assert_eq!(
        equations("    a = b      (1)\nas in (7)\n    c = d,  e = f (2)  (3)\n"),
        ["1", "3"]
    );
}
