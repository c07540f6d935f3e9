//! Where grains come down through the target's mouth plane.

use nalgebra::Vector2;

/// Share of the grains that [`LandingSpread::width_m`] covers.
const COVERED: f64 = 0.95;

/// Points in the mouth plane, in the target's frame; room for one per grain.
#[derive(Clone, Debug)]
pub struct LandingSpread {
    points: Vec<Vector2<f64>>,
}

impl LandingSpread {
    pub(super) fn with_room_for(count: usize) -> Self {
        Self { points: Vec::with_capacity(count) }
    }

    pub(super) fn clear(&mut self) {
        self.points.clear();
    }

    pub(super) fn note(&mut self, x: f64, y: f64) {
        self.points.push(Vector2::new(x, y));
    }

    /// The points, m, in the order of their arrival.
    #[must_use]
    pub fn points_m(&self) -> &[Vector2<f64>] {
        &self.points
    }

    /// Mean, m; the origin without points.
    #[must_use]
    pub fn mean_m(&self) -> Vector2<f64> {
        self.points.iter().sum::<Vector2<f64>>() / (self.points.len().max(1) as f64)
    }

    /// Standard deviation along x and y of the target, m.
    #[must_use]
    pub fn deviation_m(&self) -> Vector2<f64> {
        let mean = self.mean_m();
        let squares: Vector2<f64> = self.points.iter().map(|p| (p - mean).component_mul(&(p - mean))).sum();
        (squares / (self.points.len().max(1) as f64)).map(f64::sqrt)
    }

    /// Width along x and y of the target that 95 % of the grains pass, the outermost on both sides left out, m.
    #[must_use]
    pub fn width_m(&self) -> Vector2<f64> {
        Vector2::new(self.width(|p| p.x), self.width(|p| p.y))
    }

    fn width(&self, along: impl Fn(&Vector2<f64>) -> f64) -> f64 {
        let mut sorted: Vec<f64> = self.points.iter().map(along).collect();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1) as f64;
        let at = |share: f64| sorted.get((share * last).round() as usize).copied().unwrap_or(0.0);
        at(0.5 + 0.5 * COVERED) - at(0.5 - 0.5 * COVERED)
    }
}
