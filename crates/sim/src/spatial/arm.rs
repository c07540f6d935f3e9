//! An arm in the engine: a multibody of turning and sliding joints, driven by torques, with the tool in its hand.
//!
//! One constant model builds the multibody and serves the controller, so that the two cannot disagree unless a scenario
//! says so. Motors act as pairs of torques on neighboring links: exactly Jᵀ, so that contacts, motors and the arm's inertia
//! are solved together.

use nalgebra::{DMatrix, DVector, Isometry3, Point3, Vector3, Vector6};
use rapier3d::prelude::*;
use robot::{FrameId, JointState, Manipulator};

use super::arm_config::ArmConfig;
use super::convert;
use super::multibody::{coordinate, engine_coupling, engine_joint, link_body};
use super::reach::check_posture;
use super::tool::{HeldTool, TOOL_FRAME};
use super::world::SpatialWorld;
use crate::error::SimError;

/// Rounding of gravity turned into the base's axes and back, m/s².
const GRAVITY_ROUNDING_M_PER_S2: f64 = 1e-9;

/// An arm in a spatial world.
pub struct SpatialArm {
    model: Manipulator,
    base: RigidBodyHandle,
    joints: Vec<ArmJoint>,
    tip: MultibodyJointHandle,
    /// Index of the joint whose body holds the tool.
    carrier: usize,
    tool: FrameId,
    body_from_tool: Isometry3<f64>,
    tool_colliders: Vec<ColliderHandle>,
    rate_limit_nm_per_s: f64,
    applied_nm: DVector<f64>,
}

struct ArmJoint {
    body: RigidBodyHandle,
    rotates: bool,
    axis: Vector3<f64>,
    effort_limit: f64,
    parent: Option<usize>,
}

impl SpatialArm {
    /// Builds the arm in `world` at posture `q`, with the tool's pieces on the body that holds it. The model comes from
    /// [`super::arm_with_tool`].
    ///
    /// # Errors
    /// [`SimError::Arm`] if no joint carries the tool, a joint moves no mass, or the model's gravity is not the world's;
    /// [`SimError::Field`] for numbers that cannot be used; [`SimError::Robot`] if the model has no tool.
    pub fn insert(
        world: &mut SpatialWorld,
        model: &Manipulator,
        tool: &HeldTool,
        config: &ArmConfig,
        q: &DVector<f64>,
    ) -> Result<Self, SimError> {
        config.validate(model.joint_count())?;
        check_posture("q", model, q)?;
        check_dynamics(model, q, world)?;
        let frame = model.frame(TOOL_FRAME)?;
        let (carrier, body_from_tool) = model.frame_attachment(frame);
        let physics = &mut world.physics;
        let base = physics.insert_body(RigidBodyBuilder::fixed().pose(convert::pose(model.world_from_base())));
        let mut joints: Vec<ArmJoint> = Vec::with_capacity(model.joint_count());
        let mut tip = None;
        for joint in model.joints() {
            let parent = joint.parent.and_then(|parent| joints.get(parent)).map_or(base, |parent| parent.body);
            let body = physics.insert_body(link_body(joint));
            tip = physics.insert_multibody_joint(parent, body, engine_joint(joint));
            joints.push(ArmJoint {
                body,
                rotates: joint.kind.rotates(),
                axis: joint.axis.into_inner(),
                effort_limit: joint.limits.effort.filter(|_| !config.ideal_motors).unwrap_or(f64::INFINITY),
                parent: joint.parent,
            });
        }
        let (Some(tip), Some(carrier)) = (tip, carrier) else {
            return Err(SimError::Arm {
                reason: "the tool's frame does not move; mount the tool behind a joint".into(),
            });
        };
        let mut arm = Self {
            model: model.clone(),
            base,
            applied_nm: DVector::zeros(joints.len()),
            joints,
            tip,
            carrier,
            tool: frame,
            body_from_tool,
            tool_colliders: Vec::with_capacity(tool.pieces.len()),
            rate_limit_nm_per_s: config.torque_rate_limit_nm_per_s.unwrap_or(f64::INFINITY),
        };
        arm.prepare(world, config, q);
        arm.attach(world, tool);
        Ok(arm)
    }

