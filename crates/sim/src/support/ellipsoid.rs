//! Ellipsoidal limit surface: (fx/fm)² + (fy/fm)² + (m/(c fm))² = 1.
//!
//! Sources: Goyal, Ruina and Papadopoulos 1991; Lynch, Maekawa and Tanie 1992; Howe and Cutkosky 1996. The semi-axes are
//! exact for pure translation and for pure rotation under uniform pressure; between them the ellipsoid is a model.

use nalgebra::Vector3;
use skills::outline::Outline;

use super::SupportLaw;

/// Support friction with an ellipsoidal limit surface.
#[derive(Clone, Debug)]
pub struct Ellipsoid {
    max_force_n: f64,
    deceleration_m_per_s2: f64,
    /// Mean distance of the support from its center: ratio of the largest moment to the largest force.
    length_m: f64,
    inertia_per_mass_m2: f64,
}

/// Bisection halves its bracket once per round; this many reach the last bit of a double.
const BISECTIONS: usize = 60;

impl Ellipsoid {
    /// Law for an outline of mass `mass_kg` that slides to rest with `deceleration_m_per_s2` (friction times gravity).
    #[must_use]
    pub fn new(outline: &Outline, mass_kg: f64, deceleration_m_per_s2: f64) -> Self {
        Self {
            max_force_n: mass_kg * deceleration_m_per_s2,
            deceleration_m_per_s2,
            length_m: outline.mean_radius_m(),
            inertia_per_mass_m2: outline.inertia_per_mass_m2(),
        }
    }
}

impl SupportLaw for Ellipsoid {
    fn wrench(&self, twist: &Vector3<f64>, _angle_rad: f64) -> Vector3<f64> {
        let c = self.length_m;
        let speed = (twist.x * twist.x + twist.y * twist.y + c * c * twist.z * twist.z).sqrt();
        if speed > 0.0 {
            Vector3::new(twist.x, twist.y, c * c * twist.z) * (-self.max_force_n / speed)
        } else {
            Vector3::zeros()
        }
    }

    /// Solves (|v|/(S+d))² + (c w/(S+e))² = 1 for the remaining speed S > 0, d = μ g dt, e = d c² m/I.
    fn brake(&self, twist: &Vector3<f64>, _angle_rad: f64, dt: f64) -> Vector3<f64> {
        let d = self.deceleration_m_per_s2 * dt;
        if d <= 0.0 {
            return *twist;
        }
        let e = d * self.length_m * self.length_m / self.inertia_per_mass_m2;
        let slide = twist.x.hypot(twist.y);
        let spin = self.length_m * twist.z.abs();
        let excess = |s: f64| (slide / (s + d)).powi(2) + (spin / (s + e)).powi(2) - 1.0;
        if excess(0.0) <= 0.0 {
            return Vector3::zeros();
        }
        let (mut low, mut high) = (0.0, slide + spin);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if excess(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let s = 0.5 * (low + high);
        let (keep_slide, keep_spin) = (s / (s + d), s / (s + e));
        Vector3::new(twist.x * keep_slide, twist.y * keep_slide, twist.z * keep_spin)
    }

    fn characteristic_length_m(&self) -> f64 {
        self.length_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn disc() -> Ellipsoid {
        Ellipsoid::new(&Outline::Disc { radius_m: 0.012 }, 0.0054, 0.25 * 9.81)
    }

    #[test]
    fn a_disc_resists_spin_at_two_thirds_of_its_radius() {
        assert_relative_eq!(disc().characteristic_length_m(), 0.008, epsilon = 1e-12);
        let spin = disc().wrench(&Vector3::new(0.0, 0.0, 3.0), 0.0);
        assert_relative_eq!(spin.z, -0.0054 * 0.25 * 9.81 * 0.008, epsilon = 1e-12);
    }

    #[test]
    fn braking_a_slide_takes_off_mu_g_dt_and_ends_at_exact_rest() {
        let next = disc().brake(&Vector3::new(0.3, 0.0, 0.0), 0.0, 0.001);
        assert_relative_eq!(next.x, 0.3 - 0.25 * 9.81 * 0.001, epsilon = 1e-12);
        assert_eq!(disc().brake(&Vector3::new(0.002, 0.0, 0.0), 0.0, 0.001), Vector3::zeros());
    }

    #[test]
    fn a_frictionless_table_changes_nothing() {
        let ice = Ellipsoid::new(&Outline::Disc { radius_m: 0.012 }, 0.0054, 0.0);
        for twist in [Vector3::zeros(), Vector3::new(0.1, -0.2, 3.0)] {
            assert_eq!(ice.brake(&twist, 0.0, 0.001), twist);
            assert_eq!(ice.wrench(&twist, 0.0), Vector3::zeros());
        }
    }

    #[test]
    fn braking_never_reverses_a_motion() {
        for step in 1..200 {
            let twist = Vector3::new(1e-4 * f64::from(step), -2e-4, 0.05 * f64::from(step % 7));
            let next = disc().brake(&twist, 0.0, 0.002);
            assert!(next.x >= 0.0 && next.y <= 0.0 && next.z >= 0.0 && next.norm() < twist.norm());
        }
    }
}
