//! Sections of a cutting scenario: food, knife, board, how the plan is carried out, when it counts as done.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use serde::{Deserialize, Serialize};
use sim::cutting::food::{FoodFile, FoodSample};
use sim::cutting::mechanics::Thresholds;
use sim::cutting::scene::CuttingBoard;
use skills::field::{FieldError, finite, not_negative, positive, within};

/// What is cut.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FoodConfig {
    /// Name of a file in `assets/foods`, without its ending.
    #[schemars(extend("x-asset" = "foods"))]
    pub asset: String,
    /// Factor on all its lengths.
    #[serde(default = "one")]
    pub scale: f64,
    /// Toughness, J/m²; the file's if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub toughness_j_per_m2: Option<f64>,
    /// Shear stress between the flanks of the blade and the food, Pa; the file's if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0))]
    pub flank_shear_pa: Option<f64>,
    /// Coefficient of friction on the board; the file's if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub board_friction: Option<f64>,
}

fn one() -> f64 {
    1.0
}

impl FoodConfig {
    /// The food that the file and these changes state.
    #[must_use]
    pub fn changed(&self, file: &FoodFile) -> FoodFile {
        let mut food = file.clone();
        let material = &mut food.material;
        let set = |value: &mut f64, changed: Option<f64>| *value = changed.unwrap_or(*value);
        set(&mut material.toughness_j_per_m2, self.toughness_j_per_m2);
        set(&mut material.flank_shear_pa, self.flank_shear_pa);
        set(&mut material.board_friction, self.board_friction);
        // what the scenario states lies in the range that specimens come from
        if let Some([low, high]) = &mut food.range.toughness_j_per_m2 {
            *low = low.min(food.material.toughness_j_per_m2);
            *high = high.max(food.material.toughness_j_per_m2);
        }
        food
    }

    /// Checks the numbers on their own.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        let toughness_j_per_m2 = self.toughness_j_per_m2.unwrap_or(1.0);
        FoodSample { scale: self.scale, toughness_j_per_m2 }.validate()?;
        self.flank_shear_pa.map_or(Ok(()), |shear| not_negative("flank_shear_pa", shear))?;
        self.board_friction.map_or(Ok(()), |friction| within("board_friction", friction, 0.0, 2.0))
    }
}

/// What it is cut with, and how the hand holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KnifeConfig {
    /// Name of a file in `assets/knives`, without its ending.
    #[schemars(extend("x-asset" = "knives"))]
    pub asset: String,
    /// Where the middle of the handle is in the gripping frame of the arm, m.
    #[serde(default)]
    pub grip_m: [f64; 3],
    /// How the knife is turned in that frame: roll, pitch, yaw about its axes x, y, z, in this order, rad. By default the
    /// cutting direction is the approach axis z of the hand, and the tip points along its x axis.
    #[serde(default = "default_grip_rpy_rad")]
    pub grip_rpy_rad: [f64; 3],
}

fn default_grip_rpy_rad() -> [f64; 3] {
    [FRAC_PI_2, 0.0, 0.0]
}

impl KnifeConfig {
    /// Pose of the knife's grip in the gripping frame of the arm.
    #[must_use]
    pub fn hand_from_grip(&self) -> Isometry3<f64> {
        let [roll, pitch, yaw] = self.grip_rpy_rad;
        let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        Isometry3::from_parts(Translation3::from(nalgebra::Vector3::from(self.grip_m)), turn)
    }

    /// Checks the numbers on their own.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("grip_m", &self.grip_m)?;
        finite("grip_rpy_rad", &self.grip_rpy_rad)
    }
}

/// What it is cut on: a cuboid that never moves, its edges along the world's axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoardConfig {
    /// Middle of its upper side, world frame, m.
    #[schemars(inner(range(min = -FARTHEST_M, max = FARTHEST_M)))]
    pub center_m: [f64; 3],
    /// Full lengths along x, y and z, m.
    #[serde(default = "default_size_m")]
    #[schemars(inner(range(min = 0.002, max = 4.0)))]
    pub size_m: [f64; 3],
    /// Coefficient of friction of the knife on the board, and the most that any food has on it.
    #[serde(default = "default_friction")]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub friction: f64,
}

/// A small kitchen board.
fn default_size_m() -> [f64; 3] {
    [0.24, 0.34, 0.02]
}

