//! A transfer: from an intention to a chain of pushes and flips with another tool.

use nalgebra::{Isometry2, Point2, Vector2, Vector3};

use super::config::TransferConfig;
use super::holds::Hold;
use super::passages::Side;
use super::reference::Reference;
use super::refusal::{TransferError, explain};
use super::search::{Phase, PhaseSearch, Phases};
use super::workplace::{Shapes, Workplace};
use crate::error::SkillError;
use crate::plan::{Action, ActionKind, Plan, PlanarMotion, Push, Track};
use crate::time_law::{minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};
use crate::tool_flipping::{Flip, FlipOptions, FlipTask, WayRound};
use crate::tool_use::{SkillLibrary, Surroundings};

/// A pushing task for another tool.
#[derive(Debug, Clone)]
pub struct TransferProblem<'a> {
    /// World, object and tool.
    pub workplace: Workplace<'a>,
    /// Options.
    pub config: &'a TransferConfig,
    /// Where the object's center starts, world frame.
    pub start_world: Point2<f64>,
    /// Where the object's center is wanted, world frame.
    pub goal_world: Point2<f64>,
    /// Where the tool's origin waits before, world frame.
    pub home_world: Point2<f64>,
    /// Where the tool's origin is put afterwards, world frame.
    pub park_world: Point2<f64>,
    /// Side on which each obstacle is passed, if it is set.
    pub sides: &'a [Option<Side>],
    /// Mean speed of a push, m/s.
    pub push_speed_m_per_s: f64,
    /// Mean speed of the tool through free space, m/s.
    pub free_speed_m_per_s: f64,
    /// Time between two motions of the plan, s.
    pub time_step_s: f64,
}

/// A transferred skill.
#[derive(Debug, Clone, PartialEq)]
pub struct Transfer {
    /// The chain of actions.
    pub plan: Plan,
    /// The path that it keeps near.
    pub reference: Reference,
    /// The phases, with the cost of their search.
    pub phases: Phases,
    /// The flips between them.
    pub flips: Vec<Flip>,
    /// Switches that were given up because no flip was found there.
    pub barred_switches: usize,
}

/// A motion has at least this many time steps.
const FEWEST_STEPS: f64 = 10.0;
/// Switches that are given up before there is said to be no way.
const MOST_BARRED: usize = 40;
/// Distance that an approach or withdrawal keeps from the object, and by which a hold is left first, m.
const ROUND_M: f64 = 0.010;
/// Time between two looks at a flip among obstacles, as a share of it.
const LOOKS: usize = 100;

