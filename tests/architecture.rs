//! The source tree against its own rules: borders between crates, file heads and sizes, what PAPER.md, README.md and docs/layout.md claim.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise, its helpers too")]

#[path = "architecture/items.rs"]
mod items;
mod program;
#[path = "architecture/tree.rs"]
mod tree;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use program::PROJECT;
use tree::{files_below, is_source};

/// Crates of others, and the only folders whose code may name them.
const BORDERS: &[(&str, &[&str])] = &[
    ("rerun", &["crates/scenarios/src/recording/"]),
    ("rapier2d", &["crates/sim/"]),
    ("rapier3d", &["crates/sim/"]),
    // the tests of `sim` read shipped files; that nothing else there can is kept by the dependencies below
    ("toml", &["crates/scenarios/", "crates/sim/"]),
    ("clap", &["crates/scenarios/"]),
    ("urdf_rs", &["crates/robot/"]),
];

/// A longer file holds more than one idea.
const LONGEST_FILE_LINES: usize = 600;

/// Path of every Rust file of the crates, relative to the project, with its text.
fn sources() -> Vec<(String, String)> {
    let all = files_below(Path::new(PROJECT), "crates");
    let rust = all.into_iter().filter(|path| path.ends_with(".rs"));
    rust.map(|path| (path.clone(), read(&path))).collect()
}

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(PROJECT).join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Asserts that `complaints` is empty, and shows them all if it is not.
fn assert_none(rule: &str, complaints: &[String]) {
    assert!(complaints.is_empty(), "{rule}:\n  {}", complaints.join("\n  "));
}

/// Whether the code of `line` names the crate `name`: `name::…`, `use name;` or `extern crate name`; comments do not count.
fn names_crate(line: &str, name: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default();
    let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    code.match_indices(name).any(|(start, _)| {
        let (before, after) = (&code[..start], &code[start + name.len()..]);
        let whole = !before.ends_with(is_word) && !after.starts_with(is_word) && !before.ends_with("::");
        let declared = before.trim_end().ends_with("use") || before.trim_end().ends_with("crate");
        whole && (after.starts_with("::") || declared)
    })
}

/// Crates that `manifest` depends on, other than for its tests.
fn dependencies(manifest: &str) -> BTreeSet<String> {
    let mut section = "";
    let mut found = BTreeSet::new();
    for line in manifest.lines().map(str::trim) {
        if line.starts_with('[') {
            section = line;
        } else if section.ends_with("dependencies]") && section != "[dev-dependencies]" && !line.starts_with('#') {
            let key: String =
                line.chars().take_while(|letter| letter.is_alphanumeric() || "_-".contains(*letter)).collect();
            found.extend((!key.is_empty()).then(|| key.replace('-', "_")));
        }
    }
    found
}

#[test]
fn foreign_crates_are_named_only_behind_their_border() {
    let mut complaints = Vec::new();
    // tests and benches may use more
    for (path, text) in sources().into_iter().filter(|(path, _)| is_source(path)) {
        for (name, folders) in BORDERS {
            let inside = folders.iter().any(|folder| path.starts_with(folder));
            let line = text.lines().position(|line| names_crate(line, name)).filter(|_| !inside);
            complaints
                .extend(line.map(|line| format!("{path}:{}: `{name}` belongs in {}", line + 1, folders.join(", "))));
        }
    }
    assert_none("a crate is used outside its border", &complaints);
}

#[test]
fn each_crate_depends_only_on_what_stands_below_it() {
    let mut complaints = Vec::new();
    let forbidden: &[(&str, &[&str])] = &[
        ("skills", &["robot", "sim", "scenarios", "rapier2d", "rapier3d", "toml", "clap", "rerun"]),
        ("robot", &["skills", "sim", "scenarios", "rapier2d", "rapier3d", "toml", "clap", "rerun"]),
        ("sim", &["scenarios", "toml", "clap", "rerun"]),
        ("scenarios", &["rapier2d", "rapier3d"]),
    ];
    for (owner, others) in forbidden {
        let used = dependencies(&read(&format!("crates/{owner}/Cargo.toml")));
        assert!(used.contains("nalgebra"), "crates/{owner}/Cargo.toml was not understood: found {used:?}");
        complaints
            .extend(others.iter().filter(|name| used.contains(**name)).map(|name| format!("{owner} uses {name}")));
    }
    assert_none("a dependency points the wrong way (the directions stand in CONTRIBUTING.md)", &complaints);
}

#[test]
fn every_module_opens_with_what_it_owns() {
    let silent = sources().into_iter().filter(|(_, text)| !text.starts_with("//! "));
    let complaints: Vec<String> = silent.map(|(path, _)| path).collect();
    assert_none("the first line must be `//! ` and say what the file owns", &complaints);
}

