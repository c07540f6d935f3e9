//! Skills in a file: that they move exactly as those just learned, and what is refused of a file.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise, its helpers too")]

mod program;

use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::Value;

use program::{PROJECT, project, replaced, shipped, wield};

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The shipped scenario, its demonstrations replaced by the skills of the file `name`.
fn with_skills(name: &str) -> String {
    let text = shipped();
    let begin = text.find("[demonstrations.synthetic]").unwrap();
    let end = begin + text[begin..].find("[primitive").unwrap();
    format!("{}[demonstrations.learned]\nasset = \"{name}\"\n\n{}", &text[..begin], &text[end..])
}

/// A fresh project that has learned the skills of the shipped scenario into `assets/skills/own.toml`.
fn project_with_skills() -> tempfile::TempDir {
    let folder = project();
    fs::create_dir(folder.path().join("assets/skills")).unwrap();
    fs::write(folder.path().join("shown.toml"), shipped()).unwrap();
    let output = wield(folder.path(), None, &["learn", "shown.toml", "--out", "assets/skills/own.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    for part in
        ["learned with the tool `stick` from 5 demonstrations", "push with `side`", "skills: assets/skills/own.toml"]
    {
        assert!(told.contains(part), "{part:?} is missing in:\n{told}");
    }
    fs::write(folder.path().join("learned.toml"), with_skills("own")).unwrap();
    folder
}

fn outcome(folder: &Path, scenario: &str) -> Value {
    let output = wield(folder, None, &["run", scenario, "--no-record", "--out", &format!("{scenario}.out")]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let file = folder.join(format!("{scenario}.out/seed-1/outcome.json"));
    serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap()
}

#[test]
fn skills_from_a_file_move_exactly_as_those_just_learned() {
    let folder = project_with_skills();
    let (shown, learned) = (outcome(folder.path(), "shown.toml"), outcome(folder.path(), "learned.toml"));
    assert!(shown["trajectory_digest"].is_string());
    assert_eq!(shown["trajectory_digest"], learned["trajectory_digest"]);
    // the same skills once more, through the scenario that names the file
    let again = wield(folder.path(), None, &["learn", "learned.toml", "--out", "again.toml", "--quiet"]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    let read = |file: &str| fs::read_to_string(folder.path().join(file)).unwrap();
    assert_eq!(read("again.toml"), read("assets/skills/own.toml"));
}

#[test]
fn the_shipped_skills_are_those_of_the_shipped_scenario() {
    let folder = project_with_skills();
    let own = fs::read_to_string(folder.path().join("assets/skills/own.toml")).unwrap();
    let shipped = fs::read_to_string(Path::new(PROJECT).join("assets/skills/push_stick.toml")).unwrap();
    let renamed = own.replace("scenario = \"shown\"", "scenario = \"push_stick\"");
    // the checksum covers the name of the scenario too
    let body = |text: &str| text.split_once("[learned]").unwrap().1.to_owned();
    assert_eq!(body(&renamed), body(&shipped));
}

#[test]
fn a_file_of_another_version_or_damaged_is_refused_with_its_place() {
    let folder = project_with_skills();
    let file = folder.path().join("assets/skills/own.toml");
    let good = fs::read_to_string(&file).unwrap();
    let checksum = good.lines().find(|line| line.starts_with("checksum")).unwrap().to_owned() + "\n";
    let unsummed = good.replace(&checksum, "");
    let form = "form = \"residual\"\nbases";
    let duration = unsummed.lines().find(|line| line.starts_with("duration_s")).unwrap().to_owned();
    let cases: [(String, &[&str]); 8] = [
        (
            replaced(&good, "version = 2", "version = 3"),
            &["skills of another version", "own.toml:5:11", "found version 3; expected version 2; learn"],
        ),
        (replaced(&good, "wield-skills", "other"), &["this is no file of skills", "own.toml:4:10", "found \"other\""]),
        (
            replaced(&good, "surface = \"side\"", "surface = \"head\""),
            &["damaged or edited after it was written", "own.toml:7:12", "delete this line"],
        ),
        (good[..good.len() / 2].to_owned(), &["this is not valid TOML", "own.toml:"]),
        (
            replaced(&unsummed, "surface = \"side\"", "surface = \"sied\""),
            &["bad value for `surface` in entry 1 of [[skills.pushes]]", "expected one of `side`, `head`"],
        ),
        (replaced(&unsummed, &duration, "duration_s = -1.0"), &["`duration_s` in [skills.", "found -1"]),
        (replaced(&unsummed, form, "form = \"residue\"\nbases"), &["unknown kind `residue`"]),
        (String::new(), &["own.toml", "this is no file of skills"]),
    ];
    for (text, expected) in cases {
        fs::write(&file, text).unwrap();
        let output = wield(folder.path(), None, &["run", "learned.toml", "--no-record"]);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        for part in expected.iter().chain(&["learned.toml:"]) {
            assert!(told.contains(part), "{part:?} is missing in:\n{told}");
        }
        assert!(!folder.path().join("runs").exists(), "something was written");
    }
}
