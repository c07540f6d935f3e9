//! Flaws of a document in words: place, key, what was expected, what was probably meant.

use super::decode::{Flaw, FlawKind};
use super::document::{Node, Path, Value};
use super::source::Source;
use super::units::mistaken_unit;
use crate::diagnostic::Diagnostic;
use crate::suggest::{did_you_mean, listed, nearest};

/// A document, its source, and a document of the same type that shows how keys are written.
#[derive(Clone, Copy)]
pub(crate) struct Context<'a> {
    /// The text.
    pub source: &'a Source,
    /// The document as it was read.
    pub tree: &'a Node,
    /// A valid document of the same type.
    pub example: &'a Source,
}

/// A problem with the keys that must not be complained about once more: they are missing because of this problem.
pub(crate) struct Explained {
    /// The problem.
    pub diagnostic: Diagnostic,
    /// Path of what has to be taken out of the document to go on reading.
    pub culprit: Path,
    /// Path of a key that was probably meant by an unknown one.
    pub excused: Option<Path>,
}

impl Context<'_> {
    /// Explains a flaw.
    pub fn explain(&self, flaw: &Flaw) -> Explained {
        let path = flaw.path();
        let plain = |diagnostic| Explained { diagnostic, culprit: path.clone(), excused: None };
        match &flaw.kind {
            FlawKind::UnknownKey { key, known } => self.unknown_key(&path, key, known),
            FlawKind::UnknownVariant { found, known } => plain(self.unknown_variant(&path, found, known)),
            FlawKind::VariantCount { found, known } => plain(self.variant_count(&path, found, known)),
            FlawKind::MissingKey { key } => plain(self.missing_key(&path, key)),
            FlawKind::WrongType { found, expected } => plain(self.wrong_type(&path, found, expected)),
            FlawKind::WrongLength { found, expected } => {
                let found = format!("a list of {found} values");
                plain(self.problem_at_value(&path, bad_value(&path)).found(found).expected(expected))
            }
            FlawKind::Other(reason) => plain(self.problem_at_value(&path, bad_value(&path)).found(reason)),
        }
    }

    /// A problem at the value of `path`, or at the nearest table around it if the key is not in the file.
    pub fn problem_at_value(&self, path: &[String], title: impl Into<String>) -> Diagnostic {
        self.source.problem(self.tree.nearest(path).span.clone(), title)
    }

    fn unknown_key(&self, table: &Path, key: &str, known: &'static [&'static str]) -> Explained {
        let culprit = joined(table, key);
        let node = self.tree.nearest(&culprit);
        let unit = mistaken_unit(key, node, known);
        let meant = unit.as_ref().map(|unit| unit.key).or_else(|| nearest(key, known));
        let help = unit.map(|unit| unit.help).or_else(|| did_you_mean(key, known));
        let title = format!("unknown key `{}` in {}", key.escape_debug(), table_name(table));
        let expected = if known.is_empty() { "no keys here".into() } else { one_of(known) };
        let diagnostic = self.source.problem(node.key.clone(), title).expected(expected).help(help);
        Explained { diagnostic, excused: meant.map(|meant| joined(table, meant)), culprit }
    }

    fn unknown_variant(&self, path: &Path, found: &str, known: &[&str]) -> Diagnostic {
        let node = self.tree.nearest(path);
        let span = match &node.value {
            Value::Table(entries) => entries.get(found).map_or(node.span.clone(), |entry| entry.key.clone()),
            _ => node.span.clone(),
        };
        let title = format!("unknown kind `{}` of {}", found.escape_debug(), key_name(path));
        self.source.problem(span, title).expected(one_of(known)).help(did_you_mean(found, known))
    }

    fn variant_count(&self, path: &Path, found: &[String], known: &[&str]) -> Diagnostic {
        let title = format!("{} needs exactly one kind", key_name(path));
        let example = known.first().map(|kind| format!("write for example [{}.{kind}]", path.join(".")));
        self.problem_at_value(path, title).found(listed(found)).expected(one_of(known)).help(example)
    }

    fn missing_key(&self, table: &Path, key: &str) -> Diagnostic {
        let path = joined(table, key);
        let shown = self.shown_in_example(&path);
        let is_table = shown.as_ref().is_some_and(|example| example.starts_with('['));
        let (what, help) = if is_table && table.is_empty() {
            (format!("missing table [{key}]"), format!("add one like this:\n{}", shown.unwrap_or_default()))
        } else {
            let value = shown.unwrap_or_else(|| invented(key).to_owned());
            (format!("missing key `{key}` in {}", table_name(table)), format!("write for example: {key} = {value}"))
        };
        self.problem_at_value(table, what).expected(format!("`{key}`")).help([help])
    }

    /// The value that the example has at `path`, as it is written there; for a table with a header its lines.
    fn shown_in_example(&self, path: &[String]) -> Option<String> {
        let tree = Node::parse(self.example).ok()?;
        // entries of a list are alike: show the first
        let path: Path =
            path.iter().map(|step| if step.parse::<usize>().is_ok() { "0".into() } else { step.clone() }).collect();
        let node = tree.at(&path)?;
        let text = self.example.text.get(node.span.clone())?;
        if text.starts_with('[') && matches!(node.value, Value::Table(_)) {
            let rest = self.example.text.get(node.span.start..)?;
            let lines = rest.lines().take_while(|line| !line.trim().is_empty());
            return Some(without_long_texts(lines.map(without_comment)).join("\n"));
        }
        (!matches!(node.value, Value::Table(_)) || text.starts_with('{')).then(|| text.to_owned())
    }

    fn wrong_type(&self, path: &Path, found: &str, expected: &str) -> Diagnostic {
        let help = match &self.tree.nearest(path).value {
            Value::Text(text) if expected.contains("number") && text.trim().parse::<f64>().is_ok() => {
                Some(format!("write the number without quotes: {}", text.trim()))
            }
            Value::Integer(number) if expected.contains("text") => Some(format!("write it in quotes: \"{number}\"")),
            _ => None,
        };
        self.problem_at_value(path, bad_value(path)).found(found).expected(expected).help(help)
    }
}

