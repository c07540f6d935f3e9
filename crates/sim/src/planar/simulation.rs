//! The control loop: camera, reference, inverse kinematics, controller, engine, once per control period.

use nalgebra::{DVector, Isometry2, Isometry3, Point2, Vector6};
use robot::{
    DifferentialKinematics, FrameMotion, InverseKinematics, InverseKinematicsOptions, JointReference, JointState,
    Manipulator, RobotError, TaskRows,
};
use skills::plan::{Plan, PlanarMotion};
use skills::tool::Tool;

use super::arm::{PlanarArm, spatial};
use super::config::{EngineConfig, MapBounds, ObjectConfig, WorldConfig};
use super::contact::{ContactForce, Party};
use super::episode::{Episode, EpisodeSample};
use super::observer::{Event, EventLevel, Observer, Sample, SceneDescription};
use super::reference::{ReferenceSource, ToolReference};
use super::world::PlanarWorld;
use crate::controllers::Controller;
use crate::error::SimError;
use crate::sensing::Camera;

/// Everything that a planar run is made of.
pub struct PlanarSetup<'a> {
    /// The table.
    pub world: &'a WorldConfig,
    /// The object.
    pub object: &'a ObjectConfig,
    /// Where the object starts.
    pub world_from_object: Isometry2<f64>,
    /// The tool.
    pub tool: &'a Tool,
    /// Model of arm and tool: see [`super::arm_with_tool`].
    pub model: &'a Manipulator,
    /// Frame of the arm that holds the tool.
    pub flange: &'a str,
    /// Time step and contact solver.
    pub engine: &'a EngineConfig,
    /// What onlookers are told of the scene.
    pub scene: &'a SceneDescription,
    /// Time after the plan's end in which things come to rest, s.
    pub settle_s: f64,
    /// Simulated time at which the run is broken off, s.
    pub longest_s: f64,
}

/// Time between two looks at a plan's reach, s.
const REACH_CHECK_S: f64 = 0.02;
/// A contact gap shorter than this is not worth an event, s.
const GAP_S: f64 = 0.020;

/// Checks that the arm reaches every tool pose of a plan; returns its posture at the start.
///
/// # Errors
/// [`SimError::Unreachable`] with the time, the pose and the joint at fault.
pub fn check_reach(plan: &Plan, model: &Manipulator, flange: &str) -> Result<DVector<f64>, SimError> {
    let frame = model.frame(flange)?;
    let unreachable = |error: RobotError, time_s: f64| SimError::Unreachable { reason: error.to_string(), time_s };
    let mut solver = InverseKinematics::new(model, frame, TaskRows::PlanarPose, InverseKinematicsOptions::default())?;
    let first = plan.actions().first().map(|action| action.tool.start()).unwrap_or_default();
    let middle =
        DVector::from_iterator(model.joint_count(), model.joints().iter().map(|joint| joint.limits.clamp(0.0)));
    let start = solver.solve(&in_base(model, &first.pose()), &middle).map_err(|error| unreachable(error, 0.0))?.q;
    let mut follower = DifferentialKinematics::new(model, frame, TaskRows::PlanarPose)?;
    let mut reference = JointReference::at_rest(start.clone());
    let looks = (plan.duration_s() / REACH_CHECK_S).ceil() as usize;
    for look in 0..=looks {
        let time_s = look as f64 * REACH_CHECK_S;
        let (index, local_s) = plan.due_at(time_s);
        let motion = plan.actions().get(index).map(|action| action.tool.at(local_s)).unwrap_or_default();
        follower.follow(&frame_motion(model, &motion), &mut reference).map_err(|error| unreachable(error, time_s))?;
        check_speeds(model, &reference, time_s)?;
    }
    Ok(start)
}

/// Checks that no joint must turn faster than its limit.
fn check_speeds(model: &Manipulator, reference: &JointReference, time_s: f64) -> Result<(), SimError> {
    for (joint, speed) in model.joints().iter().zip(reference.dq.iter()) {
        if let Some(limit) = joint.limits.velocity.filter(|limit| speed.abs() > *limit) {
            let reason = format!(
                "follow plan: joint `{}` would have to turn at {:.2} rad/s; expected at most {limit} rad/s; slow the task down",
                joint.name,
                speed.abs()
            );
            return Err(SimError::Unreachable { reason, time_s });
        }
    }
    Ok(())
}

pub(super) fn in_base(model: &Manipulator, world_from_tool: &Isometry2<f64>) -> Isometry3<f64> {
    model.world_from_base().inv_mul(&spatial(world_from_tool))
}

fn frame_motion(model: &Manipulator, motion: &PlanarMotion) -> FrameMotion {
    let turn = model.world_from_base().rotation.inverse();
    let lift = |v: &nalgebra::Vector3<f64>| {
        let linear = turn * nalgebra::Vector3::new(v.x, v.y, 0.0);
        Vector6::new(linear.x, linear.y, linear.z, 0.0, 0.0, v.z)
    };
    FrameMotion {
        base_from_frame: in_base(model, &motion.pose()),
        velocity: lift(&motion.velocity),
        acceleration: lift(&motion.acceleration),
    }
}

