//! A case file as a tree of values, each with its place.

use std::fs::File;
use std::io::Read;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};

use super::diagnostics::{Problem, Problems};
use super::source::{Place, SourceText, floor_boundary};

/// The largest case file in bytes. Larger ones are refused before they are read.
pub const MAX_BYTES: u64 = 16 << 20;

/// Syntax errors that are shown at most: one slip often makes several.
const MAX_SYNTAX_ERRORS: usize = 10;

/// A value and its place.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub value: Value,
    pub place: Place,
}

/// The kinds of value that TOML knows. Numbers are finite.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    /// A date or time, which no key takes.
    Date(String),
    List(Vec<Node>),
    Table(Table),
    /// A number that was already reported.
    Broken,
}

impl Value {
    /// What it is, with an article, for messages.
    pub(super) fn describe(&self) -> String {
        let named = |what: &str, text: String| {
            if text.chars().count() > 40 { what.to_owned() } else { format!("{what} {text}") }
        };
        match self {
            Self::Text(text) => named("the text", format!("\"{text}\"")),
            Self::Integer(number) => format!("the number {number}"),
            Self::Float(number) => format!("the number {number}"),
            Self::Boolean(value) => value.to_string(),
            Self::Date(_) => "a date".to_owned(),
            Self::List(_) => "a list".to_owned(),
            Self::Table(_) => "a table".to_owned(),
            Self::Broken => "an impossible number".to_owned(),
        }
    }
}

/// Keys and values in the order of the file.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    pub entries: Vec<Entry>,
}

/// One key of a table.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub key: String,
    pub key_place: Place,
    pub node: Node,
}

impl Table {
    pub(super) fn get(&self, key: &str) -> Option<&Node> {
        self.entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }
}

/// Reads the text of the file at `path`.
///
/// # Errors
/// If it cannot be read ([`Problems::is_io`]), is larger than [`MAX_BYTES`] or is not UTF-8.
pub(super) fn read(path: &Path) -> Result<SourceText, Problems> {
    let name = path.display().to_string();
    let unreadable = |error: std::io::Error| {
        let message = format!("the case file cannot be read: {error}");
        Problems::io(name.clone(), Problem::whole(message))
    };
    if path.is_dir() {
        let problem = Problem::whole("the case file cannot be read: this is a folder")
            .help("give the path of the file, for example with `/case.toml` at its end");
        return Err(Problems::io(name, problem));
    }
    let mut bytes = Vec::new();
    // The length that a file reports can be wrong, so reading itself stops at the limit.
    let file = File::open(path).map_err(unreadable)?;
    let length = file.metadata().map_err(unreadable)?.len();
    if length <= MAX_BYTES {
        file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    }
    if length > MAX_BYTES || bytes.len() as u64 > MAX_BYTES {
        let limit = MAX_BYTES >> 20;
        let message =
            format!("the file is too large for a case file, which has at most {limit} MiB");
        let source = SourceText { name, text: String::new() };
        return Err(Problems::new(
            Arc::from([source]),
            vec![
                Problem::whole(message)
                    .help("is this the right file? Point clouds are read from CSV files"),
            ],
        ));
    }
    decode(name, bytes)
}

/// Makes text of bytes.
pub(super) fn decode(name: String, bytes: Vec<u8>) -> Result<SourceText, Problems> {
    String::from_utf8(bytes).map(|text| SourceText { name: name.clone(), text }).map_err(|error| {
        let start = error.utf8_error().valid_up_to();
        let byte = error.as_bytes().get(start).copied().unwrap_or_default();
        let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
        let place = Place::new(0, start..start + '\u{fffd}'.len_utf8());
        let message = format!("the file is not text in UTF-8: it has the byte 0x{byte:02x} here");
        let problem = Problem::new(place, message, "not UTF-8")
            .help("save it as UTF-8, or check that it is the right file");
        Problems::new(Arc::from([SourceText { name, text }]), vec![problem])
    })
}

/// Reads the TOML of text number 0. On syntax errors the tree is not to be used.
pub(super) fn parse(text: &str) -> Result<Table, Vec<Problem>> {
    let (root, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        return Err(syntax_problems(text, &errors));
    }
    let place = |span: Range<usize>| Place::new(0, span);
    let mut problems = Vec::new();
    let root = table(root.into_inner(), &place, &mut problems);
    if problems.is_empty() { Ok(root) } else { Err(problems) }
}

/// Reads one TOML value, with places as `place` makes them of spans in `text`. `None` where it is
/// not TOML.
pub(super) fn parse_value(
    text: &str,
    place: &dyn Fn(Range<usize>) -> Place,
    problems: &mut Vec<Problem>,
) -> Option<Node> {
    Some(node(DeValue::parse(text).ok()?, place, problems))
}

