//! The control loop of a spatial run: reference, inverse kinematics, controller, task physics, engine.

use nalgebra::{DVector, Matrix6xX, Vector6};
use robot::{DifferentialKinematics, JointReference, JointState, Manipulator, Workspace};
use skills::field::{FieldError, within};

use super::arm::SpatialArm;
use super::arm_config::ArmConfig;
use super::config::EngineConfig;
use super::episode::{Episode, EpisodeSample};
use super::frames::{follow, follower, frame_motion, turned_into_base};
use super::observer::{Event, EventLevel, Observer, Sample, SceneDescription};
use super::process::{Process, Step};
use super::reference::{ReferenceSource, SpatialReference};
use super::tool::{HeldTool, TOOL_FRAME};
use super::view::View;
use super::world::SpatialWorld;
use super::wrench::WrenchSensor;
use crate::controllers::Controller;
use crate::error::SimError;

/// Longest run, s: beyond it, a number is a mistake.
const LONGEST_RUN_S: f64 = 3600.0;

/// Most control periods of a run: each leaves a sample of a quarter of a kilobyte.
const MOST_PERIODS: f64 = 5e6;

/// Everything that a spatial run is made of, but for what the task adds.
pub struct SpatialSetup<'a> {
    /// Model of the arm and the tool that is simulated: see [`super::arm_with_tool`].
    pub plant: &'a Manipulator,
    /// Model of the arm and the tool that the controller believes in: see [`super::ModelMismatch`].
    pub model: &'a Manipulator,
    /// The tool in the hand.
    pub tool: &'a HeldTool,
    /// Friction and motors of the arm.
    pub arm: &'a ArmConfig,
    /// What onlookers are told of the scene.
    pub scene: &'a SceneDescription,
    /// Time steps of the physics in a control period, and their length: those of the world.
    pub engine: &'a EngineConfig,
    /// Time after the plan's end in which things come to rest, s.
    pub settle_s: f64,
    /// Simulated time at which the run is broken off, s.
    pub longest_s: f64,
}

impl SpatialSetup<'_> {
    /// Checks the numbers against each other and against `world`.
    fn validate(&self, world: &SpatialWorld) -> Result<(), SimError> {
        self.engine.validate().map_err(|error| error.within("engine"))?;
        within("settle_s", self.settle_s, 0.0, LONGEST_RUN_S)?;
        within("longest_s", self.longest_s, 0.0, LONGEST_RUN_S)?;
        let periods = self.longest_s / self.engine.control_period_s;
        if periods > MOST_PERIODS {
            let found = format!("{} s, {periods:.0} times in {} s", self.engine.control_period_s, self.longest_s);
            let expected =
                format!("a period of which a run takes at most {MOST_PERIODS:.0}; lengthen it or shorten the plan");
            return Err(FieldError::new("engine.control_period_s", found, expected).into());
        }
        if self.engine.time_step_s != world.time_step_s() {
            let expected = format!("{} s, the time step of the world", world.time_step_s());
            return Err(
                FieldError::new("engine.time_step_s", format!("{} s", self.engine.time_step_s), expected).into()
            );
        }
        if self.plant.joint_count() != self.model.joint_count() {
            let (plant, model) = (self.plant.joint_count(), self.model.joint_count());
            let reason =
                format!("the controller's model has {model} joints, the arm {plant}; derive both from one arm");
            return Err(SimError::Arm { reason });
        }
        Ok(())
    }
}

/// Carries out a reference in `world` with the arm at posture `q` first; `process` adds the task's physics.
///
/// A reference that the arm cannot follow ends the run early: the episode says so.
///
/// # Errors
/// A [`SimError`] if the scene is invalid or the state diverges.
pub fn simulate(
    setup: &SpatialSetup<'_>,
    world: SpatialWorld,
    q: &DVector<f64>,
    source: &mut dyn ReferenceSource,
    controller: &mut dyn Controller,
    process: &mut dyn Process,
    observer: &mut dyn Observer,
) -> Result<Episode, SimError> {
    let mut run = Run::new(setup, world, q)?;
    process.begin(&mut run.world, &run.arm)?;
    observer.begin(setup.scene);
    let periods = (setup.longest_s / run.period_s).ceil() as usize;
    let mut samples = Vec::with_capacity(periods);
    let (mut finished_s, mut interruption) = (None, None);
    for period in 0..periods {
        let time_s = period as f64 * run.period_s;
        let reference = source.next(time_s, &run.arm.world_from_tool(&run.world));
        let wanted = frame_motion(setup.model, &reference);
        if let Err(error) = follow(&mut run.follower, setup.model, &wanted, &mut run.reference) {
            interruption = Some(format!("the arm could not follow its reference at {time_s:.3} s: {error}"));
            observer.event(&Event { time_s, level: EventLevel::Error, text: error.to_string() });
            break;
        }
        run.control(time_s, controller, &reference)?;
        process.tell(time_s, observer);
        samples.push(run.observe(period as u64, time_s, &reference, process, observer));
        run.advance(time_s, &reference, process)?;
        if let Some(reason) = process.gives_up() {
            interruption = Some(reason);
            break;
        }
        if reference.finished && time_s - *finished_s.get_or_insert(time_s) >= setup.settle_s {
            break;
        }
    }
    process.tell(samples.len() as f64 * run.period_s, observer);
    if finished_s.is_none() && interruption.is_none() {
        interruption = Some(format!("the plan was not carried out within {:.1} s", setup.longest_s));
    }
    Ok(Episode {
        samples,
        control_period_s: run.period_s,
        finished: finished_s.is_some(),
        interruption,
        digest: run.digest.finalize().to_hex().to_string(),
    })
}

