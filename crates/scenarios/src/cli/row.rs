//! `wield run DIR --row N`: one run of a campaign alone, compared with what its row says.

use std::path::Path;

use super::campaign::{fail, open_told};
use super::plan::campaign_assets;
use super::run::{RunArguments, serve_until_enter};
use super::seed_run::{Failure, Pipeline};
use super::{Exit, prepare_told, say_aside, say_error};
use crate::campaign::{CampaignFolder, Manifest, PlannedRun, Row, load_run};
use crate::files::remove_empty;
use crate::trials::Status;

/// Runs row `index` of the campaign in the folder that the arguments name.
pub fn execute(arguments: &RunArguments, index: u64, assets: Option<&Path>, pipeline: Pipeline) -> Exit {
    let (folder, manifest) = match open_told(&arguments.file) {
        Ok(found) => found,
        Err(exit) => return exit,
    };
    let planned = usize::try_from(index).ok().and_then(|index| manifest.runs.get(index));
    let Some(run) = planned else {
        let last = manifest.runs.len().saturating_sub(1);
        say_error(&format!("--row {index}: {} has the rows 0 to {last}", folder.path().display()));
        return Exit::BadInput;
    };
    match prepared(arguments, &folder, &manifest, run) {
        Ok(row) => repeat(arguments, &folder, &manifest, run, row.as_ref(), assets, pipeline),
        Err(exit) => exit,
    }
}

/// The row of a run, after everything was looked at that could keep it from being repeated.
fn prepared(
    arguments: &RunArguments,
    folder: &CampaignFolder,
    manifest: &Manifest,
    run: &PlannedRun,
) -> Result<Option<Row>, Exit> {
    arguments.check_recording().map_err(|reason| {
        say_error(&reason);
        Exit::BadInput
    })?;
    // journals of other campaigns are refused
    folder.done(manifest).and_then(|_| folder.row(run.index)).map_err(|error| fail(&error))
}

fn repeat(
    arguments: &RunArguments,
    folder: &CampaignFolder,
    manifest: &Manifest,
    run: &PlannedRun,
    row: Option<&Row>,
    assets: Option<&Path>,
    pipeline: Pipeline,
) -> Exit {
    let scenario = match load_run(manifest, run, &campaign_assets(assets, manifest)) {
        Ok(scenario) => scenario,
        Err(reason) => {
            say_error(&format!("row {}: {reason}", run.index));
            return Exit::BadInput;
        }
    };
    let out = arguments.out.clone().unwrap_or_else(|| folder.path().join(format!("row-{}", run.index)));
    let Some(created) = prepare_told(&out) else { return Exit::BadInput };
    let (written, now, serving, success) = match arguments.run_told(pipeline, &scenario, run.seed, &out) {
        Ok((written, finished)) => {
            let success = finished.report.outcome.success;
            let now = Row::of_outcome(run, finished.report.outcome, finished.report.simulated_s, 0.0);
            (written, now, finished.serving, success)
        }
        Err(Failure::Refused(reason)) => {
            remove_empty(&created);
            say_error(&format!("row {}: {reason}", run.index));
            (Exit::BadInput, Row::without_outcome(run, Status::Refused, reason, 0.0), None, true)
        }
        Err(Failure::Crashed(reason)) => {
            say_error(&format!("row {}: {reason}", run.index));
            (Exit::Crashed, Row::without_outcome(run, Status::Crashed, reason, 0.0), None, true)
        }
    };
    let compared = compare(arguments.quiet, row, &now);
    if let Some(serving) = &serving {
        serve_until_enter(serving);
    }
    if compared == Exit::Success { written.unless_missed(success) } else { compared }
}

/// Says whether a run gave what its row says.
fn compare(quiet: bool, row: Option<&Row>, now: &Row) -> Exit {
    let Some(row) = row else {
        if !quiet {
            say_aside(&format!("row {} was not done before: there is nothing to compare it with", now.index));
        }
        return Exit::Success;
    };
    let Some(difference) = difference(row, now) else {
        if !quiet {
            say_aside(&format!("row {}: the same as before, to the last bit", now.index));
        }
        return Exit::Success;
    };
    say_error(&format!(
        "row {}: found another result than before ({difference}); expected the same from the same program on the same kind \
         of machine",
        now.index
    ));
    Exit::Crashed
}

/// In what two rows of a run differ, if in anything but the clock.
fn difference(before: &Row, now: &Row) -> Option<String> {
    let digest = |row: &Row| row.trajectory_digest.clone().unwrap_or_else(|| "none".into());
    if before == now {
        None
    } else if before.version != now.version {
        Some(format!("it was made by version {}, this is {}", before.version, now.version))
    } else if before.status != now.status {
        Some(format!("it ended as {}, now as {}", before.status.as_str(), now.status.as_str()))
    } else if before.trajectory_digest != now.trajectory_digest {
        Some(format!("the digest of its trajectory was {}, now {}", digest(before), digest(now)))
    } else {
        Some("the trajectories are equal, but not what was measured on them".into())
    }
}