fn node(
    value: Spanned<DeValue<'_>>,
    place: &dyn Fn(Range<usize>) -> Place,
    problems: &mut Vec<Problem>,
) -> Node {
    let here = place(value.span());
    let value = match value.into_inner() {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Boolean(value) => Value::Boolean(value),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Integer(integer) => match whole_number(&integer) {
            Some(number) => Value::Integer(number),
            None => {
                problems.push(Problem::new(here, "the whole number is too large", "too large"));
                Value::Broken
            }
        },
        DeValue::Float(float) => match float.as_str().parse::<f64>() {
            Ok(number) if number.is_finite() => Value::Float(number),
            other => {
                let got = other.map_or(float.as_str().to_owned(), |number| number.to_string());
                let message = format!("expected a finite number, got {got}");
                problems.push(Problem::new(here, message, "not finite"));
                Value::Broken
            }
        },
        DeValue::Array(list) => {
            Value::List(list.into_iter().map(|item| node(item, place, problems)).collect())
        }
        DeValue::Table(entries) => Value::Table(table(entries, place, problems)),
    };
    Node { value, place: here }
}

fn table(
    entries: DeTable<'_>,
    place: &dyn Fn(Range<usize>) -> Place,
    problems: &mut Vec<Problem>,
) -> Table {
    let mut entries: Vec<Entry> = entries
        .into_iter()
        .map(|(key, value)| Entry {
            key_place: place(key.span()),
            key: key.into_inner().into_owned(),
            node: node(value, place, problems),
        })
        .collect();
    entries.sort_by_key(|entry| entry.key_place);
    Table { entries }
}

fn whole_number(integer: &DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}

/// What to do about a unit behind a number.
const WITHOUT_UNIT: &str = "write the number without a unit, `1.5`: all numbers are in SI units";

/// One problem a line, with the commonest slips in plain words.
fn syntax_problems(text: &str, errors: &[toml::de::Error]) -> Vec<Problem> {
    let mut spans: Vec<_> = errors
        .iter()
        .map(|error| (error.span().unwrap_or(0..0), error.message()))
        .map(|(span, message)| {
            let start = floor_boundary(text, span.start);
            (start..floor_boundary(text, span.end).max(start), message)
        })
        .collect();
    spans.sort_by_key(|(span, _)| span.start);
    spans.dedup_by_key(|(span, _)| text[..span.start].rfind('\n'));
    spans.truncate(MAX_SYNTAX_ERRORS);
    spans.into_iter().map(|(span, message)| syntax_problem(text, span, message)).collect()
}

fn syntax_problem(text: &str, span: Range<usize>, message: &str) -> Problem {
    let place = Place::new(0, span.clone());
    let word = &text[span.clone()];
    if message == "duplicate key" {
        let message = format!("`{word}` appears twice");
        return Problem::new(place, message, "the second time").help("remove one of the two");
    }
    if message.starts_with("cannot recurse") || message == "recursion limit" {
        return Problem::new(place, "the values are nested too deeply", "too deep");
    }
    if message.starts_with("string values must be quoted") {
        let is_number = |first: &str| first.parse::<f64>().is_ok();
        return match word.split_whitespace().next() {
            None => Problem::new(place, "a value is missing here", "expected a value"),
            Some(first) if first != word && is_number(first) => {
                Problem::new(place, format!("there is a unit after a number: {word}"), "a unit")
                    .help(WITHOUT_UNIT)
            }
            Some(_) => Problem::new(place, format!("text needs quotes: \"{word}\""), "no quotes"),
        };
    }
    let problem = Problem::new(place, format!("this is not TOML: {message}"), "");
    if text[span.start..].starts_with(',') && message.starts_with("unexpected key or value") {
        return problem
            .help("write a point in numbers, `1.5`, and brackets around a list, `[1, 5]`");
    }
    let unit = text[..span.end].ends_with(|last: char| last.is_alphabetic())
        || text[span.end..].starts_with(|next: char| next.is_alphabetic());
    if unit && (message.starts_with("invalid float") || message.starts_with("invalid integer")) {
        return problem.help(WITHOUT_UNIT);
    }
    problem
}

/// The tree as TOML, without comments. Keys keep their order: a parameter may only use those above it.
pub(super) fn write(root: &Table) -> String {
    toml::to_string(&to_toml(root)).unwrap_or_default()
}

/// One value as TOML on one line.
pub(super) fn write_value(value: &Value) -> String {
    to_value(value).to_string()
}

fn to_toml(table: &Table) -> toml::Table {
    let entries = table.entries.iter();
    entries.map(|entry| (entry.key.clone(), to_value(&entry.node.value))).collect()
}

fn to_value(value: &Value) -> toml::Value {
    match value {
        Value::Text(text) | Value::Date(text) => toml::Value::String(text.clone()),
        Value::Integer(number) => toml::Value::Integer(*number),
        Value::Float(number) => toml::Value::Float(*number),
        Value::Boolean(value) => toml::Value::Boolean(*value),
        Value::List(list) => {
            toml::Value::Array(list.iter().map(|node| to_value(&node.value)).collect())
        }
        Value::Table(table) => toml::Value::Table(to_toml(table)),
        // Refused before anything is written.
        Value::Broken => toml::Value::Float(f64::NAN),
    }
}
