//! Writing scenarios with the built program: `new`, `explain`, `schema`, `completions` and `man`, in a fresh folder.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise, its helpers too")]

mod program;
#[path = "authoring/validate.rs"]
mod validate;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use program::PROJECT;
use serde_json::Value;
use tempfile::TempDir;
use validate::complaints;

/// Kinds of files with a schema, and the folder of the shipped ones.
const KINDS: &[(&str, &str)] = &[
    ("scenario", "scenarios"),
    ("sweep", "scenarios/sweeps"),
    ("design", "scenarios/designs"),
    ("tool", "assets/tools"),
    ("food", "assets/foods"),
    ("knife", "assets/knives"),
    ("container", "assets/containers"),
];

const TASKS: &[&str] = &["push", "reach", "cut", "pour"];

/// Runs the program with the shipped assets.
fn wield(folder: &Path, arguments: &[&str]) -> Output {
    program::wield(folder, Some(&Path::new(PROJECT).join("assets")), arguments)
}

fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn complained(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Runs the program and returns what it prints; it has to succeed.
fn told(folder: &Path, arguments: &[&str]) -> String {
    let output = wield(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", complained(&output));
    printed(&output)
}

/// A fresh folder in which a new scenario of each of `tasks` was written.
fn written(tasks: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for task in tasks {
        assert_eq!(told(folder.path(), &["new", task]), format!("{task}.toml\n"));
    }
    folder
}

/// Takes the marks away from the lines that show what is so anyhow.
fn with_defaults_stated(text: &str) -> String {
    let stated = |line: &str| {
        let shown = line.strip_prefix("# ").filter(|shown| !shown.contains('…'))?;
        let of_key = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || "_.".contains(letter);
        let is_key = shown.split_once(" = ").is_some_and(|(key, _)| key.chars().all(of_key));
        (is_key || shown.starts_with('[')).then(|| shown.to_owned())
    };
    text.lines().map(|line| stated(line).unwrap_or_else(|| line.to_owned()) + "\n").collect()
}

fn shipped(folder: &str) -> Vec<PathBuf> {
    let files = fs::read_dir(Path::new(PROJECT).join(folder)).unwrap().flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
    files.sort();
    files
}

fn as_json(text: &str) -> Value {
    serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap()
}

fn schema(folder: &Path, kind: &str) -> Value {
    serde_json::from_str(&told(folder, &["schema", kind])).unwrap()
}

#[test]
fn a_new_scenario_of_any_kind_passes_its_check() {
    let folder = written(TASKS);
    for task in TASKS {
        let file = format!("{task}.toml");
        assert_eq!(told(folder.path(), &["check", &file]), format!("ok {file}\n"));
    }
}

#[test]
fn a_new_push_and_a_new_reach_run() {
    let folder = written(&["push", "reach"]);
    for task in ["push", "reach"] {
        let said = told(folder.path(), &["run", &format!("{task}.toml"), "--no-record"]);
        assert!(said.contains(&format!("results: runs/{task}/seed-1")), "{said}");
    }
}

#[test]
fn a_new_scenario_shows_the_defaults_that_hold() {
    let folder = written(TASKS);
    for task in TASKS {
        let file = format!("{task}.toml");
        let text = fs::read_to_string(folder.path().join(&file)).unwrap();
        let stated = with_defaults_stated(&text);
        let shown = text.lines().zip(stated.lines()).filter(|(before, after)| before != after).count();
        assert!(shown > 10, "{task}: only {shown} defaults are shown");
        fs::write(folder.path().join("stated.toml"), &stated).unwrap();
        told(folder.path(), &["check", "stated.toml"]);
        let scenarios = [&file, "stated.toml"].map(|file| resolved(&folder.path().join(file)));
        assert_eq!(scenarios[0], scenarios[1], "{task}");
    }
}

/// A scenario with all its defaults, by the library that the program is made of.
fn resolved(file: &Path) -> String {
    let assets = scenarios::assets::Assets::at(Path::new(PROJECT).join("assets"));
    let mut scenario = scenarios::scenario::load(file, &assets).unwrap().text(1).unwrap();
    let name = scenario.lines().find(|line| line.starts_with("name = ")).unwrap().to_owned();
    scenario = scenario.replacen(&name, "", 1);
    scenario
}

#[test]
fn nothing_is_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("push.toml"), "mine").unwrap();
    let output = wield(folder.path(), &["new", "push"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(complained(&output).contains("push.toml is there already; name another place with --out"));
    assert_eq!(fs::read_to_string(folder.path().join("push.toml")).unwrap(), "mine");
    assert_eq!(told(folder.path(), &["new", "push", "--out", "other.toml"]), "other.toml\n");
}

#[test]
fn new_tells_what_there_is_and_what_was_meant() {
    let folder = tempfile::tempdir().unwrap();
    let listed = told(folder.path(), &["new"]);
    assert!(TASKS.iter().all(|task| listed.lines().any(|line| line.starts_with(task))), "{listed}");
    for (arguments, part) in [
        (&["new", "pusch"][..], "did you mean `push`?"),
        (&["new", "push", "--name", "x"], "expected it only for a tool"),
        (&["new", "tool", "l"], "wield new tool l --name my_l"),
        (&["new", "tool", "q", "--name", "x"], "expected one of `hook`, `l`"),
        (&["new", "tool", "l", "--name", "../x"], "letters, digits"),
    ] {
        let output = wield(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(complained(&output).contains(part), "{}", complained(&output));
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "something was written");
}

#[test]
fn a_new_tool_is_ready_for_a_scenario() {
    let folder = program::project();
    let file = program::wield(folder.path(), None, &["new", "tool", "l", "--name", "my_l"]);
    assert_eq!(
        (file.status.code(), printed(&file)),
        (Some(0), "assets/tools/my_l.toml\n".into()),
        "{}",
        complained(&file)
    );
    let listed = program::wield(folder.path(), None, &["list", "tools"]);
    assert!(printed(&listed).lines().any(|line| line.starts_with("my_l ") && line.contains("three usable faces")));
    let again = program::wield(folder.path(), None, &["new", "tool", "l", "--name", "my_l"]);
    assert_eq!(again.status.code(), Some(2));
}

#[test]
fn every_shipped_file_fits_its_schema() {
    let folder = tempfile::tempdir().unwrap();
    for (kind, place) in KINDS {
        let schema = schema(folder.path(), kind);
        let files = shipped(place);
        assert!(!files.is_empty(), "{place}");
        for file in files {
            let found = complaints(&schema, &as_json(&fs::read_to_string(&file).unwrap()));
            assert!(found.is_empty(), "{}: {found:?}", file.display());
        }
    }
}

#[test]
fn a_new_scenario_fits_the_schema() {
    let folder = written(TASKS);
    let schema = schema(folder.path(), "scenario");
    for task in TASKS {
        let text = fs::read_to_string(folder.path().join(format!("{task}.toml"))).unwrap();
        assert_eq!(complaints(&schema, &as_json(&text)), Vec::<String>::new());
    }
}

/// Every table of every shipped file, with a key that it does not have; every number, as a text.
#[test]
fn unknown_keys_and_wrong_types_do_not_fit() {
    let folder = tempfile::tempdir().unwrap();
    for (kind, place) in KINDS {
        let schema = schema(folder.path(), kind);
        for file in shipped(place) {
            let good = as_json(&fs::read_to_string(&file).unwrap());
            let mut paths = Vec::new();
            walk(&good, "", &mut paths);
            assert!(paths.len() > 5);
            // values that a scenario changes in an asset, and those of a sweep's factor, may be of any type
            let of_any_type = |path: &&String| {
                path.starts_with("/scenario/asset_changes") || (*kind == "sweep" && path.contains("/values"))
            };
            for path in paths.iter().filter(|path| !of_any_type(path)) {
                let mut bad = good.clone();
                let what = bad.pointer_mut(path).unwrap();
                match what {
                    Value::Object(table) => drop(table.insert("no_such_key".into(), 1.into())),
                    Value::Number(_) => *what = "1".into(),
                    _ => continue,
                }
                assert!(!complaints(&schema, &bad).is_empty(), "{}: {path} was changed in vain", file.display());
            }
        }
    }
}

fn walk(value: &Value, path: &str, found: &mut Vec<String>) {
    found.push(path.to_owned());
    match value {
        Value::Object(table) => table.iter().for_each(|(name, entry)| walk(entry, &format!("{path}/{name}"), found)),
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(index, entry)| walk(entry, &format!("{path}/{index}"), found));
        }
        _ => {}
    }
}

#[test]
fn the_schemas_in_the_docs_are_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let files = told(folder.path(), &["schema", "--out", "."]);
    assert_eq!(files.lines().count(), KINDS.len(), "{files}");
    for (kind, _) in KINDS {
        let name = format!("{kind}.schema.json");
        let made = fs::read_to_string(folder.path().join(&name)).unwrap();
        assert_eq!(made, told(folder.path(), &["schema", kind]), "{kind}");
        let kept = fs::read_to_string(Path::new(PROJECT).join("docs/schema").join(&name)).unwrap_or_default();
        assert!(made == kept, "docs/schema/{name} is out of date; write it anew: wield schema --out docs/schema");
    }
}

