//! Pushing: bring an object over a table to a goal.

mod carried_out;
mod check;
mod config;
mod demonstrations;
mod judge;
mod learned;
mod recorded;
mod resolved;
mod scenario;
mod sections;
mod transferring;
mod variation;
mod varying;

use nalgebra::{DVector, Isometry2, Point2, Vector2};
use robot::Manipulator;
use sim::controllers::Controller;
use sim::planar::{
    ArmDescription, ArmReach, ClosedLoop, ClosedLoopConfig, Episode, OpenLoop, PlanarSetup, ReferenceSource,
    SceneDescription, arm_with_tool, check_reach, simulate,
};
use sim::random::{Purpose, stream};
use sim::sensing::Camera;
use skills::plan::{Action, Plan, Track};
use skills::tool_use::{LearningReport, PushProblem, SavedLibrary, SkillLibrary};
use skills::transfer::Transfer;

pub(crate) use carried_out::{CarriedOut, carry_out};
pub use config::{PushConfig, TransferTask};
pub(crate) use recorded::read as read_demonstration;
pub use resolved::ResolvedPush;
pub use scenario::{PushScenario, PushTable};
pub use sections::{DemonstrationsConfig, ExecutionConfig, ExecutionMode, Limits, SyntheticConfig};
pub use variation::{Variation, VariationConfig};

use demonstrations::Shown;
use varying::Actual;

use super::{ShownTrial, StageError, Task, TaskKind, broken, infeasible};
use crate::outcome::Outcome;
use crate::pipeline::{Onlooker, Progress};
use crate::scenario::{KeptSkills, Origin, ResolvedScenario, SkillsFile, describe_skills, load_as};
use crate::schema::subschema;

/// The kind.
pub(crate) const KIND: TaskKind = TaskKind {
    name: "push",
    summary: "push an object over a table to a goal, past obstacles, with a tool",
    example: ("scenarios/push_stick.toml", include_str!("../../../../../scenarios/push_stick.toml")),
    tool_key: Some("tool.asset"),
    load: load_as::<PushScenario>,
    skills: Some(describe_skills::<SavedLibrary>),
    schema: subschema::<PushScenario>,
};

/// Time between two motions of a plan, s.
const PLAN_STEP_S: f64 = 0.002;
/// A run may last this many times its plan.
const PATIENCE: f64 = 2.0;
/// Frames in which the camera looks at the resting object before the plan is made, and the time that it may take, s.
const FIRST_FRAMES: u32 = 30;
const LOOK_FIRST_S: f64 = 30.0;
/// Time between two points of a drawn path, s.
const DRAWING_STEP_S: f64 = 0.05;

/// A pushing task of one scenario and seed.
pub(crate) struct PushTask<'a> {
    /// The whole scenario.
    scenario: &'a ResolvedScenario,
    /// What is particular to a push in it.
    push: &'a ResolvedPush,
    config: &'a PushConfig,
    seed: u64,
    /// What is really there.
    actual: Actual,
}

/// What was learned.
pub(crate) struct Learned {
    library: SkillLibrary,
    report: LearningReport,
}

/// A plan that the arm can carry out.
pub(crate) struct Checked {
    plan: Plan,
    /// What the plan was made of, if the skill was transferred.
    transfer: Option<Transfer>,
    model: Manipulator,
    posture: DVector<f64>,
    /// The camera that has looked at the start.
    camera: Camera,
    controller_notes: Vec<String>,
}

impl<'a> PushTask<'a> {
    /// The task that a scenario states.
    pub(crate) fn new(scenario: &'a ResolvedScenario, push: &'a ResolvedPush, seed: u64) -> Self {
        Self { scenario, push, config: push.scenario.push(), seed, actual: Actual::new(push, seed) }
    }

    /// Looks at the object before anything moves: the camera, and the mean of its first frames.
    fn look_first(&self) -> Result<(Camera, Point2<f64>), StageError> {
        let mut camera = Camera::new(&self.push.scenario.camera, stream(self.seed, Purpose::Camera, 0));
        let (there, period_s) = (self.actual.world_from_object, self.period_s());
        let (mut sum, mut frames, mut newest_s) = (Vector2::zeros(), 0, f64::NEG_INFINITY);
        for period in 0..(LOOK_FIRST_S / period_s) as usize {
            let sighting = camera.look(period as f64 * period_s, &there);
            if let Some(sighting) = sighting.filter(|sighting| sighting.exposed_s > newest_s) {
                newest_s = sighting.exposed_s;
                sum += sighting.world_from_object.translation.vector;
                frames += 1;
            }
            if frames == FIRST_FRAMES {
                camera.begin_anew();
                return Ok((camera, Point2::from(sum / f64::from(frames))));
            }
        }
        Err(StageError::Infeasible(format!(
            "plan push: the camera showed the object in {frames} frames within {LOOK_FIRST_S} s; expected {FIRST_FRAMES}; raise \
             camera.rate_hz, or lower camera.latency_s or camera.drop_out"
        )))
    }

