//! Cuts and pours by files: what a human shows is recorded, recordings are learned from, and learned skills move alike.

#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test stops at the first surprise, its helpers too")]

mod program;

use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::Value;

use program::{PROJECT, replaced, wield};

/// Largest file of a shipped demonstration in space, bytes.
const LARGEST_BYTES: u64 = 100_000;

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn shipped(file: &str) -> String {
    fs::read_to_string(Path::new(PROJECT).join("scenarios").join(file)).unwrap()
}

/// A cut of one piece off a food that is quickly cut, or a pour of few beans: what one kind of task is tried with.
struct Kind {
    scenario: String,
    /// What the scenario says of a recording besides its name.
    recorded: &'static str,
}

fn cut() -> Kind {
    let text = replaced(&shipped("cut_banana_three.toml"), "wanted.equal_pieces = 3", "wanted.equal_pieces = 2");
    Kind {
        scenario: text,
        recorded: "food = \"cylinder\"\nfood_at_m = [0.5, 0.0]\nfood_angle_rad = 1.5707963267948966\nboard_top_m = 0.12",
    }
}

fn few_beans(file: &str) -> String {
    let text = replaced(&shipped(file), "fill.count = 300", "fill.count = 60");
    replaced(&text, "options.floor_m", "options.approach_speed_m_per_s = 0.2\noptions.floor_m")
}

fn pour() -> Kind {
    Kind { scenario: few_beans("pour_wide_bowl.toml"), recorded: "target = \"wide_cup\"\nplace_m = [0.50, 0.05]" }
}

/// The scenario with another source of its skill: the table `demonstrations` replaced by `instead`.
fn with(text: &str, instead: &str) -> String {
    let begin = text.find("[demonstrations.").unwrap();
    let end = begin + text[begin..].find("\n\n").unwrap();
    format!("{}{instead}{}", &text[..begin], &text[end..])
}

/// A fresh project with all shipped assets but no demonstrations and no skills.
fn project() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for kind in ["robots", "foods", "knives", "containers", "tools", "demonstrations", "skills"] {
        let target = folder.path().join("assets").join(kind);
        fs::create_dir_all(&target).unwrap();
        if ["demonstrations", "skills"].contains(&kind) {
            continue;
        }
        for entry in fs::read_dir(Path::new(PROJECT).join("assets").join(kind)).unwrap().flatten() {
            fs::copy(entry.path(), target.join(entry.file_name())).unwrap();
        }
    }
    folder
}

