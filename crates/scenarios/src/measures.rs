//! Measures that several tasks share: paths, deviations, smoothness.

use nalgebra::{Point2, Vector2};

/// Length of a path, m.
#[must_use]
pub fn path_length_m(path: &[Point2<f64>]) -> f64 {
    path.iter().zip(path.iter().skip(1)).map(|(a, b)| (b - a).norm()).sum()
}

/// Distance of a point from a polyline, m; `None` for an empty one.
#[must_use]
pub fn distance_to_path_m(point: &Point2<f64>, path: &[Point2<f64>]) -> Option<f64> {
    let to_leg = |(a, b): (&Point2<f64>, &Point2<f64>)| {
        let leg = b - a;
        let share =
            if leg.norm_squared() > 0.0 { ((point - a).dot(&leg) / leg.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
        (point - (a + leg * share)).norm()
    };
    let first = path.first().map(|only| (point - only).norm());
    path.iter().zip(path.iter().skip(1)).map(to_leg).chain(first).min_by(f64::total_cmp)
}

/// Root mean square and maximum; zero for no values.
#[must_use]
pub fn rms_and_max(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (count, squares, largest) = values.fold((0.0, 0.0, 0.0_f64), |(count, squares, largest), value| {
        (count + 1.0, squares + value * value, largest.max(value.abs()))
    });
    if count > 0.0 { ((squares / count).sqrt(), largest) } else { (0.0, 0.0) }
}

/// Log dimensionless jerk of a motion on a uniform grid: −ln(T³/v_peak² ∫|jerk|² dt); −5.32 for a minimum-jerk movement.
///
/// Balasubramanian, Melendez-Calderon and Burdet 2012. `None` for fewer than five samples or a motion at rest.
#[must_use]
pub fn log_dimensionless_jerk(path: &[Point2<f64>], time_step_s: f64) -> Option<f64> {
    let differences = |values: &[Vector2<f64>]| -> Vec<Vector2<f64>> {
        values.iter().zip(values.iter().skip(1)).map(|(a, b)| (b - a) / time_step_s).collect()
    };
    let places: Vec<Vector2<f64>> = path.iter().map(|point| point.coords).collect();
    let velocity = differences(&places);
    let jerk = differences(&differences(&velocity));
    let duration_s = time_step_s * path.len().checked_sub(1)? as f64;
    let peak = velocity.iter().map(Vector2::norm).fold(0.0, f64::max);
    if jerk.len() < 2 || peak <= 0.0 {
        return None;
    }
    let integral: f64 = jerk.iter().map(|jerk| jerk.norm_squared() * time_step_s).sum();
    Some(-(duration_s.powi(3) / (peak * peak) * integral).ln()).filter(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use skills::time_law::minimum_jerk;

    #[test]
    fn a_minimum_jerk_movement_has_its_known_smoothness() {
        let path: Vec<_> = (0..=2000).map(|k| Point2::new(0.1 * minimum_jerk(f64::from(k) / 2000.0), 0.0)).collect();
        // ∫ jerk² = 720 L²/T⁵ and v_peak = 1.875 L/T: −ln(720/1.875²)
        let expected = -(720.0_f64 / (1.875 * 1.875)).ln();
        assert_relative_eq!(log_dimensionless_jerk(&path, 0.001).unwrap(), expected, epsilon = 0.01);
    }

    #[test]
    fn distances_are_to_the_nearest_leg() {
        let path = [Point2::origin(), Point2::new(1.0, 0.0), Point2::new(1.0, 1.0)];
        assert_relative_eq!(distance_to_path_m(&Point2::new(0.5, -0.25), &path).unwrap(), 0.25);
        assert_relative_eq!(distance_to_path_m(&Point2::new(2.0, 2.0), &path).unwrap(), 2.0_f64.sqrt());
        assert_relative_eq!(path_length_m(&path), 2.0);
    }
}
