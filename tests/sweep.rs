//! Sweeps, driven with the built program: what they give, and what is left after kills, signals, full disks and changes.

// helpers stop at the first surprise, too
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod program;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use program::{PROJECT, place, project, replaced};
use serde_json::Value;
use tempfile::TempDir;

/// Longest time that a test waits for something to happen on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// A hand that is held still for `hold_s` against a short push; a run of half a second takes a few hundredths of one.
fn hold(hold_s: &str) -> String {
    let text = fs::read_to_string(Path::new(PROJECT).join("scenarios/hold_panda.toml")).unwrap();
    let changes = [("hold_s = 4.5", format!("hold_s = {hold_s}")), ("from_s = 1.0", "from_s = 0.1".into())];
    let text = changes.iter().fold(text, |text, (from, to)| replaced(&text, from, to));
    replaced(&replaced(&text, "duration_s = 2.0", "duration_s = 0.2"), "ramp_s = 0.1", "ramp_s = 0.05")
}

const SWEEP: &str = "\
[sweep]
scenario = \"hold.toml\"
trials = 2

[[factor]]
key = \"task.reach.disturbances.0.force_n.2\"
values = [-5.0, -10.0, -60.0]
";

/// A project with a scenario and a sweep of it: six runs in files `hold.toml` and `force.toml`.
fn with_sweep() -> TempDir {
    let folder = project();
    fs::write(folder.path().join("hold.toml"), hold("0.5")).unwrap();
    fs::write(folder.path().join("force.toml"), SWEEP).unwrap();
    folder
}

/// The same with many runs.
fn with_long_sweep(trials: u32, hold_s: &str) -> TempDir {
    let folder = with_sweep();
    fs::write(folder.path().join("hold.toml"), hold(hold_s)).unwrap();
    fs::write(folder.path().join("force.toml"), SWEEP.replace("trials = 2", &format!("trials = {trials}"))).unwrap();
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_wield"));
    command.args(arguments).current_dir(folder).env_remove("WIELD_ASSETS").env_remove("WIELD_SHARDS");
    for variable in ["SLURM_ARRAY_TASK_ID", "HQ_TASK_ID", "JOB_COMPLETION_INDEX", "PARALLEL_SEQ"] {
        command.env_remove(variable);
    }
    command
}

fn wield(folder: &TempDir, arguments: &[&str]) -> Output {
    command(folder.path(), arguments).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Asserts how a program ended, and shows what it said if that was otherwise.
fn assert_code(output: &Output, code: i32) {
    assert_eq!(output.status.code(), Some(code), "{}{}", String::from_utf8_lossy(&output.stdout), stderr(output));
}

/// The journals of a campaign.
fn journals(folder: &TempDir, out: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.path().join(out).join("journal")).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.sort();
    files
}

/// All whole rows of a campaign by index, without the clock.
fn rows(folder: &TempDir, out: &str) -> Vec<Value> {
    let texts = journals(folder, out).into_iter().map(|file| fs::read_to_string(file).unwrap());
    let whole = |text: String| -> Vec<Value> {
        let lines = text.split_inclusive('\n').filter(|line| line.ends_with('\n'));
        lines.map(|line| serde_json::from_str(line).unwrap()).collect()
    };
    let mut rows: Vec<Value> = texts.flat_map(whole).collect();
    for row in &mut rows {
        assert!(row.as_object_mut().unwrap().remove("wall_s").unwrap().as_f64().unwrap() > 0.0);
    }
    rows.sort_by_key(|row| row["index"].as_u64());
    rows
}

fn indices(rows: &[Value]) -> Vec<u64> {
    rows.iter().map(|row| row["index"].as_u64().unwrap()).collect()
}

