//! The table of rooms in docs/architecture.md is that of the sources, and arrows lead downwards.

use std::collections::{BTreeMap, BTreeSet};

use super::pages::{Page, below, page, root};

/// The library's rooms with what they use.
type Arrows = BTreeMap<String, BTreeSet<String>>;

const SOURCES: &str = "crates/piola/src";

/// The crates below the library, `piola_` before each.
const CRATES: [&str; 2] = ["device", "formulas"];

/// The table: the last part of the path in the first column, and the names in the last one.
fn described(architecture: &str) -> Arrows {
    let rows = architecture.lines().filter_map(|line| {
        let row = line.strip_prefix(&format!("| `{SOURCES}/"))?.strip_suffix('|')?;
        let (room, rest) = row.split_once('`')?;
        let uses = rest.rsplit('|').next()?.split(',').map(|name| name.trim().to_owned());
        let name = room.trim_end_matches('/').trim_end_matches(".rs").to_owned();
        Some((name, uses.filter(|name| !name.is_empty()).collect()))
    });
    rows.collect()
}

/// What follows each `crate::`, with every name of a list in braces.
fn named_after_crate(source: &str) -> Vec<String> {
    let mut names = Vec::new();
    for rest in source.split("crate::").skip(1) {
        let mut depth = 0;
        let mut starts = true;
        for part in rest.split_inclusive(|c: char| !c.is_alphanumeric() && c != '_') {
            let (word, end) =
                part.split_at(part.len() - part.chars().last().map_or(0, char::len_utf8));
            if starts && depth <= 1 && !word.is_empty() {
                names.push(word.to_owned());
                starts = false;
            }
            match end {
                "{" => depth += 1,
                "}" => depth -= 1,
                "," => starts = depth == 1,
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
    }
    names
}

/// The room of a file of the library.
fn room(file: &str) -> Option<String> {
    let inside = file.strip_prefix(SOURCES)?.strip_prefix('/')?;
    let first = inside.split('/').next()?.trim_end_matches(".rs");
    (first != "lib").then(|| first.to_owned())
}

fn found() -> Arrows {
    let is_test = |name: &str| name.contains("/tests/") || name.ends_with("/tests.rs");
    let files: Vec<Page> =
        below(SOURCES, &[".rs"]).into_iter().filter(|file| !is_test(&file.name)).collect();
    let rooms: BTreeSet<String> = files.iter().filter_map(|file| room(&file.name)).collect();
    let mut arrows: Arrows = rooms.iter().map(|room| (room.clone(), BTreeSet::new())).collect();
    for file in &files {
        let Some(user) = room(&file.name) else { continue };
        let mut used = named_after_crate(&file.text);
        let crates = CRATES.iter().filter(|name| file.text.contains(&format!("piola_{name}")));
        used.extend(crates.map(|name| (*name).to_owned()));
        let others = used.into_iter().filter(|name| *name != user);
        let is_crate = |name: &String| CRATES.contains(&name.as_str());
        let known = others.filter(|name| rooms.contains(name) || is_crate(name));
        arrows.entry(user.clone()).or_default().extend(known);
    }
    arrows
}

#[test]
fn the_table_of_rooms_is_that_of_the_sources() {
    assert!(root().join(SOURCES).is_dir());
    assert_eq!(described(&page("docs/architecture.md").text), found());
}

#[test]
fn arrows_lead_downwards() {
    let mut left = found();
    left.values_mut().for_each(|uses| _ = uses.remove("formulas"));
    // Rooms that use nothing that is left lie at the bottom: take them away, layer by layer.
    while !left.is_empty() {
        let bottom: BTreeSet<String> = left
            .iter()
            .filter(|(_, uses)| uses.iter().all(|room| !left.contains_key(room)))
            .map(|(room, _)| room.clone())
            .collect();
        assert!(!bottom.is_empty(), "these rooms use each other in a circle: {left:?}");
        left.retain(|room, _| !bottom.contains(room));
    }
}

#[test]
fn lists_in_braces_are_read() {
    let source = "use crate::{Vector, fields::{Snapshot, time}, parallel}; use crate::time::Clock;\n\
                  fn f() -> crate::Tensor { crate::neighbors::Domain }";
    let names = ["Vector", "fields", "parallel", "time", "Tensor", "neighbors"];
    assert_eq!(named_after_crate(source), names);
}
