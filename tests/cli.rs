//! The built program: help, lists, checks, runs, and what they leave on disk.

#![allow(clippy::panic, reason = "helpers stop at the first surprise too")]

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
        (
            &["demonstrate", "--help"],
            &["demonstrations.json", "time_s, tool_x_m", "assets = [", "Examples:", "Exit codes"],
        ),
        (
            &["sweep", "--help"],
            &["[[factor]]", "log_uniform", "journal/", "SLURM_ARRAY_TASK_ID", "Examples:", "Exit codes"],
        ),
        (&["plan", "--help"], &["manifest.jsonl", "Examples:", "Exit codes"]),
        (&["check", "--help"], &["--set", "scenarios/sweeps", "Exit codes"]),
        (&["gains", "--help"], &["docs/arm.md", "--robot", "--frame", "Examples:", "Exit codes"]),
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
        &["demonstrate"],
        &["demonstrate", &file, "--count", "0"],
        &["demonstrate", &file, "--count", "1001"],
        &["demonstrate", &file, "--json", "--quiet"],
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
        "demonstrations:",
        "push_stick_5",
        "poses of the tool",
    ] {
        assert!(all.contains(part), "{part:?} is missing in:\n{all}");
    }
    let robots = stdout(&wield(folder.path(), &["list", "robots"]));
    assert!(robots.lines().any(|line| line.starts_with("planar_3r") && line.contains("3 joints")), "{robots}");
}

#[test]
fn assets_that_few_scenarios_name_are_listed_once_there_are_some() {
    let folder = tempfile::tempdir().unwrap();
    let assets = folder.path().join("assets");
    let list = |kinds: &[&str]| stdout(&program::wield(folder.path(), Some(&assets), &[&["list"], kinds].concat()));
    fs::create_dir(&assets).unwrap();
    assert!(!list(&[]).contains("foods:"));
    assert_eq!(list(&["foods"]), "");
    fs::create_dir(assets.join("foods")).unwrap();
    fs::copy(Path::new(PROJECT).join("assets/foods/grape.toml"), assets.join("foods/grape.toml")).unwrap();
    assert!(list(&[]).contains("foods:\n  grape  "), "{}", list(&[]));
    assert!(list(&["foods"]).starts_with("grape  "), "{}", list(&["foods"]));
}

#[test]
fn every_shipped_scenario_passes_its_check() {
    let folder = tempfile::tempdir().unwrap();
    let entries = |folder: &str| fs::read_dir(Path::new(PROJECT).join(folder)).unwrap().flatten();
    for entry in entries("scenarios").chain(entries("scenarios/sweeps")).filter(|entry| entry.path().is_file()) {
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
    let left = "runs/push_stick/seed-3/scenario.toml";
    let second = wield(folder.path(), &["run", left, "--no-record", "--json", "--out", "again"]);
    assert_eq!(second.status.code(), first.status.code(), "{}", stderr(&second));
    let read = |file: &str| fs::read_to_string(folder.path().join(file)).unwrap();
    let outcome = read("runs/push_stick/seed-3/outcome.json");
    assert_eq!(read("again/seed-3/outcome.json"), outcome);
    assert_eq!(read("again/seed-3/scenario.toml"), read(left), "what a repeated run leaves repeats it again");
    assert_eq!(stdout(&second), outcome, "--json prints what is written");
}

/// Runs the shipped scenario with parts of its text replaced; returns how it ended and its outcome.
fn run_changed(changes: &[(&str, &str)]) -> (Option<i32>, serde_json::Value) {
    let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let text = changes.iter().fold(program::shipped(), |text, (from, to)| program::replaced(&text, from, to));
    assert!(fs::write(folder.path().join("a.toml"), text).is_ok());
    let output = wield(folder.path(), &["run", "a.toml", "--no-record"]);
    let outcome = fs::read_to_string(folder.path().join("runs/a/seed-1/outcome.json")).unwrap_or_default();
    let outcome = serde_json::from_str(&outcome).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
    (output.status.code(), outcome)
}

/// Asserts that nothing was simulated, and that all `parts` stand in the one failure.
fn assert_infeasible(outcome: &serde_json::Value, parts: &[&str]) {
    assert_eq!((&outcome["success"], &outcome["trajectory_digest"]), (&false.into(), &"".into()));
    assert_eq!(outcome["measures"].as_array().map(Vec::len), Some(0), "nothing was simulated");
    let failures = outcome["failures"].as_array().map_or(&[][..], Vec::as_slice);
    let reason = failures.first().and_then(|reason| reason.as_str()).unwrap_or_default();
    assert!(failures.len() == 1 && parts.iter().all(|part| reason.contains(part)), "{failures:?}");
}

#[test]
fn an_open_loop_run_is_judged_like_any_other() {
    let (code, outcome) = run_changed(&[("mode = \"closed_loop\"", "mode = \"open_loop\"")]);
    let measures = outcome["measures"].as_array().unwrap();
    let judged: Vec<bool> = measures.iter().filter_map(|measure| measure["passed"].as_bool()).collect();
    assert!(judged.len() >= 3, "{measures:?}");
    let success = outcome["success"].as_bool().unwrap();
    assert_eq!(success, judged.iter().all(|passed| *passed));
    assert_eq!(success, outcome["failures"].as_array().unwrap().is_empty());
    assert_eq!(code, Some(if success { 0 } else { 1 }));
    assert_eq!(outcome["trajectory_digest"].as_str().map(str::is_empty), Some(false));
}

#[test]
fn a_goal_that_would_need_a_pull_is_an_outcome_without_a_simulation() {
    // the goal lies 10 mm to the right of the start, but the side of the stick pushes to the left
    let (code, outcome) = run_changed(&[("goal_m = [-0.055, 0.125]", "goal_m = [0.075, 0.125]")]);
    assert_eq!(code, Some(1));
    assert_infeasible(&outcome, &["the surface 'side'", "cannot pull"]);
}

#[test]
fn a_goal_out_of_reach_is_an_outcome_that_names_time_and_joint_or_distance() {
    let wide = ("max_m = [0.09, 0.18]", "max_m = [0.09, 1.18]");
    let (code, outcome) = run_changed(&[wide, ("goal_m = [-0.055, 0.125]", "goal_m = [-0.055, 0.9]")]);
    assert_eq!(code, Some(1));
    assert_infeasible(&outcome, &["s of the plan"]);
    let reason = outcome["failures"][0].as_str().unwrap();
    assert!(reason.contains("joint") || reason.contains(" m "), "{reason}");
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
