//! A place that follows a jumping target smoothly, with the rate and acceleration that a controller needs.

use nalgebra::Vector2;

/// Critically damped second-order follower of a target in the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Settling {
    /// Where it is, m.
    pub place: Vector2<f64>,
    /// How fast it goes, m/s.
    pub rate: Vector2<f64>,
    /// What pulls it, m/s².
    pub pull: Vector2<f64>,
}

impl Settling {
    /// Starts at rest at a place.
    pub(super) fn at(place: Vector2<f64>) -> Self {
        Self { place, ..Self::default() }
    }

    /// Lets `dt` pass while it follows `target` with time constant `response_s`.
    pub(super) fn follow(&mut self, target: &Vector2<f64>, response_s: f64, dt: f64) {
        self.pull = (target - self.place) / (response_s * response_s) - self.rate * (2.0 / response_s);
        self.place += self.rate * dt + self.pull * (0.5 * dt * dt);
        self.rate += self.pull * dt;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_followed_without_overshoot() {
        let mut settling = Settling::default();
        let target = Vector2::new(1.0, -2.0);
        for _ in 0..2000 {
            settling.follow(&target, 0.1, 0.001);
            assert!(settling.place.x <= 1.0 + 1e-9 && settling.place.y >= -2.0 - 1e-9);
        }
        assert!((settling.place - target).norm() < 1e-6 && settling.rate.norm() < 1e-5);
    }
}
