//! Checks a tree of values against the descriptions of the tables.

use super::diagnostics::Problem;
use super::document::{Node, Table, Value};
use super::functions::{Arrays, Functions};
use super::outline::table_of;
use super::record::{Datum, Record};
use super::source::{Located, Place, SourceText};
use super::spec::{KeySpec, Kind, KindSpec, Presence, TableSpec, TaggedSpec};
use super::suggest::{nearest, one_of, suggestion};

mod values;

pub(super) use values::{AXES, evaluate_parameters};

/// Problems after which checking stops looking for suggestions, which take time.
const PATIENCE: usize = 1000;

/// Entries that a list may have. Larger sets of shapes or points stand in files of their own.
const MAX_ENTRIES: usize = 10_000;

/// What checking needs to know, and the problems that it finds.
pub(super) struct Context<'a> {
    /// The texts that places refer to.
    pub sources: &'a [SourceText],
    /// 1, 2 or 3, or `None` where the file does not say it rightly.
    pub dimension: Option<usize>,
    /// Named numbers, without a value where it was refused.
    pub parameters: Vec<(String, Option<f64>)>,
    /// Functions that may stand for expressions; any in a record.
    pub functions: Option<&'a Functions>,
    /// Arrays with a value for each particle of a body, where its initial state has expressions.
    pub arrays: Option<&'a Arrays>,
    /// What was found so far.
    pub problems: Vec<Problem>,
    /// What is left out without being wrong, in sentences.
    pub remarks: Vec<String>,
}

