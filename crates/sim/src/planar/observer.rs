//! What an onlooker of a planar run is told: the scene once, a sample per control period, events as they happen.

use nalgebra::{Isometry2, Point2};
use skills::tool::Tool;

use super::config::{ObjectConfig, WorldConfig};
use super::contact::ContactForce;

/// The scene, told once before the first sample.
#[derive(Clone, Debug)]
pub struct SceneDescription {
    /// Map and obstacles.
    pub world: WorldConfig,
    /// The object.
    pub object: ObjectConfig,
    /// The tool.
    pub tool: Tool,
    /// The arm.
    pub arm: ArmDescription,
    /// Names of the plan's actions in their order; a sample's `phase` is an index into them.
    pub phases: Vec<String>,
    /// Planned path of the tool's origin, world frame.
    pub tool_path_world: Vec<Point2<f64>>,
    /// Expected path of the object's center, world frame.
    pub object_path_world: Vec<Point2<f64>>,
    /// Where the object is wanted at the end, world frame.
    pub goal_world: Point2<f64>,
    /// Time between two samples, s.
    pub control_period_s: f64,
}

/// The arm as an onlooker draws and labels it.
#[derive(Clone, Debug, Default)]
pub struct ArmDescription {
    /// Joint names.
    pub joints: Vec<String>,
    /// Largest torque of each joint, N m.
    pub torque_limits_nm: Vec<f64>,
}

/// State of a run at one control instant.
#[derive(Clone, Debug)]
pub struct Sample<'a> {
    /// Number of the control period, from 0.
    pub step: u64,
    /// Simulated time, s.
    pub time_s: f64,
    /// Index of the current action.
    pub phase: usize,
    /// Pose of the tool.
    pub world_from_tool: Isometry2<f64>,
    /// Where the tool should be.
    pub world_from_tool_reference: Isometry2<f64>,
    /// Pose of the object.
    pub world_from_object: Isometry2<f64>,
    /// Where the plan expects the object.
    pub world_from_object_expected: Isometry2<f64>,
    /// What the camera showed last; `None` before its first frame.
    pub world_from_object_seen: Option<Isometry2<f64>>,
    /// Where a steering controller believes the object to be; `None` if none is at work.
    pub object_believed_world: Option<Point2<f64>>,
    /// Joint positions, rad.
    pub q_rad: &'a [f64],
    /// Joint velocities, rad/s.
    pub dq_rad_per_s: &'a [f64],
    /// Desired joint positions, rad.
    pub q_reference_rad: &'a [f64],
    /// Torques sent to the joints, N m.
    pub torque_nm: &'a [f64],
    /// Origins of the arm's joints and of its flange, world frame, from base to tip.
    pub joint_points_world: &'a [Point2<f64>],
    /// Contact forces of the last time step.
    pub contacts: &'a [ContactForce],
}

/// Something worth a line in a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Simulated time, s.
    pub time_s: f64,
    /// How much it matters.
    pub level: EventLevel,
    /// What happened, one sentence.
    pub text: String,
}

/// How much an event matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventLevel {
    /// Expected course: an action begins, a contact is made.
    Info,
    /// Unwanted, but the run goes on: a contact was lost, a torque limit was reached.
    Warning,
    /// The run cannot succeed any more.
    Error,
}

/// An onlooker of a planar run; every method may be left out.
///
/// Observers must not block: whoever writes or streams does so on a thread or into buffers of its own.
pub trait Observer {
    /// The scene, before the first sample.
    fn begin(&mut self, _scene: &SceneDescription) {}
    /// The state at a control instant.
    fn sample(&mut self, _sample: &Sample<'_>) {}
    /// Something worth a line in a log.
    fn event(&mut self, _event: &Event) {}
}

impl Observer for () {}
