//! Overrides: `path.to.key=value`, from the command line, a variant or the coarse setting, and
//! `path.to.list+=value`, which appends to a list.

use std::ops::Range;

use super::diagnostics::Problem;
use super::document::{Entry, Node, Table, Value, parse_value};
use super::source::{Located, Place, SourceText};
use super::suggest::{nearest, one_of};

/// How deep a path may go. The deepest key of the case file is far above.
const MAX_SEGMENTS: usize = 32;

/// Keys of a table that exclude each other: an override that sets one removes the other, so that one
/// value from outside serves all variants, whichever of the keys they have.
const ALTERNATIVES: (&str, [&str; 2]) = ("time", ["cfl", "step"]);

/// The text of an override and where it stands.
pub(super) struct Override<'a> {
    text: &'a str,
    /// The place of the whole text.
    place: Place,
    /// The place of its first byte, if its bytes stand in the source one by one.
    start: Option<usize>,
    /// The value, where the text is the path alone.
    value: Option<&'a Node>,
}

impl<'a> Override<'a> {
    /// An override of the command line, which is text number `source`, after `prefix` bytes.
    pub(super) fn of_command_line(text: &'a str, source: u32, prefix: usize) -> Self {
        let place = Place::new(source, prefix..prefix + text.len());
        Self { text, place, start: Some(prefix), value: None }
    }

    /// An override that stands as a string in one of the texts.
    pub(super) fn of_string(text: &'a str, place: Place, sources: &[SourceText]) -> Self {
        Self { text, place, start: start_of_content(sources, place, text), value: None }
    }

    /// The value of a sweep for the key that `path` leads to.
    pub(super) fn of_key(
        path: &'a Located<String>,
        value: &'a Node,
        sources: &[SourceText],
    ) -> Self {
        let start = start_of_content(sources, path.place, path);
        Self { text: path, place: path.place, start, value: Some(value) }
    }

    fn place(&self, span: Range<usize>) -> Place {
        match self.start {
            Some(start) => Place::new(self.place.source, start + span.start..start + span.end),
            None => self.place,
        }
    }

