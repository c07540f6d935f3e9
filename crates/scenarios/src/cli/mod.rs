//! The command line: verbs, their options, exit codes.

mod check;
mod demonstrate;
mod gains;
mod learn;
mod list;
mod observe;
mod panics;
mod progress;
mod reproduce;
mod run;
mod seed_run;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use serde::Serialize;

use crate::assets::Assets;
use crate::diagnostic::{Diagnostic, color_wanted};
use crate::files::{prepare_folder, write_whole};
use crate::report::json;
use crate::scenario::{ResolvedScenario, load};

/// How the program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Everything that was asked for succeeded.
    Success,
    /// A task missed its limits, or too few trials succeeded.
    Missed,
    /// The input was bad; nothing was run and nothing written.
    BadInput,
    /// A run crashed or diverged, or its result could not be written.
    Crashed,
}

impl Exit {
    /// This ending, or [`Exit::Missed`] if all went well but the verdict is no `success`.
    fn unless_missed(self, success: bool) -> Self {
        if self == Self::Success && !success { Self::Missed } else { self }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(match exit {
            Exit::Success => 0,
            Exit::Missed => 1,
            Exit::BadInput => 2,
            Exit::Crashed => 3,
        })
    }
}

const AFTER_HELP: &str = "\
Examples:
  wield list                                       what there is: scenarios, tools, robots, tasks
  wield check scenarios/*.toml                     find every mistake, run nothing
  wield run scenarios/push_stick.toml              run it; results go to runs/push_stick/seed-1/
  wield run scenarios/push_stick.toml --trials 20  seeds 1 to 20 in parallel, with the success rate
  wield demonstrate scenarios/push_stick.toml      only what the synthetic human shows, as CSV files
  wield reproduce                                  every figure, table and claim of the paper, with a verdict
  wield gains                                      how closely the Panda follows under several gains

Exit codes:
  0  success
  1  a task missed its limits, or too few trials succeeded
  2  bad input: nothing was run, nothing was written
  3  a run crashed or diverged

Tools, robots, demonstrations and skills are found by name in a folder of assets: --assets DIR, else the environment
variable WIELD_ASSETS, else the folder `assets` nearest above the scenario, else nearest above the current folder.";

/// Learn tool use from demonstrations, carry it out in simulated physics, measure how well it went.
///
/// A scenario is one TOML file: the table and its obstacles, the object, the tool, the arm and its controller, the
/// task, where the demonstrations come from, and the limits that decide about success. Equal scenario and seed give
/// equal results.
#[derive(Debug, Parser)]
#[command(name = "wield", version, after_long_help = AFTER_HELP, after_help = "See `wield --help` for examples and exit codes.")]
struct Arguments {
    /// Folder of tools, robots, demonstrations and skills
    #[arg(long, value_name = "DIR", global = true)]
    assets: Option<PathBuf>,
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Run a scenario, once or under several seeds
    #[command(after_long_help = run::AFTER_HELP)]
    Run(run::RunArguments),
    /// Let a scenario's synthetic human show the task, and keep the demonstrations as CSV files
    #[command(after_long_help = demonstrate::AFTER_HELP)]
    Demonstrate(demonstrate::DemonstrateArguments),
    /// Learn skills from a scenario's demonstrations, and keep them in a file
    #[command(after_long_help = learn::AFTER_HELP)]
    Learn(learn::LearnArguments),
    /// Compute the paper's figures, tables and claims anew, and say what came out
    #[command(after_long_help = reproduce::AFTER_HELP)]
    Reproduce(reproduce::ReproduceArguments),
    /// Measure how closely the Panda carries its hand under several gains and wrong models
    #[command(after_long_help = gains::AFTER_HELP)]
    Gains(gains::GainsArguments),
    /// Check scenario files without running them
    Check(check::CheckArguments),
    /// List scenarios, tools, robots, tasks, demonstrations and skills
    List(list::ListArguments),
}

/// Reads the command line, does what it says, and returns how it ended.
#[must_use]
pub fn main() -> Exit {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(usage) => return usage_exit(&usage),
    };
    panics::install();
    let assets = arguments.assets.as_deref();
    if let Some(folder) = assets.filter(|folder| !folder.is_dir()) {
        say_error(&format!("--assets {}: found no such folder; expected the folder of assets", folder.display()));
        return Exit::BadInput;
    }
    match arguments.verb {
        Verb::Run(run) => run::execute(&run, assets, crate::pipeline::run),
        Verb::Demonstrate(demonstrate) => demonstrate::execute(&demonstrate, assets),
        Verb::Learn(learn) => learn::execute(&learn, assets),
        Verb::Reproduce(reproduce) => reproduce::execute(&reproduce, assets),
        Verb::Gains(gains) => gains::execute(&gains, assets),
        Verb::Check(check) => check::execute(&check, assets),
        Verb::List(list) => list::execute(&list, assets),
    }
}

fn usage_exit(usage: &clap::Error) -> Exit {
    match usage.print() {
        Ok(()) if !usage.use_stderr() => Exit::Success,
        _ => Exit::BadInput,
    }
}

fn assets_for(explicit: Option<&Path>, scenario: Option<&Path>) -> Assets {
    Assets::find(explicit, scenario)
}

/// Loads a scenario; says what is wrong with it if that fails.
fn load_told(file: &Path, assets: Option<&Path>) -> Option<ResolvedScenario> {
    load(file, &assets_for(assets, Some(file))).map_err(|problems| say_problems(&problems)).ok()
}

/// Makes a folder for results and returns the folders made on the way; says so if nothing can be written there.
fn prepare_told(folder: &Path) -> Option<Vec<PathBuf>> {
    prepare_folder(folder).map_err(|error| say_error(&unwritable(folder, &error, "--out"))).ok()
}

fn unwritable(path: &Path, error: &io::Error, option: &str) -> String {
    format!("cannot write to {}: {error}; name another place with {option}", path.display())
}

/// Folder of a seed in the folder of a scenario's results.
fn seed_folder(out: &Path, seed: u64) -> PathBuf {
    out.join(format!("seed-{seed}"))
}

/// Writes a result to a file as JSON; says so if that fails.
fn keep_json<T: Serialize>(file: &Path, result: &T) -> Exit {
    let kept = json(result).map_err(|error| error.to_string());
    match kept.and_then(|text| write_whole(file, text.as_bytes()).map_err(|error| error.to_string())) {
        Ok(()) => Exit::Success,
        Err(reason) => {
            say_error(&format!("write {}: {reason}", file.display()));
            Exit::Crashed
        }
    }
}

/// Prints a result as JSON.
fn say_json<T: Serialize>(result: &T) -> Exit {
    match json(result) {
        Ok(text) => say(&text),
        Err(error) => {
            say_error(&format!("write JSON: {error}"));
            Exit::Crashed
        }
    }
}

/// Prints `text` to stdout; a reader that has gone away (`wield list | head`) is no failure.
fn say(text: &str) -> Exit {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            say_error(&format!("write to stdout: {error}"));
            Exit::Crashed
        }
        _ => Exit::Success,
    }
}

/// Prints a line to stderr. Nothing can be done if that fails.
fn say_aside(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}

fn say_error(message: &str) {
    let prefix = if color_wanted(&io::stderr()) { "\u{1b}[1m\u{1b}[91merror\u{1b}[0m" } else { "error" };
    say_aside(&format!("{prefix}: {message}"));
}

fn say_problems(problems: &[Diagnostic]) {
    let color = color_wanted(&io::stderr());
    for problem in problems {
        say_aside(&format!("{}\n", problem.render(color)));
    }
}
