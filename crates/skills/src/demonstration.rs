//! One human run of a task: where the tool was and where the object was seen, each on its own clock's ticks.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Isometry2, Point2, Vector2};

use crate::error::SkillError;
use crate::trajectory::Trajectory;

/// A recorded demonstration. Both trajectories have columns x (m), y (m), angle (rad) in the world frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Demonstration {
    /// Name for reports: a file's name or a trial's number.
    pub name: String,
    /// Pose of the tool over time.
    pub tool: Trajectory,
    /// Pose of the object over time, as the camera saw it.
    pub object: Trajectory,
}

/// A demonstration on one uniform clock, freed of the camera's noise and the hand's tremor.
#[derive(Clone, Debug, PartialEq)]
pub struct Aligned {
    /// Time between rows, s.
    pub time_step_s: f64,
    /// Poses of the tool.
    pub tool: Vec<Isometry2<f64>>,
    /// Centers of the object.
    pub object: Vec<Point2<f64>>,
}

/// Rows per second after alignment: above the tool's recording, five times above what a hand does on purpose.
const ALIGNED_RATE_HZ: f64 = 100.0;
/// Standard deviation of the Gaussian that smooths both paths, s: keeps motions below 1.5 Hz, which are the voluntary ones.
const SMOOTHING_S: f64 = 0.10;

/// Longest time between two rows of a recording, s: a hand may turn round within more.
pub const LARGEST_GAP_S: f64 = 1.0;

impl Demonstration {
    /// Checks that both trajectories have the columns x, y, angle and overlap in time without large gaps; angles are
    /// continued across ±π.
    ///
    /// # Errors
    /// [`SkillError::Dimension`], [`SkillError::RowCount`], or [`SkillError::RecordingGap`].
    pub fn new(name: impl Into<String>, tool: Trajectory, object: Trajectory) -> Result<Self, SkillError> {
        const OPERATION: &str = "read demonstration";
        for trajectory in [&tool, &object] {
            if trajectory.dimension() != 3 {
                return Err(SkillError::Dimension { operation: OPERATION, found: trajectory.dimension(), expected: 3 });
            }
        }
        let demonstration = Self { name: name.into(), tool: unwrapped(tool)?, object: unwrapped(object)? };
        let (from, to) = demonstration.common_time_s();
        if to - from < 1.0 / ALIGNED_RATE_HZ {
            let expected = "tool and object recorded at the same time".into();
            return Err(SkillError::RowCount { operation: OPERATION, found: 0, expected });
        }
        demonstration.check_gaps()?;
        Ok(demonstration)
    }

    /// Refuses too long a time between two rows of one recording, as far as both were recording.
    fn check_gaps(&self) -> Result<(), SkillError> {
        let (from, to) = self.common_time_s();
        for (part, recording) in [("tool", &self.tool), ("object", &self.object)] {
            for pair in recording.times_s().windows(2) {
                let &[before, after] = pair else { continue };
                let (from_s, gap_s) = (before.max(from), after.min(to) - before.max(from));
                if gap_s > LARGEST_GAP_S {
                    return Err(SkillError::RecordingGap { part, gap_s, from_s, largest_s: LARGEST_GAP_S });
                }
            }
        }
        Ok(())
    }

    fn common_time_s(&self) -> (f64, f64) {
        let from = self.tool.start_time_s().max(self.object.start_time_s());
        (from, self.tool.end_time_s().min(self.object.end_time_s()))
    }

    /// Brings tool and object on one uniform clock and smooths both paths; the tool's angle is kept as recorded.
    #[must_use]
    pub fn aligned(&self) -> Aligned {
        let (from, to) = self.common_time_s();
        let time_step_s = 1.0 / ALIGNED_RATE_HZ;
        let rows = ((to - from) * ALIGNED_RATE_HZ).floor() as usize + 1;
        let time = |row: usize| from + row as f64 * time_step_s;
        let places = |recording: &Trajectory| -> Vec<Point2<f64>> {
            let raw: Vec<_> =
                (0..rows).map(|row| recording.at(time(row))).map(|pose| Point2::new(pose[0], pose[1])).collect();
            smoothed(&raw, SMOOTHING_S / time_step_s)
        };
        let poses = places(&self.tool).into_iter().enumerate();
        let tool = poses.map(|(row, place)| Isometry2::new(place.coords, self.tool.at(time(row))[2])).collect();
        Aligned { time_step_s, tool, object: places(&self.object) }
    }
}

impl Aligned {
    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.object.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.object.is_empty()
    }

    /// Speed of the object at each row, m/s.
    #[must_use]
    pub fn object_speed_m_per_s(&self) -> Vec<f64> {
        let last = self.len().saturating_sub(1);
        let at = |row: usize| self.object.get(row).copied().unwrap_or_default();
        (0..self.len())
            .map(|row| {
                let (before, after) = (row.saturating_sub(1), (row + 1).min(last));
                (at(after) - at(before)).norm() / ((after - before).max(1) as f64 * self.time_step_s)
            })
            .collect()
    }
}

/// The recording with an angle that never jumps by more than half a turn.
fn unwrapped(recording: Trajectory) -> Result<Trajectory, SkillError> {
    const ANGLE: usize = 2;
    let mut samples = recording.samples().clone();
    let mut last = None;
    for angle in samples.column_mut(ANGLE).iter_mut() {
        let turns = last.map_or(0.0, |last: f64| ((last - *angle) / TAU).round());
        *angle += turns * TAU;
        last = Some(*angle);
    }
    Trajectory::new(recording.times_s().to_vec(), samples)
}

