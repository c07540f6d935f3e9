//! What is asked of a pouring skill.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Isometry3, Vector3};
use serde::{Deserialize, Serialize};

use super::container::{Container, Mouth};
use crate::corridor_filter::CorridorFilterConfig;
use crate::field::{FieldError, finite, not_negative, positive, within};

/// What is in the cup.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Fill {
    /// Height of the level fill above the bottom, m.
    pub height_m: f64,
    /// Angle at which its surface is stable, rad: 0 for a liquid, some half radian for beans.
    pub stability_rad: f64,
    /// Diameter of a grain, m: how fast the fill flows over the lip goes with it.
    pub grain_m: f64,
    /// Coefficient of rolling friction of its grains: how fast they roll down the wall goes with it.
    pub rolling_friction: f64,
}

impl Default for Fill {
    fn default() -> Self {
        Self { height_m: 0.045, stability_rad: 0.5, grain_m: 0.007, rolling_friction: 0.1 }
    }
}

/// Where the lip is held while it pours.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PourAim {
    /// Such that the middle of the stream, thrown forward as it falls from the lip, meets the middle of the mouth.
    #[default]
    Stream,
    /// As far over the mouth as it was shown, in radii of the mouth.
    Shown,
}

/// Options of a pour.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PourOptions {
    /// Height of the lip above what the cup clears, m: above the rim once the cup is tilted.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gap_m: f64,
    /// Largest height of the lip above the rim when the flow may begin, m: from higher it scatters.
    #[schemars(range(max = 1.0))]
    pub largest_gap_m: f64,
    /// Clearance between cup and rim that is certified for the whole plan, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub least_clearance_m: f64,
    /// Clearance of the virtual movement x^o, m: more than `least_clearance_m`.
    #[schemars(range(max = 0.5))]
    pub margin_m: f64,
    /// Distance of the lip from the mouth's inner edge while the flow may run, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub lip_margin_m: f64,
    /// Where the lip is held over the mouth.
    pub aim: PourAim,
    /// Height of the table that the cup stays above, world frame, m; that of the start if absent.
    pub floor_m: Option<f64>,
    /// Distance of the lip from the rim at which the approach ends, m: more than `margin_m`.
    #[schemars(range(max = 0.5))]
    pub beside_m: f64,
    /// Factor k2 of the virtual movement; the paper's is 1.
    #[schemars(range(min = 0.0))]
    pub k2: f64,
    /// Angle before the onset of the flow from which on the lip is over the mouth and the tilt is slow, rad.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub before_onset_rad: f64,
    /// Angle beyond level at which the cup is emptied, rad.
    #[schemars(range(min = 0.0, max = FRAC_PI_2))]
    pub beyond_level_rad: f64,
    /// Largest rate of tilt before the flow may begin, rad/s.
    #[schemars(range(min = 0.01, max = 10.0))]
    pub tilt_rate_rad_per_s: f64,
    /// Largest rate of tilt while it may run, rad/s.
    #[schemars(range(min = 0.01))]
    pub pour_rate_rad_per_s: f64,
    /// Duration of the plain primitive in durations of its demonstration: τ of Eqs. (1) to (3).
    #[schemars(range(min = 0.1, max = 20.0))]
    pub plain_duration: f64,
    /// Time for which the cup is held empty, s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub hold_s: f64,
    /// Largest tilt during the approach, rad.
    #[schemars(range(min = 0.02, max = 0.8))]
    pub level_rad: f64,
    /// Largest mean speed of the approach, m/s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub approach_speed_m_per_s: f64,
    /// Law that keeps approach and lip inside their corridors.
    pub corridor_filter: CorridorFilterConfig,
}

impl Default for PourOptions {
    fn default() -> Self {
        Self {
            gap_m: 0.010,
            largest_gap_m: 0.06,
            least_clearance_m: 0.003,
            margin_m: 0.005,
            lip_margin_m: 0.004,
            aim: PourAim::Stream,
            floor_m: None,
            beside_m: 0.02,
            k2: 1.0,
            before_onset_rad: 0.1,
            beyond_level_rad: 0.45,
            tilt_rate_rad_per_s: 0.8,
            pour_rate_rad_per_s: 0.35,
            plain_duration: 1.0,
            hold_s: 0.8,
            level_rad: 0.25,
            approach_speed_m_per_s: 0.10,
            corridor_filter: CorridorFilterConfig::default(),
        }
    }
}

