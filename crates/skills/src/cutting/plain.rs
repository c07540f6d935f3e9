//! The plain primitive to compare with: the whole demonstration as it was, its noise too, moved to where the cut is wanted.

use nalgebra::{Isometry3, Translation3};

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
    /// Plans the same cuts with a pose primitive of the whole demonstration: it is moved with the board below the section, so
    /// that its deepest point lies as far past the board as is asked, and is as fast in the food as is asked. Size of the
    /// food, length of the edge and largest distance past the board are not looked at.
    ///
    /// # Errors
    /// A [`CutError`] if the task is invalid or the motion cannot be rolled out.
    pub fn plain_dmp(&self, task: &CutTask) -> Result<CutPlan, CutError> {
        task.validate()?;
        let shown = &self.whole;
        let from_shown = shown.section.world_from_board().inverse();
        let [first, last] = &shown.ends;
        let mut strokes = Vec::with_capacity(task.sections.len());
        let slower = task.options.speed_m_per_s.map_or(1.0, |speed| self.shown.speed_m_per_s() / speed);
        // the primitive was learned where it was shown: moved with its start and goal it gives the motion moved
        let here =
            PoseRequest { settle_s: SETTLE_S, ..PoseRequest::new(*first, *last, slower * shown.duration_s, STEP_S) };
        let rollout = self.plain.rollout(&here)?;
        let end = rollout.motions.len().saturating_sub(1);
        let below_board = |pose: &Isometry3<f64>| (from_shown * pose).translation.y;
        let deepest_m =
            rollout.motions.iter().map(|motion| below_board(&motion.pose)).fold(f64::NEG_INFINITY, f64::max);
        let deeper = Translation3::new(0.0, task.options.past_board_m - deepest_m, 0.0);
        for section in &task.sections {
            let moved = section.world_from_board() * deeper * from_shown;
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
