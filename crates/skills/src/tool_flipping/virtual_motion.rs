//! The virtual object movement x^o of Eq. (24): the object's center round the outline of a resting tool.
//!
//! Departs from the paper, which leaves its shape open: the object leaves the first contact along its normal, goes round
//! the tool at a constant clearance and comes to the second contact along its normal, corners rounded. It is not learned
//! as a primitive, which would add an error of fit; its ends are exact.

use nalgebra::{Point2, Vector2};

use super::clearance::Bodies;
use super::contour::Contour;
use super::options::WayRound;
use super::refusal::FlipError;
use crate::time_law::minimum_jerk;

/// Where the object touches the tool before or after a flip, in the tool's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hold {
    /// Place of the object's origin, m.
    pub(super) center: Point2<f64>,
    /// Unit vector along which the object leaves the tool.
    pub(super) normal: Vector2<f64>,
    /// Angle of the object, rad.
    pub(super) angle_rad: f64,
}

/// Way of the object's origin in the tool's frame over the part of its length, in [0, 1].
#[derive(Debug, Clone)]
pub(super) struct VirtualMotion {
    // equally spaced along the way
    places: Vec<Point2<f64>>,
    pub(super) length_m: f64,
    /// Part of the way on which the object leaves the first contact, and that on which it comes to the second.
    pub(super) lifting: [f64; 2],
    pub(super) way_round: WayRound,
}

/// Pieces of a way.
const PIECES: usize = 512;
/// Pieces of a way before they are spaced equally.
const ROUNDED_PIECES: usize = 2 * PIECES;
/// Nodes to each side by which a corner is averaged.
const AVERAGED: i32 = 16;
/// Miss of the margin at which a retreat ends, as a part of it.
const RETREATED: f64 = 1e-9;
/// Most steps of a retreat; each leaves no more than the part of the way that does not open the clearance.
const MOST_RETREATS: usize = 1000;
/// Part of the way over which its ends are kept from the rounding of corners.
const LARGEST_ROUNDING: f64 = 0.25;

impl VirtualMotion {
    /// Builds both ways round, counterclockwise first; the object turns on the way if the holds have different angles.
    ///
    /// # Errors
    /// [`FlipError::NoRetreat`] or [`FlipError::NoWayRound`].
    pub(super) fn both(bodies: &Bodies, holds: &[Hold; 2], margin_m: f64) -> Result<[Self; 2], FlipError> {
        let [first, second] = holds;
        // an object that turns is free at every angle within its circumscribed disc
        let turns = (first.angle_rad - second.angle_rad).abs() > 0.0 && bodies.lever_m() > 0.0;
        let circumscribed;
        let bodies = if turns {
            circumscribed = bodies.with_circumscribed_disc();
            &circumscribed
        } else {
            bodies
        };
        let contour = Contour { bodies, angle_rad: first.angle_rad, margin_m };
        let (from, to) = (retreat(&contour, first, "first")?, retreat(&contour, second, "second")?);
        let points = contour.trace(from)?;
        let (index, miss_m) = nearest_piece(&points, &to);
        if miss_m > contour.step_m() {
            return Err(FlipError::NoWayRound { miss_m });
        }
        let ways = [
            (WayRound::Counterclockwise, points.iter().take(index + 1).copied().collect::<Vec<_>>()),
            (WayRound::Clockwise, points.iter().take(1).chain(points.iter().skip(index + 1).rev()).copied().collect()),
        ];
        Ok(ways.map(|(way_round, between)| {
            let corners = std::iter::once(first.center).chain(between).chain([to, second.center]);
            Self::rounded(
                corners.collect(),
                margin_m,
                [(from - first.center).norm(), (to - second.center).norm()],
                way_round,
            )
        }))
    }

    /// Builds the way in the given sense.
    ///
    /// # Errors
    /// As [`VirtualMotion::both`].
    pub(super) fn new(
        bodies: &Bodies,
        holds: &[Hold; 2],
        margin_m: f64,
        way_round: WayRound,
    ) -> Result<Self, FlipError> {
        let [counterclockwise, clockwise] = Self::both(bodies, holds, margin_m)?;
        let first = match way_round {
            WayRound::Shorter => counterclockwise.length_m <= clockwise.length_m,
            WayRound::Counterclockwise => true,
            WayRound::Clockwise => false,
        };
        Ok(if first { counterclockwise } else { clockwise })
    }

    /// Evaluates the place, m, and its derivative by the part of the way at `part`, held outside [0, 1].
    pub(super) fn at(&self, part: f64) -> (Point2<f64>, Vector2<f64>) {
        let along = part.clamp(0.0, 1.0) * PIECES as f64;
        let row = (along as usize).min(PIECES - 1);
        let u = along - row as f64;
        let place = |row: usize| self.places.get(row).copied().unwrap_or_default();
        // one-sided at the ends, where the way is straight
        let slope = |row: usize| {
            let (before, after) = (row.saturating_sub(1), (row + 1).min(PIECES));
            (place(after) - place(before)) / (after - before) as f64
        };
        let (from, rise) = (place(row), place(row + 1) - place(row));
        let (into, out) = (slope(row), slope(row + 1));
        let position =
            from + rise * (u * u * (3.0 - 2.0 * u)) + into * (u * (1.0 - u) * (1.0 - u)) - out * (u * u * (1.0 - u));
        let derivative =
            rise * (6.0 * u * (1.0 - u)) + into * ((1.0 - u) * (1.0 - 3.0 * u)) + out * (u * (3.0 * u - 2.0));
        (position, derivative * PIECES as f64)
    }

