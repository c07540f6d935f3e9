//! The examples of the libraries run, in seconds, and print what they promise.
//!
//! They are built by the command that builds the tests of the whole workspace, and again here for a test that is built
//! alone: with the same selection of packages, so that nothing below them is compiled twice.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise, its helpers too")]

mod program;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use program::PROJECT;

/// Folder of the built examples, beside that of the running test.
fn folder() -> &'static Path {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    BUILT.get_or_init(|| {
        let tests = std::env::current_exe().unwrap();
        // <target>/<profile>/deps/<test>
        let profile = tests.ancestors().nth(2).unwrap();
        let mut cargo = Command::new(env!("CARGO"));
        cargo.current_dir(PROJECT).args(["build", "--quiet", "--offline", "--workspace", "--examples", "--profile"]);
        cargo.arg(if profile.ends_with("debug") { "dev".as_ref() } else { profile.file_name().unwrap() });
        let built = cargo.arg("--target-dir").arg(profile.parent().unwrap()).output().unwrap();
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        profile.join("examples")
    })
}

/// What the example prints; it must end with exit code 0 and without a word of complaint.
fn printed(example: &str) -> String {
    let program = folder().join(format!("{example}{}", std::env::consts::EXE_SUFFIX));
    let output = Command::new(&program).output().unwrap_or_else(|error| panic!("{}: {error}", program.display()));
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && complaint.is_empty(), "{example}: {complaint}");
    String::from_utf8(output.stdout).unwrap()
}

/// The number that stands behind `words` in `text`.
fn number(text: &str, words: &str) -> f64 {
    let (_, rest) = text.split_once(words).unwrap_or_else(|| panic!("no {words:?} in:\n{text}"));
    let end = rest.trim_start().find(|letter: char| !(letter.is_ascii_digit() || ".-e".contains(letter)));
    rest.trim_start()[..end.unwrap_or(rest.trim_start().len())].trim_end_matches('.').parse().unwrap()
}

/// Names of the example programs of a crate.
fn examples(package: &str) -> Vec<String> {
    let files = std::fs::read_dir(Path::new(PROJECT).join(format!("crates/{package}/examples"))).unwrap();
    let mut names: Vec<String> =
        files.flatten().map(|file| file.path().file_stem().unwrap().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn every_example_runs_is_small_and_is_named_on_the_front_page_of_its_crate() {
    for package in ["skills", "robot"] {
        let front = std::fs::read_to_string(Path::new(PROJECT).join(format!("crates/{package}/src/lib.rs"))).unwrap();
        for name in examples(package) {
            assert!(!printed(&name).is_empty(), "{name} prints nothing");
            assert!(front.contains(&format!("`{name}`")), "crates/{package}/src/lib.rs does not name `{name}`");
            let path = Path::new(PROJECT).join(format!("crates/{package}/examples/{name}.rs"));
            let text = std::fs::read_to_string(path).unwrap();
            assert!(text.lines().count() < 80, "{name} is no small example any more");
            assert!(
                text.contains(&format!("cargo run --release -p {package} --example {name}")),
                "{name}: how to run it"
            );
        }
    }
}

#[test]
fn a_demonstration_with_noise_is_learned_once_it_is_smoothed() {
    let text = printed("learn_from_csv");
    // the noise of the camera itself is 0.7 mm
    assert!(number(&text, "learned smoothed:") < 1.5, "{text}");
    assert!(number(&text, "new goal missed by") < 1.0, "{text}");
}

#[test]
fn goals_that_change_on_the_way_are_met_without_a_jump() {
    let text = printed("change_goal");
    assert!(number(&text, "largest step in 1 ms:") < 1.0, "{text}");
    assert!(number(&text, "goal missed by") < 0.1, "{text}");
    let text = printed("pose");
    // 290 degrees are not 70 the other way round
    assert!((number(&text, "turned by") - 290.0).abs() < 0.5, "{text}");
    for goal in ["left to the goal:", "left to the goal that moved:"] {
        assert!(number(&text, goal) < 0.05, "{text}");
    }
}

#[test]
fn via_points_are_passed_and_corridors_are_kept() {
    let text = printed("via_points");
    assert!(number(&text, "via point at 0.25 T missed by") < 0.01, "{text}");
    assert!(number(&text, "via point at 0.75 T missed by") < 0.01, "{text}");
    let text = printed("corridor");
    assert!(text.contains("plain motion: NOT inside") && text.contains("filtered motion: certified inside"), "{text}");
}

#[test]
fn what_is_loaded_moves_as_what_was_saved() {
    let text = printed("save_and_load");
    assert_eq!(text.matches("equal bits: true").count(), 4, "{text}");
    assert!(text.contains("a damaged file is refused") && text.contains("alpha"), "{text}");
}

#[test]
fn dynamics_add_up_postures_keep_limits_and_paths_are_met() {
    let text = printed("dynamics");
    assert!(number(&text, "is inverse dynamics to") < 1e-11, "{text}");
    assert!(number(&text, "forward dynamics inverts it to") < 1e-9, "{text}");
    let text = printed("inverse_kinematics");
    assert!(text.contains("within the limits: true") && text.contains("refused"), "{text}");
    let text = printed("follow_path");
    assert!(number(&text, "path met to") < 1e-9 && number(&text, "largest torque") < 100.0, "{text}");
}
