//! `wield compare` as users drive it: what it writes, what it refuses, and its statistics against a naive computation.

#![allow(clippy::panic, clippy::unwrap_used, reason = "helpers stop at the first surprise too")]

mod program;
#[cfg(feature = "recording")]
#[path = "recording/read_back.rs"]
#[allow(dead_code, reason = "each test program uses its own part of this")]
mod read_back;

use std::fs;
use std::path::Path;
use std::process::Output;

use arrow_array::cast::AsArray as _;
use arrow_array::types::Float64Type;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use program::{PROJECT, replaced, shipped};
use scenarios::campaign::{JournalReader, Row};
use scenarios::comparison::{Comparison, Verdict};
use scenarios::trials::Status;

/// Differences of values of a few mm, computed in another order.
const ROUNDING: f64 = 1e-9;

/// The shipped push, carried out without looking: the quickest there is; each seed has its own friction and start.
fn quick() -> String {
    let text = replaced(&shipped(), "mode = \"closed_loop\"", "mode = \"open_loop\"");
    text + "\n[variation]\ntable_friction_share = 0.3\nstart_m = 0.002\n"
}

fn wield(folder: &Path, arguments: &[&str]) -> Output {
    program::wield(folder, Some(&Path::new(PROJECT).join("assets")), arguments)
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

fn comparison(folder: &Path) -> Comparison {
    serde_json::from_slice(&fs::read(folder.join("comparison.json")).unwrap()).unwrap()
}

/// All rows of the journals, in the order of the manifest.
fn rows(folder: &Path) -> Vec<Row> {
    let mut rows = Vec::new();
    for entry in fs::read_dir(folder.join("journal")).unwrap().flatten() {
        let mut journal = JournalReader::open(&entry.path()).unwrap();
        while let Some((_, row)) = journal.next_row().unwrap() {
            rows.push(row);
        }
    }
    rows.sort_by_key(|row| row.index);
    rows
}

const VARY: [&str; 2] = ["--vary", "object.table_friction=0.15,0.25,0.40"];

#[test]
fn a_comparison_is_written_whole_and_does_not_depend_on_threads() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("quick.toml"), quick()).unwrap();
    let run = |threads: &str, out: &str| {
        let fixed = ["compare", "quick.toml", "--trials", "4", "--no-record", "--threads", threads, "--out", out];
        wield(folder.path(), &[&fixed[..], &VARY].concat())
    };
    let (one, two) = (run("1", "one"), run("2", "two"));
    assert_eq!((one.status.code(), two.status.code()), (Some(0), Some(0)), "{}", said(&one));
    let bytes = |out: &str, file: &str| fs::read(folder.path().join(out).join(file)).unwrap();
    assert_eq!(bytes("one", "comparison.json"), bytes("two", "comparison.json"));
    assert_eq!(bytes("one", "report.html"), bytes("two", "report.html"));

    let told = said(&one);
    for part in ["table_friction = 0.15", "4 of 4", "too few", "median", "report: one/report.html"] {
        assert!(told.contains(part), "{part:?} is missing in:\n{told}");
    }
    let page = String::from_utf8(bytes("one", "report.html")).unwrap();
    for part in ["<svg", "prefers-color-scheme: dark", "<caption>", "<desc", "too few", "table_friction = 0.15"] {
        assert!(page.contains(part), "{part:?} is missing");
    }
    for foreign in ["<script", "src=", "href=", "@import", "url(", "NaN", "inf"] {
        assert!(!page.contains(foreign), "{foreign:?} is in the page");
    }
    agrees_with_the_table(&folder.path().join("one"));
    goes_on_where_it_stopped(folder.path());
}

/// A column of numbers of `results.parquet`, as any program reads it.
fn table_column(folder: &Path, name: &str) -> Vec<f64> {
    let file = fs::File::open(folder.join("results.parquet")).unwrap();
    let reader = ParquetRecordBatchReaderBuilder::try_new(file).unwrap().build().unwrap();
    let batches = reader.map(|batch| batch.unwrap().column_by_name(name).unwrap().clone());
    batches.flat_map(|column| column.as_primitive::<Float64Type>().values().to_vec()).collect()
}