/// Carries out a reference in the physics with the arm at posture `q` first.
///
/// A reference that the arm cannot follow ends the run early: the episode says so.
///
/// # Errors
/// A [`SimError`] if the scene is invalid or the state diverges.
pub fn simulate(
    setup: &PlanarSetup<'_>,
    q: &DVector<f64>,
    source: &mut dyn ReferenceSource,
    controller: &mut dyn Controller,
    camera: &mut Camera,
    observer: &mut dyn Observer,
) -> Result<Episode, SimError> {
    let mut run = Run::new(setup, q)?;
    observer.begin(setup.scene);
    let period_s = run.period_s;
    let periods = (setup.longest_s / period_s).ceil() as usize;
    let mut samples = Vec::with_capacity(periods);
    let mut finished_s = None;
    let mut interruption = None;
    for period in 0..periods {
        let time_s = period as f64 * period_s;
        let world_from_object = run.world.world_from_object();
        let sighting = camera.look(time_s, &world_from_object);
        let world_from_tool = run.arm.world_from_tool(&run.world);
        let reference = source.next(time_s, &world_from_tool, sighting.as_ref());
        if let Err(error) = run.follower.follow(&frame_motion(setup.model, &reference.tool), &mut run.reference) {
            interruption = Some(format!("the arm could not follow its reference at {time_s:.3} s: {error}"));
            observer.event(&Event { time_s, level: EventLevel::Error, text: error.to_string() });
            break;
        }
        run.control(controller)?;
        let seen = sighting.map(|sighting| sighting.world_from_object);
        samples.push(run.observe(period as u64, time_s, &reference, seen, observer));
        run.advance(time_s)?;
        if reference.finished {
            let end = *finished_s.get_or_insert(time_s);
            if time_s - end >= setup.settle_s {
                break;
            }
        }
    }
    if finished_s.is_none() && interruption.is_none() {
        interruption = Some(format!("the plan was not carried out within {:.1} s", setup.longest_s));
    }
    Ok(Episode {
        samples,
        control_period_s: period_s,
        finished: finished_s.is_some(),
        interruption,
        digest: run.digest.finalize().to_hex().to_string(),
    })
}

/// Mutable state of a run.
struct Run<'a> {
    world: PlanarWorld,
    arm: PlanarArm,
    follower: DifferentialKinematics,
    workspace: robot::Workspace,
    state: JointState,
    reference: JointReference,
    torque_nm: DVector<f64>,
    limits_nm: Vec<f64>,
    joint_points: Vec<Point2<f64>>,
    steps_per_period: usize,
    period_s: f64,
    map: &'a MapBounds,
    digest: blake3::Hasher,
    phases: &'a [String],
    phase: Option<usize>,
    limited: bool,
    was_limited: bool,
    /// Whether something touched an obstacle in the last control period.
    hit_obstacle: bool,
    gave_up: bool,
    renewed_hold: bool,
    last_touch_s: Option<f64>,
    lost_contact: bool,
}

impl<'a> Run<'a> {
    fn new(setup: &PlanarSetup<'a>, q: &DVector<f64>) -> Result<Self, SimError> {
        let mut world = PlanarWorld::new(setup.world, setup.object, setup.engine, &setup.world_from_object)?;
        let arm = PlanarArm::insert(&mut world, setup.model, setup.flange, setup.tool, q)?;
        let joints = setup.model.joint_count();
        let steps_per_period = setup.engine.steps_per_period();
        Ok(Self {
            follower: DifferentialKinematics::new(setup.model, arm.flange(), TaskRows::PlanarPose)?,
            workspace: setup.model.workspace(),
            state: JointState::at_rest(q.clone()),
            reference: JointReference::at_rest(q.clone()),
            torque_nm: DVector::zeros(joints),
            limits_nm: setup.model.joints().iter().map(|joint| joint.limits.effort.unwrap_or(f64::INFINITY)).collect(),
            joint_points: Vec::with_capacity(joints + 1),
            steps_per_period,
            period_s: steps_per_period as f64 * world.time_step_s(),
            map: &setup.world.map,
            digest: blake3::Hasher::new(),
            phases: &setup.scene.phases,
            phase: None,
            limited: false,
            was_limited: false,
            hit_obstacle: false,
            gave_up: false,
            renewed_hold: false,
            last_touch_s: None,
            lost_contact: false,
            world,
            arm,
        })
    }

    fn control(&mut self, controller: &mut dyn Controller) -> Result<(), SimError> {
        self.arm.read_state(&self.world, &mut self.state);
        controller.torque(&mut self.workspace, &self.state, &self.reference, &mut self.torque_nm)?;
        self.limited = self.arm.apply_torques(&mut self.world, &self.torque_nm);
        Ok(())
    }

