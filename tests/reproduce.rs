//! `wield reproduce`: the files that it leaves, their form, and that nothing but the clock times changes.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise, its helpers too")]

mod program;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Output;

use program::PROJECT;

/// Items that take no more than a few seconds together.
const FAST: [&str; 4] = ["figure_2", "figure_5_transfer", "figure_7", "figure_6"];
const FIGURES: [&str; 5] = ["figure_2e.svg", "figure_5c.svg", "figure_7.svg", "figure_6ab.svg", "figure_6cd.svg"];

fn reproduce(folder: &Path, arguments: &[&str]) -> Output {
    let assets = Path::new(PROJECT).join("assets");
    program::wield(folder, Some(&assets), &[&["reproduce", "--no-record"], arguments].concat())
}

/// Runs the fast items, and returns the files by name.
fn fast(folder: &Path, out: &str) -> BTreeMap<String, String> {
    let only: Vec<&str> = FAST.iter().flat_map(|name| ["--only", name]).collect();
    let output = reproduce(folder, &[&["--out", out], only.as_slice()].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let entries = fs::read_dir(folder.join(out)).unwrap().flatten();
    entries
        .map(|entry| (entry.file_name().to_string_lossy().into_owned(), fs::read_to_string(entry.path()).unwrap()))
        .collect()
}

/// Asserts that every element that is opened is closed, in its order, and that no place is out of numbers.
fn assert_well_formed(name: &str, svg: &str) {
    let mut open = Vec::new();
    for tag in svg.split('<').skip(1) {
        let (inside, _) = tag.split_once('>').unwrap_or_else(|| panic!("{name}: `<{tag}` has no end"));
        assert_eq!(inside.matches('"').count() % 2, 0, "{name}: quotes of `{inside}`");
        if let Some(closed) = inside.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed), "{name}");
        } else if !inside.ends_with('/') {
            open.push(inside.split_whitespace().next().unwrap());
        }
    }
    assert!(open.is_empty() && svg.starts_with("<svg "), "{name}: {open:?}");
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
}

#[test]
fn the_page_shows_every_figure_and_judges_every_claim_and_repeats_to_the_byte() {
    let folder = tempfile::tempdir().unwrap();
    let (mut first, mut second) = (fast(folder.path(), "first"), fast(folder.path(), "second"));
    assert!(first.remove("timings.md").unwrap().contains("| `figure_7` |"));
    second.remove("timings.md");
    assert_eq!(first, second);
    let page = &first["README.md"];
    for figure in FIGURES {
        assert_well_formed(figure, &first[figure]);
        assert!(page.contains(&format!("]({figure})")), "{figure} is not shown");
    }
    let head = page.split_once("Clock times").unwrap().0;
    let verdicts: Vec<Vec<&str>> = head
        .lines()
        .filter(|line| line.starts_with("| ") && line.contains("**"))
        .map(|line| line.trim_matches('|').split(" | ").collect())
        .collect();
    assert!(verdicts.len() >= 10, "{verdicts:?}");
    for verdict in &verdicts {
        assert_eq!(verdict.len(), 4, "{verdict:?}");
        assert!(["**reproduced**", "**differs**", "**not reproduced**"].contains(&verdict[2]), "{verdict:?}");
        assert!(!verdict[3].contains("NaN"), "{verdict:?}");
    }
    // what the plan is and what becomes of it do not depend on how it is told
    let finding = |claim: &str| verdicts.iter().find(|verdict| verdict[1].contains(claim)).unwrap()[2];
    assert_eq!(finding("changes its surface only twice"), "**reproduced**");
    assert_eq!(finding("reaches the destination"), "**reproduced**");
}

#[test]
fn an_unknown_item_is_refused_with_the_known_ones_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let output = reproduce(folder.path(), &["--only", "figure_99"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2));
    assert!(said.contains("figure_99") && said.contains("table_2"), "{said}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn help_says_what_is_written_and_what_a_verdict_means() {
    let folder = tempfile::tempdir().unwrap();
    let output = reproduce(folder.path(), &["--help"]);
    let help = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0));
    for part in ["docs/reproduction", "timings.md", "--only", "figure_5_transfer", "Examples:", "Exit codes"] {
        assert!(help.contains(part), "{part:?} is missing in:\n{help}");
    }
}
