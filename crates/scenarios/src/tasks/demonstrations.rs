//! What a synthetic human showed: the trials, with the truth that recordings do not hold.

use serde::{Deserialize, Serialize};

/// More demonstrations than this say nothing new and take hours.
pub(crate) const MOST_DEMONSTRATIONS: usize = 1000;

/// Version of the layout of `demonstrations.json`.
pub const DEMONSTRATIONS_SCHEMA: &str = "wield.demonstrations/1";

/// All trials of a synthetic human, as written to `demonstrations.json`. Holds no clock time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DemonstrationsReport {
    /// Version of this layout: [`DEMONSTRATIONS_SCHEMA`].
    pub schema: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of the human's and the recorders' random numbers.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// Number of trials that succeeded.
    pub successes: usize,
    /// Why there are fewer successes than wanted; `null` if there are enough.
    pub shortage: Option<String>,
    /// The trials, in their order.
    pub trials: Vec<DemonstrationTrial>,
}

/// One trial of a synthetic human.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DemonstrationTrial {
    /// Number of the trial, from 1.
    pub trial: usize,
    /// File that holds what the recorders saw, beside this one.
    pub file: String,
    /// Whether the human was satisfied.
    pub success: bool,
    /// Why not; `null` on success.
    pub failure: Option<String>,
    /// True distance of the object from where it was wanted, mm; of a cut, that of the edge from the board at its deepest; of a pour,
    /// the level one of the lip from the middle of the mouth at the greatest tilt.
    pub goal_error_mm: f64,
    /// Recorded time, s.
    pub duration_s: f64,
    /// Times that the human let go and took hold again within a push.
    pub renewed_holds: usize,
    /// First and last moment of each touch between tool and object, or of the edge in the food, s: the truth, which the recording does not hold.
    pub touches_s: Vec<(f64, f64)>,
}

/// One trial with the text of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownTrial {
    /// What is known about it.
    pub trial: DemonstrationTrial,
    /// What the recorders saw, as CSV.
    pub csv: String,
}

impl DemonstrationsReport {
    /// Sums up trials.
    #[must_use]
    pub fn new(scenario: &str, seed: u64, trials: Vec<DemonstrationTrial>, shortage: Option<String>) -> Self {
        Self {
            schema: DEMONSTRATIONS_SCHEMA.into(),
            scenario: scenario.into(),
            seed,
            version: env!("CARGO_PKG_VERSION").into(),
            successes: trials.iter().filter(|trial| trial.success).count(),
            shortage,
            trials,
        }
    }
}