#[test]
fn explain_tells_meaning_unit_default_and_place() {
    let folder = tempfile::tempdir().unwrap();
    for (key, parts) in [
        (
            "task.push.push_speed_m_per_s",
            &[
                "Speed of a push",
                "a number from 0.0001 to 2, in meters per second",
                "default  0.02",
                "scenarios of the kind push",
                "scenarios/push_stick.toml:",
            ][..],
        ),
        ("task.push.transfer", &["Whether and how the skill is transferred", "holds:", "planner", "tool_angle_rad"]),
        ("controller", &["one kind of", "impedance", "push, reach, cut, pour"]),
        ("world.obstacles.0.position_m", &["a list of 2 numbers, in meters", "it has to be stated"]),
        // each kind of task shows its own file
        ("limits", &["scenarios/push_stick.toml:", "scenarios/reach_panda.toml:", "scenarios/pour_wide_bowl.toml:"]),
        ("task", &["scenarios/push_stick.toml:", "scenarios/reach_panda.toml:", "scenarios/pour_wide_bowl.toml:"]),
        ("clearance_m", &["limits.clearance_m"]),
        ("tool.asset", &["names    a file in tools"]),
        ("tool:family.l.arm_m", &["tool:family.l.arm_m", "assets/tools"]),
        ("tool.asset:family.l.arm_m", &["tool:family.l.arm_m"]),
        ("demonstrations.synthetic.tool:mass_kg", &["tool:mass_kg", "in kilograms"]),
        ("arm_m", &["tool:family"]),
        ("scenario.asset_changes", &["tool.asset:family.l.arm_m"]),
    ] {
        let told = told(folder.path(), &["explain", key]);
        for part in parts {
            assert!(told.contains(part), "{key}: {part:?} is missing in:\n{told}");
        }
    }
}

