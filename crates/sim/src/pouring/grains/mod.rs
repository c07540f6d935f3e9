//! Grains: many small bodies of one kind in somebody else's world.

mod batch;
mod config;
mod rolling;

use nalgebra::Isometry3;
use rapier3d::math::Pose;
use rapier3d::prelude::{
    ColliderHandle, InteractionGroups, PhysicsWorld, RigidBody, RigidBodyBuilder, RigidBodyHandle,
};

use super::filling::Filling;
use crate::error::SimError;

pub use batch::GrainBatch;
pub use config::{GrainConfig, GrainShape};
use rolling::Rolling;

/// An odd number without a pattern, 2⁶⁴ over the golden ratio: to multiply by it is one to one, and mixes upward.
const FOLD: u64 = 0x9E37_79B9_7F4A_7C15;

/// Grains in a world, in the order of their batch.
pub struct Grains {
    batch: GrainBatch,
    bodies: Vec<RigidBodyHandle>,
    by_collider: ByCollider,
    rolling: Rolling,
}

impl Grains {
    /// Inserts the grains of `batch` at rest at `world_from_grains`, one pose per grain, with collision `groups`.
    ///
    /// # Errors
    /// A field error if there are not as many poses as grains.
    pub fn insert(
        physics: &mut PhysicsWorld,
        batch: GrainBatch,
        world_from_grains: &[Isometry3<f64>],
        groups: InteractionGroups,
    ) -> Result<Self, SimError> {
        batch.expect_length("world_from_grains", world_from_grains.len())?;
        let (mut bodies, mut by_collider) = (Vec::with_capacity(batch.len()), ByCollider::default());
        for (index, (diameter_m, pose)) in batch.diameters_m().iter().zip(world_from_grains).enumerate() {
            // A sleeping grain would hang in the air when its cup tilts away slowly. Looking ahead of fast grains by a
            // diameter lets them bounce off a surface instead of up to v dt, 2.8 mm after a fall of 0.1 m, below it.
            let body =
                RigidBodyBuilder::dynamic().can_sleep(false).soft_ccd_prediction(*diameter_m).pose(Pose::from(*pose));
            let body = physics.insert_body(body);
            let collider = batch.config().collider(*diameter_m).collision_groups(groups);
            by_collider.note(physics.insert_collider(collider, Some(body)), index);
            bodies.push(body);
        }
        let inertias = bodies.iter().map(|body| least_inertia(physics, *body)).collect();
        let rolling = Rolling::new(batch.config().rolling_friction, batch.radii_m().collect(), inertias);
        Ok(Self { batch, bodies, by_collider, rolling })
    }

    /// Inserts grains that were settled in a container, with the velocities they had, where that container is now.
    ///
    /// # Errors
    /// A field error if the filling is not one that [`super::fill`] made.
    pub fn insert_filling(
        physics: &mut PhysicsWorld,
        filling: &Filling,
        world_from_container: &Isometry3<f64>,
        groups: InteractionGroups,
    ) -> Result<Self, SimError> {
        let poses: Vec<_> = filling.container_from_grains.iter().map(|pose| world_from_container * pose).collect();
        let grains = Self::insert(physics, filling.batch.clone(), &poses, groups)?;
        let turn = Pose::from(*world_from_container).rotation;
        for (handle, (linear, angular)) in grains.bodies.iter().zip(&filling.velocities_in_container) {
            if let Some(body) = physics.bodies.get_mut(*handle) {
                body.set_linvel(turn * rapier3d::math::Vector::new(linear.x, linear.y, linear.z), true);
                body.set_angvel(turn * rapier3d::math::Vector::new(angular.x, angular.y, angular.z), true);
            }
        }
        Ok(grains)
    }

    /// What must be done before each step of the engine: rolling resistance from the last step's contacts.
    pub fn before_step(&mut self, physics: &mut PhysicsWorld) {
        self.rolling.apply(physics, &self.bodies, &self.by_collider);
    }