/// Recomputes what `comparison.json` says from the table, naively.
fn agrees_with_the_table(folder: &Path) {
    let (found, rows) = (comparison(folder), rows(folder));
    assert_eq!((found.seeds.as_slice(), rows.len()), ([1, 2, 3, 4].as_slice(), 12));
    let groups: Vec<&[Row]> = rows.chunks(4).collect();
    for (variant, rows) in found.variants.iter().zip(&groups) {
        let successes = rows.iter().filter(|row| row.status == Status::Success).count();
        assert_eq!((variant.successes, variant.failed.len()), (successes, 4 - successes));
    }
    assert!(found.measures.iter().any(|measure| measure.name == "goal_error_mm"));
    for measure in &found.measures {
        let told = table_column(folder, &measure.name);
        assert_eq!(told, rows.iter().map(|row| row.value(&measure.name).unwrap()).collect::<Vec<_>>());
        let columns: Vec<&[f64]> = told.chunks(4).collect();
        let first = columns[0];
        for (spread, column) in measure.variants.iter().zip(&columns) {
            let mut values = column.to_vec();
            let location = spread.location.unwrap();
            assert_eq!(spread.values.iter().map(|value| value.unwrap()).collect::<Vec<_>>(), values);
            values.sort_by(f64::total_cmp);
            assert!((location.median - 0.5 * (values[1] + values[2])).abs() < ROUNDING);
            // type 7: a quarter of the way from the first to the fourth is three quarters of the first step
            assert!((location.quartiles[0] - (0.25 * values[0] + 0.75 * values[1])).abs() < ROUNDING);
            assert_eq!(location.median_interval_95, None);
        }
        for difference in &measure.differences {
            let this = columns[difference.variant];
            let values: Vec<f64> = this.iter().zip(first).map(|(this, first)| this - first).collect();
            let test = difference.test.unwrap();
            assert!((test.estimate - hodges_lehmann(&values)).abs() < ROUNDING, "{}", measure.name);
            assert!((test.p - signed_rank_p(&values)).abs() < ROUNDING, "{}", measure.name);
            assert_eq!((difference.verdict, difference.missing_seeds.len()), (Verdict::TooFew, 0));
        }
    }
}

fn hodges_lehmann(values: &[f64]) -> f64 {
    let pairs = (0..values.len()).flat_map(|i| (i..values.len()).map(move |j| (i, j)));
    let mut means: Vec<f64> = pairs.map(|(i, j)| 0.5 * (values[i] + values[j])).collect();
    means.sort_by(f64::total_cmp);
    let middle = means.len() / 2;
    if means.len() % 2 == 1 { means[middle] } else { 0.5 * (means[middle - 1] + means[middle]) }
}

/// Share of all patterns of signs whose rank sum lies as far from the middle as the one that was found.
fn signed_rank_p(values: &[f64]) -> f64 {
    let values: Vec<f64> = values.iter().copied().filter(|value| *value != 0.0).collect();
    let rank = |size: f64| {
        let below = values.iter().filter(|value| value.abs() < size).count() as f64;
        let same = values.iter().filter(|value| value.abs() == size).count() as f64;
        below + 0.5 * (same + 1.0)
    };
    let ranks: Vec<f64> = values.iter().map(|value| rank(value.abs())).collect();
    let middle = 0.5 * ranks.iter().sum::<f64>();
    let sum = |positive: &dyn Fn(usize) -> bool| {
        ranks.iter().enumerate().filter(|(index, _)| positive(*index)).map(|(_, rank)| rank).sum::<f64>()
    };
    let observed = (sum(&|index| values[index] > 0.0) - middle).abs();
    let patterns = 1_usize << values.len();
    let as_far =
        (0..patterns).filter(|signs| (sum(&|index| (signs >> index) & 1 == 1) - middle).abs() >= observed - ROUNDING);
    as_far.count() as f64 / patterns as f64
}

