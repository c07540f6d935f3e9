//! The seam to the recorder: with the feature `recording` a run is recorded, without it asking for that is refused.

use std::path::{Path, PathBuf};

use crate::pipeline::{Onlooker, Report, RunError};
use crate::scenario::ResolvedScenario;

/// A run that was watched.
pub struct Watched {
    /// What it ended in.
    pub result: Result<Report, RunError>,
    /// What the recorder had to say.
    pub warnings: Vec<String>,
    /// The server from which viewers may still ask for the recording.
    pub serving: Option<Serving>,
}

/// Whether this build can record.
pub const AVAILABLE: bool = cfg!(feature = "recording");

/// Where a recording goes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Destination {
    /// A file.
    pub file: Option<PathBuf>,
    /// A running viewer.
    pub connect: Option<String>,
    /// A port on which viewers may ask for it.
    pub serve: Option<u16>,
    /// Whether a viewer is started.
    pub view: bool,
    /// Whether the telemetry is kept beside the outcome.
    pub telemetry: bool,
}

impl Destination {
    /// Whether a recorder is wanted.
    fn records(&self) -> bool {
        self.file.is_some() || self.connect.is_some() || self.serve.is_some() || self.view
    }
}

/// A server that viewers may come to after the run, for as long as this lives.
pub struct Serving {
    #[cfg(feature = "recording")]
    served: crate::recording::Served,
}

impl Serving {
    /// The address that a viewer opens.
    #[cfg(feature = "recording")]
    pub fn url(&self) -> String {
        self.served.url()
    }

    /// The address that a viewer opens.
    #[cfg(not(feature = "recording"))]
    pub fn url(&self) -> String {
        String::new()
    }
}

/// Runs under a recorder, if anything is to be recorded.
///
/// The error says why the recorder could not start.
#[cfg(feature = "recording")]
pub fn watch(
    destination: &Destination,
    scenario: &ResolvedScenario,
    seed: u64,
    run: impl FnOnce(&mut dyn Onlooker) -> Result<Report, RunError>,
) -> Result<Watched, String> {
    use crate::recording::{Recorder, RecorderOptions};
    if !destination.records() {
        return Ok(Watched { result: run(&mut ()), warnings: Vec::new(), serving: None });
    }
    let Destination { file, connect, serve, view, .. } = destination.clone();
    let options = RecorderOptions { file, connect, serve, view };
    let mut recorder = Recorder::start(&options, scenario, seed).map_err(|error| error.to_string())?;
    let result = run(&mut recorder);
    let serving = recorder.served().map(|served| Serving { served });
    let summary = match &result {
        Ok(report) => recorder.finish(&report.outcome),
        Err(error) => recorder.abandon(&error.to_string()),
    };
    Ok(Watched { result, warnings: summary.warnings, serving })
}

/// Runs without a recorder.
#[cfg(not(feature = "recording"))]
pub fn watch(
    _: &Destination,
    _: &ResolvedScenario,
    _: u64,
    run: impl FnOnce(&mut dyn Onlooker) -> Result<Report, RunError>,
) -> Result<Watched, String> {
    Ok(Watched { result: run(&mut ()), warnings: Vec::new(), serving: None })
}

/// A run that is to be recorded beside others.
pub struct RunToRecord {
    /// What it is called.
    pub name: String,
    /// Its scenario.
    pub scenario: ResolvedScenario,
}

/// Makes runs one after the other with the same seed, and records them side by side.
///
/// Returns what the recorder had to say. The error says why it could not start.
#[cfg(feature = "recording")]
pub fn record_side_by_side(file: &Path, name: &str, seed: u64, runs: &[RunToRecord]) -> Result<Vec<String>, String> {
    let mut together = crate::recording::SideBySide::start(file, name, seed).map_err(|error| error.to_string())?;
    for run in runs {
        let mut recorder = together.recorder(&run.name, &run.scenario).map_err(|error| error.to_string())?;
        let made = super::panics::catch(|| crate::pipeline::run(&run.scenario, seed, &mut recorder, &|_, _| {}));
        let reason = |error: RunError| error.to_string();
        let result = made.and_then(|result| result.map_err(reason)).map(|report| report.outcome);
        together.ended(&run.name, recorder, result.as_ref().map_err(String::as_str));
    }
    Ok(together.finish().warnings)
}

/// Records nothing.
#[cfg(not(feature = "recording"))]
pub fn record_side_by_side(_: &Path, _: &str, _: u64, _: &[RunToRecord]) -> Result<Vec<String>, String> {
    Err("this wield was built without its recorder".into())
}
