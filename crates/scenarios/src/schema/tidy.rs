//! What schemas say too much or too little for files in TOML.

use serde_json::{Map, Value, json};

use super::place::resolved;

/// Mends a whole schema: TOML has no null, names of Rust's number types say nothing, and a kind all of whose options
/// have defaults is named by a bare text too.
pub(super) fn tidy(schema: &mut Value) {
    plain(schema);
    let whole = schema.clone();
    name_kinds_bare(&whole, schema);
}

fn plain(part: &mut Value) {
    match part {
        Value::Array(parts) => parts.iter_mut().for_each(plain),
        Value::Object(entries) => {
            // a key of a file may be called `format` as well
            if entries.get("format").is_some_and(Value::is_string) {
                entries.remove("format");
            }
            if entries.get("default").is_some_and(Value::is_null) {
                entries.remove("default");
            }
            if let Some(default) = entries.get_mut("default") {
                stated(default);
            }
            without_null(entries);
            entries.iter_mut().filter(|(name, _)| *name != "default").for_each(|(_, part)| plain(part));
        }
        _ => {}
    }
}

/// Leaves of a default what a file can state: values that are absent are not.
fn stated(default: &mut Value) {
    match default {
        Value::Object(entries) => {
            entries.retain(|_, entry| !entry.is_null());
            entries.values_mut().for_each(stated);
        }
        Value::Array(entries) => entries.iter_mut().for_each(stated),
        _ => {}
    }
}

/// Takes null out of the types of a value that may be absent.
fn without_null(entries: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = entries.get_mut("type") {
        types.retain(|name| name != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            entries.insert("type".into(), only);
        }
    }
    let Some(Value::Array(choices)) = entries.get_mut("anyOf") else { return };
    choices.retain(|choice| *choice != json!({ "type": "null" }));
    if let [Value::Object(only)] = choices.as_slice() {
        let only = only.clone();
        entries.remove("anyOf");
        for (name, value) in only {
            entries.entry(name).or_insert(value);
        }
    }
}

fn name_kinds_bare(whole: &Value, part: &mut Value) {
    match part {
        Value::Array(parts) => parts.iter_mut().for_each(|part| name_kinds_bare(whole, part)),
        Value::Object(entries) => {
            if let Some(Value::Array(choices)) = entries.get_mut("oneOf") {
                let bare: Vec<Value> = choices.iter().filter_map(|choice| bare_name(whole, choice)).collect();
                choices.extend(bare);
            }
            entries
                .iter_mut()
                .filter(|(name, _)| *name != "default")
                .for_each(|(_, part)| name_kinds_bare(whole, part));
        }
        _ => {}
    }
}

/// The bare text that names a kind without options: that of a table with one key, whose value may be an empty table.
fn bare_name(whole: &Value, choice: &Value) -> Option<Value> {
    let mut named = choice["properties"].as_object()?.iter();
    let (Some((name, content)), None) = (named.next(), named.next()) else { return None };
    let content = resolved(whole, content);
    let may_be_empty = content["type"] == "object" && content["required"].as_array().is_none_or(Vec::is_empty);
    let mut bare = json!({ "type": "string", "const": name });
    if let Some(description) = choice.get("description") {
        bare["description"] = description.clone();
    }
    may_be_empty.then_some(bare)
}
