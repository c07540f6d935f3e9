//! Equal scenario and seed, equal results: byte by byte, on any number of threads, wherever and however the program runs.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise, its helpers too")]

mod program;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use program::PROJECT;

/// The program with the shipped scenario, in `folder`.
fn run_in(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_wield"));
    command.arg("run").arg(scenario()).arg("--quiet").current_dir(folder).env_remove("WIELD_ASSETS");
    command
}

fn scenario() -> PathBuf {
    Path::new(PROJECT).join("scenarios/push_stick.toml").canonicalize().unwrap()
}

/// Runs to an outcome, and returns the text of a file that it left.
fn left_by(command: &mut Command, file: &Path) -> String {
    let output = command.output().unwrap();
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", String::from_utf8_lossy(&output.stderr));
    fs::read_to_string(file).unwrap()
}

/// The outcome of a run with `seed` into a fresh folder, without a recording.
fn outcome(seed: u64) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut command = run_in(folder.path());
    command.args(["--no-record", "--out", "o", "--seed", &seed.to_string()]);
    left_by(&mut command, &folder.path().join(format!("o/seed-{seed}/outcome.json")))
}

fn digest(outcome: &str) -> String {
    let outcome: serde_json::Value = serde_json::from_str(outcome).unwrap();
    let digest = outcome["trajectory_digest"].as_str().unwrap();
    assert!(!digest.is_empty(), "nothing was simulated: {outcome}");
    digest.to_owned()
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_trajectory() {
    let (first, second) = (outcome(5), outcome(5));
    assert_eq!(first, second);
    assert_eq!(digest(&first), digest(&second));
}

#[test]
fn other_seeds_give_other_trajectories() {
    assert_ne!(digest(&outcome(5)), digest(&outcome(6)));
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    for threads in ["1", "4"] {
        let mut command = run_in(folder.path());
        command.args(["--no-record", "--trials", "4", "--threads", threads, "--out", threads]);
        left_by(&mut command, &folder.path().join(threads).join("trials.json"));
    }
    let files = (1..=4).map(|seed| format!("seed-{seed}/outcome.json")).chain(["trials.json".to_owned()]);
    for file in files {
        let [one, four] = ["1", "4"].map(|threads| fs::read(folder.path().join(threads).join(&file)).unwrap());
        assert_eq!(one, four, "{file}");
    }
}

#[test]
fn results_do_not_depend_on_where_the_program_runs() {
    let folder = tempfile::tempdir().unwrap();
    let elsewhere = folder.path().join("a folder/für sich");
    fs::create_dir_all(&elsewhere).unwrap();
    let mut command = run_in(&elsewhere);
    command.args(["--no-record", "--seed", "5"]);
    let found = left_by(&mut command, &elsewhere.join("runs/push_stick/seed-5/outcome.json"));
    assert_eq!(found, outcome(5));
}

#[test]
fn results_do_not_depend_on_the_environment() {
    let expected = outcome(5);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("o/seed-5/outcome.json");
    let settings: [&[(&str, &str)]; 4] = [
        &[("HOME", "/does/not/exist")],
        &[("LANG", "de_DE.UTF-8"), ("LC_ALL", "de_DE.UTF-8"), ("LC_NUMERIC", "de_DE.UTF-8")],
        &[("LANG", "C"), ("LC_ALL", "tr_TR.UTF-8")],
        &[("TZ", "Pacific/Auckland"), ("RAYON_NUM_THREADS", "3"), ("NO_COLOR", "1")],
    ];
    for variables in settings {
        let mut command = run_in(folder.path());
        command.args(["--no-record", "--seed", "5", "--out", "o"]).envs(variables.iter().copied());
        assert_eq!(left_by(&mut command, &file), expected, "{variables:?}");
    }
    let mut command = run_in(folder.path());
    command.args(["--no-record", "--seed", "5", "--out", "o"]).env_clear();
    assert_eq!(left_by(&mut command, &file), expected, "an empty environment");
}

#[test]
fn results_do_not_depend_on_the_recorder() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = run_in(folder.path());
    command.args(["--seed", "5", "--out", "o"]);
    let recorded = left_by(&mut command, &folder.path().join("o/seed-5/outcome.json"));
    assert_eq!(folder.path().join("o/seed-5/recording.rrd").exists(), cfg!(feature = "recording"));
    assert_eq!(recorded, outcome(5));
}
