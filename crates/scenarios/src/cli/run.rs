//! `wield run`: a scenario under one seed or several.

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use rayon::prelude::*;

use super::observe::{self, Destination, Serving};
use super::progress::{RunProgress, TrialsProgress};
use super::seed_folder::other_seeds;
use super::seed_run::{Failure, Finished, Pipeline, RECORDING, run_seed};
use super::{
    Exit, SetArguments, interrupt, keep_json, overwrite, row, say, say_aside, say_error, say_json, seed_folder,
    unwritable,
};
use crate::files::{prepare_folder, probe, remove_empty};
use crate::report::{run_text, trials_text};
use crate::scenario::{LARGEST_SEED, ResolvedScenario, notes};
use crate::trials::{Status, Trial, TrialsReport};

pub const AFTER_HELP: &str = "\
Files, in DIR (by default runs/<scenario> in the current folder):
  seed-<n>/outcome.json    the measures and the verdict; the same run gives the same bytes
  seed-<n>/scenario.toml   the scenario with every default written out and the seed: run it again as it was
  seed-<n>/recording.rrd   the recording, for the Rerun viewer
  seed-<n>/telemetry.parquet  with --telemetry: joints, tool, references, object, curves, one row per control period
  trials.json              with --trials: all seeds, the success rate, mean and worst of the judged measures
A run is written to seed-<n>.partial, and takes the place of an earlier one when it has ended.

Examples:
  wield run scenarios/push_stick.toml
  wield run scenarios/push_stick.toml --seed 7 --out results/push
  wield run scenarios/push_stick.toml --trials 50 --min-success 0.9
  wield run scenarios/push_stick.toml --json --no-record | jq .measures
  wield run scenarios/push_stick.toml --telemetry
  wield run scenarios/push_stick.toml --set object.table_friction=0.4 --set tool.asset:mass_kg=0.02

A single run of a sweep, with its recording, in runs/push_friction/row-7/:
  wield run runs/push_friction --row 7

Exit codes: 0 success, 1 limits missed, 2 bad input (nothing written), 3 crashed or diverged, or not the same as before,
130 Ctrl-C (with --trials those that have ended are kept; a second Ctrl-C stops at once).";

/// Options of `wield run`.
#[derive(Debug, clap::Args)]
pub struct RunArguments {
    /// Scenario file; with --row the folder of a campaign
    pub file: PathBuf,
    #[command(flatten)]
    set: SetArguments,
    /// Run this row of the campaign in the folder again, and compare the result with what the row says
    #[arg(long, value_name = "N", conflicts_with_all = ["changes", "seed", "trials", "min_success", "threads", "record_all"])]
    row: Option<u64>,
    /// Seed of the run, or of the first trial [default: the scenario's]
    #[arg(long, value_name = "N", visible_alias = "first-seed", value_parser = clap::value_parser!(u64).range(..=LARGEST_SEED))]
    seed: Option<u64>,
    /// Number of trials, with seeds that follow each other
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    trials: u32,
    /// With several trials: share that must succeed for exit code 0, from 0 to 1
    #[arg(long, value_name = "SHARE", default_value_t = 1.0, value_parser = share)]
    min_success: f64,
    /// Threads for trials; results do not depend on it [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
    /// Folder for results [default: runs/<scenario>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Do not record
    #[arg(long, conflicts_with_all = ["record", "record_all", "connect", "serve", "view"])]
    no_record: bool,
    /// Record to this file instead of recording.rrd in the seed's folder
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// With several trials: record each into its seed's folder
    #[arg(long, conflicts_with = "record")]
    record_all: bool,
    /// Keep the state at every control instant as a table, telemetry.parquet
    #[arg(long)]
    telemetry: bool,
    /// Stream the recording to a running viewer
    #[arg(long, value_name = "URL")]
    connect: Option<String>,
    /// Serve the recording to viewers on this port
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "9876")]
    serve: Option<u16>,
    /// Start a viewer and stream to it
    #[arg(long)]
    view: bool,
    /// Print the result as JSON instead of tables
    #[arg(long)]
    json: bool,
    /// Print nothing but errors
    #[arg(long, short, conflicts_with = "json")]
    pub quiet: bool,
}

impl RunArguments {
    /// Where a run is recorded whose files go to `folder`.
    pub fn destination(&self, folder: &Path) -> Destination {
        let Self { no_record, record, record_all, connect, serve, view, telemetry, trials, .. } = self;
        if *no_record || !observe::AVAILABLE || (*trials > 1 && !record_all) {
            return Destination { telemetry: *telemetry, ..Destination::default() };
        }
        let file = record.clone().unwrap_or_else(|| folder.join(RECORDING));
        Destination { file: Some(file), connect: connect.clone(), serve: *serve, view: *view, telemetry: *telemetry }
    }

