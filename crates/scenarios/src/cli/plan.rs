//! `wield plan`: lists the runs of a sweep in a folder, and what campaigns have in common on the command line.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::campaign::fail;
use super::{Exit, assets_for, say, say_aside, say_error, say_json, say_problems, unwritable};
use crate::assets::Assets;
use crate::campaign::{CampaignFolder, CampaignStatus, Manifest, PlannedRun};
use crate::diagnostic::Diagnostic;
use crate::files::{prepare_folder, remove_empty};
use crate::scenario::notes;
use crate::sweep::{Design, Sweep, load_sweep};

pub const AFTER_HELP: &str = "\
Every point is read as a scenario now: mistakes are found before anything is run. A point that makes no valid scenario is
refused in a grid, and kept as rows of status invalid where points are drawn; `invalid_points` in [sweep] says otherwise. The plan depends on the files alone, so
planning again changes nothing; what was planned differently needs another folder.

Files, in DIR (by default runs/<sweep> in the current folder):
  manifest.jsonl  the scenario, its factors, and a line for each run: identity, seed, values

Examples:
  wield plan scenarios/sweeps/push_friction.toml
  wield plan scenarios/sweeps/push_friction.toml --out results/friction
  wield sweep runs/push_friction --shard 0/4        then, here or on machines that share the folder, the other three

Exit codes: 0 planned, 2 bad input (nothing written).";

/// Options of `wield plan`.
#[derive(Debug, clap::Args)]
pub struct PlanArguments {
    /// Sweep file
    sweep: PathBuf,
    /// Folder for the campaign [default: runs/<sweep>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the plan as JSON
    #[arg(long)]
    json: bool,
    /// Print nothing but errors
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

/// A sweep and its runs.
pub struct Plan {
    /// The sweep.
    pub sweep: Sweep,
    /// Its runs.
    pub manifest: Manifest,
}

/// What `wield plan --json` prints.
#[derive(Serialize)]
struct PlanReport<'a> {
    schema: &'static str,
    name: &'a str,
    scenario: &'a str,
    folder: &'a Path,
    design: &'static str,
    points: usize,
    first_seed: u64,
    trials: u64,
    runs: usize,
    /// Of these, those that will not be made: their values make no valid scenario.
    invalid: usize,
    done: usize,
    /// Time on one core that the runs which are left will take, s, by those that ended; `null` if none did.
    left_s: Option<f64>,
}

/// Plans a sweep and says what was planned.
pub fn execute(arguments: &PlanArguments, assets: Option<&Path>) -> Exit {
    let (plan, folder) = match prepare(&arguments.sweep, arguments.out.as_deref(), assets, arguments.quiet) {
        Ok(prepared) => prepared,
        Err(exit) => return exit,
    };
    let status = match CampaignStatus::of(&folder, &plan.manifest) {
        Ok(status) => status,
        Err(error) => return fail(&error),
    };
    let (runs, done) = (status.planned, status.done);
    let left_s = status.wall_per_run_s().map(|per_run_s| per_run_s * status.left() as f64);
    let points = runs / usize::try_from(plan.sweep.trials).unwrap_or(1).max(1);
    if arguments.json {
        return say_json(&PlanReport {
            schema: "wield.plan/1",
            name: &plan.sweep.name,
            scenario: &plan.manifest.base.scenario,
            folder: folder.path(),
            design: plan.sweep.design.name(),
            points,
            first_seed: plan.sweep.first_seed,
            trials: plan.sweep.trials,
            runs,
            invalid: invalid_runs(&plan.manifest).count(),
            done,
            left_s,
        });
    }
    if arguments.quiet {
        return Exit::Success;
    }
    let left = match left_s {
        _ if done == runs => "all runs are done\n".to_owned(),
        Some(left_s) => format!("{done} of {runs} runs are done; the others take about {left_s:.0} s of one core\n"),
        None => "how long a run takes shows when the first has ended\n".to_owned(),
    };
    say(&format!("{}{left}next: wield sweep {}\n", described(&plan.sweep, points), folder.path().display()))
}

