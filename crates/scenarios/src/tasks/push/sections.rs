//! Sections of a pushing scenario: where demonstrations come from, how a plan is carried out, when it counts as done.

use serde::{Deserialize, Serialize};
use sim::human::HumanConfig;
use skills::field::{FieldError, finite, positive, within};
use skills::pushing::{HoldRenewalConfig, SteeringConfig};

use crate::tasks::MOST_DEMONSTRATIONS;

/// Where the demonstrations come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum DemonstrationsConfig {
    /// A synthetic human drives a tool in the simulated world.
    Synthetic(SyntheticConfig),
    /// Recorded demonstrations, one CSV file each.
    Recorded {
        /// Names of files in `assets/demonstrations`, without their ending.
        #[schemars(extend("x-asset" = "demonstrations"))]
        assets: Vec<String>,
        /// Tool that was used: a file in `assets/tools`; the scenario's tool if absent.
        #[serde(default)]
        #[schemars(extend("x-asset" = "tools"))]
        tool: Option<String>,
    },
    /// None: the skills were learned before, by `wield learn`.
    Learned {
        /// Name of a file in `assets/skills`, without its ending.
        #[schemars(extend("x-asset" = "skills"))]
        asset: String,
    },
}

/// Demonstrations of a synthetic human.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SyntheticConfig {
    /// Number of successful demonstrations wanted.
    pub count: usize,
    /// Where the object starts, m.
    pub start_m: [f64; 2],
    /// Where the human brings it, m.
    pub goal_m: [f64; 2],
    /// Names of the contact surfaces that the human pushes with, in their order; all of the tool's if empty.
    #[serde(default)]
    pub surfaces: Vec<String>,
    /// Tool that the human uses: a file in `assets/tools`; the scenario's tool if absent.
    #[serde(default)]
    #[schemars(extend("x-asset" = "tools"))]
    pub tool: Option<String>,
    /// The human.
    #[serde(default)]
    pub human: HumanConfig,
}

/// How the plan is carried out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ExecutionConfig {
    /// Whether the seen object moves the reference.
    pub mode: ExecutionMode,
    /// How a push is steered in the closed loop.
    pub steering: SteeringConfig,
    /// Time constant with which the reference takes up a steered velocity, s.
    #[schemars(range(min = 0.005, max = 1.0))]
    pub response_s: f64,
    /// When and how a hold is renewed during a push in the closed loop.
    pub hold_renewal: HoldRenewalConfig,
}

impl Default for ExecutionConfig {
    fn default() -> Self {
        Self {
            mode: ExecutionMode::default(),
            steering: SteeringConfig::default(),
            response_s: 0.05,
            hold_renewal: HoldRenewalConfig::default(),
        }
    }
}

impl ExecutionConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.steering.validate().map_err(|error| error.within("steering"))?;
        self.hold_renewal.validate().map_err(|error| error.within("hold_renewal"))?;
        within("response_s", self.response_s, 0.005, 1.0)
    }
}

/// Whether the seen object moves the reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ExecutionMode {
    /// The plan is followed whatever the object does.
    OpenLoop,
    /// While it pushes, the tool is steered by the object that the camera sees.
    #[default]
    ClosedLoop,
}

/// When the task counts as done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Limits {
    /// Largest distance of the object from its goal at the end, m.
    #[schemars(range(max = LARGEST_LIMIT_M), extend("exclusiveMinimum" = 0))]
    pub goal_error_m: f64,
    /// Smallest distance that object and tool must keep from obstacles, m.
    #[schemars(range(min = 0.0, max = LARGEST_LIMIT_M))]
    pub clearance_m: f64,
    /// Smallest distance that the object must keep from obstacles, m; `clearance_m` if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = LARGEST_LIMIT_M))]
    pub object_clearance_m: Option<f64>,
    /// Largest way of the object while it is not pushed, m; any if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = LARGEST_LIMIT_M))]
    pub knocked_m: Option<f64>,
}

impl Default for Limits {
    fn default() -> Self {
        Self { goal_error_m: 0.005, clearance_m: 0.0, object_clearance_m: None, knocked_m: None }
    }
}

impl DemonstrationsConfig {
    /// Checks the values.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending one.
    pub(super) fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Synthetic(config) => config.validate().map_err(|error| error.within("synthetic")),
            Self::Recorded { assets, .. } if assets.is_empty() => Err(FieldError::new(
                "recorded.assets",
                "an empty list",
                "the name of at least one recorded demonstration",
            )),
            Self::Recorded { .. } | Self::Learned { .. } => Ok(()),
        }
    }
}

impl SyntheticConfig {
    fn validate(&self) -> Result<(), FieldError> {
        if !(1..=MOST_DEMONSTRATIONS).contains(&self.count) {
            return Err(FieldError::new(
                "count",
                self.count,
                format!("a whole number from 1 to {MOST_DEMONSTRATIONS}"),
            ));
        }
        finite("start_m", &self.start_m)?;
        finite("goal_m", &self.goal_m)?;
        self.human.validate().map_err(|error| error.within("human"))
    }
}

/// Largest limit of a distance, m: one that is larger than a table decides nothing.
const LARGEST_LIMIT_M: f64 = 10.0;

impl Limits {
    /// Checks the values.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending one.
    pub(super) fn validate(&self) -> Result<(), FieldError> {
        positive("goal_error_m", self.goal_error_m)?;
        within("goal_error_m", self.goal_error_m, 0.0, LARGEST_LIMIT_M)?;
        let bounded = |field: &str, limit_m: f64| within(field, limit_m, 0.0, LARGEST_LIMIT_M);
        bounded("clearance_m", self.clearance_m)?;
        self.object_clearance_m.map_or(Ok(()), |clearance_m| bounded("object_clearance_m", clearance_m))?;
        self.knocked_m.map_or(Ok(()), |knocked_m| bounded("knocked_m", knocked_m))
    }
}
