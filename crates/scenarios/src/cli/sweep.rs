//! `wield sweep`: makes the runs of a campaign that are not done yet.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::campaign::{fail, open_told};
use super::interrupt;
use super::observe::{self, Destination};
use super::panics;
use super::plan::{campaign_assets, prepare};
use super::progress::SweepProgress;
use super::run::share;
use super::seed_run::Pipeline;
use super::shard::ShardChoice;
use super::{Exit, say, say_aside, say_error, say_json};
use crate::assets::Assets;
use crate::campaign::{
    Attempt, CampaignFolder, Execution, FolderError, Manifest, Row, Shard, Summary, TableFormat, execute as make_runs,
    write_tables,
};
use crate::files::prepare_folder;
use crate::report::sweep_text;
use crate::scenario::ResolvedScenario;
use crate::sweep::SweepSummary;

pub const AFTER_HELP: &str = "\
A sweep file names a scenario, keys of it that are varied, and seeds, which are the same at each point:
  [sweep]
  scenario = \"../push_transfer_l.toml\"      # relative to the sweep file
  trials = 10                               # seeds at each point; 1 if absent
  first_seed = 1                            # the scenario's if absent
  invalid_points = \"record\"                 # or \"refuse\", which is usual for a grid: points that make no valid scenario
  [design.grid]                             # or [design.random], [design.latin_hypercube], [design.sobol]: these draw
                                            # points = 64 with seed = 1
  [[factor]]
  key = \"object.table_friction\"             # as for --set
  values = [0.15, 0.25, 0.4]                # or uniform, log_uniform, integers = { min = 1, max = 2 },
                                            # or normal = { mean = 0, sd = 1 }, with min and max if it is cut off;
                                            # the grid takes levels = 5 of these

Every run that ended is a line in the folder, at once and however it ended. Interrupted or killed, the sweep goes on where
it stopped when it is called again; only the runs in flight are made once more. Results depend neither on threads nor on
shards nor on interruptions. Ctrl-C lets the runs in flight end, twice stops at once, as SIGTERM does.

Files, in DIR (by default runs/<sweep> in the current folder):
  manifest.jsonl  what is run: made by `wield plan` or the first call
  journal/        a file for each process that worked on it, a line for each run that ended
  results.parquet the table of all runs that ended, by whichever process; made anew every half minute and at the end

--shard i/n makes the runs whose index is i modulo n. --shard auto takes i and n from the variables of an engine:
  SLURM_ARRAY_TASK_ID with SLURM_ARRAY_TASK_COUNT, _MIN and _STEP; if WIELD_SHARDS is set, task 0 to WIELD_SHARDS - 1
  HQ_TASK_ID or JOB_COMPLETION_INDEX from 0, PARALLEL_SEQ from 1, each with WIELD_SHARDS, the number of shards

Examples:
  wield sweep scenarios/sweeps/push_friction.toml
  wield sweep runs/push_friction                     what is left of it
  wield sweep runs/push_friction --shard 0/4         every fourth run
  wield sweep scenarios/sweeps/push_friction.toml --min-success 0.9 --json | jq .all
  wield sweep runs/push_friction --view              one run at a time is shown in a viewer
  wield run runs/push_friction --row 7               one of its runs, with a recording

Exit codes: 0 all runs were made, whether they kept their limits or not; 1 fewer than --min-success of them did; 2 bad input
(nothing was run); 3 some runs came to no outcome, or results cannot be written; 130 Ctrl-C. Rows of status invalid, whose
values make no valid scenario, count for none of these, and not for --min-success.";

/// Time between two tables that are made while runs are still being made.
const TABLE_INTERVAL: Duration = Duration::from_secs(30);

