//! The gallery of cases, the page of each case, and the case files that pages show.

use std::collections::BTreeSet;
use std::fs;

use piola::case::{LoadOptions, Session, parse};

use super::pages::{Page, all, below, page, root};

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

/// The rows of the gallery: the folder and the id of the case, and the picture.
fn rows() -> Vec<(String, String, String)> {
    let gallery = page("docs/gallery.md");
    let row = |line: &str| {
        let mut columns = line.strip_prefix("| <img src=\"../")?.split(" | ");
        let (picture, case) = (columns.next()?.split('"').next()?, columns.next()?);
        let (id, link) = case.split_once(" [")?;
        let folder = link.split_once("](../")?.1.split(')').next()?;
        Some((folder.to_owned(), id.to_owned(), picture.to_owned()))
    };
    gallery.text.lines().filter_map(row).collect()
}

#[test]
fn the_gallery_lists_all_cases_once_with_their_pictures() {
    let rows = rows();
    let listed = rows.iter().map(|(folder, id, _)| (folder.clone(), id.clone()));
    assert_eq!(listed.collect::<BTreeSet<_>>(), cases());
    assert_eq!(rows.len(), cases().len(), "a case has two rows");
    for (folder, _, picture) in rows {
        assert_eq!(picture, format!("{folder}/picture.png"));
    }
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

/// The whole case files that a page shows.
fn shown(page: &Page) -> Vec<&str> {
    let blocks = page.text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.filter(|block| block.starts_with("version = 1")).collect()
}

#[test]
fn cases_that_pages_show_are_good_ones() {
    let mut count = 0;
    for page in all() {
        for text in shown(&page) {
            let case = parse(text, &page.name, &LoadOptions::default());
            let case = case.unwrap_or_else(|problems| panic!("{}:\n{problems}", page.name));
            let session = Session::new(&case);
            let session = session.unwrap_or_else(|problems| panic!("{}:\n{problems}", page.name));
            assert!(!session.case().probes.is_empty(), "{}", page.name);
            count += 1;
        }
    }
    // One in the page about making a case, one in that about convergence, and one a tutorial.
    let tutorials = below("docs/tutorials", &[".md"]);
    assert!(tutorials.iter().all(|page| shown(page).len() == 1), "a tutorial shows a case");
    assert!(count >= tutorials.len() + 2, "{count}");
}