    /// Makes sure that what is asked for can be recorded.
    pub fn check_recording(&self) -> Result<(), String> {
        check_recording(self)?;
        let Some(file) = &self.record else { return Ok(()) };
        probe(file).map_err(|error| unwritable(file, &error, "--record"))?;
        overwrite::only(file, overwrite::RECORDING, "--record")
    }

    /// Makes one run and tells about it, on stdout and in `folder`.
    pub fn run_told(
        &self,
        pipeline: Pipeline,
        scenario: &ResolvedScenario,
        seed: u64,
        folder: &Path,
    ) -> Result<(Exit, Finished), Failure> {
        let destination = self.destination(folder);
        let progress = RunProgress::new(self.quiet);
        let show = |stage, share| progress.show(stage, share);
        let result = run_seed(pipeline, scenario, seed, folder, &destination, &show);
        progress.finish();
        let finished = result?;
        finished.warnings.iter().for_each(|warning| say_aside(&format!("warning: {warning}")));
        let written = if self.json {
            say_json(&finished.report.outcome)
        } else if self.quiet {
            Exit::Success
        } else {
            let recording =
                destination.file.map_or_else(String::new, |file| format!("recording: {}\n", file.display()));
            say(&format!("{}results: {}\n{recording}", run_text(&finished.report), folder.display()))
        };
        Ok((written, finished))
    }
}

/// Loads the scenario, makes sure that results can be written, runs, reports.
pub fn execute(arguments: &RunArguments, assets: Option<&Path>, pipeline: Pipeline) -> Exit {
    if let Some(index) = arguments.row {
        return row::execute(arguments, index, assets, pipeline);
    }
    let Some(scenario) = arguments.set.load_told(&arguments.file, assets) else { return Exit::BadInput };
    let job = match Job::new(arguments, &scenario, pipeline) {
        Ok(job) => job,
        Err(reason) => {
            say_error(&reason);
            return Exit::BadInput;
        }
    };
    if !arguments.quiet {
        notes(&scenario).iter().for_each(|note| say_aside(&format!("note: {note}")));
    }
    if arguments.trials == 1 { job.run_once() } else { job.run_trials() }
}

/// What is to be run, after all that could be wrong with it was checked.
struct Job<'a> {
    arguments: &'a RunArguments,
    scenario: &'a ResolvedScenario,
    pipeline: Pipeline,
    out: PathBuf,
    /// Folders that were made for the results.
    created: Vec<PathBuf>,
    first_seed: u64,
}

impl<'a> Job<'a> {
    fn new(arguments: &'a RunArguments, scenario: &'a ResolvedScenario, pipeline: Pipeline) -> Result<Self, String> {
        arguments.check_recording()?;
        let first_seed = arguments.seed.unwrap_or(scenario.header().seed);
        if first_seed > LARGEST_SEED - u64::from(arguments.trials - 1) {
            return Err(format!(
                "--trials {}: the last seed would be above {LARGEST_SEED}; lower --seed",
                arguments.trials
            ));
        }
        let out = arguments.out.clone().unwrap_or_else(|| Path::new("runs").join(&scenario.name));
        let created = prepare_folder(&out).map_err(|error| unwritable(&out, &error, "--out"))?;
        Ok(Self { arguments, scenario, pipeline, out, created, first_seed })
    }

    fn run_once(&self) -> Exit {
        let (seed, folder) = (self.first_seed, seed_folder(&self.out, self.first_seed));
        let (written, finished) = match self.arguments.run_told(self.pipeline, self.scenario, seed, &folder) {
            Ok(finished) => finished,
            Err(failure) => return self.fail(seed, &failure),
        };
        if let Some(serving) = &finished.serving {
            serve_until_enter(serving);
        }
        written.unless_missed(finished.report.outcome.success)
    }

    fn fail(&self, seed: u64, failure: &Failure) -> Exit {
        let about = format!("run {} with seed {seed}", self.scenario.name);
        match failure {
            Failure::Refused(reason) => {
                remove_empty(&self.created);
                say_error(&format!("{about}: {reason} ({})", self.arguments.file.display()));
                Exit::BadInput
            }
            Failure::Crashed(reason) => {
                say_error(&format!("{about}: {reason}"));
                Exit::Crashed
            }
        }
    }

