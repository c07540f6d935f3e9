//! The tables of a pouring scenario: grains, containers, the task and its limits.

use serde::{Deserialize, Serialize};
use sim::pouring::{FillAmount, GrainConfig, Grip};
use skills::field::{FieldError, finite, positive, within};
use skills::pouring::{AmountOptions, PourHuman, PourOptions};

/// Longest time in which grains come to rest, s.
const LONGEST_SETTLE_S: f64 = 60.0;

/// What is poured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrainsConfig {
    /// How much of it.
    pub fill: FillAmount,
    /// One grain.
    #[serde(default)]
    pub bean: GrainConfig,
    /// Angle at which the surface of the fill is stable, rad: the planner reckons the onset of the flow with it.
    #[serde(default = "default_stability_rad")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub stability_rad: f64,
}

/// A heap of the default grain stands at 24.5 degrees, and in a cup ten grains wide a little steeper.
fn default_stability_rad() -> f64 {
    0.5
}

/// What is poured from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SourceConfig {
    /// Name of a file in `assets/containers`, without its ending.
    #[schemars(extend("x-asset" = "containers"))]
    pub asset: String,
    /// How the hand holds it.
    #[serde(default)]
    pub grip: Grip,
}

/// What is poured into.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TargetConfig {
    /// Name of a file in `assets/containers`, without its ending.
    #[schemars(extend("x-asset" = "containers"))]
    pub asset: String,
    /// Where it stands on the table, world frame, m.
    pub place_m: [f64; 2],
}

/// Which skill plans the pour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PourSkillKind {
    /// The constrained skill: separated from what it was shown with, certified to keep clear.
    #[default]
    Constrained,
    /// The plain movement primitive of the whole demonstration, moved to the mouth.
    PlainDmp,
}

/// Pour grains from the held cup into a container.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PourConfig {
    /// Where the cup is held upright at first: the middle of its underside, world frame, m.
    pub start_m: [f64; 3],
    /// Direction of its lip there, about the vertical, rad; toward the target if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_angle_rad: Option<f64>,
    /// Which skill plans.
    #[serde(default)]
    pub skill: PourSkillKind,
    /// Whether the controller is told the weight of what is in the cup.
    #[serde(default)]
    pub feed_forward: bool,
    /// How much is to be poured; all of it if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amount: Option<AmountConfig>,
    /// How it is poured.
    #[serde(default)]
    pub options: PourOptions,
    /// Time after the plan's end in which grains come to rest, s.
    #[serde(default = "default_settle_s")]
    #[schemars(range(min = 0.0, max = LONGEST_SETTLE_S))]
    pub settle_s: f64,
}

fn default_settle_s() -> f64 {
    1.0
}

/// How much is to be poured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AmountConfig {
    /// Mass wanted in the target, kg; a scale under it tells what has landed.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub wanted_kg: f64,
    /// How it is approached.
    #[serde(default)]
    pub approach: AmountOptions,
}

/// Where the skill comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PourDemonstrations {
    /// A synthetic human pours once.
    Synthetic(SyntheticPour),
    /// A recorded pour.
    Recorded(RecordedPour),
    /// None: the skill was learned before, by `wield learn`.
    Learned {
        /// Name of a file in `assets/skills`, without its ending.
        asset: String,
    },
}

/// A pour that a synthetic human shows, elsewhere and into something else.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SyntheticPour {
    /// The cup, a file in `assets/containers`; that of the scenario if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-asset" = "containers"))]
    pub source: Option<String>,
    /// What is poured into, a file in `assets/containers`.
    #[schemars(extend("x-asset" = "containers"))]
    pub target: String,
    /// Where it stands on the table, m.
    pub place_m: [f64; 2],
    /// Where the cup stands at first, m.
    pub start_m: [f64; 3],
    /// The human.
    #[serde(default)]
    pub human: PourHuman,
}

/// A recorded pour, and what it was shown with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordedPour {
    /// Name of a file in `assets/demonstrations`, without its ending: poses of the cup.
    #[schemars(extend("x-asset" = "demonstrations"))]
    pub asset: String,
    /// The cup, a file in `assets/containers`; that of the scenario if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-asset" = "containers"))]
    pub source: Option<String>,
    /// What was poured into, a file in `assets/containers`.
    #[schemars(extend("x-asset" = "containers"))]
    pub target: String,
    /// Where it stood on the table, m.
    pub place_m: [f64; 2],
}

/// When a pour counts as done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PourLimits {
    /// Largest share of the grains that is spilt.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub spilt_share: f64,
    /// Largest share that is left in the cup; of no account where an amount is wanted.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub left_share: f64,
    /// Most times that the cup touches the target.
    pub cup_touches: usize,
    /// Largest difference of what was poured from the amount wanted, kg; 4.5 g by default, by which a packed 100 g may fall short
    /// (Directive 76/211/EEC, annex I: 4.5 g from 50 to 100 g, 4.5 % from 100 to 200 g).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub amount_error_kg: f64,
}

impl Default for PourLimits {
    fn default() -> Self {
        Self { spilt_share: 0.01, left_share: 0.02, cup_touches: 0, amount_error_kg: 0.0045 }
    }
}

impl GrainsConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        if self.fill == FillAmount::Count(0) {
            return Err(FieldError::new("fill.count", 0, "at least one grain"));
        }
        if let FillAmount::HeightM(height_m) = self.fill {
            positive("fill.height_m", height_m)?;
        }
        self.bean.validate().map_err(|error| error.within("bean"))?;
        within("stability_rad", self.stability_rad, 0.0, 1.0)
    }
}

impl PourConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("start_m", &self.start_m)?;
        finite("start_angle_rad", self.start_angle_rad.as_slice())?;
        within("settle_s", self.settle_s, 0.0, LONGEST_SETTLE_S)?;
        self.options.validate().map_err(|error| error.within("options"))?;
        self.amount.as_ref().map_or(Ok(()), |amount| amount.validate().map_err(|error| error.within("amount")))
    }
}

impl AmountConfig {
    fn validate(&self) -> Result<(), FieldError> {
        positive("wanted_kg", self.wanted_kg)?;
        self.approach.validate().map_err(|error| error.within("approach"))
    }
}

impl PourDemonstrations {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Synthetic(synthetic) => synthetic.validate().map_err(|error| error.within("synthetic")),
            Self::Recorded(recorded) => finite("place_m", &recorded.place_m).map_err(|error| error.within("recorded")),
            Self::Learned { .. } => Ok(()),
        }
    }
}

impl SyntheticPour {
    fn validate(&self) -> Result<(), FieldError> {
        finite("place_m", &self.place_m)?;
        finite("start_m", &self.start_m)?;
        self.human.validate().map_err(|error| error.within("human"))
    }
}

impl PourLimits {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("spilt_share", self.spilt_share, 0.0, 1.0)?;
        within("left_share", self.left_share, 0.0, 1.0)?;
        positive("amount_error_kg", self.amount_error_kg)
    }
}
