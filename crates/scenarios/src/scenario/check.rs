//! Checks that need more than one part of a scenario: places against map and obstacles, lists against the arm.

use nalgebra::{Isometry2, Vector2};
use robot::{Manipulator, RobotError};
use skills::outline::Outline;
use skills::tool::Tool;

use super::document::path;
use super::explain::{Context, bad_value, key_name};
use super::{DemonstrationsConfig, Scenario};
use crate::diagnostic::Diagnostic;
use crate::suggest::{did_you_mean, listed};
use crate::tasks::Stand;

/// Points that stand for the circle of a disc where its extent is asked for; a disc itself is handled exactly.
const ARC_POINTS: usize = 64;

/// Checks places against the map and the obstacles.
pub(crate) fn check_places(context: Context<'_>, scenario: &Scenario) -> Vec<Diagnostic> {
    let map = |stand: &Stand| outside_map(context, scenario, stand);
    let obstacles = |stand: &Stand| inside_obstacle(context, scenario, stand);
    stands(scenario).iter().flat_map(|stand| map(stand).or_else(|| obstacles(stand))).collect()
}

/// Checks lists and names against the arm.
pub(crate) fn check_arm(context: Context<'_>, scenario: &Scenario, arm: &Manipulator) -> Vec<Diagnostic> {
    [gains(context, scenario, arm), rotor_inertia(context, scenario, arm), tool_frame(context, scenario, arm)]
        .into_iter()
        .flatten()
        .collect()
}

/// Checks the names of the contact surfaces that a synthetic human is to use.
pub(crate) fn check_surfaces(context: Context<'_>, scenario: &Scenario, tool: &Tool) -> Vec<Diagnostic> {
    let DemonstrationsConfig::Synthetic(synthetic) = &scenario.demonstrations else { return Vec::new() };
    let known: Vec<&str> = tool.surfaces.iter().map(|surface| surface.name.as_str()).collect();
    let unknown = synthetic.surfaces.iter().enumerate().filter(|(_, name)| !known.contains(&name.as_str()));
    let problem = |(index, name): (usize, &String)| {
        let key = path(&format!("demonstrations.synthetic.surfaces.{index}"));
        context
            .problem_at_value(&key, format!("unknown contact surface in {}", key_name(&key)))
            .found(format!("{name:?}"))
            .expected(format!("one of {}, the surfaces of the tool `{}`", listed(&known), tool.name))
            .help(did_you_mean(name, &known))
    };
    unknown.map(problem).collect()
}

/// Every place at which a scenario puts the object.
fn stands(scenario: &Scenario) -> Vec<Stand> {
    let mut stands = scenario.task.stands();
    if let DemonstrationsConfig::Synthetic(synthetic) = &scenario.demonstrations {
        stands.push(Stand::new("demonstrations.synthetic.start_m", synthetic.start_m, 0.0));
        stands.push(Stand::new("demonstrations.synthetic.goal_m", synthetic.goal_m, 0.0));
    }
    stands
}

/// Smallest and largest coordinates of an outline turned like `pose`, relative to its origin, m.
fn extent(outline: &Outline, pose: &Isometry2<f64>) -> (Vector2<f64>, Vector2<f64>) {
    if let Outline::Disc { radius_m } = outline {
        return (Vector2::repeat(-radius_m), Vector2::repeat(*radius_m));
    }
    let corners = outline.drawing(ARC_POINTS);
    let turned = corners.iter().map(|&corner| pose.rotation * Vector2::from(corner));
    let start = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
    turned.fold(start, |(low, high), corner| (low.inf(&corner), high.sup(&corner)))
}

