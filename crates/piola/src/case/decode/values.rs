//! Numbers, names, expressions and lists of them.

use std::sync::Arc;

use piola_formulas::hyperelastic::{EnergyError, EnergyFunction};

use super::{Context, Datum, Located, Node, Problem, Table, Value, one_of, suggestion};
use crate::boundaries::SpaceTime;
use crate::case::expression::{Expression, ExpressionError, Scope, constants, energy, functions};
use crate::case::functions::MARK;
use crate::case::overrides::start_of_content;
use crate::case::settings::keys_with_values;
use crate::case::source::Place;
use crate::case::spec::{Interval, Kind, Length, Variables};

/// Every expression looks through the parameters one by one.
const MAX_PARAMETERS: usize = 1000;

/// The axes by name.
pub(in crate::case) const AXES: [&str; 3] = ["x", "y", "z"];

impl Context<'_> {
    /// Checks a value that is no table.
    pub(super) fn simple(&mut self, name: &str, kind: &Kind, node: &Node) -> Option<Datum> {
        match (kind, &node.value) {
            (Kind::Text | Kind::File, Value::Text(text)) => self.text(name, text, node.place),
            (Kind::Boolean, Value::Boolean(value)) => Some(Datum::Boolean(*value)),
            (Kind::Integer(interval), Value::Integer(_) | Value::Float(_) | Value::Text(_)) => {
                self.integer(name, interval, node)
            }
            (Kind::Number(interval), Value::Integer(_) | Value::Float(_) | Value::Text(_)) => {
                self.number(name, interval, node).map(Datum::Number)
            }
            (Kind::NumberOrText, Value::Text(text)) => self.text(name, text, node.place),
            (Kind::NumberOrText, Value::Integer(_) | Value::Float(_)) => {
                self.number(name, &Interval::ANY, node).map(Datum::Number)
            }
            (Kind::Expression(variables), Value::Integer(_) | Value::Float(_) | Value::Text(_)) => {
                self.expression(name, *variables, node).map(Datum::Expression)
            }
            (Kind::Name(choices), Value::Text(text)) => {
                let list = choices.list();
                if list.iter().any(|choice| choice.name == text) {
                    return Some(Datum::Text(text.clone()));
                }
                let message = format!("`{name}` cannot be `{text}`");
                let help = suggestion(text, list.iter().map(|choice| choice.name));
                self.report(Problem::new(node.place, message, "unknown name").help(help));
                None
            }
            (Kind::Numbers(length, interval), Value::List(list)) => {
                self.numbers(name, *length, interval, list, node.place)
            }
            (Kind::NumberOrPerAxis(interval), Value::List(list)) => {
                self.numbers(name, Length::Dimension, interval, list, node.place)
            }
            (
                Kind::NumberOrPerAxis(interval),
                Value::Integer(_) | Value::Float(_) | Value::Text(_),
            ) => {
                let number = Datum::Number(self.number(name, interval, node)?);
                let axes = self.dimension.unwrap_or(1);
                Some(Datum::List(vec![Located::new(number, node.place); axes]))
            }
            (Kind::Expressions(variables), Value::List(list)) => {
                self.length(name, Length::Dimension, list.len(), node.place)?;
                let each = list.iter().map(|item| {
                    let expression = self.expression(name, *variables, item)?;
                    Some(Located::new(Datum::Expression(expression), item.place))
                });
                // All are read before one that fails ends it, so that every problem is found.
                let each: Vec<_> = each.collect();
                each.into_iter().collect::<Option<_>>().map(Datum::List)
            }
            (Kind::KeysWithValues | Kind::KeysWithValue, Value::Table(table)) => {
                self.keys(name, matches!(kind, Kind::KeysWithValues), table, node.place)
            }
            (Kind::PerAxis(inner), Value::Table(table)) => {
                self.axes(name, inner, table, node.place)
            }
            _ => {
                self.wrong_type(name, kind, node);
                None
            }
        }
    }

    fn text(&mut self, name: &str, text: &str, place: Place) -> Option<Datum> {
        if text.trim().is_empty() {
            let message = format!("`{name}` must not be empty");
            self.report(Problem::new(place, message, "empty"));
            return None;
        }
        Some(Datum::Text(text.to_owned()))
    }

    fn integer(&mut self, name: &str, interval: &Interval, node: &Node) -> Option<Datum> {
        if let Value::Integer(number) = node.value {
            self.within(name, interval, number as f64, node.place)?;
            return Some(Datum::Integer(number));
        }
        let number = self.number(name, interval, node)?;
        // Whole numbers up to here are exact as floating-point numbers.
        if number.fract() == 0.0 && number.abs() <= 9e15 {
            return Some(Datum::Integer(number as i64));
        }
        let message = format!("`{name}` must be a whole number, got {number}");
        self.report(Problem::new(node.place, message, "not a whole number"));
        None
    }

    fn number(&mut self, name: &str, interval: &Interval, node: &Node) -> Option<f64> {
        let number = match &node.value {
            Value::Float(number) => *number,
            Value::Integer(number) => *number as f64,
            Value::Text(text) => self.constant(text, node.place)?,
            _ => {
                self.wrong_type(name, &Kind::Number(*interval), node);
                return None;
            }
        };
        self.within(name, interval, number, node.place)?;
        Some(number)
    }

    /// The value of an expression of the parameters.
    pub(in crate::case) fn constant(&mut self, text: &str, place: Place) -> Option<f64> {
        let expression = self.parse(text, place, 0, false)?;
        expression.as_constant()
    }

    fn expression(&mut self, name: &str, variables: Variables, node: &Node) -> Option<Expression> {
        match &node.value {
            Value::Text(text) if text.starts_with(MARK) => {
                let array = match (variables, self.arrays) {
                    (Variables::AtStart, Some(known)) => known.get(&text[MARK.len_utf8()..]),
                    _ => None,
                };
                match array {
                    Some(values) => Some(Expression::of_particles(text, values.clone())),
                    None => self.function(name, text, variables, node.place),
                }
            }
            Value::Text(text) => {
                let time = variables == Variables::PositionAndTime;
                self.parse(text, node.place, self.dimension.unwrap_or(3), time)
            }
            Value::Integer(_) | Value::Float(_) => {
                self.number(name, &Interval::ANY, node).map(Expression::constant)
            }
            Value::Broken => None,
            _ => {
                self.wrong_type(name, &Kind::Expression(variables), node);
                None
            }
        }
    }

    /// The function from outside that a text names.
    fn function(
        &mut self,
        name: &str,
        text: &str,
        variables: Variables,
        place: Place,
    ) -> Option<Expression> {
        // What is not known is not run either.
        let unknown: Arc<dyn SpaceTime> = Arc::new(0.0);
        let known = self.functions;
        let found = known.map_or(Some(&unknown), |known| known.get(&text[MARK.len_utf8()..]));
        let Some(function) = found else {
            let message = format!("there is no function `{text}`");
            let help = match known.and_then(|known| known.names().next()) {
                Some(first) => {
                    format!("functions are given by a program; there is `{MARK}{first}`")
                }
                None => {
                    "write an expression; functions are given by a program that uses the library"
                        .to_owned()
                }
            };
            self.report(Problem::new(place, message, "unknown function").help(help));
            return None;
        };
        if variables != Variables::PositionAndTime && !function.is_steady() {
            let message =
                format!("`{name}` is the same at all times, and `{text}` is a function of t");
            self.report(Problem::new(place, message, "depends on t"));
            return None;
        }
        Some(Expression::outside(text, function.clone()))
    }

    fn parse(&mut self, text: &str, place: Place, axes: usize, time: bool) -> Option<Expression> {
        let scope = Scope { axes, time, ..Scope::of_parameters(&self.parameters) };
        self.or_report(Expression::parse(text, &scope), text, place)
    }

    /// The strain energy that a text writes out.
    pub(in crate::case) fn energy(
        &mut self,
        text: &str,
        place: Place,
    ) -> Option<Result<EnergyFunction, EnergyError>> {
        let parsed = energy(text, &Scope::of_parameters(&self.parameters));
        self.or_report(parsed, text, place).map(EnergyFunction::new)
    }

    fn or_report<T>(
        &mut self,
        read: Result<T, ExpressionError>,
        text: &str,
        place: Place,
    ) -> Option<T> {
        match read {
            Ok(value) => Some(value),
            Err(error) => {
                if !error.is_consequence {
                    let problem = self.in_text(text, place, error);
                    self.report(problem);
                }
                None
            }
        }
    }

    /// A problem inside of the text of a value.
    fn in_text(&self, text: &str, place: Place, error: ExpressionError) -> Problem {
        let start = start_of_content(self.sources, place, text);
        let inner = start.map(|start| {
            Place::new(place.source, start + error.span.start..start + error.span.end)
        });
        let problem = Problem::new(inner.unwrap_or(place), error.message, error.label);
        match error.help {
            Some(help) => problem.help(help),
            None => problem,
        }
    }

    fn within(&mut self, name: &str, interval: &Interval, value: f64, place: Place) -> Option<()> {
        if interval.contains(value) {
            return Some(());
        }
        let bounds = interval.describe().unwrap_or_else(|| "a finite number".to_owned());
        let message = format!("`{name}` must be {bounds}, got {value}");
        self.report(Problem::new(place, message, format!("must be {bounds}")));
        None
    }

    fn length(&mut self, name: &str, length: Length, got: usize, place: Place) -> Option<()> {
        let (needed, reason) = match length {
            Length::Dimension => match self.dimension {
                None => return Some(()),
                Some(dimension) => (dimension, format!(" in {dimension}D")),
            },
            Length::Pair => (2, ": x and y".to_owned()),
            Length::Ends => (2, ": the ends of an interval".to_owned()),
            Length::Any if got == 0 => {
                let message = format!("`{name}` must have at least one entry");
                self.report(Problem::new(place, message, "empty"));
                return None;
            }
            Length::Any => return Some(()),
        };
        if got == needed {
            return Some(());
        }
        let entries = if needed == 1 { "entry" } else { "entries" };
        let message = format!("`{name}` must have {needed} {entries}{reason}, got {got}");
        self.report(Problem::new(place, message, format!("expected {needed} {entries}")));
        None
    }

    fn numbers(
        &mut self,
        name: &str,
        length: Length,
        interval: &Interval,
        list: &[Node],
        place: Place,
    ) -> Option<Datum> {
        self.length(name, length, list.len(), place)?;
        let each: Vec<_> = list
            .iter()
            .map(|item| {
                let number = self.number(name, interval, item)?;
                Some(Located::new(Datum::Number(number), item.place))
            })
            .collect();
        let numbers: Vec<_> = each.into_iter().collect::<Option<_>>()?;
        if length == Length::Ends
            && let [first, second] = &numbers[..]
            && let (Datum::Number(lower), Datum::Number(upper)) = (&first.value, &second.value)
            && lower >= upper
        {
            let message = format!("`{name}` must go from a smaller to a larger number");
            let label = format!("{lower} is not below {upper}");
            self.report(Problem::new(place, message, label));
            return None;
        }
        Some(Datum::List(numbers))
    }

    fn axes(&mut self, name: &str, inner: &Kind, table: &Table, place: Place) -> Option<Datum> {
        let known = &AXES[..self.dimension.unwrap_or(3)];
        for entry in &table.entries {
            if !known.contains(&entry.key.as_str()) {
                let message = format!("`{name}` has no component `{}`", entry.key);
                let help = format!("expected {}", one_of(known.iter().copied()));
                self.report(Problem::new(entry.key_place, message, "unknown key").help(help));
            }
        }
        if table.entries.is_empty() {
            let message = format!("`{name}` needs at least one component");
            let help = format!("expected {}", one_of(known.iter().copied()));
            self.report(Problem::new(place, message, "empty").help(help));
        }
        let each = known.iter().map(|axis| {
            let node = table.get(axis)?;
            self.value(&format!("{name}.{axis}"), inner, node)
        });
        Some(Datum::Axes(each.collect()))
    }

    /// Paths of keys with their values, which are lists if there have to be several.
    fn keys(&mut self, name: &str, several: bool, table: &Table, place: Place) -> Option<Datum> {
        let found = keys_with_values(table);
        if found.is_empty() {
            let message = format!("`{name}` must have at least one key");
            self.report(Problem::new(place, message, "empty"));
        }
        let mut kept = Vec::new();
        for (path, node) in found {
            let list = match (&node.value, several) {
                (Value::Broken, _) => continue,
                (Value::List(list), true) => list,
                (_, false) => std::slice::from_ref(node),
                (value, true) => {
                    let key = &path.value;
                    let message =
                        format!("the values of `{key}` must be a list, got {}", value.describe());
                    self.report(
                        Problem::new(node.place, message, "expected a list")
                            .help("write brackets around the values: [1, 2, 4]"),
                    );
                    continue;
                }
            };
            if list.is_empty() {
                let message = format!("`{}` needs at least one value", path.value);
                self.report(Problem::new(node.place, message, "empty"));
                continue;
            }
            kept.push((path, list.to_vec()));
        }
        Some(Datum::Keys(kept))
    }

    /// What a value should be, with an article.
    pub(super) fn expected(&self, kind: &Kind) -> String {
        let bounded = |what: &str, interval: &Interval| match interval.describe() {
            Some(bounds) => format!("{what} {bounds}"),
            None => what.to_owned(),
        };
        let count = |length: &Length| match length {
            Length::Dimension => self.dimension.map_or(String::new(), |count| format!("{count} ")),
            Length::Pair | Length::Ends => "2 ".to_owned(),
            Length::Any => String::new(),
        };
        match kind {
            Kind::Text => "text in quotes".to_owned(),
            Kind::File => "a file name in quotes".to_owned(),
            Kind::Boolean => "`true` or `false`".to_owned(),
            Kind::Integer(interval) => bounded("a whole number", interval),
            Kind::Number(interval) => bounded("a number", interval),
            Kind::NumberOrText => "a number or text in quotes".to_owned(),
            Kind::Expression(_) => "a number or an expression in quotes".to_owned(),
            Kind::Name(choices) => one_of(choices.list().iter().map(|choice| choice.name)),
            Kind::Numbers(length, interval) => {
                bounded(&format!("a list of {}numbers", count(length)), interval)
            }
            Kind::NumberOrPerAxis(interval) => {
                format!("{}, or a list with one for each axis", bounded("a number", interval))
            }
            Kind::Expressions(_) => {
                format!("a list of {}expressions", count(&Length::Dimension))
            }
            Kind::PerAxis(_) => "a table with a key for each axis, like { x = ... }".to_owned(),
            Kind::List(Kind::Table(_) | Kind::Tagged(_)) => "a list of tables".to_owned(),
            Kind::List(_) => "a list".to_owned(),
            Kind::Table(_) => "a table".to_owned(),
            Kind::Tagged(_) => "a table with the key `kind`".to_owned(),
            Kind::Parameters => "a table of numbers".to_owned(),
            Kind::KeysWithValues => {
                "a table like { \"time.cfl\" = [0.1, 0.2] }, keys with lists of values".to_owned()
            }
            Kind::KeysWithValue => {
                "a table like { \"time.cfl\" = 0.1 }, keys with a value each".to_owned()
            }
        }
    }
}