    fn period_s(&self) -> f64 {
        self.push.scenario.engine.control_period_s
    }

    fn scene_description(&self, checked: &Checked) -> SceneDescription {
        let scenario = &self.push.scenario;
        let path = |track: fn(&Action) -> &Track| {
            checked.plan.actions().iter().flat_map(|action| drawn(track(action))).collect()
        };
        let joints = checked.model.joints();
        SceneDescription {
            world: scenario.world.clone(),
            object: scenario.object.clone(),
            tool: self.push.tool.clone(),
            arm: ArmDescription {
                joints: joints.iter().map(|joint| joint.name.clone()).collect(),
                torque_limits_nm: joints.iter().map(|joint| joint.limits.effort.unwrap_or(f64::INFINITY)).collect(),
            },
            phases: checked.plan.actions().iter().map(|action| action.name.clone()).collect(),
            tool_path_world: path(|action| &action.tool),
            object_path_world: path(|action| &action.object),
            goal_world: self.config.goal_m.into(),
            control_period_s: self.period_s(),
        }
    }

    /// The arm with the tool in its hand.
    fn model(&self) -> Result<Manipulator, StageError> {
        let scenario = &self.push.scenario;
        let robot = &scenario.robot;
        let base = Isometry2::new(Vector2::from(robot.base_m), robot.base_angle_rad);
        let (gravity, tool) = (scenario.world.gravity_m_per_s2, &self.push.tool);
        arm_with_tool(&self.scenario.arm, &robot.tool_frame, tool, &base, gravity, &robot.rotor_inertia_kg_m2)
            .map_err(broken)
    }

    /// A plan that keeps the demonstrated sequence of surfaces.
    fn demonstrated_sequence(&self, skills: &Learned, start_world: Point2<f64>) -> Result<Plan, StageError> {
        let problem = PushProblem {
            start_world,
            goal_world: self.config.goal_m.into(),
            home_world: self.config.home_m.into(),
            park_world: self.config.park_m().into(),
            object: &self.push.scenario.object.shape,
            tool: &self.push.tool,
            orientation: self.config.orientation,
            push_speed_m_per_s: self.config.push_speed_m_per_s,
            free_speed_m_per_s: self.config.free_speed_m_per_s,
            time_step_s: PLAN_STEP_S,
        };
        problem.plan(&skills.library).map_err(|error| StageError::Infeasible(error.to_string()))
    }

    fn controller(&self, joints: usize) -> Result<Box<dyn Controller>, StageError> {
        self.push.scenario.controller.build(joints).map_err(|error| StageError::Input(error.to_string()))
    }

    fn reference_source<'p>(&'p self, checked: &'p Checked) -> Result<Box<dyn ReferenceSource + 'p>, StageError> {
        let (scenario, plan) = (&self.push.scenario, &checked.plan);
        Ok(match scenario.execution.mode {
            ExecutionMode::OpenLoop => Box::new(OpenLoop::new(plan)),
            ExecutionMode::ClosedLoop => {
                let config = ClosedLoopConfig {
                    steering: scenario.execution.steering.clone(),
                    response_s: scenario.execution.response_s,
                    patience: PATIENCE,
                    hold_renewal: scenario.execution.hold_renewal.clone(),
                };
                let (tool, object, camera) = (&self.push.tool, &scenario.object, &scenario.camera);
                let reach = ArmReach::new(&checked.model, &scenario.robot.tool_frame).map_err(broken)?;
                let closed_loop = ClosedLoop::new(plan, tool, object, camera, config, self.period_s());
                Box::new(closed_loop.renewing_holds(&scenario.world, &reach))
            }
        })
    }
}

