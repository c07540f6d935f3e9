//! A camera that sees the object's pose at its frame rate, late, with noise, a constant bias and drop-outs.
//!
//! Orders of magnitude of a first-generation structured-light camera at 0.6 to 1 m: lateral noise of a blob's centroid
//! 0.3–0.5 mm, bias 1–2 mm, 30 Hz, 60–90 ms latency (Nguyen, Izadi and Lovell 2012, for the noise model).

use std::collections::VecDeque;
use std::f64::consts::PI;

use nalgebra::{Isometry2, Vector2};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal, StandardNormal};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, within};

/// Largest standard deviation of a place that a camera tells, m: beyond it, it sees nothing on a table.
const LARGEST_ERROR_M: f64 = 0.1;

/// Frame rate, latency and errors of a camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CameraConfig {
    /// Frames per second, Hz.
    #[schemars(range(min = 0.1, max = 10_000.0))]
    pub rate_hz: f64,
    /// Time from exposure to arrival, s.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub latency_s: f64,
    /// Standard deviation of the latency, s.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub jitter_s: f64,
    /// Standard deviation of a position in one frame, per axis, m.
    #[schemars(range(min = 0.0, max = LARGEST_ERROR_M))]
    pub noise_m: f64,
    /// Standard deviation of the constant error of a run, per axis, m.
    #[schemars(range(min = 0.0, max = LARGEST_ERROR_M))]
    pub bias_m: f64,
    /// Standard deviation of an angle in one frame, rad.
    #[schemars(range(min = 0.0, max = PI))]
    pub angle_noise_rad: f64,
    /// Share of frames in which the object is not found.
    #[schemars(range(min = 0.0, max = 0.99))]
    pub drop_out: f64,
}

impl Default for CameraConfig {
    fn default() -> Self {
        Self {
            rate_hz: 30.0,
            latency_s: 0.075,
            jitter_s: 0.003,
            noise_m: 0.0004,
            bias_m: 0.0010,
            angle_noise_rad: 0.02,
            drop_out: 0.0075,
        }
    }
}

impl CameraConfig {
    /// A camera without any error: it sees every millisecond, at once.
    #[must_use]
    pub fn perfect() -> Self {
        Self {
            rate_hz: 1000.0,
            latency_s: 0.0,
            jitter_s: 0.0,
            noise_m: 0.0,
            bias_m: 0.0,
            angle_noise_rad: 0.0,
            drop_out: 0.0,
        }
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("rate_hz", self.rate_hz, 0.1, 10_000.0)?;
        within("latency_s", self.latency_s, 0.0, 10.0)?;
        within("jitter_s", self.jitter_s, 0.0, 1.0)?;
        within("noise_m", self.noise_m, 0.0, LARGEST_ERROR_M)?;
        within("bias_m", self.bias_m, 0.0, LARGEST_ERROR_M)?;
        within("angle_noise_rad", self.angle_noise_rad, 0.0, PI)?;
        within("drop_out", self.drop_out, 0.0, 0.99)
    }
}

/// What one frame showed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// When the frame was exposed, s.
    pub exposed_s: f64,
    /// Where the object seemed to be.
    pub world_from_object: Isometry2<f64>,
}

/// A running camera.
#[derive(Clone, Debug)]
pub struct Camera {
    config: CameraConfig,
    random: ChaCha8Rng,
    bias_m: Vector2<f64>,
    next_exposure_s: f64,
    /// Frames on their way, with the time of their arrival.
    on_the_way: VecDeque<(f64, Sighting)>,
    latest: Option<Sighting>,
    /// Most frames that can be on their way.
    capacity: usize,
}

impl Camera {
    /// A camera whose errors are drawn from `random`.
    #[must_use]
    pub fn new(config: &CameraConfig, mut random: ChaCha8Rng) -> Self {
        let bias: [f64; 2] = [StandardNormal.sample(&mut random), StandardNormal.sample(&mut random)];
        // frames on their way: latency times rate, and room for jitter
        let capacity = (config.latency_s * config.rate_hz).ceil() as usize + 8;
        Self {
            bias_m: Vector2::from(bias) * config.bias_m,
            config: config.clone(),
            random,
            next_exposure_s: 0.0,
            on_the_way: VecDeque::with_capacity(capacity),
            capacity,
            latest: None,
        }
    }

