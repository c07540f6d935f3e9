//! How well a push was done: measures out of plan and episode alone.

use nalgebra::{Isometry2, Point2};
use sim::planar::{Episode, EpisodeSample, ObjectConfig, WorldConfig};
use skills::outline::separation_m;
use skills::plan::{ActionKind, Plan, Push};
use skills::tool::Tool;
use skills::tool_use::LearningReport;

use super::{PushTask, drawn};
use crate::measures::{distance_to_path_m, log_dimensionless_jerk, path_length_m, rms_and_max};
use crate::outcome::{Limit, Measure};

const MM: f64 = 1e3;
/// A gap in a contact that is longer than this counts as lost contact, s.
const GAP_S: f64 = 0.020;
/// Time between two looks at clearances and paths, s: 0.5 mm of travel.
const LOOK_S: f64 = 0.010;
/// A planned way of the tool may come this near to the object, m: rounding of a learned way, not a push.
const PLAN_CLEARANCE_M: f64 = -0.0002;

/// Checks that a plan keeps tool and object clear of obstacles, and the tool clear of the object between pushes.
///
/// The error says which action, when, and by how much.
pub fn check_plan(plan: &Plan, tool: &Tool, object: &ObjectConfig, world: &WorldConfig) -> Result<(), String> {
    let mut begun_s = 0.0;
    for action in plan.actions() {
        let looks = (action.tool.duration_s() / LOOK_S).ceil() as usize;
        for look in 0..=looks {
            let local_s = look as f64 * LOOK_S;
            let (pose, at) = (action.tool.at(local_s).pose(), action.object.at(local_s).pose());
            let place = || format!("in the action '{}' at {:.2} s of the plan", action.name, begun_s + local_s);
            if let Some((name, distance)) =
                nearest_obstacle(world, tool, &pose, object, &at).filter(|near| near.1 < 0.0)
            {
                let depth = -distance * MM;
                return Err(format!(
                    "plan push: {name} would overlap by {depth:.1} mm {}; expected no overlap; move start_m, goal_m or the obstacle",
                    place()
                ));
            }
            let margin = world.map.margin_m(&Point2::from(at.translation.vector));
            if margin < 0.0 {
                let outside = -margin * MM;
                return Err(format!(
                    "plan push: the object would leave the map by {outside:.1} mm {}; widen world.map",
                    place()
                ));
            }
            let between = tool
                .pieces
                .iter()
                .filter_map(|piece| separation_m(&piece.shape, &(pose * piece.pose()), &object.shape, &at));
            let gap = between.fold(f64::INFINITY, f64::min);
            if matches!(action.kind, ActionKind::ToolFlipping) && gap < PLAN_CLEARANCE_M {
                let depth = -gap * MM;
                return Err(format!(
                    "plan push: the tool would cut {depth:.1} mm into the object {}; expected the learned way to go round \
                     it; demonstrate wider ways",
                    place()
                ));
            }
        }
        begun_s += action.tool.duration_s();
    }
    Ok(())
}

/// Nearest pair of an obstacle with the tool or the object: its name and distance, m.
fn nearest_obstacle(
    world: &WorldConfig,
    tool: &Tool,
    world_from_tool: &Isometry2<f64>,
    object: &ObjectConfig,
    world_from_object: &Isometry2<f64>,
) -> Option<(String, f64)> {
    let tool_pieces = tool.pieces.iter().map(|piece| ("the tool", &piece.shape, world_from_tool * piece.pose()));
    let all = tool_pieces.chain(std::iter::once(("the object", &object.shape, *world_from_object)));
    let pairs = all.flat_map(|(what, shape, pose)| {
        world.obstacles.iter().filter_map(move |obstacle| {
            let distance = separation_m(shape, &pose, &obstacle.shape, &obstacle.placed().pose())?;
            Some((what, obstacle.name.as_str(), distance))
        })
    });
    let (what, obstacle, distance) = pairs.min_by(|a, b| a.2.total_cmp(&b.2))?;
    Some((format!("{what} and '{obstacle}'"), distance))
}

/// Smallest distances of tool and object from obstacles over an episode, m.
fn clearances_m(task: &PushTask<'_>, episode: &Episode) -> (Option<f64>, Option<f64>) {
    let scenario = &task.push.scenario;
    let every = looks(episode);
    let object = every
        .clone()
        .filter_map(|sample| scenario.world.clearance_m(&scenario.object.shape, &sample.world_from_object));
    let object = object.map(|(_, distance)| distance).min_by(f64::total_cmp);
    let tool =
        every.flat_map(|sample| {
            task.push.tool.pieces.iter().filter_map(move |piece| {
                scenario.world.clearance_m(&piece.shape, &(sample.world_from_tool * piece.pose()))
            })
        });
    (object, tool.map(|(_, distance)| distance).min_by(f64::total_cmp))
}

fn looks(episode: &Episode) -> impl Iterator<Item = &EpisodeSample> + Clone {
    let stride = (LOOK_S / episode.control_period_s).round().max(1.0) as usize;
    episode.samples.iter().step_by(stride)
}