#[test]
fn explain_suggests_what_was_meant() {
    let folder = tempfile::tempdir().unwrap();
    for (key, part) in [
        ("task.push.transfr", "did you mean `task.push.transfer`?"),
        ("clearence_m", "did you mean `clearance_m`?"),
        ("tool:mas_kg", "did you mean `mass_kg`?"),
        ("planet:mass_kg", "expected a key that names an asset"),
        ("zzzzzzzzzz", "lists what a file holds"),
    ] {
        let output = wield(folder.path(), &["explain", key]);
        assert_eq!(output.status.code(), Some(2), "{key}");
        assert!(complained(&output).contains(part), "{key}: {}", complained(&output));
    }
}

#[test]
fn explain_without_a_key_lists_what_files_hold() {
    let folder = tempfile::tempdir().unwrap();
    let told = told(folder.path(), &["explain"]);
    for part in ["scenario: ", "tool: ", "food: ", "knife: ", "container: ", "    limits "] {
        assert!(told.contains(part), "{part:?} is missing in:\n{told}");
    }
}

#[test]
fn completions_are_scripts_of_their_shell() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = told(folder.path(), &["completions", shell]);
        assert!(script.contains("wield") && script.contains("explain"), "{shell}:\n{script}");
        fs::write(folder.path().join(shell), script).unwrap();
    }
    // without bash there is nothing that could read its script
    if let Ok(read) = Command::new("bash").arg("-n").arg(folder.path().join("bash")).output() {
        assert!(read.status.success(), "{}", complained(&read));
    }
}

