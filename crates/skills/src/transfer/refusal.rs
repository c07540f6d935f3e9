//! Why there are no phases: which constraint closes the last way.

use nalgebra::Point2;

use super::cells::Barred;
use super::config::SearchConfig;
use super::search::PhaseSearch;
use super::workplace::{Everywhere, Workplace};
use crate::error::SkillError;
use crate::field::FieldError;
use crate::plan::ChainError;
use crate::tool_flipping::FlipError;

/// Why the object cannot be brought to its goal.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoPhases {
    /// An option or margin is out of its range.
    #[error("plan transfer: {0}")]
    Field(#[from] FieldError),
    /// No surface can push the object without turning it.
    #[error(
        "plan transfer: none of the {surfaces} surfaces of the tool '{tool}' can push the object; expected one that lies \
         flat against a side of the object and does not overlap it; turn the tool or the object, or name another tool"
    )]
    Holds {
        /// Name of the tool.
        tool: String,
        /// Number of its surfaces.
        surfaces: usize,
    },
    /// The object is where it is wanted.
    #[error(
        "plan transfer: the object starts {distance_m:.4} m from its goal; expected at least half a cell of {cell_m} m to \
         one side; choose another start or goal, or lower cell_m"
    )]
    AtGoal {
        /// Distance of the start from the goal, m.
        distance_m: f64,
        /// Side of a cell, m.
        cell_m: f64,
    },
    /// The object cannot be where it is to be, for the edge of the map.
    #[error(
        "plan transfer: the object reaches out of the map at its {place} ({x_m:.4}, {y_m:.4}) m; expected the whole object \
         inside; move it, or widen the map"
    )]
    OutsideMap {
        /// Start or goal.
        place: &'static str,
        /// Place of the object's center, m.
        x_m: f64,
        /// Place of the object's center, m.
        y_m: f64,
    },
    /// The object cannot be where it is to be, for an obstacle.
    #[error(
        "plan transfer: the object's {place} is {clearance_m:.4} m from the nearest obstacle; expected {least_m:.4} m, the \
         safe margin and half a cell; move it, or lower object_margin_m"
    )]
    Place {
        /// Start or goal.
        place: &'static str,
        /// Distance of the object from the nearest obstacle there, m; negative where they overlap.
        clearance_m: f64,
        /// Distance that it must keep, m.
        least_m: f64,
    },
    /// The tool's surfaces push in directions that do not lead to the goal.
    #[error(
        "plan transfer: the surfaces of the tool '{tool}' push towards {directions}; expected directions that add up to \
         ({x_m:.4}, {y_m:.4}) m; turn the tool, or name one with a surface that faces the other way"
    )]
    Directions {
        /// Name of the tool.
        tool: String,
        /// The directions, in degrees.
        directions: String,
        /// Displacement wanted along x, m.
        x_m: f64,
        /// Displacement wanted along y, m.
        y_m: f64,
    },
    /// One constraint closes every way: without it there is one.
    #[error(
        "plan transfer: every way is closed by {constraint}; expected a way for object and tool; without it {without}; {advice}"
    )]
    Closed {
        /// The constraint.
        constraint: &'static str,
        /// What there would be without it.
        without: String,
        /// What to do.
        advice: &'static str,
    },
    /// Several constraints close every way together.
    #[error(
        "plan transfer: every way is closed by several constraints together; expected a way for object and tool; widen the \
         map, move the obstacles apart, bring the arm nearer, or name another tool"
    )]
    ClosedTogether,
}

