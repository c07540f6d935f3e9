//! Corridors from the world: on which side each obstacle is passed, and the bounds that follow for the object's center.
//!
//! The paper draws the boundary of Fig. 5(c) by hand. Here each obstacle that a path passes bounds one coordinate for as
//! long as the other one is beside it; the side is that of the demonstrations unless it is set.

use nalgebra::{DMatrix, Point2};
use serde::{Deserialize, Serialize};

use super::workplace::Workplace;
use crate::corridor::smoothing::{Smoothed, SmoothingConfig, smooth};
use crate::error::SkillError;
use crate::outline::PlacedOutline;
use crate::trajectory::Trajectory;

/// Side on which an obstacle is passed, world axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// At smaller x.
    Left,
    /// At larger x.
    Right,
    /// At smaller y.
    Below,
    /// At larger y.
    Above,
}

impl Side {
    /// Index of the coordinate that is bounded.
    #[must_use]
    pub fn axis(self) -> usize {
        usize::from(matches!(self, Self::Below | Self::Above))
    }

    fn is_high(self) -> bool {
        matches!(self, Self::Right | Self::Above)
    }

    fn new(axis: usize, high: bool) -> Self {
        match (axis, high) {
            (0, false) => Self::Left,
            (0, true) => Self::Right,
            (_, false) => Self::Below,
            (_, true) => Self::Above,
        }
    }
}

/// An obstacle that is passed on a side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Passage {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// The side.
    pub side: Side,
}

/// Extent of an obstacle that the object's center stays out of: its box, with the object and the safe margin around it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Barred {
    low: Point2<f64>,
    high: Point2<f64>,
}

impl Barred {
    fn new(place: &Workplace<'_>, obstacle: &PlacedOutline) -> Self {
        let quarter = std::f64::consts::FRAC_PI_2;
        let edge = |index: u32| {
            let angle = f64::from(index) * quarter;
            let toward_object = angle + 2.0 * quarter;
            obstacle.shape.support_m(angle - obstacle.angle_rad)
                + place.object_support_m(toward_object)
                + place.object_margin_m
        };
        let [x, y] = obstacle.position_m;
        Self { low: Point2::new(x - edge(2), y - edge(3)), high: Point2::new(x + edge(0), y + edge(1)) }
    }

    fn spans(&self, axis: usize, value: f64) -> bool {
        (self.low[axis]..=self.high[axis]).contains(&value)
    }

    fn middle(&self, axis: usize) -> f64 {
        0.5 * (self.low[axis] + self.high[axis])
    }
}

/// Finds the obstacles that `path` (n × 2, m) passes, and on which side: the one given in `set`, else that of most of
/// the `shown` paths, else that of the path.
///
/// An obstacle is passed along the coordinate in which the path goes from one end of it to the other. One that the path
/// enters without passing it, as beside its start or goal, is kept on the side from which it is entered least.
#[must_use]
pub fn passages(
    place: &Workplace<'_>,
    path: &Trajectory,
    shown: &[Vec<Point2<f64>>],
    set: &[Option<Side>],
) -> Vec<Passage> {
    let path_points = points(path);
    let find = |(index, obstacle): (usize, &PlacedOutline)| {
        let barred = Barred::new(place, obstacle);
        let side = match set.get(index).copied().flatten() {
            Some(side) => side,
            None => match (0..2).find(|along| crosses(&barred, *along, path)) {
                Some(along) => passed(&barred, 1 - along, &path_points, shown)?,
                None => entered(&barred, &path_points)?,
            },
        };
        Some(Passage { obstacle: index, side })
    };
    place.obstacles.iter().enumerate().filter_map(find).collect()
}

/// The side in `axis` on which most of the shown paths pass, or the path if they do not say.
fn passed(barred: &Barred, axis: usize, path: &[Point2<f64>], shown: &[Vec<Point2<f64>>]) -> Option<Side> {
    let votes: Vec<bool> = shown.iter().filter_map(|path| side_of(barred, axis, path)).collect();
    let high = votes.iter().filter(|is_high| **is_high).count();
    let low = votes.len() - high;
    let is_high = if high == low { side_of(barred, axis, path)? } else { high > low };
    Some(Side::new(axis, is_high))
}

