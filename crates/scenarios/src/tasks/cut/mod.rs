//! Cutting: divide a food on a board with a knife, as one cut of it was demonstrated.

mod actual;
mod config;
mod demonstrations;
mod expected;
mod expecting;
mod holding;
mod judge;
mod learned;
mod places;
mod resolved;
mod scenario;
mod sections;
mod showing;
mod toughness;
mod variation;

use nalgebra::{Isometry3, Point3, Translation3};
use sim::SimError;
use sim::cutting::geometry::{Plane, Solid};
use sim::cutting::scene::{CuttingProcess, CuttingRecord, CuttingSetup, held_knife, knife_from_tool, pose_at_rest};
use sim::spatial::{Episode, HeldTool, SpatialSetup, SpatialWorld, simulate, standard_gravity};
use skills::cutting::{CutPlan, CutSkill, CutTask as CutsAsked, SavedCut};
use skills::spatial::{SpatialPlan, SpatialReport};

pub use config::{CutConfig, Wanted};
pub use resolved::ResolvedCut;
pub use scenario::{CutScenario, CutTable};
pub use sections::{BoardConfig, ExecutionConfig, FoodConfig, KnifeConfig, Limits, LookConfig, SkillKind};
pub use showing::{DemonstrationsConfig, RecordedConfig, SyntheticConfig};
pub use variation::{Variation, VariationConfig};

use self::actual::{Actual, Lying};
use self::demonstrations::Shown;
use self::expecting::WithCuttingForces;
use self::holding::{LevelEdge, carried, edge_in};
use self::places::{Place, extent_m, lowest_m, place};
use super::spatial::{Aim, HeldArm, Readied, built};
use super::{ShownTrial, StageError, Task, TaskKind, broken};
use crate::outcome::Outcome;
use crate::pipeline::{Onlooker, Progress};
use crate::scenario::{KeptSkills, ResolvedScenario, describe_skills, load_as};
use crate::schema::subschema;

/// The kind.
pub(crate) const KIND: TaskKind = TaskKind {
    name: "cut",
    summary: "cut a food on a board into pieces with a knife",
    example: ("scenarios/cut_banana_three.toml", include_str!("../../../../../scenarios/cut_banana_three.toml")),
    tool_key: Some("knife.asset"),
    load: load_as::<CutScenario>,
    skills: Some(describe_skills::<SavedCut>),
    schema: subschema::<CutScenario>,
};

/// Radius around the food that is worth seeing, m.
const FOCUS_RADIUS_M: f64 = 0.22;
/// Time between two looks at how deep the edge goes, s.
const LOOK_S: f64 = 0.005;
/// What the edge may be planned past the limit of its part that is planned for, m: its rise where it is not level.
const LEVEL_TOLERANCE_M: f64 = 0.0002;
/// A run may last this much longer than its plan, s.
const PATIENCE_S: f64 = 1.0;

/// A cutting task of one scenario and seed.
pub(crate) struct CutTask<'a> {
    scenario: &'a ResolvedScenario,
    /// What is particular to a cut in it.
    cut: &'a ResolvedCut,
    seed: u64,
    edge: LevelEdge,
    /// Pose of the middle of the level part of the edge in the tool's frame.
    tool_from_edge: Isometry3<f64>,
}

/// A plan that the arm can carry out.
pub(crate) struct Planned {
    /// Poses of the tool.
    plan: SpatialPlan,
    /// What is known of each cut.
    cuts: Vec<skills::cutting::CutReport>,
    places: Vec<Place>,
    /// The pieces that are wanted, along the food, in the food's frame.
    wanted: Vec<Solid>,
    report: SpatialReport,
    ready: Readied,
    actual: Actual,
}

/// What happened to arm and food.
pub(crate) struct CutEpisode {
    episode: Episode,
    record: CuttingRecord,
}

impl<'a> CutTask<'a> {
    /// The task that a scenario states.
    pub(crate) fn new(scenario: &'a ResolvedScenario, cut: &'a ResolvedCut, seed: u64) -> Self {
        let edge = LevelEdge::of(&cut.knife);
        let tool_from_edge = knife_from_tool(&cut.knife).inverse() * edge.knife_from_blade;
        Self { scenario, cut, seed, edge, tool_from_edge }
    }

    /// The knife in the hand.
    fn tool(&self) -> HeldTool {
        let knife = &self.cut.knife;
        let hand_from_knife = self.cut.scenario.knife.hand_from_grip() * knife.knife_from_grip.inverse();
        held_knife(knife, hand_from_knife * knife_from_tool(knife))
    }

    /// The sections that are to be cut, in the food that the planner sees.
    fn places(&self, actual: &Actual) -> Result<Vec<Place>, StageError> {
        let (scenario, believed) = (&self.cut.scenario, &actual.believed);
        let (task, top_m) = (scenario.cut(), scenario.board.top_m());
        let (length_m, _) = extent_m(&believed.food, &believed.world_from_food);
        let places = task.wanted.places_m(length_m).into_iter().enumerate().map(|(index, along_m)| {
            place(&believed.food, &believed.world_from_food, top_m, along_m, task.tilt_rad(index))
                .map_err(|error| StageError::Infeasible(format!("plan cut {index}: {error}")))
        });
        places.collect()
    }

