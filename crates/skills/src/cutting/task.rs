//! What is asked of a cutting skill.

use nalgebra::Isometry3;
use serde::{Deserialize, Serialize};

use super::section::{Blade, Section};
use crate::corridor_filter::CorridorFilterConfig;
use crate::field::{FieldError, finite, not_negative, positive, within};
use crate::spatial::FreeMoveConfig;

/// How the edge moves through the food.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Stroke {
    /// With the slice–push ratio and the rocking of the demonstration (default).
    #[default]
    AsShown,
    /// Straight down, with the profile of depth that was shown.
    Press,
    /// With a draw along the edge in proportion to the depth.
    Slice {
        /// Speed along the edge over speed into the food; its sign is the direction of the first draw along x.
        #[schemars(range(min = -20.0, max = 20.0))]
        ratio: f64,
    },
    /// From an inclined edge to a level one, without draw.
    Rock {
        /// Angle at which the stroke begins, rad.
        angle_rad: f64,
    },
}

/// Options of a cut.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CutOptions {
    /// Kind of stroke.
    pub stroke: Stroke,
    /// How far past the board's surface the stroke is to end, m: a board gives way a little, and fibers next to it are cut.
    #[schemars(range(min = 0.0))]
    pub past_board_m: f64,
    /// How far past the board's surface the edge may ever be, m: more than `past_board_m`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub largest_past_board_m: f64,
    /// Height above the food at which a stroke begins, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub lead_m: f64,
    /// Height above the food at which the knife travels, m; that of the demonstration if absent.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub lift_m: Option<f64>,
    /// Mean speed of the edge in the food, m/s; that of the demonstration if absent.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub speed_m_per_s: Option<f64>,
    /// Largest angle by which the edge may rock, rad.
    #[schemars(range(min = 0.01, max = 0.8))]
    pub largest_rock_rad: f64,
    /// Free moves between cuts.
    pub free_move: FreeMoveConfig,
    /// Law that keeps the stroke inside its corridor.
    pub corridor_filter: CorridorFilterConfig,
}

impl Default for CutOptions {
    fn default() -> Self {
        Self {
            stroke: Stroke::AsShown,
            past_board_m: 0.0002,
            largest_past_board_m: 0.0005,
            lead_m: 0.004,
            lift_m: None,
            speed_m_per_s: None,
            largest_rock_rad: 0.5,
            free_move: FreeMoveConfig::default(),
            corridor_filter: CorridorFilterConfig::default(),
        }
    }
}

impl CutOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        not_negative("past_board_m", self.past_board_m)?;
        positive("largest_past_board_m", self.largest_past_board_m)?;
        if self.past_board_m >= self.largest_past_board_m {
            let expected = format!("less than largest_past_board_m = {}", self.largest_past_board_m);
            return Err(FieldError::new("past_board_m", self.past_board_m, expected));
        }
        positive("lead_m", self.lead_m)?;
        self.lift_m.map_or(Ok(()), |lift_m| positive("lift_m", lift_m))?;
        self.speed_m_per_s.map_or(Ok(()), |speed| positive("speed_m_per_s", speed))?;
        within("largest_rock_rad", self.largest_rock_rad, 0.01, 0.8)?;
        self.free_move.validate().map_err(|error| error.within("free_move"))?;
        self.corridor_filter.validate().map_err(|error| error.within("corridor_filter"))?;
        match self.stroke {
            Stroke::AsShown | Stroke::Press => Ok(()),
            Stroke::Slice { ratio } => within("stroke.slice.ratio", ratio, -20.0, 20.0),
            Stroke::Rock { angle_rad } => {
                let largest = 0.9 * self.largest_rock_rad;
                within("stroke.rock.angle_rad", angle_rad, -largest, largest)
            }
        }
    }
}

/// Cuts to plan.
#[derive(Debug, Clone, PartialEq)]
pub struct CutTask {
    /// Where the knife begins, `world_from_tool`.
    pub home: Isometry3<f64>,
    /// Edge of the knife.
    pub blade: Blade,
    /// Sections to cut, in their order.
    pub sections: Vec<Section>,
    /// How to cut them.
    pub options: CutOptions,
}

impl CutTask {
    /// Asks for cuts with default options.
    #[must_use]
    pub fn new(home: Isometry3<f64>, blade: Blade, sections: Vec<Section>) -> Self {
        Self { home, blade, sections, options: CutOptions::default() }
    }

    /// Checks everything that is asked.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("home", self.home.translation.vector.as_slice())?;
        finite("home", self.home.rotation.coords.as_slice())?;
        self.blade.validate().map_err(|error| error.within("blade"))?;
        if self.sections.is_empty() {
            return Err(FieldError::new("sections", "none", "at least one section"));
        }
        for (index, section) in self.sections.iter().enumerate() {
            section.validate().map_err(|error| error.within(format!("sections.{index}")))?;
        }
        self.options.validate().map_err(|error| error.within("options"))
    }
}
