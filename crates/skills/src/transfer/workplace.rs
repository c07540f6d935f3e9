//! What a plan for a tool must respect: map, obstacles with their margins, the tool's shape, the arm's reach.

use std::fmt;

use nalgebra::{Isometry2, Point2};
use parry2d::math::{Pose, Vector};
use parry2d::shape::SharedShape;

use crate::field::{FieldError, not_negative};
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

impl Workplace<'_> {
    /// Checks the margins.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        not_negative("object_margin_m", self.object_margin_m)?;
        not_negative("tool_margin_m", self.tool_margin_m)
    }

    /// Distance of the object's center from its side in the world direction at `angle_rad`, m: how far a face that
    /// pushes against it stands off.
    #[must_use]
    pub fn object_support_m(&self, angle_rad: f64) -> f64 {
        self.object.support_m(angle_rad - self.object_angle_rad)
    }
}

/// Shapes of a workplace, built once: distances are asked for many thousand times.
#[derive(Clone)]
pub(super) struct Shapes {
    object: Vec<(SharedShape, Isometry2<f64>)>,
    tool: Vec<(SharedShape, Isometry2<f64>)>,
    obstacles: Vec<(SharedShape, Isometry2<f64>)>,
}

impl Shapes {
    pub(super) fn new(setting: &Workplace<'_>) -> Self {
        let placed = |outline: &PlacedOutline| Some((outline.shape.shape()?, outline.pose()));
        let turn = Isometry2::rotation(setting.object_angle_rad);
        Self {
            object: setting.object.shape().map(|shape| (shape, turn)).into_iter().collect(),
            tool: setting.tool.pieces.iter().filter_map(placed).collect(),
            obstacles: setting.obstacles.iter().filter_map(placed).collect(),
        }
    }

    /// Distance of the object, its center at `center`, from the nearest obstacle, m; negative where they overlap.
    pub(super) fn object_clearance_m(&self, center: &Point2<f64>) -> f64 {
        nearest_m(&self.object, &Isometry2::from(*center), &self.obstacles)
    }

    /// Distance of the tool from the nearest obstacle, m; negative where they overlap.
    pub(super) fn tool_clearance_m(&self, world_from_tool: &Isometry2<f64>) -> f64 {
        nearest_m(&self.tool, world_from_tool, &self.obstacles)
    }

    /// Distance of the tool from the object, m; negative where they overlap.
    pub(super) fn gap_m(&self, world_from_tool: &Isometry2<f64>, center: &Point2<f64>) -> f64 {
        let at = Isometry2::from(*center);
        let object: Vec<_> = self.object.iter().map(|(shape, pose)| (shape.clone(), at * pose)).collect();
        nearest_m(&self.tool, world_from_tool, &object)
    }
}

fn nearest_m(
    moving: &[(SharedShape, Isometry2<f64>)],
    pose: &Isometry2<f64>,
    still: &[(SharedShape, Isometry2<f64>)],
) -> f64 {
    let mut nearest = f64::INFINITY;
    for (first, at) in moving {
        let here = engine_pose(&(pose * at));
        for (second, there) in still {
            let there = engine_pose(there);
            let contact =
                parry2d::query::contact(&here, first.as_ref(), &there, second.as_ref(), nearest.min(f64::MAX));
            nearest = contact.ok().flatten().map_or(nearest, |contact| contact.dist.min(nearest));
        }
    }
    nearest
}

fn engine_pose(pose: &Isometry2<f64>) -> Pose {
    Pose::new(Vector::new(pose.translation.x, pose.translation.y), pose.rotation.angle())
}
