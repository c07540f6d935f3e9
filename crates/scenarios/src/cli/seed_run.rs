//! One seed of a scenario: run it, keep its files in one folder.

use std::io;
use std::path::Path;

use super::observe::{self, Destination, Serving, Watched};
use super::panics;
use super::seed_folder::{OUTCOME, SCENARIO, SeedFolder, TELEMETRY};
use crate::files::write_whole;
use crate::pipeline::{Onlooker, Progress, Report, RunError};
use crate::report::json;
use crate::scenario::ResolvedScenario;
use crate::telemetry::{Both, Telemetry};

/// The pipeline, or what stands in for it in tests.
pub type Pipeline = fn(&ResolvedScenario, u64, &mut dyn Onlooker, Progress<'_>) -> Result<Report, RunError>;

pub use super::seed_folder::RECORDING;

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
    /// The scenario is at fault, or the folder is in use; nothing was written.
    Refused(String),
    /// The run crashed or diverged, or its files could not be written.
    Crashed(String),
}

impl From<String> for Failure {
    fn from(reason: String) -> Self {
        Self::Crashed(reason)
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        if error.is_input { Self::Refused(error.to_string()) } else { Self::Crashed(error.to_string()) }
    }
}

/// Runs one seed and writes its files into `folder`, in the place of an earlier run's; a refused run leaves those as they are.
///
/// A recording in the folder goes there with the rest: `destination` names the folder as it is in the end.
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
    let run = SeedFolder::begin(folder).map_err(|error| match error.kind() {
        io::ErrorKind::ResourceBusy => Failure::Refused(unwritable(error)),
        _ => Failure::Crashed(unwritable(error)),
    })?;
    let text = resolved_text(scenario, seed)?;
    write_whole(&run.partial().join(SCENARIO), text.as_bytes()).map_err(unwritable)?;
    let meanwhile = Destination {
        file: destination.file.as_ref().map(|file| match file.strip_prefix(folder) {
            Ok(inside) => run.partial().join(inside),
            Err(_) => file.clone(),
        }),
        ..destination.clone()
    };
    let mut unkept = None;
    let watched = panics::catch(|| {
        observe::watch(&meanwhile, scenario, seed, |observer| {
            if !destination.telemetry {
                return pipeline(scenario, seed, observer, progress);
            }
            let mut telemetry = Telemetry::new(&run.partial().join(TELEMETRY), scenario, seed);
            let result = pipeline(scenario, seed, &mut Both(observer, &mut telemetry), progress);
            unkept = telemetry.finish().err();
            result
        })
    });
    if let Some(error) = unkept {
        return Err(Failure::Crashed(format!("write {}: {error}", folder.join(TELEMETRY).display())));
    }
    let (result, mut warnings, serving) = match watched {
        Ok(Ok(Watched { result, warnings, serving })) => (result.map_err(Failure::from), warnings, serving),
        Ok(Err(reason)) => (Err(Failure::Refused(reason)), Vec::new(), None),
        Err(reason) => (Err(Failure::Crashed(reason)), Vec::new(), None),
    };
    warnings.iter_mut().for_each(|warning| *warning = run.renamed(warning));
    let outcome = match &result {
        Ok(report) => Some(json(&report.outcome).map_err(|error| format!("write {OUTCOME}: {error}"))?),
        Err(Failure::Refused(reason)) => {
            let reason = run.renamed(reason);
            run.forget();
            return Err(Failure::Refused(reason));
        }
        Err(Failure::Crashed(_)) => None,
    };
    if let Some(outcome) = outcome {
        write_whole(&run.partial().join(OUTCOME), outcome.as_bytes()).map_err(unwritable)?;
    }
    run.finish().map_err(unwritable)?;
    Ok(Finished { report: result?, warnings, serving })
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
