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
/// Tremor waxes and wanes at this rate, Hz, and by this share.
const MODULATION_HZ: f64 = 0.7;
const SWELL: f64 = 0.3;

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

    /// Tremor at a time: displacement, m, and its rate, m/s. Each axis has the configured root mean square.
    pub(crate) fn tremor(&self, time_s: f64) -> (Vector2<f64>, Vector2<f64>) {
        let tau = std::f64::consts::TAU;
        let (swing, swing_rate) = (tau * MODULATION_HZ * time_s).sin_cos();
        let (swell, swell_rate) = (1.0 + SWELL * swing, SWELL * tau * MODULATION_HZ * swing_rate);
        // mean square of a modulated sine: (1 + swell²/2)/2
        let amplitude = self.tremor_m * (2.0 / (1.0 + 0.5 * SWELL * SWELL)).sqrt();
        let wave = |(hertz, phase): (f64, f64)| {
            let (sin, cos) = (tau * hertz * time_s + phase).sin_cos();
            (amplitude * swell * sin, amplitude * (swell_rate * sin + swell * tau * hertz * cos))
        };
        let [x, y] = self.tremor.map(wave);
        (Vector2::new(x.0, y.0), Vector2::new(x.1, y.1))
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

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    fn noise() -> MotorNoise {
        MotorNoise::new(&HumanConfig::default(), ChaCha8Rng::seed_from_u64(3))
    }

    #[test]
    fn tremor_has_the_configured_root_mean_square() {
        let (noise, rows) = (noise(), 20_000);
        let squares: f64 = (0..rows).map(|k| noise.tremor(f64::from(k) * 0.001).0.x.powi(2)).sum();
        let rms = (squares / f64::from(rows)).sqrt();
        // twenty seconds hold about 200 waves
        assert!((rms / HumanConfig::default().tremor_m - 1.0).abs() < 0.03, "{rms}");
    }

    #[test]
    fn the_rate_of_tremor_is_its_derivative() {
        let (noise, h) = (noise(), 1e-6);
        let slope = (noise.tremor(1.0 + h).0 - noise.tremor(1.0 - h).0) / (2.0 * h);
        assert!((slope - noise.tremor(1.0).1).norm() < 1e-7);
    }

    #[test]
    fn velocity_noise_has_the_stated_spread() {
        let (mut noise, rows) = (noise(), 200_000);
        let squares: f64 = (0..rows).map(|_| noise.velocity(0.03, 0.001).x.powi(2)).sum();
        let sd = (squares / f64::from(rows)).sqrt();
        let expected = 0.10 * 0.03 + 0.0015;
        // 200 s at 3 Hz bandwidth: some thousand independent draws
        assert!((sd / expected - 1.0).abs() < 0.05, "{sd}");
    }
}