fn outside_map(context: Context<'_>, scenario: &Scenario, stand: &Stand) -> Option<Diagnostic> {
    let object = &scenario.object;
    let (low, high) = extent(&object.shape, &stand.world_from_object);
    let allowed_min = Vector2::from(scenario.world.map.min_m) - low;
    let allowed_max = Vector2::from(scenario.world.map.max_m) - high;
    let position = stand.world_from_object.translation.vector;
    let excess = (allowed_min - position).sup(&(position - allowed_max)).max();
    if excess <= 0.0 {
        return None;
    }
    let key = path(stand.key);
    let map = context.tree.nearest(&path("world.map")).span.clone();
    let problem = context
        .problem_at_value(&key, format!("{} lies outside the map", key_name(&key)))
        .found(format!("a place where `{}` reaches {} beyond the map", object.name, meters(excess)))
        .related(map, "the map");
    let fits = allowed_min.x <= allowed_max.x && allowed_min.y <= allowed_max.y;
    Some(if fits {
        let range = |low: f64, high: f64| format!("{} to {}", short(low), short(high));
        let (x, y) = (range(allowed_min.x, allowed_max.x), range(allowed_min.y, allowed_max.y));
        problem.expected(format!("x in {x} and y in {y}")).help(["move it there, or widen `map` in [world]".to_owned()])
    } else {
        problem.expected("an object smaller than the map").help(["widen `map` in [world]".to_owned()])
    })
}

fn inside_obstacle(context: Context<'_>, scenario: &Scenario, stand: &Stand) -> Option<Diagnostic> {
    let (index, clearance_m) = scenario.world.clearance_m(&scenario.object.shape, &stand.world_from_object)?;
    if clearance_m >= 0.0 {
        return None;
    }
    let name = &scenario.world.obstacles.get(index)?.name;
    let key = path(stand.key);
    let obstacle = context.tree.nearest(&path(&format!("world.obstacles.{index}.position_m"))).span.clone();
    let problem = context
        .problem_at_value(&key, format!("{} lies inside the obstacle `{name}`", key_name(&key)))
        .found(format!("an overlap of {} with `{}`", meters(-clearance_m), scenario.object.name))
        .expected("a place clear of obstacles")
        .help([format!("move it by at least {}, or move the obstacle", meters(-clearance_m))])
        .related(obstacle, format!("`{name}` stands here"));
    Some(problem)
}

fn gains(context: Context<'_>, scenario: &Scenario, arm: &Manipulator) -> Option<Diagnostic> {
    let error = scenario.controller.validate(arm.joint_count()).err()?.within("controller");
    let key = path(&error.field);
    let joints = joint_names(arm);
    let about_joints = error.expected.contains("joint").then(|| format!("the joints of the arm are {joints}"));
    Some(context.problem_at_value(&key, bad_value(&key)).found(error.found).expected(error.expected).help(about_joints))
}

fn rotor_inertia(context: Context<'_>, scenario: &Scenario, arm: &Manipulator) -> Option<Diagnostic> {
    let (found, joints) = (scenario.robot.rotor_inertia_kg_m2.len(), arm.joint_count());
    if found == 0 || found == joints {
        return None;
    }
    let key = path("robot.rotor_inertia_kg_m2");
    let problem = context
        .problem_at_value(&key, bad_value(&key))
        .found(format!("{found} numbers"))
        .expected(format!("{joints} numbers, one for each joint of the arm, or none"))
        .help([format!("the joints of the arm are {}", joint_names(arm))]);
    Some(problem)
}

fn tool_frame(context: Context<'_>, scenario: &Scenario, arm: &Manipulator) -> Option<Diagnostic> {
    let wanted = &scenario.robot.tool_frame;
    let Err(RobotError::UnknownFrame { known, .. }) = arm.frame(wanted) else { return None };
    let key = path("robot.tool_frame");
    let problem = context
        .problem_at_value(&key, format!("unknown frame in {}", key_name(&key)))
        .found(format!("{wanted:?}"))
        .expected(format!("one of {}", listed(&known)))
        .help(did_you_mean(wanted, &known));
    Some(problem)
}

fn joint_names(arm: &Manipulator) -> String {
    listed(&arm.joints().iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>())
}

/// A length to a tenth of a millimeter, or more finely if it is smaller than that.
fn meters(length_m: f64) -> String {
    if length_m < 1e-4 { format!("{length_m:.1e} m") } else { format!("{length_m:.4} m") }
}

/// A coordinate without the noise of its last bits.
fn short(coordinate_m: f64) -> String {
    let rounded: f64 = format!("{coordinate_m:.9}").parse().unwrap_or(coordinate_m);
    format!("{} m", if rounded == 0.0 { 0.0 } else { rounded })
}
