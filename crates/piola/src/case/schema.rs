//! The JSON schema of the case file, for editors.

use serde_json::{Map, Value, json};

use super::outline::{Section, sections};
use super::spec::{Interval, KeySpec, Kind, Length, Presence, TableSpec};
use super::tables;

/// The schema of the case file, JSON Schema draft 2020-12.
///
/// It accepts every valid case. What it cannot express, such as the length of vectors in a case of two dimensions or
/// which keys exclude each other, is checked by piola only.
pub fn json_schema() -> Value {
    let mut definitions = Map::new();
    for section in sections(&tables::CASE).into_iter().skip(1) {
        definitions.insert(section.name().to_owned(), describe(section));
    }
    let mut root = object(&[tables::CASE.keys], None);
    root["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    root["title"] = json!("piola case file");
    root["description"] = json!(tables::CASE.meaning);
    root["$defs"] = Value::Object(definitions);
    root
}

fn describe(section: Section) -> Value {
    match section {
        Section::Table(TableSpec { meaning, keys, .. }) => {
            let mut table = object(&[keys], None);
            table["description"] = json!(meaning);
            table
        }
        Section::Tagged(spec) => {
            let kinds = spec.kinds.iter().map(|kind| {
                let mut table = object(&[spec.common, kind.keys], Some(kind.name));
                table["description"] = json!(kind.meaning);
                table
            });
            json!({ "description": spec.meaning, "oneOf": kinds.collect::<Vec<_>>() })
        }
    }
}

/// A table with some keys, and with `kind` if it has a value.
fn object(groups: &[&'static [KeySpec]], kind: Option<&str>) -> Value {
    let mut properties = Map::new();
    let mut required = Vec::new();
    if let Some(kind) = kind {
        properties.insert("kind".to_owned(), json!({ "const": kind }));
        required.push("kind");
    }
    for key in groups.iter().flat_map(|keys| keys.iter()) {
        properties.insert(key.name.to_owned(), property(key));
        if matches!(key.presence, Presence::Required) {
            required.push(key.name);
        }
    }
    json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn property(key: &KeySpec) -> Value {
    let mut schema = value(&key.kind);
    let mut description = key.meaning.to_owned();
    if !key.unit.is_empty() {
        description.push_str(&format!(" [{}]", key.unit));
        schema["x-unit"] = json!(key.unit);
    }
    match key.presence {
        Presence::Required | Presence::Optional => {}
        Presence::Default(text) => {
            if let Some(default) = toml_value(text) {
                schema["default"] = default;
            }
        }
        Presence::Derived(words) => description.push_str(&format!(". Default: {words}")),
    }
    schema["description"] = json!(description);
    schema
}

/// A default, which is TOML, as JSON.
fn toml_value(text: &str) -> Option<Value> {
    let value = toml::from_str::<toml::Table>(&format!("value = {text}")).ok()?;
    serde_json::to_value(value.get("value")?).ok()
}

fn value(kind: &Kind) -> Value {
    match kind {
        Kind::Text | Kind::File => json!({ "type": "string", "minLength": 1 }),
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::Integer(interval) => or_text(bounded("integer", interval)),
        Kind::Number(interval) => or_text(bounded("number", interval)),
        Kind::NumberOrText | Kind::Expression(_) => json!({ "type": ["number", "string"] }),
        Kind::Name(choices) => {
            let names: Vec<_> = choices.list().iter().map(|choice| choice.name).collect();
            json!({ "type": "string", "enum": names })
        }
        Kind::Numbers(length, interval) => list(or_text(bounded("number", interval)), *length),
        Kind::NumberOrPerAxis(interval) => {
            let number = bounded("number", interval);
            let axes = list(or_text(number.clone()), Length::Dimension);
            json!({ "anyOf": [number, { "type": "string" }, axes] })
        }
        Kind::Expressions(_) => list(json!({ "type": ["number", "string"] }), Length::Dimension),
        Kind::PerAxis(inner) => {
            let inner = value(inner);
            json!({
                "type": "object",
                "properties": { "x": inner, "y": inner, "z": inner },
                "minProperties": 1,
                "additionalProperties": false,
            })
        }
        Kind::List(inner) => json!({ "type": "array", "items": value(inner) }),
        Kind::Table(spec) => reference(Section::Table(spec)),
        Kind::Tagged(spec) => reference(Section::Tagged(spec)),
        Kind::Parameters => json!({
            "type": "object",
            "additionalProperties": { "type": ["number", "string"] },
        }),
        // A path may be written as one key in quotes or as nested tables.
        Kind::KeysWithValues => json!({
            "type": "object",
            "minProperties": 1,
            "additionalProperties": { "type": ["array", "object"] },
        }),
        Kind::KeysWithValue => json!({ "type": "object", "minProperties": 1 }),
    }
}

fn reference(section: Section) -> Value {
    json!({ "$ref": format!("#/$defs/{}", section.name()) })
}

/// Every number may be written as an expression of the parameters.
fn or_text(number: Value) -> Value {
    json!({ "anyOf": [number, { "type": "string" }] })
}

fn bounded(name: &str, interval: &Interval) -> Value {
    let mut schema = json!({ "type": name });
    if interval.lower.is_finite() {
        let key = if interval.has_lower { "minimum" } else { "exclusiveMinimum" };
        schema[key] = json!(interval.lower);
    }
    if interval.upper.is_finite() {
        let key = if interval.has_upper { "maximum" } else { "exclusiveMaximum" };
        schema[key] = json!(interval.upper);
    }
    schema
}

fn list(item: Value, length: Length) -> Value {
    let mut schema = json!({ "type": "array", "items": item });
    let (least, most) = match length {
        Length::Dimension => (1, Some(3)),
        Length::Pair | Length::Ends => (2, Some(2)),
        Length::Any => (1, None),
    };
    schema["minItems"] = json!(least);
    if let Some(most) = most {
        schema["maxItems"] = json!(most);
    }
    schema
}

#[cfg(test)]
mod tests;
