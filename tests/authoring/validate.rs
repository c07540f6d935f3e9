//! A small JSON Schema validator: the keywords that the shipped schemas use, and no others.

use serde_json::Value;

/// Keywords that say something to readers only.
const REMARKS: &[&str] = &["$schema", "$defs", "title", "description", "default", "x-asset"];

/// What is wrong with `value`, with its path; empty if it fits. A keyword that is not known here is a mistake as well.
pub fn complaints(schema: &Value, value: &Value) -> Vec<String> {
    let mut found = Vec::new();
    check(schema, schema, value, "", &mut found);
    found
}

fn fits(whole: &Value, part: &Value, value: &Value) -> bool {
    let mut found = Vec::new();
    check(whole, part, value, "", &mut found);
    found.is_empty()
}

fn check(whole: &Value, part: &Value, value: &Value, path: &str, found: &mut Vec<String>) {
    let keywords = match part {
        Value::Bool(true) => return,
        Value::Object(keywords) => keywords,
        other => return found.push(format!("{path}: the schema {other} fits nothing")),
    };
    for (keyword, wanted) in keywords {
        let number = |limit: &Value| limit.as_f64().unwrap();
        let ok = match keyword.as_str() {
            "$ref" => {
                let target = whole.pointer(wanted.as_str().unwrap().strip_prefix('#').unwrap()).unwrap();
                check(whole, target, value, path, found);
                true
            }
            "type" => is_of_type(value, wanted.as_str().unwrap()),
            "const" => value == wanted,
            "enum" => wanted.as_array().unwrap().contains(value),
            "oneOf" => wanted.as_array().unwrap().iter().filter(|part| fits(whole, part, value)).count() == 1,
            "anyOf" => wanted.as_array().unwrap().iter().any(|part| fits(whole, part, value)),
            "minimum" => value.as_f64().is_none_or(|value| value >= number(wanted)),
            "exclusiveMinimum" => value.as_f64().is_none_or(|value| value > number(wanted)),
            "maximum" => value.as_f64().is_none_or(|value| value <= number(wanted)),
            "minItems" => value.as_array().is_none_or(|list| list.len() as f64 >= number(wanted)),
            "maxItems" => value.as_array().is_none_or(|list| list.len() as f64 <= number(wanted)),
            "required" => value.as_object().is_none_or(|table| {
                wanted.as_array().unwrap().iter().all(|name| table.contains_key(name.as_str().unwrap()))
            }),
            "items" => {
                for (index, entry) in value.as_array().into_iter().flatten().enumerate() {
                    check(whole, wanted, entry, &format!("{path}.{index}"), found);
                }
                true
            }
            "properties" => {
                for (name, entry) in value.as_object().into_iter().flatten() {
                    if let Some(part) = wanted.get(name) {
                        check(whole, part, entry, &format!("{path}.{name}"), found);
                    }
                }
                true
            }
            "additionalProperties" => {
                let known = |name: &str| part["properties"].get(name).is_some();
                for (name, entry) in value.as_object().into_iter().flatten().filter(|(name, _)| !known(name)) {
                    check(whole, wanted, entry, &format!("{path}.{name}"), found);
                }
                true
            }
            other => REMARKS.contains(&other),
        };
        if !ok {
            found.push(format!("{path}: {value} does not fit {keyword} = {wanted}"));
        }
    }
}

fn is_of_type(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        _ => false,
    }
}
