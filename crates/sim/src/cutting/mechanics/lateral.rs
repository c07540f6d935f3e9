//! Forces that keep a blade in the plane of its cut.

use nalgebra::{Point2, Vector3};

use super::motion::EdgeMotion;

/// Poisson's ratio of moist food, hardly compressible: estimate.
const POISSON_RATIO: f64 = 0.45;

/// Sideways stiffness of the walls of a cut on a blade.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walls {
    /// Young's modulus of the food, Pa.
    pub modulus: f64,
    /// Stress at which the food yields, Pa; 0 for a food that does not.
    pub yield_stress: f64,
    /// How far the blade bends before the food pushes back, m.
    pub freedom: f64,
    /// Largest stiffness that one step bears, N/m.
    pub largest_stiffness: f64,
}

/// Modulus of plane strain, E/(1 − ν²).
pub(super) fn plane_strain(modulus: f64) -> f64 {
    modulus / (1.0 - POISSON_RATIO * POISSON_RATIO)
}

/// Stiffness along the edge over that across it. A line load on a half-space dents it by 2(1 − ν²)P/(πE) ln(d/r) across the
/// line and shifts it by 2(1 + ν)Q/(πE) ln(d/r) along the line (Johnson, "Contact Mechanics", 1985, chapter 2).
pub(super) fn shear_share() -> f64 {
    1.0 - POISSON_RATIO
}

/// Stiffness along the flanks of both walls of a cut that stick to `area` of blade, N/m: of a round patch of radius a on a
/// half-space each, 8 G a/(2 − ν) (Mindlin 1949, in Johnson's chapter 7).
pub(super) fn flank_stiffness_n_per_m(modulus: f64, area: f64) -> f64 {
    let shear_modulus = modulus / (2.0 * (1.0 + POISSON_RATIO));
    2.0 * 8.0 * shear_modulus * (area / std::f64::consts::PI).sqrt() / (2.0 - POISSON_RATIO)
}

impl Walls {
    /// Force on the blade along z and moments about x and y at the knife's origin, for `area` of blade around `middle`.
    ///
    /// The blade is a rigid round punch of the same area on an elastic half-space (Johnson, "Contact Mechanics", 1985):
    /// force 2 E* a δ, moment (4/3) E* a³ θ. A bent blade presses only beyond its freedom.
    pub(super) fn wrench(&self, motion: &EdgeMotion, area: f64, middle: &Point2<f64>) -> [Vector3<f64>; 2] {
        if area <= 0.0 {
            return [Vector3::zeros(); 2];
        }
        let radius = (area / std::f64::consts::PI).sqrt();
        let modulus = plane_strain(self.modulus);
        let stiffness = (2.0 * modulus * radius).min(self.largest_stiffness);
        let turning = stiffness * radius * radius * (2.0 / 3.0);
        let deviation = motion.deviation_at(middle.x, middle.y);
        let beyond = deviation - deviation.clamp(-self.freedom, self.freedom);
        let limit = if self.yield_stress > 0.0 { self.yield_stress * area } else { f64::INFINITY };
        let force = (-stiffness * beyond).clamp(-limit, limit);
        let moment = limit * radius;
        let [tilt, yaw] = [motion.tilt_rad, motion.yaw_rad].map(|angle| (-turning * angle).clamp(-moment, moment));
        let arm = middle - motion.position;
        [Vector3::new(0.0, 0.0, force), Vector3::new(tilt + arm.y * force, yaw - arm.x * force, 0.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::Vector2;

    fn walls() -> Walls {
        Walls { modulus: 1e5, yield_stress: 0.0, freedom: 0.001, largest_stiffness: f64::INFINITY }
    }

    fn motion(lateral_m: f64, tilt_rad: f64, yaw_rad: f64) -> EdgeMotion {
        let still = EdgeMotion::translating(Point2::origin(), Vector2::zeros());
        EdgeMotion { lateral_m, tilt_rad, yaw_rad, ..still }
    }

    #[test]
    fn a_blade_is_free_for_a_millimeter_and_then_pushed_back() {
        let force = |lateral| walls().wrench(&motion(lateral, 0.0, 0.0), 1e-3, &Point2::origin())[0].z;
        assert_eq!(force(0.0009), 0.0);
        // 2 · 125 392 Pa · 17.841 mm · 1 mm by hand
        assert_relative_eq!(force(0.002), -4.4743, max_relative = 1e-3);
        assert_relative_eq!(force(-0.002), -force(0.002));
    }

    #[test]
    fn a_leaning_and_a_turned_blade_are_turned_back() {
        let moment = |tilt, yaw| walls().wrench(&motion(0.0, tilt, yaw), 1e-3, &Point2::origin())[1];
        assert!(moment(0.1, 0.0).x < 0.0 && moment(-0.1, 0.0).x > 0.0);
        assert!(moment(0.0, 0.1).y < 0.0);
        // 4/3 · 125 392 Pa · (17.841 mm)³ · 0.1 by hand
        assert_relative_eq!(moment(0.1, 0.0).x, -0.09494, max_relative = 1e-3);
    }

    #[test]
    fn a_yielding_food_bounds_the_force() {
        let soft = Walls { yield_stress: 1000.0, ..walls() };
        assert_relative_eq!(soft.wrench(&motion(0.01, 0.0, 0.0), 1e-3, &Point2::origin())[0].z, -1.0);
    }
}