fn wield_ok(folder: &Path, arguments: &[&str]) -> String {
    let output = wield(folder, None, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn outcome(folder: &Path, scenario: &str) -> Value {
    wield_ok(folder, &["run", scenario, "--no-record", "--quiet", "--out", &format!("{scenario}.out")]);
    let file = folder.join(format!("{scenario}.out/seed-1/outcome.json"));
    serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap()
}

/// Shown, recorded, learned from the recording, kept in a file, and done from that: each step by the built program.
fn go_round(kind: &Kind) {
    let folder = project();
    let at = folder.path();
    fs::write(at.join("a.toml"), &kind.scenario).unwrap();
    // what is shown is a file that another scenario learns from
    wield_ok(at, &["demonstrate", "a.toml", "--count", "2", "--quiet", "--out", "assets/demonstrations"]);
    let summary = fs::read_to_string(at.join("assets/demonstrations/demonstrations.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    assert_eq!((&summary["successes"], &summary["trials"][1]["file"]), (&2.into(), &"a_2.csv".into()));
    let recorded = format!("[demonstrations.recorded]\nasset = \"a_1\"\n{}", kind.recorded);
    fs::write(at.join("recorded.toml"), with(&kind.scenario, &recorded)).unwrap();
    let from_file = outcome(at, "recorded.toml");
    assert_eq!(from_file["success"], true, "{from_file}");
    // what is loaded moves exactly as what was learned
    let told = wield_ok(at, &["learn", "recorded.toml", "--out", "assets/skills/own.toml"]);
    assert!(told.contains("from 1 demonstration:") && told.contains("skills: assets/skills/own.toml"), "{told}");
    fs::write(at.join("learned.toml"), with(&kind.scenario, "[demonstrations.learned]\nasset = \"own\"")).unwrap();
    let learned = outcome(at, "learned.toml");
    assert!(from_file["trajectory_digest"].as_str().is_some_and(|digest| !digest.is_empty()));
    assert_eq!(from_file["trajectory_digest"], learned["trajectory_digest"]);
    assert_eq!(from_file["measures"], learned["measures"]);
    // the same skills once more, through the scenario that names the file
    wield_ok(at, &["learn", "learned.toml", "--out", "again.toml", "--quiet"]);
    let read = |file: &str| fs::read_to_string(at.join(file)).unwrap();
    assert_eq!(read("again.toml"), read("assets/skills/own.toml"));
    let output = wield(at, None, &["demonstrate", "learned.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("a demonstration or a skill already"), "{}", stderr(&output));
    let listed = wield_ok(at, &["list", "skills"]);
    assert!(listed.contains("own") && listed.contains("from 1 demonstration of recorded"), "{listed}");
    assert!(wield_ok(at, &["list", "demonstrations"]).contains("poses in space"));
}

#[test]
fn a_cut_goes_round_through_files() {
    go_round(&cut());
}

#[test]
fn a_pour_goes_round_through_files() {
    go_round(&pour());
}

#[test]
fn a_flawed_recording_is_one_message_with_its_line_and_nothing_is_written() {
    let folder = project();
    let at = folder.path();
    let good = fs::read_to_string(Path::new(PROJECT).join("assets/demonstrations/cut_cylinder.csv")).unwrap();
    let scenario = replaced(&shipped("cut_recorded.toml"), "asset = \"cut_cylinder\"", "asset = \"own\"");
    fs::write(at.join("a.toml"), scenario).unwrap();
    let first_row = good.lines().position(|line| line.starts_with("time_s")).unwrap() + 1;
    let line = |number: usize| good.lines().nth(number).unwrap().to_owned();
    let row = line(first_row + 4);
    let number = first_row + 5;
    let fields: Vec<&str> = row.split(',').collect();
    let with_field = |place: usize, value: &str| {
        let mut fields = fields.clone();
        fields[place] = value;
        replaced(&good, &row, &fields.join(","))
    };
    let until = |rows: usize| good.lines().take(first_row + rows).collect::<Vec<_>>().join("\n");
    let cases = [
        (with_field(4, "0.3"), format!("own.csv:{number}:1"), "a quaternion that is no rotation"),
        (with_field(0, "0.01"), format!("own.csv:{number}:1"), "the times do not increase"),
        (with_field(2, "NaN"), format!("own.csv:{number}:1"), "bad value in the column `y_m`"),
        (replaced(&good, ",qw,", ",w,"), format!("own.csv:{first_row}:1"), "missing column `qw`"),
        (until(4), format!("own.csv:{}:1", first_row + 4), "too few rows for a motion"),
    ];
    for (text, place, title) in cases {
        fs::write(at.join("assets/demonstrations/own.csv"), text).unwrap();
        let output = wield(at, None, &["run", "a.toml"]);
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{told}");
        for part in [title, &place, "a.toml:"] {
            assert!(told.contains(part), "{part:?} is missing in:\n{told}");
        }
        assert_eq!(told.matches("error").count(), 1, "{told}");
        assert!(!at.join("runs").exists(), "something was written");
    }
}

#[test]
fn skills_of_another_kind_of_task_are_refused() {
    let folder = project();
    let at = folder.path();
    fs::copy(Path::new(PROJECT).join("assets/skills/pour_wide_cup.toml"), at.join("assets/skills/pour.toml")).unwrap();
    fs::write(at.join("a.toml"), with(&cut().scenario, "[demonstrations.learned]\nasset = \"pour\"")).unwrap();
    let output = wield(at, None, &["check", "a.toml"]);
    let told = stderr(&output) + &String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(2), "{told}");
    for part in ["skills of another kind of task", "pour.toml:6", "\"pour\"", "\"cut\""] {
        assert!(told.contains(part), "{part:?} is missing in:\n{told}");
    }
}

#[test]
fn the_shipped_recordings_and_skills_do_what_they_show() {
    let folder = project();
    let at = folder.path();
    for (kind, file) in [
        ("demonstrations", "cut_cylinder.csv"),
        ("demonstrations", "pour_wide_cup.csv"),
        ("skills", "cut_cylinder.toml"),
        ("skills", "pour_wide_cup.toml"),
    ] {
        let from = Path::new(PROJECT).join("assets").join(kind).join(file);
        assert!(fs::metadata(&from).unwrap().len() < LARGEST_BYTES, "{}", from.display());
        fs::copy(from, at.join("assets").join(kind).join(file)).unwrap();
    }
    let learned = |name: &str| format!("[demonstrations.learned]\nasset = \"{name}\"");
    fs::write(at.join("cut.toml"), shipped("cut_recorded.toml")).unwrap();
    fs::write(at.join("pour.toml"), few_beans("pour_recorded.toml")).unwrap();
    fs::write(at.join("cut_learned.toml"), with(&cut().scenario, &learned("cut_cylinder"))).unwrap();
    fs::write(at.join("pour_learned.toml"), with(&pour().scenario, &learned("pour_wide_cup"))).unwrap();
    for scenario in ["cut.toml", "pour.toml", "cut_learned.toml", "pour_learned.toml"] {
        let done = outcome(at, scenario);
        assert_eq!(done["success"], true, "{scenario}: {done}");
    }
}

#[test]
fn recordings_that_tell_of_another_place_or_stop_in_between_are_refused_in_plain_words() {
    let folder = project();
    let at = folder.path();
    let shown = fs::read_to_string(Path::new(PROJECT).join("assets/demonstrations/cut_cylinder.csv")).unwrap();
    fs::write(at.join("cut.toml"), shipped("cut_recorded.toml")).unwrap();
    // the place of every row is changed; rows of comments and the header stay
    let moved = |change: &dyn Fn(f64) -> f64| {
        let row = |line: &str| {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            match (line.starts_with('#'), fields[1].parse::<f64>()) {
                (false, Ok(x)) => fields[1] = change(x).to_string(),
                _ => return format!("{line}\n"),
            }
            format!("{}\n", fields.join(","))
        };
        shown.lines().map(|line| if line.contains(',') { row(line) } else { format!("{line}\n") }).collect::<String>()
    };
    let time_s = |line: &str| line.split(',').next().and_then(|time| time.parse::<f64>().ok());
    let within = |line: &str| time_s(line).is_some_and(|time_s| (0.5..1.7).contains(&time_s));
    let paused = shown.lines().filter(|line| !within(line)).map(|line| format!("{line}\n")).collect::<String>();
    for (text, parts) in [
        (
            moved(&|x| x + 100.0),
            ["m from the food where it comes nearest", "are its unit meters and its frame the world"],
        ),
        (paused, ["cut_cylinder.csv:", "a gap in the recording"]),
    ] {
        fs::write(at.join("assets/demonstrations/cut_cylinder.csv"), text).unwrap();
        let output = wield(at, None, &["run", "cut.toml", "--no-record", "--out", "o"]);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{told}");
        for part in parts {
            assert!(told.contains(part), "{part:?} is missing in:\n{told}");
        }
    }
}
