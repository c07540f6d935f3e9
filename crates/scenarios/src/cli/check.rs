//! `wield check`: everything that is wrong in scenario files, without running them.

use std::path::{Path, PathBuf};

use super::{Exit, assets_for, say, say_aside, say_problems};
use crate::scenario::{load, notes};

/// Options of `wield check`.
#[derive(Debug, clap::Args)]
pub struct CheckArguments {
    /// Scenario files
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
}

/// Checks every file, prints `ok` for the good ones and all problems of the others.
pub fn execute(arguments: &CheckArguments, assets: Option<&Path>) -> Exit {
    let results: Vec<Exit> = arguments.files.iter().map(|file| check(file, assets)).collect();
    let bad = results.iter().filter(|&&exit| exit == Exit::BadInput).count();
    if bad > 0 {
        say_aside(&format!("{bad} of {} files cannot be run", results.len()));
        return Exit::BadInput;
    }
    results.into_iter().find(|&exit| exit != Exit::Success).unwrap_or(Exit::Success)
}

fn check(file: &Path, assets: Option<&Path>) -> Exit {
    match load(file, &assets_for(assets, Some(file))) {
        Ok(resolved) => {
            notes(&resolved).iter().for_each(|note| say_aside(&format!("note: {note}")));
            say(&format!("ok {}\n", file.display()))
        }
        Err(problems) => {
            say_problems(&problems);
            Exit::BadInput
        }
    }
}
