//! The built program: help, lists, checks, runs, and what they leave on disk.

mod program;

use std::fs;
use std::path::Path;
use std::process::Output;

use program::PROJECT;

/// Runs the program with the shipped assets.
fn wield(folder: &Path, arguments: &[&str]) -> Output {
    program::wield(folder, Some(&Path::new(PROJECT).join("assets")), arguments)
}

fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn scenario() -> String {
    Path::new(PROJECT).join("scenarios/push_stick.toml").display().to_string()
}

#[test]
fn help_teaches() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, parts) in [
        (&["--help"][..], &["Examples:", "wield run scenarios/push_stick.toml", "Exit codes:", "WIELD_ASSETS"][..]),
        (&["run", "--help"], &["outcome.json", "scenario.toml", "--trials", "--min-success", "Exit codes"]),
        (&["--version"], &["wield "]),
    ] {
        let output = wield(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(0));
        for part in parts {
            assert!(stdout(&output).contains(part), "{part:?} is missing in:\n{}", stdout(&output));
        }
    }
}

#[test]
fn wrong_usage_is_bad_input() {
    let folder = tempfile::tempdir().unwrap();
    let file = scenario();
    for arguments in [
        &[][..],
        &["fly"],
        &["run"],
        &["run", &file, "--trials", "0"],
        &["run", &file, "--trials", "many"],
        &["run", &file, "--seed", "-1"],
        &["run", &file, "--min-success", "1.5"],
        &["run", &file, "--min-success", "nan"],
        &["run", &file, "--threads", "0"],
        &["run", &file, "--no-record", "--record", "x.rrd"],
        &["run", &file, "--trials", "2", "--record", "x.rrd"],
        &["run", &file, "--assets", "nowhere"],
        &["list", "planets"],
    ] {
        let output = wield(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!output.stderr.is_empty(), "{arguments:?} is refused without a word");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "something was written");
}

#[test]
fn list_names_what_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let all = stdout(&wield(folder.path(), &["list"]));
    for part in [
        "scenarios:",
        "push_stick.toml",
        "Push a disc past an obstacle",
        "tools:",
        "stick",
        "robots:",
        "tasks:",
        "push",
    ] {
        assert!(all.contains(part), "{part:?} is missing in:\n{all}");
    }
    let robots = stdout(&wield(folder.path(), &["list", "robots"]));
    assert!(robots.lines().any(|line| line.starts_with("planar_3r") && line.contains("3 joints")), "{robots}");
}

#[test]
fn every_shipped_scenario_passes_its_check() {
    let folder = tempfile::tempdir().unwrap();
    for entry in fs::read_dir(Path::new(PROJECT).join("scenarios")).unwrap().flatten() {
        let file = entry.path().display().to_string();
        let output = wield(folder.path(), &["check", &file]);
        assert_eq!((output.status.code(), stdout(&output)), (Some(0), format!("ok {file}\n")), "{}", stderr(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "a check writes nothing");
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_run() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("taken"), "a file").unwrap();
    let output = wield(folder.path(), &["run", &scenario(), "--no-record", "--out", "taken/runs"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("cannot write to taken/runs"), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(folder.path().join("taken")).unwrap(), "a file");
}

#[test]
fn a_run_repeats_itself_byte_by_byte_from_what_it_left() {
    let folder = tempfile::tempdir().unwrap();
    let first = wield(folder.path(), &["run", &scenario(), "--seed", "3", "--no-record"]);
    assert!(matches!(first.status.code(), Some(0 | 1)), "{}", stderr(&first));
    let told = stdout(&first);
    for part in ["push_stick with seed 3", "measure", "limit", "time:", "results: runs/push_stick/seed-3"] {
        assert!(told.contains(part), "{part:?} is missing in:\n{told}");
    }
    let left = folder.path().join("runs/push_stick/seed-3");
    fs::copy(left.join("scenario.toml"), folder.path().join("push_stick.toml")).unwrap();
    let second = wield(folder.path(), &["run", "push_stick.toml", "--no-record", "--json", "--out", "again"]);
    assert_eq!(second.status.code(), first.status.code(), "{}", stderr(&second));
    let outcome = fs::read_to_string(left.join("outcome.json")).unwrap();
    assert_eq!(fs::read_to_string(folder.path().join("again/seed-3/outcome.json")).unwrap(), outcome);
    assert_eq!(stdout(&second), outcome, "--json prints what is written");
}

#[test]
fn trials_tell_a_rate_with_its_interval() {
    let folder = tempfile::tempdir().unwrap();
    let output =
        wield(folder.path(), &["run", &scenario(), "--trials", "2", "--no-record", "--min-success", "0", "--out", "o"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    let told = stdout(&output);
    for part in ["of 2 trials succeeded", "95 % interval", "Wilson", "seed", "worst"] {
        assert!(told.contains(part), "{part:?} is missing in:\n{told}");
    }
    assert!(folder.path().join("o/trials.json").exists() && folder.path().join("o/seed-2/outcome.json").exists());
}
