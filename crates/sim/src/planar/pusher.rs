//! A tool on rails: it moves with a stated twist whatever it meets, as the pusher of textbook experiments does.

use nalgebra::{Isometry2, Vector2};
use rapier2d::prelude::*;
use skills::tool::Tool;

use super::convert;
use super::world::PlanarWorld;

/// A kinematic tool in a planar world.
pub struct Pusher {
    body: RigidBodyHandle,
}

impl Pusher {
    /// Inserts `tool` at `world_from_tool`, at rest.
    pub fn insert(world: &mut PlanarWorld, tool: &Tool, world_from_tool: &Isometry2<f64>) -> Self {
        let body = RigidBodyBuilder::kinematic_velocity_based().pose(convert::pose(world_from_tool)).can_sleep(false);
        let body = world.physics.insert_body(body);
        world.attach_tool(body, tool, &Isometry2::identity());
        Self { body }
    }

    /// Sets the velocity of the tool's origin, m/s, and its turning rate, rad/s.
    pub fn set_velocity(&self, world: &mut PlanarWorld, velocity_world_m_per_s: &Vector2<f64>, rate_rad_per_s: f64) {
        if let Some(body) = world.physics.bodies.get_mut(self.body) {
            body.set_linvel(convert::vector(velocity_world_m_per_s), true);
            body.set_angvel(rate_rad_per_s, true);
        }
    }

    /// Pose of the tool in the world.
    #[must_use]
    pub fn world_from_tool(&self, world: &PlanarWorld) -> Isometry2<f64> {
        world.physics.bodies.get(self.body).map(|body| convert::isometry(body.position())).unwrap_or_default()
    }
}