/// A journal that lost its last rows is filled up, and the result is the same.
fn goes_on_where_it_stopped(folder: &Path) {
    let out = folder.join("one");
    let before = fs::read(out.join("comparison.json")).unwrap();
    let journal = fs::read_dir(out.join("journal")).unwrap().flatten().next().unwrap().path();
    let text = fs::read_to_string(&journal).unwrap();
    let kept: String = text.split_inclusive('\n').take(10).collect();
    // the last line was being written when it stopped
    fs::write(&journal, kept + "{\"index\":10,").unwrap();
    fs::remove_file(out.join("comparison.json")).unwrap();
    let fixed = ["compare", "quick.toml", "--trials", "4", "--no-record", "--quiet", "--out", "one"];
    let again = wield(folder, &[&fixed[..], &VARY].concat());
    assert_eq!((again.status.code(), said(&again).as_str()), (Some(0), ""));
    assert_eq!(fs::read(out.join("comparison.json")).unwrap(), before);
    assert_eq!(rows(&out).len(), 12);

    // another measure needs no further run; one that there is not is told with those that there are
    let journals = || fs::read_dir(out.join("journal")).unwrap().count();
    let made = journals();
    let asked = wield(folder, &[&fixed[..], &VARY, &["--measure", "goal_erorr_mm"]].concat());
    assert_eq!((asked.status.code(), journals()), (Some(2), made));
    assert!(said(&asked).contains("no run has this measure; expected one of goal_error_mm"), "{}", said(&asked));

    let other = wield(
        folder,
        &["compare", "quick.toml", "--tool", "stick", "--vary", "object.mass_kg=0.01,0.02", "--out", "one"],
    );
    assert_eq!(other.status.code(), Some(2));
    assert!(said(&other).contains("one holds another campaign"), "{}", said(&other));
}

#[test]
fn runs_without_an_outcome_are_data_with_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("quick.toml"), quick()).unwrap();
    // the second goal lies to the right of the start, but the side of the stick pushes to the left
    let goals = "task.push.goal_m=[-0.055, 0.125],[0.075, 0.125]";
    let arguments = ["compare", "quick.toml", "--vary", goals, "--trials", "3", "--no-record", "--json"];
    let output = wield(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let found: Comparison = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found, comparison(&folder.path().join("runs/compare-quick")));
    let [possible, pull] = found.variants.as_slice() else { panic!("two variants") };
    assert_eq!((possible.name.as_str(), pull.successes), ("goal_m = [-0.055, 0.125]", 0));
    assert!(pull.failed.len() == 3 && pull.failed[0].failures[0].contains("cannot pull"), "{:?}", pull.failed);
    assert_eq!((found.success[0].only_first, found.success[0].neither), (possible.successes, 3 - possible.successes));
    assert!(!found.measures.is_empty());
    for measure in &found.measures {
        let difference = &measure.differences[0];
        assert_eq!((difference.missing_seeds.as_slice(), difference.test), ([1, 2, 3].as_slice(), None));
        assert_eq!((measure.variants[1].location, measure.variants[1].values.len()), (None, 3));
    }
    let page = fs::read_to_string(folder.path().join("runs/compare-quick/report.html")).unwrap();
    assert!(
        page.contains("cannot pull")
            && page.contains("no value")
            && page.contains("no pair of values from seeds 1 to 3")
    );
}