impl Context<'_> {
    pub(super) fn report(&mut self, problem: Problem) {
        self.problems.push(problem);
    }

    /// Checks a table with a fixed set of keys.
    pub(super) fn table(
        &mut self,
        spec: &'static TableSpec,
        table: &Table,
        place: Place,
    ) -> Record {
        let slips = self.unknown_keys(spec.title, &[spec.keys], None, table);
        self.record(spec.title, "", &[spec.keys], &slips, table, place)
    }

    /// Checks a table with a `kind`.
    fn tagged(&mut self, spec: &'static TaggedSpec, table: &Table, place: Place) -> Option<Record> {
        let kind = self.kind(spec, table, place)?;
        let keys = [spec.common, kind.keys];
        let slips = self.unknown_keys(spec.title, &keys, Some((spec, kind)), table);
        Some(self.record(spec.title, kind.name, &keys, &slips, table, place))
    }

    fn kind(
        &mut self,
        spec: &'static TaggedSpec,
        table: &Table,
        place: Place,
    ) -> Option<&'static KindSpec> {
        let names = spec.kinds.iter().map(|kind| kind.name);
        let Some(node) = table.get("kind") else {
            let message = format!("{} needs the key `kind`", quoted(spec.title));
            self.report(
                Problem::new(place, message, "`kind` is missing")
                    .help(format!("expected {}", one_of(names))),
            );
            return None;
        };
        let Value::Text(name) = &node.value else {
            let got = node.value.describe();
            let message = format!("`kind` must be {}, got {got}", one_of(names));
            self.report(Problem::new(node.place, message, "expected text in quotes"));
            return None;
        };
        let Some(kind) = spec.kinds.iter().find(|kind| kind.name == name) else {
            let message = format!("{} has no kind `{name}`", quoted(spec.title));
            self.report(
                Problem::new(node.place, message, "unknown kind").help(suggestion(name, names)),
            );
            return None;
        };
        if let Some(dimension) = self.dimension.filter(|d| !kind.dimensions.contains(d)) {
            let known: Vec<String> = kind.dimensions.iter().map(|d| format!("{d}D")).collect();
            let message = format!(
                "{} of kind `{name}` exists only in {}, and the case is {dimension}D",
                quoted(spec.title),
                known.join(" and ")
            );
            let label = format!("not in {dimension}D");
            self.report(Problem::new(node.place, message, label));
            return None;
        }
        Some(kind)
    }

    /// Reports the keys that the table should not have, and returns what they seem to mean.
    fn unknown_keys(
        &mut self,
        title: &str,
        groups: &[&'static [KeySpec]],
        tagged: Option<(&TaggedSpec, &KindSpec)>,
        table: &Table,
    ) -> Vec<&'static str> {
        let mut slips = Vec::new();
        let known = || groups.iter().flat_map(|keys| keys.iter()).map(|key| key.name);
        for entry in &table.entries {
            let is_kind = tagged.is_some() && entry.key == "kind";
            if is_kind || known().any(|name| name == entry.key) {
                continue;
            }
            let of_kind =
                tagged.map_or(String::new(), |(_, kind)| format!(" of kind `{}`", kind.name));
            let message = format!("{}{of_kind} has no key `{}`", quoted(title), entry.key);
            let mut problem = Problem::new(entry.key_place, message, "unknown key");
            if self.problems.len() < PATIENCE {
                let elsewhere = tagged.and_then(|(spec, _)| owner(spec, &entry.key));
                let near = nearest(&entry.key, known());
                slips.extend(near);
                problem = problem.help(match (near, elsewhere) {
                    (Some(near), _) => format!("did you mean `{near}`?"),
                    (None, Some(kind)) => format!("it is a key of `{kind}`"),
                    (None, None) => format!("there are {}", one_of(known())),
                });
            }
            self.report(problem);
        }
        slips
    }

    /// Checks the keys one by one. `slips` are keys that seem to be there, misspelt.
    fn record(
        &mut self,
        title: &str,
        kind: &'static str,
        groups: &[&'static [KeySpec]],
        slips: &[&str],
        table: &Table,
        place: Place,
    ) -> Record {
        let mut record = Record { kind, place, values: Vec::new(), written: Vec::new() };
        for key in groups.iter().flat_map(|keys| keys.iter()) {
            let entry = table.entries.iter().find(|entry| entry.key == key.name);
            let value = match (entry, key.presence) {
                (Some(entry), _) => {
                    record.written.push((key.name, entry.key_place));
                    self.not_empty(key, &entry.node);
                    self.value(key.name, &key.kind, &entry.node)
                }
                (None, Presence::Required) => {
                    if !slips.contains(&key.name) {
                        self.missing(title, key, place);
                    }
                    None
                }
                (None, Presence::Default(text)) => self.default(key, text, place),
                (None, Presence::Optional | Presence::Derived(_)) => None,
            };
            record.values.extend(value.map(|value| (key.name, value)));
        }
        record
    }

    /// A list that has to be there has to have entries.
    fn not_empty(&mut self, key: &KeySpec, node: &Node) {
        let is_empty = matches!(&node.value, Value::List(list) if list.is_empty());
        if is_empty && matches!((key.kind, key.presence), (Kind::List(_), Presence::Required)) {
            let message = format!("`{}` must have at least one entry", key.name);
            self.report(Problem::new(node.place, message, "empty"));
        }
    }

    fn missing(&mut self, title: &str, key: &KeySpec, place: Place) {
        let title = quoted(title);
        let what = match table_of(&key.kind).map(|section| section.title()) {
            Some(table) if table.starts_with('[') => format!("the table {table}"),
            _ => format!("the key `{}`", key.name),
        };
        let message = format!("{title} needs {what}: {}", key.meaning);
        let label = format!("`{}` is missing", key.name);
        let mut problem = Problem::new(place, message, label);
        // The file as a whole has no text to underline.
        if place.span() == (0..0) {
            problem.place = None;
        }
        self.report(problem);
    }

    fn default(&mut self, key: &KeySpec, text: &str, place: Place) -> Option<Located<Datum>> {
        let node = super::document::parse_value(text, &|_| place, &mut self.problems)?;
        self.value(key.name, &key.kind, &node)
    }

    fn value(&mut self, name: &str, kind: &Kind, node: &Node) -> Option<Located<Datum>> {
        let datum = match (kind, &node.value) {
            (_, Value::Broken) => return None,
            (Kind::Table(spec), Value::Table(table)) => {
                Datum::Record(self.table(spec, table, node.place))
            }
            (Kind::Tagged(spec), Value::Table(table)) => {
                Datum::Record(self.tagged(spec, table, node.place)?)
            }
            (Kind::List(inner), Value::List(list)) => {
                self.not_too_many(name, list)?;
                let refused = |item: &Node| Located::new(Datum::Refused, item.place);
                let read = |item| self.value(name, inner, item).unwrap_or_else(|| refused(item));
                Datum::List(list.iter().map(read).collect())
            }
            (Kind::Parameters, Value::Table(_)) => return None,
            _ => self.simple(name, kind, node)?,
        };
        Some(Located::new(datum, node.place))
    }

    fn not_too_many(&mut self, name: &str, list: &[Node]) -> Option<()> {
        let Some(first) = list.get(MAX_ENTRIES) else { return Some(()) };
        let count = list.len();
        let message = format!("`{name}` has {count} entries, at most {MAX_ENTRIES} are allowed");
        self.report(Problem::new(first.place, message, "one too many"));
        None
    }

    fn wrong_type(&mut self, name: &str, kind: &Kind, node: &Node) {
        let expected = self.expected(kind);
        let message = format!("`{name}` must be {expected}, got {}", node.value.describe());
        let problem = Problem::new(node.place, message, format!("expected {expected}"));
        self.report(match (kind, &node.value) {
            (Kind::List(Kind::Table(_) | Kind::Tagged(_)), Value::Table(_)) => {
                problem.help(format!("write `[[{name}]]` with two brackets, once for each"))
            }
            (Kind::Table(_) | Kind::Tagged(_), Value::List(_)) => {
                problem.help(format!("there is only one: write `[{name}]` with one bracket"))
            }
            (Kind::List(_), Value::Text(text)) => {
                problem.help(format!("write brackets around it: [\"{text}\"]"))
            }
            _ => problem,
        });
    }
}

/// The title of a table in a sentence: `shape` in quotes, `[time]` as it is.
fn quoted(title: &str) -> String {
    if title.contains([' ', '[']) { title.to_owned() } else { format!("`{title}`") }
}

/// The kind of a tagged table that has the key.
fn owner(spec: &TaggedSpec, key: &str) -> Option<&'static str> {
    let has = |kind: &&KindSpec| kind.keys.iter().any(|known| known.name == key);
    spec.kinds.iter().find(has).map(|kind| kind.name)
}
