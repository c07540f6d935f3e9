//! Pouring: tilt a held cup of beans so that they end in a bowl, a cup, a bottle.

mod config;
mod demonstrations;
mod engine;
mod judge;
mod learned;
mod plan;
mod reference;
mod scenario;
mod variation;
mod vessel;

use nalgebra::{Isometry3, Point3, Vector3};
use sim::pouring::{PourResult, PourSetup, PouringProcess, container_drawing, fill, grain_description, held_container};
use sim::random::{Purpose, stream};
use sim::spatial::{
    Drawing, DrawnShape, Episode, HeldTool, Rgba, SceneDescription, SpatialSetup, SpatialWorld, simulate,
    standard_gravity,
};
use skills::pouring::{PourError, PourPlan, PourSkill, SavedPour};

pub use config::{
    AmountConfig, GrainsConfig, PourConfig, PourDemonstrations, PourLimits, PourSkillKind, RecordedPour, SourceConfig,
    SyntheticPour, TargetConfig,
};
pub use engine::PourEngineConfig;
pub use scenario::{PourScenario, PourTable, ResolvedPour, ShownVessels};
pub use variation::{DrawnPour, PourVariation};
pub use vessel::Vessel;

use self::demonstrations::Shown;
use self::reference::PourSource;
use super::spatial::{Readied, built};
use super::{ShownTrial, StageError, Task, TaskKind, broken};
use crate::outcome::Outcome;
use crate::pipeline::{Onlooker, Progress};
use crate::scenario::{KeptSkills, ResolvedScenario, describe_skills, load_as};
use crate::schema::subschema;

/// The kind.
pub(crate) const KIND: TaskKind = TaskKind {
    name: "pour",
    summary: "pour beans from a held cup into a container",
    example: ("scenarios/pour_wide_bowl.toml", include_str!("../../../../../scenarios/pour_wide_bowl.toml")),
    tool_key: Some("source.asset"),
    load: load_as::<PourScenario>,
    skills: Some(describe_skills::<SavedPour>),
    schema: subschema::<PourScenario>,
};

/// Time beyond the plan, its rest and a steered tilt after which a run is broken off, s.
const SPARE_S: f64 = 1.0;
/// Radius around the mouth that is worth seeing, m.
const FOCUS_RADIUS_M: f64 = 0.35;
const CUP_COLOR: Rgba = [0.45, 0.68, 0.95, 0.35];
const TARGET_COLOR: Rgba = [0.70, 0.85, 0.80, 0.35];
const TABLE_COLOR: Rgba = [0.80, 0.74, 0.66, 1.0];
/// Darker than soybeans are, to be seen against table and glass.
const BEAN_COLOR: Rgba = [0.52, 0.20, 0.06, 1.0];

/// A pouring task of one scenario and seed.
pub(crate) struct PourTask<'a> {
    scenario: &'a ResolvedScenario,
    pour: &'a ResolvedPour,
    seed: u64,
}

/// A plan that the arm can carry out.
pub(crate) struct Planned {
    pour: PourPlan,
    ready: Readied,
    tool: HeldTool,
    world_from_target: Isometry3<f64>,
    /// Certified distance of cup and target as they collide, m; `None` if nothing was certified.
    clearance_m: Option<f64>,
    drawn: DrawnPour,
}

/// What happened.
pub(crate) struct PourEpisode {
    episode: Episode,
    poured: PourResult,
}

impl<'a> PourTask<'a> {
    /// The task that a scenario states.
    pub fn new(scenario: &'a ResolvedScenario, pour: &'a ResolvedPour, seed: u64) -> Self {
        Self { scenario, pour, seed }
    }

    fn file(&self) -> &PourScenario {
        &self.pour.scenario
    }

    /// The scene as onlookers are told of it.
    fn scene(&self, planned: &Planned) -> SceneDescription {
        let arm = &planned.ready.arm;
        let mut scene = arm.scene(&planned.tool, &planned.pour.plan, &self.file().engine.arm());
        let mouth = planned.world_from_target * self.pour.target.container.rim.center_in_container;
        let below = Isometry3::translation(mouth.x, mouth.y, -0.01);
        let table = DrawnShape::Box { size_m: Vector3::new(0.9, 0.9, 0.02) };
        scene.fixed = vec![
            Drawing { shape: table, body_from_shape: below, color: TABLE_COLOR },
            container_drawing(&self.pour.target.container, &planned.world_from_target, TARGET_COLOR),
        ];
        scene.series = PouringProcess::series_names();
        scene.main_plots = ["flow [g/s]", "beans", "tilt [deg]"].map(String::from).to_vec();
        scene.focus_world = (Point3::new(mouth.x, mouth.y, mouth.z + 0.05), FOCUS_RADIUS_M);
        scene
    }
}