/// Gaussian smoothing with a standard deviation of `sd` rows; the ends are continued by point reflection, so they stay.
fn smoothed(points: &[Point2<f64>], sd: f64) -> Vec<Point2<f64>> {
    let reach = (3.0 * sd).ceil() as isize;
    let last = points.len() as isize - 1;
    let at = |row: isize| -> Vector2<f64> {
        let inside = row.clamp(0, last);
        let mirrored = (2 * inside - row).clamp(0, last);
        let point = |row: isize| points.get(row.unsigned_abs()).map_or_else(Vector2::zeros, |point| point.coords);
        if row == inside { point(row) } else { point(inside) * 2.0 - point(mirrored) }
    };
    let weight = |offset: isize| (-0.5 * (offset as f64 / sd).powi(2)).exp();
    let total: f64 = (-reach..=reach).map(weight).sum();
    (0..=last)
        .map(|row| Point2::from((-reach..=reach).map(|k| at(row + k) * weight(k)).sum::<Vector2<f64>>() / total))
        .collect()
}

/// A path of places `time_step_s` apart as a trajectory.
///
/// # Errors
/// As [`Trajectory::uniform`].
pub fn path(points: &[Point2<f64>], time_step_s: f64) -> Result<Trajectory, SkillError> {
    let samples =
        DMatrix::from_fn(points.len(), 2, |row, column| points.get(row).map_or(f64::NAN, |point| point[column]));
    Trajectory::uniform(time_step_s, samples)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn straight(rate_hz: f64, offset_s: f64) -> Trajectory {
        let rows = (2.0 * rate_hz) as usize;
        let times: Vec<f64> = (0..rows).map(|k| offset_s + k as f64 / rate_hz).collect();
        let samples = DMatrix::from_fn(rows, 3, |row, column| if column == 0 { 0.1 * times[row] } else { 0.0 });
        Trajectory::new(times, samples).unwrap()
    }

    #[test]
    fn clocks_with_other_ticks_are_brought_together() {
        let demonstration = Demonstration::new("a", straight(200.0, 0.0), straight(30.0, 0.013)).unwrap();
        let aligned = demonstration.aligned();
        for (tool, object) in aligned.tool.iter().zip(&aligned.object) {
            assert_relative_eq!(tool.translation.x, object.x, epsilon = 1e-9);
        }
    }

    #[test]
    fn smoothing_keeps_straight_motion_and_both_ends() {
        let points: Vec<_> = (0..100).map(|k| Point2::new(f64::from(k), 3.0)).collect();
        for (point, smooth) in points.iter().zip(smoothed(&points, 8.0)) {
            assert_relative_eq!(*point, smooth, epsilon = 1e-9);
        }
    }

    #[test]
    fn recordings_of_different_times_are_refused() {
        assert!(Demonstration::new("a", straight(200.0, 0.0), straight(30.0, 10.0)).is_err());
    }

    #[test]
    fn a_recording_of_two_columns_is_refused() {
        let flat = Trajectory::uniform(0.1, DMatrix::zeros(20, 2)).unwrap();
        let refused = Demonstration::new("a", straight(200.0, 0.0), flat);
        assert!(matches!(refused, Err(SkillError::Dimension { found: 2, expected: 3, .. })));
    }

    #[test]
    fn a_huge_gap_is_refused_while_both_record_and_allowed_before_and_after() {
        let rows = |times: &[f64]| Trajectory::new(times.to_vec(), DMatrix::zeros(times.len(), 3)).unwrap();
        let refused = Demonstration::new("a", rows(&[0.0, 0.5, 1e9]), rows(&[0.0, 1e9]));
        assert!(matches!(refused, Err(SkillError::RecordingGap { part: "tool", gap_s, .. }) if gap_s > 9e8));
        let refused = Demonstration::new("a", rows(&[0.0, 0.5, 1.0, 1.5, 2.0]), rows(&[0.0, 0.4, 1.6, 2.0]));
        let Err(SkillError::RecordingGap { part: "object", gap_s, from_s, .. }) = refused else {
            panic!("{refused:?}")
        };
        assert!((gap_s - 1.2).abs() < 1e-12 && from_s == 0.4);
        assert!(Demonstration::new("a", rows(&[-1e9, 0.0, 0.5, 1e9]), rows(&[0.0, 0.5])).is_ok());
    }

    #[test]
    fn a_tool_that_turns_past_half_a_turn_is_not_spun_back() {
        let angle = |time: f64| Isometry2::<f64>::rotation(3.0 + 0.2 * time).rotation.angle();
        let samples = DMatrix::from_fn(40, 3, |row, column| if column == 2 { angle(row as f64 * 0.05) } else { 0.0 });
        let tool = Trajectory::uniform(0.05, samples).unwrap();
        let aligned = Demonstration::new("a", tool, straight(30.0, 0.0)).unwrap().aligned();
        for (row, pose) in aligned.tool.iter().enumerate() {
            let expected = Isometry2::<f64>::rotation(3.0 + 0.2 * row as f64 * aligned.time_step_s);
            assert!(pose.rotation.angle_to(&expected.rotation).abs() < 1e-9);
        }
    }
}
