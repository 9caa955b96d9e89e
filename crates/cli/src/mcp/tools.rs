//! What an assistant can call.

use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use piola::case::{Case, LoadOptions, Problems, Session, load, parse_in, report, schema};
use piola::time::{Outcome, Progress};
use serde_json::{Value, json};

use crate::commands::check::plan_text;
use crate::commands::run::default_name;
use crate::exit::{Exit, Fault};
use crate::progress::Pace;
use crate::summary::summary;

/// Time between messages of progress.
const INTERVAL: Duration = Duration::from_secs(1);

/// What came of a call.
pub enum Answer {
    /// What was asked for.
    Text(String),
    /// What is wrong with the case, the run or the folder.
    Fault(String),
    /// There is no such tool, or its arguments are not as its schema has them.
    BadArguments(String),
}

/// The tools, with the folder in which they work.
pub struct Tools {
    folder: PathBuf,
}

/// Descriptions of the tools, with the schemas of their arguments.
pub fn list() -> Value {
    let case = json!({ "type": "string", "description": "path of a case file in the folder of the server" });
    let text =
        json!({ "type": "string", "description": "the text of a case file, instead of `case`" });
    let set = json!({
        "type": "array", "items": { "type": "string" },
        "description": "keys to change, for example \"body.water.spacing=0.05\"",
    });
    let variant = json!({ "type": "string", "description": "a variant of the case" });
    let changes = json!({ "case": case, "text": text, "set": set, "variant": variant });
    let mut run = changes.clone();
    run["name"] = json!({ "type": "string", "description": "name of the folder in results/, by default that of the folder of the case; letters, digits, - and _" });
    let tool = |name: &str,
                description: &str,
                properties: Value,
                required: &[&str],
                reads: bool| {
        json!({
            "name": name,
            "description": description,
            "inputSchema": {
                "type": "object", "properties": properties, "required": required, "additionalProperties": false,
            },
            "annotations": { "readOnlyHint": reads, "openWorldHint": false, "destructiveHint": !reads },
        })
    };
    json!([
        tool(
            "schema",
            "The JSON schema of one top-level key of a case file, such as `body` or `scheme`, with units, defaults and \
             meanings of everything below it. Without `key` a list of these keys.",
            json!({ "key": { "type": "string", "description": "a top-level key of a case file" } }),
            &[],
            true,
        ),
        tool(
            "check",
            "Read and build a case without running it: all faults with their positions in the file, or what a \
             run will do (particles, neighbours, time steps, wall time, memory, warnings).",
            changes,
            &[],
            true,
        ),
        tool(
            "run",
            "Run a case, and return its outcome, energies and files. Results go to results/NAME in the folder of \
             the server, and replace those of an earlier run there.",
            run,
            &[],
            false,
        ),
        tool(
            "report",
            "Recreate the report of an earlier run (a page for a browser), and return its record: outcome, \
             failure, steps, wall time, notes, warnings and files.",
            json!({ "results": { "type": "string", "description": "folder of the results, for example results/tank" } }),
            &["results"],
            false,
        ),
    ])
}

impl Tools {
    /// Tools that work in `folder`.
    pub fn new(folder: &Path) -> Result<Self, Fault> {
        let found = folder.canonicalize().ok().filter(|path| path.is_dir());
        let folder = found.ok_or_else(|| {
            Fault::new(Exit::Io, format_args!("there is no folder {}", folder.display()))
        })?;
        Ok(Self { folder })
    }

    /// Calls a tool.
    pub fn call(
        &self,
        name: &str,
        arguments: &Value,
        stop: &Arc<AtomicBool>,
        progress: &mut dyn FnMut(f64, String),
    ) -> Answer {
        let known = list();
        let tool = known.as_array().into_iter().flatten().find(|tool| tool["name"] == name);
        let Some(tool) = tool else {
            let told = match name {
                "" => "`name`, the tool to call, is missing".to_owned(),
                name => format!("there is no tool `{name}`"),
            };
            return Answer::BadArguments(format!(
                "{told}; there are `schema`, `check`, `run` and `report`"
            ));
        };
        if let Err(text) = fits(arguments, &tool["inputSchema"]) {
            return Answer::BadArguments(text);
        }
        let result = match name {
            "schema" => part_of_schema(arguments["key"].as_str()),
            "check" => self.check(arguments, stop),
            "run" => self.run(arguments, stop, progress),
            _ => self.report(arguments["results"].as_str().unwrap_or_default()),
        };
        match result {
            Ok(text) => Answer::Text(text),
            Err(text) => Answer::Fault(text),
        }
    }

