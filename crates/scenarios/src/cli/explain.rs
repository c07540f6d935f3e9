//! `wield explain`: what a key of a scenario or an asset means, its type, unit and default, and where it is shown.

use std::path::Path;

use serde_json::Value;

use super::{Exit, assets_for, say, say_error};
use crate::assets::Assets;
use crate::scenario::unit_of;
use crate::schema::{Answer, Book, Key, answers, as_toml, books, first_sentence, shown};

pub const AFTER_HELP: &str = "\
A key is a dotted path, or the end of one: all keys that end so are told. After a colon a path goes on in an asset, as
in changes: both `tool:family.l.arm_m` and `tool.asset:family.l.arm_m` are a key of tool files. Entries of lists are
numbers.

Examples:
  wield explain                              what files hold
  wield explain controller                   a table and what is inside
  wield explain task.push.transfer
  wield explain clearance_m                  all keys of this name
  wield explain tool:family.l.arm_m          a key of a file in assets/tools

Exit codes: 0 success, 2 there is no such key.";

/// Options of `wield explain`.
#[derive(Debug, clap::Args)]
pub struct ExplainArguments {
    /// Keys; without any, the tables of all files are listed
    #[arg(value_name = "KEY")]
    keys: Vec<String>,
}

/// More keys than this are listed in one line each.
const MOST_IN_FULL: usize = 4;
/// Column at which lines of a description are broken.
const WIDTH: usize = 100;
/// A longer default is told only where the key itself is asked for.
const LONGEST_DEFAULT: usize = 28;

/// Tells of every key that is asked for; one that there is not is bad input.
pub fn execute(arguments: &ExplainArguments, assets: Option<&Path>) -> Exit {
    let (books, assets) = (books(), assets_for(assets, None));
    if arguments.keys.is_empty() {
        return say(&overview(&books));
    }
    let told = arguments.keys.iter().map(|question| match answers(&books, question) {
        Ok(found) => say(&told(&found, &assets)),
        Err(reason) => {
            say_error(&format!("explain: {reason}"));
            Exit::BadInput
        }
    });
    told.fold(Exit::Success, |worst, exit| if exit == Exit::Success { worst } else { exit })
}

/// The outermost keys of every kind of file.
fn overview(books: &[Book]) -> String {
    let section = |book: &Book| {
        let outermost: Vec<&Key> = book.keys.iter().filter(|key| key.path.len() == 1).collect();
        let every =
            outermost.iter().map(|key| key.tasks.as_slice()).max_by_key(|tasks| tasks.len()).unwrap_or_default();
        format!("{}: {}\n{}", book.kind.name, book.kind.summary, table(&outermost, every))
    };
    books.iter().map(section).collect::<Vec<_>>().join("\n")
}

fn told(found: &[Answer<'_>], assets: &Assets) -> String {
    if found.len() > MOST_IN_FULL {
        let name = |&(book, key): &Answer<'_>| format!("{}{}", prefix(book), key.dotted());
        let width = found.iter().map(|answer| name(answer).chars().count()).max().unwrap_or(0);
        let line = |answer: &Answer<'_>| {
            format!("{:width$}  {}{}\n", name(answer), first_sentence(&answer.1.description), tasks(answer.1))
        };
        return found.iter().map(line).collect();
    }
    found.iter().map(|answer| in_full(*answer, assets)).collect::<Vec<_>>().join("\n")
}

/// What goes before a path to tell keys of assets from those of scenarios.
fn prefix(book: &Book) -> String {
    if book.kind.name == "scenario" { String::new() } else { format!("{}:", book.kind.name) }
}

fn tasks(key: &Key) -> String {
    if key.tasks.is_empty() { String::new() } else { format!(" ({})", key.tasks.join(", ")) }
}

fn in_full((book, key): Answer<'_>, assets: &Assets) -> String {
    let mut lines = vec![format!("{}{}", prefix(book), key.dotted())];
    lines.extend(wrapped(&key.description).into_iter().map(|line| format!("  {line}")));
    let mut fact = |name: &str, text: String| lines.push(format!("  {name:<8} {text}"));
    fact("takes", format!("{}{}", key.takes, key.path.last().and_then(|name| unit(name)).unwrap_or_default()));
    if let Some(folder) = &key.asset {
        fact("names", format!("a file in {folder} of the assets, without its ending: `wield list {folder}`"));
    }
    match (&key.default, key.needed) {
        _ if key.is_kind => {}
        (Some(default), _) => fact("default", as_toml(default)),
        (None, true) => fact("default", "none: it has to be stated".into()),
        (None, false) => fact("default", "none: it may be left out".into()),
    }
    match key.tasks.as_slice() {
        [] => fact("in", format!("files in {}", book.kind.folder)),
        tasks => fact("in", format!("scenarios of the kind {}", tasks.join(", "))),
    }
    if let Some(shown) = shown(book.kind, key, assets) {
        fact("shown", format!("{}:{}: {}", shown.file.display(), shown.line, shown.text));
    }
    if !key.choices.is_empty() {
        lines.push("  a text of these:".into());
        let width = key.choices.iter().map(|(name, _)| name.chars().count() + 2).max().unwrap_or(0);
        let line = |(name, meaning): &(String, String)| {
            format!("    {:width$}  {}", format!("{name:?}"), first_sentence(meaning)).trim_end().to_owned()
        };
        lines.extend(key.choices.iter().map(line));
    }
    let inside: Vec<&Key> = book.inside(key).collect();
    if inside.is_empty() {
        return format!("{}\n", lines.join("\n"));
    }
    format!("{}\n  holds:\n{}", lines.join("\n"), table(&inside, &key.tasks))
}

/// ", in meters" for a key whose suffix says so.
fn unit(name: &str) -> Option<String> {
    let unit = unit_of(name)?;
    Some(if unit == "1/s" { ", per second".into() } else { format!(", in {unit}") })
}

/// One line for each key: its last step, default, meaning, and the tasks that have it if those are not `every` one.
fn table(keys: &[&Key], every: &[&str]) -> String {
    let name = |key: &Key| key.path.last().cloned().unwrap_or_default();
    let default = |key: &Key| match &key.default {
        _ if key.is_kind => "kind".to_owned(),
        _ if key.needed => "needed".to_owned(),
        Some(Value::Object(_)) => "table".to_owned(),
        Some(default) => short(as_toml(default)),
        None => "-".to_owned(),
    };
    let width = |text: &dyn Fn(&Key) -> String| keys.iter().map(|key| text(key).chars().count()).max().unwrap_or(0);
    let (names, defaults) = (width(&name), width(&default));
    let line = |key: &&Key| {
        let tasks = if key.tasks == every { String::new() } else { tasks(key) };
        let meaning = first_sentence(&key.description);
        format!("    {:names$}  {:defaults$}  {meaning}{tasks}\n", name(key), default(key))
    };
    keys.iter().map(line).collect()
}

/// A default that is short enough for a table.
fn short(default: String) -> String {
    if default.chars().count() <= LONGEST_DEFAULT { default } else { "…".into() }
}

/// A text in lines of at most [`WIDTH`] letters.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= WIDTH => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
