//! Reaching: bring the tool through waypoints with the whole arm, and hold it there against forces.

mod config;
mod judge;
mod pushed;
mod scenario;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use sim::spatial::{Episode, HeldTool, SpatialSetup, SpatialWorld, Target, simulate, standard_gravity};
use skills::spatial::{ActionPhase, SpatialAction, SpatialPlan, rest, timed_move};

pub use config::{Disturbance, ReachConfig, ReachLimits, Waypoint};
pub use scenario::{ReachScenario, ReachTable, ResolvedReach};

use self::pushed::{Pushed, WithKnownForces};
use super::spatial::{Aim, HeldArm, Readied, built};
use super::{StageError, Task, TaskKind, broken};
use crate::outcome::Outcome;
use crate::pipeline::{Onlooker, Progress};
use crate::scenario::{ResolvedScenario, load_as};
use crate::schema::subschema;

/// The kind.
pub(crate) const KIND: TaskKind = TaskKind {
    name: "reach",
    summary: "bring the tool through waypoints in space, and hold it there against forces",
    example: ("scenarios/reach_panda.toml", include_str!("../../../../../scenarios/reach_panda.toml")),
    tool_key: None,
    load: load_as::<ReachScenario>,
    skills: None,
    schema: subschema::<ReachScenario>,
};

/// Radius around the tool's way that is worth seeing, m: the arm.
const FOCUS_RADIUS_M: f64 = 0.75;

/// A reaching task of one scenario and seed.
pub(crate) struct ReachTask<'a> {
    scenario: &'a ResolvedScenario,
    reach: &'a ReachScenario,
    seed: u64,
}

/// A plan that the arm can carry out.
pub(crate) struct Planned {
    plan: SpatialPlan,
    ready: Readied,
}

impl<'a> ReachTask<'a> {
    /// The task that a scenario states.
    pub fn new(scenario: &'a ResolvedScenario, reach: &'a ResolvedReach, seed: u64) -> Self {
        Self { scenario, reach: &reach.scenario, seed }
    }

    /// Minimum-jerk moves from waypoint to waypoint, and the rest at the end.
    fn way(&self, start: Isometry3<f64>) -> Result<SpatialPlan, StageError> {
        let config = self.reach.reach();
        let mut at = start;
        let mut actions = Vec::with_capacity(config.waypoints.len() + 1);
        let refused = |error: skills::spatial::SpatialError| StageError::Input(format!("plan reach: {error}"));
        for (index, waypoint) in config.waypoints.iter().enumerate() {
            let turn = UnitQuaternion::from_scaled_axis(Vector3::from(waypoint.turn_rad));
            let place = at.translation.vector + Vector3::from(waypoint.move_m);
            let to = Isometry3::from_parts(Translation3::from(place), turn * at.rotation);
            let track = timed_move(&at, &to, waypoint.duration_s).map_err(refused)?;
            actions.push(SpatialAction::new(format!("go to waypoint {}", index + 1), ActionPhase::Travel, track));
            at = to;
        }
        if config.hold_s > 0.0 {
            let track = rest(&at, config.hold_s).map_err(refused)?;
            actions.push(SpatialAction::new("hold", ActionPhase::Hold, track));
        }
        SpatialPlan::new(actions).map_err(refused)
    }
}

/// Where the way begins and each move ends, for onlookers.
fn targets(plan: &SpatialPlan) -> Vec<Target> {
    let start = plan.actions().first().map(|action| ("start".to_owned(), action.track.start().pose));
    let moves = plan.actions().iter().filter(|action| action.phase == ActionPhase::Travel);
    let ends = moves.enumerate().map(|(index, action)| (format!("waypoint {}", index + 1), action.track.end().pose));
    start.into_iter().chain(ends).map(|(name, world_from_target)| Target { name, world_from_target }).collect()
}

impl Task for ReachTask<'_> {
    type Shown = ();
    type Skills = ();
    type Plan = Planned;
    type Episode = Episode;

    fn demonstrations(&self, _progress: Progress<'_>) -> Result<(), StageError> {
        Ok(())
    }

    fn learn(&self, (): &()) -> Result<(), StageError> {
        Ok(())
    }

    fn plan(&self, (): &()) -> Result<Planned, StageError> {
        let robot = &self.reach.robot;
        let arm = HeldArm::new(&self.scenario.arm, robot, &HeldTool::none(), self.seed)?;
        let plan = self.way(arm.tool_at_rest()?)?;
        let remedy = "shorten move_m or turn_rad of that waypoint or of one before it";
        let aim = Aim { task: KIND.name, arm: &robot.asset, held: "the tool", remedy };
        let ready = arm.ready(&plan, &self.reach.controller, &self.reach.engine, &aim)?;
        Ok(Planned { plan, ready })
    }

    fn simulate(&self, planned: &Planned, observer: &mut dyn Onlooker) -> Result<Episode, StageError> {
        let Readied { arm, posture, .. } = &planned.ready;
        let (engine, tool) = (&self.reach.engine, HeldTool::none());
        let mut scene = arm.scene(&tool, &planned.plan, engine);
        scene.targets_world = targets(&planned.plan);
        scene.focus_world = (*arm.model.world_from_base() * nalgebra::Point3::new(0.25, 0.0, 0.45), FOCUS_RADIUS_M);
        let setup = SpatialSetup {
            plant: &arm.plant,
            model: &arm.model,
            tool: &tool,
            arm: &self.reach.robot.motors,
            scene: &scene,
            engine,
            settle_s: 0.0,
            longest_s: planned.plan.duration_s() + 1.0,
        };
        let world = SpatialWorld::new(engine, &standard_gravity()).map_err(broken)?;
        let mut controller = built(&self.reach.controller, &arm.model)?;
        let forces = &self.reach.reach().disturbances;
        let mut source = WithKnownForces::new(&planned.plan, forces);
        let mut pushed = Pushed::new(forces);
        simulate(&setup, world, posture, &mut source, controller.as_mut(), &mut pushed, observer).map_err(broken)
    }

    fn judge(&self, (): &(), (): &(), planned: &Planned, episode: &Episode) -> Outcome {
        let measures = judge::measures(self.reach, &planned.ready.arm.model, episode);
        let failures = episode.interruption.iter().cloned().collect();
        let notes = planned.ready.notes.clone();
        Outcome::judged(self.scenario, self.seed, measures, failures, notes, episode.digest.clone())
    }

    fn simulated_s(episode: &Episode) -> f64 {
        episode.duration_s()
    }
}