    fn check(&self, arguments: &Value, stop: &AtomicBool) -> Result<String, String> {
        let case = self.case(arguments)?;
        let mut session = Session::new(&case).map_err(|problems| problems.to_string())?;
        match stop.load(Ordering::SeqCst) {
            true => Err("cancelled".to_owned()),
            false => Ok(plan_text(&case, &session.plan())),
        }
    }

    fn run(
        &self,
        arguments: &Value,
        stop: &Arc<AtomicBool>,
        progress: &mut dyn FnMut(f64, String),
    ) -> Result<String, String> {
        let case = self.case(arguments)?;
        let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_');
        let name = match (arguments["name"].as_str(), arguments["case"].as_str()) {
            (Some(name), _) => name.to_owned(),
            (None, Some(path)) => default_name(&self.folder.join(path), case.variant.as_deref())
                .to_string_lossy()
                .replace(|c| !is_plain(c), "-"),
            (None, None) => "case".to_owned(),
        };
        if name.is_empty() || !name.chars().all(is_plain) {
            return Err(format!("`{name}` cannot be a name: give one of letters, digits, - and _"));
        }
        let folder = self.results(&name)?;
        let mut session = Session::new(&case).map_err(|problems| problems.to_string())?;
        session.write_to(&folder).map_err(|error| error.to_string())?;
        let start = Instant::now();
        let (mut pace, mut last) = (Pace::new(start), start);
        let mut update = |now: &Progress| {
            if last.elapsed() >= INTERVAL {
                last = Instant::now();
                progress(now.time / now.end, pace.line(now));
            }
        };
        let finished = session.run(stop, &mut update).map_err(|error| error.to_string())?;
        let text = summary(&finished, *case.time.end, &folder, start.elapsed().as_secs_f64());
        match &finished.summary.outcome {
            Outcome::Failed(failure) => Err(format!("the run failed: {failure}\n\n{text}")),
            _ => Ok(text),
        }
    }

    fn report(&self, results: &str) -> Result<String, String> {
        let name = results.strip_prefix("results/").unwrap_or(results);
        if Path::new(name).components().count() != 1 {
            return Err(format!("`{results}` is not a folder of results: give results/NAME"));
        }
        let folder = self.results(name)?;
        let page = report::write(&folder).map_err(|error| error.to_string())?;
        let record = std::fs::read_to_string(folder.join("run.json"));
        let record =
            record.map_err(|error| format!("cannot read the record of the run: {error}"))?;
        Ok(format!("{}\n\n{record}", page.display()))
    }

    /// A folder of results, in which nothing leads elsewhere.
    fn results(&self, name: &str) -> Result<PathBuf, String> {
        let folder = self.within(&Path::new("results").join(name))?;
        if folder.parent() != Some(&self.folder.join("results")) {
            return Err(format!("`{name}` is not a folder of results: give results/NAME"));
        }
        let mut folders = vec![folder.clone()];
        while let Some(next) = folders.pop() {
            // What is not there yet leads nowhere.
            for entry in std::fs::read_dir(next).into_iter().flatten().flatten() {
                match entry.file_type() {
                    Ok(kind) if kind.is_dir() => folders.push(entry.path()),
                    Ok(kind) if kind.is_file() => {}
                    _ => {
                        let entry = entry.path();
                        return Err(format!("{} is a link: remove it first", entry.display()));
                    }
                }
            }
        }
        Ok(folder)
    }