#[test]
fn no_file_is_longer_than_one_idea() {
    let lengths = sources().into_iter().map(|(path, text)| (path, text.lines().count()));
    let long = lengths.filter(|(path, lines)| is_source(path) && *lines > LONGEST_FILE_LINES);
    let complaints: Vec<String> = long.map(|(path, lines)| format!("{path}: {lines} lines")).collect();
    assert_none(&format!("more than {LONGEST_FILE_LINES} lines: divide the file"), &complaints);
}

/// PAPER.md names code as `<path>::<item>`, the path ending in `.rs`, and tests in the last column of its tables.
#[test]
fn the_ledger_names_items_and_tests_that_exist() {
    let ledger = read("PAPER.md");
    let mut complaints = Vec::new();
    let named: Vec<&str> = ledger.split('`').skip(1).step_by(2).filter(|code| code.contains(".rs::")).collect();
    for code in &named {
        let (path, item) = code.split_once("::").unwrap();
        match fs::read_to_string(Path::new(PROJECT).join(path)) {
            Err(_) => complaints.push(format!("{code}: there is no file {path}")),
            Ok(text) => {
                complaints.extend(items::missing(&text, item).map(|part| format!("{code}: {path} defines no `{part}`")))
            }
        }
    }
    let rows = items::rows_with_tests(&ledger);
    assert!(!rows.is_empty(), "PAPER.md: found no table whose last column is `Test`");
    for (row, tests) in rows {
        if tests.is_empty() {
            complaints.push(format!("{row}: names no test"));
        }
        for test in tests {
            let (path, name) = test.split_once("::").unwrap();
            let text = fs::read_to_string(Path::new(PROJECT).join(path)).unwrap_or_default();
            if !items::is_test(&text, name) {
                complaints.push(format!("{row}: `{test}` is no test"));
            }
        }
    }
    assert_none("PAPER.md names code that is not there; mend the table, or give the code its name back", &complaints);
}

#[test]
fn every_shipped_file_is_listed_and_loads() {
    let folder = tempfile::tempdir().unwrap();
    let assets = Path::new(PROJECT).join("assets");
    let listed = program::wield(folder.path(), Some(&assets), &["list"]);
    let listed = String::from_utf8_lossy(&listed.stdout).into_owned();
    let mut complaints: Vec<String> =
        listed.lines().filter(|line| line.contains("(broken")).map(|line| format!("wield list: {line}")).collect();
    for path in files_below(Path::new(PROJECT), "assets") {
        let file = Path::new(&path);
        let stem = file.file_stem().unwrap().to_string_lossy().into_owned();
        let named = listed.lines().any(|line| line.split_whitespace().next() == Some(&stem));
        complaints.extend((!named && stem != "README").then(|| format!("{path}: `wield list` does not name it")));
    }
    for path in files_below(Path::new(PROJECT), "scenarios") {
        let file = Path::new(PROJECT).join(&path);
        let named = listed.lines().any(|line| line.contains(&path));
        complaints.extend((!named).then(|| format!("{path}: `wield list` does not name it")));
        let checked = program::wield(folder.path(), Some(&assets), &["check", &file.display().to_string()]);
        let said = String::from_utf8_lossy(&checked.stderr).into_owned();
        complaints
            .extend((checked.status.code() != Some(0)).then(|| format!("{path}: `wield check` refuses it: {said}")));
    }
    assert_none("a shipped file cannot be used", &complaints);
}

#[test]
fn every_asset_states_its_source() {
    let stated = read("assets/README.md");
    let kinds = ["robots", "tools", "foods", "knives", "containers"];
    let files = kinds.iter().flat_map(|kind| files_below(Path::new(PROJECT), &format!("assets/{kind}")));
    let name = |path: &str| path.rsplit('/').next().unwrap().to_owned();
    let silent: Vec<String> = files.filter(|path| !stated.contains(&format!("`{}`", name(path)))).collect();
    assert_none("assets/README.md has no row for a file", &silent);
}

#[test]
fn the_tree_in_the_layout_is_the_tree() {
    let expected = tree::drawing(Path::new(PROJECT));
    let layout = read("docs/layout.md");
    let shown = layout.split_once("```text\n").and_then(|(_, rest)| rest.split_once("```"));
    let shown = shown.map(|(block, _)| block).unwrap_or_default();
    assert!(
        shown == expected,
        "docs/layout.md: the block differs from the folders and the first sentences of their modules; \
         replace it by:\n\n```text\n{expected}```\n"
    );
}

#[test]
fn every_relative_link_leads_somewhere() {
    let mut complaints = Vec::new();
    for document in ["README.md", "PAPER.md", "CONTRIBUTING.md", "assets/README.md", "docs/layout.md"] {
        let (text, folder) = (read(document), Path::new(PROJECT).join(document).parent().unwrap().to_owned());
        let targets = text.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0));
        let relative = targets.filter(|target| !target.contains("://") && !target.starts_with('#'));
        let lost = relative.filter(|target| !folder.join(target.split('#').next().unwrap()).exists());
        complaints.extend(lost.map(|target| format!("{document}: {target}")));
    }
    assert_none("a link leads nowhere", &complaints);
}
