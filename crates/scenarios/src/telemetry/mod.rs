//! Telemetry: a run as a table with one row per control period, Apache Parquet, for pandas, Polars, DuckDB and the like.
//!
//! What is a number at every instant is in it: joints, tool, its reference, the object, the task's own curves. Bodies that
//! come apart and grains are in the recording only.

mod plane;
mod space;
mod table;

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use sim::planar::{self, Event};
use sim::spatial;

use crate::pipeline::Onlooker;
use crate::scenario::ResolvedScenario;
use table::{Column, Table};

/// Version of the layout; it grows when a column changes its meaning or goes away.
const TELEMETRY_SCHEMA: &str = "wield.telemetry/1";

/// Writes the telemetry of one run.
pub struct Telemetry {
    path: PathBuf,
    about: Vec<(&'static str, String)>,
    table: Option<Table<File>>,
    row: Vec<f64>,
    failure: Option<io::Error>,
}

impl Telemetry {
    /// Prepares the telemetry of a run of `scenario` under `seed`; the file is made with its first row.
    #[must_use]
    pub fn new(path: &Path, scenario: &ResolvedScenario, seed: u64) -> Self {
        let about = vec![
            ("wield.schema", TELEMETRY_SCHEMA.to_owned()),
            ("wield.scenario", scenario.name.clone()),
            ("wield.seed", seed.to_string()),
            ("wield.version", env!("CARGO_PKG_VERSION").to_owned()),
        ];
        Self { path: path.to_owned(), about, table: None, row: Vec::new(), failure: None }
    }

    /// Writes what is left. A run of which nothing was simulated leaves no file.
    ///
    /// # Errors
    /// The first thing that kept the file from being written.
    pub fn finish(mut self) -> io::Result<()> {
        match (self.failure.take(), self.table.take()) {
            (Some(failure), _) => Err(failure),
            (None, Some(table)) => table.finish(),
            (None, None) => Ok(()),
        }
    }

    fn begin(&mut self, columns: &[Column], phases: &[String]) {
        let made = File::create(&self.path).and_then(|file| Table::new(file, columns, phases, &self.about));
        match made {
            Ok(table) => self.table = Some(table),
            Err(error) => self.failure = Some(error),
        }
    }

    /// Adds the row that `fill` writes; after a failure nothing more is tried.
    fn push(&mut self, phase: usize, fill: impl FnOnce(&mut Vec<f64>)) {
        let Some(table) = self.table.as_mut().filter(|_| self.failure.is_none()) else { return };
        self.row.clear();
        fill(&mut self.row);
        if let Err(error) = table.push(phase, &self.row) {
            self.failure = Some(error);
        }
    }
}

impl planar::Observer for Telemetry {
    fn begin(&mut self, scene: &planar::SceneDescription) {
        self.begin(&plane::columns(scene), &scene.phases);
    }

    fn sample(&mut self, sample: &planar::Sample<'_>) {
        self.push(sample.phase, |row| plane::fill(row, sample));
    }
}

impl spatial::Observer for Telemetry {
    fn begin(&mut self, scene: &spatial::SceneDescription) {
        self.begin(&space::columns(scene), &scene.phases);
    }

    fn sample(&mut self, sample: &spatial::Sample<'_>) {
        self.push(sample.phase, |row| space::fill(row, sample));
    }
}

/// Two onlookers of one run.
pub struct Both<'a>(pub &'a mut dyn Onlooker, pub &'a mut Telemetry);

impl planar::Observer for Both<'_> {
    fn begin(&mut self, scene: &planar::SceneDescription) {
        planar::Observer::begin(self.0, scene);
        planar::Observer::begin(self.1, scene);
    }

    fn sample(&mut self, sample: &planar::Sample<'_>) {
        planar::Observer::sample(self.0, sample);
        planar::Observer::sample(self.1, sample);
    }

    fn event(&mut self, event: &Event) {
        planar::Observer::event(self.0, event);
    }
}

impl spatial::Observer for Both<'_> {
    fn begin(&mut self, scene: &spatial::SceneDescription) {
        spatial::Observer::begin(self.0, scene);
        spatial::Observer::begin(self.1, scene);
    }

    fn sample(&mut self, sample: &spatial::Sample<'_>) {
        spatial::Observer::sample(self.0, sample);
        spatial::Observer::sample(self.1, sample);
    }

    fn bodies(&mut self, time_s: f64, bodies: &[spatial::BodyDrawing]) {
        spatial::Observer::bodies(self.0, time_s, bodies);
    }

    fn event(&mut self, event: &Event) {
        spatial::Observer::event(self.0, event);
    }
}