impl Task for PushTask<'_> {
    type Shown = Shown;
    type Skills = Learned;
    type Plan = Checked;
    type Episode = Episode;

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

    fn learn(&self, shown: &Shown) -> Result<Learned, StageError> {
        let scenario = &self.push.scenario;
        let tool = &self.push.demonstration_tool;
        if let Some(file) = &self.push.learned {
            let restored = file.skills.clone().restore(tool).map_err(|error| StageError::Broken(error.to_string()))?;
            let report = LearningReport { used: file.learned.demonstrations.clone(), ..LearningReport::default() };
            return Ok(Learned { library: restored, report });
        }
        let learned = SkillLibrary::learn(&scenario.primitive, &shown.demonstrations, tool, &scenario.object.shape);
        learned
            .map(|(library, report)| Learned { library, report })
            .map_err(|error| StageError::Infeasible(error.to_string()))
    }

    fn save(&self, _shown: &Shown, skills: &Learned) -> Result<KeptSkills, StageError> {
        let tool = &self.push.demonstration_tool;
        let origin = match &self.push.learned {
            Some(file) => file.learned.clone(),
            None => Origin {
                scenario: self.scenario.name.clone(),
                seed: self.seed,
                tool: self.push.demonstration_tool_name().to_owned(),
                demonstrations: skills.report.used.clone(),
            },
        };
        SkillsFile::new(origin, skills.library.saved(tool)).kept().map_err(StageError::Broken)
    }

    fn plan(&self, skills: &Learned) -> Result<Checked, StageError> {
        let scenario = &self.push.scenario;
        let (camera, start_world) = self.look_first()?;
        let model = self.model()?;
        let (plan, transfer) = match &self.config.transfer {
            None => (self.demonstrated_sequence(skills, start_world)?, None),
            Some(config) => {
                let transfer = transferring::plan(self, config, skills, start_world, &model)?;
                (transfer.plan.clone(), Some(transfer))
            }
        };
        judge::check_plan(&plan, &self.push.tool, &scenario.object, &scenario.world).map_err(StageError::Infeasible)?;
        let posture = check_reach(&plan, &model, &scenario.robot.tool_frame).map_err(infeasible)?;
        let controller = self.controller(model.joint_count())?;
        let mut workspace = model.workspace();
        let flange = model.frame(&scenario.robot.tool_frame).map_err(|error| StageError::Input(error.to_string()))?;
        controller
            .check_stability(&mut workspace, &posture, self.period_s())
            .map_err(|error| StageError::Input(error.within("controller").to_string()))?;
        let controller_notes = controller.describe(&mut workspace, &posture, flange, self.period_s());
        Ok(Checked { plan, transfer, model, posture, camera, controller_notes })
    }

    fn simulate(&self, checked: &Checked, observer: &mut dyn Onlooker) -> Result<Episode, StageError> {
        let scenario = &self.push.scenario;
        let scene = self.scene_description(checked);
        let setup = PlanarSetup {
            world: &scenario.world,
            object: &self.actual.object,
            world_from_object: self.actual.world_from_object,
            tool: &self.actual.tool,
            model: &checked.model,
            flange: &scenario.robot.tool_frame,
            engine: &scenario.engine,
            scene: &scene,
            settle_s: self.config.settle_s,
            longest_s: PATIENCE * checked.plan.duration_s() + self.config.settle_s,
        };
        let mut controller = self.controller(checked.model.joint_count())?;
        let mut source = self.reference_source(checked)?;
        let mut camera = checked.camera.clone();
        simulate(&setup, &checked.posture, source.as_mut(), controller.as_mut(), &mut camera, observer).map_err(broken)
    }

    fn judge(&self, shown: &Shown, skills: &Learned, checked: &Checked, episode: &Episode) -> Outcome {
        let mut notes = checked.controller_notes.clone();
        notes.extend(shown.failed.iter().map(|failed| format!("demonstrations: {failed}")));
        notes
            .extend(skills.report.left_out.iter().map(|(name, why)| format!("demonstrations: left out {name}: {why}")));
        let mut measures = judge::measures(self, &checked.plan, episode);
        if let Some(transfer) = &checked.transfer {
            measures.extend(transferring::measures(transfer));
            notes.extend(transferring::notes(transfer, &self.push.tool));
        }
        measures.extend(self.actual.measures(&self.push.scenario.variation));
        measures.extend(judge::demonstration_measures(shown.failed.len(), &skills.report));
        let failures = episode.interruption.iter().cloned().collect();
        Outcome::judged(self.scenario, self.seed, measures, failures, notes, episode.digest.clone())
    }

    fn simulated_s(episode: &Episode) -> f64 {
        episode.duration_s()
    }
}

fn drawn(track: &Track) -> Vec<Point2<f64>> {
    let steps = (track.duration_s() / DRAWING_STEP_S).ceil() as usize;
    (0..=steps).map(|step| track.at(step as f64 * DRAWING_STEP_S).point()).collect()
}