    fn problem(
        &self,
        span: Range<usize>,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Problem {
        Problem::new(self.place(span), message, label)
    }

    /// Sets the key in `root`, or appends to the list there. An empty value removes it.
    ///
    /// Unknown keys are set too: who checks the tree afterwards finds them with their place here.
    pub(super) fn apply(&self, root: &mut Table, problems: &mut Vec<Problem>) {
        let applied = self.split().and_then(|(mut path, value)| {
            let appends = self.value.is_none() && path.last_mut().is_some_and(Segment::strip_plus);
            let Some((last, parents)) = path.split_last() else {
                return Err(self.problem(0..value, "the path of the key is empty", "no path"));
            };
            let new = match self.value {
                Some(node) => Some(node.clone()),
                None => self.value(value, problems)?,
            };
            if appends {
                return self.append(root, &path, new);
            }
            if let Some(other) = alternative(parents, last).filter(|_| new.is_some()) {
                remove(root, ALTERNATIVES.0, other);
            }
            self.set(root, parents, last, new)
        });
        if let Err(problem) = applied {
            problems.push(problem);
        }
    }

    /// The segments of the path, and where the value starts.
    fn split(&self) -> Result<(Vec<Segment>, usize), Problem> {
        let all = 0..self.text.len();
        let mut path = Vec::new();
        let mut offset = 0;
        loop {
            let (segment, end) = self.segment(offset)?;
            path.push(segment);
            if path.len() > MAX_SEGMENTS {
                return Err(self.problem(all, "the path has too many parts", "too deep"));
            }
            match self.text[end..].chars().next() {
                Some('.') => offset = end + 1,
                Some('=') if self.value.is_none() => return Ok((path, end + 1)),
                None if self.value.is_some() => return Ok((path, end)),
                _ if self.value.is_some() => {
                    return Err(self.problem(all, "this is not the path of a key", "not a path"));
                }
                _ => {
                    return Err(self
                        .problem(all, "an override has the form path.to.key=value", "no `=`")
                        .help("for example `time.end=0.5` or `body.0.spacing=0.1`"));
                }
            }
        }
    }

    /// One part of the path, plain or in quotes, and where it ends.
    fn segment(&self, start: usize) -> Result<(Segment, usize), Problem> {
        let rest = &self.text[start..];
        let leading = rest.len() - rest.trim_start().len();
        let quote = rest.trim_start().chars().next().filter(|c| matches!(c, '"' | '\''));
        if let Some(quote) = quote {
            let first = start + leading + 1;
            let Some(length) = self.text[first..].find(quote) else {
                let span = start + leading..self.text.len();
                return Err(self.problem(span, "the quote is never closed", "not closed"));
            };
            let span = first..first + length;
            let after = &self.text[span.end + 1..];
            let end = self.text.len() - after.trim_start().len();
            return Ok((Segment { name: self.text[span.clone()].to_owned(), span }, end));
        }
        let length = rest.find(['.', '=']).unwrap_or(rest.len());
        let name = rest[..length].trim();
        let span = start + leading..start + leading + name.len();
        if name.is_empty() {
            let span = start..(start + 1).min(self.text.len());
            return Err(self
                .problem(span, "a part of the path is empty", "a name is missing")
                .help("an override has the form path.to.key=value"));
        }
        Ok((Segment { name: name.to_owned(), span }, start + length))
    }

    /// The value, `None` to remove the key. What is not TOML is text, but for what begins as a table
    /// or a list.
    fn value(&self, start: usize, problems: &mut Vec<Problem>) -> Result<Option<Node>, Problem> {
        let text = self.text[start..].trim();
        if text.is_empty() {
            return Ok(None);
        }
        let start = start + self.text[start..].find(text).unwrap_or(0);
        let place = |span: Range<usize>| self.place(start + span.start..start + span.end);
        if let Some(parsed) = parse_value(text, &place, problems) {
            return Ok(Some(parsed));
        }
        let what = match text.chars().next() {
            Some('{') => "table",
            Some('[') => "list",
            _ => {
                let value = Value::Text(text.to_owned());
                return Ok(Some(Node { value, place: place(0..text.len()) }));
            }
        };
        let message = format!("the {what} cannot be read");
        Err(self.problem(start..start + text.len(), message, format!("not a TOML {what}")).help(
            "strings in it need quotes, and the shell removes the outer ones: write \
             --set 'path.to.key={ key = \"text\", list = [1, 2] }'",
        ))
    }

    /// Appends to the list that `path` leads to, which is made if it is not there.
    fn append(&self, root: &mut Table, path: &[Segment], new: Option<Node>) -> Result<(), Problem> {
        let [first, rest @ ..] = path else { return Ok(()) };
        let (start, end) = (first.span.start, path[path.len() - 1].span.end);
        let Some(new) = new else {
            return Err(self
                .problem(start..end, "there is nothing to append", "no value after `+=`")
                .help("an entry of a list is appended with path.to.list+=value"));
        };
        let make_list = |table: &mut Table, segment: &Segment| match table.get(&segment.name) {
            Some(_) => Ok(()),
            None => {
                let list = Node { value: Value::List(Vec::new()), place: new.place };
                self.set_key(table, segment, Some(list))
            }
        };
        if rest.is_empty() {
            make_list(root, first)?;
        }
        let mut node = self.entry(root, first);
        for (number, segment) in (1..).zip(rest) {
            if let (true, Value::Table(table)) = (number == rest.len(), &mut node.value) {
                make_list(table, segment)?;
            }
            node = self.child(node, segment)?;
        }
        match &mut node.value {
            Value::List(list) => list.push(new),
            other => {
                let message = format!("`+=` appends to a list, and this is {}", other.describe());
                return Err(self.problem(start..end, message, "not a list"));
            }
        }
        Ok(())
    }

    fn set(
        &self,
        root: &mut Table,
        parents: &[Segment],
        last: &Segment,
        new: Option<Node>,
    ) -> Result<(), Problem> {
        let Some((first, parents)) = parents.split_first() else {
            return self.set_key(root, last, new);
        };
        let mut node = self.entry(root, first);
        for segment in parents {
            node = self.child(node, segment)?;
        }
        match &mut node.value {
            Value::Table(table) => self.set_key(table, last, new),
            Value::List(list) => {
                let index = self.index(list, last)?;
                match new {
                    Some(new) => list[index] = new,
                    None => drop(list.remove(index)),
                }
                Ok(())
            }
            other => Err(self.no_children(other, last)),
        }
    }

    fn set_key(
        &self,
        table: &mut Table,
        segment: &Segment,
        new: Option<Node>,
    ) -> Result<(), Problem> {
        let known = table.entries.iter().position(|entry| entry.key == segment.name);
        match (known, new) {
            (Some(index), Some(node)) => {
                let entry = &mut table.entries[index];
                entry.node = node;
                entry.key_place = self.place(segment.span.clone());
            }
            (None, Some(node)) => table.entries.push(Entry {
                key: segment.name.clone(),
                key_place: self.place(segment.span.clone()),
                node,
            }),
            (Some(index), None) => drop(table.entries.remove(index)),
            (None, None) => {
                let message = format!("there is no `{}` to remove", segment.name);
                let keys = table.entries.iter().map(|entry| entry.key.as_str());
                let problem = self.problem(segment.span.clone(), message, "not there");
                return Err(match nearest(&segment.name, keys) {
                    Some(near) => problem.help(format!("did you mean `{near}`?")),
                    None => {
                        problem.help("a value follows after `=`; without one the key is removed")
                    }
                });
            }
        }
        Ok(())
    }

    /// The value of a key, a new table if there is none.
    fn entry<'t>(&self, table: &'t mut Table, segment: &Segment) -> &'t mut Node {
        let known = table.entries.iter().position(|entry| entry.key == segment.name);
        let index = known.unwrap_or_else(|| {
            let place = self.place(segment.span.clone());
            let node = Node { value: Value::Table(Table::default()), place };
            table.entries.push(Entry { key: segment.name.clone(), key_place: place, node });
            table.entries.len() - 1
        });
        &mut table.entries[index].node
    }

    fn child<'t>(&self, node: &'t mut Node, segment: &Segment) -> Result<&'t mut Node, Problem> {
        match &mut node.value {
            Value::Table(table) => Ok(self.entry(table, segment)),
            Value::List(list) => {
                let index = self.index(list, segment)?;
                Ok(&mut list[index])
            }
            other => Err(self.no_children(other, segment)),
        }
    }

    fn no_children(&self, value: &Value, segment: &Segment) -> Problem {
        let message = format!("there is no `{}` in {}", segment.name, value.describe());
        self.problem(segment.span.clone(), message, "not there")
    }

    /// The element of a list that a segment means, by number or by name.
    fn index(&self, list: &[Node], segment: &Segment) -> Result<usize, Problem> {
        let names: Vec<&str> = list.iter().filter_map(name).collect();
        let by_name = list.iter().position(|item| name(item) == Some(&segment.name));
        let by_number = segment.name.parse::<usize>().ok().filter(|index| *index < list.len());
        by_name.or(by_number).ok_or_else(|| {
            let message = format!("the list has no element `{}`", segment.name);
            let problem = self.problem(segment.span.clone(), message, "not there");
            match (nearest(&segment.name, names.iter().copied()), list.len()) {
                (Some(near), _) => problem.help(format!("did you mean `{near}`?")),
                (None, 0) => problem.help("the list is empty"),
                (None, 1) if names.is_empty() => problem.help("its only element has the number 0"),
                (None, count) if names.is_empty() => {
                    problem.help(format!("its elements have the numbers 0 to {}", count - 1))
                }
                (None, _) => problem.help(format!(
                    "its elements are {}, or numbers from 0",
                    one_of(names.iter().copied())
                )),
            }
        })
    }
}

