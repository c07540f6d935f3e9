//! What happened in a run, sample by sample: all that a judge needs.

use nalgebra::Isometry2;

/// State at one control instant.
#[derive(Clone, Copy, Debug)]
pub struct EpisodeSample {
    /// Simulated time, s.
    pub time_s: f64,
    /// Index of the plan's action.
    pub phase: usize,
    /// Pose of the tool.
    pub world_from_tool: Isometry2<f64>,
    /// Where the tool should be.
    pub world_from_tool_reference: Isometry2<f64>,
    /// Pose of the object.
    pub world_from_object: Isometry2<f64>,
    /// Where the plan expects the object.
    pub world_from_object_expected: Isometry2<f64>,
    /// Whether the tool is off the object to renew its hold.
    pub renews_hold: bool,
    /// Magnitude of the tool's force on the object, N; zero without contact.
    pub tool_force_n: f64,
    /// Sliding speed where the tool touches the object, m/s.
    pub slip_m_per_s: f64,
    /// Whether tool or object touches an obstacle.
    pub hits_obstacle: bool,
    /// Largest joint tracking error, rad.
    pub joint_error_rad: f64,
    /// Largest torque as a share of its joint's limit.
    pub torque_share: f64,
    /// Mechanical power that the motors give, W: the sum of |torque times speed|.
    pub power_w: f64,
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
