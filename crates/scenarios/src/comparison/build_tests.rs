//! Tests of comparisons: what is missing is named, what is better is told from what is worse.

use super::*;
use crate::campaign::{Base, PlannedRun, RunId};

fn run(index: u64, seed: u64) -> PlannedRun {
    let run_id: RunId = serde_json::from_str("\"00\"").unwrap();
    PlannedRun { index, run_id, seed, values: vec![toml::Value::from("a")], invalid: Vec::new() }
}

fn manifest(runs: u64, seeds: u64) -> Manifest {
    let base = Base {
        schema: String::new(),
        version: "0".into(),
        scenario: "push".into(),
        task: "push".into(),
        file: "push.toml".into(),
        assets: "assets".into(),
        text: String::new(),
        factors: vec![crate::campaign::Factor { key: "tool.asset".into() }],
        runs,
    };
    Manifest { base, runs: (0..runs).map(|index| run(index, 1 + index % seeds)).collect() }
}

fn row(run: &PlannedRun, value: Option<f64>) -> Row {
    let Some(value) = value else { return Row::without_outcome(run, Status::Crashed, "it broke".into(), 0.0) };
    let judged = Measure::judged("error_mm", "error", value, "mm", Limit::AtMost(10.0));
    Row {
        status: if value <= 10.0 { Status::Success } else { Status::Missed },
        measures: vec![judged, Measure::reported("steps", "steps", value, "1")],
        ..Row::without_outcome(run, Status::Missed, String::new(), 0.0)
    }
}

/// Two variants of eight seeds: the second is one better, but for its third run, which crashed.
fn rows(manifest: &Manifest) -> Vec<Row> {
    let value = |index: u64| match index {
        10 => None,
        0..8 => Some(4.0 + index as f64),
        _ => Some(3.0 + (index - 8) as f64 - 0.01 * index as f64),
    };
    manifest.runs.iter().map(|run| row(run, value(run.index))).collect()
}

fn names() -> Vec<String> {
    ["stick", "l"].map(String::from).to_vec()
}

#[test]
fn a_crashed_run_is_counted_and_named() {
    let manifest = manifest(16, 8);
    let found = compare(&manifest, "a push", &rows(&manifest), &names(), &[]).unwrap();
    assert_eq!(found.seeds, [1, 2, 3, 4, 5, 6, 7, 8]);
    let [measure] = found.measures.as_slice() else { panic!("one measure is judged") };
    let difference = &measure.differences[0];
    assert_eq!((difference.missing_seeds.as_slice(), difference.test.unwrap().pairs), ([3].as_slice(), 7));
    assert_eq!(measure.variants[1].values[2], None);
    assert_eq!((found.variants[1].failed[0].seed, found.variants[1].failed[0].status), (3, Status::Crashed));
    // seed 8 of the first is above its limit, the second's is not; seed 3 of the second crashed
    let success = &found.success[0];
    assert_eq!([success.both, success.only_first, success.only_this, success.neither], [6, 1, 1, 0]);
    assert_eq!((success.p, success.verdict), (1.0, Verdict::NotToldApart));
}

#[test]
fn less_is_better_where_the_limit_is_an_upper_one() {
    let manifest = manifest(16, 8);
    let found = compare(&manifest, "a push", &rows(&manifest), &names(), &["steps".into()]).unwrap();
    let [judged, asked] = found.measures.as_slice() else { panic!("two measures") };
    let difference = &judged.differences[0];
    assert_eq!((difference.verdict, difference.better), (Verdict::Real, Some(true)));
    // all seven pairs point the same way
    assert_eq!(difference.test.unwrap().p, 2.0 / 128.0);
    assert_eq!((asked.limit, asked.differences[0].better), (Limits::None, None));
}

#[test]
fn a_measure_that_no_run_has_is_told_with_those_that_there_are() {
    let manifest = manifest(16, 8);
    let said = compare(&manifest, "", &rows(&manifest), &names(), &["stepz".into()]).unwrap_err().to_string();
    assert_eq!(
        said,
        "--measure stepz: no run has this measure; expected one of error_mm, steps; did you mean `steps`?"
    );
}

#[test]
fn the_first_runs_of_all_variants_tell_which_measures_there_are() {
    let manifest = manifest(16, 8);
    let mut rows = rows(&manifest);
    rows.iter_mut().for_each(|row| row.trajectory_digest = Some("00".into()));
    // only the second variant has this measure
    rows[8].measures.push(Measure::reported("flips", "flips", 0.0, "1"));
    let first = [&rows[0], &rows[8]];
    assert_eq!(check_measures(&first, &["steps".into(), "flips".into()]), Ok(()));
    assert_eq!(check_measures(&first, &["flip".into()]).unwrap_err().known, ["error_mm", "steps", "flips"]);
    // one that was not simulated to its end tells nothing of the others of its variant
    let mut broken = rows[8].clone();
    broken.trajectory_digest = None;
    assert_eq!(check_measures(&[&rows[0], &broken], &["flip".into()]), Ok(()));
}

#[test]
fn variants_whose_trials_are_all_the_same_run_are_one_pair() {
    let manifest = manifest(16, 8);
    let mut rows = rows(&manifest);
    for (index, row) in rows.iter_mut().enumerate() {
        row.trajectory_digest = Some(if index < 8 { "00" } else { "01" }.into());
    }
    let compared = compare(&manifest, "", &rows, &names(), &[]).unwrap();
    assert!(compared.variants.iter().all(|variant| variant.independent_trials == 1));
    let difference = &compared.measures[0].differences[0];
    assert_eq!((difference.test.map(|test| test.pairs), difference.verdict), (Some(1), Verdict::TooFew));
    assert_eq!(compared.success[0].verdict, Verdict::TooFew);
    assert_eq!(super::super::remarks(&compared).len(), 1);
    // one variant that draws something makes pairs of its own
    rows.iter_mut().skip(8).enumerate().for_each(|(index, row)| row.trajectory_digest = Some(format!("1{index}")));
    let compared = compare(&manifest, "", &rows, &names(), &[]).unwrap();
    // its third run crashed
    assert_eq!(compared.measures[0].differences[0].test.map(|test| test.pairs), Some(7));
}
