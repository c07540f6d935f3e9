//! Where the object is now, from late and biased sightings and from what the tool has done since.
//!
//! An extended Kalman filter over the object's center and the camera's constant bias. The tool's own motion is known at
//! once and carries the belief along as quasi-static pushing does: out of the tool along the contact normal, and along
//! with a lateral motion of the tool by the share that rolling leaves. A sighting corrects the belief of the moment at
//! which it was exposed. The bias shows itself in contact, where the camera and the tool's outline disagree.

use nalgebra::{Isometry2, Matrix2, Matrix4, Point2, SMatrix, Vector2, Vector4};
use skills::tool::Tool;

use crate::sensing::{CameraConfig, Sighting};

/// Sightings later than this many standard deviations of the latency are not believed.
const LATEST_JITTERS: f64 = 6.0;
/// Uncertainty of the first belief, m: where a task says that the object starts.
const START_SD_M: f64 = 0.003;
/// Error of the pushing model per way of the tool: unknown friction and slip.
const MODEL_ERROR: f64 = 0.1;
/// Smallest standard deviation of a sighting, m: no camera is perfect.
const LEAST_NOISE_M: f64 = 1e-5;
/// Step of numerical derivatives, m.
const STEP_M: f64 = 1e-6;

/// A belief about the object's center and the camera's bias.
#[derive(Clone, Debug)]
pub struct Tracker {
    tool: Tool,
    object_radius_m: f64,
    /// Share of a lateral motion of a touching tool that the object follows.
    follow_share: f64,
    noise_m: f64,
    /// Center (x, y) and bias (x, y), m.
    belief: Vector4<f64>,
    covariance: Matrix4<f64>,
    last_tool: Option<Isometry2<f64>>,
    history: Vec<Vector4<f64>>,
    period_s: f64,
    ticks: usize,
    last_exposed_s: f64,
}

impl Tracker {
    /// Starts from the belief that the object is at `object_world`; [`Tracker::advance`] is called every `period_s`.
    ///
    /// `friction_length_m` is the moment-to-force ratio of the object's support friction; `camera` says how far
    /// sightings can be trusted.
    #[must_use]
    pub fn new(
        tool: &Tool,
        object_radius_m: f64,
        friction_length_m: f64,
        object_world: Point2<f64>,
        camera: &CameraConfig,
        period_s: f64,
    ) -> Self {
        let ratio = object_radius_m / friction_length_m;
        let belief = Vector4::new(object_world.x, object_world.y, 0.0, 0.0);
        let bias_m = camera.bias_m.max(LEAST_NOISE_M);
        let spread = Vector4::new(START_SD_M, START_SD_M, bias_m, bias_m);
        Self {
            tool: tool.clone(),
            object_radius_m,
            follow_share: 1.0 / (1.0 + ratio * ratio),
            noise_m: camera.noise_m.max(LEAST_NOISE_M),
            belief,
            covariance: Matrix4::from_diagonal(&spread.component_mul(&spread)),
            last_tool: None,
            history: vec![belief; beliefs_kept(camera, period_s)],
            period_s,
            ticks: 0,
            last_exposed_s: f64::NEG_INFINITY,
        }
    }

    /// Where the object's center is believed to be, world frame.
    #[must_use]
    pub fn object_world(&self) -> Point2<f64> {
        Point2::new(self.belief.x, self.belief.y)
    }

    /// Bias that the camera is believed to have, world axes, m.
    #[must_use]
    pub fn camera_bias_m(&self) -> Vector2<f64> {
        Vector2::new(self.belief.z, self.belief.w)
    }

    /// Lets a period pass in which the tool came to `world_from_tool`, and hears of the newest sighting.
    pub fn advance(&mut self, time_s: f64, world_from_tool: &Isometry2<f64>, sighting: Option<&Sighting>) {
        self.predict(world_from_tool);
        self.ticks += 1;
        let slot = self.ticks % self.history.len();
        if let Some(belief) = self.history.get_mut(slot) {
            *belief = self.belief;
        }
        if let Some(sighting) = sighting.filter(|sighting| sighting.exposed_s > self.last_exposed_s) {
            self.last_exposed_s = sighting.exposed_s;
            self.correct(time_s, sighting);
        }
    }

