//! Where a shipped file shows a key.

use std::path::PathBuf;

use super::{FileKind, Key};
use crate::assets::{Assets, stems};
use crate::scenario::{Node, Source, Value};

/// A line of a shipped file.
pub(crate) struct Shown {
    /// The file.
    pub file: PathBuf,
    /// Number of the line, counted from 1.
    pub line: usize,
    /// Its text.
    pub text: String,
}

/// Finds a key in the files that show how keys are written, else in the others of their folder; a key of some kinds of tasks in
/// files of those alone.
pub(crate) fn shown(kind: &FileKind, key: &Key, assets: &Assets) -> Option<Shown> {
    let built_in = kind.examples().into_iter().find_map(|source| shown_in(&source, key));
    built_in.or_else(|| {
        let files = files(kind, assets).into_iter();
        files.filter_map(|file| Source::read(&file).ok()).find_map(|source| shown_in(&source, key))
    })
}

/// The files of a kind beside the folder of assets or in it.
fn files(kind: &FileKind, assets: &Assets) -> Vec<PathBuf> {
    let folder = match kind.folder.strip_prefix("assets/") {
        Some(folder) => assets.root().join(folder),
        None => assets.root().parent().map_or_else(|| kind.folder.into(), |project| project.join(kind.folder)),
    };
    stems(&folder, "toml").into_iter().map(|stem| folder.join(format!("{stem}.toml"))).collect()
}

fn shown_in(source: &Source, key: &Key) -> Option<Shown> {
    let tree = Node::parse(source).ok()?;
    if !(key.tasks.is_empty() || key.tasks.iter().any(|task| is_of_task(&tree, task))) {
        return None;
    }
    let node = key.path.iter().try_fold(&tree, |node, step| below(node, step))?;
    let before = source.text.get(..node.key.start)?;
    let line = before.matches('\n').count();
    let text = source.text.lines().nth(line)?.trim().to_owned();
    Some(Shown { file: source.file.clone(), line: line + 1, text })
}

/// Whether a scenario's table `task` names this kind.
fn is_of_task(tree: &Node, task: &str) -> bool {
    tree.child("task").is_some_and(|named| named.child(task).is_some())
}

/// The value under a step, where the name of a kind without options stands for that kind, and any name for a free one.
fn below<'a>(node: &'a Node, step: &str) -> Option<&'a Node> {
    match &node.value {
        Value::Text(name) if name == step => Some(node),
        Value::Table(entries) if step == super::keys::ANY_NAME => entries.values().next(),
        _ => node.child(step),
    }
}
