//! Plans of cuts: approach, cut and withdraw at one section after the other, with travels between them.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::in_plane::{InPlane, track};
use super::learning::CutSkill;
use super::refusal::CutError;
use super::section::Section;
use super::stroke::StrokeTask;
use super::task::CutTask;
use crate::spatial::{ActionPhase, SpatialAction, SpatialPlan, SpatialTrack, free_move, over};

/// Plan of a knife for one or more cuts.
#[derive(Debug, Clone, PartialEq)]
pub struct CutPlan {
    /// Poses of the knife, `world_from_tool`: see [`super::Blade`] for its frame.
    pub plan: SpatialPlan,
    /// One entry per section.
    pub cuts: Vec<CutReport>,
}

/// What is known of one planned cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutReport {
    /// Index of the plan's action that cuts.
    pub action: usize,
    /// Number of strokes to and fro.
    pub strokes: usize,
    /// Draw along the edge over depth, unsigned.
    pub slice_push_ratio: f64,
    /// Certified: the edge never is farther past the board's surface, m.
    pub past_board_m: f64,
    /// Certified: least distance of the food from an end of the usable edge, m; where the edge is shorter than the food, of
    /// the edge from leaving it. NaN for the plain primitive, of which nothing is known.
    pub edge_margin_m: f64,
}

impl CutSkill {
    /// Plans the cuts of a task; every stroke is in the plane of its section and certified to stay inside its corridor.
    ///
    /// # Errors
    /// A [`CutError`] naming what is invalid, what the edge cannot do, or what is not certified.
    pub fn plan(&self, task: &CutTask) -> Result<CutPlan, CutError> {
        task.validate()?;
        let mut cuts = Vec::with_capacity(task.sections.len());
        let mut strokes = Vec::with_capacity(task.sections.len());
        for (cut, section) in task.sections.iter().enumerate() {
            let asked = StrokeTask { cut, section, blade: &task.blade, options: &task.options };
            let planned = asked.plan(self)?;
            strokes.push(track(section, &planned.states)?);
            cuts.push(CutReport {
                action: 0,
                strokes: planned.passes,
                slice_push_ratio: planned.slice_push_ratio,
                past_board_m: planned.past_board_m,
                edge_margin_m: planned.edge_margin_m,
            });
        }
        self.chained(task, strokes, cuts, ActionPhase::Cut)
    }

    /// Chains the strokes: over to the first, up after each, over to the next.
    pub(super) fn chained(
        &self,
        task: &CutTask,
        strokes: Vec<SpatialTrack>,
        mut cuts: Vec<CutReport>,
        phase: ActionPhase,
    ) -> Result<CutPlan, CutError> {
        let lift_m = task.options.lift_m.unwrap_or(self.shown.lift_m).max(task.options.lead_m);
        let tops = task.sections.iter().map(|section| section.world_from_section.translation.vector.z);
        let above_m = tops.fold(f64::NEG_INFINITY, f64::max) + lift_m;
        let config = &task.options.free_move;
        let mut actions = Vec::new();
        let mut here = task.home;
        let last = strokes.len() - 1;
        for (index, (stroke, section)) in strokes.into_iter().zip(&task.sections).enumerate() {
            let [start, end] = [stroke.start().pose, stroke.end().pose];
            let above = lifted(&start, above_m);
            let number = index + 1;
            let travel = over(&here, &above, above_m);
            if moves(&travel) {
                let travel = free_move(config, &travel)?;
                actions.push(SpatialAction::new(format!("travel {number}"), ActionPhase::Travel, travel));
            }
            if moves(&[above, start]) {
                let approach = free_move(config, &[above, start])?;
                actions.push(SpatialAction::new(format!("approach {number}"), ActionPhase::Approach, approach));
            }
            if let Some(cut) = cuts.get_mut(index) {
                cut.action = actions.len();
            }
            actions.push(SpatialAction::new(format!("cut {number}"), phase, stroke));
            // out of the food the way it came, then up
            here = withdrawn(&end, section, above_m);
            if moves(&[end, here]) {
                let withdraw = free_move(config, &[end, here])?;
                actions.push(SpatialAction::new(format!("withdraw {number}"), ActionPhase::Withdraw, withdraw));
            }
            if index == last {
                break;
            }
        }
        Ok(CutPlan { plan: SpatialPlan::new(actions)?, cuts })
    }
}

fn lifted(pose: &Isometry3<f64>, above_m: f64) -> Isometry3<f64> {
    let mut lifted = *pose;
    lifted.translation.vector.z = lifted.translation.vector.z.max(above_m);
    lifted
}

/// The pose out of the food against the direction of the cut, up to a height of the world.
fn withdrawn(end: &Isometry3<f64>, section: &Section, above_m: f64) -> Isometry3<f64> {
    let up = -(section.world_from_section.rotation * Vector3::y());
    let way_m = ((above_m - end.translation.vector.z) / up.z).max(0.0);
    Isometry3::from_parts(Translation3::from(end.translation.vector + up * way_m), end.rotation)
}

fn moves(poses: &[Isometry3<f64>]) -> bool {
    poses.windows(2).any(|pair| {
        (pair[1].translation.vector - pair[0].translation.vector).norm() > 1e-9
            || pair[1].rotation.angle_to(&pair[0].rotation) > 1e-9
    })
}

/// States of a straight stroke in a section for what is not learned: minimum jerk in draw, depth and rocking.
pub(super) fn straight(from: InPlane, to: InPlane, duration_s: f64) -> Vec<(f64, InPlane)> {
    vec![(0.0, from), (duration_s, to)]
}

/// The pose of a state in a section, `world_from_tool`.
pub(super) fn pose(section: &Section, draw_m: f64, depth_m: f64, rock_rad: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_scaled_axis(Vector3::z() * rock_rad);
    section.world_from_section * Isometry3::from_parts(Translation3::new(draw_m, depth_m, 0.0), turn)
}