/// Mutable state of a run.
struct Run<'a> {
    world: SpatialWorld,
    arm: SpatialArm,
    scene: &'a SceneDescription,
    follower: DifferentialKinematics,
    workspace: Workspace,
    sensor: WrenchSensor,
    state: JointState,
    reference: JointReference,
    torque_nm: DVector<f64>,
    jacobian: Matrix6xX<f64>,
    limits_nm: Vec<f64>,
    steps_per_period: usize,
    period_s: f64,
    /// As the arm's motion tells, and as the process says: means over the last control period.
    tool_wrench: Vector6<f64>,
    process_wrench: Vector6<f64>,
    view: View,
    digest: blake3::Hasher,
    phase: Option<usize>,
    limited: bool,
    was_limited: bool,
}

impl<'a> Run<'a> {
    fn new(setup: &SpatialSetup<'a>, mut world: SpatialWorld, q: &DVector<f64>) -> Result<Self, SimError> {
        setup.validate(&world)?;
        let mut arm = SpatialArm::insert(&mut world, setup.plant, setup.tool, setup.arm, q)?;
        let joints = setup.plant.joint_count();
        let steps_per_period = setup.engine.steps_per_period();
        let mut start = q.clone();
        setup.model.complete_positions(&mut start)?;
        let q = &start;
        let mut workspace = setup.model.workspace();
        let mut torque_nm = DVector::zeros(joints);
        // the arm has stood under the weight that its controller knows of before
        workspace.set_positions(q)?;
        workspace.gravity_into(&mut torque_nm);
        arm.preload(&torque_nm);
        Ok(Self {
            follower: follower(setup.model, setup.model.frame(TOOL_FRAME)?, q, setup.engine.control_period_s)?,
            workspace,
            sensor: WrenchSensor::new(setup.plant, arm.tool_frame(), setup.arm, q),
            state: JointState::at_rest(q.clone()),
            reference: JointReference::at_rest(q.clone()),
            torque_nm,
            jacobian: Matrix6xX::zeros(joints),
            limits_nm: setup.plant.joints().iter().map(|joint| joint.limits.effort.unwrap_or(f64::INFINITY)).collect(),
            steps_per_period,
            period_s: steps_per_period as f64 * world.time_step_s(),
            tool_wrench: Vector6::zeros(),
            process_wrench: Vector6::zeros(),
            view: View::default(),
            digest: blake3::Hasher::new(),
            phase: None,
            limited: false,
            was_limited: false,
            scene: setup.scene,
            world,
            arm,
        })
    }

    /// Torques for one control period: the controller's, and what withstands the expected wrench.
    fn control(
        &mut self,
        time_s: f64,
        controller: &mut dyn Controller,
        reference: &SpatialReference,
    ) -> Result<(), SimError> {
        self.arm.read_state(&self.world, &mut self.state);
        controller.torque(&mut self.workspace, &self.state, &self.reference, &mut self.torque_nm)?;
        if reference.expected_wrench != Vector6::zeros() {
            self.workspace.jacobian_into(self.arm.tool_frame(), &mut self.jacobian);
            let wrench = turned_into_base(self.workspace.manipulator(), &reference.expected_wrench);
            self.torque_nm.gemv_tr(-1.0, &self.jacobian, &wrench, 1.0);
        }
        check_finite("a torque of the controller, N m,", self.torque_nm.iter(), time_s)?;
        self.limited = self.arm.set_torques(&self.torque_nm, self.period_s);
        Ok(())
    }