impl TransferProblem<'_> {
    /// Plans: the intention is generalized and kept out of obstacles, phases are searched for near it, flips are found
    /// between them, and all is chained.
    ///
    /// # Errors
    /// A [`TransferError`] that says which constraint closes the last way, or which flip or way of the tool is not there.
    pub fn plan(&self, library: &SkillLibrary) -> Result<Transfer, TransferError> {
        self.config.validate().map_err(SkillError::from)?;
        let slack_m = self.config.slack_m;
        let mut workplace = self.workplace.clone();
        workplace.object_margin_m = self.config.object_margin_m + slack_m;
        workplace.tool_margin_m = self.config.tool_margin_m + slack_m;
        let (start, goal) = (self.start_world, self.goal_world);
        let reference = Reference::new(&workplace, self.config, &library.intention, start, goal, self.sides)?;
        let points = reference.points();
        let mut search =
            PhaseSearch::new(&workplace, &self.config.search, &points, start, goal).map_err(SkillError::from)?;
        let shapes = Shapes::new(&workplace);
        let mut barred = 0;
        let mut refusals = Vec::new();
        let (phases, flips) = loop {
            let Some(mut phases) = search.solve() else {
                return Err(match refusals.pop() {
                    Some(refusal) => refusal,
                    None => explain(&workplace, &self.config.search, start, goal).into(),
                });
            };
            let switches = phases.phases.len().saturating_sub(1);
            let found: Vec<_> = (0..switches).map(|index| self.flip(&workplace, &shapes, &phases, index)).collect();
            if let Some(index) = found.iter().position(Result::is_err) {
                search.bar_switch(&phases, index);
                refusals.extend(found.into_iter().filter_map(Result::err));
                barred += 1;
                if barred > MOST_BARRED {
                    return Err(refusals.swap_remove(0));
                }
                continue;
            }
            phases.settle(&goal);
            break (phases, found.into_iter().flatten().collect::<Vec<_>>());
        };
        let plan = self.chain(library, &workplace, &phases, &flips)?;
        Ok(Transfer { plan, reference, phases, flips, barred_switches: barred })
    }

    /// A way of the tool from the hold of phase `index` to that of the next one, clear of object and obstacles.
    fn flip(
        &self,
        workplace: &Workplace<'_>,
        shapes: &Shapes,
        phases: &Phases,
        index: usize,
    ) -> Result<Flip, TransferError> {
        let [before, after, ..] = phases.phases.get(index..).unwrap_or_default() else {
            return Err(
                SkillError::RowCount { operation: "flip tool", found: index, expected: "two phases".into() }.into()
            );
        };
        let contact = |hold: &Hold, gap_m: f64| {
            let surface = workplace.tool.surfaces.get(hold.surface)?;
            let mut contact = surface.contact_at(hold.place_m);
            contact.point += contact.normal.into_inner() * gap_m;
            Some(contact)
        };
        let (Some(first), Some(second)) =
            (contact(&before.hold, 0.0), contact(&after.hold, self.config.approach_gap_m))
        else {
            return Err(SkillError::RowCount { operation: "flip tool", found: 0, expected: "a surface".into() }.into());
        };
        let center = before.to_world;
        let task = |duration_s: f64| FlipTask {
            tool: workplace.tool,
            object: workplace.object,
            object_world: Isometry2::new(center.coords, workplace.object_angle_rad),
            contacts: [first, second],
            tool_angles_rad: [before, after].map(|phase| phase.hold.center_from_tool.rotation.angle()),
            duration_s,
        };
        let mut refusal = None;
        for way_round in [WayRound::Shorter, WayRound::Counterclockwise, WayRound::Clockwise] {
            let options = FlipOptions { way_round, ..self.config.flip.clone() };
            let tried = task(1.0).flip(&options).map_err(TransferError::from).and_then(|flip| {
                let length_m = length_m(&flip);
                let flip = task(self.whole_steps_s(length_m / self.free_speed_m_per_s)).flip(&options)?;
                check_clear(workplace, shapes, &flip, center)?;
                Ok(flip)
            });
            match tried {
                Ok(flip) => return Ok(flip),
                Err(error) => refusal = refusal.or(Some(error)),
            }
        }
        Err(refusal.unwrap_or(TransferError::NoWay { what: "flip".into(), x_m: center.x, y_m: center.y }))
    }

    fn chain(
        &self,
        library: &SkillLibrary,
        workplace: &Workplace<'_>,
        phases: &Phases,
        flips: &[Flip],
    ) -> Result<Plan, TransferError> {
        let mut actions = Vec::new();
        let name = |phase: &Phase| {
            workplace.tool.surfaces.get(phase.hold.surface).map_or_else(String::new, |surface| surface.name.clone())
        };
        for (index, phase) in phases.phases.iter().enumerate() {
            let gap_m = self.config.approach_gap_m;
            let hold = Point2::from(self.hold(phase, &phase.from_world, gap_m).translation.vector);
            match index.checked_sub(1).and_then(|before| flips.get(before)) {
                None => actions.push(self.free_way(
                    library,
                    workplace,
                    format!("approach {}", name(phase)),
                    (phase, phase.from_world),
                    (self.home_world, Vector2::zeros()),
                    (hold, -phase.hold.direction),
                )?),
                Some(flip) => actions.push(self.flip_action(format!("flip to {}", name(phase)), flip, phase)?),
            }
            actions.push(self.push(format!("push {}", name(phase)), phase, gap_m)?);
        }
        if let Some(last) = phases.phases.last() {
            let hold = Point2::from(self.hold(last, &last.to_world, 0.0).translation.vector);
            actions.push(self.free_way(
                library,
                workplace,
                "withdraw".into(),
                (last, last.to_world),
                (hold, -last.hold.direction),
                (self.park_world, Vector2::zeros()),
            )?);
        }
        Ok(Plan::new(actions)?)
    }

    /// Pose of the tool that holds the object at `center` in the hold of `phase`, with a gap.
    fn hold(&self, phase: &Phase, center: &Point2<f64>, gap_m: f64) -> Isometry2<f64> {
        phase.hold.world_from_tool(&(center - phase.hold.direction * gap_m))
    }

    /// The object straight along its phase, the tool behind it; the tool closes its gap on the way.
    fn push(&self, name: String, phase: &Phase, gap_m: f64) -> Result<Action, SkillError> {
        let way = phase.to_world - phase.from_world;
        let duration_s = self.whole_steps_s(way.norm() / self.push_speed_m_per_s);
        let angle = phase.hold.center_from_tool.rotation.angle();
        let start = self.hold(phase, &phase.from_world, gap_m).translation.vector;
        let line = |from: Vector2<f64>, angle_rad: f64, way: Vector2<f64>| {
            let motion = |ratio: f64| PlanarMotion {
                position: (from + way * minimum_jerk(ratio)).push(angle_rad),
                velocity: (way * (minimum_jerk_first_derivative(ratio) / duration_s)).push(0.0),
                acceleration: (way * (minimum_jerk_second_derivative(ratio) / (duration_s * duration_s))).push(0.0),
            };
            let steps = (duration_s / self.time_step_s).round();
            Track::new(self.time_step_s, (0..=steps as usize).map(|step| motion(step as f64 / steps)).collect())
        };
        Ok(Action {
            name,
            kind: ActionKind::ObjectOperating(Push {
                surface: phase.hold.surface,
                place_m: phase.hold.place_m,
                from_world: phase.from_world,
                to_world: phase.to_world,
            }),
            tool: line(start, angle, way + phase.hold.direction * gap_m)?,
            object: line(phase.from_world.coords, self.workplace.object_angle_rad, way)?,
        })
    }

    fn flip_action(&self, name: String, flip: &Flip, phase: &Phase) -> Result<Action, SkillError> {
        let tool = flip.tool_track(self.time_step_s)?;
        let object = self.resting(&phase.from_world, tool.motions().len())?;
        Ok(Action { name, kind: ActionKind::ToolFlipping, tool, object })
    }

    /// A way of the tool through free space, its angle kept, past object and obstacles.
    fn free_way(
        &self,
        library: &SkillLibrary,
        workplace: &Workplace<'_>,
        name: String,
        (phase, center): (&Phase, Point2<f64>),
        from: (Point2<f64>, Vector2<f64>),
        to: (Point2<f64>, Vector2<f64>),
    ) -> Result<Action, TransferError> {
        let around = Surroundings {
            tool: workplace.tool,
            angle_rad: phase.hold.center_from_tool.rotation.angle(),
            object_world: center,
            object_radius_m: workplace.object.radius_m(),
            obstacles: workplace.obstacles,
            margin_m: ROUND_M.min(workplace.tool_margin_m.max(ROUND_M / 2.0)),
        };
        let Some(track) = library.free_way(&around, from, to, self.free_speed_m_per_s, self.time_step_s)? else {
            return Err(TransferError::NoWay { what: name, x_m: center.x, y_m: center.y });
        };
        let object = self.resting(&center, track.motions().len())?;
        Ok(Action { name, kind: ActionKind::ToolFlipping, tool: track, object })
    }

    fn resting(&self, center: &Point2<f64>, rows: usize) -> Result<Track, SkillError> {
        let rest = PlanarMotion::at_rest(Vector3::new(center.x, center.y, self.workplace.object_angle_rad));
        Track::new(self.time_step_s, vec![rest; rows])
    }

    /// The next whole number of time steps, s: tracks lie on a uniform grid.
    fn whole_steps_s(&self, duration_s: f64) -> f64 {
        // a rounding above a whole number is no further step
        (duration_s / self.time_step_s - 1e-6).ceil().max(FEWEST_STEPS) * self.time_step_s
    }
}

/// Length of a flip's way of the tool, m.
fn length_m(flip: &Flip) -> f64 {
    let place = |look: usize| flip.tool_in_world(flip.duration_s() * look as f64 / LOOKS as f64).point();
    (0..LOOKS).map(|look| (place(look + 1) - place(look)).norm()).sum()
}

/// Checks that a flip keeps clear of obstacles and within reach.
fn check_clear(
    workplace: &Workplace<'_>,
    shapes: &Shapes,
    flip: &Flip,
    center: Point2<f64>,
) -> Result<(), TransferError> {
    let (x_m, y_m) = (center.x, center.y);
    for look in 0..=LOOKS {
        let pose = flip.tool_in_world(flip.duration_s() * look as f64 / LOOKS as f64).pose();
        let clearance_m = shapes.tool_clearance_m(&pose);
        if !workplace.tool_passes && clearance_m < workplace.tool_margin_m {
            return Err(TransferError::FlipNearObstacle { x_m, y_m, clearance_m, margin_m: workplace.tool_margin_m });
        }
        if !workplace.reach.holds(&pose) {
            return Err(TransferError::FlipOutOfReach { x_m, y_m });
        }
    }
    Ok(())
}
