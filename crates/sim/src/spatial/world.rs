//! A spatial scene in Rapier: gravity, what stands fixed, and whatever arm and task put into it.

use nalgebra::{Isometry3, Vector3};
use rapier3d::prelude::*;
use skills::field::finite;

use super::config::EngineConfig;
use super::convert;
use crate::error::SimError;

/// Speed cap and push-out cap of the engine's contact solver, m/s; far above anything on a table.
const MAX_SPEED_M_PER_S: f64 = 400.0;
const MAX_PUSH_OUT_M_PER_S: f64 = 0.5;

/// Gravity of the Earth, world frame, m/s².
#[must_use]
pub fn standard_gravity() -> Vector3<f64> {
    Vector3::new(0.0, 0.0, -9.81)
}

/// A spatial scene in the engine.
pub struct SpatialWorld {
    /// The engine's whole state.
    pub physics: PhysicsWorld,
    ground: RigidBodyHandle,
    steps: u64,
}

impl SpatialWorld {
    /// An empty scene.
    ///
    /// # Errors
    /// A field error if a configuration value cannot be used.
    pub fn new(engine: &EngineConfig, gravity_in_world: &Vector3<f64>) -> Result<Self, SimError> {
        engine.validate()?;
        finite("gravity_in_world", gravity_in_world.as_slice())?;
        let mut physics = PhysicsWorld::new();
        physics.gravity = convert::vector(gravity_in_world);
        configure(&mut physics.integration_parameters, engine);
        let ground = physics.insert_body(RigidBodyBuilder::fixed());
        Ok(Self { physics, ground, steps: 0 })
    }

    /// Adds something that never moves, and returns its collider.
    pub fn insert_fixed(
        &mut self,
        shape: SharedShape,
        world_from_shape: &Isometry3<f64>,
        friction: f64,
    ) -> ColliderHandle {
        let collider = ColliderBuilder::new(shape).position(convert::pose(world_from_shape)).friction(friction);
        self.physics.insert_collider(collider, Some(self.ground))
    }

    /// Advances one time step.
    pub fn step(&mut self) {
        self.physics.step();
        self.steps += 1;
    }

    /// Simulated time, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.steps as f64 * self.time_step_s()
    }

    /// Time step of the physics, s.
    #[must_use]
    pub fn time_step_s(&self) -> f64 {
        self.physics.integration_parameters.dt
    }
}

fn configure(parameters: &mut IntegrationParameters, engine: &EngineConfig) {
    parameters.dt = engine.time_step_s;
    parameters.num_solver_iterations = engine.substeps;
    parameters.length_unit = engine.length_unit_m;
    // the engine scales these caps by the length unit; they are meant in plain meters per second
    parameters.normalized_max_linear_velocity = MAX_SPEED_M_PER_S / engine.length_unit_m;
    parameters.normalized_max_corrective_velocity = MAX_PUSH_OUT_M_PER_S / engine.length_unit_m;
    parameters.contact_softness.natural_frequency = engine.contact_frequency_hz;
    parameters.static_contact_softness.natural_frequency = engine.contact_frequency_hz;
    parameters.contact_recycling = engine.contact_recycling;
    parameters.max_ccd_substeps = 0;
}