impl PourOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("gap_m", self.gap_m)?;
        positive("least_clearance_m", self.least_clearance_m)?;
        within("largest_gap_m", self.largest_gap_m, self.gap_m, 1.0)?;
        within("margin_m", self.margin_m, self.least_clearance_m, 0.5)?;
        positive("lip_margin_m", self.lip_margin_m)?;
        within("beside_m", self.beside_m, self.margin_m, 0.5)?;
        not_negative("k2", self.k2)?;
        within("before_onset_rad", self.before_onset_rad, 0.0, 1.0)?;
        within("beyond_level_rad", self.beyond_level_rad, 0.0, FRAC_PI_2)?;
        within("tilt_rate_rad_per_s", self.tilt_rate_rad_per_s, 0.01, 10.0)?;
        within("pour_rate_rad_per_s", self.pour_rate_rad_per_s, 0.01, self.tilt_rate_rad_per_s)?;
        within("plain_duration", self.plain_duration, 0.1, 20.0)?;
        finite("floor_m", self.floor_m.as_slice())?;
        positive("hold_s", self.hold_s)?;
        within("level_rad", self.level_rad, 0.02, 0.8)?;
        positive("approach_speed_m_per_s", self.approach_speed_m_per_s)?;
        self.corridor_filter.validate().map_err(|error| error.within("corridor_filter"))
    }
}

/// Pour to plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PourTask {
    /// Where the cup stands, `world_from_cup`: upright.
    pub start: Isometry3<f64>,
    /// The cup.
    pub source: Container,
    /// What is in it.
    pub fill: Fill,
    /// Where it goes.
    pub mouth: Mouth,
    /// Direction of pouring about z of the world, rad: from the start to the mouth if absent.
    pub direction_rad: Option<f64>,
    /// How to pour.
    pub options: PourOptions,
}

/// Largest tilt of a cup that counts as upright, rad.
const UPRIGHT_RAD: f64 = 0.05;

impl PourTask {
    /// Asks for a pour with default fill and options.
    #[must_use]
    pub fn new(start: Isometry3<f64>, source: Container, mouth: Mouth) -> Self {
        Self { start, source, fill: Fill::default(), mouth, direction_rad: None, options: PourOptions::default() }
    }

    /// Checks everything that is asked.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("start", self.start.translation.vector.as_slice())?;
        finite("start", self.start.rotation.coords.as_slice())?;
        let lean = (self.start.rotation * Vector3::z()).angle(&Vector3::z());
        if lean > UPRIGHT_RAD {
            return Err(FieldError::new("start", format!("a cup that leans by {lean:.3} rad"), "an upright cup"));
        }
        self.source.validate().map_err(|error| error.within("source"))?;
        self.mouth.validate().map_err(|error| error.within("mouth"))?;
        within("fill.height_m", self.fill.height_m, 0.0, self.source.height_m - self.source.wall_m)?;
        within("fill.stability_rad", self.fill.stability_rad, 0.0, 1.0)?;
        positive("fill.grain_m", self.fill.grain_m)?;
        within("fill.rolling_friction", self.fill.rolling_friction, 0.0, 1.0)?;
        finite("direction_rad", self.direction_rad.as_slice())?;
        self.options.validate().map_err(|error| error.within("options"))
    }

    /// Height of the table above the rim, m: below 0.
    pub(super) fn floor_above_rim_m(&self) -> f64 {
        self.options.floor_m.unwrap_or(self.start.translation.vector.z) - self.mouth.center_world.z
    }

    /// Direction of pouring, rad about z of the world.
    pub(super) fn direction(&self) -> f64 {
        let way = self.mouth.center_world.coords - self.start.translation.vector;
        self.direction_rad.unwrap_or_else(|| way.y.atan2(way.x))
    }
}
