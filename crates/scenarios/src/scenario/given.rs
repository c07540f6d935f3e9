//! Where a place in a changed text comes from: the file as its user sees it, or one of the changes.
//!
//! A scenario is read after its changes were put into its text, so places of problems are places in a text that nobody has
//! seen. They are led back change by change: what lies inside a value that a change put there is blamed on that change, any
//! other place is where it was before.

use std::ops::Range;

use super::changes::{self, Change};
use super::document::{Node, Value};
use super::source::Source;

/// The changes that made a text out of another one.
#[derive(Clone, Debug)]
pub(crate) struct Given {
    before: Source,
    /// Each change with the words by which its user knows it: `push.toml --set object.mass_kg=-1`.
    changes: Vec<(Change, String)>,
}

/// Where a place comes from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Origin {
    /// A change, in the words by which its user knows it.
    Change(String),
    /// A byte range of the text before all changes.
    Before(Range<usize>),
}

impl Given {
    pub fn new(before: Source, changes: Vec<(Change, String)>) -> Self {
        Self { before, changes }
    }

    /// The text before all changes.
    pub fn before(&self) -> &Source {
        &self.before
    }

    /// The words for the change of a key, the last one if there are several.
    pub fn words_for(&self, key: &str) -> Option<&str> {
        self.changes.iter().rev().find(|(change, _)| change.key == key).map(|(_, words)| words.as_str())
    }

    /// Where a byte range of the changed text comes from; `None` if the changes cannot be made one by one.
    pub fn origin(&self, mut span: Range<usize>) -> Option<Origin> {
        let mut texts = vec![Source::new(&self.before.file, &*self.before.text)];
        for (change, _) in &self.changes {
            let next = changes::with(texts.last()?, std::slice::from_ref(change)).ok()?;
            texts.push(next);
        }
        for (index, (change, words)) in self.changes.iter().enumerate().rev() {
            let (old, new) = (texts.get(index)?, texts.get(index + 1)?);
            if put_there(old, new, change).is_some_and(|node| covers(&node, &span)) {
                return Some(Origin::Change(words.clone()));
            }
            span = led_back(&old.text, &new.text, span);
        }
        Some(Origin::Before(span))
    }
}

/// What a change put into a text: the value of its key, or the outermost table that was made on the way to it.
fn put_there(old: &Source, new: &Source, change: &Change) -> Option<Node> {
    let (old, new) = (Node::parse(old).ok()?, Node::parse(new).ok()?);
    let mut path: Vec<String> = changes::path_in_text(&change.key).iter().map(|step| (*step).to_owned()).collect();
    let table_with_asset = |node: &Node| matches!(node.value, Value::Table(_)) && node.child("asset").is_some();
    if matches!(change.value, toml::Value::String(_)) && old.at(&path).is_some_and(table_with_asset) {
        path.push("asset".into());
    }
    let existing = (0..=path.len()).rev().find(|&length| path.get(..length).is_some_and(|head| old.at(head).is_some()));
    let length = (existing.unwrap_or(0) + 1).min(path.len());
    new.at(path.get(..length)?).cloned()
}

/// Whether a range lies in the key or the value of a node, or in those of what is inside.
fn covers(node: &Node, span: &Range<usize>) -> bool {
    let inside = |outer: &Range<usize>| outer.start <= span.start && span.end <= outer.end;
    let mut children: Box<dyn Iterator<Item = &Node>> = match &node.value {
        Value::Table(entries) => Box::new(entries.values()),
        Value::List(entries) => Box::new(entries.iter()),
        _ => Box::new(std::iter::empty()),
    };
    inside(&node.key) || inside(&node.span) || children.any(|child| covers(child, span))
}

/// The range of `old` that became `span` of `new`: both are alike up to somewhere, and again from somewhere on.
fn led_back(old: &str, new: &str, span: Range<usize>) -> Range<usize> {
    let head = old.bytes().zip(new.bytes()).take_while(|(a, b)| a == b).count();
    let room = old.len().min(new.len()) - head;
    let tail = old.bytes().rev().zip(new.bytes().rev()).take(room).take_while(|(a, b)| a == b).count();
    let back = |at: usize, between: usize| match at {
        at if at <= head => at,
        at if at >= new.len() - tail => at + old.len() - new.len(),
        _ => between,
    };
    let start = back(span.start, head);
    start..back(span.end, old.len() - tail).max(start)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# head\n[a]\nx = 1\ny = 2\n[tool]\nasset = \"stick\"\n[kind]\nk = \"plain\"\n[b]\nz = 3\n";

    /// Where each occurrence of `part` in the changed text comes from.
    fn origin(changes: &[&str], part: &str) -> Origin {
        let before = Source::new("a.toml", TEXT);
        let changes: Vec<Change> = changes.iter().map(|text| text.parse().unwrap()).collect();
        let new = changes::with(&before, &changes).unwrap();
        let start = new.text.find(part).unwrap_or_else(|| panic!("{part} is not in {}", new.text));
        let words = changes.into_iter().map(|change| (change.clone(), change.to_string())).collect();
        Given::new(before, words).origin(start..start + part.len()).unwrap()
    }

    fn before(part: &str) -> Origin {
        let start = TEXT.find(part).unwrap();
        Origin::Before(start..start + part.len())
    }

    #[test]
    fn a_value_that_a_change_put_there_is_blamed_on_it() {
        assert_eq!(origin(&["a.x=-17"], "-17"), Origin::Change("a.x = -17".into()));
        assert_eq!(origin(&["a.x=[1, 7]"], "7"), Origin::Change("a.x = [1, 7]".into()));
        assert_eq!(origin(&["a.new=5"], "new"), Origin::Change("a.new = 5".into()));
        assert_eq!(origin(&["c.d.e=5"], "c.d"), Origin::Change("c.d.e = 5".into()));
        assert_eq!(origin(&["tool=l"], "\"l\""), Origin::Change("tool = \"l\"".into()));
        assert_eq!(origin(&["kind.k.plain.w=8"], "w"), Origin::Change("kind.k.plain.w = 8".into()));
        assert_eq!(origin(&["tool:mass=1"], "\"tool:mass\""), Origin::Change("tool:mass = 1".into()));
    }

    #[test]
    fn of_two_changes_of_a_key_the_last_one_is_to_blame() {
        assert_eq!(origin(&["a.x=5", "b.z=9", "a.x=-17"], "-17"), Origin::Change("a.x = -17".into()));
        assert_eq!(origin(&["a.x=[5, 6]", "a.x.1=-17"], "5"), Origin::Change("a.x = [5, 6]".into()));
    }

    #[test]
    fn any_other_place_is_where_it_was() {
        let long = "a.x=\"a text that is longer than what stood there\"";
        for part in ["# head", "[a]", "y = 2", "\"plain\"", "[b]", "z = 3"] {
            assert_eq!(origin(&[long, "a.new=1", "c.d.e=5"], part), before(part), "{part}");
        }
        assert_eq!(origin(&["tool=l"], "[tool]"), before("[tool]"));
    }
}
