//! What runs leave: telemetry that agrees with the outcome, and earlier results that a refused or stopped run takes nothing from.

#![allow(clippy::panic, clippy::unwrap_used, clippy::indexing_slicing, reason = "a test stops at the first surprise")]

mod program;

use std::fs;
use std::path::Path;
use std::process::Output;

use arrow_array::cast::AsArray as _;
use arrow_array::types::Float64Type;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use program::PROJECT;
use serde_json::Value;

fn wield(folder: &Path, arguments: &[&str]) -> Output {
    program::wield(folder, Some(&Path::new(PROJECT).join("assets")), arguments)
}

fn shipped(name: &str) -> String {
    Path::new(PROJECT).join("scenarios").join(name).display().to_string()
}

/// The last values of columns of a telemetry, and the number of its rows.
fn last(file: &Path, columns: &[&str]) -> (Vec<f64>, usize) {
    let reader = ParquetRecordBatchReaderBuilder::try_new(fs::File::open(file).unwrap()).unwrap().build().unwrap();
    let batches: Vec<_> = reader.map(Result::unwrap).collect();
    let end = batches.last().unwrap();
    let value = |name: &&str| {
        let column = end.column_by_name(name).unwrap_or_else(|| panic!("no column {name}"));
        column.as_primitive::<Float64Type>().value(end.num_rows() - 1)
    };
    (columns.iter().map(value).collect(), batches.iter().map(arrow_array::RecordBatch::num_rows).sum())
}

fn measure(outcome: &Value, name: &str) -> f64 {
    let all = outcome["measures"].as_array().unwrap();
    all.iter().find(|measure| measure["name"] == name).unwrap()["value"].as_f64().unwrap()
}

#[test]
fn telemetry_ends_where_the_outcome_says_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = shipped("push_stick.toml");
    for options in [&["--telemetry", "--out", "with"][..], &["--out", "without"]] {
        let run = ["run", file.as_str(), "--no-record", "--quiet"];
        assert_eq!(wield(folder.path(), &[&run[..], options].concat()).status.code(), Some(0));
    }
    let outcome = |out: &str| fs::read(folder.path().join(out).join("seed-1/outcome.json")).unwrap();
    assert_eq!(outcome("with"), outcome("without"));
    assert!(!folder.path().join("without/seed-1/telemetry.parquet").exists());
    let told: Value = serde_json::from_slice(&outcome("with")).unwrap();
    let table = folder.path().join("with/seed-1/telemetry.parquet");
    let (values, rows) = last(&table, &["time_s", "object_x_m", "object_y_m"]);
    // the shipped goal, and the error that the outcome states
    let error_mm = 1e3 * (values[1] + 0.055).hypot(values[2] - 0.125);
    assert!((error_mm - measure(&told, "goal_error_mm")).abs() < 1e-6, "{error_mm} mm, {told:#}");
    // a row for each control period of 1 ms
    assert_eq!(rows, (values[0] / 1e-3).round() as usize + 1);

    let spatial = shipped("reach_panda.toml");
    let run = ["run", spatial.as_str(), "--no-record", "--quiet", "--telemetry", "--out", "reach"];
    assert_eq!(wield(folder.path(), &run).status.code(), Some(0));
    let told = fs::read(folder.path().join("reach/seed-1/outcome.json")).unwrap();
    let told: Value = serde_json::from_slice(&told).unwrap();
    let places = ["tool_x_m", "tool_y_m", "tool_z_m", "tool_reference_x_m", "tool_reference_y_m", "tool_reference_z_m"];
    let (at, _) = last(&folder.path().join("reach/seed-1/telemetry.parquet"), &places);
    let error_mm = 1e3 * ((at[0] - at[3]).powi(2) + (at[1] - at[4]).powi(2) + (at[2] - at[5]).powi(2)).sqrt();
    assert!((error_mm - measure(&told, "final_tool_error_mm")).abs() < 1e-3, "{error_mm} mm, {told:#}");
}

#[test]
fn a_refused_run_leaves_the_results_of_an_earlier_one_and_its_own_input() {
    let folder = tempfile::tempdir().unwrap();
    let file = shipped("hold_panda.toml");
    assert_eq!(wield(folder.path(), &["run", &file, "--quiet", "--no-record", "--out", "o"]).status.code(), Some(0));
    let left =
        || ["outcome.json", "scenario.toml"].map(|name| fs::read(folder.path().join("o/seed-1").join(name)).unwrap());
    let before = left();
    let again = ["run", "o/seed-1/scenario.toml", "--quiet", "--no-record", "--out", "o"];
    let gain = ["--set", "controller.impedance.error_gain_per_s=1e6"];
    let refused = wield(folder.path(), &[&again[..], &gain].concat());
    assert_eq!(refused.status.code(), Some(2), "{}", String::from_utf8_lossy(&refused.stderr));
    assert_eq!(left(), before);
    assert_eq!(fs::read_dir(folder.path().join("o")).unwrap().count(), 1, "nothing half-made is left");
}
