//! The arm of a scenario with a tool in its hand: what is simulated, what the controller believes in, what onlookers see.

use nalgebra::{DVector, Isometry3, Point3};
use robot::Manipulator;
use sim::SimError;
use sim::controllers::{Controller, ControllerConfig};
use sim::random::{Purpose, stream};
use sim::spatial::{
    ArmDescription, Drawing, EngineConfig, HeldTool, LinkDrawing, Rgba, SceneDescription, arm_with_tool,
    check_reach_along, out_of_reach, standard_gravity,
};
use skills::field::FieldError;
use skills::spatial::SpatialPlan;

use super::following::PlanSource;
use super::robot::SpatialRobotConfig;
use crate::tasks::{StageError, broken, infeasible};

/// Color of links whose file gives none.
const LINK_COLOR: Rgba = [0.85, 0.86, 0.88, 1.0];
/// Time between two points of a drawn path, s.
const DRAWING_STEP_S: f64 = 0.02;
/// Time between two looks at the stability of the control loop, s: it depends on the posture.
const STABILITY_CHECK_S: f64 = 0.1;
/// Name of the frame of the held tool in the arm's model.
const TOOL: &str = "tool";

/// Distance from which on a place is told to be out of reach; below it, it is the turn that does not fit, m.
const SHOWN_M: f64 = 5e-4;

/// Words for what a plan aims at.
pub(crate) struct Aim<'a> {
    /// Kind of the task.
    pub task: &'a str,
    /// Name of the arm.
    pub arm: &'a str,
    /// What is held: "the knife".
    pub held: &'a str,
    /// What brings a place within reach.
    pub remedy: &'a str,
}

/// An arm with a tool in its hand.
pub(crate) struct HeldArm {
    /// What is simulated.
    pub plant: Manipulator,
    /// What the controller believes in.
    pub model: Manipulator,
    /// Posture near which it begins, rad.
    pub near: DVector<f64>,
}

/// An arm that stands ready to carry out a plan.
pub(crate) struct Readied {
    /// The arm.
    pub arm: HeldArm,
    /// Its posture at the start, rad.
    pub posture: DVector<f64>,
    /// What a reader should know of the controller.
    pub notes: Vec<String>,
}

impl HeldArm {
    /// Puts `tool` into the hand of the arm that a scenario states; the model's errors are drawn for `seed`.
    pub fn new(arm: &Manipulator, robot: &SpatialRobotConfig, tool: &HeldTool, seed: u64) -> Result<Self, StageError> {
        let (base, gravity) = (robot.world_from_base(), standard_gravity());
        let nominal =
            arm_with_tool(arm, &robot.tool_frame, tool, &base, &gravity, &robot.rotor_inertia_kg_m2).map_err(broken)?;
        let frame = nominal.frame(TOOL).map_err(|error| StageError::Broken(error.to_string()))?;
        let random = stream(seed, Purpose::Model, 0);
        let (plant, model) = robot.mismatch.plant_and_model(&nominal, frame, random).map_err(broken)?;
        Ok(Self { plant, model, near: robot.posture(arm) })
    }

    /// Pose of the tool at the posture near which the arm begins, `world_from_tool`.
    pub fn tool_at_rest(&self) -> Result<Isometry3<f64>, StageError> {
        let stage = |error: robot::RobotError| StageError::Broken(error.to_string());
        let mut workspace = self.model.workspace();
        workspace.set_positions(&self.near).map_err(stage)?;
        let frame = self.model.frame(TOOL).map_err(stage)?;
        Ok(self.model.world_from_base() * workspace.base_from_frame(frame))
    }