/// Options of `wield sweep`.
#[derive(Debug, clap::Args)]
pub struct SweepArguments {
    /// Sweep file, or the folder of a campaign
    #[arg(value_name = "SWEEP.toml|DIR")]
    sweep: PathBuf,
    /// Folder for the campaign [default: runs/<sweep>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads; results do not depend on it [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
    /// Make only the runs whose index is I modulo N; `auto` asks the engine that started this
    #[arg(long, value_name = "I/N|auto", default_value = "0/1", hide_default_value = true)]
    shard: ShardChoice,
    /// Share of the runs that must keep all limits for exit code 0, from 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    min_success: f64,
    /// Format of the table of results: parquet, csv, jsonl; several may be named
    #[arg(long, value_name = "FORMAT", default_value = "parquet")]
    format: Vec<TableFormat>,
    /// Stream the run that is being made to a running viewer
    #[arg(long, value_name = "URL")]
    connect: Option<String>,
    /// Start a viewer and stream the run that is being made to it
    #[arg(long)]
    view: bool,
    /// Print the summary as JSON instead of tables
    #[arg(long)]
    json: bool,
    /// Print nothing but errors
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

/// Plans if need be, makes the runs that are left, reports.
pub fn execute(arguments: &SweepArguments, assets: Option<&Path>, pipeline: Pipeline) -> Exit {
    let shard = match arguments.shard.resolve(&|name| std::env::var(name).ok()) {
        Ok(shard) => shard,
        Err(reason) => {
            say_error(&reason);
            return Exit::BadInput;
        }
    };
    if let Err(reason) = check_viewer(arguments) {
        say_error(&reason);
        return Exit::BadInput;
    }
    let (folder, manifest) = match campaign(arguments, assets) {
        Ok(found) => found,
        Err(exit) => return exit,
    };
    let assets = campaign_assets(assets, &manifest);
    Job { arguments, folder, manifest, assets, shard, pipeline, viewer_failed: AtomicBool::new(false) }.run()
}

/// Refuses what this build cannot show.
fn check_viewer(arguments: &SweepArguments) -> Result<(), String> {
    if !observe::AVAILABLE && (arguments.view || arguments.connect.is_some()) {
        return Err("this wield was built without its recorder; build it with the feature `recording`, or leave out \
                    --connect and --view"
            .into());
    }
    Ok(())
}

/// The campaign that the arguments name, planned if they name a sweep file.
fn campaign(arguments: &SweepArguments, assets: Option<&Path>) -> Result<(CampaignFolder, Manifest), Exit> {
    let SweepArguments { sweep, out, quiet, .. } = arguments;
    if !sweep.is_dir() {
        return prepare(sweep, out.as_deref(), assets, *quiet).map(|(plan, folder)| (folder, plan.manifest));
    }
    if out.is_some() {
        say_error(&format!(
            "--out: {} is the folder of a campaign, whose results stay in it; leave out --out",
            sweep.display()
        ));
        return Err(Exit::BadInput);
    }
    let found = open_told(sweep)?;
    prepare_folder(sweep).map_err(|error| {
        say_error(&format!("cannot write to {}: {error}; give this program leave to write there", sweep.display()));
        Exit::BadInput
    })?;
    Ok(found)
}

/// A campaign of which a shard is to be made.
struct Job<'a> {
    arguments: &'a SweepArguments,
    folder: CampaignFolder,
    manifest: Manifest,
    assets: Assets,
    shard: Shard,
    pipeline: Pipeline,
    /// Set once a viewer could not be reached or started.
    viewer_failed: AtomicBool,
}

