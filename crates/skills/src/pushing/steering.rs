//! Steering a push: velocity of the tool that brings the object back to its line and keeps it on the contact surface.
//!
//! Quasi-static law of a disc that rolls on the tool without slipping: of a motion of the tool along the contact's tangent
//! the object keeps 1/(1 + R²/c²), the rest turns the line of contact. With u the lateral offset of the object's center
//! from the middle of the contact surface, e its deviation from its line, v the speed of the push along the contact's
//! normal, v_t the tool's along its tangent, and 1/ρ the relative curvature of tool and object,
//! u̇ = −κ v_t and ė = v u/ρ + (1 − κ) v_t with κ = 1/(1 + c²/R²).
//!
//! A round tool that goes straight ahead slides back by v_t = −v u/ρ along the leaning tangent: the offset grows with an
//! e-folding length ρ/κ. It is stabilized by v_t = v (u − uᵈ)/(κ l), where uᵈ = −e ρ/L leads the object back to its line.
//! That is stable for L > ρ (1 − κ)/κ: what the tool drags along must not outrun what the lean brings back.
//!
//! On a face 1/ρ = 0 and e + u (1 − κ)/κ stays what it is: rolling trades one for the other. Of either, half is left.

use nalgebra::{Point2, Unit, Vector2};
use serde::{Deserialize, Serialize};

use crate::field::{FieldError, positive, within};

/// Gains of the steering law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SteeringConfig {
    /// Way of the push over which an offset on the surface fades, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub offset_length_m: f64,
    /// Way of the push over which a deviation from the line fades on a round surface, m; longer where that is unstable.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub line_length_m: f64,
    /// Largest offset that is asked for, as a share of what the surface allows.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub offset_share: f64,
    /// Largest tangential velocity of the tool, as a share of the speed of the push.
    #[schemars(range(min = 0.0, max = 10.0))]
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
    /// What the surface leaves to the left of where the object is held, m.
    left_m: f64,
    /// What it leaves to the right, m.
    right_m: f64,
    /// Distance of the object's center from the contact, m.
    object_radius_m: f64,
    /// κ: share of a motion of the tool along the contact's tangent that turns the line of contact.
    rolling_share: f64,
    /// (1 − κ)/κ: way that the object is dragged along per change of its offset.
    pub(super) drag: f64,
}

/// What the tool should do now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteeringCommand {
    /// Velocity of the tool, world axes, m/s.
    pub velocity_world: Vector2<f64>,
    /// Lateral offset of the object's center from where it is to be held, m: positive to the left of the push.
    pub offset_m: f64,
    /// Deviation of the object's center from its line, m: positive to the left of the push.
    pub deviation_m: f64,
}

impl Steering {
    /// Prepares a push along the line through `line_point` in `direction`.
    ///
    /// `surface_radius_m` and `half_length_m` belong to the contact surface, in whose middle the object is held;
    /// `object_radius_m` and `friction_length_m` (moment-to-force ratio c of the support friction) to the object.
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
        let drag = ratio * ratio;
        Self {
            config,
            line_point,
            direction,
            surface_radius_m,
            left_m: half_length_m,
            right_m: half_length_m,
            object_radius_m,
            rolling_share,
            drag,
        }
    }

    /// Returns the same push with the object held `place_m` off the middle of the surface, m: positive to the left.
    #[must_use]
    pub fn held_at(self, place_m: f64) -> Self {
        // a hold beyond the end has no room on that side
        Self { left_m: (self.left_m - place_m).max(0.0), right_m: (self.right_m + place_m).max(0.0), ..self }
    }

    /// Velocity of a tool that should hold the object at `contact` with outward `normal`, for an object at `center`.
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
        let lean = self.reach_m().map_or(0.0, |reach_m| offset_m / reach_m);
        let (normal, tangent) = leaned(lean, normal, &tangent);
        let slope = (offset_m - self.wanted_offset_m(deviation_m)) / (self.rolling_share * self.config.offset_length_m);
        let slope = limited(slope, self.config.largest_slope);
        SteeringCommand { velocity_world: (normal + tangent * slope) * speed_m_per_s, offset_m, deviation_m }
    }

    /// ρ: signed distance of the object's center from the center of a round surface, m; `None` where the object cannot lean.
    pub(super) fn reach_m(&self) -> Option<f64> {
        let reach_m = self.surface_radius_m + self.object_radius_m;
        (reach_m.is_finite() && reach_m.abs() > SOCKET_M).then_some(reach_m)
    }

    /// uᵈ: the offset at which the object should be held to come back to its line, within what the surface allows, m.
    pub(super) fn wanted_offset_m(&self, deviation_m: f64) -> f64 {
        match self.reach_m() {
            Some(reach_m) => {
                // the object moves along the line of centers: lean it back to the line
                let length_m = self.config.line_length_m.max(STABLE_MARGIN * self.drag * reach_m);
                self.within_room_m(-deviation_m * reach_m / length_m)
            }
            // on a face only rolling moves the object sideways, by the drag that its offset costs
            None if self.rolls_on_a_face() => self.within_room_m(deviation_m / self.drag),
            None => 0.0,
        }
    }

    /// Whether the object rolls, and on something straight.
    pub(super) fn rolls_on_a_face(&self) -> bool {
        self.surface_radius_m.is_infinite() && self.drag > 0.0
    }

    /// Offset per way along the surface: on a round one the object's center goes farther than the contact.
    fn offset_per_place(&self) -> f64 {
        self.reach_m().map_or(1.0, |reach_m| (reach_m / self.surface_radius_m).abs())
    }

    /// The offset, limited to the share of the surface that may be asked for, m.
    pub(super) fn within_room_m(&self, offset_m: f64) -> f64 {
        let share = self.config.offset_share * self.offset_per_place();
        offset_m.max(-share * self.right_m).min(share * self.left_m)
    }

    /// How far the contact lies beyond the usable surface, m; negative within it.
    pub(super) fn overhang_m(&self, offset_m: f64) -> f64 {
        let place_m = offset_m / self.offset_per_place();
        (place_m - self.left_m).max(-place_m - self.right_m)
    }

    /// Whether the surface bulges, so that a tool that backs off can go sideways past the object.
    pub(super) fn bulges(&self) -> bool {
        self.surface_radius_m > 0.0 && self.surface_radius_m.is_finite()
    }
}

/// A hollow that fits the object to this length is a socket, m: in it nothing rolls.
const SOCKET_M: f64 = 0.001;
/// The line length is at least this many times the one at which the law becomes unstable.
const STABLE_MARGIN: f64 = 2.0;

/// The value, its magnitude at most `largest`.
fn limited(value: f64, largest: f64) -> f64 {
    value.max(-largest.abs()).min(largest.abs())
}

/// Normal and tangent turned to the left by an angle of the given sine.
fn leaned(sine: f64, normal: &Unit<Vector2<f64>>, tangent: &Vector2<f64>) -> (Vector2<f64>, Vector2<f64>) {
    let sine = limited(sine, 1.0);
    let cosine = (1.0 - sine * sine).sqrt();
    let leaned = normal.into_inner() * cosine + tangent * sine;
    (leaned, Vector2::new(-leaned.y, leaned.x))
}

#[cfg(test)]
#[path = "steering_tests.rs"]
mod tests;
