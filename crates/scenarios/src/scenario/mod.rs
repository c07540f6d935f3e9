//! The scenario file: everything that a run depends on, as one serializable struct.

mod check;
mod decode;
mod document;
mod draft;
mod explain;
mod load;
mod named;
mod parts;
mod skills_file;
mod source;
mod units;
mod variation;
mod words;

use serde::{Deserialize, Serialize};
use sim::controllers::ControllerConfig;
use sim::human::HumanConfig;
use sim::planar::{EngineConfig, ObjectConfig, WorldConfig};
use sim::sensing::CameraConfig;
use skills::field::{FieldError, within};
use skills::primitive::PrimitiveConfig;
use skills::pushing::{HoldRenewalConfig, SteeringConfig};

use crate::tasks::TaskConfig;

pub use load::{load, notes, title};
pub(crate) use named::{demonstration_description, skills_description, tool_description};
pub(crate) use parts::MOST_DEMONSTRATIONS;
pub use parts::{CONTROL_RATE_HZ, LARGEST_SEED};
pub use skills_file::{Origin, SkillsFile};
pub(crate) use source::Source;
pub use variation::{Variation, VariationConfig};

/// One experiment: what is there, what is to be done, how it is learned, carried out and judged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Name, title, description and seed.
    pub scenario: Header,
    /// The table: map, gravity, obstacles.
    pub world: WorldConfig,
    /// The object that is pushed.
    pub object: ObjectConfig,
    /// The tool in the hand.
    pub tool: ToolConfig,
    /// The arm that holds the tool.
    pub robot: RobotConfig,
    /// What turns tracking errors into joint torques.
    pub controller: ControllerConfig,
    /// What is to be done.
    pub task: TaskConfig,
    /// Where the demonstrations come from.
    pub demonstrations: DemonstrationsConfig,
    /// What is learned from them.
    #[serde(default)]
    pub primitive: PrimitiveConfig,
    /// How the plan is carried out.
    #[serde(default)]
    pub execution: ExecutionConfig,
    /// What sees the object.
    #[serde(default)]
    pub camera: CameraConfig,
    /// Time steps and contact solver.
    #[serde(default)]
    pub engine: EngineConfig,
    /// What each seed's world differs in from all of this.
    #[serde(default)]
    pub variation: VariationConfig,
    /// When the task counts as done.
    #[serde(default)]
    pub limits: Limits,
    /// What the recording holds.
    #[serde(default)]
    pub recording: RecordingConfig,
}

/// Name, title, description and seed of a scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// Name in results and of their folder: letters, digits, `_` and `-`; the file's name without its ending if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// One line for lists and tables.
    pub title: String,
    /// A paragraph for the recording and for readers.
    #[serde(default)]
    pub description: String,
    /// All randomness of a run comes from here.
    #[serde(default = "default_seed")]
    pub seed: u64,
}

fn default_seed() -> u64 {
    1
}

/// The tool in the hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ToolConfig {
    /// Name of a file in `assets/tools`, without its ending.
    pub asset: String,
}

/// The arm that holds the tool.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotConfig {
    /// Name of a URDF file in `assets/robots`, without its ending.
    pub asset: String,
    /// Position of the arm's base in the world, m.
    #[serde(default)]
    pub base_m: [f64; 2],
    /// Rotation of the arm's base in the world, rad.
    #[serde(default)]
    pub base_angle_rad: f64,
    /// Rotor inertia felt at each joint, kg m²; one number per joint, or none for a bare arm.
    #[serde(default)]
    pub rotor_inertia_kg_m2: Vec<f64>,
    /// Frame of the arm that grips the tool.
    #[serde(default = "default_tool_frame")]
    pub tool_frame: String,
}

fn default_tool_frame() -> String {
    "flange".into()
}

/// Where the demonstrations come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum DemonstrationsConfig {
    /// A synthetic human drives a tool in the simulated world.
    Synthetic(SyntheticConfig),
    /// Recorded demonstrations, one CSV file each.
    Recorded {
        /// Names of files in `assets/demonstrations`, without their ending.
        assets: Vec<String>,
        /// Tool that was used: a file in `assets/tools`; the scenario's tool if absent.
        #[serde(default)]
        tool: Option<String>,
    },
    /// None: the skills were learned before, by `wield learn`.
    Learned {
        /// Name of a file in `assets/skills`, without its ending.
        asset: String,
    },
}

/// Demonstrations of a synthetic human.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    pub tool: Option<String>,
    /// The human.
    #[serde(default)]
    pub human: HumanConfig,
}

/// How the plan is carried out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ExecutionConfig {
    /// Whether the seen object moves the reference.
    pub mode: ExecutionMode,
    /// How a push is steered in the closed loop.
    pub steering: SteeringConfig,
    /// Time constant with which the reference takes up a steered velocity, s.
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ExecutionMode {
    /// The plan is followed whatever the object does.
    OpenLoop,
    /// While it pushes, the tool is steered by the object that the camera sees.
    #[default]
    ClosedLoop,
}

/// When the task counts as done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Limits {
    /// Largest distance of the object from its goal at the end, m.
    pub goal_error_m: f64,
    /// Smallest distance that object and tool must keep from obstacles, m.
    pub clearance_m: f64,
    /// Smallest distance that the object must keep from obstacles, m; `clearance_m` if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub object_clearance_m: Option<f64>,
    /// Largest way of the object while it is not pushed, m; any if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub knocked_m: Option<f64>,
}

impl Default for Limits {
    fn default() -> Self {
        Self { goal_error_m: 0.005, clearance_m: 0.0, object_clearance_m: None, knocked_m: None }
    }
}

/// What the recording holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RecordingConfig {
    /// Samples per simulated second in the recording, Hz.
    pub rate_hz: f64,
}

impl Default for RecordingConfig {
    fn default() -> Self {
        Self { rate_hz: 100.0 }
    }
}

/// A checked scenario together with everything that it names.
#[derive(Clone, Debug)]
pub struct ResolvedScenario {
    /// Name, as the scenario states it, or the file's name without its ending.
    pub name: String,
    /// The scenario with all defaults filled in, the name too.
    pub scenario: Scenario,
    /// The tool in the hand.
    pub tool: skills::tool::Tool,
    /// The tool of the demonstrations.
    pub demonstration_tool: skills::tool::Tool,
    /// The arm, as its URDF describes it; without tool, mounting or rotor inertia.
    pub arm: robot::Manipulator,
    /// The recorded demonstrations that the scenario names, in its order.
    pub recorded: Vec<skills::demonstration::Demonstration>,
    /// The skills that the scenario names instead of demonstrations.
    pub learned: Option<SkillsFile>,
    /// The scenario file's text, as it was read.
    pub source: String,
}

impl ResolvedScenario {
    /// Name of the file of the tool that the demonstrations were or are to be shown with.
    #[must_use]
    pub fn demonstration_tool_name(&self) -> &str {
        let own = match &self.scenario.demonstrations {
            DemonstrationsConfig::Synthetic(SyntheticConfig { tool, .. })
            | DemonstrationsConfig::Recorded { tool, .. } => tool.as_deref(),
            DemonstrationsConfig::Learned { .. } => self.learned.as_ref().map(|file| file.learned.tool.as_str()),
        };
        own.unwrap_or(&self.scenario.tool.asset)
    }
}
