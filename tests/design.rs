//! Tool design, as a user does it: a design file, the best tool as an asset, the comparison with the start on fresh seeds.

#![allow(clippy::unwrap_used, reason = "a test stops at the first surprise")]

mod program;

use std::fs;
use std::path::Path;

use program::{PROJECT, project, wield};

/// An L for the transfer: how long must its arm be. Few candidates and seeds, since what is tested is the way round.
const DESIGN: &str = "\
[design]
name = \"own\"
scenario = \"push.toml\"
asset = \"tool.asset\"
minimize = \"duration_s\"
trials = 2
evaluations = 4
check_trials = 3

[[parameter]]
key = \"family.l.arm_m\"
min = 0.035
max = 0.055
";

fn folder() -> tempfile::TempDir {
    let folder = project();
    fs::copy(Path::new(PROJECT).join("scenarios/push_transfer_l.toml"), folder.path().join("push.toml")).unwrap();
    fs::write(folder.path().join("own.toml"), DESIGN).unwrap();
    folder
}

#[test]
fn a_design_is_the_same_again_and_goes_on_from_what_is_known() {
    let folder = folder();
    let run = |out: &str, threads: &str| {
        let output =
            wield(folder.path(), None, &["design", "own.toml", "--out", out, "--threads", threads, "--no-record"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(matches!(output.status.code(), Some(0 | 1)), "{said}");
        (output.status.code(), fs::read(folder.path().join(out).join("design.json")).unwrap())
    };
    let first = run("one", "1");
    assert_eq!(first, run("two", "2"));
    // what a kill leaves: a journal whose last line is cut off
    let journal = folder.path().join("two/journal/0of1-0.jsonl");
    let text = fs::read(&journal).unwrap();
    fs::write(&journal, &text[..text.len() * 2 / 3]).unwrap();
    assert_eq!(first, run("two", "2"));

    let report: serde_json::Value = serde_json::from_slice(&first.1).unwrap();
    let candidates = report["candidates"].as_array().unwrap();
    assert_eq!(candidates.len(), 4);
    assert_eq!(candidates[0]["values"][0].as_f64(), Some(0.040), "the start is the first candidate");
    let tool: toml::Table = fs::read_to_string(folder.path().join("one/own.toml")).unwrap().parse().unwrap();
    let best = &candidates[usize::try_from(report["best"].as_u64().unwrap()).unwrap()];
    assert_eq!(tool["name"].as_str(), Some("own"));
    assert_eq!(tool["family"]["l"]["arm_m"].as_float(), best["values"][0].as_f64());
    if first.0 == Some(0) {
        let checked = fs::read_to_string(folder.path().join("one/check/comparison.json")).unwrap();
        let checked: serde_json::Value = serde_json::from_str(&checked).unwrap();
        assert_eq!(checked["seeds"], serde_json::json!([3, 4, 5]), "seeds that the search never saw");
    }
}

#[test]
fn what_is_wrong_with_a_design_is_told_at_its_place() {
    let folder = folder();
    for (from, to, said) in [
        ("minimize = \"duration_s\"", "minimize = \"duratio_s\"", "expected one of"),
        ("family.l.arm_m", "family.l.arn_m", "own.toml:11:7"),
        ("min = 0.035", "min = 0.045", "the start lies outside the range"),
        ("asset = \"tool.asset\"", "asset = \"knife.asset\"", "the scenario names no such asset"),
        ("trials = 2\n", "trials = 0\n", "own.toml:6:10"),
    ] {
        fs::write(folder.path().join("own.toml"), DESIGN.replacen(from, to, 1)).unwrap();
        let output = wield(folder.path(), None, &["design", "own.toml", "--quiet"]);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains(said), "{told}");
    }
}
