//! Drives the built program in a fresh folder.

// each test program uses its own part of this, and all of it may stop at the first surprise
#![allow(dead_code, clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

/// The project's folder.
pub const PROJECT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// A fresh project: the shipped assets, no scenario yet.
pub fn project() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["tools", "robots"] {
        let target = folder.path().join("assets").join(kind);
        fs::create_dir_all(&target).unwrap();
        for entry in fs::read_dir(Path::new(PROJECT).join("assets").join(kind)).unwrap().flatten() {
            fs::copy(entry.path(), target.join(entry.file_name())).unwrap();
        }
    }
    folder
}

/// Text of the shipped scenario.
pub fn shipped() -> String {
    fs::read_to_string(Path::new(PROJECT).join("scenarios/push_stick.toml")).unwrap()
}

/// Text with the only occurrence of `from` replaced.
pub fn replaced(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} must stand once in the text");
    text.replace(from, to)
}

/// Line and column, as `line:column`, of `part` in `text`; its only occurrence.
pub fn place(text: &str, part: &str) -> String {
    assert_eq!(text.matches(part).count(), 1, "{part:?} must stand once in the text");
    let start = text.find(part).unwrap();
    let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    format!("{}:{}", text[..start].matches('\n').count() + 1, text[line_start..start].chars().count() + 1)
}

/// Runs the built program in `folder`, with the assets named by the environment if there are any.
pub fn wield(folder: &Path, assets: Option<&Path>, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_wield"));
    command.args(arguments).current_dir(folder).env_remove("WIELD_ASSETS");
    command.envs(assets.map(|assets| ("WIELD_ASSETS", assets))).output().unwrap()
}
