//! Checks that need more than one part of a pushing scenario: places against map and obstacles, surfaces against the tool.

use nalgebra::{Isometry2, Vector2};
use skills::outline::Outline;
use skills::tool::Tool;

use super::config::Stand;
use super::{DemonstrationsConfig, PushScenario};
use crate::diagnostic::Diagnostic;
use crate::scenario::{Context, key_name, path};
use crate::suggest::{did_you_mean, listed};

/// Points that stand for the circle of a disc where its extent is asked for; a disc itself is handled exactly.
const ARC_POINTS: usize = 64;

/// Checks places against the map and the obstacles.
pub fn check_places(context: Context<'_>, scenario: &PushScenario) -> Vec<Diagnostic> {
    let map = |stand: &Stand| outside_map(context, scenario, stand);
    let obstacles = |stand: &Stand| inside_obstacle(context, scenario, stand);
    scenario.stands().iter().flat_map(|stand| map(stand).or_else(|| obstacles(stand))).collect()
}

/// Checks the names of the contact surfaces that a synthetic human is to use.
pub fn check_surfaces(context: Context<'_>, scenario: &PushScenario, tool: &Tool) -> Vec<Diagnostic> {
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

fn outside_map(context: Context<'_>, scenario: &PushScenario, stand: &Stand) -> Option<Diagnostic> {
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
    let problem = context.problem_at_value(&key, format!("{} lies outside the map", key_name(&key))).found(format!(
        "a place where `{}` reaches {} beyond the map",
        object.name,
        meters(excess)
    ));
    let problem = context.source.related(problem, map, "the map");
    let fits = allowed_min.x <= allowed_max.x && allowed_min.y <= allowed_max.y;
    Some(if fits {
        let range = |low: f64, high: f64| format!("{} to {}", short(low), short(high));
        let (x, y) = (range(allowed_min.x, allowed_max.x), range(allowed_min.y, allowed_max.y));
        problem.expected(format!("x in {x} and y in {y}")).help(["move it there, or widen `map` in [world]".to_owned()])
    } else {
        problem.expected("an object smaller than the map").help(["widen `map` in [world]".to_owned()])
    })
}

fn inside_obstacle(context: Context<'_>, scenario: &PushScenario, stand: &Stand) -> Option<Diagnostic> {
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
        .help([format!("move it by at least {}, or move the obstacle", meters(-clearance_m))]);
    Some(context.source.related(problem, obstacle, &format!("`{name}` stands here")))
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
