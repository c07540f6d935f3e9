//! What a plan takes place among, and the tolerances of its verification.

use serde::{Deserialize, Serialize};

use crate::field::{FieldError, not_negative, within};
use crate::outline::{Outline, PlacedOutline};
use crate::tool::Tool;

/// Tool, object and obstacles that a plan is meant for.
#[derive(Clone, Copy, Debug)]
pub struct Setting<'a> {
    /// The tool that follows the plan.
    pub tool: &'a Tool,
    /// Outline of the object about its center.
    pub object: &'a Outline,
    /// Obstacles, world frame.
    pub obstacles: &'a [PlacedOutline],
}

impl Setting<'_> {
    /// Checks tool, outline and obstacles.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.tool.validate().map_err(|error| error.within("tool"))?;
        self.object.validate().map_err(|error| error.within("object"))?;
        for (index, obstacle) in self.obstacles.iter().enumerate() {
            obstacle.validate().map_err(|error| error.within(format!("obstacles.{index}")))?;
        }
        Ok(())
    }
}

/// How far a plan may be from strict continuity and from its conditions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ChainTolerances {
    /// Jump of a place, m; the default is the repeatability of a common arm.
    pub position_m: f64,
    /// Jump of an angle, rad; the default moves the tip of a tool of 0.1 m by as much as `position_m`.
    pub angle_rad: f64,
    /// Jump of a velocity and speed of what rests, m/s; the default, within one cycle of 1 ms, asks for 1 m/s².
    pub velocity_m_per_s: f64,
    /// Jump of an angular velocity and angular speed of what rests, rad/s; the default as `angle_rad` on 0.1 m.
    pub angular_velocity_rad_per_s: f64,
    /// Largest gap between a surface and the object that it pushes, m; the default is the gap that an approach leaves, 1 mm,
    /// with the tolerance of its place.
    pub gap_m: f64,
    /// Overlap of tool and object, m. A learned way begins and ends in touch and errs there by tenths of a millimeter; the
    /// default is half of the gap that an approach leaves, which the contact of object and tool yields to.
    pub overlap_m: f64,
    /// Distance of a contact beyond the end of its surface, m; the default is that of places given in files.
    pub beyond_surface_m: f64,
    /// Largest angle between the object's velocity and the normal that pushes it, rad; left out: the tool's friction angle.
    pub push_angle_rad: Option<f64>,
    /// Share of the object's largest speed below which its direction is not looked at: at rest it has none.
    pub least_speed_share: f64,
    /// Distance to keep from obstacles, m.
    pub clearance_m: f64,
}

impl Default for ChainTolerances {
    fn default() -> Self {
        Self {
            position_m: 1e-4,
            angle_rad: 1e-3,
            velocity_m_per_s: 1e-3,
            angular_velocity_rad_per_s: 1e-2,
            gap_m: 1.1e-3,
            overlap_m: 5e-4,
            beyond_surface_m: 1e-4,
            push_angle_rad: None,
            least_speed_share: 0.1,
            clearance_m: 0.0,
        }
    }
}

impl ChainTolerances {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending tolerance.
    pub fn validate(&self) -> Result<(), FieldError> {
        for (field, value) in [
            ("position_m", self.position_m),
            ("angle_rad", self.angle_rad),
            ("velocity_m_per_s", self.velocity_m_per_s),
            ("angular_velocity_rad_per_s", self.angular_velocity_rad_per_s),
            ("gap_m", self.gap_m),
            ("overlap_m", self.overlap_m),
            ("beyond_surface_m", self.beyond_surface_m),
            ("clearance_m", self.clearance_m),
        ] {
            not_negative(field, value)?;
        }
        within("least_speed_share", self.least_speed_share, 0.0, 1.0)?;
        self.push_angle_rad.map_or(Ok(()), |angle| within("push_angle_rad", angle, 0.0, std::f64::consts::PI))
    }
}
