//! Pushing: bring an object over a table to a goal.

mod config;
mod judge;
mod recorded;

use nalgebra::{DVector, Isometry2, Point2, Vector2};
use robot::Manipulator;
use sim::SimError;
use sim::controllers::Controller;
use sim::human::{DemonstrationTask, Trial, demonstrate};
use sim::planar::{
    ArmDescription, ClosedLoop, ClosedLoopConfig, Episode, Observer, OpenLoop, PlanarSetup, ReferenceSource,
    SceneDescription, arm_with_tool, check_reach, simulate,
};
use sim::random::{Purpose, stream};
use sim::sensing::Camera;
use skills::demonstration::Demonstration;
use skills::plan::{Action, Plan, Track};
use skills::tool_use::{LearningReport, PushProblem, SkillLibrary};

pub use config::PushConfig;

use super::{StageError, Task};
use crate::outcome::Outcome;
use crate::pipeline::Progress;
use crate::scenario::{DemonstrationsConfig, ExecutionMode, ResolvedScenario, SyntheticConfig};

/// Time between two motions of a plan, s.
const PLAN_STEP_S: f64 = 0.002;
/// Time between two torques, s: the rate of common torque-controlled arms.
const CONTROL_PERIOD_S: f64 = 0.001;
/// A run may last this many times its plan.
const PATIENCE: f64 = 2.0;
/// Trials that a human may spend on each demonstration wanted.
const TRIALS_PER_DEMONSTRATION: usize = 4;
/// Time for which the camera looks at the resting object before the plan is made, s.
const LOOK_FIRST_S: f64 = 1.0;
/// Distance between two points of a drawn path, s.
const DRAWING_STEP_S: f64 = 0.05;

/// A pushing task of one scenario and seed.
pub struct PushTask<'a> {
    scenario: &'a ResolvedScenario,
    config: &'a PushConfig,
    seed: u64,
}

/// Demonstrations of a push.
pub struct Shown {
    demonstrations: Vec<Demonstration>,
    /// Trials that failed, with the reason.
    failed: Vec<String>,
}

/// What was learnt.
pub struct Learnt {
    library: SkillLibrary,
    report: LearningReport,
}

/// A plan that the arm can carry out.
pub struct Checked {
    plan: Plan,
    model: Manipulator,
    posture: DVector<f64>,
    controller_notes: Vec<String>,
}

impl<'a> PushTask<'a> {
    /// The task that a scenario states.
    pub fn new(scenario: &'a ResolvedScenario, config: &'a PushConfig, seed: u64) -> Self {
        Self { scenario, config, seed }
    }

    fn synthetic(&self, config: &SyntheticConfig, progress: Progress<'_>) -> Result<Shown, StageError> {
        let scenario = &self.scenario.scenario;
        let tool = &self.scenario.demonstration_tool;
        let surfaces = surface_indices(tool, &config.surfaces)?;
        let task = DemonstrationTask {
            world: &scenario.world,
            object: &scenario.object,
            tool,
            surfaces: &surfaces,
            start_world: config.start_m.into(),
            goal_world: config.goal_m.into(),
            home_world: self.config.home_m.into(),
            park_world: self.config.park_m().into(),
            human: &config.human,
            camera: &scenario.camera,
            engine: &scenario.engine,
        };
        let mut shown = Shown { demonstrations: Vec::new(), failed: Vec::new() };
        for trial in 0..config.count * TRIALS_PER_DEMONSTRATION {
            if shown.demonstrations.len() == config.count {
                break;
            }
            let Trial { demonstration, failure, .. } = demonstrate(&task, self.seed, trial as u64).map_err(broken)?;
            match failure {
                Some(reason) => shown.failed.push(format!("{} {reason}", demonstration.name)),
                None => shown.demonstrations.push(demonstration),
            }
            progress("demonstrate", Some(shown.demonstrations.len() as f64 / config.count as f64));
        }
        if shown.demonstrations.len() < config.count {
            return Err(StageError::Infeasible(format!(
                "demonstrate: {} of {} demonstrations succeeded in {} trials ({}); expected all; make the task of the \
                 demonstrations easier or the human more able",
                shown.demonstrations.len(),
                config.count,
                config.count * TRIALS_PER_DEMONSTRATION,
                shown.failed.join("; "),
            )));
        }
        Ok(shown)
    }

