//! Learned skills as a file: its format, written by `wield learn` and named in scenarios.
//!
//! The text holds every number to the last bit, so that what is loaded rolls out exactly as what was saved. A checksum
//! finds damage; whoever edits a file on purpose deletes the line of the checksum.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use skills::primitive::RestoreError;

use super::document::{Node, Value, path};
use super::draft::{Draft, read as read_draft};
use super::explain::{Context, bad_value};
use super::named::field_problem;
use super::source::Source;
use crate::diagnostic::Diagnostic;

/// What the key `format` says.
const FORMAT: &str = "wield-skills";
/// The version that this program writes and reads; version 1 did not tell the kind of task.
const VERSION: i128 = 2;
/// Marks the line after which the text is summed.
const CHECKSUM_KEY: &str = "checksum = ";

/// Skills of one kind of task, as they stand in a file: what the kind implements for its own.
pub trait SavedSkills: Serialize + DeserializeOwned {
    /// Name of the kind of task.
    const TASK: &'static str;
    /// What the hand held in the demonstrations: "tool", "knife".
    const HELD: &'static str;
    /// Path and text of a valid file, which shows how keys are written.
    const EXAMPLE: (&'static str, &'static str);

    /// What each of the skills is, for whoever has just learned them.
    fn lines(&self) -> Vec<String>;

    /// The same in a few words, for lists.
    fn summary(&self) -> String;
}

/// Skills with their origin; `S` is what the kind of task keeps of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SkillsFile<S> {
    /// Always `wield-skills`.
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// Name of the kind of task that the skills are for.
    pub task: String,
    /// Sum of the text after its line; not checked if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checksum: Option<String>,
    /// Where the skills come from.
    pub learned: Origin,
    /// The skills.
    pub skills: S,
}

/// Learned skills of any kind, ready to be written to a file and told of.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptSkills {
    /// The text of the file.
    pub text: String,
    /// What was learned from how much, in lines.
    pub told: String,
}

/// Where skills come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of its demonstrations.
    pub seed: u64,
    /// Name of the tool, knife or cup that was used: a file in the assets.
    pub tool: String,
    /// Names of the demonstrations that were learned from.
    pub demonstrations: Vec<String>,
}

impl<S: SavedSkills> SkillsFile<S> {
    /// Skills with their origin, in the present version.
    pub(crate) fn new(learned: Origin, skills: S) -> Self {
        Self { format: FORMAT.into(), version: VERSION as u32, task: S::TASK.into(), checksum: None, learned, skills }
    }

    /// The file's text, and what to tell of it; the error is in words.
    pub(crate) fn kept(&self) -> Result<KeptSkills, String> {
        let count = self.learned.demonstrations.len();
        let demonstrations = if count == 1 { "demonstration" } else { "demonstrations" };
        let lines: String = self.skills.lines().iter().map(|line| format!("  {line}\n")).collect();
        let told =
            format!("learned with the {} `{}` from {count} {demonstrations}:\n{lines}", S::HELD, self.learned.tool);
        Ok(KeptSkills { text: self.text()?, told })
    }

    fn text(&self) -> Result<String, String> {
        #[derive(Serialize)]
        struct Body<'a, S> {
            learned: &'a Origin,
            skills: &'a S,
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
             task = {:?}\n\
             {CHECKSUM_KEY}{sum:?}  # of all that follows; delete this line after editing by hand\n\
             {body}",
            S::TASK
        ))
    }
}

/// Reads a file of skills of one kind of task.
///
/// # Errors
/// All that is wrong with it: another format, version or kind, damage, missing or refused values.
pub(crate) fn read<S: SavedSkills>(source: &Source) -> Result<SkillsFile<S>, Vec<Diagnostic>> {
    let tree = Node::parse(source).map_err(|problem| vec![*problem])?;
    check_kind(source, &tree).map_err(|problem| vec![*problem])?;
    check_task(source, &tree, S::TASK).map_err(|problem| vec![*problem])?;
    check_sum(source, &tree).map_err(|problem| vec![*problem])?;
    let Draft { value, problems, .. } = read_draft::<SkillsFile<S>>(source, &example::<S>());
    match value {
        Some(file) if problems.is_empty() => Ok(file),
        _ => Err(problems),
    }
}

/// Skills of a kind in a few words, for lists.
///
/// # Errors
/// As [`read`].
pub(crate) fn describe<S: SavedSkills>(source: &Source) -> Result<String, Vec<Diagnostic>> {
    let SkillsFile { learned, skills, .. } = read::<S>(source)?;
    let count = learned.demonstrations.len();
    let demonstrations = if count == 1 { "demonstration" } else { "demonstrations" };
    let Origin { tool, scenario, .. } = &learned;
    Ok(format!("{}, with the {} `{tool}`, from {count} {demonstrations} of {scenario}", skills.summary(), S::HELD))
}

/// Name of the kind of task that a file of skills is for.
///
/// # Errors
/// If it is no file of skills, or does not tell.
pub(crate) fn task_of(source: &Source) -> Result<String, Box<Diagnostic>> {
    let tree = Node::parse(source)?;
    check_kind(source, &tree)?;
    match tree.at(&path("task")).map(|node| &node.value) {
        Some(Value::Text(task)) => Ok(task.clone()),
        _ => Err(Box::new(source.problem(tree.span, "this file of skills does not tell its kind of task"))),
    }
}

/// Why skills that were read cannot be used, at the place of the value at fault.
pub(crate) fn refusal<S: SavedSkills>(source: &Source, error: RestoreError) -> Vec<Diagnostic> {
    let tree = match Node::parse(source) {
        Ok(tree) => tree,
        Err(problem) => return vec![*problem],
    };
    let example = example::<S>();
    let context = Context { source, tree: &tree, example: &example };
    let at = path(&format!("skills.{}", error.path()));
    let at_primitive = |reason: String| context.problem_at_value(&at, bad_value(&at)).found(reason);
    vec![match error {
        RestoreError::Field(error) => field_problem(context, error.within("skills")),
        RestoreError::Primitive { source: reason, .. } => at_primitive(reason.to_string()),
        RestoreError::Pose { source: reason, .. } => at_primitive(reason.to_string()),
    }]
}

/// A file that shows how keys are written.
fn example<S: SavedSkills>() -> Source {
    let (file, text) = S::EXAMPLE;
    Source::new(file, text)
}

fn check_task(source: &Source, tree: &Node, task: &str) -> Result<(), Box<Diagnostic>> {
    let found = match tree.at(&path("task")).map(|node| &node.value) {
        Some(Value::Text(found)) if found == task => return Ok(()),
        Some(Value::Text(found)) => format!("{found:?}"),
        _ => "none".into(),
    };
    let problem = source.problem(tree.nearest(&path("task")).span.clone(), "skills of another kind of task");
    Err(Box::new(problem.found(found).expected(format!("{task:?}, as in the scenario that names the file"))))
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
