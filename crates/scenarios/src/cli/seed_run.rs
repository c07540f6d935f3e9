//! One seed of a scenario: run it, keep its files in one folder.

use std::io;
use std::path::Path;

use super::observe::{self, Destination, Serving, Watched};
use super::panics;
use crate::files::{remove_if_present, write_whole};
use crate::pipeline::{Onlooker, Progress, Report, RunError};
use crate::report::json;
use crate::scenario::ResolvedScenario;

/// The pipeline, or what stands in for it in tests.
pub type Pipeline = fn(&ResolvedScenario, u64, &mut dyn Onlooker, Progress<'_>) -> Result<Report, RunError>;

/// Name of the result's file in a seed's folder.
const OUTCOME: &str = "outcome.json";
/// Name of the scenario with all defaults written out, in a seed's folder.
const SCENARIO: &str = "scenario.toml";
/// Name of the recording in a seed's folder.
pub const RECORDING: &str = "recording.rrd";

/// A run that came to an outcome.
pub struct Finished {
    /// Its report.
    pub report: Report,
    /// What the recorder had to say.
    pub warnings: Vec<String>,
    /// The server from which viewers may still ask for the recording.
    pub serving: Option<Serving>,
}

/// Why a run came to no outcome.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The scenario is at fault; nothing was left on disk.
    Refused(String),
    /// The run crashed or diverged, or its files could not be written.
    Crashed(String),
}

impl From<String> for Failure {
    fn from(reason: String) -> Self {
        Self::Crashed(reason)
    }
}

/// Runs one seed and writes its files into `folder`; an earlier run's files there are removed first.
///
/// # Errors
/// Why the run was refused, crashed or diverged, or its files could not be written.
pub fn run_seed(
    pipeline: Pipeline,
    scenario: &ResolvedScenario,
    seed: u64,
    folder: &Path,
    destination: &Destination,
    progress: Progress<'_>,
) -> Result<Finished, Failure> {
    let unwritable = |error: io::Error| format!("write {}: {error}", folder.display());
    start_fresh(folder).map_err(unwritable)?;
    write_whole(&folder.join(SCENARIO), resolved_text(scenario, seed)?.as_bytes()).map_err(unwritable)?;
    let watched = panics::catch(|| {
        observe::watch(destination, scenario, seed, |observer| pipeline(scenario, seed, observer, progress))
    })?;
    let refused = |reason| {
        forget(folder);
        Failure::Refused(reason)
    };
    let Watched { result, warnings, serving } = watched.map_err(refused)?;
    let report = match result {
        Ok(report) => report,
        Err(error) if error.is_input => return Err(refused(error.to_string())),
        Err(error) => return Err(Failure::Crashed(error.to_string())),
    };
    let outcome = json(&report.outcome).map_err(|error| format!("write {OUTCOME}: {error}"))?;
    write_whole(&folder.join(OUTCOME), outcome.as_bytes()).map_err(unwritable)?;
    Ok(Finished { report, warnings, serving })
}

/// The scenario with every default written out and the seed of the run: a file that gives the same run again.
pub fn resolved_text(scenario: &ResolvedScenario, seed: u64) -> Result<String, String> {
    let body = scenario.text(seed).map_err(|error| format!("write {SCENARIO}: {error}"))?;
    let head = format!(
        "# {} as it was run by wield {}, all defaults written out.\n",
        scenario.name,
        env!("CARGO_PKG_VERSION")
    );
    Ok(head + &body)
}

/// Removes what a refused run has left; what cannot be removed stays.
fn forget(folder: &Path) {
    let _ = start_fresh(folder);
    let _ = std::fs::remove_dir(folder);
}

/// A seed's folder holds one run: files of an earlier one would tell of something else.
fn start_fresh(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    [OUTCOME, SCENARIO, RECORDING].iter().try_for_each(|name| remove_if_present(&folder.join(name)))
}
