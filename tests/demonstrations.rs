//! What a synthetic human shows: the files it leaves, that they can be learned from, and what is refused.

#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test stops at the first surprise, its helpers too")]

mod program;

use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::Value;

use program::{PROJECT, place, project, replaced, shipped, wield};

/// Largest file of a shipped demonstration, bytes.
const LARGEST_BYTES: u64 = 200_000;

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn summary(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("demonstrations.json")).unwrap()).unwrap()
}

/// Lines of a CSV file that are comments, and the others.
fn comments_and_rows(text: &str) -> (Vec<&str>, Vec<&str>) {
    text.lines().partition(|line| line.starts_with('#'))
}

/// A fresh project with the shipped recordings and, as `recorded.toml`, the scenario that learns from them.
fn project_with_recordings() -> tempfile::TempDir {
    let folder = project();
    let copied = folder.path().join("assets/demonstrations");
    fs::create_dir(&copied).unwrap();
    for entry in fs::read_dir(Path::new(PROJECT).join("assets/demonstrations")).unwrap().flatten() {
        fs::copy(entry.path(), copied.join(entry.file_name())).unwrap();
    }
    let scenario = Path::new(PROJECT).join("scenarios/push_stick_recorded.toml");
    fs::copy(scenario, folder.path().join("recorded.toml")).unwrap();
    folder
}

