//! What a goal or duration that changes on the way adds to the orientation of a motion: a turn before all others.

use nalgebra::{UnitQuaternion, Vector3};

use crate::primitive::dmp::SHORTEST_TRANSFER;
use crate::primitive::pose::rotation::angular_motion;
use crate::time_law::{MinimumJerkTransfer, PathState};

/// An orientation with its angular velocity and acceleration, by time or by progress, in the frame of the poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AngularMotion {
    pub(super) rotation: UnitQuaternion<f64>,
    pub(super) velocity: Vector3<f64>,
    pub(super) acceleration: Vector3<f64>,
}

impl AngularMotion {
    /// Rest at no rotation.
    pub(super) fn still() -> Self {
        Self { rotation: UnitQuaternion::identity(), velocity: Vector3::zeros(), acceleration: Vector3::zeros() }
    }

    /// The motion of the product q = p·r, p being this: ω = ω_p + p·ω_r, ω̇ = ω̇_p + ω_p × (p·ω_r) + p·ω̇_r.
    pub(super) fn before(&self, next: &Self) -> Self {
        let carried = self.rotation * next.velocity;
        Self {
            rotation: self.rotation * next.rotation,
            velocity: self.velocity + carried,
            acceleration: self.acceleration + self.velocity.cross(&carried) + self.rotation * next.acceleration,
        }
    }

    /// What has this rotation and makes the product with `next` move as `product` does: the inverse of [`Self::before`].
    pub(super) fn completing(&self, product: &Self, next: &Self) -> Self {
        let carried = self.rotation * next.velocity;
        let velocity = product.velocity - carried;
        let acceleration = product.acceleration - velocity.cross(&carried) - self.rotation * next.acceleration;
        Self { rotation: self.rotation, velocity, acceleration }
    }

    /// The same by progress t/τ instead of by time.
    pub(super) fn by_progress(&self, tau: f64) -> Self {
        Self { velocity: self.velocity * tau, acceleration: self.acceleration * (tau * tau), ..*self }
    }

    /// The same by time instead of by progress t/τ.
    pub(super) fn by_time(&self, tau: f64) -> Self {
        Self { velocity: self.velocity / tau, acceleration: self.acceleration / (tau * tau), ..*self }
    }
}

/// Turn c = e^{θ(t/τ)}·c0 that goes before the orientation of a motion, from wherever it is to rest; θ is a minimum-jerk
/// transfer in each coordinate that begins at zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Correction {
    begin: UnitQuaternion<f64>,
    path: [MinimumJerkTransfer; 3],
}

impl Correction {
    /// Plans from `present` (by progress) at `progress` to rest at `end`, the short way round, over what is left of the
    /// motion, at least a quarter of it.
    pub(super) fn new(progress: f64, present: &AngularMotion, end: &UnitQuaternion<f64>) -> Self {
        let turn = (end * present.rotation.inverse()).scaled_axis();
        let horizon = (1.0 - progress).max(SHORTEST_TRANSFER);
        // at θ = 0 the derivatives of θ are those of the rotation
        let path = [0, 1, 2].map(|k| {
            let state = PathState { position: 0.0, first: present.velocity[k], second: present.acceleration[k] };
            MinimumJerkTransfer::new(progress, state, turn[k], horizon)
        });
        Self { begin: present.rotation, path }
    }

    /// Evaluates the turn at `progress`, by progress.
    pub(super) fn at(&self, progress: f64) -> AngularMotion {
        let [x, y, z] = self.path.map(|axis| axis.at(progress));
        let theta = Vector3::new(x.position, y.position, z.position);
        let (first, second) = (Vector3::new(x.first, y.first, z.first), Vector3::new(x.second, y.second, z.second));
        let (velocity, acceleration) = angular_motion(&theta, &first, &second);
        AngularMotion { rotation: UnitQuaternion::from_scaled_axis(theta) * self.begin, velocity, acceleration }
    }
}
