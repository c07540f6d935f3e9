//! What a plan for a tool must respect: map, obstacles with their margins, the tool's shape, the arm's reach.

use std::fmt;

use nalgebra::{Isometry2, Point2};

use crate::field::{FieldError, finite, not_negative};
use crate::outline::{Outline, PlacedOutline};
use crate::tool::Tool;

/// Tells at which poses an actuator can hold a tool.
pub trait Reach: fmt::Debug {
    /// Whether the actuator can be at `world_from_tool`; the tool's frame is that of the actuator.
    fn holds(&self, world_from_tool: &Isometry2<f64>) -> bool;
}

/// Reach without bounds.
#[derive(Debug, Clone, Copy)]
pub struct Everywhere;

impl Reach for Everywhere {
    fn holds(&self, _: &Isometry2<f64>) -> bool {
        true
    }
}

/// Reach of an actuator that can be anywhere in a rectangle, world frame, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RectangularReach {
    /// Smallest coordinates, m.
    pub min_m: [f64; 2],
    /// Largest coordinates, m.
    pub max_m: [f64; 2],
}

impl Reach for RectangularReach {
    fn holds(&self, world_from_tool: &Isometry2<f64>) -> bool {
        let at = world_from_tool.translation.vector;
        (0..2).all(|axis| (self.min_m[axis]..=self.max_m[axis]).contains(&at[axis]))
    }
}

/// World, object and tool of a transfer, lengths in m, world frame.
#[derive(Debug, Clone)]
pub struct Workplace<'a> {
    /// Smallest coordinates of the map, in which the whole object stays.
    pub map_min: Point2<f64>,
    /// Largest coordinates of the map.
    pub map_max: Point2<f64>,
    /// Obstacles.
    pub obstacles: &'a [PlacedOutline],
    /// Least distance of the object from obstacles: the paper's safe margin.
    pub object_margin_m: f64,
    /// Least distance of the tool from obstacles.
    pub tool_margin_m: f64,
    /// Outline of the object about its center.
    pub object: &'a Outline,
    /// Angle at which the object stands and is kept, rad.
    pub object_angle_rad: f64,
    /// The tool.
    pub tool: &'a Tool,
    /// Angle at which the tool is held, rad.
    pub tool_angle_rad: f64,
    /// Whether the tool is held above the obstacles and does not have to keep clear of them.
    pub tool_passes: bool,
    /// Where the actuator can be.
    pub reach: &'a dyn Reach,
}

/// A centroid this near to the origin of its outline is there, m: places given in files.
const CENTERED_M: f64 = 1e-4;

impl Workplace<'_> {
    /// Checks map, margins, outlines, angles and tool.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("map_min", self.map_min.coords.as_slice())?;
        finite("map_max", self.map_max.coords.as_slice())?;
        for axis in 0..2 {
            if self.map_min[axis] >= self.map_max[axis] {
                let expected = format!("more than map_min, {} m", self.map_min[axis]);
                return Err(FieldError::new("map_max", self.map_max[axis], expected));
            }
        }
        not_negative("object_margin_m", self.object_margin_m)?;
        not_negative("tool_margin_m", self.tool_margin_m)?;
        finite("object_angle_rad", &[self.object_angle_rad])?;
        finite("tool_angle_rad", &[self.tool_angle_rad])?;
        self.object.validate().map_err(|error| error.within("object"))?;
        let center = self.object.centroid();
        if center.coords.norm() > CENTERED_M {
            let found = format!("an outline about ({:.4}, {:.4}) m", center.x, center.y);
            return Err(FieldError::new("object", found, "one with its centroid at its origin: pushes go through it"));
        }
        self.tool.validate().map_err(|error| error.within("tool"))?;
        for (index, obstacle) in self.obstacles.iter().enumerate() {
            obstacle.validate().map_err(|error| error.within(format!("obstacles.{index}")))?;
        }
        Ok(())
    }

    /// Distance of the object's center from its side in the world direction at `angle_rad`, m: how far a face that
    /// pushes against it stands off.
    #[must_use]
    pub fn object_support_m(&self, angle_rad: f64) -> f64 {
        self.object.support_m(angle_rad - self.object_angle_rad)
    }
}