    /// The case of a call: a file in the folder, or a text as if it stood there.
    fn case(&self, arguments: &Value) -> Result<Case, String> {
        let set = arguments["set"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let options = LoadOptions {
            overrides: set.map(str::to_owned).collect(),
            variant: arguments["variant"].as_str().map(str::to_owned),
            ..LoadOptions::default()
        };
        let read = match (arguments["case"].as_str(), arguments["text"].as_str()) {
            (Some(path), None) => load(&self.within(Path::new(path))?, &options),
            (None, Some(text)) => parse_in(&self.folder, text, "the case", &options),
            _ => return Err("give either `case` or `text`".to_owned()),
        };
        read.map_err(|problems: Problems| problems.to_string())
    }

    /// A path in the folder, whatever links there are on the way.
    fn within(&self, path: &Path) -> Result<PathBuf, String> {
        let outside = || {
            let (path, folder) = (path.display(), self.folder.display());
            format!("{path} is not in the folder of the server, {folder}")
        };
        let whole = self.folder.join(path);
        if path.components().any(|part| part == Component::ParentDir) {
            return Err(outside());
        }
        // Where the part of the way leads that is there; the next part must not be a link that leads nowhere.
        let there = whole.ancestors().find_map(|part| Some((part, part.canonicalize().ok()?)));
        let (part, real) = there.ok_or_else(outside)?;
        let rest = whole.strip_prefix(part).unwrap_or(Path::new(""));
        let is_link = rest.components().next().is_some_and(|next| part.join(next).is_symlink());
        if !real.starts_with(&self.folder) || is_link {
            return Err(outside());
        }
        // Joined to nothing, the path of a file would become that of a folder.
        Ok(rest.components().fold(real, |path, next| path.join(next)))
    }
}

/// The schema of case files, or of what is below one of its keys, with the definitions that it refers to.
fn part_of_schema(key: Option<&str>) -> Result<String, String> {
    let whole = schema::json_schema();
    let Some(key) = key else {
        let keys = whole["properties"].as_object().into_iter().flatten();
        let line = |(name, part): (&String, &Value)| {
            format!("{name}: {}\n", part["description"].as_str().unwrap_or_default())
        };
        return Ok(keys.map(line).collect());
    };
    let Some(part) = whole["properties"].get(key) else {
        let names = whole["properties"].as_object().into_iter().flat_map(|all| all.keys());
        let names: Vec<String> = names.map(|name| format!("`{name}`")).collect();
        return Err(format!("there is no key `{key}`; there are {}", names.join(", ")));
    };
    let mut definitions = serde_json::Map::new();
    let mut wanted = references(part);
    while let Some(name) = wanted.pop() {
        if !definitions.contains_key(&name) {
            let definition = whole["$defs"][&name].clone();
            wanted.extend(references(&definition));
            definitions.insert(name, definition);
        }
    }
    Ok(format!("{:#}", json!({ "properties": { key: part }, "$defs": definitions })))
}

/// Names of the definitions that a part of a schema refers to.
fn references(part: &Value) -> Vec<String> {
    match part {
        Value::Object(all) => {
            let own = all.get("$ref").and_then(Value::as_str);
            let own = own.and_then(|path| path.strip_prefix("#/$defs/")).map(str::to_owned);
            own.into_iter().chain(all.values().flat_map(references)).collect()
        }
        Value::Array(all) => all.iter().flat_map(references).collect(),
        _ => Vec::new(),
    }
}

/// Whether arguments are as a schema of the kinds of [`list`] has them.
fn fits(arguments: &Value, schema: &Value) -> Result<(), String> {
    let empty = serde_json::Map::new();
    let given = match arguments {
        Value::Null => &empty,
        Value::Object(given) => given,
        _ => return Err("`arguments` must be an object".to_owned()),
    };
    for (name, value) in given.iter().filter(|(_, value)| !value.is_null()) {
        let known = &schema["properties"][name];
        let is_text_list =
            |value: &Value| value.as_array().is_some_and(|all| all.iter().all(Value::is_string));
        match known["type"].as_str() {
            None => return Err(format!("there is no argument `{name}`")),
            Some("array") if !is_text_list(value) => {
                return Err(format!("`{name}` must be a list of strings"));
            }
            Some("string") if !value.is_string() => {
                return Err(format!("`{name}` must be a string"));
            }
            _ => {}
        }
    }
    let mut required =
        schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
    match required.find(|name| !given.contains_key(*name)) {
        Some(name) => Err(format!("the argument `{name}` is missing")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_that_is_cancelled_has_no_plan() {
        let tools = Tools::new(Path::new(env!("CARGO_MANIFEST_DIR"))).expect("there is a folder");
        let arguments = json!({ "text": piola::case::template::new_case("a column") });
        let check = |stop| tools.check(&arguments, &AtomicBool::new(stop));
        assert!(check(false).is_ok_and(|plan| plan.contains("first step")));
        assert_eq!(check(true), Err("cancelled".to_owned()));
    }
}
