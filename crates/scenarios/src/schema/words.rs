//! Types and values of a schema in words, and as TOML.

use serde_json::Value;

use super::place::{kinds, resolved};

/// What a value has to be: "a list of 2 numbers".
pub(super) fn type_in_words(schema: &Value, part: &Value) -> String {
    let part = resolved(schema, part);
    if let Some(kinds) = kinds(schema, part) {
        let mut names: Vec<&str> = kinds.iter().map(|kind| kind.name).collect();
        names.sort_unstable();
        names.dedup();
        let what = if kinds.iter().any(|kind| kind.content.is_some()) { "one kind of" } else { "one of" };
        return format!("{what} {}", names.join(", "));
    }
    match part["type"].as_str() {
        Some("array") => list_in_words(schema, part),
        other => format!("{}{}", one_in_words(other), range_in_words(part)),
    }
}

fn one_in_words(name: Option<&str>) -> &'static str {
    match name {
        Some("number") => "a number",
        Some("integer") => "a whole number",
        Some("string") => "a text in quotes",
        Some("boolean") => "true or false",
        Some("object") => "a table",
        _ => "any value",
    }
}

/// " from 0 to 1", " greater than 0", " of at least 0"; nothing if any number will do.
fn range_in_words(part: &Value) -> String {
    let bound = |name: &str| part.get(name).filter(|bound| bound.is_number()).map(short_number);
    match (bound("minimum"), bound("exclusiveMinimum"), bound("maximum")) {
        (Some(least), None, Some(most)) => format!(" from {least} to {most}"),
        (_, Some(below), Some(most)) => format!(" greater than {below}, at most {most}"),
        (_, Some(below), None) => format!(" greater than {below}"),
        (Some(least), None, None) => format!(" of at least {least}"),
        (None, None, Some(most)) => format!(" of at most {most}"),
        (None, None, None) => String::new(),
    }
}

/// A number as messages show it: 0 and not 0.0.
fn short_number(number: &Value) -> String {
    number.as_f64().map_or_else(|| number.to_string(), |number| number.to_string())
}

/// "a list of 2 numbers", "a list of lists of 3 numbers", "a list of tables".
fn list_in_words(schema: &Value, part: &Value) -> String {
    let mut words = String::from("a list of ");
    let mut part = part;
    loop {
        let length = part["minItems"].as_u64().filter(|_| part["minItems"] == part["maxItems"]);
        words += &length.map_or_else(String::new, |length| format!("{length} "));
        part = resolved(schema, &part["items"]);
        if part["type"] != "array" {
            break;
        }
        words += "lists of ";
    }
    words + several_in_words(schema, part)
}

fn several_in_words(schema: &Value, part: &Value) -> &'static str {
    match part["type"].as_str() {
        _ if kinds(schema, part).is_some() => "kinds",
        Some("number") => "numbers",
        Some("integer") => "whole numbers",
        Some("string") => "texts",
        Some("boolean") => "truths",
        Some("object") => "tables",
        _ => "values",
    }
}

/// A JSON value as it is written inline in TOML.
pub(crate) fn as_toml(value: &Value) -> String {
    match value {
        Value::Array(entries) => format!("[{}]", entries.iter().map(as_toml).collect::<Vec<_>>().join(", ")),
        Value::Object(entries) if entries.is_empty() => "{}".into(),
        Value::Object(entries) => {
            let entries: Vec<String> =
                entries.iter().map(|(key, value)| format!("{key} = {}", as_toml(value))).collect();
            format!("{{ {} }}", entries.join(", "))
        }
        Value::String(text) => toml::Value::String(text.clone()).to_string(),
        other => other.to_string(),
    }
}

/// The first sentence of a description, on one line and without its full stop.
pub(crate) fn first_sentence(description: &str) -> String {
    let line = description.split_whitespace().collect::<Vec<_>>().join(" ");
    // a sentence ends where the next one begins with a capital: `Eq. (1)` does not end one
    let stops = line.match_indices(". ").map(|(at, _)| at);
    let end = stops.into_iter().find(|at| line.get(at + 2..).is_some_and(|rest| rest.starts_with(char::is_uppercase)));
    let sentence = end.and_then(|end| line.get(..end)).unwrap_or(&line);
    sentence.strip_suffix('.').unwrap_or(sentence).to_owned()
}