/// Waits until a campaign has `count` rows.
fn wait_for_rows(folder: &TempDir, out: &str, count: usize) {
    let begun = Instant::now();
    while rows(folder, out).len() < count {
        assert!(begun.elapsed() < PATIENCE, "no {count} rows after {PATIENCE:?}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Starts a sweep in the background.
fn start(folder: &TempDir, arguments: &[&str]) -> Child {
    command(folder.path(), arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

#[cfg(unix)]
fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

#[test]
fn rows_depend_neither_on_threads_nor_on_shards() {
    let folder = with_sweep();
    assert_code(&wield(&folder, &["sweep", "force.toml", "--threads", "1", "--out", "one", "--quiet"]), 0);
    assert_code(&wield(&folder, &["sweep", "force.toml", "--threads", "2", "--out", "two", "--quiet"]), 0);
    let expected = rows(&folder, "one");
    assert_eq!(indices(&expected), [0, 1, 2, 3, 4, 5]);
    let digests: BTreeSet<&str> = expected.iter().filter_map(|row| row["trajectory_digest"].as_str()).collect();
    assert!(digests.len() >= 3, "each value gives a trajectory of its own: {digests:?}");
    assert_eq!(rows(&folder, "two"), expected);

    assert_code(&wield(&folder, &["plan", "force.toml", "--out", "shards"]), 0);
    assert_code(&wield(&folder, &["sweep", "shards", "--shard", "2/4", "--quiet"]), 0);
    assert_eq!(indices(&rows(&folder, "shards")), [2]);
    for task in ["1", "2", "3", "4"] {
        let mut command = command(folder.path(), &["sweep", "force.toml", "--out", "shards", "--shard", "auto"]);
        let output = command.env("PARALLEL_SEQ", task).env("WIELD_SHARDS", "4").output().unwrap();
        assert_code(&output, 0);
    }
    assert_eq!(rows(&folder, "shards"), expected, "each run was made once, the one that was done before not again");
}

#[test]
fn planning_again_changes_nothing() {
    let folder = with_sweep();
    let first = wield(&folder, &["plan", "force.toml"]);
    assert_code(&first, 0);
    let said = String::from_utf8_lossy(&first.stdout).into_owned();
    assert!(said.contains("6 runs of hold: 3 points (grid), seeds 1 to 2"), "{said}");
    assert!(said.contains("next: wield sweep runs/force"), "{said}");
    let manifest = || fs::read(folder.path().join("runs/force/manifest.jsonl")).unwrap();
    let before = manifest();
    let again = wield(&folder, &["plan", "force.toml", "--json"]);
    let report: Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!((&report["runs"], &report["points"], &report["done"]), (&6.into(), &3.into(), &0.into()));
    assert_eq!(manifest(), before);
    assert!(!folder.path().join("runs/force/journal").exists(), "planning runs nothing");
}

#[test]
fn a_killed_sweep_goes_on_where_it_stopped() {
    let folder = with_long_sweep(20, "0.5");
    let mut child = start(&folder, &["sweep", "force.toml", "--threads", "2", "--quiet"]);
    wait_for_rows(&folder, "runs/force", 5);
    child.kill().unwrap();
    child.wait().unwrap();
    let kept = rows(&folder, "runs/force");
    assert!(kept.len() < 60, "it was killed too late to tell anything");
    // the runs are begun in order: of those before the last that ended, only the ones in flight can be missing
    let last = indices(&kept).last().copied().unwrap() as usize;
    assert!(last + 1 - kept.len() <= 1, "{:?}", indices(&kept));

    let output = wield(&folder, &["sweep", "runs/force"]);
    assert_code(&output, 0);
    let said = format!("{} of 60 runs are done: going on with the others", kept.len());
    assert!(stderr(&output).contains(&said), "{}", stderr(&output));
    let all = rows(&folder, "runs/force");
    assert_eq!(indices(&all), (0..60).collect::<Vec<u64>>(), "every run once, none twice");
    let same = |row: &Value| all.iter().any(|other| other == row);
    assert!(kept.iter().all(same), "what was done stays");
    let values: BTreeSet<&str> = all.iter().filter_map(|row| row["trajectory_digest"].as_str()).collect();
    assert_eq!(values.len(), 3, "without noise the seed changes nothing, the force does");
}

#[test]
fn a_last_line_that_was_cut_off_is_passed_over() {
    let folder = with_sweep();
    assert_code(&wield(&folder, &["sweep", "force.toml", "--quiet"]), 0);
    let expected = rows(&folder, "runs/force");
    let file = journals(&folder, "runs/force").remove(0);
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, &text[..text.len() - 20]).unwrap();
    assert_eq!(rows(&folder, "runs/force").len(), 5);
    assert_code(&wield(&folder, &["sweep", "runs/force", "--quiet"]), 0);
    assert_eq!(rows(&folder, "runs/force"), expected);
    // damage in the middle is not the mark of a kill
    fs::write(&file, text.replacen("{\"index\"", "{\"inde", 1)).unwrap();
    let output = wield(&folder, &["sweep", "runs/force", "--quiet"]);
    assert_code(&output, 3);
    assert!(stderr(&output).contains("found no row at byte 0"), "{}", stderr(&output));
}

#[test]
fn runs_without_an_outcome_become_rows_with_their_reason() {
    let folder = with_sweep();
    // the weight of a thousand tonnes
    let sweep = SWEEP.replace("[-5.0, -10.0, -60.0]", "[-5.0, -1e7]").replace("trials = 2", "trials = 1");
    fs::write(folder.path().join("wild.toml"), sweep).unwrap();
    let output = wield(&folder, &["sweep", "wild.toml"]);
    assert_code(&output, 3);
    let found = rows(&folder, "runs/wild");
    assert_eq!(indices(&found), [0, 1]);
    assert!(found[0]["trajectory_digest"].is_string());
    let crashed = &found[1];
    assert_eq!(crashed["status"], "crashed", "{crashed}");
    assert!(crashed["failures"][0].as_str().unwrap().starts_with("simulate: "), "{crashed}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("1 crashed"), "{output:?}");
    // it is done: the same run would end in the same way
    assert_code(&wield(&folder, &["sweep", "wild.toml"]), 3);
    assert_eq!(rows(&folder, "runs/wild").len(), 2);

    // no control period is short enough for this gain, which shows when the run is planned
    let sweep = "[sweep]\nscenario = \"hold.toml\"\n[[factor]]\nkey = \"controller.impedance.error_gain_per_s\"\n\
                 values = [1e9]\n";
    fs::write(folder.path().join("gain.toml"), sweep).unwrap();
    assert_code(&wield(&folder, &["sweep", "gain.toml", "--quiet"]), 3);
    let found = rows(&folder, "runs/gain");
    assert_eq!(found[0]["status"], "refused", "{found:?}");
    assert!(found[0]["failures"][0].as_str().unwrap().contains("found gains under which an error grows"), "{found:?}");
}

#[cfg(unix)]
#[test]
fn a_full_disk_stops_with_a_message_and_leaves_the_rows() {
    let folder = with_long_sweep(10, "0.2");
    assert_code(&wield(&folder, &["plan", "force.toml"]), 0);
    // files of at most 16 blocks, of 512 or 1024 bytes; the signal that would kill the program is ignored
    let script = format!("trap '' XFSZ; ulimit -f 16; exec '{}' sweep runs/force", env!("CARGO_BIN_EXE_wield"));
    let output = Command::new("sh").args(["-c", &script]).current_dir(folder.path()).output().unwrap();
    assert_code(&output, 3);
    let said = stderr(&output);
    assert!(said.contains("runs/force/journal/0of1-0.jsonl: ") && said.contains("make room, then go on"), "{said}");
    let kept = rows(&folder, "runs/force");
    assert!(!kept.is_empty() && kept.len() < 30, "{} rows", kept.len());
    assert!(fs::read_to_string(&journals(&folder, "runs/force")[0]).unwrap().ends_with('\n'), "half a line was left");
    assert_code(&wield(&folder, &["sweep", "runs/force", "--quiet"]), 0);
    assert_eq!(indices(&rows(&folder, "runs/force")), (0..30).collect::<Vec<u64>>());
}

#[test]
fn another_sweep_or_a_changed_one_is_refused_in_the_same_folder() {
    let folder = with_sweep();
    assert_code(&wield(&folder, &["sweep", "force.toml", "--out", "a", "--quiet"]), 0);
    let before = rows(&folder, "a");
    let refused = |part: &str| {
        let output = wield(&folder, &["sweep", "force.toml", "--out", "a", "--quiet"]);
        assert_code(&output, 2);
        let said = stderr(&output);
        assert!(said.contains("a holds another campaign") && said.contains(part) && said.contains("--out"), "{said}");
        assert_eq!(rows(&folder, "a"), before);
    };
    fs::write(folder.path().join("force.toml"), SWEEP.replace("trials = 2", "trials = 3")).unwrap();
    refused("it has 6 runs, this one 9");
    fs::write(folder.path().join("force.toml"), SWEEP.replace("-60.0", "-61.0")).unwrap();
    refused("run 4 differs");
    fs::write(folder.path().join("force.toml"), SWEEP).unwrap();
    fs::write(folder.path().join("hold.toml"), hold("0.6")).unwrap();
    refused("run 0 differs");
    // a remark in the scenario changes no result
    fs::write(folder.path().join("hold.toml"), format!("# held\n{}", hold("0.5"))).unwrap();
    assert_code(&wield(&folder, &["sweep", "force.toml", "--out", "a", "--quiet"]), 0);
}

#[test]
fn a_changed_asset_stops_a_planned_campaign() {
    let folder = with_sweep();
    assert_code(&wield(&folder, &["plan", "force.toml", "--quiet"]), 0);
    let robot = folder.path().join("assets/robots/panda.urdf");
    let text = fs::read_to_string(&robot).unwrap();
    fs::write(&robot, text.replacen("</robot>", "<!-- changed --></robot>", 1)).unwrap();
    let output = wield(&folder, &["sweep", "runs/force", "--quiet"]);
    assert_code(&output, 2);
    assert!(stderr(&output).contains("is not what it was when the runs were planned"), "{}", stderr(&output));
    assert_eq!(rows(&folder, "runs/force"), Vec::<Value>::new(), "no row tells of what was not planned");
    fs::write(&robot, text).unwrap();
    assert_code(&wield(&folder, &["sweep", "runs/force", "--quiet"]), 0);
}

#[test]
fn bad_sweeps_are_refused_at_their_place_before_anything_is_written() {
    let folder = with_sweep();
    let names =
        || fs::read_dir(folder.path()).unwrap().flatten().map(|entry| entry.file_name()).collect::<BTreeSet<_>>();
    let before = names();
    for (from, to, at, part) in [
        ("trials", "trails", "trails", "did you mean `trials`?"),
        ("values = [", "values = [0.5, -1e400, ", "-1e400", "expected a finite number"),
        ("-10.0", "-5.0", "-5.0, -60.0", "expected each value once"),
        ("-10.0", "\"ten\"", "\"ten\"", "the scenario cannot be run with"),
        ("disturbances.0.force_n", "disturbance.0.force_n", "\"task", "did you mean `disturbances`?"),
        ("hold.toml", "held.toml", "\"held.toml\"", "there is no such file"),
    ] {
        let text = replaced(SWEEP, from, to);
        fs::write(folder.path().join("force.toml"), &text).unwrap();
        for verb in ["sweep", "plan", "check"] {
            let output = wield(&folder, &[verb, "force.toml"]);
            assert_code(&output, 2);
            let (said, place) = (stderr(&output), format!("force.toml:{}", place(&text, at)));
            assert!(said.contains(&place) && said.contains(part), "{place}, {part}:\n{said}");
        }
        assert_eq!(names(), before, "something was written");
    }
    fs::write(folder.path().join("force.toml"), SWEEP).unwrap();
    for arguments in [
        &["sweep", "nowhere.toml"][..],
        &["sweep", "."],
        &["sweep", "force.toml", "--shard", "4/4"],
        &["sweep", "hold.toml", "--shard", "auto"],
        &["plan", "hold.toml"],
        &["run", "force.toml"],
        &["run", ".", "--row", "0"],
        &["check", "hold.toml", "--set", "nothing"],
    ] {
        let output = wield(&folder, arguments);
        assert_code(&output, 2);
        assert!(!output.stderr.is_empty() && !stderr(&output).contains("panicked"), "{arguments:?}");
    }
    assert_eq!(names(), before, "something was written");
}

#[test]
fn the_wanted_share_of_successes_decides_about_the_exit_code() {
    let folder = with_sweep();
    let output = wield(&folder, &["sweep", "force.toml", "--json"]);
    assert_code(&output, 0);
    let summary: Value = serde_json::from_slice(&output.stdout).unwrap();
    let success = summary["all"]["success"].as_u64().unwrap();
    assert_eq!((&summary["planned"], &summary["all"]["done"]), (&6.into(), &6.into()));
    assert_eq!(summary["factors"][0]["levels"].as_array().map(Vec::len), Some(3));
    assert!(success < 6, "a push of 60 N is too much for the limits: {summary}");
    let with = |share: f64| wield(&folder, &["sweep", "force.toml", "--quiet", "--min-success", &share.to_string()]);
    assert_code(&with(success as f64 / 6.0), 0);
    assert_code(&with((success as f64 + 1.0) / 6.0), 1);
}

#[test]
fn a_row_can_be_run_again_alone_and_is_the_same_to_the_last_bit() {
    let folder = with_sweep();
    assert_code(&wield(&folder, &["sweep", "force.toml", "--quiet"]), 0);
    let row = rows(&folder, "runs/force").remove(3);
    let again = wield(&folder, &["run", "runs/force", "--row", "3", "--no-record"]);
    assert!(matches!(again.status.code(), Some(0 | 1)) && stderr(&again).contains("the same as before"), "{again:?}");
    let outcome = fs::read_to_string(folder.path().join("runs/force/row-3/outcome.json")).unwrap();
    let outcome: Value = serde_json::from_str(&outcome).unwrap();
    assert_eq!(outcome["trajectory_digest"], row["trajectory_digest"]);
    assert_eq!((&outcome["seed"], &outcome["measures"]), (&row["seed"], &row["measures"]));
    // the scenario that it leaves holds the value of the factor
    let left = "runs/force/row-3/scenario.toml";
    let alone = wield(&folder, &["run", left, "--no-record", "--json", "--out", "alone"]);
    let alone: Value = serde_json::from_slice(&alone.stdout).unwrap();
    assert_eq!(alone, outcome);

    let file = journals(&folder, "runs/force").remove(0);
    let digest = row["trajectory_digest"].as_str().unwrap();
    let other = digest.replace(|letter: char| letter.is_ascii_digit(), "0");
    fs::write(&file, fs::read_to_string(&file).unwrap().replace(digest, &other)).unwrap();
    let output = wield(&folder, &["run", "runs/force", "--row", "3", "--no-record", "--out", "elsewhere"]);
    assert_code(&output, 3);
    assert!(stderr(&output).contains("the digest of its trajectory was"), "{}", stderr(&output));
    assert!(folder.path().join("elsewhere/outcome.json").exists());
    let output = wield(&folder, &["run", "runs/force", "--row", "6"]);
    assert_code(&output, 2);
    assert!(stderr(&output).contains("has the rows 0 to 5"), "{}", stderr(&output));
}

#[test]
fn a_changed_scenario_repeats_itself_from_what_it_left() {
    let folder = project();
    let scenario = Path::new(PROJECT).join("scenarios/push_transfer_l.toml");
    fs::copy(scenario, folder.path().join("l.toml")).unwrap();
    let run = |file: &str, out: &str, changes: &[&str]| -> Value {
        let sets = changes.iter().flat_map(|change| ["--set", change]);
        let all: Vec<&str> = ["run", file, "--no-record", "--json", "--out", out].into_iter().chain(sets).collect();
        let output = wield(&folder, &all);
        serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)))
    };
    let change = "tool.asset:family.l.arm_m=0.042";
    let changed = run("l.toml", "changed", &[change]);
    assert_eq!(run("changed/seed-1/scenario.toml", "again", &[]), changed);
    assert_ne!(run("l.toml", "plain", &[])["trajectory_digest"], changed["trajectory_digest"]);
    let output = wield(&folder, &["check", "l.toml", "--set", "object.mass_kg=-1"]);
    assert_code(&output, 2);
    let said = stderr(&output);
    assert!(said.contains("found -1") && said.contains("--> l.toml --set object.mass_kg=-1"), "{said}");
    let output = wield(&folder, &["run", "l.toml", "--set", "tool.asset:family.l.arm_mm=40"]);
    assert_code(&output, 2);
    assert!(stderr(&output).contains("write arm_m = 0.04"), "{}", stderr(&output));
}

#[cfg(unix)]
#[test]
fn ctrl_c_lets_the_runs_in_flight_end() {
    let folder = with_long_sweep(30, "0.5");
    let child = start(&folder, &["sweep", "force.toml", "--threads", "2"]);
    wait_for_rows(&folder, "runs/force", 3);
    let before = rows(&folder, "runs/force").len();
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    assert_code(&output, 130);
    let said = stderr(&output);
    assert!(said.contains("runs are left; go on with: wield sweep runs/force"), "{said}");
    let kept = rows(&folder, "runs/force");
    assert!(kept.len() >= before && kept.len() < 90, "{} rows", kept.len());
    // nothing that was begun is missing
    assert_eq!(indices(&kept), (0..kept.len() as u64).collect::<Vec<u64>>());
}

#[cfg(unix)]
#[test]
fn ctrl_c_twice_stops_at_once_and_so_does_sigterm() {
    use std::io::{BufRead, BufReader};
    use std::os::unix::process::ExitStatusExt;
    const SIGTERM: i32 = 15;
    // a run takes far longer than the test waits
    let folder = with_long_sweep(1, "600.0");
    let begun = |arguments: &[&str]| {
        let before = journals(&folder, "runs/force").len();
        let (child, first) = (start(&folder, arguments), Instant::now());
        while journals(&folder, "runs/force").len() == before {
            assert!(first.elapsed() < PATIENCE, "process {} begins nothing", child.id());
            std::thread::sleep(Duration::from_millis(5));
        }
        child
    };
    let mut child = begun(&["sweep", "force.toml"]);
    signal(&child, "-INT");
    let mut said = String::new();
    let mut lines = BufReader::new(child.stderr.take().unwrap());
    while !said.contains("stopping") {
        assert!(lines.read_line(&mut said).unwrap() > 0, "{said}");
    }
    let asked = Instant::now();
    signal(&child, "-INT");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(asked.elapsed() < PATIENCE);

    let mut child = begun(&["sweep", "runs/force"]);
    signal(&child, "-TERM");
    assert_eq!(child.wait().unwrap().signal(), Some(SIGTERM), "shells and engines see 143");
    assert_eq!(rows(&folder, "runs/force"), Vec::<Value>::new());
}

#[test]
fn a_viewer_that_is_absent_changes_no_row() {
    let folder = with_sweep();
    assert_code(&wield(&folder, &["sweep", "force.toml", "--out", "plain", "--quiet"]), 0);
    let nobody = "rerun+http://127.0.0.1:1/proxy";
    assert_code(&wield(&folder, &["sweep", "force.toml", "--out", "shown", "--quiet", "--connect", nobody]), 0);
    let table = |out: &str| fs::read(folder.path().join(out).join("results.parquet")).unwrap();
    assert_eq!(rows(&folder, "shown"), rows(&folder, "plain"));
    assert_eq!(table("shown"), table("plain"));
}

/// A sweep of eight random points, some of which ask for a time below zero.
const WITH_INVALID: &str = "\
[sweep]
scenario = \"hold.toml\"
trials = 2

[design.random]
points = 8

[[factor]]
key = \"task.reach.disturbances.0.duration_s\"
uniform = { min = -0.2, max = 0.3 }
";

#[test]
fn points_that_make_no_scenario_become_rows_and_the_others_are_run_however_they_are_divided() {
    let folder = with_sweep();
    fs::write(folder.path().join("drawn.toml"), WITH_INVALID).unwrap();
    let whole = wield(&folder, &["sweep", "drawn.toml", "--out", "whole", "--json"]);
    assert_code(&whole, 0);
    assert!(stderr(&whole).contains("runs without a valid scenario"), "{}", stderr(&whole));
    let summary: Value = serde_json::from_slice(&whole.stdout).unwrap();
    let expected = rows(&folder, "whole");
    let invalid: Vec<&Value> = expected.iter().filter(|row| row["status"] == "invalid").collect();
    assert!((2..=14).contains(&invalid.len()), "some of 16 and not all: {}", invalid.len());
    for row in &invalid {
        assert!(row["failures"][0].as_str().unwrap().contains("duration_s"), "{row}");
        assert_eq!((&row["trajectory_digest"], row["measures"].as_array().unwrap().len()), (&Value::Null, 0));
    }
    assert_eq!(summary["all"]["invalid"].as_u64(), Some(invalid.len() as u64));
    assert_eq!(summary["all"]["done"].as_u64(), Some(16));

    // four shards, one of them after a plan of its own; then all again, which has nothing to do
    for shard in ["3/4", "0/4", "2/4", "1/4"] {
        let output = wield(&folder, &["sweep", "drawn.toml", "--out", "parts", "--shard", shard, "--quiet"]);
        assert_code(&output, 0);
    }
    assert_code(&wield(&folder, &["sweep", "parts", "--quiet", "--format", "parquet", "--format", "csv"]), 0);
    assert_code(&wield(&folder, &["merge", "whole", "--format", "parquet", "--format", "csv"]), 0);
    assert_eq!(rows(&folder, "parts"), expected);
    for table in ["results.parquet", "results.csv", "manifest.jsonl"] {
        let [whole, parts] = ["whole", "parts"].map(|out| fs::read(folder.path().join(out).join(table)).unwrap());
        assert!(whole == parts, "{table} depends on the division");
    }

    let status = wield(&folder, &["status", "parts"]);
    assert_code(&status, 0);
    assert!(String::from_utf8_lossy(&status.stdout).contains(&format!("{} invalid (not run)", invalid.len())));
    let alone = wield(&folder, &["run", "whole", "--row", &invalid[0]["index"].to_string()]);
    assert_code(&alone, 2);
    assert!(stderr(&alone).contains("its values make no valid scenario"), "{}", stderr(&alone));
}

#[test]
fn campaigns_that_were_planned_before_points_could_be_invalid_go_on() {
    let folder = with_sweep();
    assert_code(&wield(&folder, &["plan", "force.toml", "--out", "old"]), 0);
    let manifest = fs::read_to_string(folder.path().join("old/manifest.jsonl")).unwrap();
    assert!(!manifest.contains("\"invalid\""), "a plan of valid points is written as it always was");
    assert_code(&wield(&folder, &["sweep", "old", "--quiet"]), 0);
}
