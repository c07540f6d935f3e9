//! Noise of a human hand in six coordinates: what a demonstration holds besides its intention.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3, Vector6};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::plan::SpatialPlan;
use crate::field::{FieldError, not_negative, positive, within};
use crate::primitive::pose::{PoseError, PoseTrajectory};

/// Bandwidth of the velocity noise, Hz: voluntary movement lies below it.
const NOISE_HZ: f64 = 3.0;
/// Range of tremor frequencies, Hz (C. N. Riviere, R. S. Rader and P. K. Khosla, 1997).
const TREMOR_HZ: (f64, f64) = (8.0, 12.0);
/// Tremor waxes and wanes at this rate, Hz, and by this share.
const MODULATION_HZ: f64 = 0.7;
const SWELL: f64 = 0.3;
/// Spread of the logarithm of a pause.
const PAUSE_SPREAD: f64 = 0.4;

/// Numbers of a hand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct HandConfig {
    /// Velocity noise per speed, linear and angular (signal-dependent noise; C. M. Harris and D. M. Wolpert, 1998).
    #[schemars(range(min = 0.0, max = 1.0))]
    pub velocity_noise: f64,
    /// Constant velocity noise, m/s.
    #[schemars(range(min = 0.0))]
    pub constant_noise_m_per_s: f64,
    /// Constant noise of the angular velocity, rad/s: 0.12 makes a blade wobble by about one degree.
    #[schemars(range(min = 0.0))]
    pub constant_noise_rad_per_s: f64,
    /// Root mean square of the tremor at 8 to 12 Hz, m.
    #[schemars(range(min = 0.0))]
    pub tremor_m: f64,
    /// Root mean square of the angular tremor, rad.
    #[schemars(range(min = 0.0))]
    pub tremor_rad: f64,
    /// Delay from seeing an error to correcting it, s.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub reaction_s: f64,
    /// Speed of a correction per seen error, 1/s.
    pub gain_per_s: f64,
    /// Median pause at a change of contact, s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub pause_s: f64,
    /// Coefficient of variation of durations between trials.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub trial_variation: f64,
    /// Rate of the recording, Hz.
    #[schemars(range(min = 20.0, max = 2000.0))]
    pub recording_hz: f64,
}

impl Default for HandConfig {
    fn default() -> Self {
        Self {
            velocity_noise: 0.10,
            constant_noise_m_per_s: 0.0015,
            constant_noise_rad_per_s: 0.12,
            tremor_m: 0.000_08,
            tremor_rad: 0.001,
            reaction_s: 0.18,
            gain_per_s: 3.0,
            pause_s: 0.25,
            trial_variation: 0.07,
            recording_hz: 100.0,
        }
    }
}

impl HandConfig {
    /// A hand without noise that pauses and times as any other does on average.
    #[must_use]
    pub fn steady() -> Self {
        Self {
            velocity_noise: 0.0,
            constant_noise_m_per_s: 0.0,
            constant_noise_rad_per_s: 0.0,
            tremor_m: 0.0,
            tremor_rad: 0.0,
            trial_variation: 0.0,
            ..Self::default()
        }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("velocity_noise", self.velocity_noise, 0.0, 1.0)?;
        not_negative("constant_noise_m_per_s", self.constant_noise_m_per_s)?;
        not_negative("constant_noise_rad_per_s", self.constant_noise_rad_per_s)?;
        not_negative("tremor_m", self.tremor_m)?;
        not_negative("tremor_rad", self.tremor_rad)?;
        within("reaction_s", self.reaction_s, 0.0, 1.0)?;
        // a delayed correction of more than π/2 per delay oscillates ever further
        within("gain_per_s", self.gain_per_s, 0.0, 0.5 * std::f64::consts::PI / self.reaction_s.max(0.01))?;
        positive("pause_s", self.pause_s)?;
        within("trial_variation", self.trial_variation, 0.0, 0.5)?;
        within("recording_hz", self.recording_hz, 20.0, 2000.0)
    }
}

/// A hand in one trial.
#[derive(Debug, Clone)]
pub struct Hand {
    config: HandConfig,
    random: ChaCha8Rng,
}

