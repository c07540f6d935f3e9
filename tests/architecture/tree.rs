//! The folders of the project as the block of text in docs/layout.md.

use std::fs;
use std::path::Path;

/// Folders without code, and what they hold; folders of code say it themselves, in the head of their module.
const HELD: &[(&str, &str)] = &[
    ("assets", "What scenarios name; sources in assets/README.md."),
    ("assets/containers", "Containers that are poured from or into."),
    ("assets/demonstrations", "Recorded demonstrations, one CSV file each."),
    ("assets/foods", "Foods: shape, core, and how hard they are to cut."),
    ("assets/knives", "Knives: blade, edge and how they are held."),
    ("assets/robots", "Arms, as URDF files."),
    ("assets/skills", "Learned skills, as `wield learn` writes them."),
    ("assets/tools", "Tools: outlines and contact surfaces."),
    ("crates", "The code: each crate uses only those below it."),
    ("docs", "Pictures, the reproduction of the paper, measured performance."),
    ("scenarios", "Experiments, one TOML file each."),
    ("tests", "Tests of the built program and of this tree."),
];

/// Crates, highest first.
const CRATES: &[&str] = &["scenarios", "sim", "skills", "robot"];

/// Column at which the comments begin.
const COMMENT_COLUMN: usize = 22;

/// All files below `folder` of `project`, as paths relative to `project` with `/`, sorted.
pub fn files_below(project: &Path, folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    for name in entries(project, folder) {
        let path = format!("{folder}/{name}");
        if project.join(&path).is_dir() { found.extend(files_below(project, &path)) } else { found.push(path) }
    }
    found
}

/// Whether a file belongs to a crate's library or program, rather than to its tests or benches.
pub fn is_source(path: &str) -> bool {
    path.split('/').nth(2) == Some("src")
}

/// The block: one line per folder, indented, with a comment.
pub fn drawing(project: &Path) -> String {
    let mut lines = String::new();
    for top in folders(project, "") {
        lines += &line(0, &top, &held(&top));
        match top.as_str() {
            "crates" => {
                let found = folders(project, "crates");
                let mut expected: Vec<String> = CRATES.iter().map(|name| (*name).to_owned()).collect();
                expected.sort();
                assert_eq!(found, expected, "a new crate: add it to CRATES in tests/architecture/tree.rs");
                for name in CRATES {
                    lines += &line(1, name, &said(project, &format!("crates/{name}/src")));
                    lines += &modules(project, &format!("crates/{name}/src"), 2);
                }
            }
            "assets" => {
                for kind in folders(project, "assets") {
                    lines += &line(1, &kind, &held(&format!("assets/{kind}")));
                }
            }
            _ => {}
        }
    }
    lines
}

fn modules(project: &Path, folder: &str, depth: usize) -> String {
    let named = folders(project, folder).into_iter().map(|name| (format!("{folder}/{name}"), name));
    named.map(|(path, name)| line(depth, &name, &said(project, &path)) + &modules(project, &path, depth + 1)).collect()
}

fn line(depth: usize, name: &str, comment: &str) -> String {
    let left = format!("{}{name}/", "  ".repeat(depth));
    format!("{left:COMMENT_COLUMN$} {comment}\n")
}

fn held(folder: &str) -> String {
    let found = HELD.iter().find(|(name, _)| *name == folder);
    found
        .unwrap_or_else(|| panic!("{folder}/ is new: say what it holds in HELD of tests/architecture/tree.rs"))
        .1
        .into()
}

/// First sentence of the module that owns `folder`: its mod.rs or lib.rs, else the file of its name beside it.
fn said(project: &Path, folder: &str) -> String {
    let candidates = [format!("{folder}/mod.rs"), format!("{folder}/lib.rs"), format!("{folder}.rs")];
    let text = candidates.iter().find_map(|path| fs::read_to_string(project.join(path)).ok());
    let text = text.unwrap_or_else(|| panic!("{folder}/ has no module: expected one of {}", candidates.join(", ")));
    let paragraph = text.lines().map_while(|line| line.strip_prefix("//! ")).collect::<Vec<_>>().join(" ");
    // a sentence ends where the next one begins with a capital: `Eq. (1)` does not end one
    let stops = paragraph.match_indices(". ").map(|(at, _)| at + 1);
    let end = stops.into_iter().find(|end| paragraph[end + 1..].starts_with(char::is_uppercase));
    paragraph[..end.unwrap_or(paragraph.len())].replace(['[', ']', '`'], "")
}

/// Names of the folders in `folder` that hold a file, sorted; hidden ones and what builds and runs leave are not part of the tree.
fn folders(project: &Path, folder: &str) -> Vec<String> {
    let path = |name: &str| if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
    let outputs = ["target", "runs"];
    let named =
        entries(project, folder).into_iter().filter(|name| !(folder.is_empty() && outputs.contains(&name.as_str())));
    named.filter(|name| project.join(path(name)).is_dir() && !files_below(project, &path(name)).is_empty()).collect()
}

fn entries(project: &Path, folder: &str) -> Vec<String> {
    let read = fs::read_dir(project.join(folder)).unwrap_or_else(|error| panic!("{folder}: {error}"));
    let mut names: Vec<String> = read.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.retain(|name| !name.starts_with('.'));
    names.sort();
    names
}
