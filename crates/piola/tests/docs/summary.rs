//! The list of chapters has every page once.

use std::collections::BTreeMap;

use super::pages::{all, page};

const SUMMARY: &str = "docs/SUMMARY.md";

/// The pages that the list of chapters names, as paths from the root, with how often.
fn listed(summary: &str) -> BTreeMap<String, usize> {
    let mut pages = BTreeMap::new();
    for target in summary.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
        let path = match target.strip_prefix("../") {
            Some(path) => path.to_owned(),
            None => format!("docs/{target}"),
        };
        *pages.entry(path).or_default() += 1;
    }
    pages
}

#[test]
fn the_list_of_chapters_has_every_page_once() {
    let pages = all().into_iter().map(|page| page.name).filter(|name| name != SUMMARY);
    let pages: BTreeMap<String, usize> = pages.map(|name| (name, 1)).collect();
    assert_eq!(listed(&page(SUMMARY).text), pages);
}

#[test]
fn a_page_that_is_listed_twice_is_counted_twice() {
    let pages = listed("- [a](a.md)\n  - [b](../b.md)\n- [c](a.md)\n");
    assert_eq!(pages, [("b.md".to_owned(), 1), ("docs/a.md".to_owned(), 2)].into());
}