    /// Removes the engine's own damping, adds rotor inertia and friction, and takes the posture `q`.
    fn prepare(&self, world: &mut SpatialWorld, config: &ArmConfig, q: &DVector<f64>) {
        let physics = &mut world.physics;
        for joint in &self.joints {
            if let Some(body) = physics.bodies.get_mut(joint.body) {
                body.recompute_mass_properties_from_colliders(&physics.colliders);
            }
        }
        let Some((multibody, _)) = physics.multibody_joints.get_mut(self.tip) else { return };
        multibody.set_self_contacts_enabled(false);
        // only now does the engine know that the base is fixed, and the vectors below have one entry per joint
        multibody.forward_kinematics(&physics.bodies, true);
        for index in 0..self.joints.len() {
            let friction = config.friction_of(index);
            multibody.damping_mut()[index] = friction.viscous_nm_s_per_rad;
            multibody.frictions_mut()[index] = friction.coulomb_nm;
        }
        for (inertia, joint) in multibody.armature_mut().iter_mut().zip(self.model.joints()) {
            *inertia = joint.rotor_inertia;
        }
        for coupling in self.model.couplings() {
            let rotates = |joint: usize| self.joints.get(joint).is_none_or(|joint| joint.rotates);
            multibody.add_dof_coupling(engine_coupling(&coupling, rotates));
        }
        let mut start = q.clone();
        // the length was checked when the arm was inserted
        let _ = self.model.complete_positions(&mut start);
        multibody.apply_displacements(start.as_slice());
        multibody.forward_kinematics(&physics.bodies, false);
        multibody.update_rigid_bodies(&mut physics.bodies, true);
    }

    /// Gives the hand the tool's pieces as its colliders; their mass is in the model already.
    fn attach(&mut self, world: &mut SpatialWorld, tool: &HeldTool) {
        let Some(hand) = self.joints.get(self.carrier).map(|joint| joint.body) else { return };
        for piece in &tool.pieces {
            let collider = ColliderBuilder::new(piece.shape.clone())
                .density(0.0)
                .position(convert::pose(&(self.body_from_tool * piece.tool_from_piece)))
                .friction(piece.friction);
            self.tool_colliders.push(world.physics.insert_collider(collider, Some(hand)));
        }
    }

    /// The constant model of arm and tool.
    #[must_use]
    pub fn model(&self) -> &Manipulator {
        &self.model
    }

    /// The tool's frame in the model.
    #[must_use]
    pub fn tool_frame(&self) -> FrameId {
        self.tool
    }

    /// The engine's body that holds the tool.
    #[must_use]
    pub fn hand_body(&self) -> RigidBodyHandle {
        self.joints.get(self.carrier).map_or(self.base, |joint| joint.body)
    }

    /// Pose of the tool's frame in the body that holds it.
    #[must_use]
    pub fn hand_from_tool(&self) -> &Isometry3<f64> {
        &self.body_from_tool
    }

    /// The tool's colliders, in the order of its pieces.
    #[must_use]
    pub fn tool_colliders(&self) -> &[ColliderHandle] {
        &self.tool_colliders
    }

    /// Reads joint positions and velocities.
    pub fn read_state(&self, world: &SpatialWorld, state: &mut JointState) {
        let Some((multibody, _)) = world.physics.multibody_joints.get(self.tip) else { return };
        let velocities = multibody.generalized_velocity();
        for (index, (joint, link)) in self.joints.iter().zip(multibody.links().skip(1)).enumerate() {
            state.q[index] = link.joint().coords()[coordinate(joint.rotates)];
            state.dq[index] = velocities[index];
        }
    }

    /// Sets the motors' torques, each limited to what its motor can give and to how fast it can change within
    /// `period_s`; they act from the next [`SpatialArm::drive`] on. Returns whether any was limited. A torque that is not
    /// finite is handed on, so that the state shows it after the next step.
    pub fn set_torques(&mut self, torque_nm: &DVector<f64>, period_s: f64) -> bool {
        let mut limited = false;
        let largest_change = self.rate_limit_nm_per_s * period_s;
        for (index, joint) in self.joints.iter().enumerate() {
            let wanted = torque_nm[index];
            let change = (wanted - self.applied_nm[index]).clamp(-largest_change, largest_change);
            // an unlimited change is taken as it is, without the rounding of a difference and a sum
            let reached = if change.abs() < largest_change { wanted } else { self.applied_nm[index] + change };
            let given = reached.clamp(-joint.effort_limit, joint.effort_limit);
            limited |= given != wanted;
            self.applied_nm[index] = given;
        }
        limited
    }

    /// Starts the motors with these torques, whatever their rate limit: the arm stands still under them.
    pub fn preload(&mut self, torque_nm: &DVector<f64>) {
        for (index, joint) in self.joints.iter().enumerate() {
            self.applied_nm[index] = torque_nm[index].clamp(-joint.effort_limit, joint.effort_limit);
        }
    }

    /// Clears all forces on the arm and lets the motors act during the next step of the engine. A motor drives its link and,
    /// with the opposite torque, the link that carries it.
    pub fn drive(&self, world: &mut SpatialWorld) {
        for joint in &self.joints {
            if let Some(body) = world.physics.bodies.get_mut(joint.body) {
                body.reset_forces(false);
                body.reset_torques(false);
            }
        }
        for (index, joint) in self.joints.iter().enumerate() {
            let Some(body) = world.physics.bodies.get_mut(joint.body) else { continue };
            let effort = self.applied_nm[index];
            let (pose, axis) = (*body.position(), convert::vector(&joint.axis));
            let along = pose.rotation * axis * effort;
            let at = pose.translation;
            act(body, joint.rotates, along, at);
            let carrier = joint.parent.and_then(|parent| self.joints.get(parent));
            if let Some(carrier) = carrier.and_then(|carrier| world.physics.bodies.get_mut(carrier.body)) {
                act(carrier, joint.rotates, -along, at);
            }
        }
    }

