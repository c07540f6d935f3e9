//! A push with a skill that is transferred to another tool: the planner fed from the scenario, and what is told of it.

use nalgebra::Point2;
use robot::Manipulator;
use sim::planar::ArmReach;
use skills::outline::PlacedOutline;
use skills::tool::Tool;
use skills::transfer::{Side, Transfer, TransferProblem, Workplace};

use super::config::TransferTask;
use super::{Learned, PLAN_STEP_S, PushTask, StageError, broken};
use crate::outcome::Measure;

/// Plans the transfer of `skills` from where the object was seen.
pub fn plan(
    task: &PushTask<'_>,
    config: &TransferTask,
    skills: &Learned,
    start_world: Point2<f64>,
    model: &Manipulator,
) -> Result<Transfer, StageError> {
    let scenario = &task.push.scenario;
    let reach = ArmReach::new(model, &scenario.robot.tool_frame).map_err(broken)?;
    let obstacles: Vec<PlacedOutline> = scenario.world.obstacles.iter().map(|obstacle| obstacle.placed()).collect();
    let sides: Vec<Option<Side>> =
        scenario.world.obstacles.iter().map(|obstacle| config.sides.get(&obstacle.name).copied()).collect();
    let problem = TransferProblem {
        workplace: Workplace {
            map_min: scenario.world.map.min_m.into(),
            map_max: scenario.world.map.max_m.into(),
            obstacles: &obstacles,
            object_margin_m: config.planner.object_margin_m,
            tool_margin_m: config.planner.tool_margin_m,
            object: &scenario.object.shape,
            object_angle_rad: task.config.start_angle_rad,
            tool: &task.push.tool,
            tool_angle_rad: config.tool_angle_rad,
            tool_passes: false,
            reach: &reach,
        },
        config: &config.planner,
        start_world,
        goal_world: task.config.goal_m.into(),
        home_world: task.config.home_m.into(),
        park_world: task.config.park_m().into(),
        sides: &sides,
        push_speed_m_per_s: task.config.push_speed_m_per_s,
        free_speed_m_per_s: task.config.free_speed_m_per_s,
        time_step_s: PLAN_STEP_S,
    };
    problem.plan(&skills.library).map_err(|error| StageError::Infeasible(error.to_string()))
}

/// What is measured of a plan that was transferred.
pub fn measures(transfer: &Transfer) -> Vec<Measure> {
    let flips = transfer.flips.iter();
    let closest = flips.clone().map(|flip| flip.certificate.middle_clearance_m * 1e3).min_by(f64::total_cmp);
    let largest_k2 = flips.map(|flip| flip.k2).max_by(f64::total_cmp);
    vec![
        Measure::reported("phases", "phases of the plan", transfer.phases.phases.len() as f64, "1"),
        Measure::reported("flips", "changes of the contact surface", transfer.flips.len() as f64, "1"),
        Measure::reported("barred_switches", "changes given up in planning", transfer.barred_switches as f64, "1"),
        Measure::reported("flip_clearance_mm", "planned clearance halfway through flips, least", closest, "mm"),
        Measure::reported("flip_k2_max", "factor k2 of the flips, largest", largest_k2, "1"),
    ]
}

/// What is said of a plan that was transferred.
pub fn notes(transfer: &Transfer, tool: &Tool) -> Vec<String> {
    let name = |surface: usize| tool.surfaces.get(surface).map_or("?", |surface| surface.name.as_str());
    let surfaces: Vec<&str> = transfer.phases.phases.iter().map(|phase| name(phase.hold.surface)).collect();
    let mut notes = vec![format!("plan: surfaces {}", surfaces.join(" - "))];
    notes.extend(transfer.reference.refusal.iter().map(|reason| {
        format!("plan: the generalized path was not kept out of the obstacles, the search was: {reason}")
    }));
    notes
}
