//! `wield demonstrate`: a scenario's synthetic human shows the task, and what the recorders saw is kept as CSV.

use std::path::{Path, PathBuf};

use super::progress::RunProgress;
use super::{Exit, SetArguments, keep_json, panics, prepare_told, say, say_aside, say_error, say_json, seed_folder};
use crate::files::{remove_empty, remove_if_present, write_whole};
use crate::pipeline::{RunError, demonstrate};
use crate::report::demonstrations_text;
use crate::scenario::{LARGEST_SEED, ResolvedScenario, notes};
use crate::tasks::{DemonstrationsReport, MOST_DEMONSTRATIONS, ShownTrial};

pub const AFTER_HELP: &str = "\
The human tries until enough trials have succeeded, at most four times as often as that. These are the trials from which
`wield run` with the same seed learns.

Files, in DIR (by default runs/<scenario>/seed-<n>/demonstrations in the current folder):
  <scenario>_<trial>.csv  what the recorders saw in a trial; a comment in it says whether the trial succeeded
  demonstrations.json     all trials: success or reason of failure, distance to the goal, duration, and the true
                          moments of contact, which no recorder sees

Columns of the CSV of a push, all in the frame of the world:
  time_s, tool_x_m, tool_y_m, tool_angle_rad, object_x_m, object_y_m, object_angle_rad
Tool and object are recorded on clocks of their own: a row leaves the fields of the other one empty.

Columns of the CSV of a cut or a pour, the pose of knife or cup in the world:
  time_s, x_m, y_m, z_m, qw, qx, qy, qz
A knife's frame lies in the middle of its edge, level with the heel, x toward the tip, y in the direction of the cut; a
cup's in the middle of its underside, z along its axis, x toward the lip.

To learn from such files, copy them to the folder `demonstrations` of the assets and name them in a scenario:
  [demonstrations.recorded]                    # a push
  assets = [\"push_stick_1\", \"push_stick_2\"]
  [demonstrations.recorded]                    # a cut; scenarios/cut_recorded.toml says what else, and pour_recorded.toml
  asset = \"cut_banana_three_1\"

Examples:
  wield demonstrate scenarios/push_stick.toml
  wield demonstrate scenarios/push_stick.toml --count 20 --seed 7 --out shown
  wield demonstrate scenarios/cut_banana_three.toml --out shown
  wield demonstrate scenarios/push_stick.toml --set object.table_friction=0.4
  wield demonstrate scenarios/push_stick.toml --json | jq '.trials[].goal_error_mm'

Exit codes: 0 success, 1 too few trials succeeded, 2 bad input (nothing written), 3 crashed or diverged.";

/// Name of the summary's file.
const SUMMARY: &str = "demonstrations.json";

/// Options of `wield demonstrate`.
#[derive(Debug, clap::Args)]
pub struct DemonstrateArguments {
    /// Scenario file
    file: PathBuf,
    #[command(flatten)]
    set: SetArguments,
    /// Number of trials that must succeed [default: the scenario's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MOST_DEMONSTRATIONS as u64))]
    count: Option<u64>,
    /// Seed of the human and the recorders [default: the scenario's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=LARGEST_SEED))]
    seed: Option<u64>,
    /// Folder for the files [default: runs/<scenario>/seed-<n>/demonstrations]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print the summary as JSON instead of a table
    #[arg(long)]
    json: bool,
    /// Print nothing but errors
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

/// Loads the scenario, makes sure that files can be written, lets the human show the task, reports.
pub fn execute(arguments: &DemonstrateArguments, assets: Option<&Path>) -> Exit {
    let Some(scenario) = arguments.set.load_told(&arguments.file, assets) else { return Exit::BadInput };
    let seed = arguments.seed.unwrap_or(scenario.header().seed);
    let usual = || seed_folder(&Path::new("runs").join(&scenario.name), seed).join("demonstrations");
    let out = arguments.out.clone().unwrap_or_else(usual);
    let Some(created) = prepare_told(&out) else { return Exit::BadInput };
    if !arguments.quiet {
        notes(&scenario).iter().for_each(|note| say_aside(&format!("note: {note}")));
    }
    match show(arguments, &scenario, seed, &out) {
        Ok(report) => told(arguments, &report, &out),
        Err(error) if error.is_input => {
            remove_empty(&created);
            say_error(&format!("{} with seed {seed}: {error} ({})", scenario.name, arguments.file.display()));
            Exit::BadInput
        }
        Err(error) => {
            say_error(&format!("{} with seed {seed}: {error}", scenario.name));
            Exit::Crashed
        }
    }
}

/// Lets the human show the task and writes each trial into `out` as soon as it is over.
fn show(
    arguments: &DemonstrateArguments,
    scenario: &ResolvedScenario,
    seed: u64,
    out: &Path,
) -> Result<DemonstrationsReport, RunError> {
    let progress = RunProgress::new(arguments.quiet);
    let tell = |stage, share| progress.show(stage, share);
    let count = arguments.count.map(|count| count as usize);
    let mut trials = Vec::new();
    let mut keep = |shown: ShownTrial| {
        // an earlier summary would tell of other files
        remove_if_present(&out.join(SUMMARY)).map_err(|error| format!("remove {SUMMARY}: {error}"))?;
        let file = out.join(&shown.trial.file);
        write_whole(&file, shown.csv.as_bytes()).map_err(|error| format!("write {}: {error}", file.display()))?;
        trials.push(shown.trial);
        Ok(())
    };
    let result = panics::catch(|| demonstrate(scenario, seed, count, &tell, &mut keep));
    progress.finish();
    let shortage = result.unwrap_or_else(|reason| Err(RunError { stage: "demonstrate", reason, is_input: false }))?;
    Ok(DemonstrationsReport::new(&scenario.name, seed, trials, shortage))
}

/// Writes the summary and prints what was asked for.
fn told(arguments: &DemonstrateArguments, report: &DemonstrationsReport, out: &Path) -> Exit {
    let told = match keep_json(&out.join(SUMMARY), report) {
        Exit::Success if arguments.json => say_json(report),
        Exit::Success if arguments.quiet => Exit::Success,
        Exit::Success => say(&format!("{}results: {}\n", demonstrations_text(report), out.display())),
        failed => failed,
    };
    told.unless_missed(report.shortage.is_none())
}