    /// Number of grains.
    #[must_use]
    pub fn len(&self) -> usize {
        self.bodies.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// Sizes and masses.
    #[must_use]
    pub fn batch(&self) -> &GrainBatch {
        &self.batch
    }

    /// The grains' bodies.
    #[must_use]
    pub fn handles(&self) -> &[RigidBodyHandle] {
        &self.bodies
    }

    /// Which grain a collider belongs to.
    #[must_use]
    pub fn index_of(&self, collider: ColliderHandle) -> Option<usize> {
        self.by_collider.index(collider)
    }

    /// The grains' bodies in their order.
    pub fn bodies<'a>(&'a self, physics: &'a PhysicsWorld) -> impl Iterator<Item = &'a RigidBody> + 'a {
        self.bodies.iter().filter_map(|handle| physics.bodies.get(*handle))
    }

    /// Writes the grains' poses in the world into `world_from_grains`, which keeps its memory.
    pub fn poses(&self, physics: &PhysicsWorld, world_from_grains: &mut Vec<Isometry3<f64>>) {
        world_from_grains.clear();
        world_from_grains.extend(self.bodies(physics).map(|body| Isometry3::from(*body.position())));
    }

    /// The greatest speed of a grain, m/s; NaN if any is.
    #[must_use]
    pub fn greatest_speed_m_per_s(&self, physics: &PhysicsWorld) -> f64 {
        let greater = |most: f64, speed: f64| if speed > most || speed.is_nan() { speed } else { most };
        self.bodies(physics).map(|body| body.linvel().length()).fold(0.0, greater)
    }

    /// Adds every bit of the grains' poses to a digest: equal digests, equal runs.
    ///
    /// All poses are folded into one number first: the digest proper of 17 KB per step took a twentieth of a run. Every bit
    /// changes that number, and two runs that part in any step differ in it, but for one chance in 2⁶⁴.
    pub fn digest(&self, physics: &PhysicsWorld, digest: &mut blake3::Hasher) {
        let mut folded = 0_u64;
        for body in self.bodies(physics) {
            let (at, turn) = (body.translation(), body.rotation());
            for value in [at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w] {
                folded = (folded.rotate_left(23) ^ value.to_bits()).wrapping_mul(FOLD);
            }
        }
        digest.update(&folded.to_le_bytes());
    }

    /// Checks that no grain is faster than `limit_m_per_s`: what falls from h has √(2gh).
    ///
    /// # Errors
    /// [`SimError::Diverged`] if one is, or is not finite.
    pub fn check_speed(&self, physics: &PhysicsWorld, time_s: f64, limit_m_per_s: f64) -> Result<(), SimError> {
        let value = self.greatest_speed_m_per_s(physics);
        if value <= limit_m_per_s {
            return Ok(());
        }
        let quantity = format!("the greatest speed of a grain (m/s, at most {limit_m_per_s:.2})");
        Err(SimError::Diverged { quantity, value, time_s })
    }
}

/// Which grain each collider is: a table over the engine's slot numbers, no search.
#[derive(Debug, Default)]
pub(super) struct ByCollider {
    slots: Vec<Option<(ColliderHandle, usize)>>,
}

impl ByCollider {
    fn note(&mut self, collider: ColliderHandle, grain: usize) {
        let slot = collider.into_raw_parts().0 as usize;
        if self.slots.len() <= slot {
            self.slots.resize(slot + 1, None);
        }
        if let Some(entry) = self.slots.get_mut(slot) {
            *entry = Some((collider, grain));
        }
    }

    pub(super) fn index(&self, collider: ColliderHandle) -> Option<usize> {
        let (known, grain) = (*self.slots.get(collider.into_raw_parts().0 as usize)?)?;
        (known == collider).then_some(grain)
    }
}

/// The least principal moment of inertia, kg m².
fn least_inertia(physics: &mut PhysicsWorld, handle: RigidBodyHandle) -> f64 {
    let Some(body) = physics.bodies.get_mut(handle) else { return 0.0 };
    body.recompute_mass_properties_from_colliders(&physics.colliders);
    let inertia = body.mass_properties().local_mprops.principal_inertia();
    inertia.x.min(inertia.y).min(inertia.z)
}

#[cfg(test)]
#[path = "grains_tests.rs"]
mod tests;