/// Why a skill cannot be transferred.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TransferError {
    /// There are no phases.
    #[error(transparent)]
    Phases(#[from] NoPhases),
    /// The tool cannot change its hold at a place that every plan passes.
    #[error(transparent)]
    Flip(#[from] FlipError),
    /// The change of hold would bring the tool too near to an obstacle.
    #[error(
        "plan transfer: the change of hold at ({x_m:.4}, {y_m:.4}) m brings the tool within {clearance_m:.4} m of an \
         obstacle; expected {margin_m:.4} m; lower the tool's margin, or move the obstacles apart"
    )]
    FlipNearObstacle {
        /// Place of the object, m.
        x_m: f64,
        /// Place of the object, m.
        y_m: f64,
        /// Distance of the tool from the obstacle, m; negative where they overlap.
        clearance_m: f64,
        /// Distance that it must keep, m.
        margin_m: f64,
    },
    /// The change of hold leaves the reach of the arm.
    #[error(
        "plan transfer: the change of hold at ({x_m:.4}, {y_m:.4}) m leaves the reach of the arm; expected a way within \
         it; move the arm's base nearer"
    )]
    FlipOutOfReach {
        /// Place of the object, m.
        x_m: f64,
        /// Place of the object, m.
        y_m: f64,
    },
    /// The tool cannot come to its first hold, or away from its last one.
    #[error(
        "plan transfer: found no way of the tool to {what} with the object at ({x_m:.4}, {y_m:.4}) m; expected one past \
         object and obstacles; move home_m or park_m, the obstacles, or lower tool_margin_m"
    )]
    NoWay {
        /// What the way is for.
        what: String,
        /// Place of the object, m.
        x_m: f64,
        /// Place of the object, m.
        y_m: f64,
    },
    /// The plan was made but is no chain.
    #[error(transparent)]
    Chain(#[from] ChainError),
    /// A skill could not be rolled out, or an option is out of its range.
    #[error(transparent)]
    Skill(#[from] SkillError),
}

/// A constraint that may close the last way, what it is called, and what to do.
type Relaxation<'s> = (&'static str, fn(&mut Workplace<'s>), &'static str);

fn relaxations<'s>() -> [Relaxation<'s>; 6] {
    [
        (
            "the safe margin of the object",
            |workplace| workplace.object_margin_m = 0.0,
            "lower object_margin_m, or move the obstacles",
        ),
        (
            "the margin of the tool",
            |workplace| workplace.tool_margin_m = 0.0,
            "lower tool_margin_m, or move the obstacles",
        ),
        ("the edge of the map", widen_map, "widen the map, or move start and goal inward"),
        ("the reach of the arm", |workplace| workplace.reach = &Everywhere, "move its base, or name a longer tool"),
        ("the tool, which hits obstacles", |workplace| workplace.tool_passes = true, "name another tool, or turn it"),
        ("the obstacles", |workplace| workplace.obstacles = &[], "move them apart"),
    ]
}

/// Widens the map by its own size to every side.
fn widen_map(workplace: &mut Workplace<'_>) {
    let size = workplace.map_max - workplace.map_min;
    workplace.map_min -= size;
    workplace.map_max += size;
}

/// Explains why [`PhaseSearch::solve`] found nothing.
#[must_use]
pub fn explain(workplace: &Workplace<'_>, config: &SearchConfig, start: Point2<f64>, goal: Point2<f64>) -> NoPhases {
    let search = match PhaseSearch::new(workplace, config, &[], start, goal) {
        Ok(search) => search,
        Err(error) => return error.into(),
    };
    let tool = workplace.tool.name.clone();
    if search.holds().is_empty() {
        return NoPhases::Holds { tool, surfaces: workplace.tool.surfaces.len() };
    }
    if search.is_at_goal() {
        return NoPhases::AtGoal { distance_m: (goal - start).norm(), cell_m: config.cell_m };
    }
    for (place, at) in [("start", start), ("goal", goal)] {
        match search.barred(&at) {
            Some(Barred::Map) => return NoPhases::OutsideMap { place, x_m: at.x, y_m: at.y },
            Some(Barred::Obstacle { clearance_m, least_m }) => return NoPhases::Place { place, clearance_m, least_m },
            None => {}
        }
    }
    if !search.directions_lead_there() {
        let wanted = goal - start;
        let mut degrees: Vec<i64> = search
            .holds()
            .iter()
            .map(|hold| hold.direction.y.atan2(hold.direction.x).to_degrees().round() as i64)
            .collect();
        degrees.sort_unstable();
        degrees.dedup();
        let directions = degrees.iter().map(|angle| format!("{angle}°")).collect::<Vec<_>>().join(", ");
        return NoPhases::Directions { tool, directions, x_m: wanted.x, y_m: wanted.y };
    }
    for (constraint, relax, advice) in relaxations() {
        let mut relaxed = workplace.clone();
        relax(&mut relaxed);
        let found = PhaseSearch::new(&relaxed, config, &[], start, goal).ok().and_then(|mut search| search.solve());
        if let Some(phases) = found {
            let without = format!("{} phases would do", phases.phases.len());
            return NoPhases::Closed { constraint, without, advice };
        }
    }
    NoPhases::ClosedTogether
}
