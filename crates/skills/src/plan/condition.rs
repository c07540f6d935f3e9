//! Pre- and post-conditions of an action, and what must hold throughout: each is a number with a limit.

use std::fmt;

use nalgebra::{Isometry2, Point2, UnitComplex};
use serde::Serialize;

use super::{ChainTolerances, Setting};
use crate::outline::{Outline, separation_m};
use crate::tool::{ContactSurface, Tool};

/// What must hold; the number that is checked is named in brackets.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Condition {
    /// The tool rests (speed, m/s; an angular speed counts as on an arm of 0.1 m).
    ToolAtRest,
    /// The object rests (speed, m/s; an angular speed counts as on an arm of 0.1 m).
    ObjectAtRest,
    /// The object stays where it is (distance, m; an angle counts as on an arm of 0.1 m).
    ObjectStays,
    /// The object is where the push begins or ends (distance, m).
    ObjectInPlace,
    /// The surface of this name touches the object (gap, m; negative if it presses).
    InContact(String),
    /// The contact lies on the usable part of the surface of this name (distance beyond its end, m).
    OnSurface(String),
    /// The object moves along the normal of the surface of this name (angle, rad).
    AlongNormal(String),
    /// The tool does not overlap the object (overlap, m; negative if apart).
    ToolClearOfObject,
    /// The tool keeps clear of obstacles (missing clearance, m; negative if there is more).
    ToolClearOfObstacles,
    /// The object keeps clear of obstacles (missing clearance, m; negative if there is more).
    ObjectClearOfObstacles,
}

/// When a condition must hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Moment {
    /// A pre-condition: at the first motion.
    Start,
    /// At every motion.
    Throughout,
    /// A post-condition: at the last motion.
    End,
}

/// A condition that was checked.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// What must hold.
    pub condition: Condition,
    /// When it must hold.
    pub moment: Moment,
    /// Time of the plan at which it comes nearest to failing, s.
    pub time_s: f64,
    /// The number found then.
    pub found: f64,
    /// The largest number that is accepted.
    pub limit: f64,
}

impl Check {
    /// What is left until the condition fails; negative if it does.
    #[must_use]
    pub fn margin(&self) -> f64 {
        self.limit - self.found
    }

    /// Whether the condition holds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.found <= self.limit
    }
}

impl Condition {
    /// Unit of the number that is checked.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        match self {
            Self::ToolAtRest | Self::ObjectAtRest => "m/s",
            Self::AlongNormal(_) => "rad",
            _ => "m",
        }
    }

    /// What to do if it does not hold.
    pub(super) fn remedy(&self) -> &'static str {
        match self {
            Self::ToolAtRest | Self::ObjectAtRest => "end and begin actions at rest, or raise velocity_m_per_s",
            Self::ObjectStays => "keep the object's track at rest while the tool changes its hold",
            Self::ObjectInPlace => "end the object's track where the push is said to, or raise position_m",
            Self::InContact(_) => "bring the tool nearer with the action before, or raise gap_m",
            Self::OnSurface(_) => "push at another place of the surface, or lengthen it",
            Self::AlongNormal(_) => "push along the surface's normal, or with another surface",
            Self::ToolClearOfObject => "demonstrate wider ways round the object, or raise overlap_m",
            Self::ToolClearOfObstacles => "lead the tool farther from the obstacle",
            Self::ObjectClearOfObstacles => "lead the object farther from the obstacle",
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ToolAtRest => formatter.write_str("the speed of the resting tool"),
            Self::ObjectAtRest => formatter.write_str("the speed of the resting object"),
            Self::ObjectStays => formatter.write_str("the distance of the resting object from where it was"),
            Self::ObjectInPlace => formatter.write_str("the distance of the object from the end of the push"),
            Self::InContact(surface) => write!(formatter, "the gap between the surface '{surface}' and the object"),
            Self::OnSurface(surface) => write!(formatter, "the contact's distance beyond the surface '{surface}'"),
            Self::AlongNormal(surface) => {
                write!(formatter, "the angle of the object's way to the normal of '{surface}'")
            }
            Self::ToolClearOfObject => formatter.write_str("the overlap of tool and object"),
            Self::ToolClearOfObstacles => formatter.write_str("the clearance that the tool lacks from an obstacle"),
            Self::ObjectClearOfObstacles => formatter.write_str("the clearance that the object lacks from an obstacle"),
        }
    }
}

