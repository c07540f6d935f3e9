//! The seam to the recorder: with the feature `recording` a run is recorded, without it asking for that is refused.

use std::path::PathBuf;

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
    if *destination == Destination::default() {
        return Ok(Watched { result: run(&mut ()), warnings: Vec::new(), serving: None });
    }
    let Destination { file, connect, serve, view } = destination.clone();
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
