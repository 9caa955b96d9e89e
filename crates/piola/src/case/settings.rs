//! The settings of a case file: coarse and variants, which are overrides of the base case.

use super::diagnostics::Problem;
use super::document::{Node, Table, Value};
use super::interpret::Setting;
use super::overrides::Override;
use super::source::SourceText;
use super::suggest::suggestion;

/// Applies the overrides of the coarse setting and of the variant to the tree.
///
/// What is misshapen here is left out: checking the tree reports it.
pub(super) fn apply(
    tree: &mut Table,
    sources: &[SourceText],
    setting: Setting<'_>,
    problems: &mut Vec<Problem>,
) {
    let mut lists = Vec::new();
    if setting.coarse
        && let Some(Value::Table(coarse)) = tree.get("coarse").map(|node| &node.value)
    {
        lists.push(coarse.get("set").cloned());
    }
    if let Some(name) = setting.variant {
        match variant(tree, name) {
            Ok(variant) => {
                lists.push(variant.get("set").cloned());
                lists.extend(setting.coarse.then(|| variant.get("coarse").cloned()));
            }
            Err(problem) => problems.push(problem),
        }
    }
    for list in lists.into_iter().flatten() {
        let Value::List(list) = list.value else { continue };
        for item in list {
            if let Value::Text(text) = &item.value {
                Override::of_string(text, item.place, sources).apply(tree, problems);
            }
        }
    }
}

fn variant<'t>(tree: &'t Table, name: &str) -> Result<&'t Table, Problem> {
    let list: &[Node] = match tree.get("variant").map(|node| &node.value) {
        Some(Value::List(list)) => list,
        _ => &[],
    };
    let named = list.iter().filter_map(|node| match &node.value {
        Value::Table(table) => match table.get("name").map(|name| &name.value) {
            Some(Value::Text(name)) => Some((name.as_str(), table)),
            _ => None,
        },
        _ => None,
    });
    let found = named.clone().find(|(known, _)| *known == name);
    found.map(|(_, table)| table).ok_or_else(|| {
        let problem = Problem::whole(format!("the case has no variant `{name}`"));
        match list.is_empty() {
            true => problem.help("it has no variants at all"),
            false => problem.help(suggestion(name, named.map(|(known, _)| known))),
        }
    })
}

/// What is added to a problem that is found in a setting that was not asked for.
pub(super) fn remark(setting: Setting<'_>) -> String {
    match (setting.variant, setting.coarse) {
        (None, false) => " (in the base case)".to_owned(),
        (None, true) => " (in the coarse setting)".to_owned(),
        (Some(name), false) => format!(" (in the variant `{name}`)"),
        (Some(name), true) => format!(" (in the coarse setting of the variant `{name}`)"),
    }
}
