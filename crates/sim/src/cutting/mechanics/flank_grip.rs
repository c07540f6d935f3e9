//! Friction of a blade's flanks on a free food, which gives way in the blade's plane before it slides.
//!
//! Friction that fades out below a creeping speed is a damper of friction by that speed: kilonewtons by meter per second. A step
//! of dt bears c dt/m < 2 of a damper c on a mass m, and less where the food can turn: a blade that is withdrawn from 30 g with
//! 2.5 N, fading below 1 mm/s, has 83, and throws the food to and fro in each step, at steps of 0.1 ms still. Behind the
//! elasticity of the food, of which a step sees at most what that mass bears, there is no such limit.

use nalgebra::Vector2;

use super::giving::Elasticity;

/// What the flanks bear in one step, in one column of the section.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlankFriction {
    /// Friction of sliding, N.
    pub strength: f64,
    /// Speed below which it fades out, m/s.
    pub creep_speed: f64,
    /// Part of the elasticity that is this column's.
    pub share: f64,
}

/// One patch of both flanks: a spring in the blade's plane with friction behind it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FlankGrip {
    stretch_m: Vector2<f64>,
    /// Energy in the spring, J.
    stored_j: f64,
}

impl FlankGrip {
    /// Velocity with which the flank slides over the food when the knife moves by `velocity` (m/s): where friction takes the
    /// force of the spring at the step's end, so that no step is too long for it.
    pub(super) fn slide(
        &mut self,
        velocity: Vector2<f64>,
        friction: &FlankFriction,
        elasticity: &Elasticity,
    ) -> Vector2<f64> {
        let FlankFriction { strength, creep_speed, share } = *friction;
        let Elasticity { dt, .. } = *elasticity;
        let (stiffness, loss) = (elasticity.stiffness * share, elasticity.loss * share);
        let yielding = stiffness * dt + loss;
        if yielding <= 0.0 {
            self.release();
            return velocity;
        }
        let force = (self.stretch_m + velocity * dt) * stiffness + velocity * loss;
        let size = force.norm();
        let speed = if size < strength + yielding * creep_speed {
            size / (strength / creep_speed + yielding)
        } else {
            (size - strength) / yielding
        };
        let sliding = force * (speed / size.max(f64::MIN_POSITIVE));
        self.stretch_m += (velocity - sliding) * dt;
        self.stored_j = 0.5 * stiffness * self.stretch_m.norm_squared();
        sliding
    }

    /// Lets go.
    pub(super) fn release(&mut self) {
        *self = Self::default();
    }

    /// Energy in the spring, J.
    pub(super) fn stored_j(&self) -> f64 {
        self.stored_j
    }
}

#[cfg(test)]
#[path = "flank_grip_tests.rs"]
mod tests;
