//! Every path that a page mentions exists, and every heading that a link names.

use std::collections::BTreeSet;
use std::path::Path;
use std::{fs, iter};

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

/// The targets of links and pictures that lie in the repository, with the heading behind a `#`.
fn links(line: &str) -> impl Iterator<Item = &str> {
    let after = |mark: &'static str, end: char| {
        line.split(mark).skip(1).filter_map(move |rest| rest.split(end).next())
    };
    let targets = after("](", ')').chain(after("src=\"", '"'));
    targets.filter(|target| !target.is_empty() && !target.contains("://"))
}

/// A target without its heading.
fn file(target: &str) -> &str {
    target.split('#').next().unwrap_or_default()
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
    let links = prose.iter().flat_map(|line| links(line)).map(file).filter(|path| !path.is_empty());
    let found: Vec<&str> = quoted.chain(named).chain(links).collect();
    let lost = found.iter().filter(|path| !exists(&root(), path) && !exists(&page.folder(), path));
    (found.len(), lost.map(|path| format!("{}: {path}", page.name)).collect())
}

/// The names by which links find the headings of a page: letters, digits, `-` and `_`, in small
/// letters, with `-` for a blank. A name that is there already gets a number.
fn headings(page: &Page) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for line in page.lines().0.iter().filter(|line| line.starts_with('#')) {
        let heading = line.trim_start_matches('#').trim();
        let kept = heading.chars().filter(|&c| c.is_alphanumeric() || "-_ ".contains(c));
        let name: String = kept.collect::<String>().to_lowercase().replace(' ', "-");
        let numbered = (1..).map(|number| format!("{name}-{number}"));
        let free = iter::once(name.clone()).chain(numbered).find(|name| !names.contains(name));
        names.extend(free);
    }
    names
}

/// The links of a page to headings, and those of them that find none.
fn anchors(from: &Page) -> (usize, Vec<String>) {
    let (prose, _) = from.lines();
    let links = prose.iter().flat_map(|line| links(line));
    let found: Vec<(&str, &str)> = links.filter_map(|target| target.split_once('#')).collect();
    let is_lost = |&&(path, heading): &&(&str, &str)| {
        let text = match path {
            "" => Some(from.text.clone()),
            _ => fs::read_to_string(from.folder().join(path)).ok(),
        };
        let target = text.map(|text| Page { name: path.to_owned(), text });
        !target.is_some_and(|target| headings(&target).contains(heading))
    };
    let lost = found.iter().filter(is_lost);
    (found.len(), lost.map(|(path, heading)| format!("{}: {path}#{heading}", from.name)).collect())
}

#[test]
fn paths_in_pages_exist() {
    let (counts, lost): (Vec<usize>, Vec<Vec<String>>) = all().iter().map(paths).unzip();
    assert_eq!(lost.concat(), Vec::<String>::new(), "these paths lead nowhere");
    // The pages have more than this; fewer mean that the search for them is broken.
    assert!(counts.iter().sum::<usize>() > 100, "{counts:?}");
}

#[test]
fn headings_that_links_name_exist() {
    let (counts, lost): (Vec<usize>, Vec<Vec<String>>) = all().iter().map(anchors).unzip();
    assert_eq!(lost.concat(), Vec::<String>::new(), "these links find no heading");
    assert!(counts.iter().sum::<usize>() >= 5, "{counts:?}");
}

#[test]
fn a_heading_that_is_not_there_is_found() {
    let text = "# `[[one]]` or two: 3.4\n## Again\n## Again\n```\n# no heading\n```\n\
                [a](#one-or-two-34) [b](#again-1) [c](docs/checks.md#checks) [d](#no-heading)\n\
                [e](docs/checks.md#nothing) [f](#again-2) [g](docs/nowhere.md#checks)\n"
        .to_owned();
    let (count, lost) = anchors(&Page { name: "README.md".to_owned(), text });
    let expected = ["#no-heading", "docs/checks.md#nothing", "#again-2", "docs/nowhere.md#checks"];
    assert_eq!(lost, expected.map(|link| format!("README.md: {link}")));
    assert_eq!(count, 7);
}

#[test]
fn a_path_that_leads_nowhere_is_found() {
    let text = "See `crates/piola/src/lib.rs`, `crates/piola/src/lob.rs` and `docs/*.bib`, not \
                `m/s`, `a b/c` or `results/bar`, but [this](docs/nowhere.md#there).\n\
                <img src=\"docs/nothing.png\">\n\
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
        "docs/nothing.png",
    ];
    assert_eq!(lost, expected.map(|path| format!("README.md: {path}")));
    assert_eq!(count, expected.len() + 2);
    assert!(page("README.md").text.starts_with("# piola"));
}