    /// Plans the edge's motion with the skill that the scenario asks for, and carries it over to the tool.
    fn motion(&self, skill: &CutSkill, places: &[Place]) -> Result<CutPlan, StageError> {
        let scenario = &self.cut.scenario;
        let Some(first) = places.first() else {
            return Err(StageError::Broken("plan cut: the scenario asks for no cut".into()));
        };
        let home = Isometry3::from_parts(
            Translation3::from(nalgebra::Vector3::from(scenario.cut().home_m)),
            first.section.world_from_section.rotation,
        );
        let asked = CutsAsked {
            home,
            blade: self.edge.blade,
            sections: places.iter().map(|place| place.section).collect(),
            options: scenario.cut().motion.clone(),
        };
        let planned = match scenario.execution.skill {
            SkillKind::Constrained => skill.plan(&asked),
            SkillKind::PlainDmp => skill.plain_dmp(&asked),
        };
        let CutPlan { plan, cuts } = planned.map_err(|error| StageError::Infeasible(error.to_string()))?;
        let plan = carried(&plan, &self.tool_from_edge.inverse())
            .map_err(|error| StageError::Broken(format!("plan cut: {error}")))?;
        Ok(CutPlan { plan, cuts })
    }

    /// Checks that no part of the edge, its belly and tip too, is planned to go deeper into the board than a stroke may.
    fn check_board(&self, plan: &SpatialPlan) -> Result<(), StageError> {
        let scenario = &self.cut.scenario;
        let edge = edge_in(&self.cut.knife, &knife_from_tool(&self.cut.knife).inverse());
        let allowed_m = scenario.cut().motion.largest_past_board_m + LEVEL_TOLERANCE_M;
        let looks = (plan.duration_s() / LOOK_S).ceil() as usize;
        for look in 0..=looks {
            let time_s = look as f64 * LOOK_S;
            let past_m = scenario.board.top_m() - lowest_m(&plan.at(time_s).pose, &edge);
            if past_m > allowed_m {
                return Err(StageError::Infeasible(format!(
                    "plan cut: the edge would be {:.2} mm past the board's surface at {time_s:.2} s; expected at most {:.2} \
                     mm; rock less, lean less, or take a knife with a straighter edge",
                    past_m * 1e3,
                    allowed_m * 1e3,
                )));
            }
        }
        Ok(())
    }

    /// The reference of the arm: the plan, and the cutting forces to be expected if the scenario wants them.
    fn source<'p>(&'p self, planned: &'p Planned) -> WithCuttingForces<'p> {
        let scenario = &self.cut.scenario;
        if !scenario.execution.expects_cutting_force {
            return WithCuttingForces::none(&planned.plan);
        }
        let cuts: Vec<(usize, &Place)> =
            planned.cuts.iter().zip(&planned.places).map(|(cut, place)| (cut.action, place)).collect();
        let food = &planned.actual.believed.food;
        let expecting = WithCuttingForces::new(&planned.plan, &cuts, food, &self.cut.knife, &self.tool_from_edge);
        if !scenario.execution.learns_toughness {
            return expecting;
        }
        let stated = food.material.toughness_j_per_m2;
        let toughest = self.cut.food.range.toughness_j_per_m2.map_or(stated, |[_, most]| most);
        let edge = edge_in(&self.cut.knife, &knife_from_tool(&self.cut.knife).inverse());
        expecting.learning(toughest / stated, edge, scenario.board.top_m())
    }

    /// The scene with a food that lies on the board.
    fn setup(&self, lying: &Lying, places: &[Place]) -> CuttingSetup {
        let scenario = &self.cut.scenario;
        CuttingSetup {
            food: lying.food.clone(),
            world_from_food: lying.world_from_food,
            knife: self.cut.knife.clone(),
            board: scenario.board.board(),
            config: scenario.mechanics.clone(),
            thresholds: scenario.limits.failing.clone(),
            planned: places.iter().map(|place| place.section.world_from_section).collect(),
        }
    }
}

/// A food that does not lie still is no crash.
fn unsettled(error: SimError) -> StageError {
    match error {
        SimError::Cutting { .. } => StageError::Infeasible(error.to_string()),
        other => broken(other),
    }
}

/// The pieces that cuts at `places` make of a solid, in its frame, along x.
fn pieces(solid: &Solid, world_from_food: &Isometry3<f64>, places: &[Place]) -> Vec<Solid> {
    let mut pieces = vec![solid.clone()];
    for place in places {
        let plane = Plane::of_frame(&(world_from_food.inverse() * place.section.world_from_section));
        pieces = pieces.iter().flat_map(|piece| piece.split(&plane)).collect();
    }
    let middle = |piece: &Solid| piece.mass_properties(1.0).center.x;
    pieces.sort_by(|one, other| middle(one).total_cmp(&middle(other)));
    pieces
}

