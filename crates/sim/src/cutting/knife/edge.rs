//! The part of a knife that cuts: a polyline with a radius, and the flanks behind it.

use nalgebra::Point2;
use skills::field::{FieldError, finite, not_negative, positive};

/// Edge of a knife in the plane of its blade, with what the cutting law needs to know of the blade behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Corners from the heel to the tip in the knife's frame, x increasing, m.
    pub points: Vec<Point2<f64>>,
    /// Radius of the edge (its sharpness), m: 2 to 10 µm for a sharp kitchen knife, half the diameter for a wire.
    pub radius_m: f64,
    /// Height of the blade behind the edge, m; only so much of it rubs.
    pub blade_height_m: f64,
    /// Greatest thickness of the blade, m.
    pub thickness_m: f64,
    /// Coefficient of friction between the blade and food.
    pub friction: f64,
    /// What teeth add to the slice-push ratio; 0 for a plain edge.
    pub tooth_ratio: f64,
    /// How much rougher than its path the edge leaves the cut surface; 1 for a plain edge.
    pub roughness_factor: f64,
}

impl Edge {
    /// A straight, perfectly sharp edge from x = 0 to `length_m` without friction or teeth: the edge of closed forms.
    #[must_use]
    pub fn ideal(length_m: f64, blade_height_m: f64) -> Self {
        Self {
            points: vec![Point2::origin(), Point2::new(length_m, 0.0)],
            radius_m: 0.0,
            blade_height_m,
            thickness_m: 0.002,
            friction: 0.0,
            tooth_ratio: 0.0,
            roughness_factor: 1.0,
        }
    }

    /// Checks that the corners run from heel to tip and every number is of use.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        let flat: Vec<f64> = self.points.iter().flat_map(|point| [point.x, point.y]).collect();
        finite("points", &flat)?;
        if self.points.len() < 2 || self.points.windows(2).any(|pair| pair[0].x >= pair[1].x) {
            let expected = "two corners or more, x increasing from heel to tip";
            return Err(FieldError::new("points", format!("{} corners", self.points.len()), expected));
        }
        not_negative("radius_m", self.radius_m)?;
        positive("blade_height_m", self.blade_height_m)?;
        positive("thickness_m", self.thickness_m)?;
        not_negative("friction", self.friction)?;
        not_negative("tooth_ratio", self.tooth_ratio)?;
        positive("roughness_factor", self.roughness_factor)
    }

    /// Distance from heel to tip along x, m.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        match (self.points.first(), self.points.last()) {
            (Some(heel), Some(tip)) => tip.x - heel.x,
            _ => 0.0,
        }
    }
}