    fn rounded(corners: Vec<Point2<f64>>, rounding_m: f64, lifting_m: [f64; 2], way_round: WayRound) -> Self {
        let line = Polyline::new(corners);
        let length_m = line.length_m();
        let widest_m = rounding_m.min(LARGEST_ROUNDING * length_m);
        // an average of width w(l) ≤ l: the ends stay, and so does their direction
        let width_m = |along_m: f64| match widest_m > 0.0 {
            true => widest_m * minimum_jerk(along_m.min(length_m - along_m) / (2.0 * widest_m)),
            false => 0.0,
        };
        let bent = |row: usize| {
            let along_m = length_m * row as f64 / ROUNDED_PIECES as f64;
            line.averaged(along_m, width_m(along_m))
        };
        // a rounded corner is shorter: spaced anew, so that a time law along the way is one along its length
        let way = Polyline::new((0..=ROUNDED_PIECES).map(bent));
        let length_m = way.length_m();
        let places = (0..=PIECES).map(|row| way.at(length_m * row as f64 / PIECES as f64)).collect();
        let lifting = lifting_m.map(|lifting_m| if length_m > 0.0 { lifting_m / length_m } else { 0.0 });
        Self { places, length_m, lifting, way_round }
    }
}

/// First place along the normal of a hold that is free by the margin; on the curve at the margin if the hold is farther off.
fn retreat(contour: &Contour<'_>, hold: &Hold, end: &'static str) -> Result<Point2<f64>, FlipError> {
    let (bodies, margin_m) = (contour.bodies, contour.margin_m);
    let (mut way_m, mut reached_m) = (0.0, 0.0);
    for _ in 0..MOST_RETREATS {
        let place = hold.center + hold.normal * way_m;
        reached_m = bodies.gap(&place, hold.angle_rad).distance_m;
        if reached_m >= margin_m * (1.0 - RETREATED) {
            return Ok(contour.corrected(place));
        }
        if way_m > 2.0 * bodies.reach_m() + margin_m {
            break;
        }
        // the clearance opens at most as fast as the way goes, so nothing is stepped over
        way_m += margin_m - reached_m;
    }
    Err(FlipError::NoRetreat { end, reached_m, margin_m })
}

/// The piece of a closed curve nearest to a place, by its first point, and its distance, m.
fn nearest_piece(points: &[Point2<f64>], place: &Point2<f64>) -> (usize, f64) {
    let pieces = points.iter().zip(points.iter().cycle().skip(1));
    let distances = pieces.map(|(a, b)| {
        let edge = b - a;
        let along = ((place - a).dot(&edge) / edge.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (place - (a + edge * along)).norm()
    });
    distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, f64::INFINITY))
}

/// Points with their distance along the line through them.
pub(super) struct Polyline {
    marks: Vec<(f64, Point2<f64>)>,
}

impl Polyline {
    pub(super) fn new(points: impl IntoIterator<Item = Point2<f64>>) -> Self {
        let mut marks: Vec<(f64, Point2<f64>)> = Vec::new();
        for point in points {
            let along_m = marks.last().map_or(0.0, |(along_m, last)| along_m + (point - last).norm());
            marks.push((along_m, point));
        }
        Self { marks }
    }

    pub(super) fn length_m(&self) -> f64 {
        self.marks.last().map_or(0.0, |(along_m, _)| *along_m)
    }

    /// The place at a distance along the line, held at its ends.
    pub(super) fn at(&self, along_m: f64) -> Point2<f64> {
        let next = self.marks.partition_point(|(mark, _)| *mark < along_m);
        let (Some((to, b)), Some((from, a))) =
            (self.marks.get(next).or(self.marks.last()), self.marks.get(next.saturating_sub(1)))
        else {
            return Point2::origin();
        };
        let share = if to > from { ((along_m - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
        a + (b - a) * share
    }

    /// The mean of the places within `width_m` to each side, weighted by a triangle.
    fn averaged(&self, along_m: f64, width_m: f64) -> Point2<f64> {
        let middle = self.at(along_m);
        let mut sum = Vector2::zeros();
        let mut total = 0.0;
        for node in -AVERAGED..=AVERAGED {
            let offset = f64::from(node) / f64::from(AVERAGED);
            let weight = 1.0 - offset.abs();
            sum += (self.at(along_m + offset * width_m) - middle) * weight;
            total += weight;
        }
        middle + sum / total
    }
}