    /// What the tool's motion does to the object and to what is known of it.
    fn predict(&mut self, world_from_tool: &Isometry2<f64>) {
        let last = self.last_tool.replace(*world_from_tool).unwrap_or(*world_from_tool);
        let at = self.object_world();
        let Some(next) = self.pushed(&at, &last, world_from_tool) else { return };
        let shifted = |offset: Vector2<f64>| {
            let from = at + offset;
            self.pushed(&from, &last, world_from_tool).unwrap_or(from)
        };
        let slope = |axis: Vector2<f64>| (shifted(axis * STEP_M) - shifted(-axis * STEP_M)) / (2.0 * STEP_M);
        let jacobian = Matrix2::from_columns(&[slope(Vector2::x()), slope(Vector2::y())]);
        let mut transition = Matrix4::identity();
        transition.fixed_view_mut::<2, 2>(0, 0).copy_from(&jacobian);
        let moved = MODEL_ERROR * (next - at).norm();
        self.covariance = transition * self.covariance * transition.transpose();
        // an error of the model in each period is independent of the last one's: variances add per way, not per period
        let variance = moved * moved.max(MODEL_ERROR * CORRELATION_M);
        self.covariance[(0, 0)] += variance;
        self.covariance[(1, 1)] += variance;
        self.belief.x = next.x;
        self.belief.y = next.y;
    }

    /// Where an object at `at` is after the tool has moved; `None` if the tool does not touch it.
    fn pushed(&self, at: &Point2<f64>, last: &Isometry2<f64>, now: &Isometry2<f64>) -> Option<Point2<f64>> {
        let in_tool = now.inverse_transform_point(at);
        let overlap = self.object_radius_m - self.tool.signed_distance_m(&in_tool);
        if overlap <= 0.0 {
            return None;
        }
        let normal = now.rotation * self.outward(&in_tool);
        let tangent = Vector2::new(-normal.y, normal.x);
        let moved = (now * in_tool) - (last * in_tool);
        Some(at + normal * overlap + tangent * (moved.dot(&tangent) * self.follow_share))
    }

    /// Gradient of the tool's distance at a point in its frame.
    fn outward(&self, point: &Point2<f64>) -> Vector2<f64> {
        let slope = |offset: Vector2<f64>| {
            self.tool.signed_distance_m(&(point + offset)) - self.tool.signed_distance_m(&(point - offset))
        };
        let gradient = Vector2::new(slope(Vector2::x() * STEP_M), slope(Vector2::y() * STEP_M));
        gradient.try_normalize(0.0).unwrap_or_else(Vector2::y)
    }

    /// Corrects the belief, and all beliefs since the exposure, by what a sighting shows.
    fn correct(&mut self, time_s: f64, sighting: &Sighting) {
        let age = ((time_s - sighting.exposed_s) / self.period_s).round().max(0.0) as usize;
        let kept = self.history.len();
        if age >= kept {
            return;
        }
        let slot = (self.ticks + kept - age.min(self.ticks)) % kept;
        let Some(then) = self.history.get(slot) else { return };
        let expected = Vector2::new(then.x + then.z, then.y + then.w);
        let surprise = sighting.world_from_object.translation.vector - expected;
        // a sighting shows center and bias together
        let seen = SMatrix::<f64, 2, 4>::new(1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0);
        let spread = seen * self.covariance * seen.transpose() + Matrix2::identity() * (self.noise_m * self.noise_m);
        let Some(inverse) = spread.try_inverse() else { return };
        let gain = self.covariance * seen.transpose() * inverse;
        let shift = gain * surprise;
        let keep = Matrix4::identity() - gain * seen;
        // Joseph's form keeps the covariance symmetric and positive
        let noise = gain * gain.transpose() * (self.noise_m * self.noise_m);
        self.covariance = keep * self.covariance * keep.transpose() + noise;
        self.belief += shift;
        for belief in &mut self.history {
            *belief += shift;
        }
    }
}

/// Beliefs that late sightings are compared with: one per period, for as long as a frame may be on its way.
fn beliefs_kept(camera: &CameraConfig, period_s: f64) -> usize {
    // one frame may wait for the next period, and one belief is the present
    ((camera.latency_s + LATEST_JITTERS * camera.jitter_s + 1.0 / camera.rate_hz) / period_s).ceil() as usize + 2
}

/// Errors of the pushing model are alike over this way, m.
const CORRELATION_M: f64 = 0.001;
