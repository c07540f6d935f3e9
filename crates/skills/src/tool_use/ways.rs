//! Ways of the tool from hold to hold: as they were shown, or the shortest one round the object where none was shown.

use nalgebra::{DVector, Point2, Vector2};

use super::closing::closed;
use super::library::{Shown, SkillLibrary, ToolFlippingSkill};
use super::routing::Surroundings;
use crate::demonstration::path;
use crate::error::SkillError;
use crate::plan::Track;
use crate::primitive::{PrimitiveConfig, RolloutRequest};
use crate::segmentation::PushFragment;
use crate::time_law::minimum_jerk;

/// Rows of a retimed way.
const RETIMED_ROWS: usize = 200;
/// Distance that a way round the object keeps from it, and by which a hold is left before, m: a learned way rounds corners.
pub(super) const ROUND_M: f64 = 0.010;

impl ToolFlippingSkill {
    /// Learns the way before push `index`, or after the last push if there is none of that index.
    pub(super) fn learn(primitive: &PrimitiveConfig, shown: &[&Shown], index: usize) -> Result<Self, SkillError> {
        let ways = shown.iter().filter_map(|(aligned, fragments)| {
            let from = index.checked_sub(1).and_then(|before| fragments.get(before)).map_or(0, PushFragment::end);
            let to = fragments.get(index).map_or(aligned.len(), |fragment| fragment.first() + 1);
            let rows = from.saturating_sub(1)..to;
            let (tool, object) = aligned.tool.get(rows.clone()).zip(aligned.object.get(rows))?;
            let rest = object.iter().map(|point| point.coords).sum::<Vector2<f64>>() / object.len().max(1) as f64;
            Some(tool.iter().map(|pose| Point2::from(pose.translation.vector - rest)).collect())
        });
        Self::along(primitive, &ways.collect::<Vec<Vec<_>>>())
    }

    /// Learns from ways relative to the object's center.
    pub(super) fn along(primitive: &PrimitiveConfig, ways: &[Vec<Point2<f64>>]) -> Result<Self, SkillError> {
        // the time step is arbitrary: a primitive learns in time over duration
        let paths =
            ways.iter().map(|way| path(&retimed(way), 1.0 / RETIMED_ROWS as f64)).collect::<Result<Vec<_>, _>>()?;
        let length_m = paths.iter().map(|path| path.path_length()).sum::<f64>() / paths.len().max(1) as f64;
        Ok(Self { primitive: primitive.learn(&paths)?, length_m })
    }
}

/// Places of the tool on its shortest way round the object, relative to the object's center.
///
/// `from` and `to` are places with the direction in which the hold there is left; without a hold it is zero. Straight
/// ahead if every way is barred.
pub(super) fn round_object(
    around: &Surroundings<'_>,
    from: (Point2<f64>, Vector2<f64>),
    to: (Point2<f64>, Vector2<f64>),
) -> Vec<Point2<f64>> {
    let clear = |(place, away): (Point2<f64>, Vector2<f64>)| place + away * (ROUND_M + CORNER_M);
    let ends = [clear(from), clear(to)];
    let between = around.way(ends[0], ends[1]).unwrap_or_else(|| ends.to_vec());
    let all = std::iter::once(from.0).chain(between).chain([to.0]);
    all.map(|place| Point2::from(place - around.object_world)).collect()
}

impl SkillLibrary {
    /// A way of the tool through free space that no demonstration shows, in the time law of the library's primitives;
    /// nothing if every way is barred.
    ///
    /// `from` and `to` are places of the tool's origin with the direction in which the hold there is left; without a hold
    /// it is zero.
    ///
    /// # Errors
    /// If the way cannot be learned or rolled out.
    pub(crate) fn free_way(
        &self,
        around: &Surroundings<'_>,
        from: (Point2<f64>, Vector2<f64>),
        to: (Point2<f64>, Vector2<f64>),
        speed_m_per_s: f64,
        time_step_s: f64,
    ) -> Result<Option<Track>, SkillError> {
        // a side of the object may lie inside the disc that holds it, out of which the hold is left first
        let clear = |(place, away): (Point2<f64>, Vector2<f64>)| {
            place + away * (around.margin_m + CORNER_M - around.clearance_m(&place).min(0.0))
        };
        let Some(between) = around.way(clear(from), clear(to)) else { return Ok(None) };
        let places: Vec<Point2<f64>> = std::iter::once(from.0).chain(between).chain([to.0]).collect();
        let skill = self.way_along(places)?;
        let steps = (skill.length_m / speed_m_per_s / time_step_s).ceil().max(FEWEST_STEPS);
        let vector = |point: Point2<f64>| DVector::from_column_slice(&[point.x, point.y]);
        let request = RolloutRequest::new(vector(from.0), vector(to.0), steps * time_step_s, time_step_s);
        let track = Track::from_rollout(&skill.primitive.rollout(&request)?, time_step_s, around.angle_rad)?;
        Track::new(time_step_s, closed(&track, &to.0.coords.push(around.angle_rad))).map(Some)
    }
}

/// A motion has at least this many time steps.
const FEWEST_STEPS: f64 = 10.0;

/// What is kept beyond the margin so that a place is free whatever lies between two looks, m.
const CORNER_M: f64 = 0.002;

/// The way of a hand without its pauses: the same places, passed with the minimum-jerk time law of one free movement.
///
/// Demonstrations wait at different times for different reasons; only once aligned do they show the same way. A way
/// that goes nowhere stays where it is.
fn retimed(way: &[Point2<f64>]) -> Vec<Point2<f64>> {
    let mut length_m = 0.0;
    let mut marks: Vec<(f64, Point2<f64>)> = Vec::with_capacity(way.len());
    for point in way {
        length_m += marks.last().map_or(0.0, |(_, last)| (point - last).norm());
        marks.push((length_m, *point));
    }
    let at = |along: f64| -> Option<Point2<f64>> {
        let next = marks.partition_point(|(mark, _)| *mark < along);
        let (to, b) = marks.get(next).or(marks.last())?;
        let (from, a) = marks.get(next.saturating_sub(1))?;
        let share = if to > from { ((along - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        Some(a + (b - a) * share)
    };
    let place = |row: usize| at(length_m * minimum_jerk(row as f64 / (RETIMED_ROWS - 1) as f64));
    (0..RETIMED_ROWS).filter_map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A few roundings of lengths of some meters.
    const ROUNDING_M: f64 = 1e-12;

    fn line(xs: &[f64]) -> Vec<Point2<f64>> {
        xs.iter().map(|x| Point2::new(*x, 0.0)).collect()
    }

    #[test]
    fn a_retimed_way_has_no_pauses_and_keeps_its_ends() {
        let way = retimed(&line(&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 3.0, 3.0]));
        assert_eq!(way.len(), RETIMED_ROWS);
        for (row, point) in way.iter().enumerate() {
            let expected = 3.0 * minimum_jerk(row as f64 / (RETIMED_ROWS - 1) as f64);
            assert_relative_eq!(*point, Point2::new(expected, 0.0), epsilon = ROUNDING_M);
        }
    }

    #[test]
    fn a_way_of_one_place_stays_there_and_one_of_none_has_no_place() {
        for way in [line(&[2.0]), line(&[2.0, 2.0]), line(&[2.0, 2.0, 2.0])] {
            assert_eq!(retimed(&way), line(&[2.0; RETIMED_ROWS]));
        }
        assert!(retimed(&[]).is_empty());
    }
}