fn place(pose: &Isometry2<f64>) -> Point2<f64> {
    Point2::from(pose.translation.vector)
}

/// The measures of a push.
pub fn measures(task: &PushTask<'_>, plan: &Plan, episode: &Episode) -> Vec<Measure> {
    let limits = &task.push.scenario.limits;
    let end = episode.samples.last();
    let goal = Point2::from(task.config.goal_m);
    let goal_error = end.map(|sample| (place(&sample.world_from_object) - goal).norm() * MM);
    let (object_clearance, tool_clearance) = clearances_m(task, episode);
    let clearance = |value: Option<f64>| value.map(|value| value * MM);
    let tool_limit = Limit::AtLeast(limits.clearance_m * MM);
    let object_limit = limits.object_clearance_m.map_or(tool_limit, |clearance_m| Limit::AtLeast(clearance_m * MM));
    let object_path: Vec<_> = looks(episode).map(|sample| place(&sample.world_from_object)).collect();
    let tool_path: Vec<_> = looks(episode).map(|sample| place(&sample.world_from_tool)).collect();
    let planned: Vec<_> = plan.actions().iter().flat_map(|action| drawn(&action.object)).collect();
    let pushed =
        looks(episode).filter(|sample| is_push(plan, sample.phase)).map(|sample| place(&sample.world_from_object));
    let deviation = rms_and_max(pushed.filter_map(|point| distance_to_path_m(&point, &planned)));
    let tool_error =
        |sample: &EpisodeSample| (place(&sample.world_from_tool) - place(&sample.world_from_tool_reference)).norm();
    let (tool_rms, tool_max) = rms_and_max(episode.samples.iter().map(tool_error));
    let largest = |value: fn(&EpisodeSample) -> f64| episode.samples.iter().map(value).fold(0.0, f64::max);
    let effort_j: f64 = episode.samples.iter().map(|sample| sample.power_w * episode.control_period_s).sum();
    let contact = ContactStory::of(task, plan, episode);
    let mut measures = vec![Measure::judged(
        "goal_error_mm",
        "distance to goal",
        goal_error,
        "mm",
        Limit::AtMost(limits.goal_error_m * MM),
    )];
    if !task.push.scenario.world.obstacles.is_empty() {
        measures.push(Measure::judged(
            "object_clearance_mm",
            "object to obstacles",
            clearance(object_clearance),
            "mm",
            object_limit,
        ));
        measures.push(Measure::judged(
            "tool_clearance_mm",
            "tool to obstacles",
            clearance(tool_clearance),
            "mm",
            tool_limit,
        ));
    }
    let margin = looks(episode).map(|sample| task.push.scenario.world.map.margin_m(&place(&sample.world_from_object)));
    let margin = margin.min_by(f64::total_cmp).map(|margin| margin * MM);
    measures.extend([
        Measure::judged("collisions", "contacts with obstacles", collisions(episode), "1", Limit::AtMost(0.0)),
        Measure::judged("map_margin_mm", "object's center inside the map", margin, "mm", Limit::AtLeast(0.0)),
        Measure::reported("duration_s", "duration, with the rest at the end", episode.duration_s(), "s"),
        Measure::reported("planned_duration_s", "planned duration, without it", plan.duration_s(), "s"),
        Measure::reported("object_path_mm", "object's path", path_length_m(&object_path) * MM, "mm"),
        Measure::reported(
            "path_deviation_rms_mm",
            "object off its planned path in pushes, rms",
            deviation.0 * MM,
            "mm",
        ),
        Measure::reported(
            "path_deviation_max_mm",
            "object off its planned path in pushes, largest",
            deviation.1 * MM,
            "mm",
        ),
        Measure::reported("contact_losses", "contacts lost while pushing", contact.losses, "1"),
        Measure::reported("renewed_holds_execution", "holds renewed while pushing", renewed_holds(episode), "1"),
        Measure::reported("contact_lost_s", "time without contact while pushing", contact.lost_s, "s"),
        Measure::reported("slip_mm", "sliding on the tool while pushing", contact.slip_m * MM, "mm"),
        Measure::reported("surface_used", "largest share of a surface's usable half", contact.surface_used, "1"),
        knocked(contact.knocked_m * MM, limits.knocked_m),
        Measure::reported("coasting_mm", "object's way after the last contact", contact.coasting_m * MM, "mm"),
        Measure::reported(
            "peak_force_n",
            "largest force of the tool, one time step",
            largest(|sample| sample.tool_force_n),
            "N",
        ),
        Measure::reported("tool_error_rms_mm", "tool off its reference, rms", tool_rms * MM, "mm"),
        Measure::reported("tool_error_max_mm", "tool off its reference, largest", tool_max * MM, "mm"),
        Measure::reported(
            "joint_error_max_mrad",
            "joint off its reference, largest",
            largest(|sample| sample.joint_error_rad) * 1e3,
            "mrad",
        ),
        Measure::reported(
            "torque_share_max_percent",
            "torque as a share of its joint's limit, largest",
            largest(|sample| sample.torque_share) * 1e2,
            "%",
        ),
        Measure::reported("effort_j", "mechanical work of the motors", effort_j, "J"),
        Measure::reported(
            "smoothness_ldj",
            "smoothness of the tool (log dimensionless jerk)",
            log_dimensionless_jerk(&tool_path, LOOK_S),
            "1",
        ),
    ]);
    measures
}