    /// Adds a force (N) at a point of the tool, world frame, for the next step of the engine.
    pub fn push_tool(&self, world: &mut SpatialWorld, force_world_n: &Vector3<f64>, at_world: &Point3<f64>) {
        if let Some(body) = world.physics.bodies.get_mut(self.hand_body()) {
            body.add_force_at_point(convert::vector(force_world_n), convert::point(at_world), true);
        }
    }

    /// Adds a wrench to the tool for the next step of the engine: force (N, rows 0–2), moment about the tool's origin (N m,
    /// rows 3–5), world axes.
    pub fn load_tool(&self, world: &mut SpatialWorld, wrench_world: &Vector6<f64>) {
        let at = Point3::from(self.world_from_tool(world).translation.vector);
        self.push_tool(world, &wrench_world.fixed_rows::<3>(0).into_owned(), &at);
        if let Some(body) = world.physics.bodies.get_mut(self.hand_body()) {
            body.add_torque(convert::vector(&wrench_world.fixed_rows::<3>(3).into_owned()), true);
        }
    }

    /// Torques that the motors give, N m (N).
    #[must_use]
    pub fn applied_torque_nm(&self) -> &DVector<f64> {
        &self.applied_nm
    }

    /// Pose of the tool in the world.
    #[must_use]
    pub fn world_from_tool(&self, world: &SpatialWorld) -> Isometry3<f64> {
        let body = world.physics.bodies.get(self.hand_body());
        body.map(|body| convert::isometry(body.position()) * self.body_from_tool).unwrap_or_default()
    }

    /// Velocity of the tool's origin (m/s, rows 0–2) and angular velocity (rad/s, rows 3–5), world axes.
    #[must_use]
    pub fn tool_velocity(&self, world: &SpatialWorld) -> Vector6<f64> {
        let Some((multibody, _)) = world.physics.multibody_joints.get(self.tip) else { return Vector6::zeros() };
        // summed over the joints, because the engine's bodies keep the velocities that they had before the step
        let speeds = multibody.generalized_velocity();
        let tool = self.world_from_tool(world).translation.vector;
        let (mut linear, mut angular) = (Vector3::zeros(), Vector3::zeros());
        let mut ancestor = Some(self.carrier);
        while let Some((index, joint)) = ancestor.and_then(|index| Some((index, self.joints.get(index)?))) {
            if let Some(body) = world.physics.bodies.get(joint.body) {
                let pose = convert::isometry(body.position());
                let motion = pose.rotation * joint.axis * speeds[index];
                if joint.rotates {
                    angular += motion;
                    linear += motion.cross(&(tool - pose.translation.vector));
                } else {
                    linear += motion;
                }
            }
            ancestor = joint.parent;
        }
        Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
    }

    /// Writes the poses of the base and of each joint's body, world frame.
    pub fn link_poses(&self, world: &SpatialWorld, poses: &mut Vec<Isometry3<f64>>) {
        poses.clear();
        let bodies = std::iter::once(self.base).chain(self.joints.iter().map(|joint| joint.body));
        poses.extend(bodies.filter_map(|body| Some(convert::isometry(world.physics.bodies.get(body)?.position()))));
    }
}

/// Checks that every joint moves mass in posture `q`, and that model and world agree on gravity.
fn check_dynamics(model: &Manipulator, q: &DVector<f64>, world: &SpatialWorld) -> Result<(), SimError> {
    let mut workspace = model.workspace();
    let mut mass = DMatrix::zeros(q.len(), q.len());
    workspace.set_positions(q)?;
    workspace.mass_matrix_into(&mut mass);
    if mass.cholesky().is_none() {
        let reason = "the mass matrix is not positive definite: some joint moves neither mass nor rotor; \
                      give its link an inertial element, or the joint a rotor inertia";
        return Err(SimError::Arm { reason: reason.into() });
    }
    let modeled = model.world_from_base().rotation * model.gravity_in_base();
    let simulated = convert::to_vector(world.physics.gravity);
    if (modeled - simulated).norm() > GRAVITY_ROUNDING_M_PER_S2 {
        let reason = format!(
            "gravity is {:?} m/s² in the arm's model and {:?} m/s² in its world; expected one gravity; mount the model with the world's",
            modeled.as_slice(),
            simulated.as_slice()
        );
        return Err(SimError::Arm { reason });
    }
    Ok(())
}

/// A motor's torque, or the force of a sliding joint's motor, on one of its two links.
fn act(body: &mut RigidBody, rotates: bool, along: Vector, at: Vector) {
    if rotates {
        body.add_torque(along, false);
    } else {
        body.add_force_at_point(along, at, false);
    }
}
