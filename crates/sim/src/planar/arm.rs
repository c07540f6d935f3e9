//! A planar arm in the engine: a multibody of revolute joints, driven by torques, with the tool in its hand.
//!
//! The same constant model feeds the engine and the controller, so that they cannot disagree unless a scenario says so.

use nalgebra::{DVector, Isometry2, Isometry3, Point2, Vector2, Vector3};
use rapier2d::prelude::*;
use robot::{FrameId, JointKind, JointState, Manipulator};
use skills::tool::Tool;

use super::convert;
use super::world::PlanarWorld;
use crate::error::SimError;

/// How far a joint axis or a mounting may lean out of the plane: rounding of a file's numbers, rad.
const PLANARITY: f64 = 1e-6;

/// A planar arm in a planar world.
pub struct PlanarArm {
    model: Manipulator,
    joints: Vec<ArmJoint>,
    tip: MultibodyJointHandle,
    /// Index of the joint whose body holds the tool.
    carrier: usize,
    flange: FrameId,
    body_from_flange: Isometry2<f64>,
    applied_nm: DVector<f64>,
}

struct ArmJoint {
    body: RigidBodyHandle,
    /// +1 if the joint turns counterclockwise seen from above.
    sense: f64,
    torque_limit_nm: f64,
}

/// Model of an arm that carries a tool, for controllers and for [`PlanarArm::insert`].
///
/// The tool becomes part of the body that holds the frame `flange`; gravity points into the table.
///
/// # Errors
/// [`SimError::Robot`] if the frame is unknown or the rotor inertias do not fit the arm, [`SimError::Arm`] if a joint
/// moves out of the plane.
pub fn arm_with_tool(
    arm: &Manipulator,
    flange: &str,
    tool: &Tool,
    world_from_base: &Isometry2<f64>,
    gravity_m_per_s2: f64,
    rotor_inertia_kg_m2: &[f64],
) -> Result<Manipulator, SimError> {
    let center = tool.centroid();
    let inertia = tool.inertia_kg_m2();
    // a flat plate: the moment about its normal is the sum of those in its plane
    let inertia = nalgebra::Matrix3::from_diagonal(&Vector3::new(inertia / 2.0, inertia / 2.0, inertia));
    let mut model =
        arm.attach_payload(arm.frame(flange)?, tool.mass_kg, Vector3::new(center.x, center.y, 0.0), inertia)?;
    model.mount(spatial(world_from_base), Vector3::new(0.0, 0.0, -gravity_m_per_s2));
    if !rotor_inertia_kg_m2.is_empty() {
        model.set_rotor_inertia(rotor_inertia_kg_m2)?;
    }
    check_planar(&model)?;
    Ok(model)
}

/// A plane pose in space: rotation about z.
#[must_use]
pub fn spatial(pose: &Isometry2<f64>) -> Isometry3<f64> {
    let translation = Vector3::new(pose.translation.x, pose.translation.y, 0.0);
    Isometry3::new(translation, Vector3::z() * pose.rotation.angle())
}

fn planar(pose: &Isometry3<f64>) -> Isometry2<f64> {
    Isometry2::new(pose.translation.vector.xy(), pose.rotation.scaled_axis().z)
}

fn leans(pose: &Isometry3<f64>) -> bool {
    pose.rotation.scaled_axis().xy().norm() > PLANARITY
}

impl PlanarArm {
    /// Builds the arm in `world` at posture `q`, with the tool's outline on the body that holds `flange`.
    ///
    /// # Errors
    /// [`SimError::Arm`] if a joint cannot move in the plane.
    pub fn insert(
        world: &mut PlanarWorld,
        model: &Manipulator,
        flange: &str,
        tool: &Tool,
        q: &DVector<f64>,
    ) -> Result<Self, SimError> {
        let flange = model.frame(flange)?;
        let (carrier, body_from_flange) = model.frame_attachment(flange);
        let world_from_base = planar(model.world_from_base());
        let physics = &mut world.physics;
        let base = physics.insert_body(RigidBodyBuilder::fixed().pose(convert::pose(&world_from_base)));
        let mut joints: Vec<ArmJoint> = Vec::new();
        let mut tip = None;
        for joint in model.joints() {
            let parent = joint.parent.and_then(|parent| joints.get(parent)).map_or(base, |parent| parent.body);
            let center = convert::vector(&joint.body.center_of_mass_m.xy());
            let properties = MassProperties::new(center, joint.body.mass_kg, joint.body.inertia_kg_m2.m33);
            let body = RigidBodyBuilder::dynamic().additional_mass_properties(properties).can_sleep(false);
            let body = physics.insert_body(body);
            let data = GenericJointBuilder::new(JointAxesMask::LOCKED_REVOLUTE_AXES)
                .contacts_enabled(false)
                .local_frame1(convert::pose(&planar(&joint.parent_from_joint)))
                .local_frame2(Pose::IDENTITY);
            tip = physics.insert_multibody_joint(parent, body, data);
            let torque_limit_nm = joint.limits.effort.unwrap_or(f64::INFINITY);
            joints.push(ArmJoint { body, sense: joint.axis.z.signum(), torque_limit_nm });
        }
        let (Some(tip), Some(carrier)) = (tip, carrier) else {
            return Err(SimError::Arm {
                reason: "the tool's frame does not move; mount the tool behind a joint".into(),
            });
        };
        let body_from_flange = planar(&body_from_flange);
        let arm = Self {
            model: model.clone(),
            applied_nm: DVector::zeros(joints.len()),
            joints,
            tip,
            carrier,
            flange,
            body_from_flange,
        };
        arm.prepare(world, q);
        if let Some(hand) = arm.joints.get(carrier) {
            world.attach_tool(hand.body, tool, &body_from_flange);
        }
        Ok(arm)
    }

