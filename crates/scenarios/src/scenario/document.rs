//! The TOML document as a tree that knows where each key and value stands, and refuses numbers that are not finite.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::source::Source;
use crate::diagnostic::Diagnostic;

/// Deepest nesting of tables and lists that is accepted; a scenario needs eight.
const DEEPEST: usize = 60;

/// A value with the byte ranges of its key and of itself.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    /// Byte range of the key (of the value itself for an entry of a list).
    pub key: Range<usize>,
    /// Byte range of the value; of the header for a table with a header.
    pub span: Range<usize>,
    /// The value.
    pub value: Value,
}

/// A TOML value.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    /// Text.
    Text(String),
    /// Whole number.
    Integer(i128),
    /// Number with a fraction.
    Float(f64),
    /// True or false.
    Boolean(bool),
    /// Date or time, of which a scenario has none.
    Date,
    /// List.
    List(Vec<Node>),
    /// Table.
    Table(BTreeMap<String, Node>),
}

/// Dotted path of a value; entries of a list are named by their index.
pub(crate) type Path = Vec<String>;

/// Splits a dotted path.
pub(crate) fn path(dotted: &str) -> Path {
    dotted.split('.').filter(|step| !step.is_empty()).map(str::to_owned).collect()
}

impl Node {
    /// Parses a source; on a syntax error there is no tree.
    pub fn parse(source: &Source) -> Result<Self, Box<Diagnostic>> {
        let table = DeTable::parse(&source.text).map_err(|error| Box::new(syntax(source, &error)))?;
        let value = convert_table(source, table.get_ref(), 0)?;
        Ok(Self { key: 0..0, span: 0..0, value })
    }

    /// The value under `step`: a key of a table or an index of a list.
    pub fn child(&self, step: &str) -> Option<&Self> {
        match &self.value {
            Value::Table(entries) => entries.get(step),
            Value::List(entries) => entries.get(step.parse::<usize>().ok()?),
            _ => None,
        }
    }

    fn child_mut(&mut self, step: &str) -> Option<&mut Self> {
        match &mut self.value {
            Value::Table(entries) => entries.get_mut(step),
            Value::List(entries) => entries.get_mut(step.parse::<usize>().ok()?),
            _ => None,
        }
    }

    /// The value at `path`.
    pub fn at(&self, path: &[String]) -> Option<&Self> {
        path.iter().try_fold(self, |node, step| node.child(step))
    }

    /// The value at `path`, or the nearest table or list around it.
    pub fn nearest(&self, path: &[String]) -> &Self {
        let mut node = self;
        for step in path {
            match node.child(step) {
                Some(child) => node = child,
                None => break,
            }
        }
        node
    }

    /// Removes the value at `path`, or the nearest one around it that exists; an entry of a list takes the list along.
    ///
    /// Returns the path of what was removed; `None` if only the whole document is left.
    pub fn remove(&mut self, path: &[String]) -> Option<Path> {
        let existing =
            (0..=path.len()).rev().find(|&length| path.get(..length).is_some_and(|head| self.at(head).is_some()))?;
        let mut path = path.get(..existing)?.to_vec();
        while let Some(last) = path.pop() {
            let parent = path.iter().try_fold(&mut *self, |node, step| node.child_mut(step))?;
            if let Value::Table(entries) = &mut parent.value {
                entries.remove(&last);
                path.push(last);
                return Some(path);
            }
        }
        None
    }

    /// The numbers that are not finite: path and text as written.
    pub fn not_finite(&self) -> Vec<(Path, f64)> {
        let mut found = Vec::new();
        self.collect_not_finite(&mut Vec::new(), &mut found);
        found
    }

    fn collect_not_finite(&self, path: &mut Path, found: &mut Vec<(Path, f64)>) {
        match &self.value {
            Value::Float(number) if !number.is_finite() => found.push((path.clone(), *number)),
            Value::Table(entries) => {
                for (key, node) in entries {
                    path.push(key.clone());
                    node.collect_not_finite(path, found);
                    path.pop();
                }
            }
            Value::List(entries) => {
                for (index, node) in entries.iter().enumerate() {
                    path.push(index.to_string());
                    node.collect_not_finite(path, found);
                    path.pop();
                }
            }
            _ => {}
        }
    }
}

