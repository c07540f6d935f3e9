//! Two-level tool planning: a tool that pushes an object along a given path, segment by segment, with as few changes of
//! its contact surface as the path allows.
//!
//! The paper's §IV.B compares with such a planner without describing it. Here a segment can be pushed by a place on a
//! surface whose normal is within an angle of the segment's heading, from a pose that keeps the tool clear of obstacles
//! and inside its workspace; dynamic programming over segments × places finds the fewest changes of surface, of those the
//! fewest changes of place, and of those the smallest squared angles.

mod holds;
mod measures;

use nalgebra::{Isometry2, Point2};
use serde::{Deserialize, Serialize};

pub use measures::{Phase, TwoLevelMeasures};

use super::measures::SAME_HEADING_RAD;
use crate::error::SkillError;
use crate::field::{FieldError, finite, not_negative, positive, within};
use crate::outline::PlacedOutline;
use crate::tool::Tool;

/// How the tool may be turned along the path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ToolTurning {
    /// It keeps its angle.
    Fixed {
        /// The angle, rad.
        angle_rad: f64,
    },
    /// It is turned for each segment so that the surface's normal points along it.
    WithHeading,
}

/// Options of the tool level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TwoLevelConfig {
    /// How the tool may be turned.
    pub turning: ToolTurning,
    /// Largest angle between a segment and the normal that pushes along it, rad; left out: the tool's friction angle, beyond
    /// which the object slips.
    pub push_angle_rad: Option<f64>,
    /// Places that are tried on each surface, the middle among them if the number is odd.
    pub places: usize,
    /// Distance that the tool keeps from obstacles, m.
    pub clearance_m: f64,
}

impl Default for TwoLevelConfig {
    fn default() -> Self {
        Self { turning: ToolTurning::Fixed { angle_rad: 0.0 }, push_angle_rad: None, places: 5, clearance_m: 0.003 }
    }
}

/// Who pushes what where.
#[derive(Clone, Debug)]
pub struct TwoLevelProblem<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// Radius of the disc that is pushed, m.
    pub object_radius_m: f64,
    /// Obstacles, world frame.
    pub obstacles: &'a [PlacedOutline],
    /// Corners of least and of greatest coordinates of the rectangle that the tool's origin may be in, world frame, m.
    pub workspace_m: Option<([f64; 2], [f64; 2])>,
}

/// A place of contact for one segment, and where the tool is with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Index of the contact surface in the tool's list.
    pub surface: usize,
    /// Arc length of the contact from the surface's middle, m.
    pub place_m: f64,
    /// Angle between the segment's heading and the normal, rad.
    pub angle_rad: f64,
    /// Pose of the tool at the segment's start.
    pub world_from_tool_start: Isometry2<f64>,
    /// Pose of the tool at the segment's end.
    pub world_from_tool_end: Isometry2<f64>,
}

/// Why the tool cannot push along a segment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Obstruction {
    /// No surface faces along it.
    Heading {
        /// Smallest angle between the heading and a normal, rad.
        least_rad: f64,
    },
    /// Surfaces face along it, but from there the tool meets an obstacle.
    Obstacle,
    /// Surfaces face along it, but the tool would have to leave its workspace.
    Workspace,
}

/// One straight part of the path, and how it is pushed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where the object's center begins, world frame.
    pub from_world: Point2<f64>,
    /// Where it ends, world frame.
    pub to_world: Point2<f64>,
    /// The hold; if none can push, one that faces the segment best.
    pub hold: Hold,
    /// Why the hold cannot push, if it cannot.
    pub obstruction: Option<Obstruction>,
}

/// How a tool pushes an object along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoLevelPlan {
    /// Parts of the path in their order; parts of no length are left out.
    pub segments: Vec<Segment>,
}

impl TwoLevelConfig {
    /// Checks the options.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending option.
    pub fn validate(&self) -> Result<(), FieldError> {
        if let ToolTurning::Fixed { angle_rad } = self.turning {
            finite("turning.fixed.angle_rad", &[angle_rad])?;
        }
        if let Some(angle_rad) = self.push_angle_rad {
            within("push_angle_rad", angle_rad, 0.0, std::f64::consts::FRAC_PI_2)?;
        }
        if self.places == 0 {
            return Err(FieldError::new("places", 0, "at least 1"));
        }
        not_negative("clearance_m", self.clearance_m)
    }

    /// Chooses a hold for each segment of the object's `path` (world frame, m).
    ///
    /// # Errors
    /// [`SkillError::InvalidConfig`] if an option, the tool, the radius or an obstacle is none,
    /// [`SkillError::RowCount`] if the path has fewer than two different places, [`SkillError::NonFinite`] if one is not
    /// finite.
    pub fn plan(&self, problem: &TwoLevelProblem<'_>, path: &[Point2<f64>]) -> Result<TwoLevelPlan, SkillError> {
        let operation = "plan tool along path";
        self.validate()?;
        problem.validate()?;
        for (row, place) in path.iter().enumerate() {
            if let Some((column, found)) = place.iter().enumerate().find(|(_, coordinate)| !coordinate.is_finite()) {
                return Err(SkillError::NonFinite { operation, row, column, found: *found });
            }
        }
        let parts: Vec<_> = path
            .windows(2)
            .map(|pair| (pair[0], pair[1]))
            .filter(|(from, to)| nalgebra::distance(from, to) > SAME_PLACE_M)
            .collect();
        if parts.is_empty() {
            return Err(SkillError::RowCount { operation, found: path.len(), expected: "2 different places".into() });
        }
        let offers: Vec<Vec<Segment>> = parts.iter().map(|(from, to)| holds::offers(self, problem, from, to)).collect();
        Ok(TwoLevelPlan { segments: holds::fewest_changes(&offers) })
    }

    fn push_angle_rad(&self, tool: &Tool) -> f64 {
        self.push_angle_rad.unwrap_or(tool.friction.atan())
    }
}

/// Shorter parts of a path are left out, m.
const SAME_PLACE_M: f64 = 1e-9;

impl TwoLevelProblem<'_> {
    fn validate(&self) -> Result<(), FieldError> {
        self.tool.validate().map_err(|error| error.within("tool"))?;
        positive("object_radius_m", self.object_radius_m)?;
        for (index, obstacle) in self.obstacles.iter().enumerate() {
            obstacle.validate().map_err(|error| error.within(format!("obstacles.{index}")))?;
        }
        match self.workspace_m {
            Some((min, max)) => finite("workspace_m", &[min[0], min[1], max[0], max[1]]),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