impl fmt::Display for Moment {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Start => "at the start",
            Self::Throughout => "during",
            Self::End => "at the end",
        })
    }
}

/// Poses of tool and object at one time, world frame, and the geometry that is asked of them.
pub(super) struct Scene<'a> {
    pub(super) setting: &'a Setting<'a>,
    pub(super) tool: Isometry2<f64>,
    pub(super) object: Isometry2<f64>,
}

impl Scene<'_> {
    fn center_in_tool(&self) -> Point2<f64> {
        self.tool.inverse_transform_point(&Point2::from(self.object.translation.vector))
    }

    /// Gap between the usable part of a surface and the object, m.
    pub(super) fn gap_m(&self, surface: &ContactSurface) -> f64 {
        let object_from_tool = self.object.inv_mul(&self.tool);
        let distance = |point: &Point2<f64>| self.setting.object.signed_distance_m(&(object_from_tool * point));
        if let Outline::Disc { .. } = self.setting.object {
            return distance(&surface.nearest(&self.center_in_tool()).point);
        }
        let half = surface.length_m() / 2.0;
        least(|place_m| distance(&surface.contact_at(place_m).point), -half, half)
    }

    /// Distance of the contact below the object's center beyond the end of a surface, m; negative on the usable part.
    pub(super) fn beyond_m(&self, surface: &ContactSurface) -> f64 {
        surface.place_m(&self.center_in_tool()).abs() - surface.length_m() / 2.0
    }

    /// Direction of the normal of a surface below the object's center, world frame.
    pub(super) fn normal(&self, surface: &ContactSurface) -> nalgebra::Vector2<f64> {
        self.tool.rotation * surface.nearest(&self.center_in_tool()).normal.into_inner()
    }

    /// Overlap of tool and object, m; negative apart.
    pub(super) fn overlap_m(&self) -> f64 {
        match self.setting.object {
            Outline::Disc { radius_m } => radius_m - self.setting.tool.signed_distance_m(&self.center_in_tool()),
            other => -tool_separation_m(self.setting.tool, &self.tool, other, &self.object),
        }
    }

    /// Clearance that the tool lacks from obstacles, m.
    pub(super) fn tool_lacks_m(&self, tolerances: &ChainTolerances) -> f64 {
        let nearest = self
            .setting
            .obstacles
            .iter()
            .map(|obstacle| tool_separation_m(self.setting.tool, &self.tool, &obstacle.shape, &obstacle.pose()));
        tolerances.clearance_m - nearest.fold(f64::INFINITY, f64::min)
    }

    /// Clearance that the object lacks from obstacles, m.
    pub(super) fn object_lacks_m(&self, tolerances: &ChainTolerances) -> f64 {
        let nearest =
            self.setting.obstacles.iter().filter_map(|obstacle| {
                separation_m(self.setting.object, &self.object, &obstacle.shape, &obstacle.pose())
            });
        tolerances.clearance_m - nearest.fold(f64::INFINITY, f64::min)
    }
}

fn tool_separation_m(tool: &Tool, world_from_tool: &Isometry2<f64>, other: &Outline, pose: &Isometry2<f64>) -> f64 {
    let pieces = tool.pieces.iter();
    pieces
        .filter_map(|piece| separation_m(&piece.shape, &(world_from_tool * piece.pose()), other, pose))
        .fold(f64::INFINITY, f64::min)
}

/// Least value of a function with one valley: along a face, the distance from a convex outline is one.
fn least(value: impl Fn(f64) -> f64, mut lower: f64, mut upper: f64) -> f64 {
    /// The bracket shrinks by a factor 1.618 each time: to a millionth of a surface.
    const ROUNDS: usize = 30;
    let share = (5.0_f64.sqrt() - 1.0) / 2.0;
    let mut places = [upper - share * (upper - lower), lower + share * (upper - lower)];
    let mut values = places.map(&value);
    for _ in 0..ROUNDS {
        if values[0] <= values[1] {
            upper = places[1];
            places = [upper - share * (upper - lower), places[0]];
            values = [value(places[0]), values[0]];
        } else {
            lower = places[0];
            places = [places[1], lower + share * (upper - lower)];
            values = [values[1], value(places[1])];
        }
    }
    values[0].min(values[1])
}

/// Angle between two directions in the plane, rad; rotations by a whole turn are none.
pub(super) fn angle_rad(from: &nalgebra::Vector2<f64>, to: &nalgebra::Vector2<f64>) -> f64 {
    UnitComplex::rotation_between(from, to).angle().abs()
}