fn convert_table(source: &Source, table: &DeTable<'_>, depth: usize) -> Result<Value, Box<Diagnostic>> {
    let entry = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
        let name = AsRef::<str>::as_ref(key.get_ref()).to_owned();
        Ok((name, convert(source, key.span(), value, depth + 1)?))
    };
    Ok(Value::Table(table.iter().map(entry).collect::<Result<_, Box<Diagnostic>>>()?))
}

fn convert(
    source: &Source,
    key: Range<usize>,
    value: &Spanned<DeValue<'_>>,
    depth: usize,
) -> Result<Node, Box<Diagnostic>> {
    let span = value.span();
    if depth > DEEPEST {
        let problem = source.problem(span, "tables and lists are nested too deeply");
        return Err(Box::new(problem.expected(format!("at most {DEEPEST} levels"))));
    }
    let converted = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(number) => match i128::from_str_radix(number.as_str(), number.radix()) {
            Ok(number) => Value::Integer(number),
            Err(_) => {
                let problem = source.problem(span, "the whole number is too large");
                return Err(Box::new(problem.found(number.to_string())));
            }
        },
        // a float that overflows parses to infinity, and is refused like one
        DeValue::Float(number) => Value::Float(number.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(truth) => Value::Boolean(*truth),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Table(table) => convert_table(source, table, depth)?,
        DeValue::Array(entries) => {
            let entries = entries.iter().map(|entry| convert(source, entry.span(), entry, depth + 1));
            Value::List(entries.collect::<Result<_, _>>()?)
        }
    };
    Ok(Node { key, span, value: converted })
}

fn syntax(source: &Source, error: &toml::de::Error) -> Diagnostic {
    let span = error.span().unwrap_or(0..0);
    source.problem(span, "this is not valid TOML").found(error.message().trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> Source {
        Source::new("a.toml", text)
    }

    fn tree(text: &str) -> Node {
        Node::parse(&source(text)).unwrap()
    }

    #[test]
    fn keys_and_values_know_their_place() {
        let text = "[a.b]\nc = [1.0, { d = 2 }]\n";
        let tree = tree(text);
        let node = tree.at(&path("a.b.c.1.d")).unwrap();
        assert_eq!((&text[node.key.clone()], &text[node.span.clone()]), ("d", "2"));
        assert_eq!(&text[tree.at(&path("a.b")).unwrap().span.clone()], "[a.b]");
        assert_eq!(&text[tree.nearest(&path("a.b.x.y")).span.clone()], "[a.b]");
    }

    #[test]
    fn removing_an_entry_of_a_list_takes_the_list() {
        let mut tree = tree("[a]\nb = [1, 2]\nc = 3\n");
        assert_eq!(tree.remove(&path("a.b.1")), Some(path("a.b")));
        assert_eq!(tree.remove(&path("a.c.x")), Some(path("a.c")));
        assert_eq!(tree.remove(&path("z")), None);
    }

    #[test]
    fn every_number_that_is_not_finite_is_found() {
        let found = tree("a = nan\nb = [1.0, -inf]\n[c]\nd = { e = 1e999 }\nf = 1.0\n").not_finite();
        assert_eq!(found.iter().map(|(path, _)| path.join(".")).collect::<Vec<_>>(), ["a", "b.1", "c.d.e"]);
    }

    #[test]
    fn endless_nesting_is_refused_not_followed() {
        let dotted = format!("{} = 1", vec!["a"; 20_000].join("."));
        let lists = format!("a = {}{}", "[".repeat(20_000), "]".repeat(20_000));
        for text in [dotted, lists] {
            assert!(Node::parse(&source(&text)).is_err());
        }
    }
}