    /// Where the camera of this run sees the object before anything moves: the mean of its first frames.
    fn seen_start(&self) -> Point2<f64> {
        let mut camera = self.camera();
        let there = self.world_from_object();
        let (mut sum, mut frames, mut newest_s) = (Vector2::zeros(), 0.0, f64::NEG_INFINITY);
        for period in 0..(LOOK_FIRST_S / CONTROL_PERIOD_S) as usize {
            let sighting = camera.look(period as f64 * CONTROL_PERIOD_S, &there);
            if let Some(sighting) = sighting.filter(|sighting| sighting.exposed_s > newest_s) {
                newest_s = sighting.exposed_s;
                sum += sighting.world_from_object.translation.vector;
                frames += 1.0;
            }
        }
        if frames > 0.0 { Point2::from(sum / frames) } else { self.config.start_m.into() }
    }

    fn camera(&self) -> Camera {
        Camera::new(&self.scenario.scenario.camera, stream(self.seed, Purpose::Camera, 0))
    }

    fn world_from_object(&self) -> Isometry2<f64> {
        Isometry2::new(Vector2::from(self.config.start_m), self.config.start_angle_rad)
    }

    fn scene_description(&self, checked: &Checked) -> SceneDescription {
        let scenario = &self.scenario.scenario;
        let path = |track: fn(&Action) -> &Track| {
            checked.plan.actions().iter().flat_map(|action| drawn(track(action))).collect()
        };
        let joints = checked.model.joints();
        SceneDescription {
            world: scenario.world.clone(),
            object: scenario.object.clone(),
            tool: self.scenario.tool.clone(),
            arm: ArmDescription {
                joints: joints.iter().map(|joint| joint.name.clone()).collect(),
                torque_limits_nm: joints.iter().map(|joint| joint.limits.effort.unwrap_or(f64::INFINITY)).collect(),
            },
            phases: checked.plan.actions().iter().map(|action| action.name.clone()).collect(),
            tool_path_world: path(|action| &action.tool),
            object_path_world: path(|action| &action.object),
            goal_world: self.config.goal_m.into(),
            control_period_s: CONTROL_PERIOD_S,
        }
    }

    fn controller(&self, joints: usize) -> Result<Box<dyn Controller>, StageError> {
        self.scenario.scenario.controller.build(joints).map_err(|error| StageError::Input(error.to_string()))
    }

    fn reference_source<'p>(&'p self, plan: &'p Plan) -> Box<dyn ReferenceSource + 'p> {
        let scenario = &self.scenario.scenario;
        match scenario.execution.mode {
            ExecutionMode::OpenLoop => Box::new(OpenLoop::new(plan)),
            ExecutionMode::ClosedLoop => {
                let config = ClosedLoopConfig {
                    steering: scenario.execution.steering.clone(),
                    response_s: scenario.execution.response_s,
                    patience: PATIENCE,
                };
                Box::new(ClosedLoop::new(
                    plan,
                    &self.scenario.tool,
                    &scenario.object,
                    &scenario.camera,
                    config,
                    CONTROL_PERIOD_S,
                ))
            }
        }
    }
}