    /// Tells the observer, and writes down what a judge needs.
    fn observe(
        &mut self,
        step: u64,
        time_s: f64,
        reference: &ToolReference,
        seen: Option<Isometry2<f64>>,
        observer: &mut dyn Observer,
    ) -> EpisodeSample {
        self.arm.joint_points(&self.world, &mut self.joint_points);
        let world_from_tool = self.arm.world_from_tool(&self.world);
        self.events(time_s, reference, observer);
        let torque = self.arm.applied_torque_nm();
        observer.sample(&Sample {
            step,
            time_s,
            phase: reference.phase,
            world_from_tool,
            world_from_tool_reference: reference.tool.pose(),
            world_from_object: self.world.world_from_object(),
            world_from_object_expected: reference.world_from_object_expected,
            world_from_object_seen: seen,
            object_believed_world: reference.object_believed_world,
            q_rad: self.state.q.as_slice(),
            dq_rad_per_s: self.state.dq.as_slice(),
            q_reference_rad: self.reference.q.as_slice(),
            torque_nm: torque.as_slice(),
            joint_points_world: &self.joint_points,
            contacts: self.world.contacts(),
        });
        let contacts = self.world.contacts();
        let on_object = contacts.iter().filter(|contact| contact.force_on_n(Party::Object, Party::Tool).is_some());
        let errors = self.reference.q.iter().zip(self.state.q.iter());
        let shares = torque.iter().zip(&self.limits_nm).map(|(torque, limit)| torque.abs() / limit);
        EpisodeSample {
            time_s,
            phase: reference.phase,
            world_from_tool,
            world_from_tool_reference: reference.tool.pose(),
            world_from_object: self.world.world_from_object(),
            world_from_object_expected: reference.world_from_object_expected,
            renews_hold: reference.renews_hold,
            tool_force_n: self.world.force_on_object_n(Party::Tool).norm(),
            slip_m_per_s: on_object.map(|contact| contact.slip_m_per_s.abs()).fold(0.0, f64::max),
            hits_obstacle: self.hit_obstacle,
            joint_error_rad: errors.map(|(wanted, is)| (wanted - is).abs()).fold(0.0, f64::max),
            torque_share: shares.fold(0.0, f64::max),
            power_w: torque.iter().zip(self.state.dq.iter()).map(|(torque, speed)| (torque * speed).abs()).sum(),
        }
    }

    /// Tells of actions that begin, of contacts that are made and lost, of torques at their limits.
    fn events(&mut self, time_s: f64, reference: &ToolReference, observer: &mut dyn Observer) {
        let mut tell = |level: EventLevel, text: String| observer.event(&Event { time_s, level, text });
        if self.phase != Some(reference.phase) {
            self.phase = Some(reference.phase);
            let name = self.phases.get(reference.phase).map_or("", String::as_str);
            tell(EventLevel::Info, format!("action {} begins: {name}", reference.phase + 1));
        }
        if self.limited && !self.was_limited {
            tell(EventLevel::Warning, "a joint torque is at its limit".into());
        }
        self.was_limited = self.limited;
        if reference.gives_up && !self.gave_up {
            tell(EventLevel::Warning, "the push has run out of time and is given up".into());
        }
        self.gave_up = reference.gives_up;
        if reference.renews_hold && !self.renewed_hold {
            tell(EventLevel::Info, "the hold is renewed: the object is to be held elsewhere on the surface".into());
        }
        self.renewed_hold = reference.renews_hold;
        let touches =
            self.world.contacts().iter().any(|contact| contact.force_on_n(Party::Object, Party::Tool).is_some());
        match self.last_touch_s {
            _ if touches => {
                if self.last_touch_s.is_none() || self.lost_contact {
                    tell(EventLevel::Info, "the tool touches the object".into());
                }
                self.last_touch_s = Some(time_s);
                self.lost_contact = false;
            }
            Some(last) if !self.lost_contact && time_s - last > GAP_S => {
                self.lost_contact = true;
                let level = if reference.is_pushing { EventLevel::Warning } else { EventLevel::Info };
                tell(level, "the tool has left the object".into());
            }
            _ => {}
        }
    }

    /// One control period of physics.
    fn advance(&mut self, time_s: f64) -> Result<(), SimError> {
        self.hit_obstacle = false;
        for _ in 0..self.steps_per_period {
            self.world.step();
            self.hit_obstacle |= self.world.contacts().iter().any(ContactForce::involves_obstacle);
            self.arm.read_state(&self.world, &mut self.state);
            let (pose, twist) = (self.world.world_from_object(), self.world.object_twist());
            let object =
                [pose.translation.x, pose.translation.y, pose.rotation.re, pose.rotation.im, twist.x, twist.y, twist.z];
            for value in object.iter().chain(self.state.q.iter()).chain(self.state.dq.iter()) {
                self.digest.update(&value.to_bits().to_le_bytes());
                if !value.is_finite() {
                    let quantity = "a coordinate of the state".into();
                    return Err(SimError::Diverged { quantity, value: *value, time_s });
                }
            }
        }
        let beyond_m = -self.map.margin_m(&Point2::from(self.world.world_from_object().translation.vector));
        if beyond_m > self.map.size_m() {
            return Err(SimError::Diverged {
                quantity: "the object's way beyond the map, m,".into(),
                value: beyond_m,
                time_s,
            });
        }
        Ok(())
    }
}
