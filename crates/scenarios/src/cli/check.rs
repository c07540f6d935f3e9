//! `wield check`: everything that is wrong in scenario, sweep and design files, without running them.

use std::path::{Path, PathBuf};

use super::plan::{invalid_points, planned};
use super::{Exit, SetArguments, assets_for, say, say_aside, say_problems};
use crate::diagnostic::Diagnostic;
use crate::scenario::notes;
use crate::sweep::is_sweep;
use crate::tool_design::{is_design, load_design};

pub const AFTER_HELP: &str = "\
Of a sweep file every point is checked. In a grid each must make a valid scenario; where points are drawn, or with
invalid_points = \"record\" in [sweep], it is told how many do not.

Examples:
  wield check scenarios/*.toml
  wield check scenarios/push_stick.toml --set object.mass_kg=0.01
  wield check scenarios/sweeps/*.toml

Exit codes: 0 all files can be run, 2 some cannot.";

/// Options of `wield check`.
#[derive(Debug, clap::Args)]
pub struct CheckArguments {
    /// Scenario, sweep and design files
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    set: SetArguments,
}

/// Checks every file, prints `ok` for the good ones and all problems of the others.
pub fn execute(arguments: &CheckArguments, assets: Option<&Path>) -> Exit {
    let results: Vec<Exit> = arguments.files.iter().map(|file| check(file, &arguments.set, assets)).collect();
    let bad = results.iter().filter(|&&exit| exit == Exit::BadInput).count();
    if bad > 0 {
        say_aside(&format!("{bad} of {} files cannot be run", results.len()));
        return Exit::BadInput;
    }
    results.into_iter().find(|&exit| exit != Exit::Success).unwrap_or(Exit::Success)
}

fn check(file: &Path, set: &SetArguments, assets: Option<&Path>) -> Exit {
    let remarks = if is_sweep(file) {
        check_sweep(file, set, assets)
    } else if is_design(file) {
        check_design(file, set, assets)
    } else {
        check_scenario(file, set, assets)
    };
    match remarks {
        Ok(remarks) => {
            remarks.iter().for_each(|remark| say_aside(&format!("note: {remark}")));
            say(&format!("ok {}\n", file.display()))
        }
        Err(problems) => {
            say_problems(&problems);
            Exit::BadInput
        }
    }
}

/// Remarks on a scenario that can be run.
fn check_scenario(file: &Path, set: &SetArguments, assets: Option<&Path>) -> Result<Vec<String>, Vec<Diagnostic>> {
    set.load(file, assets).map(|scenario| notes(&scenario))
}

/// Remarks on a sweep that can be run.
fn check_sweep(file: &Path, set: &SetArguments, assets: Option<&Path>) -> Result<Vec<String>, Vec<Diagnostic>> {
    refuse_changes(file, set, "a sweep file", "a [[factor]] with one value in the file instead")?;
    planned(file, assets, &|_, _| {})
        .map(|plan| notes(&plan.sweep.scenario).into_iter().chain(invalid_points(&plan)).collect())
}

/// Remarks on a design that can be run.
fn check_design(file: &Path, set: &SetArguments, assets: Option<&Path>) -> Result<Vec<String>, Vec<Diagnostic>> {
    refuse_changes(file, set, "a design file", "a change of the scenario that it names instead")?;
    load_design(file, &|scenario| assets_for(assets, Some(scenario))).map(|task| notes(&task.scenario))
}

fn refuse_changes(file: &Path, set: &SetArguments, what: &str, instead: &str) -> Result<(), Vec<Diagnostic>> {
    if set.changes.is_empty() {
        return Ok(());
    }
    let problem = Diagnostic::of_file(file, format!("--set changes keys of a scenario, and this is {what}"));
    Err(vec![problem.expected(instead)])
}
