//! A container as part of a body in a world.

use nalgebra::{Isometry3, Point3, Vector3};
use rapier3d::math::Pose;
use rapier3d::prelude::{ColliderHandle, InteractionGroups, PhysicsWorld, RigidBodyHandle};

use super::super::grains::GrainConfig;
use super::Container;

/// A container whose colliders belong to a body: a fixed or kinematic one, a free one, or a link of an arm.
#[derive(Clone, Debug)]
pub struct AttachedContainer {
    container: Container,
    body: RigidBodyHandle,
    collider: ColliderHandle,
    body_from_container: Isometry3<f64>,
}

impl Container {
    /// Lends this container's colliders to `body`, at `body_from_container`, as a wall for grains of `grain`.
    ///
    /// The collider weighs nothing: whoever owns the body accounts for [`Container::mass_properties`].
    pub fn attach(
        &self,
        physics: &mut PhysicsWorld,
        body: RigidBodyHandle,
        body_from_container: &Isometry3<f64>,
        groups: InteractionGroups,
        grain: &GrainConfig,
    ) -> AttachedContainer {
        let collider = self.collider(grain).position(Pose::from(*body_from_container)).collision_groups(groups);
        let collider = physics.insert_collider(collider, Some(body));
        AttachedContainer { container: self.clone(), body, collider, body_from_container: *body_from_container }
    }
}

impl AttachedContainer {
    /// The container.
    #[must_use]
    pub fn container(&self) -> &Container {
        &self.container
    }

    /// The body that carries it.
    #[must_use]
    pub fn body(&self) -> RigidBodyHandle {
        self.body
    }

    /// Its collider.
    #[must_use]
    pub fn collider(&self) -> ColliderHandle {
        self.collider
    }

    /// Pose of the container; that in its body if the body is gone.
    #[must_use]
    pub fn world_from_container(&self, physics: &PhysicsWorld) -> Isometry3<f64> {
        let world_from_body = physics.bodies.get(self.body).map(|body| Isometry3::from(*body.position()));
        world_from_body.unwrap_or_default() * self.body_from_container
    }

    /// The lip's point and direction in the world.
    #[must_use]
    pub fn lip_in_world(&self, physics: &PhysicsWorld) -> (Point3<f64>, Vector3<f64>) {
        let (pose, lip) = (self.world_from_container(physics), self.container.lip);
        (pose * lip.point_in_container, pose * lip.direction_in_container)
    }

    /// The rim's center and the mouth plane's normal in the world.
    #[must_use]
    pub fn mouth_in_world(&self, physics: &PhysicsWorld) -> (Point3<f64>, Vector3<f64>) {
        let (pose, rim) = (self.world_from_container(physics), self.container.rim);
        (pose * rim.center_in_container, pose * rim.normal_in_container)
    }

    /// Angle between the container's axis and the vertical, rad.
    #[must_use]
    pub fn tilt_rad(&self, physics: &PhysicsWorld) -> f64 {
        let (_, axis) = self.mouth_in_world(physics);
        axis.z.clamp(-1.0, 1.0).acos()
    }
}