/// The side of an obstacle that both ends of a path respect and beyond which the path goes least; nothing if the path
/// does not enter it.
fn entered(barred: &Barred, path: &[Point2<f64>]) -> Option<Side> {
    let inside = |point: &&Point2<f64>| (0..2).all(|axis| barred.spans(axis, point[axis]));
    path.iter().find(inside)?;
    // how far the path goes beyond a side, for as long as it is beside the obstacle
    let beyond = |side: Side, points: &[Point2<f64>]| {
        let axis = side.axis();
        let rows = points.iter().filter(|point| barred.spans(1 - axis, point[1 - axis]));
        let depths = rows
            .map(|point| if side.is_high() { barred.high[axis] - point[axis] } else { point[axis] - barred.low[axis] });
        depths.fold(f64::NEG_INFINITY, f64::max)
    };
    let ends: Vec<Point2<f64>> = [path.first(), path.last()].into_iter().flatten().copied().collect();
    let sides = [Side::Left, Side::Right, Side::Below, Side::Above];
    let possible = sides.into_iter().filter(|side| beyond(*side, &ends) <= 0.0);
    possible.min_by(|a, b| beyond(*a, path).total_cmp(&beyond(*b, path)))
}

/// Whether a path leads from before an obstacle to behind it along an axis.
fn crosses(barred: &Barred, along: usize, path: &Trajectory) -> bool {
    let values = path.samples().column(along);
    values.iter().any(|value| *value < barred.low[along]) && values.iter().any(|value| *value > barred.high[along])
}

fn points(path: &Trajectory) -> Vec<Point2<f64>> {
    path.samples().row_iter().map(|row| Point2::new(row[0], row[1])).collect()
}

/// Whether a path is above the middle of an obstacle in `axis` where it passes its middle in the other one.
fn side_of(barred: &Barred, axis: usize, path: &[Point2<f64>]) -> Option<bool> {
    let middle = barred.middle(1 - axis);
    let off = |point: &&Point2<f64>| (point[1 - axis] - middle).abs();
    let nearest = path.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    barred.spans(1 - axis, nearest[1 - axis]).then(|| nearest[axis] > barred.middle(axis))
}

/// Builds the corridor (2 coordinates, C²) of the object's center for a motion like `path`: the map, and each passed
/// obstacle for as long as the path is beside it.
///
/// # Errors
/// If the obstacles leave no way between them or to the edge of the map, or an option is out of its range.
pub fn corridor(
    place: &Workplace<'_>,
    path: &Trajectory,
    passages: &[Passage],
    config: &SmoothingConfig,
) -> Result<Smoothed, SkillError> {
    let rows = path.len();
    let quarter = std::f64::consts::FRAC_PI_2;
    let inset = |index: u32| place.object_support_m(f64::from(index) * quarter);
    let low = [place.map_min.x + inset(2), place.map_min.y + inset(3)];
    let high = [place.map_max.x - inset(0), place.map_max.y - inset(1)];
    let mut lower = DMatrix::from_fn(rows, 2, |_, axis| low[axis]);
    let mut upper = DMatrix::from_fn(rows, 2, |_, axis| high[axis]);
    for Passage { obstacle, side } in passages {
        let Some(obstacle) = place.obstacles.get(*obstacle) else { continue };
        let (barred, axis) = (Barred::new(place, obstacle), side.axis());
        for row in (0..rows).filter(|row| barred.spans(1 - axis, path.samples()[(*row, 1 - axis)])) {
            if side.is_high() {
                lower[(row, axis)] = lower[(row, axis)].max(barred.high[axis]);
            } else {
                upper[(row, axis)] = upper[(row, axis)].min(barred.low[axis]);
            }
        }
    }
    smooth(config, path.times_s(), &lower, &upper)
}

#[cfg(test)]
#[path = "passages_tests.rs"]
mod tests;
