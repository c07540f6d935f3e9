//! Uniform pressure on support points: the sum of their Coulomb friction forces.
//!
//! Exact for the pressure that it states, at the cost of a sum over the points. It couples slip and spin as a real flat
//! object does: both end together (Farkas, Bartels, Unger and Wolf 2003).

use nalgebra::{Matrix3, Vector2, Vector3};
use skills::outline::Outline;

use super::SupportLaw;

/// Support friction of equal loads on points spread evenly over the outline.
#[derive(Clone, Debug)]
pub struct SupportPoints {
    /// Points relative to the center of mass, in the object's axes, m.
    points_m: Vec<Vector2<f64>>,
    deceleration_m_per_s2: f64,
    mass_kg: f64,
    inertia_per_mass_m2: f64,
    length_m: f64,
}

/// Sliding speed below which a point's friction grows linearly with its speed, as a share of what one step removes.
const SMOOTHING_PER_STEP: f64 = 0.01;
/// Below this multiple of the smoothing speed a motion is rest: friction that is not yet saturated would let it creep.
const REST_RATIO: f64 = 10.0;
const NEWTON_ROUNDS: usize = 30;
/// Newton's method has converged when a round changes the twist by less than this share of what friction removes.
const NEWTON_TOLERANCE: f64 = 1e-9;

impl SupportPoints {
    /// Law for an outline of mass `mass_kg` on at least `count` points (see [`Outline::spread_points`]).
    #[must_use]
    pub fn new(outline: &Outline, mass_kg: f64, deceleration_m_per_s2: f64, count: usize) -> Self {
        Self {
            points_m: outline.spread_points(count),
            deceleration_m_per_s2,
            mass_kg,
            inertia_per_mass_m2: outline.inertia_per_mass_m2(),
            length_m: outline.mean_radius_m(),
        }
    }

    /// Mean direction of sliding of the points, and its derivative with respect to the twist, smoothed below `smooth` m/s.
    fn mean_direction(&self, twist: &Vector3<f64>, angle_rad: f64, smooth: f64) -> (Vector3<f64>, Matrix3<f64>) {
        let (sin, cos) = angle_rad.sin_cos();
        let mut direction = Vector3::zeros();
        let mut slope = Matrix3::zeros();
        for point in &self.points_m {
            let r = Vector2::new(cos * point.x - sin * point.y, sin * point.x + cos * point.y);
            let v = Vector2::new(twist.x - twist.z * r.y, twist.y + twist.z * r.x);
            let speed = (v.norm_squared() + smooth * smooth).sqrt();
            if speed <= 0.0 {
                continue;
            }
            let u = v / speed;
            direction += Vector3::new(u.x, u.y, r.perp(&u));
            // rows of the point's velocity with respect to the twist: (1, 0, -ry), (0, 1, rx)
            let jx = Vector3::new(1.0, 0.0, -r.y);
            let jy = Vector3::new(0.0, 1.0, r.x);
            let ju = jx * u.x + jy * u.y;
            slope += (jx * jx.transpose() + jy * jy.transpose() - ju * ju.transpose()) / speed;
        }
        let share = 1.0 / self.points_m.len() as f64;
        (direction * share, slope * share)
    }
}

impl SupportLaw for SupportPoints {
    fn wrench(&self, twist: &Vector3<f64>, angle_rad: f64) -> Vector3<f64> {
        self.mean_direction(twist, angle_rad, 0.0).0 * (-self.mass_kg * self.deceleration_m_per_s2)
    }

    /// Damped Newton on D (t⁺ − t) + μ g dt · direction(t⁺) = 0, D = diag(1, 1, I/m): a strictly convex problem.
    fn brake(&self, twist: &Vector3<f64>, angle_rad: f64, dt: f64) -> Vector3<f64> {
        let removed = self.deceleration_m_per_s2 * dt;
        if removed <= 0.0 {
            return *twist;
        }
        let smooth = SMOOTHING_PER_STEP * removed;
        let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, self.inertia_per_mass_m2));
        let residual = |t: &Vector3<f64>| {
            let (direction, slope) = self.mean_direction(t, angle_rad, smooth);
            (inertia * (t - twist) + direction * removed, inertia + slope * removed)
        };
        let scale = Vector3::new(1.0, 1.0, 1.0 / self.length_m);
        let mut next = *twist;
        let (mut error, mut slope) = residual(&next);
        for _ in 0..NEWTON_ROUNDS {
            let Some(step) = slope.cholesky().map(|factor| factor.solve(&error)) else { break };
            let mut share = 1.0;
            let mut trial = residual(&(next - step));
            while trial.0.component_mul(&scale).norm() > error.component_mul(&scale).norm() && share > 1e-3 {
                share *= 0.5;
                trial = residual(&(next - step * share));
            }
            next -= step * share;
            (error, slope) = trial;
            if step.component_div(&scale).norm() * share < NEWTON_TOLERANCE * removed {
                break;
            }
        }
        if next.component_div(&scale).norm() < REST_RATIO * smooth { Vector3::zeros() } else { next }
    }

    fn characteristic_length_m(&self) -> f64 {
        self.length_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn disc(count: usize) -> SupportPoints {
        SupportPoints::new(&Outline::Disc { radius_m: 0.012 }, 0.0054, 0.25 * 9.81, count)
    }

    #[test]
    fn moments_of_a_spinning_disc_approach_two_thirds_of_its_radius() {
        let force = 0.0054 * 0.25 * 9.81;
        let moment = -disc(64).wrench(&Vector3::new(0.0, 0.0, 1.0), 0.3).z / force;
        // 64 points stand for continuous pressure to 1 %
        assert_relative_eq!(moment, 0.008, max_relative = 0.01);
    }

    #[test]
    fn braking_a_slide_takes_off_mu_g_dt_and_ends_at_exact_rest() {
        let next = disc(64).brake(&Vector3::new(0.3, 0.0, 0.0), 0.0, 0.001);
        assert_relative_eq!(next.x, 0.3 - 0.25 * 9.81 * 0.001, epsilon = 1e-7);
        assert_eq!(disc(64).brake(&Vector3::new(0.002, 0.0, 0.0), 0.0, 0.001), Vector3::zeros());
    }

    #[test]
    fn spin_and_slide_end_together() {
        let (mut twist, dt) = (Vector3::new(0.3, 0.0, 25.0), 1e-4);
        let mut last_ratio = 0.0;
        for _ in 0..3000 {
            let next = disc(256).brake(&twist, 0.0, dt);
            if next == Vector3::zeros() {
                break;
            }
            twist = next;
            if twist.x > 0.005 {
                last_ratio = twist.x / (0.012 * twist.z);
            }
        }
        // v/(R w) tends to 0.653 at the stop: Farkas et al., Phys. Rev. Lett. 90, 248302 (2003)
        assert_relative_eq!(last_ratio, 0.653, epsilon = 0.03);
    }
}
