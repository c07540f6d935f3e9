//! Loading: from a scenario file to a checked scenario with everything that it names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::changes::{Change, GivenBy, changed};
use super::check::check_arm;
use super::decode::{Flaw, decode};
use super::document::{Node, Value, path};
use super::draft::{Draft, empty, read};
use super::explain::Context;
use super::named::{Reader, field_problem};
use super::parts::name_of_file;
use super::source::Source;
use super::{ReadScenario, ResolvedScenario};
use crate::assets::Assets;
use crate::diagnostic::Diagnostic;
use crate::suggest::nearest;
use crate::tasks::{AnyKind, TASKS, TaskKind};

/// The table that says what is to be done; its only key names the kind.
const TASK: &str = "task";

/// Reads a scenario of one kind of task.
pub(crate) type Loader = fn(&Source, &Source, &Assets) -> Result<ResolvedScenario, Vec<Diagnostic>>;

/// Reads and checks a scenario file and everything that it names.
///
/// # Errors
/// Everything that is wrong, as far as it can be told apart: at least one [`Diagnostic`].
pub fn load(file: &Path, assets: &Assets) -> Result<ResolvedScenario, Vec<Diagnostic>> {
    let source = Source::read(file).map_err(|problem| vec![*problem])?;
    resolve(&source, assets)
}

/// Reads and checks a scenario of which some values are changed; `file` is the name under which the user knows its text.
///
/// # Errors
/// As [`load`]; each problem says which values were changed, one with a changed value is not at a place of the file.
pub fn load_text(
    file: &Path,
    text: &str,
    changes: &[Change],
    assets: &Assets,
) -> Result<ResolvedScenario, Vec<Diagnostic>> {
    load_changed(file, text, changes, GivenBy::Values, assets)
}

/// The same, with the way in which the user made the changes.
///
/// # Errors
/// As [`load_text`].
pub fn load_changed(
    file: &Path,
    text: &str,
    changes: &[Change],
    by: GivenBy,
    assets: &Assets,
) -> Result<ResolvedScenario, Vec<Diagnostic>> {
    let source = Source::new(file, text);
    let in_words: Vec<_> = changes.iter().map(|change| (change.clone(), by.words(file, change))).collect();
    let words: Vec<PathBuf> = in_words.iter().map(|(_, words)| words.into()).collect();
    let result = changed(&source, in_words).map_err(|problem| vec![*problem]);
    result.and_then(|source| resolve(&source, assets)).map_err(|problems| {
        let stated: Vec<String> = changes.iter().map(Change::to_string).collect();
        let remark = (!stated.is_empty()).then(|| format!("the file is read with {}", stated.join(", ")));
        // a problem that names the only change needs no list of them
        let told = |problem: &Diagnostic| words.len() == 1 && words.contains(&problem.file);
        let remarked = |problem: Diagnostic| {
            if told(&problem) { problem } else { problem.help(remark.clone()) }
        };
        problems.into_iter().map(remarked).collect()
    })
}

/// Remarks on a scenario that can be used: oddities of its robot's description.
#[must_use]
pub fn notes(resolved: &ResolvedScenario) -> Vec<String> {
    let robot = resolved.file().arm().asset;
    resolved.arm.warnings().iter().map(|warning| format!("robot `{robot}`: {warning}")).collect()
}

/// Title of a scenario file, for lists; `None` if the file cannot be read that far.
#[must_use]
pub fn title(file: &Path) -> Option<String> {
    let source = Source::read(file).ok()?;
    match &Node::parse(&source).ok()?.at(&path("scenario.title"))?.value {
        Value::Text(title) => Some(title.clone()),
        _ => None,
    }
}

/// Looks up the kind of the task, whose scenarios have a shape of their own, and reads the file as one of that kind.
fn resolve(source: &Source, assets: &Assets) -> Result<ResolvedScenario, Vec<Diagnostic>> {
    if let Some(problem) = empty(source) {
        return Err(vec![problem]);
    }
    let tree = Node::parse(source).map_err(|problem| vec![*problem])?;
    match kind_of(&tree) {
        Ok(kind) => (kind.load)(source, &kind.example(), assets),
        // without a kind there is nothing that the rest of the file could be compared with
        Err(flaw) => {
            let example = TASKS.first().map_or_else(|| source.clone(), TaskKind::example);
            Err(vec![Context { source, tree: &tree, example: &example }.explain(&flaw).diagnostic])
        }
    }
}

/// The kind of a scenario's task: the only key of its table `task`.
fn kind_of(tree: &Node) -> Result<&'static TaskKind, Flaw> {
    let nothing = Node { key: 0..0, span: 0..0, value: Value::Table(BTreeMap::new()) };
    let stated = decode(tree.child(TASK).unwrap_or(&nothing)).map(|AnyKind(kind)| kind);
    stated.or_else(|flaw| meant_kind(tree).ok_or_else(|| flaw.inside(TASK)))
}

/// The kind that a table named almost like `task` names: reading the file as one of that kind finds the misspelled name.
fn meant_kind(tree: &Node) -> Option<&'static TaskKind> {
    let Value::Table(entries) = &tree.value else { return None };
    if entries.contains_key(TASK) {
        return None;
    }
    let mut alike = entries.iter().filter(|(name, _)| nearest(name, &[TASK]).is_some());
    alike.find_map(|(_, table)| decode(table).ok()).map(|AnyKind(kind)| kind)
}

/// Reads a file as a scenario of one kind, with its arm and everything else that it names.
pub(crate) fn load_as<F: ReadScenario>(
    source: &Source,
    example: &Source,
    assets: &Assets,
) -> Result<ResolvedScenario, Vec<Diagnostic>> {
    let Draft { value, tree, mut problems } = read::<F>(source, example);
    let (Some(mut file), Some(tree)) = (value, tree) else { return Err(problems) };
    let context = Context { source, tree: &tree, example };
    let refused = file.refused_values();
    problems.extend(refused.iter().cloned().map(|error| field_problem(context, error)));
    let name = file.header_mut().name.get_or_insert_with(|| name_of_file(&source.file)).clone();
    let asset_changes = file.header_mut().asset_changes.clone();
    let mut reader = Reader { assets, context, problems, asset_changes, used: Vec::new(), asked: Vec::new() };
    let arm = reader.arm("robot.asset", file.arm().asset);
    let against_arm = arm.as_ref().map(|arm| check_arm(context, &file.arm(), arm));
    reader.problems.extend(against_arm.into_iter().flatten());
    let task = file.resolve(&mut reader, &refused);
    reader.refuse_idle_changes();
    let (mut problems, used) = (reader.problems, reader.used);
    problems.sort_by_key(|problem| (problem.file != source.file, problem.place.as_ref().map(|place| place.span.start)));
    match (arm, task) {
        (Some(arm), Some(task)) if problems.is_empty() => {
            Ok(ResolvedScenario { name, arm, source: source.text.to_string(), assets: used, task })
        }
        _ => Err(problems),
    }
}

#[cfg(test)]
#[path = "load_tests.rs"]
mod tests;
