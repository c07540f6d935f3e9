//! The hand: a mass on a spring that drags the tool after the place where the human wants it.

use nalgebra::{Isometry2, Vector2};
use rapier2d::prelude::*;
use skills::tool::Tool;

use super::config::HumanConfig;
use crate::planar::PlanarWorld;

/// Times critical damping: a hand does not ring.
const DAMPING_RATIO: f64 = 2.0;
/// The hand turns as easily as its mass at this distance, m.
const GYRATION_M: f64 = 0.03;

/// A hand that holds a tool in a planar world.
pub(crate) struct Hand {
    body: RigidBodyHandle,
    stiffness_n_per_m: f64,
    damping_n_s_per_m: f64,
}

impl Hand {
    /// Inserts hand and tool at `world_from_tool`.
    pub(crate) fn insert(
        world: &mut PlanarWorld,
        tool: &Tool,
        config: &HumanConfig,
        world_from_tool: &Isometry2<f64>,
    ) -> Self {
        let mass = config.hand_mass_kg;
        let properties = MassProperties::new(Vector::ZERO, mass, mass * GYRATION_M * GYRATION_M);
        let body = RigidBodyBuilder::dynamic().additional_mass_properties(properties).can_sleep(false);
        let body = world.insert_body(body, world_from_tool);
        world.attach_tool(body, tool, &Isometry2::identity());
        let damping_n_s_per_m = DAMPING_RATIO * 2.0 * (config.hand_stiffness_n_per_m * mass).sqrt();
        Self { body, stiffness_n_per_m: config.hand_stiffness_n_per_m, damping_n_s_per_m }
    }

    /// Pose of the tool.
    pub(crate) fn world_from_tool(&self, world: &PlanarWorld) -> Isometry2<f64> {
        world.body_pose(self.body)
    }

    /// Pulls the hand towards a place that moves with a velocity, and its angle towards zero turning at `angle_rad`.
    pub(crate) fn pull(&self, world: &mut PlanarWorld, place: &Vector2<f64>, velocity: &Vector2<f64>, angle_rad: f64) {
        let pose = world.body_pose(self.body);
        let Some(body) = world.body_mut(self.body) else { return };
        let (linear, rate) = (Vector2::new(body.linvel().x, body.linvel().y), body.angvel());
        let force =
            (place - pose.translation.vector) * self.stiffness_n_per_m + (velocity - linear) * self.damping_n_s_per_m;
        let turn = nalgebra::UnitComplex::new(angle_rad).rotation_to(&pose.rotation).angle();
        let square = GYRATION_M * GYRATION_M;
        let torque = -(turn * self.stiffness_n_per_m + rate * self.damping_n_s_per_m) * square;
        body.reset_forces(false);
        body.reset_torques(false);
        body.add_force(Vector::new(force.x, force.y), true);
        body.add_torque(torque, true);
    }
}