impl Job<'_> {
    fn run(&self) -> Exit {
        let stop = interrupt::watch();
        let made = match self.make(&stop) {
            Ok(made) => made,
            Err(error) => return self.stopped_by(&error),
        };
        if let Err(error) = write_tables(&self.folder, &self.manifest, &self.arguments.format) {
            return fail(&error);
        }
        if stop.load(Ordering::Relaxed) && made.left > 0 {
            let again = format!("wield sweep {}", self.folder.path().display());
            say_aside(&format!("stopped: {} runs are left; go on with: {again}{}", made.left, self.shard_option()));
            return Exit::Interrupted;
        }
        match SweepSummary::of(&self.folder, &self.manifest, self.shard) {
            Ok(summary) => self.report(&summary),
            Err(error) => fail(&error),
        }
    }

    /// Makes the runs that are left.
    fn make(&self, stop: &AtomicBool) -> Result<Summary, FolderError> {
        let mine = self.manifest.runs.iter().filter(|run| self.shard.holds(run.index)).count();
        let done = self.folder.done(&self.manifest)?;
        let before = (0_u64..).zip(&done).filter(|(index, done)| **done && self.shard.holds(*index)).count();
        let progress = SweepProgress::new(mine, before, self.arguments.quiet);
        let tables = Mutex::new(Instant::now());
        let each = |row: &Row| {
            progress.one_done(row.status);
            // one thread makes the tables, the others go on
            if let Ok(mut last) = tables.try_lock()
                && last.elapsed() >= TABLE_INTERVAL
            {
                // the journals hold everything: a table that cannot be written now is complained about at the end
                let _ = write_tables(&self.folder, &self.manifest, &self.arguments.format);
                *last = Instant::now();
            }
        };
        let watching = Mutex::new(());
        let run = |scenario: &ResolvedScenario, seed: u64| -> Attempt {
            // one run at a time is shown; the next one that begins after it is shown next
            match watching.try_lock() {
                Ok(_shown) if self.is_live() => self.shown_run(scenario, seed),
                _ => panics::catch(|| (self.pipeline)(scenario, seed, &mut (), &|_, _| {})),
            }
        };
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let threads = self.arguments.threads.map_or_else(cores, usize::from);
        let execution = Execution { run: &run, assets: &self.assets, shard: self.shard, threads, stop, each: &each };
        let made = make_runs(&self.folder, &self.manifest, &execution);
        progress.finish();
        made
    }

    /// Whether runs are shown in a viewer while they are made.
    fn is_live(&self) -> bool {
        let wanted = self.arguments.view || self.arguments.connect.is_some();
        wanted && !self.viewer_failed.load(Ordering::Relaxed)
    }

    /// Makes a run that a viewer sees; a viewer that is absent does not change it.
    fn shown_run(&self, scenario: &ResolvedScenario, seed: u64) -> Attempt {
        let SweepArguments { connect, view, .. } = self.arguments;
        let destination = Destination { connect: connect.clone(), view: *view, ..Destination::default() };
        let watched = panics::catch(|| {
            observe::watch(&destination, scenario, seed, |observer| {
                (self.pipeline)(scenario, seed, observer, &|_, _| {})
            })
        })?;
        match watched {
            Ok(watched) => Ok(watched.result),
            // the recorder could not start, so nothing was run: a viewer decides about no result
            Err(reason) => {
                if !self.viewer_failed.swap(true, Ordering::Relaxed) {
                    say_aside(&format!("warning: runs are not shown: {reason}"));
                }
                panics::catch(|| (self.pipeline)(scenario, seed, &mut (), &|_, _| {}))
            }
        }
    }

    /// Says why no further runs can be made, and that the earlier ones are kept.
    fn stopped_by(&self, error: &FolderError) -> Exit {
        let exit = fail(error);
        let again = format!("wield sweep {}{}", self.folder.path().display(), self.shard_option());
        match error {
            FolderError::Io { .. } => {
                say_aside(&format!("runs that ended before are kept; make room, then go on with: {again}"));
            }
            FolderError::Changed { .. } => {
                say_aside(
                    "runs that ended before are kept; bring the files back, or sweep into another folder with --out",
                );
            }
            _ => {}
        }
        exit
    }

    fn shard_option(&self) -> String {
        let Shard { index, count } = self.shard;
        if count == 1 { String::new() } else { format!(" --shard {index}/{count}") }
    }

    fn report(&self, summary: &SweepSummary) -> Exit {
        let told = if self.arguments.json {
            say_json(summary)
        } else if self.arguments.quiet {
            Exit::Success
        } else {
            say(&format!("{}results: {}\n", sweep_text(summary), self.folder.path().display()))
        };
        if summary.all.without_outcome() > 0 {
            return Exit::Crashed;
        }
        let rate = summary.all.success_rate().unwrap_or(1.0);
        told.unless_missed(rate >= self.arguments.min_success)
    }
}
