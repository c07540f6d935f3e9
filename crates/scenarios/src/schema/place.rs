//! Moving through a schema: references, tables, kinds, entries of lists.

use serde_json::Value;

/// What a reference leads to; any other schema itself.
pub(super) fn resolved<'a>(schema: &'a Value, part: &'a Value) -> &'a Value {
    let named = part["$ref"].as_str().and_then(|path| path.strip_prefix('#')).and_then(|path| schema.pointer(path));
    named.unwrap_or(part)
}

/// The keys of a table and their schemas; none if `part` is no table with fixed keys.
pub(super) fn entries<'a>(schema: &'a Value, part: &'a Value) -> Vec<(&'a str, &'a Value)> {
    let properties = resolved(schema, part)["properties"].as_object();
    properties.into_iter().flatten().map(|(name, entry)| (name.as_str(), entry)).collect()
}

/// One of the kinds between which a value chooses.
pub(super) struct Kind<'a> {
    /// Its name.
    pub name: &'a str,
    /// What is said about it.
    pub description: &'a str,
    /// Its options; `None` if a bare text names it.
    pub content: Option<&'a Value>,
}

/// The kinds between which a value chooses; one that may be named with and without options is there twice. `None` for a
/// value of another type.
pub(super) fn kinds<'a>(schema: &'a Value, part: &'a Value) -> Option<Vec<Kind<'a>>> {
    let part = resolved(schema, part);
    if let Some(names) = part["enum"].as_array() {
        let names = names.iter().filter_map(Value::as_str);
        return Some(names.map(|name| Kind { name, description: "", content: None }).collect());
    }
    let choices = part["oneOf"].as_array()?.iter();
    Some(choices.flat_map(choice).collect())
}

fn choice(choice: &Value) -> Vec<Kind<'_>> {
    let description = choice["description"].as_str().unwrap_or_default();
    if let Some(name) = choice["const"].as_str() {
        return vec![Kind { name, description, content: None }];
    }
    let names = choice["enum"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let bare = names.map(|name| Kind { name, description, content: None });
    let tables = choice["properties"].as_object().into_iter().flatten();
    bare.chain(tables.map(|(name, content)| Kind { name, description, content: Some(content) })).collect()
}

/// The schema of what stands at `path` below `part`; entries of lists have any index.
pub(super) fn at<'a>(schema: &'a Value, part: &'a Value, path: &[&str]) -> Option<&'a Value> {
    path.iter().try_fold(part, |part, step| {
        let part = resolved(schema, part);
        let key = part["properties"].get(*step);
        let kind =
            || kinds(schema, part)?.into_iter().find(|kind| kind.name == *step && kind.content.is_some())?.content;
        let entry = || part.get("items").filter(|_| step.parse::<usize>().is_ok());
        key.or_else(kind).or_else(entry)
    })
}

/// Whether a value is a table with keys of its own, or a kind that may have options.
pub(super) fn is_table_like(schema: &Value, part: &Value) -> bool {
    let with_options = |kinds: Vec<Kind<'_>>| kinds.iter().any(|kind| kind.content.is_some());
    !entries(schema, part).is_empty() || kinds(schema, part).is_some_and(with_options)
}
