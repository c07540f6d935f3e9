//! README.md and the guides do what they show: the console blocks of each are run in order, in a fresh copy of scenarios
//! and assets.
//!
//! In a `console` block a line that begins with `$ ` is a command, the lines after it are parts of what it prints: each
//! must be printed, spaces apart. `…` stands for anything. A command must end with exit code 0, unless `$ echo $?` follows.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise, its helpers too")]

mod program;

use std::fs;
use std::path::Path;
use std::process::Command;

use program::PROJECT;

/// How the program is run from a checkout; the guides call it `wield`.
const FROM_CHECKOUT: &str = "cargo run --release --";

/// Commands that are not run: they test this program, install or open a viewer, or wait for one.
const NOT_RUN: &[&str] = &[
    "cargo test --release --workspace",
    "pip install rerun-sdk==0.36.3",
    "rerun runs/push_stick/seed-1/recording.rrd",
    "cargo run --release -- run scenarios/push_stick.toml --view",
    "cargo run --release -- run scenarios/push_stick.toml --connect rerun+http://127.0.0.1:9876/proxy",
    "cargo run --release -- run scenarios/push_stick.toml --serve",
];

/// A command and the lines that stand below it.
struct Step {
    command: String,
    shown: Vec<String>,
}

fn steps(page: &Path) -> Vec<Step> {
    let readme = fs::read_to_string(page).unwrap();
    let mut steps: Vec<Step> = Vec::new();
    let blocks = readme.split("```console\n").skip(1).filter_map(|rest| Some(rest.split_once("\n```")?.0));
    for line in blocks.flat_map(str::lines) {
        match (line.strip_prefix("$ "), steps.last_mut()) {
            (Some(command), _) => steps.push(Step { command: command.to_owned(), shown: Vec::new() }),
            (None, Some(step)) => step.shown.push(line.to_owned()),
            (None, None) => panic!("{}: a console block begins with {line:?}; expected a command", page.display()),
        }
    }
    steps
}

/// Copies a folder and all below it.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().flatten() {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}

/// Whether `printed` is `shown`, spaces apart, where `…` in `shown` stands for anything.
fn matches(shown: &str, printed: &str) -> bool {
    let printed = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    let shown = shown.split_whitespace().collect::<Vec<_>>().join(" ");
    let parts: Vec<&str> = shown.split('…').collect();
    let (first, last) = (parts[0], parts[parts.len() - 1]);
    if parts.len() == 1 {
        return shown == printed;
    }
    let Some(mut rest) = printed.strip_prefix(first).and_then(|rest| rest.strip_suffix(last)) else { return false };
    for part in &parts[1..parts.len() - 1] {
        match rest.split_once(part) {
            Some((_, after)) => rest = after,
            None => return false,
        }
    }
    true
}

/// Asserts that every line shown is printed, in the order shown.
fn assert_shown(page: &str, step: &Step, printed: &str) {
    let mut lines = printed.lines();
    for shown in &step.shown {
        // a build without its recorder tells of no recording
        if shown.starts_with("recording:") && !cfg!(feature = "recording") {
            continue;
        }
        let found = shown == "…" || lines.any(|line| matches(shown, line));
        assert!(
            found,
            "{page}: `{}` does not print the line {shown:?} where it is shown; it prints:\n{printed}",
            step.command
        );
    }
}

#[test]
fn the_readme_does_what_it_shows() {
    let steps = steps(&Path::new(PROJECT).join("README.md"));
    assert!(steps.iter().any(|step| step.command.starts_with(FROM_CHECKOUT)), "README.md shows no run");
    for command in NOT_RUN {
        assert!(
            steps.iter().any(|step| step.command == *command),
            "README.md no longer shows `{command}`; drop it here"
        );
    }
    assert_run("README.md", &steps);
}

#[test]
fn the_guides_do_what_they_show() {
    let folder = Path::new(PROJECT).join("docs/guides");
    let mut pages: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    pages.retain(|page| page.extension().is_some_and(|ending| ending == "md"));
    pages.sort();
    assert!(pages.len() >= 4, "{pages:?}");
    for page in pages {
        assert_run(&page.file_name().unwrap().to_string_lossy(), &steps(&page));
    }
}

/// Runs the commands of a page in a fresh copy of scenarios and assets, and asserts that they print what it shows.
fn assert_run(page: &str, steps: &[Step]) {
    let folder = tempfile::tempdir().unwrap();
    for part in ["scenarios", "assets"] {
        copy(&Path::new(PROJECT).join(part), &folder.path().join(part));
    }
    let mut steps = steps.iter().filter(|step| !NOT_RUN.contains(&step.command.as_str())).peekable();
    while let Some(step) = steps.next() {
        let program = format!("'{}'", env!("CARGO_BIN_EXE_wield"));
        let installed = step.command.strip_prefix("wield ").map(|rest| format!("{program} {rest}"));
        let line = installed.unwrap_or_else(|| step.command.replace(FROM_CHECKOUT, &program));
        let mut shell = Command::new("sh");
        shell.args(["-c", &line]).current_dir(folder.path()).env_remove("WIELD_ASSETS");
        let output = shell.output().unwrap();
        let printed = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        let ended = steps.next_if(|next| next.command == "echo $?");
        let expected = ended.map_or("0", |ended| ended.shown.first().map_or("", String::as_str));
        let code = output.status.code().map_or_else(|| "a signal".into(), |code| code.to_string());
        assert_eq!(code, expected, "{page}: `{}` ends with another exit code; it prints:\n{printed}", step.command);
        assert_shown(page, step, &printed);
    }
}

#[test]
fn an_ellipsis_stands_for_anything_and_spaces_do_not_count() {
    for (shown, printed) in
        [("a b", "a    b"), ("| x | 0.4… mm |", "| x |   0.4214 mm |"), ("… s, … s", "1 s, 2 s"), ("…", "")]
    {
        assert!(matches(shown, printed), "{shown:?} {printed:?}");
    }
    for (shown, printed) in [("a", "a b"), ("0.4… mm", "0.5 mm"), ("a … c", "a b"), ("a…a", "a")] {
        assert!(!matches(shown, printed), "{shown:?} {printed:?}");
    }
}
