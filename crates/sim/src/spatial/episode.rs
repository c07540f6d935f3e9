//! What happened in a spatial run, sample by sample: all that a judge needs of the arm.

use nalgebra::{Isometry3, Vector6};

/// State at one control instant.
#[derive(Clone, Copy, Debug)]
pub struct EpisodeSample {
    /// Simulated time, s.
    pub time_s: f64,
    /// Index of the plan's action.
    pub phase: usize,
    /// Pose of the tool.
    pub world_from_tool: Isometry3<f64>,
    /// Where the tool should be.
    pub world_from_tool_reference: Isometry3<f64>,
    /// Force (N) and moment about the tool's origin (N m) of the surroundings on the tool, world axes, as the arm's motion
    /// tells: see [`super::WrenchSensor`]. The mean over the last control period.
    pub tool_wrench: Vector6<f64>,
    /// The part of it that the task's process says it exerted, without contacts that the engine solves.
    pub process_wrench: Vector6<f64>,
    /// Largest joint tracking error, rad (m).
    pub joint_error_rad: f64,
    /// Largest torque as a share of its joint's limit.
    pub torque_share: f64,
    /// Mechanical power that the motors give, W: the sum of |torque times speed|.
    pub power_w: f64,
}

impl EpisodeSample {
    /// Distance of the tool's origin from where it should be, m.
    #[must_use]
    pub fn tool_error_m(&self) -> f64 {
        (self.world_from_tool.translation.vector - self.world_from_tool_reference.translation.vector).norm()
    }

    /// Angle of the tool to how it should be turned, rad.
    #[must_use]
    pub fn tool_angle_error_rad(&self) -> f64 {
        self.world_from_tool.rotation.angle_to(&self.world_from_tool_reference.rotation)
    }
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Episode {
    /// Samples, one per control period.
    pub samples: Vec<EpisodeSample>,
    /// Time between samples, s.
    pub control_period_s: f64,
    /// Whether the plan was carried out to its end.
    pub finished: bool,
    /// Why the run ended before that; `None` if it did not.
    pub interruption: Option<String>,
    /// Digest of the state at every time step: equal digests, equal runs.
    pub digest: String,
}

impl Episode {
    /// Simulated time, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.samples.len() as f64 * self.control_period_s
    }
}
