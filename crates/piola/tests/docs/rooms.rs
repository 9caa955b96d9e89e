//! The table of rooms in docs/architecture.md is that of the sources, and arrows lead downwards.

use std::collections::{BTreeMap, BTreeSet};

use super::pages::{Page, below, page};

/// The library's rooms with what they use.
type Arrows = BTreeMap<String, BTreeSet<String>>;

/// The crates of the library. The second is one room.
const LIBRARY: [&str; 3] = ["piola", "report", "physics"];

/// The crates below the library, `piola_` before each.
const CRATES: [&str; 3] = ["device", "formulas", "ranks"];

/// The table: the last part of the path in the first column, and the names in the last one.
fn described(architecture: &str) -> Arrows {
    let rows = architecture.lines().filter_map(|line| {
        let row = line.strip_prefix("| `crates/")?.strip_suffix('|')?;
        let (path, rest) = row.split_once('`')?;
        let uses = rest.rsplit('|').next()?.split(',').map(|name| name.trim().to_owned());
        Some((room(path)?, uses.filter(|name| !name.is_empty()).collect()))
    });
    rows.collect()
}

/// What follows each `crate::` or another root, with every name of a list in braces.
fn named_after(root: &str, source: &str) -> Vec<String> {
    let mut names = Vec::new();
    for rest in source.split(root).skip(1) {
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

/// The room of a path below `crates/`, if it is one of the library.
fn room(path: &str) -> Option<String> {
    let (package, inside) = path.split_once("/src/")?;
    let first = inside.split('/').next()?.trim_end_matches(".rs");
    let is_root = first == "lib" || !LIBRARY.contains(&package);
    match package {
        "report" => Some(package.to_owned()),
        _ => (!is_root).then(|| first.to_owned()),
    }
}

fn found() -> Arrows {
    let is_test = |name: &str| name.contains("/tests/") || name.ends_with("/tests.rs");
    let sources =
        LIBRARY.iter().flat_map(|package| below(&format!("crates/{package}/src"), &[".rs"]));
    let rooms: Vec<(String, Page)> = sources
        .filter(|file| !is_test(&file.name))
        .filter_map(|file| Some((room(file.name.strip_prefix("crates/")?)?, file)))
        .collect();
    let mut arrows: Arrows =
        rooms.iter().map(|(room, _)| (room.clone(), BTreeSet::new())).collect();
    let names: BTreeSet<String> = arrows.keys().cloned().collect();
    for (user, file) in &rooms {
        let mut used = named_after("crate::", &file.text);
        used.extend(named_after("piola_physics::", &file.text));
        // The name by which the library shows the crate.
        used.iter_mut().filter(|name| *name == "output").for_each(|name| *name = "report".into());
        let crates = CRATES.iter().filter(|name| file.text.contains(&format!("piola_{name}")));
        used.extend(crates.map(|name| (*name).to_owned()));
        let others = used.into_iter().filter(|name| name != user);
        let is_crate = |name: &String| CRATES.contains(&name.as_str());
        let known = others.filter(|name| names.contains(name) || is_crate(name));
        arrows.entry(user.clone()).or_default().extend(known);
    }
    arrows
}

#[test]
fn the_table_of_rooms_is_that_of_the_sources() {
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
    assert_eq!(named_after("crate::", source), names);
}
