//! Noise of a human hand: signal-dependent velocity noise and tremor.

use nalgebra::Vector2;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::config::HumanConfig;

/// Bandwidth of the velocity noise, Hz: voluntary movement lies below it.
const NOISE_HZ: f64 = 3.0;
/// Range of tremor frequencies, Hz (Riviere, Rader and Khosla 1997).
const TREMOR_HZ: (f64, f64) = (8.0, 12.0);
/// Tremor waxes and wanes at this rate, Hz.
const MODULATION_HZ: f64 = 0.7;

/// Noise of one trial.
#[derive(Clone, Debug)]
pub(crate) struct MotorNoise {
    random: ChaCha8Rng,
    velocity: Vector2<f64>,
    per_speed: f64,
    constant_m_per_s: f64,
    tremor_m: f64,
    /// Frequency (Hz) and phase (rad) of the tremor in x and in y.
    tremor: [(f64, f64); 2],
}

impl MotorNoise {
    pub(crate) fn new(config: &HumanConfig, mut random: ChaCha8Rng) -> Self {
        let mut wave =
            || (random.random_range(TREMOR_HZ.0..TREMOR_HZ.1), random.random_range(0.0..std::f64::consts::TAU));
        let tremor = [wave(), wave()];
        Self {
            random,
            velocity: Vector2::zeros(),
            per_speed: config.velocity_noise,
            constant_m_per_s: config.constant_noise_m_per_s,
            tremor_m: config.tremor_m,
            tremor,
        }
    }

    /// Velocity noise for the next `dt` of a movement at `speed_m_per_s`: an Ornstein-Uhlenbeck process, m/s.
    pub(crate) fn velocity(&mut self, speed_m_per_s: f64, dt: f64) -> Vector2<f64> {
        let spread = self.per_speed * speed_m_per_s + self.constant_m_per_s;
        let keep = (-std::f64::consts::TAU * NOISE_HZ * dt).exp();
        let fresh: [f64; 2] = [StandardNormal.sample(&mut self.random), StandardNormal.sample(&mut self.random)];
        self.velocity = self.velocity * keep + Vector2::from(fresh) * (spread * (1.0 - keep * keep).sqrt());
        self.velocity
    }

    /// Tremor at a time, m.
    pub(crate) fn tremor_m(&self, time_s: f64) -> Vector2<f64> {
        let tau = std::f64::consts::TAU;
        let swell = 1.0 + 0.3 * (tau * MODULATION_HZ * time_s).sin();
        let wave = |(hertz, phase): (f64, f64)| (tau * hertz * time_s + phase).sin();
        Vector2::new(wave(self.tremor[0]), wave(self.tremor[1])) * (self.tremor_m * swell)
    }

    /// A factor around one with the given coefficient of variation, never below a half.
    pub(crate) fn factor(&mut self, variation: f64) -> f64 {
        let draw: f64 = StandardNormal.sample(&mut self.random);
        (1.0 + variation * draw).max(0.5)
    }

    /// Length of a pause: log-normal about its median, s.
    pub(crate) fn pause_s(&mut self, median_s: f64) -> f64 {
        const SPREAD: f64 = 0.4;
        let draw: f64 = StandardNormal.sample(&mut self.random);
        median_s * (SPREAD * draw).exp()
    }
}
