//! A scenario to begin with: a shipped one, with what else could be stated beside it as comments.

use serde_json::Value;
use toml_edit::{DocumentMut, value};

use super::place::{at, entries, is_table_like, kinds, resolved};
use super::words::{as_toml, first_sentence};
use super::{FILES, wholes};
use crate::scenario::{self, Node};
use crate::tasks::TaskKind;

/// Column at which the remarks begin, and the letters that a line and a remark have room for.
const REMARK_COLUMN: usize = 40;
const LINE: usize = 120;
/// Stands for what has no default.
const YOURS: &str = "…";

/// The text of a new scenario; `file` is what it will be called.
///
/// # Errors
/// In words, if the shipped scenario that it is made of cannot be read.
pub(crate) fn scenario_text(kind: &TaskKind, file: &str) -> Result<String, String> {
    let example = kind.example();
    let broken = |reason: String| format!("{} is broken: {reason}", example.file.display());
    let schema = FILES.first().map_or(Value::Null, super::FileKind::schema);
    let (_, whole) = wholes(&schema).into_iter().find(|(name, _)| *name == Some(kind.name)).unwrap_or((None, &schema));
    let tree = Node::parse(&example).map_err(|problem| broken(problem.to_string()))?;
    let body = filled_in(&example.text, kind).map_err(broken)?;
    let (remarks, body) = body.split_at(body.find("\n[").map_or(0, |end| end + 1));
    let all = Optional { schema: &schema, whole, tree: &tree };
    Ok(format!(
        "{}{remarks}{}{}",
        heading(kind, file, &example.file.display().to_string()),
        all.beside(body),
        all.absent()
    ))
}

fn heading(kind: &TaskKind, file: &str, example: &str) -> String {
    let (name, summary) = (kind.name, kind.summary);
    let commands = [
        (format!("wield check {file}"), "find every mistake, run nothing"),
        (format!("wield run {file}"), "run it"),
        (format!("wield explain task.{name}"), "say what keys mean, here those of the task"),
    ];
    let width = commands.iter().map(|(command, _)| command.chars().count()).max().unwrap_or(0);
    let commands: String = commands.iter().map(|(command, what)| format!("#   {command:width$}  {what}\n")).collect();
    format!(
        "# A scenario of the kind `{name}`: {summary}.\n\
         # State its title and description, then change what is to differ.\n\
         #\n{commands}#\n\
         # A line such as `# key = 1.0` shows a key and what it is if it is not stated: take the mark away to change it.\n\
         # Where `{YOURS}` stands there is no such value. What follows is taken from {example}:\n#\n"
    )
}

/// The example with its own title and description taken out.
fn filled_in(text: &str, kind: &TaskKind) -> Result<String, String> {
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| error.to_string())?;
    let header = document.get_mut("scenario").and_then(|table| table.as_table_like_mut());
    let header = header.ok_or("it has no table [scenario]")?;
    for (key, text) in [("title", format!("My scenario of the kind {}", kind.name)), ("description", String::new())] {
        header.insert(key, value(text));
    }
    let remarks = [("title", "one line for lists and tables"), ("description", "a paragraph for readers")];
    for (key, remark) in remarks {
        if let Some(text) = header.get_mut(key).and_then(|item| item.as_value_mut()) {
            text.decor_mut().set_suffix(format!("  # yours: {remark}"));
        }
    }
    Ok(document.to_string())
}

/// What a scenario could state beside what its example does.
struct Optional<'a> {
    schema: &'a Value,
    /// The part of the schema that a whole file has to fit.
    whole: &'a Value,
    /// The example.
    tree: &'a Node,
}

