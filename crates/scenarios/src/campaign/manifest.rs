//! The manifest of a campaign: every run that is to be made, written before the first begins.
//!
//! A file of lines of JSON: the first holds what all runs share, each further one a run.

use std::io::{self, BufRead, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::RunId;
use crate::scenario::Change;

/// Version of the layout of manifests and journals.
pub const CAMPAIGN_SCHEMA: &str = "wield.campaign/1";

/// What all runs of a campaign share.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Base {
    /// Version of this layout: [`CAMPAIGN_SCHEMA`].
    pub schema: String,
    /// Version of the program that planned it.
    pub version: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Kind of its task.
    pub task: String,
    /// The scenario file, as the user named it.
    pub file: PathBuf,
    /// The folder in which its assets were found.
    pub assets: PathBuf,
    /// Its text.
    pub text: String,
    /// What differs between the runs besides the seed.
    pub factors: Vec<Factor>,
    /// Number of runs.
    pub runs: u64,
}

/// A key of the scenario that is given other values.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Factor {
    /// The key, as in [`Change::key`]; its ending tells the unit.
    pub key: String,
}

/// A run that is to be made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedRun {
    /// Place in the manifest, from 0.
    pub index: u64,
    /// Identity.
    pub run_id: RunId,
    /// Seed.
    pub seed: u64,
    /// The value of each factor, in their order.
    pub values: Vec<toml::Value>,
    /// Why these values make no valid scenario, one sentence per problem; empty, and then not written, if they make one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub invalid: Vec<String>,
}

/// Everything that a campaign runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Manifest {
    /// What all runs share.
    pub base: Base,
    /// The runs, by index.
    pub runs: Vec<PlannedRun>,
}

/// Why a manifest cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ManifestError {
    /// The file system refused.
    #[error("cannot read {}: {source}", file.display())]
    Unreadable {
        /// The file.
        file: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A line is not what it should be.
    #[error("{}:{line}: {reason}; make the manifest anew with `wield plan`", file.display())]
    Malformed {
        /// The file.
        file: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
}

/// Which runs of a campaign one process makes: those whose index is `index` modulo `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 0.
    pub index: u64,
    /// At least 1.
    pub count: u64,
}

impl Shard {
    /// All runs.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Whether the run at `index` belongs to it.
    #[must_use]
    pub fn holds(self, index: u64) -> bool {
        index % self.count == self.index
    }
}

impl FromStr for Shard {
    type Err = String;

    /// Reads `i/n`, with `i` from 0 to `n` − 1.
    ///
    /// # Errors
    /// In words.
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        match numbers {
            Some((index, count)) if index < count => Ok(Self { index, count }),
            _ => Err(format!("found {text:?}; expected i/n with i from 0 to n - 1, such as 0/4, or auto")),
        }
    }
}

impl Manifest {
    /// The changes that make the scenario of a run.
    #[must_use]
    pub fn changes(&self, run: &PlannedRun) -> Vec<Change> {
        let pairs = self.base.factors.iter().zip(&run.values);
        pairs.map(|(factor, value)| Change { key: factor.key.clone(), value: value.clone() }).collect()
    }

    /// Writes it, a line for each run.
    ///
    /// # Errors
    /// Of `to`, or if a value cannot be written.
    pub fn write(&self, mut to: impl Write) -> io::Result<()> {
        serde_json::to_writer(&mut to, &self.base)?;
        to.write_all(b"\n")?;
        for run in &self.runs {
            serde_json::to_writer(&mut to, run)?;
            to.write_all(b"\n")?;
        }
        Ok(())
    }

    /// Reads a manifest.
    ///
    /// # Errors
    /// A [`ManifestError`]; a manifest that was cut off is refused.
    pub fn read(file: &Path) -> Result<Self, ManifestError> {
        let unreadable = |source| ManifestError::Unreadable { file: file.to_owned(), source };
        let malformed = |line, reason: String| ManifestError::Malformed { file: file.to_owned(), line, reason };
        let mut lines = io::BufReader::new(std::fs::File::open(file).map_err(unreadable)?).lines();
        let head = lines.next().ok_or_else(|| malformed(1, "the file is empty".into()))?.map_err(unreadable)?;
        let base: Base = serde_json::from_str(&head).map_err(|error| malformed(1, error.to_string()))?;
        if base.schema != CAMPAIGN_SCHEMA {
            return Err(malformed(1, format!("found schema {:?}; expected {CAMPAIGN_SCHEMA:?}", base.schema)));
        }
        let mut runs = Vec::new();
        for (line, text) in lines.enumerate() {
            let text = text.map_err(unreadable)?;
            let run: PlannedRun =
                serde_json::from_str(&text).map_err(|error| malformed(line + 2, error.to_string()))?;
            if run.index != runs.len() as u64 || run.values.len() != base.factors.len() {
                return Err(malformed(line + 2, "the run does not fit the others".into()));
            }
            runs.push(run);
        }
        if runs.len() as u64 != base.runs {
            return Err(malformed(runs.len() + 1, format!("found {} runs; expected {}", runs.len(), base.runs)));
        }
        Ok(Self { base, runs })
    }
}
