//! The plain primitive to compare with: the whole demonstration as it was, its noise too, moved to where the cut is wanted.

use super::learning::CutSkill;
use super::planning::{CutPlan, CutReport};
use super::refusal::CutError;
use super::task::CutTask;
use crate::primitive::pose::PoseRequest;
use crate::spatial::{ActionPhase, SpatialKnot, SpatialMotion, SpatialTrack};

/// Time between the knots, s, and after the end until the motion has settled.
const STEP_S: f64 = 0.01;
const SETTLE_S: f64 = 0.5;

impl CutSkill {
    /// Plans the same cuts with a pose primitive of the whole demonstration: start and goal are moved with the board below
    /// the section, so that it is reached; size of the food and length of the edge are not looked at.
    ///
    /// # Errors
    /// A [`CutError`] if the task is invalid or the motion cannot be rolled out.
    pub fn plain_dmp(&self, task: &CutTask) -> Result<CutPlan, CutError> {
        task.validate()?;
        let shown = &self.demonstration;
        let from_shown = shown.section.world_from_board().inverse();
        let (Some(first), Some(last)) = (shown.knife.poses().first(), shown.knife.poses().last()) else {
            return Err(CutError::Phase { phase: "cut" });
        };
        let mut strokes = Vec::with_capacity(task.sections.len());
        for section in &task.sections {
            let moved = section.world_from_board() * from_shown;
            let request = PoseRequest {
                settle_s: SETTLE_S,
                ..PoseRequest::new(moved * first, moved * last, shown.knife.duration_s(), STEP_S)
            };
            // the primitive was learned where it was shown: turned with its start and goal it gives the motion turned
            let here = PoseRequest { start: *first, goal: *last, ..request };
            let rollout = self.plain.rollout(&here)?;
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
            strokes.push(SpatialTrack::new(knots.collect())?.seen_from(&moved));
        }
        let unknown = CutReport {
            action: 0,
            strokes: 1,
            slice_push_ratio: self.shown.slice_push_ratio.abs(),
            past_board_m: f64::NAN,
            edge_margin_m: f64::NAN,
        };
        let cuts = vec![unknown; task.sections.len()];
        self.chained(task, strokes, cuts, ActionPhase::Whole)
    }
}