/// The key that the one a path leads to excludes.
fn alternative(parents: &[Segment], last: &Segment) -> Option<&'static str> {
    let (table, [one, other]) = ALTERNATIVES;
    match parents {
        [parent] if parent.name == table && last.name == one => Some(other),
        [parent] if parent.name == table && last.name == other => Some(one),
        _ => None,
    }
}

/// Removes a key of a table of the root, if it is there.
fn remove(root: &mut Table, table: &str, key: &str) {
    let found = root.entries.iter_mut().find(|entry| entry.key == table);
    if let Some(Value::Table(table)) = found.map(|entry| &mut entry.node.value) {
        table.entries.retain(|entry| entry.key != key);
    }
}

/// A part of a path and its bytes in the override.
struct Segment {
    name: String,
    span: Range<usize>,
}

impl Segment {
    /// Takes away a `+` at the end of the name, and says whether there was one.
    fn strip_plus(&mut self) -> bool {
        let Some(name) = self.name.strip_suffix('+').map(str::trim_end) else { return false };
        self.span.end = self.span.start + name.len();
        self.name = name.to_owned();
        true
    }
}

fn name(node: &Node) -> Option<&str> {
    let Value::Table(table) = &node.value else { return None };
    match &table.get("name")?.value {
        Value::Text(name) => Some(name),
        _ => None,
    }
}

/// Where the content of the string at `place` starts in its source, if it stands there as it is,
/// without escapes.
pub(super) fn start_of_content(
    sources: &[SourceText],
    place: Place,
    content: &str,
) -> Option<usize> {
    let source = sources.get(place.source as usize)?;
    let written = source.text.get(place.span())?;
    if content.is_empty() {
        return None;
    }
    written.find(content).map(|offset| place.start as usize + offset)
}
