//! The command line: verbs, their options, exit codes.

mod campaign;
mod check;
mod compare;
mod comparing;
mod completions;
mod demonstrate;
mod design;
mod explain;
mod gains;
mod interrupt;
mod learn;
mod list;
mod man;
mod new;
mod observe;
mod overwrite;
mod panics;
mod plan;
mod progress;
mod reproduce;
mod row;
mod run;
mod schema;
mod seed_folder;
mod seed_run;
mod shard;
mod sweep;
mod view;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use serde::Serialize;

use crate::assets::Assets;
use crate::diagnostic::{Diagnostic, color_wanted};
use crate::files::{prepare_folder, write_whole};
use crate::report::json;
use crate::scenario::{Change, GivenBy, ResolvedScenario, Source, load_changed};
use crate::sweep::is_sweep;

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
    /// Ctrl-C ended it before everything was done; what was done is kept.
    Interrupted,
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
            Exit::Interrupted => interrupt::CODE,
        })
    }
}

const AFTER_HELP: &str = "\
Examples:
  wield list                                       what there is: scenarios, tools, robots, tasks
  wield new push                                   write a scenario to begin with, push.toml
  wield explain task.push.transfer                 what a key means, its unit and default
  wield check scenarios/*.toml                     find every mistake, run nothing
  wield run scenarios/push_stick.toml              run it; results go to runs/push_stick/seed-1/
  wield run scenarios/push_stick.toml --trials 20  seeds 1 to 20 in parallel, with the success rate
  wield compare scenarios/push_compare.toml --tool stick --tool l    which tool is better, and how surely
  wield run scenarios/push_stick.toml --set object.mass_kg=0.01   with another value of one key
  wield sweep scenarios/sweeps/push_friction.toml  many runs over several values, on all cores; goes on where it stopped
  wield demonstrate scenarios/push_stick.toml      only what the synthetic human shows, as CSV files
  wield reproduce                                  every figure, table and claim of the paper, with a verdict
  wield gains                                      how closely the Panda follows under several gains

Exit codes:
  0  success
  1  a task missed its limits, or too few trials succeeded
  2  bad input: nothing was run, nothing was written
  3  a run crashed or diverged
  130  Ctrl-C: what was done is kept

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
    /// Compare tools or other values: which is better, by how much, how surely
    #[command(after_long_help = compare::AFTER_HELP)]
    Compare(compare::CompareArguments),
    /// Choose parameters of a tool for a scenario, and compare the best tool with the start
    #[command(after_long_help = design::AFTER_HELP)]
    Design(design::DesignArguments),
    /// Plan many runs: list them in a folder from which they can be made
    #[command(after_long_help = plan::AFTER_HELP)]
    Plan(plan::PlanArguments),
    /// Make many runs on all cores: those of a sweep file, or those left in a folder
    #[command(after_long_help = sweep::AFTER_HELP)]
    Sweep(sweep::SweepArguments),
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
    /// Tell how far a campaign of runs is
    #[command(after_long_help = campaign::STATUS_HELP)]
    Status(campaign::StatusArguments),
    /// Make the tables of a campaign from what its processes wrote down
    #[command(after_long_help = campaign::MERGE_HELP)]
    Merge(campaign::MergeArguments),
    /// Hand the runs of a campaign to Slurm, HyperQueue or GNU parallel
    #[command(after_long_help = campaign::SUBMIT_HELP)]
    Submit(campaign::SubmitArguments),
    /// Open recordings in the viewer
    #[command(after_long_help = view::AFTER_HELP)]
    View(view::ViewArguments),
    /// Check scenario and sweep files without running them
    #[command(after_long_help = check::AFTER_HELP)]
    Check(check::CheckArguments),
    /// List scenarios, tools, robots, tasks, demonstrations and skills
    List(list::ListArguments),
    /// Write a scenario or a tool to begin with
    #[command(after_long_help = new::AFTER_HELP)]
    New(new::NewArguments),
    /// Say what a key of a scenario or an asset means: type, unit, default, where it is shown
    #[command(after_long_help = explain::AFTER_HELP)]
    Explain(explain::ExplainArguments),
    /// Print the JSON Schema of scenarios and assets, for editors
    #[command(after_long_help = schema::AFTER_HELP)]
    Schema(schema::SchemaArguments),
    /// Print a script that lets a shell complete verbs and options
    #[command(after_long_help = completions::AFTER_HELP)]
    Completions(completions::CompletionsArguments),
    /// Print the manual
    #[command(after_long_help = man::AFTER_HELP)]
    Man(man::ManArguments),
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
        Verb::Compare(compare) => compare::execute(&compare, assets),
        Verb::Design(design) => design::execute(&design, assets),
        Verb::Plan(plan) => plan::execute(&plan, assets),
        Verb::Sweep(sweep) => sweep::execute(&sweep, assets, crate::pipeline::run),
        Verb::Demonstrate(demonstrate) => demonstrate::execute(&demonstrate, assets),
        Verb::Learn(learn) => learn::execute(&learn, assets),
        Verb::Reproduce(reproduce) => reproduce::execute(&reproduce, assets),
        Verb::Gains(gains) => gains::execute(&gains, assets),
        Verb::Status(status) => campaign::status(&status),
        Verb::Merge(merge) => campaign::merge(&merge),
        Verb::Submit(submit) => campaign::submit(&submit),
        Verb::View(view) => view::execute(&view),
        Verb::Check(check) => check::execute(&check, assets),
        Verb::List(list) => list::execute(&list, assets),
        Verb::New(new) => new::execute(&new, assets),
        Verb::Explain(explain) => explain::execute(&explain, assets),
        Verb::Schema(schema) => schema::execute(&schema),
        Verb::Completions(completions) => completions::execute(&completions),
        Verb::Man(man) => man::execute(&man),
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

/// Values of keys that differ from what the scenario file says.
#[derive(Debug, Default, clap::Args)]
struct SetArguments {
    /// Gives a key another value: object.mass_kg=0.01, task.push.goal_m=[0, 0.1], tool.asset=l; after a colon a key of the
    /// file that the value names: tool.asset:friction=0.5. Can be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    changes: Vec<Change>,
}

impl SetArguments {
    /// Loads a scenario with these changes.
    fn load(&self, file: &Path, assets: Option<&Path>) -> Result<ResolvedScenario, Vec<Diagnostic>> {
        if is_sweep(file) {
            let problem = Diagnostic::of_file(file, "this is a sweep, not a scenario").expected("a scenario file");
            return Err(vec![problem.help([format!("its runs are made by `wield sweep {}`", file.display())])]);
        }
        let source = Source::read(file).map_err(|problem| vec![*problem])?;
        load_changed(file, &source.text, &self.changes, GivenBy::Option, &assets_for(assets, Some(file)))
    }

    /// Loads a scenario with these changes; says what is wrong with it if that fails.
    fn load_told(&self, file: &Path, assets: Option<&Path>) -> Option<ResolvedScenario> {
        self.load(file, assets).map_err(|problems| say_problems(&problems)).ok()
    }
}

/// Loads a scenario as it is; says what is wrong with it if that fails.
fn load_told(file: &Path, assets: Option<&Path>) -> Option<ResolvedScenario> {
    SetArguments::default().load_told(file, assets)
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
