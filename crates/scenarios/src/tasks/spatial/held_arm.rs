//! The arm of a scenario with a tool in its hand: what is simulated, what the controller believes in, what onlookers see.

use nalgebra::{DVector, Isometry3, Point3};
use robot::Manipulator;
use sim::controllers::{Controller, ControllerConfig};
use sim::random::{Purpose, stream};
use sim::spatial::{
    ArmDescription, Drawing, EngineConfig, HeldTool, LinkDrawing, ReferenceSource, Rgba, SceneDescription,
    arm_with_tool, check_reach_along, standard_gravity,
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
    pub fn ready(
        self,
        plan: &SpatialPlan,
        controller: &ControllerConfig,
        engine: &EngineConfig,
    ) -> Result<Readied, StageError> {
        self.ready_for(plan.duration_s(), &mut PlanSource::new(plan), controller, engine)
    }

    /// The same for a reference that is not simply a plan.
    pub fn ready_for(
        self,
        duration_s: f64,
        source: &mut dyn ReferenceSource,
        controller: &ControllerConfig,
        engine: &EngineConfig,
    ) -> Result<Readied, StageError> {
        let controller = built(controller, &self.model)?;
        let mut workspace = self.model.workspace();
        let period_s = engine.steps_per_period() as f64 * engine.time_step_s;
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
        let posture =
            check_reach_along(&self.model, &self.near, duration_s, source, &mut stable).map_err(infeasible)?;
        let tool = self.model.frame(TOOL).map_err(|error| StageError::Broken(error.to_string()))?;
        let notes = controller.describe(&mut workspace, &posture, tool, period_s);
        Ok(Readied { arm: self, posture, notes })
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