#[test]
fn every_trial_is_kept_with_what_the_recorders_saw_and_no_more() {
    let folder = project();
    fs::write(folder.path().join("a.toml"), shipped()).unwrap();
    let output = wield(folder.path(), None, &["demonstrate", "a.toml", "--count", "2", "--seed", "7"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    for part in ["a_1.csv", "a_2.csv", "trials of a with seed 7 succeeded", "results: runs/a/seed-7/demonstrations"] {
        assert!(told.contains(part), "{part:?} is missing in:\n{told}");
    }
    let left = folder.path().join("runs/a/seed-7/demonstrations");
    let summary = summary(&left);
    assert_eq!((&summary["schema"], &summary["seed"]), (&"wield.demonstrations/1".into(), &7.into()));
    for (index, trial) in summary["trials"].as_array().unwrap().iter().enumerate() {
        let text = fs::read_to_string(left.join(trial["file"].as_str().unwrap())).unwrap();
        let (comments, rows) = comments_and_rows(&text);
        let number = format!("# trial: {}", index + 1);
        let expected =
            ["# scenario: a", "# seed: 7", &number, "# tool: stick", "# surfaces: side, head", "# result: success"];
        assert_eq!(comments, expected);
        assert_eq!(rows[0], "time_s,tool_x_m,tool_y_m,tool_angle_rad,object_x_m,object_y_m,object_angle_rad");
        assert!(rows.iter().any(|row| row.ends_with(",,,")), "rows of the tool alone");
        assert!(rows.iter().any(|row| row.contains(",,,,")), "rows of the object alone");
        let duration_s = trial["duration_s"].as_f64().unwrap();
        let touches = trial["touches_s"].as_array().unwrap();
        assert!(!touches.is_empty(), "a push touches");
        for touch in touches {
            let (first, last) = (touch[0].as_f64().unwrap(), touch[1].as_f64().unwrap());
            assert!(0.0 <= first && first <= last && last <= duration_s, "{touch} in {duration_s} s");
        }
    }
}

#[test]
fn a_run_that_learns_from_the_files_succeeds() {
    let folder = project();
    fs::write(folder.path().join("a.toml"), shipped()).unwrap();
    let shown = wield(folder.path(), None, &["demonstrate", "a.toml", "--quiet", "--out", "assets/demonstrations"]);
    assert_eq!((shown.status.code(), shown.stdout.len()), (Some(0), 0), "{}", stderr(&shown));
    let (before, after) =
        shipped().split_once("[demonstrations.synthetic]").map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    let after = after.split_once("\n\n").unwrap().1;
    let recorded = "[demonstrations.recorded]\nassets = [\"a_1\", \"a_2\", \"a_3\", \"a_4\", \"a_5\"]";
    fs::write(folder.path().join("b.toml"), format!("{before}{recorded}\n\n{after}")).unwrap();
    let output = wield(folder.path(), None, &["run", "b.toml", "--no-record"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn the_shipped_recordings_show_the_task() {
    let folder = tempfile::tempdir().unwrap();
    for number in 1..=5 {
        let file = Path::new(PROJECT).join(format!("assets/demonstrations/push_stick_{number}.csv"));
        assert!(fs::metadata(&file).unwrap().len() < LARGEST_BYTES, "{}", file.display());
        let text = fs::read_to_string(file).unwrap();
        let (comments, _) = comments_and_rows(&text);
        assert!(comments.contains(&"# seed: 7") && comments.contains(&"# result: success"), "{comments:?}");
    }
    let file = Path::new(PROJECT).join("scenarios/push_stick_recorded.toml").display().to_string();
    let output = wield(folder.path(), Some(&Path::new(PROJECT).join("assets")), &["run", &file, "--no-record"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn trials_that_fail_are_kept_and_marked() {
    let folder = project();
    // no hand brings the disc to a nanometer
    let text = replaced(
        &shipped(),
        "[primitive.dmp]",
        "[demonstrations.synthetic.human]\nsatisfied_m = 1e-9\n\n[primitive.dmp]",
    );
    fs::write(folder.path().join("a.toml"), text).unwrap();
    let output = wield(folder.path(), None, &["demonstrate", "a.toml", "--count", "1", "--out", "shown", "--json"]);
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let summary = summary(&folder.path().join("shown"));
    assert_eq!(serde_json::from_slice::<Value>(&output.stdout).unwrap(), summary, "--json prints what is written");
    assert!(summary["shortage"].as_str().unwrap().contains("0 of 1 demonstrations succeeded in 4 trials"), "{summary}");
    let trials = summary["trials"].as_array().unwrap();
    assert_eq!((trials.len(), &summary["successes"]), (4, &0.into()));
    for trial in trials {
        let text = fs::read_to_string(folder.path().join("shown").join(trial["file"].as_str().unwrap())).unwrap();
        let marked = format!("# result: failure: {}", trial["failure"].as_str().unwrap());
        assert!(comments_and_rows(&text).0.contains(&marked.as_str()), "{marked}");
    }
}

#[test]
fn the_same_seed_shows_the_same_bytes() {
    let folder = project();
    fs::write(folder.path().join("a.toml"), shipped()).unwrap();
    for out in ["first", "second"] {
        let output = wield(folder.path(), None, &["demonstrate", "a.toml", "--count", "2", "--quiet", "--out", out]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    for file in ["a_1.csv", "a_2.csv", "demonstrations.json"] {
        let [first, second] = ["first", "second"].map(|out| fs::read(folder.path().join(out).join(file)).unwrap());
        assert_eq!(first, second, "{file}");
    }
    assert_ne!(
        fs::read(folder.path().join("first/a_1.csv")).unwrap(),
        fs::read(folder.path().join("first/a_2.csv")).unwrap()
    );
}

#[test]
fn a_scenario_that_nobody_can_show_is_refused_without_a_trace() {
    let folder = project_with_recordings();
    // the side of the stick would have to pull the disc to the right
    let pull = replaced(&shipped(), "goal_m = [-0.060, 0.130]", "goal_m = [0.070, 0.130]");
    fs::write(folder.path().join("pull.toml"), pull).unwrap();
    for (file, part) in
        [("recorded.toml", "expected [demonstrations.synthetic]"), ("pull.toml", "surface 0 of the list would pull")]
    {
        let output = wield(folder.path(), None, &["demonstrate", file]);
        assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
        assert!(stderr(&output).contains(part) && stderr(&output).contains(file), "{}", stderr(&output));
        assert!(!folder.path().join("runs").exists(), "something was written");
    }
}

#[test]
fn a_camera_that_hardly_sees_the_object_is_named_as_the_cause() {
    let folder = project();
    fs::write(folder.path().join("a.toml"), shipped()).unwrap();
    for (change, cause) in [
        ("camera.drop_out=0.99", "takes 30 frames a second and misses 99 % of them"),
        ("camera.rate_hz=0.5", "takes 0.5 frames a second"),
    ] {
        let output = wield(folder.path(), None, &["run", "a.toml", "--set", change, "--no-record", "--out", "o"]);
        let told = String::from_utf8_lossy(&output.stdout).into_owned() + &stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{told}");
        for part in ["the object was not recorded for", cause, "raise camera.rate_hz or lower camera.drop_out"] {
            assert!(told.contains(part), "{part:?} is missing in:\n{told}");
        }
    }
}

#[test]
fn a_mistake_in_a_recording_points_into_the_csv_file() {
    for (from, to, at, parts) in [
        ("tool_y_m", "tool_y_mm", "tool_y_mm", ["missing column `tool_y_m`", "did you mean `tool_y_m`?"]),
        ("\n1.000000,", "\n1.000000,zero", "zero", ["bad value in the column `tool_x_m`", "expected a finite number"]),
        ("\n1.000000,", "\n0.500000001,", "0.500000001", ["the times of the tool do not increase", "after 0.995 s"]),
    ] {
        let folder = project_with_recordings();
        let file = folder.path().join("assets/demonstrations/push_stick_2.csv");
        let text = replaced(&fs::read_to_string(&file).unwrap(), from, to);
        fs::write(&file, &text).unwrap();
        let place = format!("push_stick_2.csv:{}", place(&text, at));
        for verb in ["check", "run", "demonstrate"] {
            let output = wield(folder.path(), None, &[verb, "recorded.toml"]);
            let message = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{message}");
            for part in parts.into_iter().chain([place.as_str(), "entry 2 of `assets` in [demonstrations.recorded]"]) {
                assert!(message.contains(part), "{part:?} is missing in:\n{message}");
            }
            assert!(!folder.path().join("runs").exists(), "something was written");
        }
    }
}
