//! The reference of the case file as Markdown, made from the descriptions of its tables.

use std::fmt::Write;

use super::expression::{constants, functions};
use super::outline::{Section, sections, table_of};
use super::spec::{KeySpec, Kind, Length, Presence, Variables};
use super::tables;
use crate::fields::FieldDescription;
use crate::schemes::SchemeDescription;

/// All tables and keys with their units, defaults and meanings.
pub fn markdown() -> String {
    let mut page = String::from(
        "# Reference of the case file\n\n\
         Generated from the descriptions against which the program checks case files.\n\n\
         Wherever a number is expected, text with an expression of the parameters does as well: \
         `\"2 * speed\"`.\n",
    );
    for section in sections(&tables::CASE) {
        let title = match section.title() {
            "the case file" => "Top level",
            title => title,
        };
        let code = if title == "Top level" { title.to_owned() } else { format!("`{title}`") };
        push(&mut page, &format!("\n## {code}\n"));
        match section {
            Section::Table(spec) => {
                push(&mut page, &format!("\n{}\n", spec.meaning));
                keys(&mut page, spec.keys);
            }
            Section::Tagged(spec) => {
                push(&mut page, &format!("\n{}\n", spec.meaning));
                keys(&mut page, spec.common);
                for kind in spec.kinds {
                    let dimensions: Vec<_> =
                        kind.dimensions.iter().map(|dimension| format!("{dimension}D")).collect();
                    let only = match dimensions.len() {
                        3 => String::new(),
                        _ => format!(" ({} only)", dimensions.join(" and ")),
                    };
                    let head =
                        format!("\n### `kind = \"{}\"`{only}\n\n{}\n", kind.name, kind.meaning);
                    push(&mut page, &head);
                    keys(&mut page, kind.keys);
                }
            }
        }
    }
    fields(&mut page);
    expressions(&mut page);
    page
}

fn push(page: &mut String, text: &str) {
    page.push_str(text);
}

fn keys(page: &mut String, keys: &[KeySpec]) {
    if keys.is_empty() {
        return;
    }
    push(page, "\n| key | value | unit | default | meaning |\n|---|---|---|---|---|\n");
    for key in keys {
        let default = match key.presence {
            Presence::Required => "required".to_owned(),
            Presence::Optional => "none".to_owned(),
            Presence::Default(text) => format!("`{text}`"),
            Presence::Derived(words) => words.to_owned(),
        };
        let row = format!(
            "| `{}` | {} | {} | {default} | {} |\n",
            key.name,
            value(&key.kind),
            key.unit,
            key.meaning
        );
        push(page, &row);
    }
    for key in keys {
        let Kind::Name(choices) = &key.kind else { continue };
        push(page, &format!("\nNames of `{}`:\n\n", key.name));
        for choice in choices.list() {
            push(page, &format!("- `{}`: {}\n", choice.name, choice.meaning));
        }
    }
}

fn value(kind: &Kind) -> String {
    let within = |what: &str, bounds: Option<String>| match bounds {
        Some(bounds) => format!("{what} {bounds}"),
        None => what.to_owned(),
    };
    match kind {
        Kind::Text => "text".to_owned(),
        Kind::File => "file name".to_owned(),
        Kind::Boolean => "`true` or `false`".to_owned(),
        Kind::Integer(interval) => within("whole number", interval.describe()),
        Kind::Number(interval) => within("number", interval.describe()),
        Kind::NumberOrText => "number or text".to_owned(),
        Kind::Expression(variables) => format!("expression of {}", names(*variables)),
        Kind::Name(_) => "name, see below".to_owned(),
        Kind::Numbers(length, interval) => match length {
            Length::Dimension => within("list, one number per axis", interval.describe()),
            Length::Pair => within("list of 2 numbers", interval.describe()),
            Length::Ends => "list of 2 numbers, the smaller one first".to_owned(),
            Length::Any => within("list of numbers", interval.describe()),
        },
        Kind::NumberOrPerAxis(interval) => {
            within("number, or list with one per axis,", interval.describe())
        }
        Kind::Expressions(variables) => {
            format!("list, one expression of {} per axis", names(*variables))
        }
        Kind::PerAxis(inner) => {
            format!("table with the keys `x`, `y`, `z`, each: {}", value(inner))
        }
        Kind::List(inner) => match table_of(inner) {
            Some(section) => format!("list of tables, see `{}`", section.title()),
            None => format!("list, each: {}", value(inner)),
        },
        Kind::Table(_) | Kind::Tagged(_) => {
            let title = table_of(kind).map_or("", |section| section.title());
            format!("table, see `{title}`")
        }
        Kind::Parameters => "table of numbers and expressions".to_owned(),
        Kind::KeysWithValues => "table of one or two key paths, each with a list".to_owned(),
        Kind::KeysWithValue => "table of key paths, each with a value".to_owned(),
    }
}

fn names(variables: Variables) -> &'static str {
    match variables {
        Variables::Position | Variables::AtStart => "x, y, z",
        Variables::PositionAndTime => "x, y, z, t",
    }
}

fn fields(page: &mut String) {
    push(
        page,
        "\n## Fields\n\n\
         The fields that each scheme provides to probes, lines, pictures and particle files. Evolved \
         fields are the state; derived ones are computed from it on demand.\n",
    );
    for scheme in SchemeDescription::ALL {
        let head = "| field | kind | unit | life | meaning |\n|---|---|---|---|---|\n";
        let of = scheme.matter.map_or_else(String::new, |matter| format!(" for {matter}"));
        push(page, &format!("\n### Fields of `{}`{of}\n\n{head}", scheme.name));
        for FieldDescription { name, kind, unit, life, meaning, .. } in scheme.shown() {
            let (kind, life) = (kind.name(), life.name());
            push(page, &format!("| `{name}` | {kind} | {unit} | {life} | {meaning} |\n"));
        }
    }
}

fn expressions(page: &mut String) {
    push(
        page,
        "\n## Expressions\n\n\
         Numbers, parameters and, where the table above says so, the reference position `x`, `y`, \
         `z` (as many as the case has dimensions) in m and the time `t` in s, with `+ - * / ^`, \
         brackets and the functions below. `-2^2` is -4, `2^3^2` is 512. Constants: ",
    );
    let constants: Vec<_> = constants().iter().map(|(name, v)| format!("`{name}` = {v}")).collect();
    push(page, &constants.join(", "));
    push(page, ".\n\n| function | meaning |\n|---|---|\n");
    for function in functions() {
        let arguments = if function.arguments == 1 { "a" } else { "a, b" };
        writeln!(page, "| `{}({arguments})` | {} |", function.name, function.meaning)
            .expect("writing to a string does not fail");
    }
}