    fn run_trials(&self) -> Exit {
        let seeds = self.first_seed..self.first_seed + u64::from(self.arguments.trials);
        let progress = TrialsProgress::new(self.arguments.trials as usize, self.arguments.quiet);
        let stop = interrupt::watch();
        let unless_stopped = |seed| (!stop.load(Ordering::Relaxed)).then(|| self.trial(seed, &progress));
        let trials = || -> Vec<(Trial, Vec<String>)> {
            let seeds: Vec<u64> = seeds.collect();
            seeds.into_par_iter().filter_map(unless_stopped).collect()
        };
        let threads = self.arguments.threads.map_or(0, usize::from);
        let results = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
            Ok(pool) => pool.install(trials),
            Err(error) => {
                say_error(&format!("start threads: {error}; lower --threads"));
                return Exit::Crashed;
            }
        };
        progress.finish();
        let (trials, warnings): (Vec<_>, Vec<_>) = results.into_iter().unzip();
        warnings.iter().flatten().for_each(|warning| say_aside(&format!("warning: {warning}")));
        let missing = self.arguments.trials as usize - trials.len();
        if missing > 0 {
            say_aside(&format!("stopped: {missing} of {} trials were not begun", self.arguments.trials));
            if trials.is_empty() {
                remove_empty(&self.created);
                return Exit::Interrupted;
            }
        }
        let exit = self.report_trials(&TrialsReport::new(&self.scenario.name, trials, self.arguments.min_success));
        if missing > 0 { Exit::Interrupted } else { exit }
    }

    fn trial(&self, seed: u64, progress: &TrialsProgress) -> (Trial, Vec<String>) {
        let folder = seed_folder(&self.out, seed);
        let destination = self.arguments.destination(&folder);
        let result = run_seed(self.pipeline, self.scenario, seed, &folder, &destination, &|_, _| {});
        progress.one_done();
        match result {
            Ok(finished) => (Trial::of_outcome(&finished.report.outcome), finished.warnings),
            Err(Failure::Refused(reason)) => (Trial::without_outcome(seed, Status::Refused, reason), Vec::new()),
            Err(Failure::Crashed(reason)) => (Trial::without_outcome(seed, Status::Crashed, reason), Vec::new()),
        }
    }

    fn report_trials(&self, report: &TrialsReport) -> Exit {
        if let Some(refused) = report.trials.iter().find(|trial| trial.status == Status::Refused) {
            return self.fail(refused.seed, &Failure::Refused(refused.reason()));
        }
        let kept = keep_json(&self.out.join("trials.json"), report);
        if kept != Exit::Success {
            return kept;
        }
        self.tell_of_other_seeds();
        let written = if self.arguments.json {
            say_json(report)
        } else if self.arguments.quiet {
            Exit::Success
        } else {
            say(&format!("{}results: {}\n", trials_text(report), self.out.display()))
        };
        if report.any(Status::Crashed) { Exit::Crashed } else { written.unless_missed(report.success()) }
    }
}

/// How many other seeds are named.
const NAMED_SEEDS: usize = 5;

impl Job<'_> {
    /// Results of other seeds in the same folder are easily taken for these.
    fn tell_of_other_seeds(&self) {
        let others = other_seeds(&self.out, self.first_seed..self.first_seed + u64::from(self.arguments.trials));
        if others.is_empty() {
            return;
        }
        let named: Vec<String> = others.iter().take(NAMED_SEEDS).map(|seed| format!("seed-{seed}")).collect();
        let more = others.len().saturating_sub(NAMED_SEEDS);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        say_aside(&format!(
            "warning: {} also holds {}{more}, of an earlier call; trials.json does not count them",
            self.out.display(),
            named.join(", ")
        ));
    }
}

/// Keeps a server up for viewers until Enter is pressed or the input ends.
pub fn serve_until_enter(serving: &Serving) {
    let url = serving.url();
    say_aside(&format!("the recording is served at {url}: open it with `rerun {url}`; press Enter to end"));
    let mut line = String::new();
    // an input that cannot be read has ended
    let _ = std::io::stdin().read_line(&mut line);
}

/// Refuses recordings that this build cannot make, and one file for several trials.
fn check_recording(arguments: &RunArguments) -> Result<(), String> {
    let live = arguments.connect.is_some() || arguments.serve.is_some() || arguments.view;
    if !observe::AVAILABLE && (live || arguments.record.is_some() || arguments.record_all) {
        return Err("this wield was built without its recorder; build it with the feature `recording`, or leave out \
                    --record, --record-all, --connect, --serve and --view"
            .into());
    }
    if arguments.trials > 1 && (live || arguments.record.is_some()) {
        return Err("several trials cannot share one recording; use --record-all, or run one seed".into());
    }
    Ok(())
}

/// Reads a share.
pub fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(share),
        _ => Err("expected a number from 0 to 1".into()),
    }
}

#[cfg(test)]
#[path = "run_tests.rs"]
mod tests;
