//! All keys that a schema knows, each with its path, meaning, type and default.

use serde_json::Value;

use super::place::{entries, kinds, resolved};
use super::wholes;
use super::words::type_in_words;

/// A scenario needs eight levels of tables; a schema that led back to itself would have no end.
const DEEPEST: usize = 16;
/// The step of a path that stands for the first entry of a list.
const FIRST: &str = "0";
/// The step of a path that stands for any name.
pub(super) const ANY_NAME: &str = "NAME";

/// A key of a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Key {
    /// Steps of its path: a list's first entry is `0`, a name that is free is `NAME`.
    pub path: Vec<String>,
    /// What it means.
    pub description: String,
    /// What its value has to be, in words.
    pub takes: String,
    /// What it is if it is not stated; `None` if there is nothing then.
    pub default: Option<Value>,
    /// Whether the table around it needs it.
    pub needed: bool,
    /// Whether it is the name of a kind, whose value are its options.
    pub is_kind: bool,
    /// Kinds that are named by a bare text: name and meaning.
    pub choices: Vec<(String, String)>,
    /// Folder of the assets that its value names a file of.
    pub asset: Option<String>,
    /// Kinds of tasks whose files have it; none if files do not differ so.
    pub tasks: Vec<&'static str>,
}

impl Key {
    /// The path as people write it.
    pub fn dotted(&self) -> String {
        self.path.join(".")
    }

    /// Whether a written path means this key, entries of lists and free names being alike.
    pub fn is_at(&self, written: &[&str]) -> bool {
        self.path.len() == written.len() && self.is_alike_from_its_end(written)
    }

    /// Whether a written path is the end of that of this key, whose last step it has to name.
    pub fn ends_in(&self, written: &[&str]) -> bool {
        self.path.last().map(String::as_str) == written.last().copied() && self.is_alike_from_its_end(written)
    }

    fn is_alike_from_its_end(&self, written: &[&str]) -> bool {
        let Some(from) = self.path.len().checked_sub(written.len()) else { return false };
        self.path.iter().skip(from).zip(written).all(|(own, written)| alike(own, written))
    }

    /// Whether this key stands directly in the table of `other`, or in the tables that `other` is a list of.
    pub fn is_directly_in(&self, other: &Self) -> bool {
        let Some((_, table)) = self.path.split_last() else { return false };
        let entry = table.split_last().filter(|(step, _)| *step == FIRST);
        table == other.path || entry.is_some_and(|(_, list)| list == other.path)
    }

    /// Whether two kinds of tasks have this key with the same path and meaning.
    fn says_the_same_as(&self, other: &Self) -> bool {
        let told =
            |key: &Self| (key.needed, key.is_kind, key.takes.clone(), key.description.clone(), key.default.clone());
        self.path == other.path && told(self) == told(other)
    }
}

fn alike(own: &str, written: &str) -> bool {
    own == written || own == ANY_NAME || (own == FIRST && written.parse::<usize>().is_ok())
}

/// All keys of a schema; what several kinds of tasks have in common is there once.
pub(crate) fn keys(schema: &Value) -> Vec<Key> {
    let mut all: Vec<Key> = Vec::new();
    for (task, whole) in wholes(schema) {
        let mut found = Vec::new();
        collect(schema, whole, &[], &mut found);
        for key in found {
            match all.iter_mut().find(|other| other.says_the_same_as(&key)) {
                Some(other) => other.tasks.extend(task),
                None => all.push(Key { tasks: task.into_iter().collect(), ..key }),
            }
        }
    }
    all
}

fn collect(schema: &Value, part: &Value, path: &[String], found: &mut Vec<Key>) {
    if path.len() > DEEPEST {
        return;
    }
    let table = resolved(schema, part);
    let required: Vec<&str> = table["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    for (name, entry) in entries(schema, table) {
        let needed = required.contains(&name);
        add(schema, entry, joined(path, name), Key { needed, ..described(schema, entry) }, found);
    }
    for kind in kinds(schema, table).into_iter().flatten() {
        if let Some(content) = kind.content {
            let own = described(schema, content);
            let description =
                if kind.description.is_empty() { own.description.clone() } else { kind.description.into() };
            let key = Key { is_kind: true, description, default: None, ..own };
            add(schema, content, joined(path, kind.name), key, found);
        }
    }
    if let Some(entry) = table.get("items") {
        collect(schema, entry, &joined(path, FIRST), found);
    }
    if let Some(entry) = table.get("additionalProperties").filter(|entry| entry.is_object()) {
        add(schema, entry, joined(path, ANY_NAME), described(schema, entry), found);
    }
}

fn add(schema: &Value, part: &Value, path: Vec<String>, key: Key, found: &mut Vec<Key>) {
    found.push(Key { path: path.clone(), ..key });
    collect(schema, part, &path, found);
}

/// A key without path, as its schema describes it; what stands beside a reference goes before what that leads to.
fn described(schema: &Value, part: &Value) -> Key {
    let target = resolved(schema, part);
    let text = |name: &str| part[name].as_str().or_else(|| target[name].as_str()).map(str::to_owned);
    let bare = kinds(schema, part).into_iter().flatten().filter(|kind| kind.content.is_none());
    Key {
        path: Vec::new(),
        description: text("description").unwrap_or_default(),
        takes: type_in_words(schema, part),
        default: part.get("default").or_else(|| target.get("default")).cloned(),
        needed: false,
        is_kind: false,
        choices: bare.map(|kind| (kind.name.to_owned(), kind.description.to_owned())).collect(),
        asset: text("x-asset"),
        tasks: Vec::new(),
    }
}

fn joined(path: &[String], step: &str) -> Vec<String> {
    path.iter().cloned().chain([step.to_owned()]).collect()
}
