//! Section of a cutting scenario that says where the demonstration of one cut comes from.

use serde::{Deserialize, Serialize};
use skills::cutting::CutHuman;
use skills::field::{FieldError, finite, within};

/// Where the demonstration of one cut comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum DemonstrationsConfig {
    /// A synthetic human shows one cut.
    Synthetic(SyntheticConfig),
    /// A recorded cut.
    Recorded(RecordedConfig),
    /// None: the skill was learned before, by `wield learn`.
    Learned {
        /// Name of a file in `assets/skills`, without its ending.
        asset: String,
    },
}

/// One cut of a synthetic human, on the scenario's board.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SyntheticConfig {
    /// Food that the human cuts: a file in `assets/foods`; the scenario's food if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-asset" = "foods"))]
    pub food: Option<String>,
    /// Knife that the human holds: a file in `assets/knives`; the scenario's knife if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-asset" = "knives"))]
    pub knife: Option<String>,
    /// Place of the cut, as a share of the food's length.
    #[schemars(range(min = SHOWN_SHARES[0], max = SHOWN_SHARES[1]))]
    pub at_share: f64,
    /// The human.
    pub human: CutHuman,
}

/// A recorded cut, and where and with what it was shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordedConfig {
    /// Name of a file in `assets/demonstrations`, without its ending: poses of the middle of the edge.
    #[schemars(extend("x-asset" = "demonstrations"))]
    pub asset: String,
    /// Food that was cut: a file in `assets/foods`; the scenario's food if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-asset" = "foods"))]
    pub food: Option<String>,
    /// Knife that was held: a file in `assets/knives`; the scenario's knife if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-asset" = "knives"))]
    pub knife: Option<String>,
    /// Where the origin of the food's frame was on the board, x and y, m.
    pub food_at_m: [f64; 2],
    /// Turn of the food about the vertical, rad.
    pub food_angle_rad: f64,
    /// Height of the board's upper side, m.
    pub board_top_m: f64,
    /// Place of the cut, as a share of the food's length.
    #[serde(default = "middle")]
    #[schemars(range(min = SHOWN_SHARES[0], max = SHOWN_SHARES[1]))]
    pub at_share: f64,
}

/// The middle of a food.
fn middle() -> f64 {
    0.5
}

impl Default for SyntheticConfig {
    fn default() -> Self {
        Self { food: None, knife: None, at_share: middle(), human: CutHuman::default() }
    }
}

impl DemonstrationsConfig {
    /// Names of the food and the knife that were shown, if they are not the scenario's: keys and values.
    pub(super) fn names(&self) -> [(&'static str, Option<&str>); 2] {
        match self {
            Self::Synthetic(synthetic) => [
                ("demonstrations.synthetic.food", synthetic.food.as_deref()),
                ("demonstrations.synthetic.knife", synthetic.knife.as_deref()),
            ],
            Self::Recorded(recorded) => [
                ("demonstrations.recorded.food", recorded.food.as_deref()),
                ("demonstrations.recorded.knife", recorded.knife.as_deref()),
            ],
            Self::Learned { .. } => [("demonstrations.learned.asset", None); 2],
        }
    }

    /// Checks the values.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending one.
    pub(super) fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Synthetic(synthetic) => synthetic.validate().map_err(|error| error.within("synthetic")),
            Self::Recorded(recorded) => recorded.validate().map_err(|error| error.within("recorded")),
            Self::Learned { .. } => Ok(()),
        }
    }
}

/// A cut nearer to an end than this shows the cut of a rounding, as a share of the length.
const SHOWN_SHARES: [f64; 2] = [0.05, 0.95];

impl SyntheticConfig {
    fn validate(&self) -> Result<(), FieldError> {
        within("at_share", self.at_share, SHOWN_SHARES[0], SHOWN_SHARES[1])?;
        self.human.validate().map_err(|error| error.within("human"))
    }
}

impl RecordedConfig {
    fn validate(&self) -> Result<(), FieldError> {
        finite("food_at_m", &self.food_at_m)?;
        finite("food_angle_rad", &[self.food_angle_rad])?;
        finite("board_top_m", &[self.board_top_m])?;
        within("at_share", self.at_share, SHOWN_SHARES[0], SHOWN_SHARES[1])
    }
}
