//! The files of the repository, as the tests read them.

use std::fs;
use std::path::{Path, PathBuf};

/// A text file with its path from the root of the repository.
pub struct Page {
    pub name: String,
    pub text: String,
}

impl Page {
    /// Lines that are prose, and lines between fences or indented by four blanks.
    pub fn lines(&self) -> (Vec<&str>, Vec<&str>) {
        let mut fenced = false;
        self.text.lines().filter(|line| !line.trim().is_empty()).partition(|line| {
            let fence = line.trim_start().starts_with("```");
            fenced ^= fence;
            !(fenced || fence || line.starts_with("    "))
        })
    }

    /// The folder that its relative links start from.
    pub fn folder(&self) -> PathBuf {
        root().join(&self.name).parent().expect("a file lies in a folder").to_owned()
    }
}

/// The root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The file called `name`, a path from the root.
pub fn page(name: &str) -> Page {
    let text = fs::read_to_string(root().join(name));
    Page { name: name.to_owned(), text: text.unwrap_or_else(|error| panic!("{name}: {error}")) }
}

/// The files below `folder`, a path from the root, whose names end in one of `endings`, sorted.
/// Results of runs are left out.
pub fn below(folder: &str, endings: &[&str]) -> Vec<Page> {
    let mut pages = Vec::new();
    let entries = fs::read_dir(root().join(folder)).unwrap_or_else(|error| {
        panic!("{folder}: {error}");
    });
    for entry in entries {
        let entry = entry.expect("the folder can be read");
        let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            if !name.ends_with("results") {
                pages.extend(below(&name, endings));
            }
        } else if endings.iter().any(|ending| name.ends_with(ending)) {
            pages.push(page(&name));
        }
    }
    pages.sort_by(|a, b| a.name.cmp(&b.name));
    pages
}

/// Everything that people read as a page.
pub fn all() -> Vec<Page> {
    let mut pages = vec![page("README.md"), page("CONTRIBUTING.md"), page("CHANGELOG.md")];
    pages.extend(below("docs", &[".md"]));
    pages.extend(below("cases", &[".md"]));
    pages
}

/// Everything that may cite: pages, sources and case files.
pub fn all_that_cite() -> Vec<Page> {
    let mut pages = all();
    pages.extend(below("crates", &[".rs", ".toml"]));
    pages.extend(below("cases", &[".toml", ".py"]));
    pages
}
