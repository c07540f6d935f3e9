//! Learned skills as a file: its format, written by `wield learn` and named in scenarios.
//!
//! The text holds every number to the last bit, so that what is loaded rolls out exactly as what was saved. A checksum
//! finds damage; whoever edits a file on purpose deletes the line of the checksum.

use serde::{Deserialize, Serialize};
use skills::tool::Tool;
use skills::tool_use::{RestoreError, SavedLibrary};

use super::document::{Node, Value, path};
use super::draft::{Draft, read as read_draft};
use super::explain::{Context, bad_value};
use super::named::field_problem;
use super::source::Source;
use crate::diagnostic::Diagnostic;

/// What the key `format` says.
const FORMAT: &str = "wield-skills";
/// The version that this program writes, and the only one so far.
const VERSION: i128 = 1;
/// Marks the line after which the text is summed.
const CHECKSUM_KEY: &str = "checksum = ";

/// Skills with their origin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SkillsFile {
    /// Always `wield-skills`.
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// Sum of the text after its line; not checked if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checksum: Option<String>,
    /// Where the skills come from.
    pub learned: Origin,
    /// The skills.
    pub skills: SavedLibrary,
}

/// Where skills come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of its demonstrations.
    pub seed: u64,
    /// Name of the tool that was used: a file in `assets/tools`.
    pub tool: String,
    /// Names of the demonstrations that were learned from.
    pub demonstrations: Vec<String>,
}

impl SkillsFile {
    /// Skills with their origin, in the present version.
    #[must_use]
    pub fn new(learned: Origin, skills: SavedLibrary) -> Self {
        Self { format: FORMAT.into(), version: VERSION as u32, checksum: None, learned, skills }
    }

    /// The text of the file.
    ///
    /// # Errors
    /// In words, if a value cannot be written.
    pub fn text(&self) -> Result<String, String> {
        #[derive(Serialize)]
        struct Body<'a> {
            learned: &'a Origin,
            skills: &'a SavedLibrary,
        }
        let body = Body { learned: &self.learned, skills: &self.skills };
        let body = toml::to_string(&body).map_err(|error| format!("write skills: {error}"))?;
        let sum = checksum(&body);
        Ok(format!(
            "# Skills that `wield learn` took from demonstrations. Name this file in a scenario to use them:\n\
             #   [demonstrations.learned]\n\
             #   asset = \"<its name in assets/skills, without .toml>\"\n\
             format = {FORMAT:?}\n\
             version = {VERSION}\n\
             {CHECKSUM_KEY}{sum:?}  # of all that follows; delete this line after editing by hand\n\
             {body}"
        ))
    }
}

/// Reads a file of skills.
///
/// # Errors
/// All that is wrong with it: another format or version, damage, missing or refused values.
pub(crate) fn read(source: &Source) -> Result<SkillsFile, Vec<Diagnostic>> {
    let tree = Node::parse(source).map_err(|problem| vec![*problem])?;
    check_kind(source, &tree).map_err(|problem| vec![*problem])?;
    check_sum(source, &tree).map_err(|problem| vec![*problem])?;
    let Draft { value, problems, .. } = read_draft::<SkillsFile>(source, &example());
    match value {
        Some(file) if problems.is_empty() => Ok(file),
        _ => Err(problems),
    }
}

/// Checks that skills fit `tool` and that their primitives can be built anew.
///
/// # Errors
/// The value at fault.
pub(crate) fn check(source: &Source, file: &SkillsFile, tool: &Tool) -> Result<(), Vec<Diagnostic>> {
    let Err(error) = file.skills.clone().restore(tool) else { return Ok(()) };
    let tree = Node::parse(source).map_err(|problem| vec![*problem])?;
    let example = example();
    let context = Context { source, tree: &tree, example: &example };
    Err(vec![match error {
        RestoreError::Field(error) => field_problem(context, error.within("skills")),
        RestoreError::Primitive { path: at, source: reason } => {
            let at = path(&format!("skills.{at}"));
            context.problem_at_value(&at, bad_value(&at)).found(reason.to_string())
        }
    }])
}

/// A file that shows how keys are written.
fn example() -> Source {
    let text = include_str!("../../../../assets/skills/push_stick.toml");
    Source { file: "assets/skills/push_stick.toml".into(), text: text.into() }
}

fn check_kind(source: &Source, tree: &Node) -> Result<(), Box<Diagnostic>> {
    let at = |key: &str| tree.at(&path(key));
    let refuse = |key: &str, title: &str, found: String, expected: String| {
        let span = tree.nearest(&path(key)).span.clone();
        Err(Box::new(source.problem(span, title).found(found).expected(expected)))
    };
    match at("format").map(|node| &node.value) {
        Some(Value::Text(format)) if format == FORMAT => {}
        Some(Value::Text(format)) => {
            return refuse("format", "this is no file of skills", format!("{format:?}"), format!("{FORMAT:?}"));
        }
        _ => {
            let (found, expected) = ("no `format`".into(), format!("format = {FORMAT:?}, as `wield learn` writes it"));
            return refuse("format", "this is no file of skills", found, expected);
        }
    }
    match at("version").map(|node| &node.value) {
        Some(Value::Integer(VERSION)) => Ok(()),
        Some(Value::Integer(version)) => {
            let expected = format!("version {VERSION}; learn the skills anew with `wield learn`, or use a newer wield");
            refuse("version", "skills of another version", format!("version {version}"), expected)
        }
        _ => refuse("version", "this file of skills has no version", "none".into(), format!("version = {VERSION}")),
    }
}

fn check_sum(source: &Source, tree: &Node) -> Result<(), Box<Diagnostic>> {
    let Some(node) = tree.at(&path("checksum")) else { return Ok(()) };
    let Value::Text(stated) = &node.value else { return Ok(()) };
    let rest = source.text.get(node.span.end..).and_then(|rest| rest.split_once('\n')).map_or("", |(_, rest)| rest);
    let sum = checksum(rest);
    if *stated == sum {
        return Ok(());
    }
    let problem = source.problem(node.span.clone(), "the file was damaged or edited after it was written");
    let problem = problem.found(format!("{sum:?} as the sum of what follows")).expected(format!("{stated:?}"));
    let help = "restore the file, or learn the skills anew; if it was edited on purpose, delete this line";
    Err(Box::new(problem.help([help.to_owned()])))
}

/// The sum of a text, whatever its line ends.
fn checksum(text: &str) -> String {
    let hash = blake3::hash(text.replace("\r\n", "\n").as_bytes());
    format!("blake3:{}", hash.to_hex().get(..32).unwrap_or_default())
}
