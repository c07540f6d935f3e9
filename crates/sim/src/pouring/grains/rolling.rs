//! Rolling resistance, which the engine lacks: T = −μ_r R_r F_n ω_t/|ω_t|.
//!
//! The directional constant torque, model A of Ai, Chen, Rotter and Ooi (2011): against the relative rotation across the
//! contact plane, with the rolling radius R_r = r₁r₂/(r₁+r₂), or r at a wall. F_n is the last step's impulse over its
//! duration. Each contact takes off at most what stops the relative rotation, one contact after the other, so no
//! rotation is ever reversed. A grain that other forces set rolling anew in each step therefore creeps, by 2.5·g·sin α·dt
//! on a slope α < atan μ_r (0.5 mm/s at 1° and 1 ms), instead of standing still.

use rapier3d::math::Vector;
use rapier3d::prelude::{ContactPair, PhysicsWorld, RigidBodyHandle};

use super::ByCollider;

/// Rolling resistance of a batch, with memory for one step.
#[derive(Debug)]
pub(super) struct Rolling {
    coefficient: f64,
    radii_m: Vec<f64>,
    inertias: Vec<f64>,
    rotations: Vec<Vector>,
    changed: Vec<bool>,
}

impl Rolling {
    pub(super) fn new(coefficient: f64, radii_m: Vec<f64>, inertias: Vec<f64>) -> Self {
        let count = radii_m.len();
        Self { coefficient, radii_m, inertias, rotations: vec![Vector::ZERO; count], changed: vec![false; count] }
    }

    /// Takes off what rolling resistance brakes in one time step.
    pub(super) fn apply(&mut self, physics: &mut PhysicsWorld, bodies: &[RigidBodyHandle], grains: &ByCollider) {
        if self.coefficient == 0.0 {
            return;
        }
        for (rotation, handle) in self.rotations.iter_mut().zip(bodies) {
            *rotation = physics.bodies.get(*handle).map_or(Vector::ZERO, |body| body.angvel());
        }
        self.changed.fill(false);
        for pair in physics.narrow_phase.contact_pairs() {
            self.brake(pair, physics, grains);
        }
        for ((rotation, changed), handle) in self.rotations.iter().zip(&self.changed).zip(bodies) {
            if let (true, Some(body)) = (*changed, physics.bodies.get_mut(*handle)) {
                body.set_angvel(*rotation, false);
            }
        }
    }

    fn brake(&mut self, pair: &ContactPair, physics: &PhysicsWorld, grains: &ByCollider) {
        let (first, other) = match (grains.index(pair.collider1), grains.index(pair.collider2)) {
            (None, None) => return,
            (Some(first), Some(second)) => (first, Other::Grain(second)),
            (Some(first), None) => (first, Other::wall(physics, pair.collider2)),
            (None, Some(second)) => (second, Other::wall(physics, pair.collider1)),
        };
        for manifold in pair.solver_manifolds() {
            let impulse: f64 = manifold.points.iter().map(|point| point.data.impulse).sum();
            if impulse > 0.0 {
                self.brake_contact(first, other, manifold.data.normal, impulse);
            }
        }
    }

    fn brake_contact(&mut self, first: usize, other: Other, normal: Vector, impulse: f64) {
        let (Some(radius), Some(inertia), Some(rotation)) =
            (self.radii_m.get(first), self.inertias.get(first), self.rotations.get(first))
        else {
            return;
        };
        let (rolling_radius, inverse_inertia, relative) = match other {
            Other::Wall(wall) => (*radius, 1.0 / inertia, *rotation - wall),
            Other::Grain(second) => {
                let (Some(radius2), Some(inertia2), Some(rotation2)) =
                    (self.radii_m.get(second), self.inertias.get(second), self.rotations.get(second))
                else {
                    return;
                };
                (radius * radius2 / (radius + radius2), 1.0 / inertia + 1.0 / inertia2, *rotation - *rotation2)
            }
        };
        let rolling = relative - normal * relative.dot(normal);
        let speed = rolling.length();
        if speed < f64::MIN_POSITIVE {
            return;
        }
        let angular_impulse = (self.coefficient * rolling_radius * impulse).min(speed / inverse_inertia);
        let impulse = rolling * (angular_impulse / speed);
        self.turn(first, -impulse);
        if let Other::Grain(second) = other {
            self.turn(second, impulse);
        }
    }

    fn turn(&mut self, grain: usize, impulse: Vector) {
        if let (Some(rotation), Some(changed), Some(inertia)) =
            (self.rotations.get_mut(grain), self.changed.get_mut(grain), self.inertias.get(grain))
        {
            *rotation += impulse / *inertia;
            *changed = true;
        }
    }
}

/// What a grain touches.
#[derive(Clone, Copy)]
enum Other {
    Grain(usize),
    /// Anything else, with its angular velocity.
    Wall(Vector),
}

impl Other {
    fn wall(physics: &PhysicsWorld, collider: rapier3d::prelude::ColliderHandle) -> Self {
        let body = physics.colliders.get(collider).and_then(rapier3d::prelude::Collider::parent);
        Self::Wall(body.and_then(|body| physics.bodies.get(body)).map_or(Vector::ZERO, |body| body.angvel()))
    }
}
