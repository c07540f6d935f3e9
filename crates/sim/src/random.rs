//! Random numbers: one seed, a stream per purpose, so that a draw added in one place moves nothing elsewhere.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

/// What random numbers are drawn for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// Errors of the camera that watches the robot.
    Camera = 1,
    /// The demonstrator's hand and decisions.
    Hand = 2,
    /// What the demonstrator sees.
    Eyes = 3,
    /// Errors of the camera that records demonstrations.
    Recorder = 4,
    /// What a run's world differs in from its scenario.
    Variation = 5,
    /// Errors of the controller's model of its arm.
    Model = 6,
    /// Sizes of grains and how they lie.
    Grains = 7,
}

/// Streams of one trial lie this far apart.
const TRIAL_STRIDE: u64 = 64;

/// The generator of a purpose, for trial number `trial` of a run with `seed`.
#[must_use]
pub fn stream(seed: u64, purpose: Purpose, trial: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(purpose as u64 + TRIAL_STRIDE * trial);
    random
}

/// Draws a number from the standard normal distribution.
pub fn normal(random: &mut ChaCha8Rng) -> f64 {
    random.sample(StandardNormal)
}

/// Draws a number from −1 to 1, all equally likely.
pub fn symmetric(random: &mut ChaCha8Rng) -> f64 {
    2.0 * random.random::<f64>() - 1.0
}
