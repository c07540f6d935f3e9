//! The object on the table: a rigid body with support friction.

use nalgebra::{Isometry2, Vector3};
use rapier2d::prelude::*;

use super::config::{ObjectConfig, WorldConfig};
use super::convert;
use crate::support::SupportLaw;

/// Motors solve friction together with the contacts; the gain makes them act as pure force limits.
const MOTOR_GAIN: f64 = 1e8;
/// Below this multiple of what friction removes in one step, motors chatter: the implicit map takes over.
const MOTOR_MIN_SPEED_RATIO: f64 = 2.0;
const AXES: [JointAxis; 3] = [JointAxis::LinX, JointAxis::LinY, JointAxis::AngX];

pub(crate) struct Slider {
    body: RigidBodyHandle,
    collider: ColliderHandle,
    motors: ImpulseJointHandle,
    law: Box<dyn SupportLaw>,
    /// Speed that friction removes in one time step, m/s.
    removed_m_per_s: f64,
}

impl Slider {
    pub(crate) fn insert(
        physics: &mut PhysicsWorld,
        ground: RigidBodyHandle,
        world: &WorldConfig,
        object: &ObjectConfig,
        world_from_object: &Isometry2<f64>,
        groups: InteractionGroups,
    ) -> Self {
        let center = convert::vector(&object.shape.centroid().coords);
        let inertia = object.mass_kg * object.shape.inertia_per_mass_m2();
        let body = RigidBodyBuilder::dynamic()
            .pose(convert::pose(world_from_object))
            .additional_mass_properties(MassProperties::new(center, object.mass_kg, inertia))
            .can_sleep(false);
        let body = physics.insert_body(body);
        let shape = object.shape.shape().unwrap_or_else(|| SharedShape::ball(object.shape.radius_m()));
        // the partner's coefficient decides: the larger of it and zero
        let collider = ColliderBuilder::new(shape)
            .density(0.0)
            .friction(0.0)
            .friction_combine_rule(CoefficientCombineRule::Max)
            .collision_groups(groups);
        let collider = physics.insert_collider(collider, Some(body));
        let joint = AXES.into_iter().fold(
            GenericJointBuilder::new(JointAxesMask::empty()).local_anchor2(center),
            |joint, axis| {
                joint
                    .motor_model(axis, MotorModel::ForceBased)
                    .set_motor(axis, 0.0, 0.0, 0.0, MOTOR_GAIN)
                    .motor_max_force(axis, 0.0)
            },
        );
        let motors = physics.insert_impulse_joint(ground, body, joint);
        let law = object.support.law(&object.shape, object.mass_kg, object.table_friction, world.gravity_m_per_s2);
        let removed_m_per_s = object.table_friction * world.gravity_m_per_s2 * physics.integration_parameters.dt;
        Self { body, collider, motors, law, removed_m_per_s }
    }

    pub(crate) fn collider(&self) -> ColliderHandle {
        self.collider
    }

    pub(crate) fn pose(&self, physics: &PhysicsWorld) -> Isometry2<f64> {
        physics.bodies.get(self.body).map(|body| convert::isometry(body.position())).unwrap_or_default()
    }

    pub(crate) fn twist(&self, physics: &PhysicsWorld) -> Vector3<f64> {
        let twist =
            physics.bodies.get(self.body).map(|body| Vector3::new(body.linvel().x, body.linvel().y, body.angvel()));
        twist.unwrap_or_default()
    }

    pub(crate) fn set_twist(&self, physics: &mut PhysicsWorld, twist: &Vector3<f64>) {
        if let Some(body) = physics.bodies.get_mut(self.body) {
            body.set_linvel(Vector::new(twist.x, twist.y), true);
            body.set_angvel(twist.z, true);
        }
    }

    /// Lets support friction act in the coming step: as motors while `touched` and sliding, as a velocity map otherwise.
    pub(crate) fn apply_support(&self, physics: &mut PhysicsWorld, touched: bool) {
        let twist = self.twist(physics);
        let angle_rad = self.pose(physics).rotation.angle();
        let c = self.law.characteristic_length_m();
        let speed = (twist.x * twist.x + twist.y * twist.y + c * c * twist.z * twist.z).sqrt();
        let by_motors = touched && speed > MOTOR_MIN_SPEED_RATIO * self.removed_m_per_s;
        let limits = if by_motors { self.law.wrench(&twist, angle_rad).abs() } else { Vector3::zeros() };
        if let Some(joint) = physics.impulse_joints.get_mut(self.motors, false) {
            for (axis, limit) in AXES.into_iter().zip(limits.iter()) {
                joint.data.set_motor_max_force(axis, *limit);
            }
        }
        if !by_motors {
            let braked = self.law.brake(&twist, angle_rad, physics.integration_parameters.dt);
            self.set_twist(physics, &braked);
        }
    }
}
