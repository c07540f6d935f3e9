//! What the study finds out.

use super::condition::Condition;
use super::gains::StudiedGains;

/// One run of the study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunOutcome {
    /// The gains that were tried.
    pub gains: StudiedGains,
    /// In what the arm differed from the model.
    pub condition: Condition,
    /// Largest distance of the tool from its reference, m.
    pub tip_error_m: f64,
    /// Largest error of a joint, rad.
    pub joint_error_rad: f64,
    /// Largest motor torque, N m.
    pub peak_torque_nm: f64,
    /// Whether some joint was ever more than 1 rad off, or a number stopped being finite.
    pub diverged: bool,
}

/// What one set of gains makes of the arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainSummary {
    /// The gains.
    pub gains: StudiedGains,
    /// Time, s, after which the errors of a step of 0.05 rad in all joints stay below 2 % of it in the engine, torques limited
    /// in size only; `None` if they do not within 5 s.
    pub settling_s: Option<f64>,
    /// Stiffness of each joint, N m/rad.
    pub joint_stiffness_nm_per_rad: [f64; 7],
    /// Stiffness of the tool at the start, N/m along the base's x, y, z: see [`crate::controllers::tip_stiffness_n_per_m`].
    pub tip_stiffness_n_per_m: [f64; 3],
    /// Factor by which errors change per control period, at the start; stable below 1.
    pub growth_per_period: f64,
}

/// All that the study finds out.
#[derive(Clone, Debug, PartialEq)]
pub struct GainStudy {
    /// One entry for each set of gains, softest first.
    pub summaries: Vec<GainSummary>,
    /// One entry for each set of gains under each condition.
    pub runs: Vec<RunOutcome>,
}
