//! `wield status`, `wield merge`, `wield submit`: what can be done with the folder of a campaign besides running it.

use std::path::{Path, PathBuf};

use super::{Exit, say, say_error, say_json};
use crate::campaign::submission::{ENGINES, Engine, Submission, shard_count};
use crate::campaign::{CampaignFolder, CampaignStatus, FolderError, Manifest, TableFormat, write_tables};
use crate::files::write_whole;
use crate::report::not_run;

pub const STATUS_HELP: &str = "\
The answer comes from the files in the folder alone: the manifest, which lists all runs, and the journals, which hold a
line for every run that ended.

Examples:
  wield status runs/push_friction
  wield status runs/push_friction --json | jq .left

Exit codes: 0 all runs ended, 1 some are left, 2 no such campaign.";

pub const MERGE_HELP: &str = "\
Makes results.parquet (and the formats asked for) from the journals of all processes that worked on the campaign. Rows are
sorted by index and hold no clock time: the bytes do not depend on how the runs were divided. Two copies of a run must be equal.

Examples:
  wield merge runs/push_friction
  wield merge runs/push_friction --format csv --format jsonl
  wield merge runs/push_friction --from other_machine/push_friction

Exit codes: 0 all runs are in the tables, 1 some are missing, 2 bad input, 3 the tables could not be written.";

pub const SUBMIT_HELP: &str = "\
Plan the runs first. Each task of the array makes one shard and skips runs that are done, so tasks may be killed, requeued and
submitted again at will. How far it is, tells `wield status`; when all runs ended, `wield merge` makes the tables.

Engines:
  slurm       a job array; needs sbatch on this machine
  hyperqueue  a task array; needs hq, with a server that runs
  parallel    GNU parallel on this machine, or on others: --option=--sshlogin=host1,host2

Examples:
  wield plan scenarios/sweeps/push_friction.toml
  wield submit slurm runs/push_friction --print
  wield submit slurm runs/push_friction --shards 20 --option=--partition=short
  wield submit parallel runs/push_friction --shards 8";

/// Options of `wield status`.
#[derive(Debug, clap::Args)]
pub struct StatusArguments {
    /// Folder of the campaign
    dir: PathBuf,
    /// Print the answer as JSON
    #[arg(long)]
    json: bool,
}

/// Options of `wield merge`.
#[derive(Debug, clap::Args)]
pub struct MergeArguments {
    /// Folder of the campaign
    dir: PathBuf,
    /// Take in the journals of another folder of the same campaign first
    #[arg(long, value_name = "DIR")]
    from: Vec<PathBuf>,
    /// Format of the table: parquet, csv, jsonl; several may be named
    #[arg(long, value_name = "FORMAT", default_value = "parquet")]
    format: Vec<TableFormat>,
}

/// Options of `wield submit`.
#[derive(Debug, clap::Args)]
pub struct SubmitArguments {
    /// Engine: slurm, hyperqueue, parallel
    #[arg(value_parser = engine)]
    engine: &'static Engine,
    /// Folder of the campaign
    dir: PathBuf,
    /// Number of tasks [default: as many as take --minutes each]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MOST_SHARDS))]
    shards: Option<u64>,
    /// Clock time that a task should take, by the runs that ended so far; 50 runs a task if none did
    #[arg(long, value_name = "MINUTES", default_value_t = 10.0)]
    minutes: f64,
    /// Threads of a task
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: u16,
    /// Further option for the engine, such as --option=--partition=short
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    option: Vec<String>,
    /// Print the script instead of handing it to the engine
    #[arg(long)]
    print: bool,
}

/// Arrays of more tasks than this are refused by many clusters.
const MOST_SHARDS: u64 = 1000;

fn engine(name: &str) -> Result<&'static Engine, String> {
    let known = || ENGINES.iter().map(|engine| engine.name).collect::<Vec<_>>().join(", ");
    ENGINES.iter().find(|engine| engine.name == name).ok_or_else(|| format!("expected one of {}", known()))
}

/// The campaign in a folder; says so if there is none.
pub(super) fn open_told(dir: &Path) -> Result<(CampaignFolder, Manifest), Exit> {
    let folder = CampaignFolder::at(dir);
    if !folder.exists() {
        say_error(&format!(
            "{}: found no manifest.jsonl; expected the folder of a campaign, made by `wield plan` or `wield sweep`",
            dir.display()
        ));
        return Err(Exit::BadInput);
    }
    match folder.manifest() {
        Ok(manifest) => Ok((folder, manifest)),
        Err(error) => {
            say_error(&error.to_string());
            Err(Exit::BadInput)
        }
    }
}

/// Says why a campaign's folder cannot be used, and how that ends the program.
pub(super) fn fail(error: &FolderError) -> Exit {
    say_error(&error.to_string());
    match error {
        FolderError::Io { .. } | FolderError::Contradiction { .. } => Exit::Crashed,
        _ => Exit::BadInput,
    }
}

