//! Integrals over an outline's area: what a body of that outline weighs and how hard it is to turn.

use nalgebra::{Point2, Vector2};

use super::{Outline, edges};

impl Outline {
    /// Area, m².
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        match self {
            Self::Disc { radius_m } => std::f64::consts::PI * radius_m * radius_m,
            Self::Box { width_m, height_m } => width_m * height_m,
            Self::Polygon { vertices_m } => edges(vertices_m).map(|(a, b)| 0.5 * a.coords.perp(&b.coords)).sum(),
        }
    }

    /// Polar second moment of area about the centroid divided by the area, m²: moment of inertia per unit of mass.
    #[must_use]
    pub fn inertia_per_mass_m2(&self) -> f64 {
        match self {
            Self::Disc { radius_m } => 0.5 * radius_m * radius_m,
            Self::Box { width_m, height_m } => (width_m * width_m + height_m * height_m) / 12.0,
            Self::Polygon { vertices_m } => {
                let about_origin: f64 = edges(vertices_m)
                    .map(|(a, b)| {
                        let (a, b) = (a.coords, b.coords);
                        a.perp(&b) * (a.dot(&a) + a.dot(&b) + b.dot(&b)) / 12.0
                    })
                    .sum();
                about_origin / self.area_m2() - self.centroid().coords.norm_squared()
            }
        }
    }

    /// Centroid in the outline's own frame, m.
    #[must_use]
    pub fn centroid(&self) -> Point2<f64> {
        match self {
            Self::Disc { .. } | Self::Box { .. } => Point2::origin(),
            Self::Polygon { vertices_m } => {
                let sum: Vector2<f64> =
                    edges(vertices_m).map(|(a, b)| (a.coords + b.coords) * a.coords.perp(&b.coords) / 6.0).sum();
                Point2::from(sum / self.area_m2())
            }
        }
    }

    /// Mean distance of the area's points from the centroid, m: the lever of friction against spinning in place.
    #[must_use]
    pub fn mean_radius_m(&self) -> f64 {
        match self {
            Self::Disc { radius_m } => 2.0 / 3.0 * radius_m,
            Self::Box { .. } | Self::Polygon { .. } => {
                let center = self.centroid();
                let corners = self.drawing(0);
                edges(&corners).map(|(a, b)| radius_integral(&(a - center), &(b - center))).sum::<f64>()
                    / self.area_m2()
            }
        }
    }
}

/// Integral of the distance from the origin over the triangle (origin, a, b), signed by its orientation, m³.
fn radius_integral(a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    let edge = b - a;
    let height = a.perp(b) / edge.norm();
    let height_abs = height.abs();
    if height_abs <= 0.0 {
        return 0.0;
    }
    // in polar form: h³/3 times the integral of sec³ between the ends' angles from the foot of the height
    let primitive = |along: f64| {
        let tan = along / height_abs;
        // ln(tan + sec), exact for a far end on either side
        0.5 * (tan * tan.hypot(1.0) + tan.asinh())
    };
    let (from, to) = (a.dot(&edge) / edge.norm(), b.dot(&edge) / edge.norm());
    height * height_abs * height_abs / 3.0 * (primitive(to) - primitive(from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn mean_radius_matches_closed_forms() {
        // square of side a: 0.3826 a
        assert_relative_eq!(
            Outline::Box { width_m: 0.04, height_m: 0.04 }.mean_radius_m(),
            0.382_597_858 * 0.04,
            epsilon = 1e-9
        );
        let many =
            (0..720).map(|k| (std::f64::consts::TAU * f64::from(k) / 720.0).sin_cos()).map(|(s, c)| [c, s]).collect();
        assert_relative_eq!(Outline::Polygon { vertices_m: many }.mean_radius_m(), 2.0 / 3.0, epsilon = 1e-4);
    }

    #[test]
    fn the_mean_radius_of_a_bar_is_a_quarter_of_its_length_however_thin() {
        for height_m in [1e-6, 1e-9, 1e-12] {
            // what the height adds is of second order
            assert_relative_eq!(Outline::Box { width_m: 1.0, height_m }.mean_radius_m(), 0.25, epsilon = 1e-6);
        }
    }

    #[test]
    fn a_shifted_polygon_keeps_its_inertia_about_the_centroid() {
        let shifted = Outline::Polygon { vertices_m: vec![[4.0, 6.0], [6.0, 6.0], [6.0, 8.0], [4.0, 8.0]] };
        assert_relative_eq!(shifted.centroid(), Point2::new(5.0, 7.0), epsilon = 1e-12);
        assert_relative_eq!(shifted.inertia_per_mass_m2(), 8.0 / 12.0, epsilon = 1e-12);
    }
}