impl Hand {
    /// Takes a hand with its own random numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn new(config: HandConfig, random: ChaCha8Rng) -> Result<Self, FieldError> {
        config.validate()?;
        Ok(Self { config, random })
    }

    /// A factor about one for durations, never below a half.
    pub fn factor(&mut self) -> f64 {
        (1.0 + self.config.trial_variation * self.normal()).max(0.5)
    }

    /// Length of a pause, s: log-normal about its median.
    pub fn pause_s(&mut self) -> f64 {
        let spread = if self.config.trial_variation > 0.0 { PAUSE_SPREAD } else { 0.0 };
        self.config.pause_s * (spread * self.normal()).exp()
    }

    /// Follows a plan with this hand and records where the tool was, `world_from_tool`: velocity noise that is corrected
    /// after the reaction time, and tremor, in all six coordinates.
    ///
    /// # Errors
    /// [`PoseError`] if the plan is too short to be recorded.
    pub fn follow(&mut self, plan: &SpatialPlan) -> Result<PoseTrajectory, PoseError> {
        let step_s = 1.0 / self.config.recording_hz;
        let rows = (plan.duration_s() / step_s).floor() as usize + 1;
        let delay = (self.config.reaction_s / step_s).round() as usize;
        let keep = (-TAU * NOISE_HZ * step_s).exp();
        let waves: Vec<(f64, f64)> = (0..6)
            .map(|_| (self.random.random_range(TREMOR_HZ.0..TREMOR_HZ.1), self.random.random_range(0.0..TAU)))
            .collect();
        let (mut error, mut noise) = (Vector6::<f64>::zeros(), Vector6::<f64>::zeros());
        let mut seen: VecDeque<Vector6<f64>> = std::iter::repeat_n(error, delay + 1).collect();
        let (mut times_s, mut poses) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
        for row in 0..rows {
            let time_s = row as f64 * step_s;
            let motion = plan.at(time_s);
            let shaken = error + self.tremor(&waves, time_s);
            times_s.push(time_s);
            poses.push(displaced(&motion.pose, &shaken));
            let linear = self.spread(motion.linear_velocity().norm(), self.config.constant_noise_m_per_s);
            let angular = self.spread(motion.angular_velocity().norm(), self.config.constant_noise_rad_per_s);
            for k in 0..6 {
                let spread = if k < 3 { linear } else { angular };
                noise[k] = noise[k] * keep + spread * (1.0 - keep * keep).sqrt() * self.normal();
            }
            seen.push_back(error);
            let late = seen.pop_front().unwrap_or_default();
            error += (noise - late * self.config.gain_per_s) * step_s;
        }
        PoseTrajectory::new(times_s, poses)
    }

    fn spread(&self, speed: f64, constant: f64) -> f64 {
        self.config.velocity_noise * speed + constant
    }

    fn tremor(&self, waves: &[(f64, f64)], time_s: f64) -> Vector6<f64> {
        let swell = 1.0 + SWELL * (TAU * MODULATION_HZ * time_s).sin();
        // mean square of a modulated sine: (1 + swell²/2)/2
        let per_rms = (2.0 / (1.0 + 0.5 * SWELL * SWELL)).sqrt() * swell;
        Vector6::from_fn(|k, _| {
            let rms = if k < 3 { self.config.tremor_m } else { self.config.tremor_rad };
            waves.get(k).map_or(0.0, |(hertz, phase)| rms * per_rms * (TAU * hertz * time_s + phase).sin())
        })
    }

    /// A number of the standard normal distribution, by G. E. P. Box and M. E. Muller, 1958.
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.random.random::<f64>()).ln()).sqrt();
        radius * (TAU * self.random.random::<f64>()).cos()
    }
}

fn displaced(pose: &Isometry3<f64>, by: &Vector6<f64>) -> Isometry3<f64> {
    let shift = Vector3::new(by[0], by[1], by[2]);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(by[3], by[4], by[5]));
    Isometry3::from_parts(Translation3::from(pose.translation.vector + shift), turn * pose.rotation)
}

#[cfg(test)]
#[path = "hand_tests.rs"]
mod tests;
