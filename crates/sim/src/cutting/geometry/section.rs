//! What a plane cuts out of a solid.

use nalgebra::{Isometry3, Point2};

use super::polygon;

/// What a plane cuts out of a solid, in the plane's own frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// The section's frame in the food's: its origin lies on the plane, x points along the knife's edge, y where the
    /// knife cuts to (downwards), and z along the plane's normal.
    pub food_from_section: Isometry3<f64>,
    /// Convex, counterclockwise polygons with disjoint interiors, one per cell that is cut, m.
    pub polygons: Vec<Vec<Point2<f64>>>,
}

impl Section {
    /// Returns the area of the section, m².
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.polygons.iter().map(|outline| polygon::area(outline)).sum()
    }

    /// Returns how long an edge parallel to x would be inside the section at depth `y_m`: the sum of all chords, m.
    ///
    /// Where the outline has an edge along x the width jumps; there it is the width just below (at the greater y), so that
    /// polygons that share that edge are not counted twice. At the lowest point of the section it is therefore 0.
    #[must_use]
    pub fn width_at(&self, y_m: f64) -> f64 {
        self.polygons.iter().map(|outline| polygon::chord(outline, y_m)).sum()
    }

    /// Returns the smallest and the greatest x and y of the section, m; none if it is empty.
    #[must_use]
    pub fn bounds(&self) -> Option<(Point2<f64>, Point2<f64>)> {
        let mut points = self.polygons.iter().flatten();
        let first = *points.next()?;
        Some(points.fold((first, first), |(low, high), point| (low.inf(point), high.sup(point))))
    }

    /// Does `point` (x, y in m) lie in the section or on its outline?
    #[must_use]
    pub fn contains(&self, point: &Point2<f64>) -> bool {
        self.polygons.iter().any(|outline| polygon::contains(outline, point))
    }

    /// Does the plane miss the solid?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of a few products of exactly represented numbers.
    const ROUNDING: f64 = 1e-15;

    fn rectangle(low: [f64; 2], high: [f64; 2]) -> Vec<Point2<f64>> {
        [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]].map(Point2::from).to_vec()
    }

    fn two_blocks() -> Section {
        let polygons = vec![rectangle([0.0, 0.0], [0.04, 0.03]), rectangle([0.01, 0.03], [0.03, 0.05])];
        Section { food_from_section: Isometry3::identity(), polygons }
    }

    #[test]
    fn width_and_area_add_up_over_the_cells() {
        let section = two_blocks();
        assert!((section.area_m2() - 0.0016).abs() < ROUNDING);
        assert!((section.width_at(0.02) - 0.04).abs() < ROUNDING);
        assert!((section.width_at(0.04) - 0.02).abs() < ROUNDING);
        assert_eq!(section.width_at(-0.001), 0.0);
    }

    #[test]
    fn a_shared_edge_along_x_is_counted_once() {
        assert!((two_blocks().width_at(0.03) - 0.02).abs() < ROUNDING);
    }

    #[test]
    fn bounds_and_inside_follow_the_outline() {
        let section = two_blocks();
        let (low, high) = section.bounds().unwrap();
        assert_eq!((low, high), (Point2::new(0.0, 0.0), Point2::new(0.04, 0.05)));
        assert!(section.contains(&Point2::new(0.02, 0.049)));
        assert!(!section.contains(&Point2::new(0.035, 0.04)));
    }

    #[test]
    fn an_empty_section_has_no_bounds() {
        let section = Section { food_from_section: Isometry3::identity(), polygons: vec![] };
        assert!(section.is_empty() && section.bounds().is_none() && section.area_m2() == 0.0);
    }
}
