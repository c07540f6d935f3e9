//! Tests of the task that CONTRIBUTING.md shows: it is what is compiled here, and it is read and run as the text says.

use std::path::{Path, PathBuf};

use super::TASKS;
use super::scoop::KIND;
use crate::assets::Assets;
use crate::scenario::Source;

fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(file: &str) -> String {
    std::fs::read_to_string(project().join(file)).unwrap()
}

#[test]
fn the_task_in_contributing_is_the_one_that_compiles() {
    let guide = read("CONTRIBUTING.md");
    let (_, rest) = guide.split_once("```rust\n//! Scooping").unwrap();
    let shown = format!("//! Scooping{}", rest.split_once("```").unwrap().0);
    // its example stands beside it here, and among the shipped scenarios there
    let compiled =
        read("tests/authoring/scoop.rs").replace("\"scoop_beans.toml\"", "\"../../../../scenarios/scoop_beans.toml\"");
    assert!(shown == compiled, "CONTRIBUTING.md: bring the skeleton up to date with tests/authoring/scoop.rs");
}

#[test]
fn its_lines_in_the_list_of_tasks_are_those_that_compile() {
    let (guide, list) = (read("CONTRIBUTING.md"), read("crates/scenarios/src/tasks/mod.rs"));
    let (_, rest) = guide.split_once("```rust,ignore\npub mod scoop;").unwrap();
    let lines = format!("pub mod scoop;{}", rest.split_once("```").unwrap().0);
    for line in lines.lines().filter(|line| !line.starts_with("//")) {
        // the one line that the tests cannot have: the program would list the kind
        assert!(list.contains(&format!("{line}\n")) || line.trim() == "scoop::KIND,", "{line}");
    }
    assert!(TASKS.iter().all(|kind| kind.name != KIND.name));
}

#[test]
fn it_is_read_written_and_begun() {
    let assets = Assets::at(project().join("assets"));
    let scenario = (KIND.load)(&KIND.example(), &KIND.example(), &assets).unwrap();
    assert_eq!((scenario.kind(), scenario.name.as_str()), ("scoop", "scoop_beans"));
    let again = Source::new("again.toml", scenario.text(7).unwrap());
    assert_eq!((KIND.load)(&again, &KIND.example(), &assets).unwrap().text(7), scenario.text(7));
    let told = crate::pipeline::run(&scenario, 1, &mut (), &|_, _| {}).unwrap_err().to_string();
    assert!(told.contains("demonstrate is not written yet"), "{told}");
    let wrong = Source::new("a.toml", KIND.example().text.replace("0.02", "-1.0"));
    let problem = (KIND.load)(&wrong, &KIND.example(), &assets).unwrap_err().remove(0).to_string();
    assert!(problem.contains("bad value for `wanted_kg` in [task.scoop]"), "{problem}");
}