/// How far the object went while it was not pushed, judged if there is a limit.
fn knocked(way_mm: f64, limit_m: Option<f64>) -> Measure {
    let (name, label, unit) = ("knocked_mm", "object moved between pushes", "mm");
    match limit_m {
        None => Measure::reported(name, label, way_mm, unit),
        Some(limit_m) => Measure::judged(name, label, way_mm, unit, Limit::AtMost(limit_m * MM)),
    }
}

/// Times that tool or object came to touch an obstacle.
fn collisions(episode: &Episode) -> f64 {
    beginnings(episode, |sample| sample.hits_obstacle)
}

/// Times that the tool let the object go in a push to hold it elsewhere.
fn renewed_holds(episode: &Episode) -> f64 {
    beginnings(episode, |sample| sample.renews_hold)
}

/// Times that something began to be the case.
fn beginnings(episode: &Episode, is_so: fn(&EpisodeSample) -> bool) -> f64 {
    let all = || episode.samples.iter().map(is_so);
    let first = u8::from(all().next().unwrap_or(false));
    all().zip(all().skip(1)).filter(|(before, now)| !before && *now).count() as f64 + f64::from(first)
}

fn is_push(plan: &Plan, phase: usize) -> bool {
    plan.actions().get(phase).is_some_and(|action| matches!(action.kind, ActionKind::ObjectOperating(_)))
}

/// Measures of the demonstrations behind a run.
pub fn demonstration_measures(failed: usize, report: &LearningReport) -> Vec<Measure> {
    vec![
        Measure::reported("demonstrations_used", "demonstrations learned from", report.used.len() as f64, "1"),
        Measure::reported("demonstrations_failed", "demonstration trials that failed", failed as f64, "1"),
        Measure::reported("demonstrations_left_out", "demonstrations left out", report.left_out.len() as f64, "1"),
        Measure::reported(
            "renewed_holds",
            "holds renewed within demonstrated pushes",
            report.renewed_holds as f64,
            "1",
        ),
    ]
}

/// What the contact between tool and object went through.
#[derive(Default)]
struct ContactStory {
    losses: f64,
    lost_s: f64,
    slip_m: f64,
    surface_used: f64,
    knocked_m: f64,
    coasting_m: f64,
}

impl ContactStory {
    fn of(task: &PushTask<'_>, plan: &Plan, episode: &Episode) -> Self {
        let mut story = Self::default();
        let dt = episode.control_period_s;
        let (mut phase, mut gap_s, mut touched) = (usize::MAX, 0.0, false);
        for (sample, next) in episode.samples.iter().zip(episode.samples.iter().skip(1)) {
            if sample.phase != phase {
                (phase, gap_s, touched) = (sample.phase, 0.0, false);
            }
            let moved = (place(&next.world_from_object) - place(&sample.world_from_object)).norm();
            let Some(ActionKind::ObjectOperating(push)) = plan.actions().get(phase).map(|action| action.kind) else {
                story.knocked_m += moved;
                continue;
            };
            if sample.renews_hold {
                // letting go on purpose is no loss, until the object is touched again
                (gap_s, touched) = (0.0, false);
            } else if sample.tool_force_n > 0.0 {
                touched = true;
                gap_s = 0.0;
                story.slip_m += sample.slip_m_per_s * dt;
                story.surface_used = story.surface_used.max(used_share(task, &push, sample));
            } else if touched {
                story.lost_s += dt;
                story.losses += f64::from(u8::from(gap_s <= GAP_S && gap_s + dt > GAP_S));
                gap_s += dt;
            }
        }
        let last_touch = episode.samples.iter().rposition(|sample| sample.tool_force_n > 0.0);
        if let Some((touch, end)) = last_touch.and_then(|row| episode.samples.get(row)).zip(episode.samples.last()) {
            story.coasting_m = (place(&end.world_from_object) - place(&touch.world_from_object)).norm();
        }
        story
    }
}

/// How far from the middle of its surface the object is held, as a share of the usable half.
fn used_share(task: &PushTask<'_>, push: &Push, sample: &EpisodeSample) -> f64 {
    let Some(surface) = task.push.tool.surfaces.get(push.surface) else { return 0.0 };
    let in_tool = sample.world_from_tool.inverse() * place(&sample.world_from_object);
    (surface.place_m(&in_tool) / (surface.length_m() / 2.0)).abs()
}

#[cfg(test)]
#[path = "judge_tests.rs"]
mod tests;
