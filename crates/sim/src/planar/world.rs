//! The table seen from above, in Rapier: an object that slides with support friction, obstacles, and whatever holds the tool.
//!
//! The engine resolves contacts on a frictionless plane. Friction with the table is ours: a limit-surface law applied
//! as force-limited motors while the object is touched (solved together with the contacts), and as an implicit map of
//! the velocity while it slides alone (exact rest, no drift). Pushes slower than twice what friction takes off in a time
//! step (2.5 mm/s by default) are carried by the map alone and follow the law to some percent only.

use nalgebra::{Isometry2, Vector2, Vector3};
use rapier2d::prelude::*;
use skills::tool::Tool;

use super::config::{EngineConfig, ObjectConfig, WorldConfig};
use super::contact::{ContactForce, Party, read_contacts};
use super::convert;
use super::slider::Slider;
use crate::error::SimError;

const OBJECT_GROUP: Group = Group::GROUP_1;
const TOOL_GROUP: Group = Group::GROUP_2;
const OBSTACLE_GROUP: Group = Group::GROUP_3;

/// Speed cap and push-out cap of the engine's contact solver, m/s; far above anything on a table.
const MAX_SPEED_M_PER_S: f64 = 400.0;
const MAX_PUSH_OUT_M_PER_S: f64 = 0.5;
/// More simultaneous contact points than the scene's convex pieces can have.
const CONTACT_CAPACITY: usize = 64;

/// A planar scene in the engine.
pub struct PlanarWorld {
    pub(crate) physics: PhysicsWorld,
    slider: Slider,
    parties: Vec<(ColliderHandle, Party)>,
    contacts: Vec<ContactForce>,
    steps: u64,
}

impl PlanarWorld {
    /// Builds obstacles and the object at `world_from_object`.
    ///
    /// # Errors
    /// A field error if a configuration value cannot be used.
    pub fn new(
        world: &WorldConfig,
        object: &ObjectConfig,
        engine: &EngineConfig,
        world_from_object: &Isometry2<f64>,
    ) -> Result<Self, SimError> {
        world.validate()?;
        object.validate()?;
        engine.validate()?;
        let mut physics = PhysicsWorld::new();
        physics.gravity = Vector::ZERO;
        configure(&mut physics.integration_parameters, engine);
        let ground = physics.insert_body(RigidBodyBuilder::fixed());
        let mut parties = Vec::new();
        for (index, obstacle) in world.obstacles.iter().enumerate() {
            if let Some(shape) = obstacle.shape.shape() {
                let collider = ColliderBuilder::new(shape)
                    .position(convert::pose(&obstacle.placed().pose()))
                    .friction(obstacle.friction)
                    .friction_combine_rule(CoefficientCombineRule::Max)
                    .collision_groups(groups(OBSTACLE_GROUP, OBJECT_GROUP | TOOL_GROUP));
                parties.push((physics.insert_collider(collider, Some(ground)), Party::Obstacle(index)));
            }
        }
        let slider = Slider::insert(
            &mut physics,
            ground,
            world,
            object,
            world_from_object,
            groups(OBJECT_GROUP, TOOL_GROUP | OBSTACLE_GROUP),
        );
        parties.push((slider.collider(), Party::Object));
        Ok(Self { physics, slider, parties, contacts: Vec::with_capacity(CONTACT_CAPACITY), steps: 0 })
    }

    /// Gives `body` the tool's outline, at `body_from_tool`, as its colliders.
    pub(crate) fn attach_tool(&mut self, body: RigidBodyHandle, tool: &Tool, body_from_tool: &Isometry2<f64>) {
        for (piece, friction) in tool.pieces.iter().zip(tool.piece_frictions()) {
            if let Some(shape) = piece.shape.shape() {
                let collider = ColliderBuilder::new(shape)
                    .density(0.0)
                    .position(convert::pose(&(body_from_tool * piece.pose())))
                    .friction(friction)
                    .friction_combine_rule(CoefficientCombineRule::Max)
                    .collision_groups(groups(TOOL_GROUP, OBJECT_GROUP | OBSTACLE_GROUP));
                self.parties.push((self.physics.insert_collider(collider, Some(body)), Party::Tool));
            }
        }
    }

    /// Adds a body at a pose.
    pub(crate) fn insert_body(&mut self, body: RigidBodyBuilder, pose: &Isometry2<f64>) -> RigidBodyHandle {
        self.physics.insert_body(body.pose(convert::pose(pose)))
    }

    /// Pose of a body; the identity if there is none of that handle.
    pub(crate) fn body_pose(&self, body: RigidBodyHandle) -> Isometry2<f64> {
        self.physics.bodies.get(body).map(|body| convert::isometry(body.position())).unwrap_or_default()
    }

    /// A body, to apply forces to.
    pub(crate) fn body_mut(&mut self, body: RigidBodyHandle) -> Option<&mut RigidBody> {
        self.physics.bodies.get_mut(body)
    }

    /// Advances one time step: support friction, engine, contact forces.
    pub fn step(&mut self) {
        let touched = self.contacts.iter().any(|contact| contact.involves(Party::Object));
        self.slider.apply_support(&mut self.physics, touched);
        self.physics.step();
        self.steps += 1;
        read_contacts(&self.physics, &self.parties, &mut self.contacts);
    }

    /// Simulated time, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.steps as f64 * self.time_step_s()
    }

    /// Number of time steps taken.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Time step of the physics, s.
    #[must_use]
    pub fn time_step_s(&self) -> f64 {
        self.physics.integration_parameters.dt
    }

    /// Pose of the object in the world.
    #[must_use]
    pub fn world_from_object(&self) -> Isometry2<f64> {
        self.slider.pose(&self.physics)
    }

    /// Twist of the object at its center of mass in world axes: vx, vy in m/s, w in rad/s.
    #[must_use]
    pub fn object_twist(&self) -> Vector3<f64> {
        self.slider.twist(&self.physics)
    }

    /// Sets the object's twist: the start of a free slide.
    pub fn set_object_twist(&mut self, twist: &Vector3<f64>) {
        self.slider.set_twist(&mut self.physics, twist);
    }

    /// Contact forces of the last step.
    #[must_use]
    pub fn contacts(&self) -> &[ContactForce] {
        &self.contacts
    }

    /// Sum of the contact forces that `party` exerted on the object in the last step, world axes, N.
    #[must_use]
    pub fn force_on_object_n(&self, party: Party) -> Vector2<f64> {
        self.contacts.iter().filter_map(|contact| contact.force_on_n(Party::Object, party)).sum()
    }
}

fn groups(memberships: Group, filter: Group) -> InteractionGroups {
    InteractionGroups::new(memberships, filter, InteractionTestMode::And)
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
    // recycled contacts keep the old normal and lever arm: several percent of twist error on a round tool
    parameters.contact_recycling = false;
    parameters.max_ccd_substeps = 0;
}
