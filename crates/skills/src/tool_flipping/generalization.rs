//! The generalization of a tool flip, Eq. (28), free of collisions between its samples too.
//!
//! Departs from the paper: Eq. (28) is written for the object's center in the tool's frame, q = R(θ)ᵀ(c − p), so that tool
//! and object may be of any outline and the tool may turn: q = x^t + k2·(x^o − x0) with k1 = I, x^o the virtual object
//! movement, g^t = x0 + (1 − k2)·(q_B − q_A) from Eq. (39), and p = c − R(θ)·q. Enlarging k2 alone does not free a flip
//! whose x^o leaves a contact sideways; here x^o leaves along the normals, in the time law of x^t.

use nalgebra::{Isometry2, UnitComplex, Vector2};

use super::certificate::{Checked, FlipCertificate};
use super::clearance::Bodies;
use super::learning::{OwnWay, ToolFlip};
use super::options::{FlipOptions, WayRound};
use super::refusal::FlipError;
use super::search::{Parts, Search};
use super::virtual_motion::{Hold, VirtualMotion};
use super::way::Way;
use crate::error::SkillError;
use crate::field::{FieldError, finite, positive};
use crate::outline::Outline;
use crate::plan::{PlanarMotion, Track};
use crate::tool::{Contact, Tool};

/// Change of contact that is wanted of a tool while the object rests.
#[derive(Debug, Clone, Copy)]
pub struct FlipTask<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// Outline of the object.
    pub object: &'a Outline,
    /// Pose of the object: `world_from_object`.
    pub object_world: Isometry2<f64>,
    /// Contacts of the tool before and after the flip, in its frame.
    pub contacts: [Contact; 2],
    /// Angles of the tool in the world before and after the flip, rad; it turns by their difference.
    pub tool_angles_rad: [f64; 2],
    /// Duration of the flip, s.
    pub duration_s: f64,
}

/// Flip of a tool round a resting object, certified to be free of collisions.
#[derive(Debug, Clone, PartialEq)]
pub struct Flip {
    /// Factor k2 of Eq. (28).
    pub k2: f64,
    /// Part of the tool's own way x^t that was kept, in [0, 1]: it fades where it leads into the tool.
    pub own_share: f64,
    /// Sense in which the object's center goes round the tool.
    pub way_round: WayRound,
    /// Length of the virtual object movement x^o, m.
    pub virtual_length_m: f64,
    /// Clearance that is certified.
    pub certificate: FlipCertificate,
    way: Way,
    object_world: Isometry2<f64>,
    duration_s: f64,
}

impl FlipTask<'_> {
    /// Generalizes without a demonstration, Eq. (28) with x^t a straight line: the virtual object movement alone.
    ///
    /// # Errors
    /// A [`FlipError`] that says what is in the way, with numbers.
    pub fn flip(&self, options: &FlipOptions) -> Result<Flip, FlipError> {
        self.solve(None, options)
    }

    /// Generalizes with the tool's own way of `skill`, if there is one.
    pub(super) fn solve(&self, skill: Option<&ToolFlip>, options: &FlipOptions) -> Result<Flip, FlipError> {
        options.validate()?;
        self.validate()?;
        let bodies = Bodies::new(self.tool, self.object)?;
        let holds = self.holds(&bodies);
        // half of the tolerance is for the contacts as given, half for what a bound misses
        let tolerance_m = 0.5 * options.contact_tolerance_m;
        for (hold, end) in holds.iter().zip(["first", "second"]) {
            let depth_m = -bodies.gap(&hold.center, hold.angle_rad).distance_m;
            if depth_m > tolerance_m {
                return Err(FlipError::ContactOverlaps { end, depth_m, tolerance_m });
            }
        }
        let object = VirtualMotion::new(&bodies, &holds, options.margin_m, options.way_round)?;
        let own = match skill {
            Some(skill) => skill.own_way(&(holds[1].center - holds[0].center), object.way_round, options)?,
            None => OwnWay::straight(),
        };
        let parts = Parts::new(&holds, &object, own);
        let search = Search { bodies: &bodies, parts: &parts, lifting: object.lifting, options };
        let (found, samples) = search.run()?;
        let checked = Checked { bodies: &bodies, way: &found.way, resolution_m: tolerance_m };
        let certificate = checked.certificate(samples);
        Ok(Flip {
            k2: found.k2,
            own_share: found.share,
            way_round: object.way_round,
            virtual_length_m: object.length_m,
            certificate,
            way: found.way,
            object_world: self.object_world,
            duration_s: self.duration_s,
        })
    }

    fn validate(&self) -> Result<(), FieldError> {
        positive("duration_s", self.duration_s)?;
        finite("tool_angles_rad", &self.tool_angles_rad)?;
        let pose = self.object_world;
        finite("object_world", &[pose.translation.x, pose.translation.y, pose.rotation.angle()])?;
        for (index, contact) in self.contacts.iter().enumerate() {
            let numbers = [contact.point.x, contact.point.y, contact.normal.x, contact.normal.y];
            finite(&format!("contacts.{index}"), &numbers)?;
        }
        Ok(())
    }

    /// Where the object touches the tool, its origin on the normal of the contact.
    fn holds(&self, bodies: &Bodies) -> [Hold; 2] {
        let hold = |contact: &Contact, tool_angle_rad: f64| {
            let normal = contact.normal.into_inner();
            let angle_rad = self.object_world.rotation.angle() - tool_angle_rad;
            let center = contact.point + normal * bodies.support_m(&-normal, angle_rad);
            Hold { center, normal, angle_rad }
        };
        let ([first, second], [from, to]) = (&self.contacts, self.tool_angles_rad);
        [hold(first, from), hold(second, to)]
    }
}

