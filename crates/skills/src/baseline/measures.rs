//! Measures of a path of straight segments.

use nalgebra::{Point2, Vector2, distance};
use serde::Serialize;

/// What comparisons tell of a path; headings that differ by one degree or less count as one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PathMeasures {
    /// Places of the path, start and end included.
    pub nodes: usize,
    /// Places where the heading changes by more than a degree.
    pub heading_changes: usize,
    /// Length of the path, m.
    pub length_m: f64,
    /// Distance of its end from the goal, m.
    pub goal_error_m: f64,
}

/// Headings that differ by no more than this count as one, rad: one degree.
pub(super) const SAME_HEADING_RAD: f64 = std::f64::consts::PI / 180.0;

impl PathMeasures {
    /// Measures a path against its goal (both in one frame, m).
    #[must_use]
    pub fn new(path: &[Point2<f64>], goal: &Point2<f64>) -> Self {
        Self {
            nodes: path.len(),
            heading_changes: heading_changes(path, SAME_HEADING_RAD),
            length_m: path.windows(2).map(|pair| distance(&pair[0], &pair[1])).sum(),
            goal_error_m: path.last().map_or(f64::INFINITY, |end| distance(end, goal)),
        }
    }

    /// Times that the tool is placed anew if it pushes along every straight run of the path, start and goal included:
    /// straight runs + 1, as the paper's 4 for three pushes.
    #[must_use]
    pub fn trajectory_points(&self) -> usize {
        self.heading_changes + 2
    }
}

/// Counts the places of a path where its heading changes by more than `angle_rad`; segments of no length are passed over.
#[must_use]
pub fn heading_changes(path: &[Point2<f64>], angle_rad: f64) -> usize {
    let ways: Vec<Vector2<f64>> =
        path.windows(2).map(|pair| pair[1] - pair[0]).filter(|way| way.norm() > f64::EPSILON).collect();
    ways.windows(2).filter(|pair| pair[0].angle(&pair[1]) > angle_rad).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_of_known_corners_has_their_measures() {
        let path = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 0.0], [2.0, 3.0], [1.97, 6.0]].map(Point2::from);
        let measures = PathMeasures::new(&path, &Point2::new(1.97, 6.5));
        // a right angle; the last turn is 0.57°
        assert_eq!((measures.nodes, measures.heading_changes, measures.trajectory_points()), (6, 1, 3));
        assert!((measures.length_m - 5.0 - 3.0_f64.hypot(0.03)).abs() < 1e-12);
        assert!((measures.goal_error_m - 0.5).abs() < 1e-12);
        assert_eq!(heading_changes(&path, 0.009), 2);
    }

    #[test]
    fn a_path_of_nothing_misses_every_goal() {
        let measures = PathMeasures::new(&[], &Point2::origin());
        assert_eq!((measures.nodes, measures.length_m, measures.goal_error_m), (0, 0.0, f64::INFINITY));
    }
}
