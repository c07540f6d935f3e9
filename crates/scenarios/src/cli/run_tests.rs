//! Tests of `wield run` with a pipeline that ends as its seed says: 0 misses, 13 panics, 14 diverges, 15 and 16 are refused, others succeed.

use std::fs;

use super::*;
use crate::outcome::{Limit, Measure, OUTCOME_SCHEMA, Outcome};
use crate::pipeline::{Onlooker, Progress, Report, RunError};
use clap::Parser;

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    run: RunArguments,
}

fn pretended(
    scenario: &ResolvedScenario,
    seed: u64,
    _: &mut dyn Onlooker,
    _: Progress<'_>,
) -> Result<Report, RunError> {
    match seed {
        13 => panic!("unlucky"),
        14 => return Err(RunError { stage: "simulate", reason: "diverged".into(), is_input: false }),
        15 | 16 => return Err(RunError { stage: "plan", reason: "senseless".into(), is_input: true }),
        _ => {}
    }
    let error_mm = if seed == 0 { 9.0 } else { seed as f64 / 100.0 };
    let measure = Measure::judged("goal_error_mm", "distance to the goal", error_mm, "mm", Limit::AtMost(5.0));
    let success = measure.passed == Some(true);
    let outcome = Outcome {
        schema: OUTCOME_SCHEMA.into(),
        scenario: scenario.name.clone(),
        task: "push".into(),
        seed,
        version: "0".into(),
        success,
        failures: if success { vec![] } else { vec!["too far".into()] },
        measures: vec![measure],
        notes: vec![],
        trajectory_digest: format!("{seed:04}"),
    };
    Ok(Report { outcome, timings_s: vec![("simulate", 0.1)], simulated_s: 1.0 })
}

fn run(out: &Path, options: &[&str]) -> Exit {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/push_stick.toml");
    let out = out.to_str().unwrap();
    let line = ["run", file, "--out", out, "--quiet", "--no-record"].into_iter().chain(options.iter().copied());
    execute(&Line::try_parse_from(line).unwrap().run, None, pretended)
}

#[test]
fn a_run_leaves_its_outcome_and_a_scenario_that_repeats_it() {
    let out = tempfile::tempdir().unwrap();
    assert_eq!(run(out.path(), &["--seed", "7"]), Exit::Success);
    let folder = out.path().join("seed-7");
    let outcome: Outcome = serde_json::from_str(&fs::read_to_string(folder.join("outcome.json")).unwrap()).unwrap();
    assert_eq!((outcome.seed, outcome.success), (7, true));
    let assets = crate::assets::Assets::at(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets"));
    let again = crate::scenario::load(&folder.join("scenario.toml"), &assets).unwrap();
    assert_eq!(again.header().seed, 7);
}

#[test]
fn each_ending_has_its_exit_code() {
    let out = tempfile::tempdir().unwrap();
    let codes = ["1", "0", "13", "14"].map(|seed| run(out.path(), &["--seed", seed]));
    assert_eq!(codes, [Exit::Success, Exit::Missed, Exit::Crashed, Exit::Crashed]);
}

#[test]
fn a_refused_run_leaves_nothing() {
    let root = tempfile::tempdir().unwrap();
    for trials in ["1", "2"] {
        let options = ["--seed", "15", "--trials", trials];
        assert_eq!(run(&root.path().join("a/b"), &options), Exit::BadInput);
    }
    assert_eq!(fs::read_dir(root.path()).unwrap().count(), 0);
}

#[test]
fn a_refused_run_takes_nothing_away() {
    let out = tempfile::tempdir().unwrap();
    fs::create_dir_all(out.path().join("seed-15")).unwrap();
    for name in ["outcome.json", "scenario.toml", "recording.rrd"] {
        fs::write(out.path().join("seed-15").join(name), "old").unwrap();
    }
    for trials in ["1", "2"] {
        assert_eq!(run(out.path(), &["--seed", "15", "--trials", trials]), Exit::BadInput);
        for name in ["outcome.json", "scenario.toml", "recording.rrd"] {
            assert_eq!(fs::read_to_string(out.path().join("seed-15").join(name)).unwrap(), "old");
        }
    }
    assert_eq!(fs::read_dir(out.path()).unwrap().count(), 1);
}

#[test]
fn a_scenario_is_not_replaced_by_a_recording() {
    let out = tempfile::tempdir().unwrap();
    let mine = out.path().join("mine.toml");
    fs::write(&mine, "[scenario]\n").unwrap();
    let line = ["run", "x.toml", "--record", mine.to_str().unwrap()];
    assert!(Line::try_parse_from(line).unwrap().run.check_recording().is_err());
    assert_eq!(fs::read_to_string(&mine).unwrap(), "[scenario]\n");
}

#[test]
fn a_crash_leaves_no_outcome_of_an_earlier_run() {
    let out = tempfile::tempdir().unwrap();
    fs::create_dir_all(out.path().join("seed-13")).unwrap();
    fs::write(out.path().join("seed-13/outcome.json"), "old").unwrap();
    assert_eq!(run(out.path(), &["--seed", "13"]), Exit::Crashed);
    assert!(!out.path().join("seed-13/outcome.json").exists());
    assert!(out.path().join("seed-13/scenario.toml").exists());
}

#[test]
fn trials_do_not_depend_on_threads_and_a_panic_is_one_row() {
    let folders = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let texts = [("1", &folders[0]), ("4", &folders[1])].map(|(threads, out)| {
        let options = ["--seed", "9", "--trials", "6", "--threads", threads, "--min-success", "0.5"];
        assert_eq!(run(out.path(), &options), Exit::Crashed);
        fs::read_to_string(out.path().join("trials.json")).unwrap()
    });
    assert_eq!(texts[0], texts[1]);
    let report: TrialsReport = serde_json::from_str(&texts[0]).unwrap();
    let seeds: Vec<u64> = report.trials.iter().map(|trial| trial.seed).collect();
    assert_eq!(seeds, [9, 10, 11, 12, 13, 14]);
    assert!(report.trials[4].reason().contains("unlucky"));
    assert_eq!((report.successes, report.measures[0].worst), (4, Some(0.12)));
}

#[test]
fn the_wanted_share_decides_about_the_exit_code() {
    let out = tempfile::tempdir().unwrap();
    let options = ["--seed", "0", "--trials", "4", "--min-success"];
    let code = |share| run(out.path(), &[&options[..], &[share]].concat());
    assert_eq!([code("0.75"), code("0.8")], [Exit::Success, Exit::Missed]);
}

#[test]
fn seeds_beyond_the_largest_are_refused() {
    let out = tempfile::tempdir().unwrap();
    let largest = LARGEST_SEED.to_string();
    assert_eq!(run(&out.path().join("new"), &["--seed", &largest, "--trials", "2"]), Exit::BadInput);
    assert!(!out.path().join("new").exists());
}