    /// Checks that the arm can carry out `plan` and that its control loop is stable, and takes the posture of the start.
    ///
    /// Of a plan that the arm cannot follow, the first place that it cannot take at all is told, if there is one: `aim` has the words.
    pub fn ready(
        self,
        plan: &SpatialPlan,
        controller: &ControllerConfig,
        engine: &EngineConfig,
        aim: &Aim<'_>,
    ) -> Result<Readied, StageError> {
        let (controller, period_s) =
            (built(controller, &self.model)?, engine.steps_per_period() as f64 * engine.time_step_s);
        let mut workspace = self.model.workspace();
        let mut next_s = 0.0;
        let mut stable = |time_s: f64, q: &DVector<f64>| {
            if time_s < next_s {
                return Ok(());
            }
            next_s = time_s + STABILITY_CHECK_S;
            let checked = controller.check_stability(&mut workspace, q, period_s);
            checked.map_err(|error| {
                let found = format!("{} at {time_s:.2} s of the plan", error.found);
                FieldError { found, ..error.within("controller") }.into()
            })
        };
        let source = &mut PlanSource::new(plan);
        let posture = match check_reach_along(&self.model, &self.near, plan.duration_s(), source, &mut stable) {
            Ok(posture) => posture,
            Err(error @ SimError::Unreachable { .. }) => {
                return Err(self.unreachable(plan, aim).unwrap_or(infeasible(error)));
            }
            Err(error) => return Err(infeasible(error)),
        };
        let tool = self.model.frame(TOOL).map_err(|error| StageError::Broken(error.to_string()))?;
        let notes = controller.describe(&mut workspace, &posture, tool, period_s);
        Ok(Readied { arm: self, posture, notes })
    }

    /// The first place at which an action of the plan begins or ends and that the arm cannot take, in words; `None` if it can take
    /// all of them, and it is the way between them that is at fault.
    fn unreachable(&self, plan: &SpatialPlan, aim: &Aim<'_>) -> Option<StageError> {
        let first = plan.actions().first().map(|action| ("begin", action, action.track.start()));
        let ends = plan.actions().iter().map(|action| ("end", action, action.track.end()));
        first.into_iter().chain(ends).find_map(|(side, action, motion)| {
            let missing = out_of_reach(&self.model, &self.near, &motion.pose).ok()??;
            let place = motion.pose.translation.vector;
            let how_far = if missing.distance_m >= SHOWN_M {
                format!("{:.3} m out of reach of", missing.distance_m)
            } else {
                format!("to be turned by {:.3} rad more than fits", missing.angle_rad)
            };
            Some(StageError::Infeasible(format!(
                "plan {}: {} at the {side} of `{}`, ({:.3}, {:.3}, {:.3}) m, is {how_far} `{}` ({}); {}",
                aim.task, aim.held, action.name, place.x, place.y, place.z, aim.arm, missing.reason, aim.remedy
            )))
        })
    }

    /// What onlookers are told of the arm.
    pub fn description(&self, tool: &HeldTool) -> ArmDescription {
        let joints = self.plant.joints();
        let drawn = |body: &robot::Body| LinkDrawing {
            name: body.links.first().cloned().unwrap_or_default(),
            drawings: body.visuals.iter().filter_map(|shape| Drawing::of_link_shape(shape, LINK_COLOR)).collect(),
        };
        let bodies = std::iter::once(self.plant.base()).chain(joints.iter().map(|joint| &joint.body));
        ArmDescription {
            joints: joints.iter().map(|joint| joint.name.clone()).collect(),
            torque_limits_nm: joints.iter().map(|joint| joint.limits.effort.unwrap_or(f64::INFINITY)).collect(),
            links: bodies.map(drawn).collect(),
            tool: tool.drawings.clone(),
        }
    }

    /// The part of a scene's description that a plan and the arm give; fixed things, bodies, grains, curves and focus are the
    /// task's.
    pub fn scene(&self, tool: &HeldTool, plan: &SpatialPlan, engine: &EngineConfig) -> SceneDescription {
        let steps = (plan.duration_s() / DRAWING_STEP_S).ceil() as usize;
        let place = |step: usize| Point3::from(plan.at(step as f64 * DRAWING_STEP_S).pose.translation.vector);
        SceneDescription {
            arm: self.description(tool),
            phases: plan.actions().iter().map(|action| action.name.clone()).collect(),
            tool_path_world: (0..=steps).map(place).collect(),
            control_period_s: engine.steps_per_period() as f64 * engine.time_step_s,
            ..SceneDescription::default()
        }
    }
}

/// Builds the controller of a scenario for `model`.
pub(crate) fn built(controller: &ControllerConfig, model: &Manipulator) -> Result<Box<dyn Controller>, StageError> {
    controller.build(model.joint_count()).map_err(|error| StageError::Input(error.within("controller").to_string()))
}
