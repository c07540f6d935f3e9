//! The closed curve on which the object's center goes round the tool at a constant clearance.
//!
//! The curve is traced on the clearance itself, so that tools of any number of pieces and objects of any outline need no
//! union of polygons, and hollows too narrow for the object are passed by.

use nalgebra::{Point2, Vector2};

use super::clearance::Bodies;
use super::refusal::FlipError;

/// Most points of a curve; a step is at least a thousandth of the reach of tool and object.
const MOST_POINTS: usize = 20_000;
/// Corrections of one point; in an acute hollow each removes a part of the error only.
const MOST_CORRECTIONS: usize = 200;
/// Part of a step by which a point may miss the clearance.
const MISS: f64 = 1e-6;
/// Part of a step within which a second piece of the tool bars the way.
const NEAR: f64 = 1e-3;

/// Curve of constant clearance round a tool.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contour<'a> {
    pub(super) bodies: &'a Bodies,
    /// Angle of the object in the tool's frame, rad.
    pub(super) angle_rad: f64,
    /// Clearance kept, m.
    pub(super) margin_m: f64,
}

impl Contour<'_> {
    /// Distance between two points of the curve, m.
    pub(super) fn step_m(&self) -> f64 {
        (0.1 * self.margin_m).max(1e-3 * self.bodies.reach_m())
    }

    /// Traces the curve through `start` counterclockwise, once round; the last point is a step or less before the first.
    ///
    /// # Errors
    /// [`FlipError::NoWayRound`] if the curve does not close.
    pub(super) fn trace(&self, start: Point2<f64>) -> Result<Vec<Point2<f64>>, FlipError> {
        let step_m = self.step_m();
        let mut points = vec![start];
        let mut place = start;
        let mut left_start = false;
        while points.len() < MOST_POINTS {
            place = self.corrected(place + self.heading(&place) * step_m);
            let distance = (place - start).norm();
            left_start |= distance > 2.0 * step_m;
            if left_start && distance <= step_m {
                return Ok(points);
            }
            points.push(place);
        }
        Err(FlipError::NoWayRound { miss_m: (place - start).norm() })
    }

    /// Moves a place onto the curve along the direction that opens the clearance.
    pub(super) fn corrected(&self, mut place: Point2<f64>) -> Point2<f64> {
        for _ in 0..MOST_CORRECTIONS {
            let gap = self.bodies.gap(&place, self.angle_rad);
            let miss = self.margin_m - gap.distance_m;
            if miss.abs() <= MISS * self.step_m() {
                break;
            }
            place += gap.outward * miss;
        }
        place
    }

    /// Direction counterclockwise along the curve: of the pieces at the clearance, round the one whose neighbors let pass.
    fn heading(&self, place: &Point2<f64>) -> Vector2<f64> {
        let limit_m = self.bodies.gap(place, self.angle_rad).distance_m + NEAR * self.step_m();
        let near = || self.bodies.gaps(place, self.angle_rad).filter(|gap| gap.distance_m <= limit_m);
        let left_of = |outward: &Vector2<f64>| Vector2::new(-outward.y, outward.x);
        let opening = |way: &Vector2<f64>| near().map(|gap| gap.outward.dot(way)).fold(f64::INFINITY, f64::min);
        let ways = near().map(|gap| left_of(&gap.outward));
        ways.max_by(|a, b| opening(a).total_cmp(&opening(b))).unwrap_or_default()
    }
}
