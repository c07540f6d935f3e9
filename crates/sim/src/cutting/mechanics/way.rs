//! The way that a blade took through a food, as the surface along which the food comes apart.

use nalgebra::{Isometry3, Point2, UnitQuaternion, Vector3};

use super::process::Cut;
use crate::cutting::geometry::{CutSurface, GeometryError, Plane};

/// Bands in which the way is averaged.
const BANDS: usize = 30;
/// Strips of a cut surface, at most: each divides the cells that it meets once more.
const MOST_STRIPS: usize = 10;
/// A surface this near to the way needs no further strip, m.
const CLOSE_M: f64 = 1e-4;

impl Cut {
    /// Returns the surface that the edge went along, in the food's frame: strips that follow the blade's deviation from the
    /// section's plane within 0.1 mm where ten strips can, a single plane for a straight cut.
    ///
    /// The blade's turn about the cutting direction is that of the whole cut, as each strip is plane.
    ///
    /// # Errors
    /// A [`GeometryError`] if the section's frame is not finite.
    pub fn cut_surface(&self, food_from_section: &Isometry3<f64>) -> Result<CutSurface, GeometryError> {
        let along = self.best_plane().map_or(0.0, |plane| plane.y);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -along.atan());
        let turned = food_from_section * turn;
        let across = along.atan().cos();
        let way: Vec<_> = self.bands(along, BANDS).iter().map(|at| Point2::new(at.x, at.y * across)).collect();
        let profile = simplified(&way);
        if profile.len() < 2 {
            return CutSurface::new(vec![Plane::of_frame(food_from_section)], Vec::new());
        }
        CutSurface::from_profile(&turned, &profile)
    }
}

/// Corners of a polyline near `way`: of most strips, and fewer if that is near enough.
fn simplified(way: &[Point2<f64>]) -> Vec<Point2<f64>> {
    if way.len() < 2 {
        return Vec::new();
    }
    let mut corners = vec![0, way.len() - 1];
    while corners.len() <= MOST_STRIPS {
        let Some((at, distance)) = farthest(way, &corners) else { break };
        if distance <= CLOSE_M {
            break;
        }
        corners.push(at);
        corners.sort_unstable();
    }
    corners.into_iter().map(|corner| way[corner]).collect()
}

/// The point farthest from the polyline through `corners`, and its distance across.
fn farthest(way: &[Point2<f64>], corners: &[usize]) -> Option<(usize, f64)> {
    let between = corners.windows(2).flat_map(|pair| {
        let (from, to) = (way[pair[0]], way[pair[1]]);
        let slope = (to.y - from.y) / (to.x - from.x);
        (pair[0] + 1..pair[1]).map(move |at| (at, (way[at].y - from.y - slope * (way[at].x - from.x)).abs()))
    });
    between.max_by(|one, other| one.1.total_cmp(&other.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn way(deviation: impl Fn(f64) -> f64) -> Vec<Point2<f64>> {
        (0..30).map(|band| 0.001 * f64::from(band)).map(|y| Point2::new(y, deviation(y))).collect()
    }

    #[test]
    fn a_straight_way_is_one_strip_whatever_it_leans() {
        assert_eq!(simplified(&way(|y| 0.3 * y - 0.01)).len(), 2);
        assert_eq!(simplified(&[]).len(), 0);
    }

    #[test]
    fn a_wave_is_followed_closely_or_by_ten_strips() {
        let slow = way(|y| 0.001 * (200.0 * y).sin());
        let corners = simplified(&slow);
        assert!(corners.len() < MOST_STRIPS + 1, "{}", corners.len());
        let distance = |at: &Point2<f64>| {
            let pair = corners.windows(2).find(|pair| at.x <= pair[1].x).unwrap();
            let share = (at.x - pair[0].x) / (pair[1].x - pair[0].x);
            (at.y - pair[0].y - share * (pair[1].y - pair[0].y)).abs()
        };
        assert!(slow.iter().map(distance).fold(0.0, f64::max) <= CLOSE_M);
        assert_eq!(simplified(&way(|y| 0.01 * (2000.0 * y).sin())).len(), MOST_STRIPS + 1);
    }
}
