//! Every path that a page mentions exists.

use std::fs;
use std::path::Path;

use super::pages::{Page, all, page, root};

/// First parts of paths that a run or a build makes.
const MADE: [&str; 8] = [
    "results",
    "target",
    "particles",
    "pictures",
    "profiles",
    "plots",
    "checkpoints",
    "references",
];
/// Endings of files that are paths even without a folder in front.
const SOURCES: [&str; 3] = [".rs", ".md", ".bib"];
/// Folders that commands between fences name.
const FOLDERS: [&str; 3] = ["cases/", "crates/", "docs/"];

/// The text between single back quotes, line by line.
fn quoted(line: &str) -> impl Iterator<Item = &str> {
    line.split('`').skip(1).step_by(2)
}

/// The targets of links and pictures that lie in the repository.
fn links(line: &str) -> impl Iterator<Item = &str> {
    line.split("](").skip(1).filter_map(|rest| {
        let target = rest.split(')').next()?.split('#').next()?;
        (!target.is_empty() && !target.contains("://")).then_some(target)
    })
}

fn looks_like_a_path(text: &str) -> bool {
    let first = text.split('/').next().unwrap_or_default();
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_./*-".contains(c);
    let is_name = |text: &str| SOURCES.iter().any(|ending| text.ends_with(ending));
    text.chars().all(is_plain)
        && !text.contains("//")
        && !MADE.contains(&first)
        && (text.contains('/') && (first.len() > 2 || first == ".") || is_name(text))
}

/// Whether there is something at `path`, in which `*` stands for any part of a name.
fn exists(base: &Path, path: &str) -> bool {
    let Some((first, rest)) = path.split_once('/') else { return is_there(base, path) };
    if first.contains('*') {
        let entries = fs::read_dir(base).into_iter().flatten().flatten();
        return entries
            .filter(|entry| matches(&entry.file_name().to_string_lossy(), first))
            .any(|entry| exists(&entry.path(), rest));
    }
    exists(&base.join(first), rest)
}

fn is_there(base: &Path, name: &str) -> bool {
    let mut entries = fs::read_dir(base).into_iter().flatten().flatten();
    match name {
        "" => base.is_dir(),
        _ => entries.any(|entry| matches(&entry.file_name().to_string_lossy(), name)),
    }
}

fn matches(name: &str, pattern: &str) -> bool {
    match pattern.split_once('*') {
        None => name == pattern,
        Some((start, end)) => {
            name.len() >= pattern.len() - 1 && name.starts_with(start) && name.ends_with(end)
        }
    }
}

/// The paths of a page, and those of them that lead nowhere.
fn paths(page: &Page) -> (usize, Vec<String>) {
    let (prose, code) = page.lines();
    let quoted = prose.iter().flat_map(|line| quoted(line)).filter(|text| looks_like_a_path(text));
    let words = code.iter().flat_map(|line| line.split_whitespace());
    let named = words.filter(|word| FOLDERS.iter().any(|folder| word.starts_with(folder)));
    let links = prose.iter().flat_map(|line| links(line));
    let found: Vec<&str> = quoted.chain(named).chain(links).collect();
    let lost = found.iter().filter(|path| !exists(&root(), path) && !exists(&page.folder(), path));
    (found.len(), lost.map(|path| format!("{}: {path}", page.name)).collect())
}

#[test]
fn paths_in_pages_exist() {
    let (counts, lost): (Vec<usize>, Vec<Vec<String>>) = all().iter().map(paths).unzip();
    assert_eq!(lost.concat(), Vec::<String>::new(), "these paths lead nowhere");
    // The pages have more than this; fewer mean that the search for them is broken.
    assert!(counts.iter().sum::<usize>() > 100, "{counts:?}");
}

#[test]
fn a_path_that_leads_nowhere_is_found() {
    let text = "See `crates/piola/src/lib.rs`, `crates/piola/src/lob.rs` and `docs/*.bib`, not \
                `m/s`, `a b/c` or `results/bar`, but [this](docs/nowhere.md).\n\
                ```\npiola run cases/nothing/case.toml --out results/bar\n```\n\
                `crates/*/src/nothing.rs` `schemes/upwind/` `lost.rs`\n"
        .to_owned();
    let (count, lost) = paths(&Page { name: "README.md".to_owned(), text });
    let expected = [
        "crates/piola/src/lob.rs",
        "crates/*/src/nothing.rs",
        "schemes/upwind/",
        "lost.rs",
        "cases/nothing/case.toml",
        "docs/nowhere.md",
    ];
    assert_eq!(lost, expected.map(|path| format!("README.md: {path}")));
    assert_eq!(count, expected.len() + 2);
    assert!(page("README.md").text.starts_with("# piola"));
}