impl Optional<'_> {
    /// The tables of the example, each followed by what else it could hold.
    fn beside(&self, body: &str) -> String {
        let mut text = String::new();
        let mut seen: Vec<&str> = Vec::new();
        for block in blocks(body) {
            text += block.trim_end();
            text += "\n";
            let header = block.lines().next().unwrap_or_default();
            let path = header.split(']').next().unwrap_or_default().trim_start_matches('[');
            // tables of a list are alike: what they could hold is said of the first
            if !seen.contains(&path) {
                text += &self.missing_in(path, header.starts_with("[["));
                seen.push(path);
            }
            text += "\n";
        }
        text
    }

    /// What the table at `path` could hold besides.
    fn missing_in(&self, path: &str, is_list: bool) -> String {
        let mut steps: Vec<String> = scenario::path(path);
        steps.extend(is_list.then(|| "0".to_owned()));
        let plain: Vec<&str> = steps.iter().map(String::as_str).collect();
        let Some(table) = at(self.schema, self.whole, &plain) else { return String::new() };
        let node = self.tree.at(&steps);
        let stated = |name: &str| node.is_some_and(|node| node.child(name).is_some());
        self.table(path, table, None, &stated)
    }

    /// The tables that the example does not have at all.
    fn absent(&self) -> String {
        let stated = |name: &str| self.tree.child(name).is_some();
        let absent = entries(self.schema, self.whole).into_iter().filter(|(name, _)| !stated(name));
        let tables: Vec<String> = absent.map(|(name, part)| self.entry("", name, part, part.get("default"))).collect();
        tables.join("").trim_start().to_owned()
    }

    /// The keys of a table that are not stated: first values, then tables. `shown` is its default as a whole.
    fn table(&self, path: &str, table: &Value, shown: Option<&Value>, stated: &dyn Fn(&str) -> bool) -> String {
        let missing: Vec<_> = entries(self.schema, table).into_iter().filter(|(name, _)| !stated(name)).collect();
        let (tables, values): (Vec<_>, Vec<_>) = missing.into_iter().partition(|(_, part)| self.stands_apart(part));
        let entry = |(name, part): (&str, &Value)| {
            let default = shown.and_then(|shown| shown.get(name)).or_else(|| self.default_of(part)).cloned();
            self.entry(path, name, part, default.as_ref())
        };
        values.into_iter().chain(tables).map(entry).collect()
    }

    /// Whether a key is written as a table with a header of its own.
    fn stands_apart(&self, part: &Value) -> bool {
        let is_text = self.default_of(part).is_some_and(|default| !default.is_object());
        is_table_like(self.schema, part) && !is_text
    }

    fn default_of<'a>(&'a self, part: &'a Value) -> Option<&'a Value> {
        part.get("default").or_else(|| resolved(self.schema, part).get("default"))
    }

    /// One key: a line, or the lines of a table.
    fn entry(&self, path: &str, name: &str, part: &Value, default: Option<&Value>) -> String {
        let meaning = part["description"].as_str().or_else(|| resolved(self.schema, part)["description"].as_str());
        let remark = first_sentence(meaning.unwrap_or_default());
        if !self.stands_apart(part) {
            let text = default.map_or_else(|| YOURS.to_owned(), as_toml);
            return line(&format!("{name} = {text}"), &remark);
        }
        let path = if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
        let Some(default) = default else {
            return format!("\n{}", line(&format!("[{path}] {YOURS}"), &remark));
        };
        match kinds(self.schema, part) {
            None => self.whole_table(&path, part, default, &remark),
            Some(kinds) => {
                let chosen = default.as_object().and_then(|default| default.iter().next());
                let kind =
                    chosen.and_then(|(name, _)| kinds.iter().find(|kind| kind.name == name && kind.content.is_some()));
                match (chosen, kind.and_then(|kind| kind.content)) {
                    (Some((kind, default)), Some(content)) => {
                        self.whole_table(&format!("{path}.{kind}"), content, default, &remark)
                    }
                    _ => format!("\n{}", line(&format!("[{path}] {YOURS}"), &remark)),
                }
            }
        }
    }

    fn whole_table(&self, path: &str, table: &Value, default: &Value, remark: &str) -> String {
        format!("\n{}{}", line(&format!("[{path}]"), remark), self.table(path, table, Some(default), &|_| false))
    }
}

/// A commented line with its remark, which is cut short where it would not fit.
fn line(text: &str, remark: &str) -> String {
    let left = format!("# {text:REMARK_COLUMN$}  # ");
    let room = LINE.saturating_sub(left.chars().count());
    format!("{}\n", format!("{left}{}", shortened(remark, room)).trim_end_matches(['#', ' ']))
}

/// The longest beginning of a remark that has room and ends before a clause; its first clause if none has.
fn shortened(remark: &str, room: usize) -> &str {
    let fits = |end: &usize| remark.get(..*end).is_some_and(|head| head.chars().count() <= room);
    let mut ends: Vec<usize> =
        ["; ", ": ", ", ", " ("].iter().flat_map(|mark| remark.match_indices(mark)).map(|(at, _)| at).collect();
    ends.push(remark.len());
    ends.sort_unstable();
    let end = ends.iter().rev().find(|end| fits(end)).or(ends.first());
    end.and_then(|end| remark.get(..*end)).unwrap_or(remark)
}

/// Cuts a text before each line that is the header of a table.
fn blocks(text: &str) -> Vec<&str> {
    let mut starts = Vec::new();
    let (mut at, mut in_text) = (0, false);
    for line in text.split_inclusive('\n') {
        if line.starts_with('[') && !in_text {
            starts.push(at);
        }
        in_text ^= line.matches("\"\"\"").count() % 2 == 1;
        at += line.len();
    }
    let ends = starts.iter().skip(1).copied().chain([text.len()]);
    starts.iter().zip(ends).filter_map(|(&start, end)| text.get(start..end)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_inside_texts_begin_no_block() {
        let text = "[a]\nx = \"\"\"\n[no]\n\"\"\"\n\n[[b]]\ny = 1\n";
        assert_eq!(blocks(text), ["[a]\nx = \"\"\"\n[no]\n\"\"\"\n\n", "[[b]]\ny = 1\n"]);
        assert!(blocks("x = 1\n").is_empty());
    }

    #[test]
    fn a_remark_is_cut_before_a_clause() {
        let remark = "Smallest distance, m; any if absent";
        assert_eq!(shortened(remark, 100), remark);
        assert_eq!(shortened(remark, 25), "Smallest distance, m");
        assert_eq!(shortened(remark, 3), "Smallest distance");
        assert_eq!(shortened("", 3), "");
    }

    #[test]
    fn a_line_has_no_remark_where_there_is_none() {
        assert_eq!(line("a = 1", ""), "# a = 1\n");
        assert!(line("a = 1", "One").starts_with("# a = 1 ") && line("a = 1", "One").ends_with("  # One\n"));
    }
}
