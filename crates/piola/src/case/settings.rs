//! The settings of a case file: coarse, variants and members of sweeps, which are overrides of the
//! base case.

use super::diagnostics::Problem;
use super::document::{Node, Table, Value};
use super::interpret::Setting;
use super::model::{Level, member_name, member_of};
use super::overrides::Override;
use super::source::{Located, SourceText};
use super::suggest::suggestion;

/// Applies the overrides of the coarse or the paper's setting, of the variant, and of the sweep and its member to
/// the tree, in this order.
///
/// What is misshapen here is left out: checking the tree reports it.
pub(super) fn apply(
    tree: &mut Table,
    sources: &[SourceText],
    setting: Setting<'_>,
    problems: &mut Vec<Problem>,
) {
    let mut lists = Vec::new();
    let mut values = Vec::new();
    let table = match setting.level {
        Level::Case => None,
        level => tree.get(level.name()),
    };
    if let Some(Value::Table(table)) = table.map(|node| &node.value) {
        lists.push(table.get("set").cloned());
    }
    let mut variant = setting.variant;
    let sweep;
    if let Some((name, index)) = variant.and_then(member_of) {
        match member(tree, name, index, setting.level) {
            Ok(found) => {
                sweep = found.sweep;
                values = found.values;
                variant = text(&sweep, "variant").filter(|name| *name != "base");
                extend(&mut lists, tree, variant, setting.level, problems);
                lists.push(sweep.get("set").cloned());
            }
            Err(problem) => problems.push(problem),
        }
    } else {
        extend(&mut lists, tree, variant, setting.level, problems);
    }
    for list in lists.into_iter().flatten() {
        let Value::List(list) = list.value else { continue };
        for item in list {
            if let Value::Text(text) = &item.value {
                Override::of_string(text, item.place, sources).apply(tree, problems);
            }
        }
    }
    for (path, value) in &values {
        Override::of_key(path, value, sources).apply(tree, problems);
    }
}

/// Adds the overrides of a variant.
fn extend(
    lists: &mut Vec<Option<Node>>,
    tree: &Table,
    variant: Option<&str>,
    level: Level,
    problems: &mut Vec<Problem>,
) {
    let Some(name) = variant else { return };
    match find(tree, name) {
        Ok(variant) => {
            lists.push(variant.get("set").cloned());
            lists.extend((level == Level::Coarse).then(|| variant.get("coarse").cloned()));
        }
        Err(problem) => problems.push(problem),
    }
}

/// A member of a sweep: the table of the sweep, and the value of each key.
struct Member {
    sweep: Table,
    values: Vec<(Located<String>, Node)>,
}

fn member(tree: &Table, name: &str, index: usize, level: Level) -> Result<Member, Problem> {
    let found = named(tree, "sweep").find(|(known, _)| *known == name);
    let Some((_, sweep)) = found else {
        let problem = Problem::whole(format!("the case has no sweep `{name}`"));
        let names: Vec<&str> = named(tree, "sweep").map(|(name, _)| name).collect();
        return Err(match names.is_empty() {
            true => problem.help("it has no sweeps at all"),
            false => problem.help(suggestion(name, names)),
        });
    };
    let keys = keys_of(sweep, level);
    let count = keys.iter().fold(1, |count: usize, (_, list)| count.saturating_mul(list.len()));
    if index >= count {
        let message = format!("the sweep `{name}` has no member number {}", index + 1);
        let first = member_name(name, 0);
        let last = member_name(name, count.saturating_sub(1));
        return Err(Problem::whole(message).help(format!("its members are `{first}` to `{last}`")));
    }
    let mut rest = index;
    let mut values = Vec::new();
    for (path, list) in keys.into_iter().rev() {
        values.push((path, list[rest % list.len()].clone()));
        rest /= list.len();
    }
    values.reverse();
    Ok(Member { sweep: sweep.clone(), values })
}

/// The keys of a sweep with their values at a setting. What is no list is left out.
fn keys_of(sweep: &Table, level: Level) -> Vec<(Located<String>, Vec<Node>)> {
    let table = |key: &str| match sweep.get(key).map(|node| &node.value) {
        Some(Value::Table(table)) => keys_with_values(table),
        _ => Vec::new(),
    };
    let instead = if level == Level::Coarse { table("coarse") } else { Vec::new() };
    let each = table("over").into_iter().filter_map(|(path, node)| {
        let other = instead.iter().find(|(other, _)| other.value == path.value);
        match &other.map_or(node, |(_, other)| other).value {
            Value::List(list) if !list.is_empty() => Some((path, list.clone())),
            _ => None,
        }
    });
    each.collect()
}

/// The values of a table whose keys are paths, or nested tables that make paths.
pub(super) fn keys_with_values(table: &Table) -> Vec<(Located<String>, &Node)> {
    let mut found = Vec::new();
    for entry in &table.entries {
        let path = Located::new(entry.key.clone(), entry.key_place);
        match &entry.node.value {
            Value::Table(inner) => {
                for (mut below, node) in keys_with_values(inner) {
                    below.value = format!("{}.{}", path.value, below.value);
                    found.push((below, node));
                }
            }
            _ => found.push((path, &entry.node)),
        }
    }
    found
}

/// The tables of a list that have a name.
fn named<'t>(tree: &'t Table, key: &str) -> impl Iterator<Item = (&'t str, &'t Table)> {
    let list: &[Node] = match tree.get(key).map(|node| &node.value) {
        Some(Value::List(list)) => list,
        _ => &[],
    };
    list.iter().filter_map(|node| match &node.value {
        Value::Table(table) => text(table, "name").map(|name| (name, table)),
        _ => None,
    })
}

fn text<'t>(table: &'t Table, key: &str) -> Option<&'t str> {
    match table.get(key).map(|node| &node.value) {
        Some(Value::Text(text)) => Some(text),
        _ => None,
    }
}

fn find<'t>(tree: &'t Table, name: &str) -> Result<&'t Table, Problem> {
    let found = named(tree, "variant").find(|(known, _)| *known == name);
    found.map(|(_, table)| table).ok_or_else(|| {
        let problem = Problem::whole(format!("the case has no variant `{name}`"));
        let names: Vec<&str> = named(tree, "variant").map(|(name, _)| name).collect();
        if let Some((_, sweep)) = named(tree, "sweep").find(|(known, _)| *known == name) {
            let keys = keys_of(sweep, Level::Case);
            let count = keys.iter().fold(1, |count: usize, key| count.saturating_mul(key.1.len()));
            let (first, last) = (member_name(name, 0), member_name(name, count.saturating_sub(1)));
            return problem.help(format!("it is a sweep, with members `{first}` to `{last}`"));
        }
        match names.is_empty() {
            true => problem.help("it has no variants at all"),
            false => problem.help(suggestion(name, names)),
        }
    })
}

/// What is added to a problem that is found in a setting that was not asked for.
pub(super) fn remark(setting: Setting<'_>) -> String {
    let variant = setting.variant;
    let of = match setting.level {
        Level::Case => String::new(),
        level => format!("{} of ", level.words()),
    };
    if let Some((sweep, index)) = variant.and_then(member_of) {
        return format!(" (in {of}member {} of the sweep `{sweep}`)", index + 1);
    }
    match (variant, setting.level) {
        (None, Level::Case) => " (in the base case)".to_owned(),
        (None, level) => format!(" (in {})", level.words()),
        (Some(name), _) => format!(" (in {of}the variant `{name}`)"),
    }
}