/// Estimate: steel and moist food on plastic.
fn default_friction() -> f64 {
    0.4
}

/// Longest board and farthest place, m.
const FARTHEST_M: f64 = 10.0;

impl BoardConfig {
    /// Height of its upper side, m.
    #[must_use]
    pub fn top_m(&self) -> f64 {
        self.center_m[2]
    }

    /// The board as the scene has it.
    #[must_use]
    pub fn board(&self) -> CuttingBoard {
        let [x, y, z] = self.center_m;
        CuttingBoard {
            world_from_board: Isometry3::translation(x, y, z),
            half_extents_m: self.size_m.map(|length| 0.5 * length),
            friction: self.friction,
        }
    }

    /// Checks the numbers on their own.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.center_m.iter().try_for_each(|value| within("center_m", *value, -FARTHEST_M, FARTHEST_M))?;
        self.size_m.iter().try_for_each(|length| within("size_m", *length, 0.002, 4.0))?;
        within("friction", self.friction, 0.0, 2.0)
    }
}

/// How the demonstrated cut is made one of other foods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SkillKind {
    /// The section constrains the knife: the stroke runs in its plane, and its corridor is certified.
    #[default]
    Constrained,
    /// A pose primitive of the whole demonstration, noise and all: the baseline.
    PlainDmp,
}

/// How the plan is made and carried out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct ExecutionConfig {
    /// What is learned of the demonstration.
    pub skill: SkillKind,
    /// Whether the arm is told what force the food is expected to exert, by the toughness that the scenario states.
    pub expects_cutting_force: bool,
    /// Whether that force is scaled to how far the knife falls behind: the food may be tougher or softer than stated.
    pub learns_toughness: bool,
}

impl Default for ExecutionConfig {
    fn default() -> Self {
        Self { skill: SkillKind::default(), expects_cutting_force: true, learns_toughness: true }
    }
}

/// How well the food is seen before it is cut: one look at rest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct LookConfig {
    /// Standard deviation of each coordinate of its seen place, m. By default half a millimeter: what remains of a camera's
    /// calibration to the arm once the noise of its pictures is averaged out. Estimate.
    #[schemars(range(min = 0.0, max = LARGEST_NOISE_M))]
    pub place_noise_m: f64,
    /// Standard deviation of its seen angle, rad.
    #[schemars(range(min = 0.0, max = LARGEST_NOISE_RAD))]
    pub angle_noise_rad: f64,
}

impl Default for LookConfig {
    fn default() -> Self {
        Self { place_noise_m: 0.0005, angle_noise_rad: 0.01 }
    }
}

/// Noise beyond which a look tells nothing.
const LARGEST_NOISE_M: f64 = 0.02;
const LARGEST_NOISE_RAD: f64 = 0.5;

impl LookConfig {
    /// Checks the values.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending one.
    pub(super) fn validate(&self) -> Result<(), FieldError> {
        within("place_noise_m", self.place_noise_m, 0.0, LARGEST_NOISE_M)?;
        within("angle_noise_rad", self.angle_noise_rad, 0.0, LARGEST_NOISE_RAD)
    }
}

/// When the task counts as done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Limits {
    /// Largest root mean square error of the pieces' lengths, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub thickness_error_rms_m: f64,
    /// Largest share of mass that may be lost or won by cutting.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass_error_share: f64,
    /// Largest mean deviation Ra of any cut face, m; any if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mean_deviation_m: Option<f64>,
    /// Largest tilt of any cut face from the wanted plane, rad; any if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub tilt_rad: Option<f64>,
    /// What counts as a failed cut.
    pub failing: Thresholds,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            thickness_error_rms_m: 0.002,
            mass_error_share: 1e-6,
            mean_deviation_m: None,
            tilt_rad: None,
            failing: Thresholds::default(),
        }
    }
}

impl Limits {
    /// Checks the values.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending one.
    pub(super) fn validate(&self) -> Result<(), FieldError> {
        positive("thickness_error_rms_m", self.thickness_error_rms_m)?;
        positive("mass_error_share", self.mass_error_share)?;
        self.mean_deviation_m.map_or(Ok(()), |deviation_m| positive("mean_deviation_m", deviation_m))?;
        self.tilt_rad.map_or(Ok(()), |tilt_rad| positive("tilt_rad", tilt_rad))?;
        self.failing.validate().map_err(|error| error.within("failing"))
    }
}
