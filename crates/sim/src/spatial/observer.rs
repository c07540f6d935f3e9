//! What an onlooker of a spatial run is told: the scene once, a sample per control period, events and new bodies as they come.

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector6};

use super::drawing::{Drawing, Rgba};

pub use crate::planar::{Event, EventLevel};

/// The scene, told once before the first sample.
#[derive(Clone, Debug, Default)]
pub struct SceneDescription {
    /// What never moves: table, board, containers; placed in the world.
    pub fixed: Vec<Drawing>,
    /// The arm with its tool.
    pub arm: ArmDescription,
    /// Bodies that the task moves, at their start; see [`Observer::bodies`].
    pub bodies: Vec<BodyDrawing>,
    /// The grains, if there are any.
    pub grains: Option<GrainDescription>,
    /// Curves that the task adds to a sample's `series`, in their order.
    pub series: Vec<Series>,
    /// Titles of those of the series' plots that matter most; the first ones if empty.
    pub main_plots: Vec<String>,
    /// Places that the tool is wanted at.
    pub targets_world: Vec<Target>,
    /// Names of the plan's actions in their order; a sample's `phase` is an index into them.
    pub phases: Vec<String>,
    /// Planned path of the tool's origin, world frame.
    pub tool_path_world: Vec<Point3<f64>>,
    /// Center of what is worth seeing, world frame, and the radius around it, m: where a viewer looks at first.
    pub focus_world: (Point3<f64>, f64),
    /// Time between two samples, s.
    pub control_period_s: f64,
}

/// The arm as an onlooker draws and labels it.
#[derive(Clone, Debug, Default)]
pub struct ArmDescription {
    /// Joint names.
    pub joints: Vec<String>,
    /// Largest torque of each joint, N m (N for sliding joints); infinite if the arm states none.
    pub torque_limits_nm: Vec<f64>,
    /// What moves with the base and with each joint: the base first, then one entry per joint.
    pub links: Vec<LinkDrawing>,
    /// The held tool, placed in the tool's frame.
    pub tool: Vec<Drawing>,
}

/// What moves with one joint.
#[derive(Clone, Debug, Default)]
pub struct LinkDrawing {
    /// Name of the link.
    pub name: String,
    /// Its shapes, placed in the body's frame.
    pub drawings: Vec<Drawing>,
}

/// A body that the task moves.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyDrawing {
    /// Name, as reports call it; each body of a scene has its own.
    pub name: String,
    /// Its shapes, placed in the body's frame.
    pub drawings: Vec<Drawing>,
}

/// The grains as an onlooker draws them: one shape for all, scaled.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainDescription {
    /// Half lengths of each grain along its own axes, m.
    pub half_sizes_m: Vec<[f64; 3]>,
    /// Color of all grains.
    pub color: Rgba,
}

/// A curve that a task draws.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Plot that it belongs to, as its title with the unit: curves of one plot share the axis. For example `flow [g/s]`.
    pub plot: String,
    /// Its own name in the legend, with the unit.
    pub name: String,
}

/// A place that the tool is wanted at.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Its name, its own within a scene.
    pub name: String,
    /// The frame that the tool's is wanted in.
    pub world_from_target: Isometry3<f64>,
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
    pub world_from_tool: Isometry3<f64>,
    /// Where the tool should be.
    pub world_from_tool_reference: Isometry3<f64>,
    /// Poses of the base and of each joint's body, in the order of [`ArmDescription::links`].
    pub world_from_links: &'a [Isometry3<f64>],
    /// Joint positions, rad (m).
    pub q_rad: &'a [f64],
    /// Joint velocities, rad/s (m/s).
    pub dq_rad_per_s: &'a [f64],
    /// Desired joint positions, rad (m).
    pub q_reference_rad: &'a [f64],
    /// Torques of the motors, N m (N).
    pub torque_nm: &'a [f64],
    /// Force (N) and moment about the tool's origin (N m) of the surroundings on the tool, world axes, as the arm's motion
    /// tells: the mean over the last control period.
    pub tool_wrench: Vector6<f64>,
    /// Poses of the task's bodies, in the order of the last [`Observer::bodies`].
    pub world_from_bodies: &'a [Isometry3<f64>],
    /// Centers of the grains, world frame, m.
    pub grain_centers_world: &'a [Point3<f64>],
    /// Orientations of the grains; empty for balls.
    pub grain_turns: &'a [UnitQuaternion<f64>],
    /// Values of the task's curves, in the order of [`SceneDescription::series`].
    pub series: &'a [f64],
}

/// An onlooker of a spatial run; every method may be left out.
///
/// Observers must not block: whoever writes or streams does so on a thread or into buffers of its own.
pub trait Observer {
    /// The scene, before the first sample.
    fn begin(&mut self, _scene: &SceneDescription) {}
    /// The state at a control instant.
    fn sample(&mut self, _sample: &Sample<'_>) {}
    /// The task's bodies are these from `time_s` on: a body came apart.
    fn bodies(&mut self, _time_s: f64, _bodies: &[BodyDrawing]) {}
    /// Something worth a line in a log.
    fn event(&mut self, _event: &Event) {}
}

impl Observer for () {}
