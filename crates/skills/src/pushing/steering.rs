//! Steering a push: velocity of the tool that brings the object back to its line and keeps it on the contact surface.
//!
//! Quasi-static law of a disc that rolls on the tool without slipping: of a lateral motion of the tool the object keeps
//! 1/(1 + R²/c²), the rest turns the line of contact. With u the lateral offset of the object's center from the middle
//! of the contact surface, v the speed of the push and 1/ρ the relative curvature of tool and object,
//! u̇ = κ v u/ρ − κ v_t and ė = v u/ρ + (1 − κ) v_t with κ = 1/(1 + c²/R²). A round tool on a disc is thus unstable with
//! an e-folding length ρ/κ; it is stabilized by v_t = (k/κ)(u − uᵈ), where uᵈ leads the object back to its line.

use nalgebra::{Point2, Unit, Vector2};
use serde::{Deserialize, Serialize};

use crate::field::{FieldError, positive, within};

/// Gains of the steering law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SteeringConfig {
    /// Way of the push over which an offset on the surface fades, m.
    pub offset_length_m: f64,
    /// Way of the push over which a deviation from the line fades, m.
    pub line_length_m: f64,
    /// Largest offset that is asked for, as a share of what the surface allows.
    pub offset_share: f64,
    /// Largest tangential velocity of the tool, as a share of the speed of the push.
    pub largest_slope: f64,
}

impl Default for SteeringConfig {
    fn default() -> Self {
        Self { offset_length_m: 0.010, line_length_m: 0.020, offset_share: 0.9, largest_slope: 0.6 }
    }
}

impl SteeringConfig {
    /// Checks the gains.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("offset_length_m", self.offset_length_m)?;
        positive("line_length_m", self.line_length_m)?;
        within("offset_share", self.offset_share, 0.0, 1.0)?;
        within("largest_slope", self.largest_slope, 0.0, 10.0)
    }
}

/// What is known about one push.
#[derive(Clone, Debug, PartialEq)]
pub struct Steering {
    config: SteeringConfig,
    /// A point of the line along which the object should go, world frame, m.
    line_point: Point2<f64>,
    /// Direction of that line.
    direction: Unit<Vector2<f64>>,
    /// Signed radius of the contact surface, m: infinite for a face.
    surface_radius_m: f64,
    /// Half of the surface's usable length, m.
    half_length_m: f64,
    /// Distance of the object's center from the contact, m.
    object_radius_m: f64,
    /// κ: share of a lateral motion of the tool that turns the line of contact.
    rolling_share: f64,
}

/// What the tool should do now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteeringCommand {
    /// Velocity of the tool, world axes, m/s.
    pub velocity_world: Vector2<f64>,
    /// Lateral offset of the object's center from the middle of the surface, m: positive to the left of the push.
    pub offset_m: f64,
    /// Deviation of the object's center from its line, m: positive to the left of the push.
    pub deviation_m: f64,
}

impl Steering {
    /// Prepares a push along the line through `line_point` in `direction`.
    ///
    /// `surface_radius_m` and `half_length_m` belong to the contact surface, `object_radius_m` and
    /// `friction_length_m` (moment-to-force ratio c of the support friction) to the object.
    #[must_use]
    pub fn new(
        config: &SteeringConfig,
        line_point: Point2<f64>,
        direction: Unit<Vector2<f64>>,
        surface_radius_m: f64,
        half_length_m: f64,
        object_radius_m: f64,
        friction_length_m: f64,
    ) -> Self {
        let ratio = friction_length_m / object_radius_m;
        let rolling_share = 1.0 / (1.0 + ratio * ratio);
        let config = config.clone();
        Self { config, line_point, direction, surface_radius_m, half_length_m, object_radius_m, rolling_share }
    }

    /// Velocity of the tool for an object at `center` whose surface's middle is at `contact` with outward `normal`.
    #[must_use]
    pub fn command(
        &self,
        contact: &Point2<f64>,
        normal: &Unit<Vector2<f64>>,
        center: &Point2<f64>,
        speed_m_per_s: f64,
    ) -> SteeringCommand {
        let tangent = Vector2::new(-normal.y, normal.x);
        let left = Vector2::new(-self.direction.y, self.direction.x);
        let offset_m = (center - contact).dot(&tangent);
        let deviation_m = (center - self.line_point).dot(&left);
        let reach = self.surface_radius_m + self.object_radius_m;
        let curved = self.surface_radius_m.is_finite();
        // lateral offset that the surface's ends allow
        let largest = self.config.offset_share
            * if curved { self.half_length_m * reach / self.surface_radius_m } else { self.half_length_m };
        let wanted = if curved {
            // the object moves along the line of centers: lean it back to the line
            -deviation_m * reach / self.config.line_length_m
        } else {
            // on a face only rolling moves the object sideways, by (1 - kappa)/kappa of the offset that it costs
            deviation_m * self.rolling_share / (1.0 - self.rolling_share)
        };
        let wanted = wanted.clamp(-largest.abs(), largest.abs());
        let slope = (offset_m - wanted) / (self.rolling_share * self.config.offset_length_m);
        let slope = slope.clamp(-self.config.largest_slope, self.config.largest_slope);
        let across =
            if curved { self.lean(offset_m / reach, normal, &tangent) } else { (normal.into_inner(), tangent) };
        let velocity_world = (across.0 + across.1 * slope) * speed_m_per_s;
        SteeringCommand { velocity_world, offset_m, deviation_m }
    }

    /// Normal and tangent where the object touches a curved surface, from its offset in units of the reach.
    fn lean(&self, sine: f64, normal: &Unit<Vector2<f64>>, tangent: &Vector2<f64>) -> (Vector2<f64>, Vector2<f64>) {
        let sine = sine.clamp(-1.0, 1.0);
        let cosine = (1.0 - sine * sine).sqrt();
        let leaned = normal.into_inner() * cosine + tangent * sine;
        (leaned, Vector2::new(-leaned.y, leaned.x))
    }
}
