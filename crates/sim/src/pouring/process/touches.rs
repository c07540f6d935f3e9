//! Counts how often two colliders touch.

use rapier3d::prelude::{ColliderHandle, PhysicsWorld};

/// Time apart after which the next touch counts again, s.
const PAUSE_S: f64 = 0.05;

/// Touches between two colliders: contacts that push.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touches {
    pair: (ColliderHandle, ColliderHandle),
    apart_s: f64,
    count: usize,
}

impl Touches {
    pub(super) fn between(one: ColliderHandle, other: ColliderHandle) -> Self {
        Self { pair: (one, other), apart_s: f64::INFINITY, count: 0 }
    }

    /// Looks at the contacts of the last step.
    pub(super) fn look(&mut self, physics: &PhysicsWorld, time_step_s: f64) {
        self.apart_s += time_step_s;
        let Some(pair) = physics.narrow_phase.contact_pair(self.pair.0, self.pair.1) else { return };
        let pushes = pair.solver_manifolds().iter().flat_map(|m| &m.points).any(|point| point.data.impulse > 0.0);
        if pushes {
            self.count += usize::from(self.apart_s > PAUSE_S);
            self.apart_s = 0.0;
        }
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }
}