#[test]
fn every_verb_has_a_page_of_the_manual() {
    let folder = tempfile::tempdir().unwrap();
    assert!(told(folder.path(), &["man"]).contains(".TH wield 1"));
    told(folder.path(), &["man", "--out", "man"]);
    let help = told(folder.path(), &["--help"]);
    let verbs =
        help.lines().skip_while(|line| !line.starts_with("Commands:")).skip(1).take_while(|line| !line.is_empty());
    let verbs: Vec<&str> =
        verbs.filter_map(|line| line.split_whitespace().next()).filter(|verb| *verb != "help").collect();
    assert!(verbs.contains(&"explain"), "{verbs:?}");
    for verb in verbs {
        let page = folder.path().join(format!("man/wield-{verb}.1"));
        let text = fs::read_to_string(&page).unwrap_or_else(|error| panic!("{}: {error}", page.display()));
        assert!(text.contains(&format!(".TH wield-{verb} 1")), "{text}");
        // a machine without groff leaves it at that
        if let Ok(read) = Command::new("groff").args(["-man", "-Tutf8", "-ww"]).arg(&page).output() {
            assert!(read.status.success(), "{verb}: {}", complained(&read));
        }
    }
}

/// The methods that every implementation of a trait has to write, in the order of the trait.
fn required_methods(file: &str, name: &str) -> Vec<String> {
    let text = fs::read_to_string(Path::new(PROJECT).join(file)).unwrap();
    let (_, rest) = text.split_once(&format!("pub trait {name}")).unwrap();
    let body = rest.split_once("\n}\n").unwrap().0;
    let signatures = body.split("    fn ").skip(1);
    let bare = signatures.filter(|text| text.find(';').is_some_and(|end| !text[..end].contains('{')));
    bare.map(|text| text.split(['(', '<']).next().unwrap().to_owned()).collect()
}

#[test]
fn contributing_names_every_method_that_a_new_kind_has_to_write() {
    let guide = fs::read_to_string(Path::new(PROJECT).join("CONTRIBUTING.md")).unwrap();
    for (heading, file, name, count) in [
        ("### A task", "crates/scenarios/src/tasks/mod.rs", "Task", 6),
        ("### A movement primitive", "crates/skills/src/primitive/mod.rs", "MovementPrimitive", 3),
        ("### A controller", "crates/sim/src/controllers/mod.rs", "Controller", 3),
    ] {
        let section = guide.split_once(heading).unwrap().1.split("\n### ").next().unwrap();
        let methods = required_methods(file, name);
        assert_eq!(methods.len(), count, "{name}: {methods:?}");
        for method in methods {
            let told = section.contains(&format!("`{method}`")) || section.contains(&format!("fn {method}("));
            assert!(told, "{heading} does not name `{method}` of `{name}`");
        }
    }
}
