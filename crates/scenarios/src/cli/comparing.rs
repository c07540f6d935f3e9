//! Carries out a comparison whose runs are planned: makes them, compares, reports.

use std::sync::atomic::AtomicBool;

use super::observe::{self, RunToRecord};
use super::progress::TrialsProgress;
use super::seed_run::RECORDING;
use super::{Exit, interrupt, keep_json, panics, say, say_aside, say_error, say_json, unwritable};
use crate::assets::Assets;
use crate::campaign::{
    CampaignFolder, Execution, FolderError, Manifest, ManifestError, Row, Shard, TableFormat, execute as carry_out,
    load_run, write_tables,
};
use crate::comparison::{Comparison, check_measures, compare, page, text};
use crate::files::{prepare_folder, write_whole};
use crate::scenario::ResolvedScenario;
use crate::trials::Status;

/// Which seed of the variants is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordedSeed {
    /// None.
    None,
    /// The first under which every variant moved.
    First,
    /// This one.
    This(u64),
}

/// A comparison whose runs are planned.
pub struct Comparing<'a> {
    /// One line on what is compared.
    pub title: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Where assets are found.
    pub assets: &'a Assets,
    /// The variants one after the other, each with the same seeds.
    pub manifest: Manifest,
    /// Names of the variants.
    pub names: Vec<String>,
    /// Where it is kept.
    pub folder: CampaignFolder,
    /// Measures that are compared though they are not judged.
    pub measures: Vec<String>,
    /// Number of threads; one per core if absent.
    pub threads: Option<u16>,
    /// What is recorded.
    pub record: RecordedSeed,
    /// Whether the result is printed as JSON.
    pub json: bool,
    /// Whether nothing but errors is printed.
    pub quiet: bool,
}