impl Task for PushTask<'_> {
    type Shown = Shown;
    type Skills = Learnt;
    type Plan = Checked;
    type Episode = Episode;

    fn demonstrations(&self, progress: Progress<'_>) -> Result<Shown, StageError> {
        match &self.scenario.scenario.demonstrations {
            DemonstrationsConfig::Synthetic(config) => self.synthetic(config, progress),
            DemonstrationsConfig::Recorded { .. } => {
                let read = self.scenario.recorded.iter().map(|(name, text)| recorded::read(name, text));
                let demonstrations = read.collect::<Result<_, _>>().map_err(StageError::Input)?;
                Ok(Shown { demonstrations, failed: Vec::new() })
            }
        }
    }

    fn learn(&self, shown: &Shown) -> Result<Learnt, StageError> {
        let scenario = &self.scenario.scenario;
        let tool = &self.scenario.demonstration_tool;
        let learnt = SkillLibrary::learn(&scenario.primitive, &shown.demonstrations, tool, &scenario.object.shape);
        learnt
            .map(|(library, report)| Learnt { library, report })
            .map_err(|error| StageError::Infeasible(error.to_string()))
    }

    fn plan(&self, skills: &Learnt) -> Result<Checked, StageError> {
        let scenario = &self.scenario.scenario;
        let problem = PushProblem {
            start_world: self.seen_start(),
            goal_world: self.config.goal_m.into(),
            home_world: self.config.home_m.into(),
            park_world: self.config.park_m().into(),
            object: &scenario.object.shape,
            tool: &self.scenario.tool,
            orientation: self.config.orientation,
            push_speed_m_per_s: self.config.push_speed_m_per_s,
            free_speed_m_per_s: self.config.free_speed_m_per_s,
            time_step_s: PLAN_STEP_S,
        };
        let plan = problem.plan(&skills.library).map_err(|error| StageError::Infeasible(error.to_string()))?;
        judge::check_plan(&plan, &self.scenario.tool, &scenario.object, &scenario.world)
            .map_err(StageError::Infeasible)?;
        let robot = &scenario.robot;
        let base = Isometry2::new(Vector2::from(robot.base_m), robot.base_angle_rad);
        let gravity = scenario.world.gravity_m_per_s2;
        let tool = &self.scenario.tool;
        let model =
            arm_with_tool(&self.scenario.arm, &robot.tool_frame, tool, &base, gravity, &robot.rotor_inertia_kg_m2)
                .map_err(broken)?;
        let posture = check_reach(&plan, &model, &robot.tool_frame).map_err(infeasible)?;
        let controller = self.controller(model.joint_count())?;
        let mut workspace = model.workspace();
        controller
            .check_stability(&mut workspace, &posture, CONTROL_PERIOD_S)
            .map_err(|error| StageError::Input(error.within("controller").to_string()))?;
        let controller_notes = controller.describe(&mut workspace, &posture, CONTROL_PERIOD_S);
        Ok(Checked { plan, model, posture, controller_notes })
    }

    fn simulate(&self, checked: &Checked, observer: &mut dyn Observer) -> Result<Episode, StageError> {
        let scenario = &self.scenario.scenario;
        let setup = PlanarSetup {
            world: &scenario.world,
            object: &scenario.object,
            world_from_object: self.world_from_object(),
            tool: &self.scenario.tool,
            model: &checked.model,
            flange: &scenario.robot.tool_frame,
            engine: &scenario.engine,
            control_period_s: CONTROL_PERIOD_S,
            settle_s: self.config.settle_s,
            longest_s: PATIENCE * checked.plan.duration_s() + self.config.settle_s,
        };
        let mut controller = self.controller(checked.model.joint_count())?;
        let mut source = self.reference_source(&checked.plan);
        let mut camera = self.camera();
        observer.begin(&self.scene_description(checked));
        simulate(&setup, &checked.posture, source.as_mut(), controller.as_mut(), &mut camera, observer).map_err(broken)
    }

    fn judge(&self, shown: &Shown, skills: &Learnt, checked: &Checked, episode: &Episode) -> Outcome {
        let mut notes = checked.controller_notes.clone();
        notes.extend(shown.failed.iter().map(|failed| format!("demonstrations: {failed}")));
        notes
            .extend(skills.report.left_out.iter().map(|(name, why)| format!("demonstrations: left out {name}: {why}")));
        let mut measures = judge::measures(self, &checked.plan, episode);
        measures.extend(judge::demonstration_measures(shown.failed.len(), &skills.report));
        let failures = episode.interruption.iter().cloned().collect();
        Outcome::judged(self.scenario, self.seed, measures, failures, notes, episode.digest.clone())
    }

    fn simulated_s(episode: &Episode) -> f64 {
        episode.duration_s()
    }
}

fn broken(error: SimError) -> StageError {
    match error {
        SimError::Field(error) => StageError::Input(error.to_string()),
        other => StageError::Broken(other.to_string()),
    }
}

fn infeasible(error: SimError) -> StageError {
    match error {
        SimError::Unreachable { .. } => StageError::Infeasible(error.to_string()),
        other => broken(other),
    }
}

fn drawn(track: &Track) -> Vec<Point2<f64>> {
    let steps = (track.duration_s() / DRAWING_STEP_S).ceil() as usize;
    (0..=steps).map(|step| track.at(step as f64 * DRAWING_STEP_S).point()).collect()
}

/// Indices of the named surfaces; all of them if none is named.
fn surface_indices(tool: &skills::tool::Tool, names: &[String]) -> Result<Vec<usize>, StageError> {
    if names.is_empty() {
        return Ok((0..tool.surfaces.len()).collect());
    }
    let find = |name: &String| {
        tool.surfaces.iter().position(|surface| surface.name == *name).ok_or_else(|| {
            let known: Vec<&str> = tool.surfaces.iter().map(|surface| surface.name.as_str()).collect();
            StageError::Input(format!(
                "demonstrations.synthetic.surfaces: found '{name}'; expected a surface of the tool '{}': {}",
                tool.name,
                known.join(", ")
            ))
        })
    };
    names.iter().map(find).collect()
}