impl Task for CutTask<'_> {
    type Shown = Shown;
    type Skills = CutSkill;
    type Plan = Planned;
    type Episode = CutEpisode;

    fn demonstrations(&self, progress: Progress<'_>) -> Result<Shown, StageError> {
        demonstrations::obtain(self, progress)
    }

    fn show(
        &self,
        count: Option<usize>,
        progress: Progress<'_>,
        each: &mut dyn FnMut(ShownTrial) -> Result<(), StageError>,
    ) -> Result<(), StageError> {
        demonstrations::show(self, count, progress, each)
    }

    fn learn(&self, shown: &Shown) -> Result<CutSkill, StageError> {
        learned::learn(self, shown)
    }

    fn save(&self, shown: &Shown, skill: &CutSkill) -> Result<KeptSkills, StageError> {
        learned::kept(self, shown, skill)
    }

    fn plan(&self, skill: &CutSkill) -> Result<Planned, StageError> {
        let scenario = &self.cut.scenario;
        let robot = &scenario.robot;
        let actual = Actual::new(scenario, &self.cut.food, self.seed)
            .map_err(|error| StageError::Input(error.within("food").to_string()))?;
        let laid = self.setup(&actual.believed, &[]);
        let actual = actual.settled(pose_at_rest(&laid, &scenario.engine).map_err(unsettled)?);
        let places = self.places(&actual)?;
        let CutPlan { plan, cuts } = self.motion(skill, &places)?;
        let report = plan.verify(&scenario.motion_limits).map_err(|error| StageError::Infeasible(error.to_string()))?;
        if scenario.execution.skill == SkillKind::Constrained {
            self.check_board(&plan)?;
        }
        let arm = HeldArm::new(&self.scenario.arm, robot, &self.tool(), self.seed)?;
        let remedy = "move the board and the food nearer, lower task.cut.home_m, or turn the knife in the hand";
        let aim = Aim { task: KIND.name, arm: &robot.asset, held: "the middle of the edge", remedy };
        let ready = arm.ready(&plan, &scenario.controller, &scenario.engine, &aim)?;
        let wanted = pieces(&actual.believed.food.solid, &actual.believed.world_from_food, &places);
        Ok(Planned { plan, cuts, places, wanted, report, ready, actual })
    }

    fn simulate(&self, planned: &Planned, observer: &mut dyn Onlooker) -> Result<CutEpisode, StageError> {
        let scenario = &self.cut.scenario;
        let (engine, tool) = (&scenario.engine, self.tool());
        let Readied { arm, posture, .. } = &planned.ready;
        let mut world = SpatialWorld::new(engine, &standard_gravity()).map_err(broken)?;
        let mut process =
            CuttingProcess::insert(&mut world, &self.setup(&planned.actual.there, &planned.places)).map_err(broken)?;
        let mut scene = arm.scene(&tool, &planned.plan, engine);
        scene.fixed = process.fixed();
        scene.bodies = process.drawings();
        scene.series = CuttingProcess::series();
        let middle = Point3::from(planned.actual.there.world_from_food.translation.vector);
        scene.focus_world = (middle, FOCUS_RADIUS_M);
        let settle_s = scenario.cut().settle_s;
        let setup = SpatialSetup {
            plant: &arm.plant,
            model: &arm.model,
            tool: &tool,
            arm: &scenario.robot.motors,
            scene: &scene,
            engine,
            settle_s,
            longest_s: planned.plan.duration_s() + settle_s + PATIENCE_S,
        };
        let mut controller = built(&scenario.controller, &arm.model)?;
        let mut source = self.source(planned);
        let episode = simulate(&setup, world, posture, &mut source, controller.as_mut(), &mut process, observer)
            .map_err(broken)?;
        Ok(CutEpisode { episode, record: process.record() })
    }

    fn judge(&self, shown: &Shown, skill: &CutSkill, planned: &Planned, seen: &CutEpisode) -> Outcome {
        let measures = judge::measures(self, skill, planned, seen);
        let mut failures: Vec<String> = seen.record.failure.iter().map(ToString::to_string).collect();
        // what ended the run may be what failed first
        failures.extend(
            seen.episode.interruption.iter().filter(|reason| !failures.contains(reason)).cloned().collect::<Vec<_>>(),
        );
        let mut notes = planned.ready.notes.clone();
        notes.extend(judge::plan_notes(planned));
        notes.extend(judge::piece_notes(planned, seen));
        notes.extend(shown.failed.iter().map(|failed| format!("demonstrations: {failed}")));
        Outcome::judged(self.scenario, self.seed, measures, failures, notes, seen.episode.digest.clone())
    }

    fn simulated_s(seen: &CutEpisode) -> f64 {
        seen.episode.duration_s()
    }
}
