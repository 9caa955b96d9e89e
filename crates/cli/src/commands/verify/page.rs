//! Writing the validation page with its charts, and the results that it is made of.

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::time::SystemTime;

use piola::case::page::{CaseResults, PageCase, Reproduction, Results, Row};
use piola::output::{Plot, atomic};

use crate::exit::{Exit, Fault};
use crate::terminal;
use crate::text::count;

/// The list of what the papers show, beside the cases.
const LIST: &str = "reproduction.toml";

/// The day, as 2026-11-22.
pub fn today() -> String {
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    now.split('T').next().unwrap_or_default().to_owned()
}

/// A page in the making: `NAME.md`, with its charts in the folder `NAME` and its results in
/// `NAME.json`, where those of cases that are not run again stay as they are. It is written after
/// each case, so that nothing is lost where the next one is interrupted.
pub struct Writer {
    file: PathBuf,
    above: PathBuf,
    list: Vec<Reproduction>,
    charts: usize,
}

impl Writer {
    /// A page for `file`. The list of what the papers show is looked for above `paths`.
    pub fn new(file: &Path, paths: &[PathBuf]) -> Result<Self, Fault> {
        if file.with_extension("") == file {
            let message = format!(
                "the page {} needs a file name extension, for example `.md`",
                file.display()
            );
            return Err(Fault::new(Exit::BadCase, message));
        }
        let above = file.parent().filter(|above| !above.as_os_str().is_empty());
        let above = above.unwrap_or(Path::new(".")).to_owned();
        fs::create_dir_all(&above).map_err(|error| fault(&above, &error))?;
        let writer = Self { file: file.to_owned(), above, list: list(paths)?, charts: 0 };
        writer.earlier()?;
        Ok(writer)
    }

    /// The results that there are, without those of cases that have gone.
    fn earlier(&self) -> Result<Results, Fault> {
        let file = self.file.with_extension("json");
        let Ok(text) = fs::read_to_string(&file) else { return Ok(Results::default()) };
        let mut results: Results = serde_json::from_str(&text).map_err(|error| {
            let name = file.display();
            let message = format!(
                "{name} holds no results of an earlier page: {error}; remove it to start anew"
            );
            Fault::new(Exit::BadCase, message)
        })?;
        results.cases.retain(|case| self.above.join(&case.link).exists());
        Ok(results)
    }

    /// Adds the case at `path`.
    pub fn add(&mut self, mut case: PageCase, path: &Path, today: &str) -> Result<(), Fault> {
        let target = path.with_file_name("README.md");
        if target.is_file() {
            case.pictures = pictures(&target, &self.above);
        }
        let target = if target.is_file() { target } else { path.to_owned() };
        case.link = relative(&self.above, &target);
        match case.results(today) {
            Some((results, charts)) => self.write(results, &charts),
            None => Ok(()),
        }
    }

    /// Adds the case at `path`, which cannot be read: the name of its folder, and a row that says so.
    pub fn add_unreadable(
        &mut self,
        (name, rows): &(String, Vec<Row>),
        path: &Path,
    ) -> Result<(), Fault> {
        let results = CaseResults {
            id: name.clone(),
            name: name.clone(),
            link: relative(&self.above, path),
            rows: rows.clone(),
            ..CaseResults::default()
        };
        self.write(results, &[])
    }

    /// Writes page, results and the charts of a case, and removes charts that no case has any more.
    fn write(&mut self, case: CaseResults, charts: &[(String, Plot)]) -> Result<(), Fault> {
        let io = |error| Fault::new(Exit::Io, error);
        let mut results = self.earlier()?;
        results.version = env!("CARGO_PKG_VERSION").to_owned();
        results.put(case);
        let folder = self.file.with_extension("");
        let name =
            folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
        let page = results.page(&self.list, &name);
        if !charts.is_empty() {
            fs::create_dir_all(&folder).map_err(|error| fault(&folder, &error))?;
        }
        for (chart, plot) in charts {
            plot.write_png(&folder.join(chart)).map_err(io)?;
        }
        self.charts += charts.len();
        let json = serde_json::to_string_pretty(&results).unwrap_or_default() + "\n";
        let earlier = fs::read_to_string(&self.file).unwrap_or_default();
        atomic::write_file(&self.file.with_extension("json"), |out| out.write_all(json.as_bytes()))
            .map_err(io)?;
        atomic::write_file(&self.file, |out| out.write_all(page.as_bytes())).map_err(io)?;
        let kept = shown(&page, &name);
        for chart in shown(&earlier, &name).iter().filter(|chart| !kept.contains(chart)) {
            // It may be gone already.
            let _ = fs::remove_file(folder.join(chart));
        }
        Ok(())
    }

    /// Says what has been written.
    pub fn report(&self) -> Result<(), Fault> {
        let charts = count(self.charts as u64, "chart");
        terminal::print(&format!("wrote {} with {charts}\n", self.file.display()))
    }
}

fn fault(path: &Path, error: &std::io::Error) -> Fault {
    Fault::new(Exit::Io, format!("cannot write {}: {error}", path.display()))
}

/// The list of what the papers show, empty where there is none.
fn list(paths: &[PathBuf]) -> Result<Vec<Reproduction>, Fault> {
    let above = paths.iter().flat_map(|path| path.ancestors());
    let Some(file) = above.map(|path| path.join(LIST)).find(|file| file.is_file()) else {
        return Ok(Vec::new());
    };
    let name = file.display();
    let text = fs::read_to_string(&file)
        .map_err(|error| Fault::new(Exit::Io, format!("cannot read {name}: {error}")))?;
    Reproduction::read(&text).map_err(|why| Fault::new(Exit::BadCase, format!("{name}: {why}")))
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