impl Comparing<'_> {
    /// Makes the runs that are not done yet, compares, reports.
    pub fn run(&self) -> Result<Exit, Exit> {
        if !self.folder.exists() {
            // a folder that cannot be written to is bad input, not a crash after the fact
            prepare_folder(self.folder.path())
                .map_err(|error| refuse(unwritable(self.folder.path(), &error, "--out")))?;
        }
        self.folder.prepare(&self.manifest).map_err(told)?;
        let stop = interrupt::watch();
        if !self.measures.is_empty() {
            self.check_measures(&stop)?;
        }
        self.make(Shard::WHOLE, &stop)?;
        write_tables(&self.folder, &self.manifest, &[TableFormat::Parquet]).map_err(told)?;
        let rows = self.folder.ordered_rows(&self.manifest).map_err(told)?;
        let compared = compare(&self.manifest, &self.title, &rows, &self.names, &self.measures);
        let comparison = compared.map_err(|unknown| refuse(unknown.to_string()))?;
        let recording = self.record(&rows);
        let kept = self.keep(&comparison, recording.as_deref());
        let said = self.say(&comparison, recording.as_deref());
        let crashed = rows.iter().any(|row| row.status == Status::Crashed);
        Ok(match (kept, said) {
            (Exit::Success, Exit::Success) if crashed => Exit::Crashed,
            (Exit::Success, said) => said,
            (kept, _) => kept,
        })
    }

    /// Makes the first run of each variant, and refuses measures that runs do not have before all others are made.
    fn check_measures(&self, stop: &AtomicBool) -> Result<(), Exit> {
        let per_variant = self.manifest.runs.len() / self.names.len().max(1);
        let firsts = Shard { index: 0, count: per_variant.max(1) as u64 };
        self.make(firsts, stop)?;
        let rows = self.folder.ordered_rows(&self.manifest).map_err(told)?;
        let first: Vec<&Row> = rows.iter().filter(|row| firsts.holds(row.index)).collect();
        check_measures(&first, &self.measures).map_err(|unknown| {
            let kept = self.folder.path().display();
            refuse(format!(
                "{unknown}; the runs made so far are kept in {kept}, and the same command goes on with them"
            ))
        })
    }

    /// Makes the runs of a shard that are not done yet.
    fn make(&self, shard: Shard, stop: &AtomicBool) -> Result<(), Exit> {
        let threads = self.threads.map_or_else(available_threads, usize::from);
        let done = self.folder.done(&self.manifest).map_err(told)?;
        let open = (0..).zip(&done).filter(|(index, done)| shard.holds(*index) && !**done).count();
        let progress = TrialsProgress::new(open, self.quiet);
        let run = |scenario: &ResolvedScenario, seed: u64| {
            panics::catch(|| crate::pipeline::run(scenario, seed, &mut (), &|_, _| {}))
        };
        let execution =
            Execution { run: &run, assets: self.assets, shard, threads, stop, each: &|_| progress.one_done() };
        let summary = carry_out(&self.folder, &self.manifest, &execution);
        progress.finish();
        let left = summary.map_err(told)?.left;
        if left > 0 {
            say_aside(&format!("stopped: {left} runs are left; the same command goes on with them"));
            return Err(Exit::Interrupted);
        }
        Ok(())
    }

    /// Records one seed of every variant; returns the file's name.
    fn record(&self, rows: &[Row]) -> Option<String> {
        let seed = match self.record {
            RecordedSeed::None => return None,
            RecordedSeed::This(seed) => Some(seed),
            RecordedSeed::First => None,
        };
        if !observe::AVAILABLE {
            return None;
        }
        let file = self.folder.path().join(RECORDING);
        let per_variant = self.manifest.runs.len() / self.names.len().max(1);
        let mut runs = Vec::new();
        for (name, planned) in self.names.iter().zip(self.manifest.runs.chunks(per_variant.max(1))) {
            let Some(run) = planned.first() else { continue };
            match load_run(&self.manifest, run, self.assets) {
                Ok(scenario) => runs.push(RunToRecord { name: name.clone(), scenario }),
                Err(reason) => say_aside(&format!("warning: {name} is not recorded: {reason}")),
            }
        }
        let seed = seed.or_else(|| worth_seeing(rows, per_variant)).unwrap_or_default();
        let name = format!("compare-{}", self.scenario);
        match observe::record_side_by_side(&file, &name, seed, &runs) {
            Ok(warnings) => {
                warnings.iter().for_each(|warning| say_aside(&format!("warning: {warning}")));
                Some(RECORDING.to_owned())
            }
            Err(reason) => {
                say_aside(&format!("warning: {reason}"));
                None
            }
        }
    }

    fn keep(&self, comparison: &Comparison, recording: Option<&str>) -> Exit {
        let kept = keep_json(&self.folder.path().join("comparison.json"), comparison);
        let report = self.folder.path().join("report.html");
        match write_whole(&report, page(comparison, recording).as_bytes()) {
            Ok(()) => kept,
            Err(error) => {
                say_error(&format!("write {}: {error}", report.display()));
                Exit::Crashed
            }
        }
    }

    fn say(&self, comparison: &Comparison, recording: Option<&str>) -> Exit {
        if self.json {
            return say_json(comparison);
        }
        if self.quiet {
            return Exit::Success;
        }
        let at = |name: &str| self.folder.path().join(name).display().to_string();
        let recording = recording.map_or_else(String::new, |name| format!("recording: {}\n", at(name)));
        say(&format!("{}report: {}\n{recording}", text(comparison), at("report.html")))
    }
}

/// The first seed under which every variant moved; else the first.
fn worth_seeing(rows: &[Row], per_variant: usize) -> Option<u64> {
    let moved =
        |place: usize| rows.iter().skip(place).step_by(per_variant.max(1)).all(|row| row.trajectory_digest.is_some());
    let place = (0..per_variant).find(|place| moved(*place)).unwrap_or(0);
    rows.get(place).map(|row| row.seed)
}

fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Says why nothing was run.
pub(super) fn refuse(reason: String) -> Exit {
    say_error(&reason);
    Exit::BadInput
}

/// Says what is wrong with the folder of results.
fn told(error: FolderError) -> Exit {
    let bad_input = matches!(
        error,
        FolderError::Other { .. }
            | FolderError::Stranger { .. }
            | FolderError::Manifest(ManifestError::Malformed { .. })
    );
    say_error(&error.to_string());
    if bad_input { Exit::BadInput } else { Exit::Crashed }
}