    /// Tells the observer, and writes down what a judge needs.
    fn observe(
        &mut self,
        step: u64,
        time_s: f64,
        reference: &SpatialReference,
        process: &dyn Process,
        observer: &mut dyn Observer,
    ) -> EpisodeSample {
        self.events(time_s, reference, observer);
        self.view.look(&self.world, &self.arm, process);
        let world_from_tool = self.arm.world_from_tool(&self.world);
        let torque = self.arm.applied_torque_nm();
        observer.sample(&Sample {
            step,
            time_s,
            phase: reference.phase,
            world_from_tool,
            world_from_tool_reference: reference.world_from_tool,
            world_from_links: &self.view.world_from_links,
            q_rad: self.state.q.as_slice(),
            dq_rad_per_s: self.state.dq.as_slice(),
            q_reference_rad: self.reference.q.as_slice(),
            torque_nm: torque.as_slice(),
            tool_wrench: self.tool_wrench,
            world_from_bodies: &self.view.world_from_bodies,
            grain_centers_world: &self.view.grain_centers_world,
            grain_turns: &self.view.grain_turns,
            series: &self.view.series,
        });
        let errors = self.reference.q.iter().zip(self.state.q.iter());
        let shares = torque.iter().zip(&self.limits_nm).map(|(torque, limit)| torque.abs() / limit);
        EpisodeSample {
            time_s,
            phase: reference.phase,
            world_from_tool,
            world_from_tool_reference: reference.world_from_tool,
            tool_wrench: self.tool_wrench,
            process_wrench: self.process_wrench,
            joint_error_rad: errors.map(|(wanted, is)| (wanted - is).abs()).fold(0.0, f64::max),
            torque_share: shares.fold(0.0, f64::max),
            power_w: torque.iter().zip(self.state.dq.iter()).map(|(torque, speed)| (torque * speed).abs()).sum(),
        }
    }

    /// Tells of actions that begin and of torques at their limits.
    fn events(&mut self, time_s: f64, reference: &SpatialReference, observer: &mut dyn Observer) {
        if self.phase != Some(reference.phase) {
            self.phase = Some(reference.phase);
            let name = self.scene.phases.get(reference.phase).map_or("", String::as_str);
            let text = format!("action {} begins: {name}", reference.phase + 1);
            observer.event(&Event { time_s, level: EventLevel::Info, text });
        }
        if self.limited && !self.was_limited {
            let text = "a joint torque is at its limit".into();
            observer.event(&Event { time_s, level: EventLevel::Warning, text });
        }
        self.was_limited = self.limited;
    }

    /// One control period of physics.
    fn advance(
        &mut self,
        time_s: f64,
        reference: &SpatialReference,
        process: &mut dyn Process,
    ) -> Result<(), SimError> {
        let mut exerted = Vector6::zeros();
        for _ in 0..self.steps_per_period {
            self.arm.drive(&mut self.world);
            let mut step = Step {
                time_s: self.world.time_s(),
                time_step_s: self.world.time_step_s(),
                world: &mut self.world,
                arm: &self.arm,
                phase: reference.phase,
                world_from_tool_reference: reference.world_from_tool,
            };
            process.before_step(&mut step)?;
            step.world.step();
            process.after_step(&mut step)?;
            exerted += process.tool_wrench();
            self.arm.read_state(&self.world, &mut self.state);
            let coordinates = self.state.q.iter().chain(self.state.dq.iter());
            check_finite("a coordinate of the arm", coordinates.clone(), time_s)?;
            coordinates.for_each(|value| {
                self.digest.update(&value.to_bits().to_le_bytes());
            });
            process.digest(&self.world, &mut self.digest);
        }
        self.process_wrench = exerted / self.steps_per_period as f64;
        self.tool_wrench = self.sensor.read(&self.state, self.arm.applied_torque_nm(), self.period_s)?;
        Ok(())
    }
}

fn check_finite<'v>(quantity: &str, mut values: impl Iterator<Item = &'v f64>, time_s: f64) -> Result<(), SimError> {
    match values.find(|value| !value.is_finite()) {
        Some(&value) => Err(SimError::Diverged { quantity: quantity.into(), value, time_s }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controllers::{Impedance, ImpedanceConfig};
    use crate::spatial::{NoProcess, arm_with_tool, standard_gravity};

    #[test]
    fn a_run_of_more_samples_than_memory_holds_is_refused_and_does_not_abort() {
        let arm = Manipulator::from_urdf_str(include_str!("../../../../assets/robots/panda.urdf")).expect("valid");
        let (tool, gravity) = (HeldTool::none(), standard_gravity());
        let plant = arm_with_tool(&arm, "panda_hand_tcp", &tool, &nalgebra::Isometry3::identity(), &gravity, &[])
            .expect("an arm");
        let engine = EngineConfig { time_step_s: 1e-6, control_period_s: 1e-6, ..EngineConfig::default() };
        let (motors, scene) = (ArmConfig::default(), SceneDescription::default());
        let setup = SpatialSetup {
            plant: &plant,
            model: &plant,
            tool: &tool,
            arm: &motors,
            scene: &scene,
            engine: &engine,
            settle_s: 0.0,
            longest_s: 3600.0,
        };
        let world = SpatialWorld::new(&engine, &gravity).expect("valid");
        let mut source =
            |_: f64, world_from_tool: &nalgebra::Isometry3<f64>| SpatialReference::at_rest(*world_from_tool);
        let mut controller = Impedance::new(&ImpedanceConfig::paper(), 7).expect("valid");
        let q = DVector::from_column_slice(&[0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8]);
        let run = simulate(&setup, world, &q, &mut source, &mut controller, &mut NoProcess, &mut ());
        let Err(SimError::Field(error)) = run else { panic!("expected a refusal") };
        assert_eq!(error.field, "engine.control_period_s");
    }
}
