//! The plain primitive to compare with: the whole demonstration as it was, moved to where the pour is wanted.

use super::learning::PourSkill;
use super::planning::{PourPlan, PourReport, resting_at};
use super::refusal::PourError;
use super::task::PourTask;
use crate::primitive::pose::PoseRequest;
use crate::spatial::{ActionPhase, SpatialAction, SpatialKnot, SpatialMotion, SpatialPlan, SpatialTrack};

/// Time between the knots, s, and after the end until the motion has settled.
const STEP_S: f64 = 0.01;
const SETTLE_S: f64 = 0.5;

impl PourSkill {
    /// Plans the same pour with a pose primitive of the demonstration up to its greatest tilt: the goal is moved with the
    /// middle of the mouth and the direction of pouring; shapes of cup and mouth and the fill are not looked at.
    ///
    /// # Errors
    /// A [`PourError`] if the task is invalid or the motion cannot be rolled out.
    pub fn plain_dmp(&self, task: &PourTask) -> Result<PourPlan, PourError> {
        task.validate()?;
        // seen from where it was shown, so that the way is turned with the direction of pouring
        let moved = task.mouth.world_from_pour(task.direction()) * self.whole.world_from_pour.inverse();
        let duration_s = task.options.plain_duration * self.whole.duration_s;
        let request = PoseRequest {
            settle_s: SETTLE_S,
            ..PoseRequest::new(moved.inverse() * task.start, self.whole.steepest, duration_s, STEP_S)
        };
        let rollout = self.plain.rollout(&request)?;
        let end = rollout.motions.len().saturating_sub(1);
        let knots = rollout.times_s.iter().zip(&rollout.motions).enumerate().map(|(row, (time_s, motion))| {
            let moving = SpatialMotion::new(
                motion.pose,
                [motion.linear_velocity_m_per_s, motion.angular_velocity_rad_per_s],
                [motion.linear_acceleration_m_per_s2, motion.angular_acceleration_rad_per_s2],
            );
            let rests = row == 0 || row == end;
            let motion = if rests { SpatialMotion::at_rest(motion.pose) } else { moving };
            SpatialKnot { time_s: *time_s, motion }
        });
        let whole = SpatialTrack::new(knots.collect())?.seen_from(&moved);
        let hold = resting_at(whole.end().pose, task.options.hold_s)?;
        let back = whole.reversed()?;
        let report = PourReport {
            onset_rad: task.source.onset_rad(task.fill.height_m, task.fill.stability_rad),
            flows_from_rad: f64::NAN,
            end_rad: f64::NAN,
            gap_m: f64::NAN,
            off_center_m: f64::NAN,
            clearance_m: f64::NAN,
            flows_from_s: f64::NAN,
            direction_rad: task.direction(),
            exit_speed_m_per_s: f64::NAN,
            throw_m: f64::NAN,
            landing_m: f64::NAN,
        };
        let plan = SpatialPlan::new(vec![
            SpatialAction::new("pour", ActionPhase::Whole, whole),
            SpatialAction::new("hold", ActionPhase::Hold, hold),
            SpatialAction::new("return", ActionPhase::Return, back),
        ])?;
        Ok(PourPlan::plain(plan, report))
    }
}
