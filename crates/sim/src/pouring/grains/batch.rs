//! A batch: grains of one kind, each of its own size.

use std::f64::consts::PI;

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use skills::field::FieldError;

use super::config::GrainConfig;

/// The largest deviation of a size, in standard deviations.
const WIDEST: f64 = 2.0;

/// Grains of one kind with their sizes.
#[derive(Clone, Debug, PartialEq)]
pub struct GrainBatch {
    config: GrainConfig,
    diameters_m: Vec<f64>,
}

impl GrainBatch {
    /// Draws the sizes of `count` grains.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value of `config`.
    pub fn draw(config: &GrainConfig, count: usize, random: &mut ChaCha8Rng) -> Result<Self, FieldError> {
        config.validate()?;
        let diameter = |_| {
            let deviation: f64 = StandardNormal.sample(random);
            config.diameter_m * (1.0 + config.size_variation * deviation.clamp(-WIDEST, WIDEST))
        };
        Ok(Self { config: config.clone(), diameters_m: (0..count).map(diameter).collect() })
    }

    /// The kind.
    #[must_use]
    pub fn config(&self) -> &GrainConfig {
        &self.config
    }

    /// Diameters of the balls of equal volume, m.
    #[must_use]
    pub fn diameters_m(&self) -> &[f64] {
        &self.diameters_m
    }

    /// Number of grains.
    #[must_use]
    pub fn len(&self) -> usize {
        self.diameters_m.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.diameters_m.is_empty()
    }

    /// Masses, kg.
    pub fn masses_kg(&self) -> impl Iterator<Item = f64> + '_ {
        self.diameters_m.iter().map(|diameter| self.config.density_kg_per_m3 * PI / 6.0 * diameter.powi(3))
    }

    /// Radii of the round parts, m.
    pub fn radii_m(&self) -> impl Iterator<Item = f64> + '_ {
        self.diameters_m.iter().map(|diameter| self.config.radius_and_half_length_m(*diameter).0)
    }

    /// The longest extent of any grain, m.
    #[must_use]
    pub fn longest_m(&self) -> f64 {
        let lengths = self.diameters_m.iter().map(|diameter| {
            let (radius, half_length) = self.config.radius_and_half_length_m(*diameter);
            2.0 * (radius + half_length)
        });
        lengths.fold(0.0, f64::max)
    }

    pub(super) fn expect_length(&self, field: &str, length: usize) -> Result<(), FieldError> {
        if length == self.len() {
            return Ok(());
        }
        Err(FieldError::new(field, format!("{length} poses"), format!("{}, one per grain", self.len())))
    }
}