/// Tells how far a campaign is.
pub fn status(arguments: &StatusArguments) -> Exit {
    let (folder, manifest) = match open_told(&arguments.dir) {
        Ok(found) => found,
        Err(exit) => return exit,
    };
    let status = match CampaignStatus::of(&folder, &manifest) {
        Ok(status) => status,
        Err(error) => return fail(&error),
    };
    let said = if arguments.json { say_json(&status) } else { say(&status_text(&status)) };
    said.unless_missed(status.left() == 0)
}

fn status_text(status: &CampaignStatus) -> String {
    let CampaignStatus { scenario, planned, done, success, missed, crashed, refused, invalid, .. } = status;
    let [low, high] = status.success_interval_95.map(|share| 100.0 * share);
    let mut text = format!("{scenario}: {done} of {planned} runs ended: {success} success, {missed} missed, ");
    text += &format!("{crashed} crashed, {refused} refused{}\n", not_run(*invalid));
    if let Some(per_run_s) = status.wall_per_run_s() {
        text += &format!("success rate: {:.1} % ", 100.0 * *success as f64 / status.made() as f64);
        text += &format!("(95 % interval {low:.1} to {high:.1} %, Wilson); {per_run_s:.2} s a run\n");
    }
    for (reason, count) in &status.reasons {
        text += &format!("{count} × {reason}\n");
    }
    if let Some(per_run_s) = status.wall_per_run_s().filter(|_| status.left() > 0) {
        text += &format!("left: {} runs, {:.0} s on one core\n", status.left(), per_run_s * status.left() as f64);
    }
    text
}

/// Makes the tables of a campaign.
pub fn merge(arguments: &MergeArguments) -> Exit {
    let (folder, manifest) = match open_told(&arguments.dir) {
        Ok(found) => found,
        Err(exit) => return exit,
    };
    for from in &arguments.from {
        let (other, theirs) = match open_told(from) {
            Ok(found) => found,
            Err(exit) => return exit,
        };
        if let Err(error) = folder.prepare(&theirs).and_then(|()| folder.take_in(&other)) {
            return fail(&error);
        }
    }
    match write_tables(&folder, &manifest, &arguments.format) {
        Ok((rows, files)) => {
            let files = files.iter().map(|file| format!("table: {}\n", file.display())).collect::<String>();
            say(&format!("{rows} of {} runs\n{files}", manifest.runs.len())).unless_missed(rows == manifest.runs.len())
        }
        Err(error) => fail(&error),
    }
}

/// Hands a campaign to an engine.
pub fn submit(arguments: &SubmitArguments) -> Exit {
    let (folder, manifest) = match open_told(&arguments.dir) {
        Ok(found) => found,
        Err(exit) => return exit,
    };
    let status = match CampaignStatus::of(&folder, &manifest) {
        Ok(status) => status,
        Err(error) => return fail(&error),
    };
    if status.left() == 0 {
        return say("all runs are done: there is nothing to submit\n");
    }
    let submission = match submission(arguments, &manifest, &status) {
        Ok(submission) => submission,
        Err(reason) => {
            say_error(&reason);
            return Exit::Crashed;
        }
    };
    let script = (arguments.engine.script)(&submission);
    if arguments.print {
        return say(&script);
    }
    match start(arguments.engine, &submission, &script) {
        Ok(()) => say(&format!(
            "submitted {} shards to {}; `wield status {dir}` tells how far they are, `wield merge {dir}` makes the tables\n",
            submission.shards,
            arguments.engine.name,
            dir = arguments.dir.display(),
        )),
        Err(reason) => {
            say_error(&reason);
            Exit::Crashed
        }
    }
}

fn submission(arguments: &SubmitArguments, manifest: &Manifest, status: &CampaignStatus) -> Result<Submission, String> {
    let absolute = |path: &Path| path.canonicalize().map_err(|error| format!("{}: {error}", path.display()));
    let per_run_s = status.wall_per_run_s();
    let shards = arguments
        .shards
        .unwrap_or_else(|| shard_count(status.left(), per_run_s, arguments.minutes, arguments.threads, MOST_SHARDS));
    let runs_of_one = status.left().div_ceil(shards as usize) as f64;
    Ok(Submission {
        name: format!("wield-{}", manifest.base.scenario),
        program: std::env::current_exe().map_err(|error| format!("find the program: {error}"))?,
        work_in: absolute(Path::new("."))?,
        folder: absolute(&arguments.dir)?,
        shards,
        threads: arguments.threads,
        expected_s: per_run_s.map(|per_run_s| per_run_s * runs_of_one / f64::from(arguments.threads)),
        options: arguments.option.clone(),
    })
}

fn start(engine: &Engine, submission: &Submission, script: &str) -> Result<(), String> {
    let file = submission.folder.join(format!("submit-{}.sh", engine.name));
    let written =
        std::fs::create_dir_all(submission.folder.join("log")).and_then(|()| write_whole(&file, script.as_bytes()));
    written.map_err(|error| format!("write {}: {error}", file.display()))?;
    let Some((program, options)) = engine.start.split_first() else { return Ok(()) };
    let ended = std::process::Command::new(program).args(options).arg(&file).status();
    match ended {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{program} {}: {status}; its message stands above", file.display())),
        Err(error) => Err(format!("start {program}: {error}; install {} or look at --print", engine.name)),
    }
}