/// What a sweep consists of, a line for each factor.
fn described(sweep: &Sweep, points: usize) -> String {
    let Sweep { name, scenario, trials, first_seed, .. } = sweep;
    let seeds = match trials {
        1 => format!("seed {first_seed}"),
        _ => format!("seeds {first_seed} to {}", first_seed + trials - 1),
    };
    let of_points = if points == 1 { "1 point".to_owned() } else { format!("{points} points") };
    let runs = points as u64 * trials;
    let design = sweep.design.name().replace('_', " ");
    let mut text = format!("{name}: {runs} runs of {}: {of_points} ({design}), {seeds}\n", scenario.name);
    for factor in &sweep.factors {
        let over =
            if factor.levels.is_empty() { "drawn".to_owned() } else { format!("{} values", factor.levels.len()) };
        text += &format!("  {}: {over}\n", factor.key);
    }
    text
}

/// Reads a sweep file and plans its runs.
///
/// # Errors
/// What is wrong with the file, or with the scenarios that it makes.
pub fn planned(file: &Path, assets: Option<&Path>, progress: &dyn Fn(usize, usize)) -> Result<Plan, Vec<Diagnostic>> {
    let sweep = load_sweep(file, &|scenario| assets_for(assets, Some(scenario)))?;
    let manifest = sweep.plan(&assets_for(assets, Some(&sweep.scenario_file)), progress)?;
    Ok(Plan { sweep, manifest })
}

/// Plans a sweep and writes the plan into its folder, or makes sure that the one which is there is the same.
///
/// # Errors
/// How that ends the program; why was said.
pub fn prepare(
    file: &Path,
    out: Option<&Path>,
    assets: Option<&Path>,
    quiet: bool,
) -> Result<(Plan, CampaignFolder), Exit> {
    let told = Cell::new(std::time::Instant::now());
    let progress = |done: usize, of: usize| {
        if !quiet && told.get().elapsed() >= super::progress::LINE_INTERVAL {
            told.set(std::time::Instant::now());
            say_aside(&format!("planned {done} of {of} runs"));
        }
    };
    let plan = planned(file, assets, &progress).map_err(|problems| {
        say_problems(&problems);
        Exit::BadInput
    })?;
    if !quiet {
        notes(&plan.sweep.scenario).iter().for_each(|note| say_aside(&format!("note: {note}")));
        invalid_points(&plan).iter().for_each(|note| say_aside(&format!("note: {note}")));
        balance(plan.sweep.design).iter().for_each(|note| say_aside(&format!("note: {note}")));
    }
    let path = out.map_or_else(|| Path::new("runs").join(&plan.sweep.name), Path::to_owned);
    let folder = CampaignFolder::at(&path);
    let created = prepare_folder(&path).map_err(|error| {
        say_error(&unwritable(&path, &error, "--out"));
        Exit::BadInput
    })?;
    match folder.prepare(&plan.manifest) {
        Ok(()) => Ok((plan, folder)),
        Err(error) => {
            remove_empty(&created);
            Err(fail(&error))
        }
    }
}

fn invalid_runs(manifest: &Manifest) -> impl Iterator<Item = &PlannedRun> {
    manifest.runs.iter().filter(|run| !run.invalid.is_empty())
}

/// A remark on points that make no valid scenario.
pub fn invalid_points(plan: &Plan) -> Option<String> {
    let first = invalid_runs(&plan.manifest).next()?;
    let (invalid, runs) = (invalid_runs(&plan.manifest).count(), plan.manifest.runs.len());
    let reason = first.invalid.first().map_or("", String::as_str);
    Some(format!(
        "found {invalid} of {runs} runs without a valid scenario, kept as rows of status invalid; the first is run {}: {reason}",
        first.index
    ))
}

/// A remark on a number of points that leaves Sobol' points out of balance.
fn balance(design: Design) -> Option<String> {
    match design {
        Design::Sobol { points, .. } if !points.is_power_of_two() => {
            let below = 1_u64 << points.max(1).ilog2();
            Some(format!("{points} Sobol' points are no power of two: {below} or {} are balanced better", 2 * below))
        }
        _ => None,
    }
}

/// Where the assets of a campaign are: where they are said to be, else where they were when it was planned, else where
/// those of any scenario are looked for.
pub fn campaign_assets(explicit: Option<&Path>, manifest: &Manifest) -> Assets {
    match explicit {
        None if manifest.base.assets.is_dir() => Assets::at(&manifest.base.assets),
        _ => assets_for(explicit, Some(&manifest.base.file)),
    }
}