/// Evaluates the table of parameters, each an expression of those above it.
pub(in crate::case) fn evaluate_parameters(context: &mut Context<'_>, root: &Table) {
    let Some(Value::Table(table)) = root.get("parameters").map(|node| &node.value) else { return };
    if table.entries.len() > MAX_PARAMETERS {
        let place = table.entries[MAX_PARAMETERS].key_place;
        let message = format!("there are more than {MAX_PARAMETERS} parameters");
        return context.report(Problem::new(place, message, "one too many"));
    }
    for (index, entry) in table.entries.iter().enumerate() {
        let key = entry.key.as_str();
        if let Some(problem) = bad_name(key, entry.key_place) {
            context.report(problem);
            continue;
        }
        let value = match &entry.node.value {
            Value::Text(text) => {
                let before = context.problems.len();
                let value = context.constant(text, entry.node.place);
                let later = table.entries[index..].iter().map(|entry| entry.key.as_str());
                explain_order(&mut context.problems[before..], key, later);
                value
            }
            _ => context.number(key, &Interval::ANY, &entry.node),
        };
        context.parameters.push((key.to_owned(), value));
    }
}

/// Says of an unknown name that it is defined too late, where that is so.
fn explain_order<'a>(
    problems: &mut [Problem],
    own: &str,
    later: impl Iterator<Item = &'a str> + Clone,
) {
    for problem in problems {
        let unknown = |name: &&str| problem.message == format!("`{name}` is not known");
        if let Some(name) = later.clone().find(unknown) {
            let help = if name == own {
                "a parameter cannot use itself"
            } else {
                "a parameter uses those above it only: change their order"
            };
            problem.help = Some(help.to_owned());
        }
    }
}

fn bad_name(name: &str, place: Place) -> Option<Problem> {
    let mut characters = name.chars();
    let starts_well = characters.next().is_some_and(|c| c.is_alphabetic() || c == '_');
    if !starts_well || !characters.all(|c| c.is_alphanumeric() || c == '_') {
        let message = format!("the parameter `{name}` cannot be used in expressions");
        return Some(
            Problem::new(place, message, "not a name").help("use letters, digits and `_` only"),
        );
    }
    let is_taken = AXES.contains(&name)
        || name == "t"
        || constants().iter().any(|(known, _)| *known == name)
        || functions().iter().any(|function| function.name == name);
    is_taken.then(|| {
        let message = format!("the name `{name}` has a meaning in expressions already");
        Problem::new(place, message, "taken").help("choose another name for the parameter")
    })
}
