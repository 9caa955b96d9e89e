//! Writing the validation page with its charts.

use std::fs;
use std::path::{Component, Path, PathBuf};

use piola::case::page::{PageCase, page};
use piola::output::atomic;

use crate::exit::{Exit, Fault};
use crate::terminal;
use crate::text::count;

/// Writes the page to `file`, its charts into the folder of its name without ending, and removes
/// charts that an earlier page of this name shows and this one does not.
pub fn write(file: &Path, mut cases: Vec<PageCase>, full: bool) -> Result<(), Fault> {
    let folder = file.with_extension("");
    if folder == file {
        let message = format!("the page {} needs an ending, for example `.md`", file.display());
        return Err(Fault::new(Exit::BadCase, message));
    }
    let name = folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
    let above = file.parent().filter(|above| !above.as_os_str().is_empty());
    let above = above.unwrap_or(Path::new("."));
    let fault = |path: &Path, error: &std::io::Error| {
        Fault::new(Exit::Io, format!("cannot write {}: {error}", path.display()))
    };
    fs::create_dir_all(above).map_err(|error| fault(above, &error))?;
    for case in &mut cases {
        let target = Path::new(&case.link).with_file_name("README.md");
        if target.is_file() {
            case.pictures = pictures(&target, above);
        }
        let target = if target.is_file() { target } else { PathBuf::from(&case.link) };
        case.link = relative(above, &target);
    }
    let earlier = fs::read_to_string(file).unwrap_or_default();
    let made = page(cases, full, &name);
    if !made.charts.is_empty() {
        fs::create_dir_all(&folder).map_err(|error| fault(&folder, &error))?;
    }
    let io = |error| Fault::new(Exit::Io, error);
    for (chart, plot) in &made.charts {
        plot.write_png(&folder.join(chart)).map_err(io)?;
    }
    atomic::write_file(file, |out| out.write_all(made.markdown.as_bytes())).map_err(io)?;
    for chart in shown(&earlier, &name) {
        if made.charts.iter().all(|(known, _)| known != chart) {
            // It may be gone already.
            let _ = fs::remove_file(folder.join(chart));
        }
    }
    let charts = count(made.charts.len() as u64, "chart");
    terminal::print(&format!("wrote {} with {charts}\n", file.display()))
}

/// The pictures beside the page of a case, by name, with their links from the folder `from`.
fn pictures(page: &Path, from: &Path) -> Vec<(String, String)> {
    let entries = page.parent().and_then(|folder| fs::read_dir(folder).ok());
    let mut files: Vec<PathBuf> =
        entries.into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "png"));
    files.sort();
    let name = |file: &Path| {
        file.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
    };
    files.iter().map(|file| (name(file), relative(from, file))).collect()
}

/// The charts in the folder `name` that a page shows.
fn shown<'a>(page: &'a str, name: &str) -> Vec<&'a str> {
    let start = format!("]({name}/");
    let files = page.split(start.as_str()).skip(1).filter_map(|rest| rest.split(')').next());
    files.filter(|file| file.ends_with(".png") && !file.contains(['/', '\\'])).collect()
}

/// The way from the folder `from` to `to`, with `/` between its parts.
fn relative(from: &Path, to: &Path) -> String {
    let (Ok(from), Ok(to)) = (from.canonicalize(), to.canonicalize()) else {
        return to.display().to_string();
    };
    let parts = |path: &Path| -> Vec<String> {
        let parts = path.components().filter(|part| *part != Component::CurDir);
        parts.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect()
    };
    let (from, to) = (parts(&from), parts(&to));
    let same = from.iter().zip(&to).take_while(|(one, other)| one == other).count();
    let up = std::iter::repeat_n("..", from.len() - same);
    up.chain(to[same..].iter().map(String::as_str)).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_lead_up_and_down() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let way = relative(&root.join("src/commands"), &root.join("tests/program/main.rs"));
        assert_eq!(way, "../../tests/program/main.rs");
        assert_eq!(relative(&root.join("src"), &root.join("src/main.rs")), "main.rs");
    }

    #[test]
    fn only_charts_of_the_page_are_its_own() {
        let page = "![a](validation/a.png) [b](validation/../b.png) ![c](other/c.png) \
                    ![d](validation/d.txt)";
        assert_eq!(shown(page, "validation"), ["a.png"]);
    }
}
