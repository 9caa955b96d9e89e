//! Case files: what a user writes, checked and turned into types.
//!
//! The stages of reading a case: text, tree of values (`document`), overrides (`overrides`), check against the
//! descriptions of the tables ([`spec`], [`tables`], `decode`), agreement of values with each other (`interpret`),
//! and the typed [`Case`]. Every stage keeps the places of its values, so that each problem points at the text that
//! causes it, and all are reported at once.

pub mod assembly;
pub mod catalogue;
mod columns;
mod decode;
pub mod diagnostics;
mod document;
pub mod expression;
mod finished;
mod functions;
mod interpret;
pub mod model;

mod outline;
mod outputs;
mod overrides;
pub mod page;
mod plan;
mod ranks;
mod record;
pub mod reference;
mod render;
pub mod report;
mod resume;
pub mod schema;
mod sensitivity;
mod session;
mod settings;
pub mod source;
pub mod spec;
mod suggest;
pub mod sweep;
pub mod tables;
pub mod template;
pub mod verify;
mod views;

use std::path::Path;
use std::sync::Arc;

pub use columns::ColumnError;
use decode::{Context, evaluate_parameters};
pub use diagnostics::{Problem, Problems};
use document::{Node, Table, Value};
pub use expression::Expression;
pub use finished::Finished;
pub use functions::{Arrays, Clouds, Functions, Named};
use interpret::Setting;
pub use model::{Case, Level};
use overrides::Override;
pub use plan::{BANDWIDTH, LATENCY, Plan, PlannedLimit, PlannedRank, Undamped, seconds_told};
pub use ranks::{Unserved, decline, serve};
pub use sensitivity::SensitivityError;
pub use session::{RunError, Session};
pub use source::{Located, Place, SourceText};
pub use views::FieldView;

/// What is said on the command line in front of an override.
const FLAG: &str = "--set ";

/// Options for reading a case file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Overrides `path.to.key=value` and `path.to.list+=value`, applied last, in this order. They apply to the
    /// setting that is read; if there are any, the other settings are not checked.
    pub overrides: Vec<String>,
    /// The variant, `None` or `base` for the case itself; `NAME.3` for the third member of the
    /// sweep `NAME`.
    pub variant: Option<String>,
    /// The setting that is read. The overrides of `[coarse]` or `[paper]` come first, those of a
    /// variant next, the variant's own coarse ones after them.
    pub level: Level,
    /// What `"@NAME"` stands for in place of an expression.
    pub functions: Functions,
    /// What `"@NAME"` stands for in place of the file of a shape of the kind `points`.
    pub clouds: Clouds,
    /// What `"@NAME"` stands for in place of an expression of an initial state.
    pub arrays: Arrays,
}

/// Reads the case file at `path`.
///
/// # Errors
/// All problems at once; [`Problems::is_io`] if the file cannot be read. The settings that the options do not select
/// (variants, coarse, paper) are checked too if there are no overrides.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Case, Problems> {
    let source = document::read(path)?;
    // A bare file name has the empty path as its folder, to which names can be joined.
    assemble(source, path.parent().or(Some(Path::new(""))), options)
}

/// Reads a case from its text. Files that it names are not searched for.
///
/// # Errors
/// As [`load`], with `name` in place of the path.
pub fn parse(text: &str, name: &str, options: &LoadOptions) -> Result<Case, Problems> {
    assemble(SourceText { name: name.to_owned(), text: text.to_owned() }, None, options)
}

/// Reads a case from its text, as if it were in a file in `folder`: files that it names are searched for from there.
///
/// # Errors
/// As [`parse`].
pub fn parse_in(
    folder: &Path,
    text: &str,
    name: &str,
    options: &LoadOptions,
) -> Result<Case, Problems> {
    let source = SourceText { name: name.to_owned(), text: text.to_owned() };
    assemble(source, Some(folder), options)
}

fn assemble(
    file: SourceText,
    folder: Option<&Path>,
    options: &LoadOptions,
) -> Result<Case, Problems> {
    let parsed = document::parse(&file.text);
    let flags = options
        .overrides
        .iter()
        .map(|text| SourceText { name: "command line".to_owned(), text: format!("{FLAG}{text}") });
    let sources: Arc<[SourceText]> = std::iter::once(file).chain(flags).collect();
    let tree = parsed.map_err(|problems| Problems::new(sources.clone(), problems))?;
    let variant = options.variant.as_deref().filter(|name| *name != "base");
    let is_changed = !options.overrides.is_empty();
    let LoadOptions { functions, clouds, arrays, level, .. } = options;
    let wanted = Setting {
        variant,
        level: *level,
        folder,
        is_changed,
        functions: Some(functions),
        clouds: Some(clouds),
        arrays: Some(arrays),
    };
    let case = read(&tree, &sources, options, wanted).and_then(|(case, changed)| {
        if !is_changed {
            others(&tree, &sources, options, wanted, &case)?;
        }
        let as_run = document::write(&changed);
        let mut remarks = case.remarks;
        remarks.extend(unused_parameters(&tree, &as_run, &options.overrides));
        Ok(Case { as_run, remarks, ..case })
    });
    case.map_err(|problems| Problems::new(sources, problems))
}

