//! Points spread evenly over an outline's area, for sums that stand for integrals.

use nalgebra::{Point2, Vector2};

use super::Outline;

/// An outline that fills less of its bounding box than one cell in 2 to this power is taken for a line without area.
const MOST_DOUBLINGS: usize = 12;

impl Outline {
    /// At least `count` points spread evenly over the area, relative to the centroid, their mean at the centroid, m.
    ///
    /// An outline without area has fewer.
    #[must_use]
    pub fn spread_points(&self, count: usize) -> Vec<Vector2<f64>> {
        match self {
            Self::Disc { radius_m } => sunflower(*radius_m, count),
            Self::Box { .. } | Self::Polygon { .. } => self.cells(count),
        }
    }

    /// Centers of square cells over the bounding box, ever smaller until enough of them lie inside.
    fn cells(&self, count: usize) -> Vec<Vector2<f64>> {
        let corners = self.drawing(0);
        let bound = |axis: usize, pick: fn(f64, f64) -> f64, from: f64| {
            corners.iter().map(|corner| corner[axis]).fold(from, pick)
        };
        let low = Point2::new(bound(0, f64::min, f64::INFINITY), bound(1, f64::min, f64::INFINITY));
        let high = Point2::new(bound(0, f64::max, f64::NEG_INFINITY), bound(1, f64::max, f64::NEG_INFINITY));
        let size = high - low;
        let mut inside = Vec::new();
        for doubling in 0..=MOST_DOUBLINGS {
            let wanted = count << doubling;
            // a flat box has one row of cells or one column
            let columns = ((wanted as f64 * size.x / size.y).sqrt().ceil().max(1.0) as usize).min(wanted.max(1));
            let rows = wanted.div_ceil(columns);
            let cells = Vector2::new(columns as f64, rows as f64);
            let at = |k: usize| {
                let share = Vector2::new((k % columns) as f64 + 0.5, (k / columns) as f64 + 0.5);
                low + size.component_mul(&share.component_div(&cells))
            };
            let centers = (0..columns * rows).map(at).filter(|point| self.signed_distance_m(point) < 0.0);
            inside = centers.map(|point| point.coords).collect();
            if inside.len() >= count {
                break;
            }
        }
        centered(inside)
    }
}

/// Sunflower arrangement (Vogel 1979): equal areas along a golden-angle spiral.
fn sunflower(radius_m: f64, count: usize) -> Vec<Vector2<f64>> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let at = |k: usize| {
        let (sin, cos) = (golden * k as f64).sin_cos();
        Vector2::new(cos, sin) * (radius_m * ((k as f64 + 0.5) / count as f64).sqrt())
    };
    centered((0..count).map(at).collect())
}

fn centered(mut points: Vec<Vector2<f64>>) -> Vec<Vector2<f64>> {
    let mean = points.iter().sum::<Vector2<f64>>() / points.len() as f64;
    points.iter_mut().for_each(|point| *point -= mean);
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A sum over 64 points for an integral.
    const SUM_ERROR: f64 = 0.03;
    /// A hundred roundings of numbers of order one.
    const ROUNDING_M: f64 = 1e-12;

    #[test]
    fn spread_points_lie_inside_and_average_to_the_centroid() {
        let square = Outline::Polygon { vertices_m: vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] };
        for outline in [Outline::Disc { radius_m: 0.012 }, square, Outline::Box { width_m: 3.0, height_m: 0.5 }] {
            let points = outline.spread_points(64);
            assert!(points.len() >= 64);
            assert!(points.iter().sum::<Vector2<f64>>().norm() < ROUNDING_M);
            let mean = points.iter().map(|point| point.norm()).sum::<f64>() / points.len() as f64;
            assert_relative_eq!(mean, outline.mean_radius_m(), max_relative = SUM_ERROR);
        }
    }

    #[test]
    fn a_sliver_across_its_bounding_box_is_filled_too() {
        let sliver = Outline::Polygon { vertices_m: vec![[0.0, 0.0], [1.0, 0.98], [1.0, 1.0]] };
        assert!(sliver.spread_points(64).len() >= 64);
    }

    #[test]
    fn an_outline_without_area_ends_the_search() {
        let line = Outline::Polygon { vertices_m: vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]] };
        assert!(line.spread_points(8).len() < 8);
        assert!(Outline::Box { width_m: 1.0, height_m: 0.0 }.spread_points(8).len() < 8);
        assert!(Outline::Polygon { vertices_m: Vec::new() }.spread_points(8).is_empty());
        assert!(Outline::Box { width_m: 1.0, height_m: 1.0 }.spread_points(0).is_empty());
    }
}