    /// Removes the engine's own damping, adds rotor inertia and takes the posture `q`.
    fn prepare(&self, world: &mut PlanarWorld, q: &DVector<f64>) {
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
        multibody.damping_mut().fill(0.0);
        for (inertia, joint) in multibody.armature_mut().iter_mut().zip(self.model.joints()) {
            *inertia = joint.rotor_inertia;
        }
        let displacement: Vec<f64> = self.joints.iter().zip(q.iter()).map(|(joint, q)| joint.sense * q).collect();
        multibody.apply_displacements(&displacement);
        multibody.forward_kinematics(&physics.bodies, false);
        multibody.update_rigid_bodies(&mut physics.bodies, true);
    }

    /// The constant model of arm and tool.
    #[must_use]
    pub fn model(&self) -> &Manipulator {
        &self.model
    }

    /// The frame that grips the tool.
    #[must_use]
    pub fn flange(&self) -> FrameId {
        self.flange
    }

    /// Reads joint positions and velocities.
    pub fn read_state(&self, world: &PlanarWorld, state: &mut JointState) {
        let Some((multibody, _)) = world.physics.multibody_joints.get(self.tip) else { return };
        let velocities = multibody.generalized_velocity();
        let links = multibody.links().skip(1);
        for (index, (joint, link)) in self.joints.iter().zip(links).enumerate() {
            state.q[index] = joint.sense * link.joint().coords()[2];
            state.dq[index] = joint.sense * velocities[index];
        }
    }

    /// Applies joint torques, each limited to what its motor can give, until they are changed; returns whether any was.
    pub fn apply_torques(&mut self, world: &mut PlanarWorld, torque_nm: &DVector<f64>) -> bool {
        let mut limited = false;
        for (index, joint) in self.joints.iter().enumerate() {
            let limit = joint.torque_limit_nm;
            self.applied_nm[index] = torque_nm[index].clamp(-limit, limit);
            limited |= torque_nm[index].abs() > limit;
        }
        // a motor turns its link and, with the opposite torque, the link that carries it
        for (index, joint) in self.joints.iter().enumerate() {
            let onward: f64 = self
                .model
                .joints()
                .iter()
                .enumerate()
                .filter(|(_, child)| child.parent == Some(index))
                .map(|(child, _)| self.joints[child].sense * self.applied_nm[child])
                .sum();
            if let Some(body) = world.physics.bodies.get_mut(joint.body) {
                body.reset_torques(false);
                body.add_torque(joint.sense * self.applied_nm[index] - onward, false);
            }
        }
        limited
    }

    /// Torques that the motors gave last, N m.
    #[must_use]
    pub fn applied_torque_nm(&self) -> &DVector<f64> {
        &self.applied_nm
    }

    /// Pose of the tool in the world.
    #[must_use]
    pub fn world_from_tool(&self, world: &PlanarWorld) -> Isometry2<f64> {
        let body = self.joints.get(self.carrier).and_then(|joint| world.physics.bodies.get(joint.body));
        body.map(|body| convert::isometry(body.position()) * self.body_from_flange).unwrap_or_default()
    }

    /// Writes the joints' origins and the flange, world frame, from base to tip.
    pub fn joint_points(&self, world: &PlanarWorld, points: &mut Vec<Point2<f64>>) {
        points.clear();
        for joint in &self.joints {
            if let Some(body) = world.physics.bodies.get(joint.body) {
                points.push(convert::to_point(body.position().translation));
            }
        }
        points.push(Point2::from(self.world_from_tool(world).translation.vector));
    }

    /// Pushes the tool's origin with a force until the next call, world axes, N: a disturbance.
    pub fn disturb(&self, world: &mut PlanarWorld, force_world_n: &Vector2<f64>) {
        let at = convert::vector(&self.world_from_tool(world).translation.vector);
        if let Some(body) = self.joints.get(self.carrier).and_then(|joint| world.physics.bodies.get_mut(joint.body)) {
            body.reset_forces(true);
            body.add_force_at_point(convert::vector(force_world_n), at, true);
        }
    }
}

fn check_planar(model: &Manipulator) -> Result<(), SimError> {
    let refuse = |reason: String| Err(SimError::Arm { reason });
    if leans(model.world_from_base()) {
        return refuse("the base is tilted out of the plane; mount it with a rotation about z only".into());
    }
    for joint in model.joints() {
        if !matches!(joint.kind, JointKind::Revolute | JointKind::Continuous) {
            return refuse(format!("joint '{}' does not turn; expected revolute joints in a planar scene", joint.name));
        }
        if joint.axis.xy().norm() > PLANARITY || leans(&joint.parent_from_joint) {
            return refuse(format!("joint '{}' moves out of the plane; expected an axis along z", joint.name));
        }
    }
    Ok(())
}