/// What to say of parameters that the command line sets, that the case does not have, and that nothing in the case `as_run`
/// mentions: most probably another was meant.
fn unused_parameters(tree: &Table, as_run: &str, overrides: &[String]) -> Vec<String> {
    let known: Vec<&str> = match tree.get("parameters") {
        Some(Node { value: Value::Table(table), .. }) => {
            table.entries.iter().map(|entry| entry.key.as_str()).collect()
        }
        _ => Vec::new(),
    };
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let paths =
        overrides.iter().filter_map(|text| text.split_once('=')).map(|(path, _)| path.trim());
    let names = paths.filter_map(|path| path.strip_prefix("parameters."));
    let new = names.filter(|name| name.chars().all(is_word) && !known.contains(name));
    // Its own line mentions it once.
    let unused =
        new.filter(|name| as_run.split(|c| !is_word(c)).filter(|word| word == name).count() < 2);
    let remark = |name: &str| {
        let near = suggest::nearest(name, known.iter().copied());
        let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        format!("the case has no parameter `{name}`, and nothing depends on it{near}")
    };
    unused.map(remark).collect()
}

/// Reads one setting of the case, and returns it with the tree after all overrides.
fn read(
    tree: &Table,
    sources: &[SourceText],
    options: &LoadOptions,
    setting: Setting<'_>,
) -> Result<(Case, Table), Vec<Problem>> {
    let mut problems = Vec::new();
    let mut tree = tree.clone();
    settings::apply(&mut tree, sources, setting, &mut problems);
    for (text, source) in options.overrides.iter().zip(1..) {
        Override::of_command_line(text, source, FLAG.len()).apply(&mut tree, &mut problems);
    }
    Ok((check(&tree, sources, setting, problems)?, tree))
}

/// Reads a case from the record of its run: `text` after all overrides, of which the variant was
/// `variant`. Settings that were not run are not looked at.
fn recorded(text: &str, variant: Option<&str>) -> Result<Case, Problems> {
    let sources: Arc<[SourceText]> =
        Arc::new([SourceText { name: "the case as run".to_owned(), text: text.to_owned() }]);
    let setting = Setting {
        variant,
        level: Level::Case,
        folder: None,
        is_changed: true,
        functions: None,
        clouds: None,
        arrays: None,
    };
    let tree = document::parse(text);
    let case = tree.and_then(|tree| check(&tree, &sources, setting, Vec::new()));
    let case = case.map_err(|problems| Problems::new(sources, problems))?;
    Ok(Case { as_run: text.to_owned(), ..case })
}

/// Checks a tree after all overrides, of which `problems` came.
fn check(
    tree: &Table,
    sources: &[SourceText],
    setting: Setting<'_>,
    problems: Vec<Problem>,
) -> Result<Case, Vec<Problem>> {
    let dimension = match tree.get("dimension") {
        Some(Node { value: Value::Integer(dimension @ 1..=3), .. }) => {
            usize::try_from(*dimension).ok()
        }
        _ => None,
    };
    let mut context = Context {
        sources,
        dimension,
        parameters: Vec::new(),
        functions: setting.functions,
        arrays: setting.arrays,
        problems,
        remarks: Vec::new(),
    };
    evaluate_parameters(&mut context, tree);
    let record = context.table(&tables::CASE, tree, Place::new(0, 0..0));
    let case = interpret::case(&record, &mut context, setting);
    match case {
        Some(case) if context.problems.is_empty() => Ok(case),
        _ if context.problems.is_empty() => {
            Err(vec![Problem::whole("the case could not be read, without a known reason")])
        }
        _ => Err(context.problems),
    }
}

/// Checks the settings of the case that were not asked for.
fn others(
    tree: &Table,
    sources: &[SourceText],
    options: &LoadOptions,
    wanted: Setting<'_>,
    case: &Case,
) -> Result<(), Vec<Problem>> {
    let mut problems: Vec<Problem> = Vec::new();
    for variant in case.settings() {
        for level in [Level::Case, Level::Coarse, Level::Paper] {
            if level == Level::Paper && case.paper.is_none() {
                continue;
            }
            let setting = Setting { variant: variant.as_deref(), level, ..wanted };
            if setting.variant.is_some_and(|name| !case.is_at(name, level)) {
                continue;
            }
            if setting.variant == wanted.variant && level == wanted.level {
                continue;
            }
            let found = read(tree, sources, options, setting).err().unwrap_or_default();
            let is_new = |problem: &Problem, known: &[Problem]| {
                !known.iter().any(|other| {
                    other.place == problem.place && other.message.starts_with(&problem.message)
                })
            };
            for mut problem in found {
                if is_new(&problem, &problems) {
                    problem.message.push_str(&settings::remark(setting));
                    problems.push(problem);
                }
            }
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

#[cfg(test)]
mod tests;