    /// Sets the clock back to zero: frames on their way are lost, the errors go on.
    pub fn begin_anew(&mut self) {
        self.next_exposure_s = 0.0;
        self.on_the_way.clear();
        self.latest = None;
    }

    /// Lets time advance to `time_s` with the object at `world_from_object`; returns the newest frame that has arrived.
    pub fn look(&mut self, time_s: f64, world_from_object: &Isometry2<f64>) -> Option<Sighting> {
        if time_s >= self.next_exposure_s {
            self.next_exposure_s += 1.0 / self.config.rate_hz;
            self.expose(time_s, world_from_object);
        }
        while let Some(&(arrival_s, sighting)) = self.on_the_way.front() {
            if arrival_s > time_s {
                break;
            }
            self.latest = Some(sighting);
            self.on_the_way.pop_front();
        }
        self.latest
    }

    fn expose(&mut self, time_s: f64, world_from_object: &Isometry2<f64>) {
        let mut noise = |sd: f64| Normal::new(0.0, sd).map_or(0.0, |normal| normal.sample(&mut self.random));
        let error = Vector2::new(noise(self.config.noise_m), noise(self.config.noise_m)) + self.bias_m;
        let turn = noise(self.config.angle_noise_rad);
        let delay = (self.config.latency_s + noise(self.config.jitter_s)).max(0.0);
        let lost = self.random.random_bool(self.config.drop_out);
        if lost || self.on_the_way.len() == self.capacity {
            return;
        }
        let seen =
            Isometry2::new(world_from_object.translation.vector + error, world_from_object.rotation.angle() + turn);
        // frames arrive in the order of their exposure
        let arrival = self.on_the_way.back().map_or(0.0, |last| last.0).max(time_s + delay);
        self.on_the_way.push_back((arrival, Sighting { exposed_s: time_s, world_from_object: seen }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn a_perfect_camera_sees_what_is_there_at_once() {
        let mut camera = Camera::new(&CameraConfig::perfect(), ChaCha8Rng::seed_from_u64(1));
        let there = Isometry2::new(Vector2::new(0.1, 0.2), 0.3);
        approx::assert_relative_eq!(camera.look(0.0, &there).unwrap().world_from_object, there, epsilon = 1e-15);
    }

    #[test]
    fn errors_as_large_as_a_table_are_refused_by_name() {
        let refused = |config: CameraConfig| config.validate().err().map(|error| error.field);
        assert_eq!(refused(CameraConfig { noise_m: 0.05, ..CameraConfig::default() }), None);
        assert_eq!(refused(CameraConfig { noise_m: 10.0, ..CameraConfig::default() }).as_deref(), Some("noise_m"));
        assert_eq!(refused(CameraConfig { bias_m: 1e300, ..CameraConfig::default() }).as_deref(), Some("bias_m"));
        let turned = CameraConfig { angle_noise_rad: 7.0, ..CameraConfig::default() };
        assert_eq!(refused(turned).as_deref(), Some("angle_noise_rad"));
    }

    #[test]
    fn a_frame_arrives_after_its_latency() {
        let config = CameraConfig { latency_s: 0.075, jitter_s: 0.0, ..CameraConfig::default() };
        let mut camera = Camera::new(&config, ChaCha8Rng::seed_from_u64(1));
        assert!(camera.look(0.0, &Isometry2::identity()).is_none());
        assert!(camera.look(0.074, &Isometry2::identity()).is_none());
        assert_eq!(camera.look(0.076, &Isometry2::identity()).unwrap().exposed_s, 0.0);
    }

    #[test]
    fn noise_and_bias_have_the_stated_size() {
        let config =
            CameraConfig { bias_m: 0.0, drop_out: 0.0, latency_s: 0.0, jitter_s: 0.0, ..CameraConfig::default() };
        let mut camera = Camera::new(&config, ChaCha8Rng::seed_from_u64(7));
        let seen: Vec<f64> = (0..3000)
            .map(|k| camera.look(f64::from(k) / 30.0 + 1e-9, &Isometry2::identity()).unwrap())
            .map(|s| s.world_from_object.translation.x)
            .collect();
        let sd = (seen.iter().map(|x| x * x).sum::<f64>() / seen.len() as f64).sqrt();
        // standard error of a standard deviation of 3000 draws: 1.3 %
        assert!((sd - 0.0004).abs() < 0.0004 * 0.05, "{sd}");
    }
}