#[test]
fn what_cannot_be_compared_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let text = quick();
    fs::write(folder.path().join("quick.toml"), &text).unwrap();
    for (arguments, parts) in [
        (
            &["--tool", "stick", "--tool", "stik"][..],
            &["did you mean", "--> quick.toml with tool.asset = \"stik\""][..],
        ),
        (&["--vary", "object.mas_kg=0.1,0.2"], &["unknown key `mas_kg`", "mass_kg"]),
        (&["--vary", "tool.asset:mas_kg=0.1,0.2"], &["mas_kg"]),
        (&["--vary", "object.mass_kg=0.1,-0.2"], &["mass_kg", "expected"]),
        (&["--tool", "stick"], &["found one variant; expected at least two"]),
        (&[], &["found one variant"]),
        (&["--vary", "object.mass_kg="], &["no value of `object.mass_kg`"]),
        (&["--vary", "object.mass_kg"], &["expected KEY=VALUE"]),
        (&["--vary", "object.mass_kg=0.1,0.1"], &["twice"]),
        (&["--tool", "stick", "--tool", "stick"], &["found stick twice"]),
        (&["--tool", "stick", "--vary", "tool.asset=l,t"], &["`tool.asset` is varied twice"]),
        (&["--vary", "scenario.seed=1,2", "--trials", "0"], &["--trials"]),
        (&["--vary", "object.table_friction=0.25,0.250"], &["twice"]),
        (&["--vary", "world.gravity_m_per_s2=9.81,9.810000"], &["twice"]),
        (&["--tool", "stick", "--tool", "l", "--first-seed", "9223372036854775807"], &["lower --first-seed"]),
    ] {
        let output = wield(folder.path(), &[&["compare", "quick.toml"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", said(&output));
        for part in parts {
            assert!(said(&output).contains(part), "{arguments:?}: {part:?} is missing in:\n{}", said(&output));
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{arguments:?}: something was written");
    }
}

#[test]
fn variants_that_are_the_same_scenario_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("quick.toml"), quick()).unwrap();
    let output = wield(folder.path(), &["compare", "quick.toml", "--vary", "object.mass_kg=1,1.0"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(said(&output).contains("are the same scenario"), "{}", said(&output));
}

#[test]
#[cfg(feature = "recording")]
fn the_recording_holds_every_variant_below_its_own_entity() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("quick.toml"), quick()).unwrap();
    let arguments =
        ["compare", "quick.toml", "--vary", "object.table_friction=0.2,0.3", "--trials", "1", "--out", "o", "--quiet"];
    let output = wield(folder.path(), &arguments);
    assert_eq!((output.status.code(), said(&output).as_str()), (Some(0), ""));
    let found = read_back::read(&folder.path().join("o/recording.rrd"));
    assert_eq!(found.activations, [(true, true)], "one layout, not one of each run");
    for variant in ["table_friction___0_2", "table_friction___0_3"] {
        for part in ["plane/object", "plane/tool", "plots/distance/goal", "summary/outcome"] {
            let path = format!("/{variant}/{part}");
            assert!(found.rows.contains_key(&path), "{path} is missing in {:?}", found.rows.keys());
        }
    }
    let outside = |path: &&String| !path.starts_with("/table_friction") && !path.starts_with("/__properties");
    assert_eq!(found.rows.keys().find(outside), None);
    // both run the same seed: what differs is the friction, and with it where the disc came to lie
    let place = |variant: &str| found.places[&format!("/{variant}/plane/object")];
    assert_ne!(place("table_friction___0_2"), place("table_friction___0_3"));
}

#[test]
fn a_measure_that_there_is_not_is_told_after_the_first_run_of_each_variant() {
    let project = tempfile::tempdir().unwrap();
    fs::write(project.path().join("push.toml"), quick()).unwrap();
    let fixed = ["compare", "push.toml", "--no-record", "--trials", "6", "--out", "out"];
    let asked = wield(project.path(), &[&fixed[..], &VARY, &["--measure", "goal_erorr_mm"]].concat());
    assert_eq!(asked.status.code(), Some(2), "{}", said(&asked));
    for part in ["no run has this measure", "did you mean `goal_error_mm`?", "kept in out"] {
        assert!(said(&asked).contains(part), "{part}: {}", said(&asked));
    }
    let made = |rows: &[Row]| rows.iter().map(|row| row.index).collect::<Vec<_>>();
    assert_eq!(made(&rows(&project.path().join("out"))), [0, 6, 12], "one run of each variant was made, and is kept");
    assert!(!project.path().join("out/comparison.json").exists());
    let mended = wield(project.path(), &[&fixed[..], &VARY, &["--measure", "duration_s"]].concat());
    assert_eq!(mended.status.code(), Some(0), "{}", said(&mended));
    assert_eq!(made(&rows(&project.path().join("out"))), (0..18).collect::<Vec<_>>(), "none of them was made twice");
}

#[test]
fn a_controller_that_is_only_named_has_gains_for_arms_in_the_plane_and_in_space() {
    let project = tempfile::tempdir().unwrap();
    fs::write(project.path().join("push.toml"), quick()).unwrap();
    fs::copy(Path::new(PROJECT).join("scenarios/reach_panda.toml"), project.path().join("reach.toml")).unwrap();
    for scenario in ["push", "reach"] {
        let file = format!("{scenario}.toml");
        let arguments = ["compare", &file, "--vary", "controller=impedance,joint_pd", "--trials", "1", "--no-record"];
        let output = wield(project.path(), &[&arguments[..], &["--out", scenario]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        let found = comparison(&project.path().join(scenario));
        let [impedance, joint_pd] = found.variants.as_slice() else { panic!("two variants") };
        assert_eq!((impedance.name.as_str(), joint_pd.name.as_str()), ("impedance", "joint_pd"));
        // the paper's gains, which are those of an impedance without any, leave a Panda too soft for this motion
        assert_eq!(impedance.successes, usize::from(scenario == "push"), "{scenario}");
        assert_eq!(joint_pd.successes, 1, "{scenario}: {:?}", joint_pd.failed);
    }
}
