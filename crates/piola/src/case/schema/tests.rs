use super::*;
use crate::case::{spec::TaggedSpec, template};

/// Whether `value` fits `schema`, for the words of JSON Schema that are used here.
fn fits(root: &Value, schema: &Value, value: &Value) -> bool {
    let Value::Object(words) = schema else { return schema == &json!(true) };
    words.iter().all(|(word, content)| match word.as_str() {
        "$ref" => {
            let pointer = content.as_str().unwrap().strip_prefix('#').unwrap();
            fits(root, root.pointer(pointer).expect("the reference exists"), value)
        }
        "type" => match content {
            Value::Array(types) => types.iter().any(|name| has_type(name, value)),
            name => has_type(name, value),
        },
        "properties" => value.as_object().is_none_or(|object| {
            let known = content.as_object().unwrap();
            object.iter().all(|(key, v)| known.get(key).is_none_or(|known| fits(root, known, v)))
        }),
        "additionalProperties" => value.as_object().is_none_or(|object| {
            let known = words.get("properties").and_then(Value::as_object);
            let extra = |key: &String| known.is_none_or(|known| !known.contains_key(key));
            object.iter().all(|(key, v)| !extra(key) || fits(root, content, v))
        }),
        "required" => value.as_object().is_none_or(|object| {
            content.as_array().unwrap().iter().all(|key| object.contains_key(key.as_str().unwrap()))
        }),
        "anyOf" => content.as_array().unwrap().iter().any(|inner| fits(root, inner, value)),
        "oneOf" => {
            let options = content.as_array().unwrap();
            options.iter().filter(|inner| fits(root, inner, value)).count() == 1
        }
        "items" => {
            value.as_array().is_none_or(|items| items.iter().all(|item| fits(root, content, item)))
        }
        "enum" => content.as_array().unwrap().contains(value),
        "const" => content == value,
        "minItems" => value.as_array().is_none_or(|v| v.len() as f64 >= content.as_f64().unwrap()),
        "maxItems" => value.as_array().is_none_or(|v| v.len() as f64 <= content.as_f64().unwrap()),
        "minimum" => value.as_f64().is_none_or(|v| v >= content.as_f64().unwrap()),
        "maximum" => value.as_f64().is_none_or(|v| v <= content.as_f64().unwrap()),
        "exclusiveMinimum" => value.as_f64().is_none_or(|v| v > content.as_f64().unwrap()),
        "minLength" => value.as_str().is_none_or(|v| !v.is_empty()),
        "minProperties" => value.as_object().is_none_or(|v| !v.is_empty()),
        "description" | "title" | "default" | "x-unit" | "$schema" | "$defs" => true,
        other => panic!("the test does not know the word {other}"),
    })
}

fn has_type(name: &Value, value: &Value) -> bool {
    match name.as_str().unwrap() {
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        "boolean" => value.is_boolean(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("unknown type {other}"),
    }
}

fn accepts(text: &str) -> bool {
    let case = serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap();
    let schema = json_schema();
    fits(&schema, &schema, &case)
}

#[test]
fn accepts_good_cases_and_refuses_slips() {
    let good = template::new_case("name");
    assert!(accepts(&good));
    assert!(accepts(crate::case::tests::FULL));
    for (from, to) in [
        ("dimension = 2", "dimension = 4"),
        ("cfl = 0.3", "cfk = 0.3"),
        ("kind = \"box\"", "kind = \"bix\""),
        ("end = 0.5", "end = true"),
        ("title = ", "titel = "),
        ("of = \"largest\"", "of = \"large\""),
        ("every = 0.05 ", "every = -0.05 "),
    ] {
        let bad = good.replacen(from, to, 1);
        assert_ne!(good, bad, "{from} is not in the template");
        assert!(!accepts(&bad), "accepted {to}");
    }
}

#[test]
fn describes_every_key_with_its_unit() {
    let schema = json_schema();
    let check = |keys: &[KeySpec], properties: &Value| {
        for key in keys {
            let property = &properties[key.name];
            let description = property["description"].as_str().unwrap();
            assert!(description.starts_with(key.meaning), "{}", key.name);
            if !key.unit.is_empty() {
                assert_eq!(property["x-unit"], key.unit);
            }
        }
    };
    check(tables::CASE.keys, &schema["properties"]);
    for section in sections(&tables::CASE).into_iter().skip(1) {
        let definition = &schema["$defs"][section.name()];
        match section {
            Section::Table(spec) => check(spec.keys, &definition["properties"]),
            Section::Tagged(TaggedSpec { common, kinds, .. }) => {
                for (number, kind) in kinds.iter().enumerate() {
                    let properties = &definition["oneOf"][number]["properties"];
                    assert_eq!(properties["kind"]["const"], kind.name);
                    check(common, properties);
                    check(kind.keys, properties);
                }
            }
        }
    }
}

#[test]
fn defaults_are_toml() {
    let schema = json_schema();
    assert_eq!(
        schema["$defs"]["scheme"]["oneOf"][0]["properties"]["kernel"]["default"],
        "cubic_spline"
    );
    assert_eq!(schema["$defs"]["lattice"]["properties"]["jitter"]["default"], 0.0);
}
