//! Skills that are transferred to other tools: what the built program plans, simulates and refuses.

#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test stops at the first surprise, its helpers too")]

mod program;

use std::fs;
use std::path::Path;

use serde_json::Value;

use program::{PROJECT, project, replaced, wield};

fn shipped(name: &str) -> String {
    fs::read_to_string(Path::new(PROJECT).join("scenarios").join(name)).unwrap()
}

/// Runs `file` of a project without a recording: the exit code, and the outcome that was left in the folder.
fn run(folder: &Path, file: &str, seed: u64) -> (Option<i32>, Value) {
    let seed_text = seed.to_string();
    let output = wield(folder, None, &["run", file, "--no-record", "--quiet", "--seed", &seed_text, "--out", "o"]);
    let left = fs::read_to_string(folder.join(format!("o/seed-{seed}/outcome.json")));
    let left = left.unwrap_or_else(|_| String::from_utf8_lossy(&output.stderr).into_owned());
    (output.status.code(), serde_json::from_str(&left).unwrap_or(Value::String(left)))
}

fn measure<'o>(outcome: &'o Value, name: &str) -> &'o Value {
    outcome["measures"].as_array().unwrap().iter().find(|measure| measure["name"] == name).unwrap()
}

#[test]
fn the_papers_tool_2_keeps_goal_margin_and_rest_in_a_world_that_differs() {
    let folder = project();
    fs::write(folder.path().join("l.toml"), shipped("push_transfer_l.toml")).unwrap();
    for seed in [1, 2] {
        let (code, outcome) = run(folder.path(), "l.toml", seed);
        assert_eq!(code, Some(0), "{outcome:#}");
        let notes: Vec<&str> = outcome["notes"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
        assert!(notes.contains(&"plan: surfaces bottom - tip - top"), "{notes:?}");
        let limits = [
            ("goal_error_mm", "at_most", 5.0),
            ("object_clearance_mm", "at_least", 15.0),
            ("knocked_mm", "at_most", 1.0),
        ];
        for (name, bound, limit) in limits {
            let measure = measure(&outcome, name);
            assert_eq!((&measure["limit"][bound], &measure["passed"]), (&limit.into(), &true.into()), "{name}");
        }
        // 20 % of the friction and mass that the scenario states, and 1 mm
        let drawn = |name: &str| measure(&outcome, name)["value"].as_f64().unwrap();
        let stated = [("varied_table_friction", 0.25), ("varied_tool_friction", 0.30), ("varied_mass_g", 5.4)];
        for (name, stated) in stated {
            let share = drawn(name) / stated - 1.0;
            assert!(share != 0.0 && share.abs() <= 0.2, "{name}: {share}");
        }
        for name in ["varied_start_x_mm", "varied_start_y_mm"] {
            assert!(drawn(name) != 0.0 && drawn(name).abs() <= 1.0, "{name}");
        }
    }
}

#[test]
fn a_goal_to_which_no_surface_pushes_is_an_outcome_with_its_reason() {
    let folder = project();
    fs::write(folder.path().join("never.toml"), shipped("push_transfer_infeasible.toml")).unwrap();
    let (code, outcome) = run(folder.path(), "never.toml", 1);
    assert_eq!(code, Some(1), "{outcome:#}");
    let reason = outcome["failures"][0].as_str().unwrap();
    assert!(reason.contains("the surfaces of the tool 'l' push towards -90°, 90°, 180°"), "{reason}");
    assert_eq!(outcome["measures"], Value::Array(Vec::new()));
}

#[test]
fn learned_skills_give_the_run_of_fresh_ones() {
    let folder = project();
    let text = shipped("push_transfer_l.toml");
    fs::write(folder.path().join("fresh.toml"), &text).unwrap();
    let skills = folder.path().join("assets/skills");
    fs::create_dir(&skills).unwrap();
    let file = skills.join("shown.toml").display().to_string();
    let learned = wield(folder.path(), None, &["learn", "fresh.toml", "--seed", "3", "--out", &file]);
    assert_eq!(learned.status.code(), Some(0), "{}", String::from_utf8_lossy(&learned.stderr));

    let (from, to) = (text.find("[demonstrations.synthetic]").unwrap(), text.find("[primitive.dmp]").unwrap());
    let learned = replaced(&text, &text[from..to], "[demonstrations.learned]\nasset = \"shown\"\n\n");
    fs::write(folder.path().join("learned.toml"), learned).unwrap();
    let [fresh, learned] = ["fresh.toml", "learned.toml"].map(|file| run(folder.path(), file, 3).1);
    assert!(!fresh["trajectory_digest"].as_str().unwrap().is_empty());
    assert_eq!(learned["trajectory_digest"], fresh["trajectory_digest"]);
    assert_eq!(measure(&learned, "goal_error_mm"), measure(&fresh, "goal_error_mm"));
}