impl Flip {
    /// Duration, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Returns the same flip at another speed; its way and its certificate do not depend on the duration.
    ///
    /// # Errors
    /// A [`FlipError`] if the duration is not positive.
    pub fn with_duration_s(self, duration_s: f64) -> Result<Self, FlipError> {
        positive("duration_s", duration_s)?;
        Ok(Self { duration_s, ..self })
    }

    /// Evaluates the object's motion in the tool's frame (x, y in m, angle in rad) at a time, s; at rest outside.
    #[must_use]
    pub fn object_in_tool(&self, time_s: f64) -> PlanarMotion {
        let ratio = time_s / self.duration_s;
        let motion = self.way.at(ratio);
        if !(0.0..=1.0).contains(&ratio) {
            return PlanarMotion::at_rest(motion.position);
        }
        let rate = self.duration_s.recip();
        PlanarMotion {
            position: motion.position,
            velocity: motion.velocity * rate,
            acceleration: motion.acceleration * (rate * rate),
        }
    }

    /// Evaluates the tool's motion in the world, p = c − R(θ)·q, at a time, s; at rest outside.
    #[must_use]
    pub fn tool_in_world(&self, time_s: f64) -> PlanarMotion {
        let object = self.object_in_tool(time_s);
        let left = |v: Vector2<f64>| Vector2::new(-v.y, v.x);
        let (q, dq, ddq) = (object.position.xy(), object.velocity.xy(), object.acceleration.xy());
        let angle_rad = self.object_world.rotation.angle() - object.position.z;
        let (spin, spin_rate) = (-object.velocity.z, -object.acceleration.z);
        let rotation = UnitComplex::new(angle_rad);
        let position = self.object_world.translation.vector - rotation * q;
        let velocity = rotation * -(left(q) * spin + dq);
        let acceleration = rotation * -(left(q) * spin_rate - q * (spin * spin) + left(dq) * (2.0 * spin) + ddq);
        PlanarMotion {
            position: position.push(angle_rad),
            velocity: velocity.push(spin),
            acceleration: acceleration.push(spin_rate),
        }
    }

    /// Samples the tool's motion every `time_step_s`, world frame; the last sample is the first one at rest at the end.
    ///
    /// # Errors
    /// A [`SkillError`] if the step is not positive, or so short that there are more than a million.
    pub fn tool_track(&self, time_step_s: f64) -> Result<Track, SkillError> {
        let steps = (self.duration_s / time_step_s - WHOLE_STEP).ceil();
        if !(time_step_s > 0.0 && (1.0..=MOST_STEPS).contains(&steps)) {
            return Err(SkillError::InvalidArgument {
                operation: "sample flip",
                argument: "time_step_s",
                found: time_step_s,
                expected: "at most the duration and at least a millionth of it",
            });
        }
        let at = |step: usize| self.tool_in_world((step as f64 * time_step_s).min(self.duration_s));
        Track::new(time_step_s, (0..=steps as usize).map(at).collect())
    }
}

/// Part of a step below which the duration counts as a whole number of steps.
const WHOLE_STEP: f64 = 1e-6;
/// Most steps of a track.
const MOST_STEPS: f64 = 1e6;