/// A refusal of the skill: the scenario's numbers make no sense, or the pour cannot be done.
fn refused(error: PourError) -> StageError {
    match error {
        PourError::Skill(_) => StageError::Input(error.to_string()),
        _ => StageError::Infeasible(error.to_string()),
    }
}

impl Task for PourTask<'_> {
    type Shown = Shown;
    type Skills = PourSkill;
    type Plan = Planned;
    type Episode = PourEpisode;

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

    fn learn(&self, shown: &Shown) -> Result<PourSkill, StageError> {
        learned::learn(self, shown)
    }

    fn save(&self, shown: &Shown, skill: &PourSkill) -> Result<KeptSkills, StageError> {
        learned::kept(self, shown, skill)
    }

    fn plan(&self, skill: &PourSkill) -> Result<Planned, StageError> {
        plan::plan(self, skill)
    }

    fn simulate(&self, planned: &Planned, observer: &mut dyn Onlooker) -> Result<PourEpisode, StageError> {
        let (file, source) = (self.file(), &self.pour.source.container);
        let (engine, grains) = (file.engine.arm(), file.engine.grains());
        let bean = planned.drawn.bean(&file.grains.bean);
        let mut random = stream(self.seed, Purpose::Grains, 0);
        let filling =
            fill(source, &bean, &grains, planned.drawn.fill(file.grains.fill), &mut random).map_err(broken)?;
        let mut scene = self.scene(planned);
        scene.grains = Some(grain_description(&filling.batch, BEAN_COLOR));
        let mut process = PouringProcess::new(PourSetup {
            source: source.clone(),
            target: self.pour.target.container.clone(),
            world_from_target: planned.world_from_target,
            filling,
            table: file.table.clone(),
            monitor: file.monitor.clone(),
        });
        let Readied { arm, posture, .. } = &planned.ready;
        let (pour, config) = (&planned.pour, file.pour());
        let steered_s = config.amount.as_ref().map_or(0.0, |amount| amount.approach.longest_s);
        let setup = SpatialSetup {
            plant: &arm.plant,
            model: &arm.model,
            tool: &planned.tool,
            arm: &file.robot.motors,
            scene: &scene,
            engine: &engine,
            settle_s: config.settle_s,
            longest_s: pour.plan.duration_s() + config.settle_s + SPARE_S + steered_s,
        };
        let mut world = SpatialWorld::new(&engine, &standard_gravity()).map_err(broken)?;
        grains.apply(&mut world.physics.integration_parameters);
        let mut controller = built(&file.controller, &arm.model)?;
        let period_s = engine.control_period_s;
        let mut reference = PourSource::new(pour, process.gauge(), config, period_s)
            .map_err(|error| StageError::Input(error.within("task.pour.amount").to_string()))?;
        let episode = simulate(&setup, world, posture, &mut reference, controller.as_mut(), &mut process, observer)
            .map_err(broken)?;
        let poured = process.result().ok_or_else(|| StageError::Broken("pour: nothing was simulated".into()))?;
        Ok(PourEpisode { episode, poured })
    }

    fn judge(&self, shown: &Shown, _skill: &PourSkill, planned: &Planned, episode: &PourEpisode) -> Outcome {
        let measures = judge::measures(self.file(), planned, episode);
        let failures = episode.episode.interruption.iter().cloned().collect();
        let mut notes = planned.ready.notes.clone();
        notes.extend(shown.failed.iter().map(|failed| format!("demonstrations: {failed}")));
        Outcome::judged(self.scenario, self.seed, measures, failures, notes, episode.episode.digest.clone())
    }

    fn simulated_s(episode: &PourEpisode) -> f64 {
        episode.episode.duration_s()
    }
}

/// The cup of a scenario in the hand of its arm.
fn held(pour: &ResolvedPour) -> HeldTool {
    let container = &pour.source.container;
    held_container(container, &pour.scenario.source.grip.grip_from_cup(container), CUP_COLOR)
}

#[cfg(test)]
#[path = "weight_tests.rs"]
mod tests;