/// Title of a problem with a value.
pub(crate) fn bad_value(path: &[String]) -> String {
    format!("bad value for {}", key_name(path))
}

/// "`key` in [table]".
pub(crate) fn key_name(path: &[String]) -> String {
    match path.split_last() {
        Some((last, table)) if last.parse::<usize>().is_err() => {
            let inside = if table.is_empty() { String::new() } else { format!(" in {}", table_name(table)) };
            format!("`{}`{inside}", last.escape_debug())
        }
        Some((last, list)) => format!("entry {} of {}", ordinal(last), key_name(list)),
        None => "the file".into(),
    }
}

/// "[table]", "entry 2 of [[list]]", "`shape.disc` of entry 2 of [[list]]" or "the file".
fn table_name(path: &[String]) -> String {
    let Some(index) = path.iter().rposition(|step| step.parse::<usize>().is_ok()) else {
        return if path.is_empty() { "the file".into() } else { format!("[{}]", path.join(".").escape_debug()) };
    };
    let (list, rest) = path.split_at(index);
    let entry =
        format!("entry {} of [[{}]]", rest.first().map_or_else(String::new, |step| ordinal(step)), list.join("."));
    match rest.get(1..) {
        Some(rest) if !rest.is_empty() => format!("`{}` of {entry}", rest.join(".")),
        _ => entry,
    }
}

/// An index as people count.
fn ordinal(index: &str) -> String {
    index.parse::<usize>().map_or_else(|_| index.to_owned(), |index| (index + 1).to_string())
}

fn one_of(known: &[&str]) -> String {
    if known.len() == 1 { listed(known) } else { format!("one of {}", listed(known)) }
}

fn joined(table: &[String], key: &str) -> Path {
    table.iter().cloned().chain([key.to_owned()]).collect()
}

/// Leaves out the keys whose texts run over several lines.
fn without_long_texts<'a>(lines: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut inside = false;
    let outside = |line: &&str| {
        let before = inside;
        inside ^= line.matches("\"\"\"").count() % 2 == 1;
        !before && !inside
    };
    lines.filter(outside).collect()
}

fn without_comment(line: &str) -> &str {
    line.split(" #").next().unwrap_or(line).trim_end()
}

/// A plausible value for a key that the example does not have, judged by the key's unit.
fn invented(key: &str) -> &'static str {
    match key {
        "vertices_m" => "[[0.0, 0.0], [0.02, 0.0], [0.0, 0.02]]",
        "assets" => "[\"first\", \"second\"]",
        "count" => "5",
        _ if key.ends_with("_m") => "0.01",
        _ if key.contains('_') => "1.0",
        _ => "\"…\"",
    }
}
