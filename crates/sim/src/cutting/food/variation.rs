//! In what specimens of a food differ: size and toughness.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, positive, within};

use crate::cutting::material::Material;

/// How far specimens of a food differ from what its file states; a range that is absent means that they do not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FoodRange {
    /// Smallest and greatest factor on all lengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<[f64; 2]>,
    /// Smallest and greatest toughness, J/m².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub toughness_j_per_m2: Option<[f64; 2]>,
}

/// One specimen: what its size and toughness are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FoodSample {
    /// Factor on all lengths of the shape.
    pub scale: f64,
    /// Toughness, J/m².
    pub toughness_j_per_m2: f64,
}

/// Specimens of a food are from half to twice as long as stated; others are another food.
const SCALES: [f64; 2] = [0.5, 2.0];

impl FoodSample {
    /// The specimen that a file states.
    #[must_use]
    pub fn of(material: &Material) -> Self {
        Self { scale: 1.0, toughness_j_per_m2: material.toughness_j_per_m2 }
    }

    /// Checks that a food can have this size and toughness.
    ///
    /// # Errors
    /// A [`FieldError`] naming the value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("scale", self.scale, SCALES[0], SCALES[1])?;
        positive("toughness_j_per_m2", self.toughness_j_per_m2)
    }
}

impl FoodRange {
    /// Draws a specimen. Ratios, not differences, are equally likely: toughness ranges over factors of two and more.
    ///
    /// Two numbers are drawn whatever the ranges are, so that adding a range moves nothing else.
    pub fn draw(&self, material: &Material, random: &mut ChaCha8Rng) -> FoodSample {
        let stated = FoodSample::of(material);
        let mut between = |range: Option<[f64; 2]>, otherwise: f64| {
            let share = random.random::<f64>();
            range.map_or(otherwise, |[low, high]| low * (high / low).powf(share))
        };
        FoodSample {
            scale: between(self.scale, stated.scale),
            toughness_j_per_m2: between(self.toughness_j_per_m2, stated.toughness_j_per_m2),
        }
    }

    /// Checks that the ranges are ranges and contain what the file states.
    ///
    /// # Errors
    /// A [`FieldError`] naming the range.
    pub fn validate(&self, material: &Material) -> Result<(), FieldError> {
        let stated = FoodSample::of(material);
        let ranges = [
            ("scale", self.scale, stated.scale),
            ("toughness_j_per_m2", self.toughness_j_per_m2, stated.toughness_j_per_m2),
        ];
        for (field, range, stated) in ranges {
            let Some([low, high]) = range else { continue };
            if !(low > 0.0 && low <= stated && stated <= high && high.is_finite()) {
                let expected = format!("[smallest, greatest], greater than 0, with {stated} between them");
                return Err(FieldError::new(field, format!("[{low}, {high}]"), expected));
            }
        }
        let [low, high] = self.scale.unwrap_or([1.0; 2]);
        within("scale", low, SCALES[0], SCALES[1])?;
        within("scale", high, SCALES[0], SCALES[1])
    }
}
