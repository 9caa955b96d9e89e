//! The table of cases in the README, and the page of each case.

use std::collections::BTreeSet;
use std::fs;

use piola::case::{LoadOptions, Session, parse};

use super::pages::{below, page, root};

/// Largest picture beside a case in bytes: clones stay small.
const LARGEST_PICTURE: u64 = 200_000;

/// The folder of each case with its id.
fn cases() -> BTreeSet<(String, String)> {
    let folder = |name: &str| name.trim_end_matches("/case.toml").to_owned();
    let files = below("cases", &["/case.toml"]).into_iter().map(|file| {
        let case: toml::Table = file.text.parse().expect("case files are TOML");
        let id = case.get("id").and_then(toml::Value::as_str).unwrap_or_default();
        (folder(&file.name), id.to_owned())
    });
    files.collect()
}

/// The rows of the README whose second column links to a folder of `cases/`.
fn rows() -> Vec<(String, String)> {
    let readme = page("README.md");
    let row = |line: &str| {
        let mut columns = line.strip_prefix("| ")?.split(" | ");
        let (id, link) = (columns.next()?, columns.next()?);
        let folder = link.split_once("](cases/")?.1.split(')').next()?;
        Some((format!("cases/{folder}"), id.to_owned()))
    };
    readme.text.lines().filter_map(row).collect()
}

#[test]
fn the_table_of_the_readme_lists_all_cases_once() {
    let rows = rows();
    assert_eq!(rows.iter().cloned().collect::<BTreeSet<_>>(), cases());
    assert_eq!(rows.len(), cases().len(), "a case has two rows");
}

#[test]
fn each_case_has_a_page_with_its_command_and_picture() {
    for (folder, id) in cases() {
        let page = page(&format!("{folder}/README.md"));
        assert!(page.text.starts_with(&format!("# {id}: ")), "{}", page.name);
        let command = format!("cargo run --release -- run {folder}/case.toml");
        assert!(page.text.contains(&command), "{} lacks `{command}`", page.name);
        assert!(page.text.contains("](picture.png)"), "{} shows no picture", page.name);
        let picture = root().join(&folder).join("picture.png");
        let size = fs::metadata(picture).expect("each case has its picture").len();
        assert!(size < LARGEST_PICTURE, "{folder}/picture.png has {size} bytes");
    }
}

#[test]
fn the_case_in_the_readme_is_a_good_one() {
    let readme = page("README.md");
    let case = readme.text.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next());
    let text = case.expect("the README shows a case file");
    let case = parse(text, "README.md", &LoadOptions::default());
    let case = case.unwrap_or_else(|problems| panic!("{problems}"));
    let session = Session::new(&case).unwrap_or_else(|problems| panic!("{problems}"));
    assert!(!session.case().probes.is_empty());
}
