//! The logistic function σ of Eq. (16), its inverse the logit, and the logit continued beyond the bounds.

use crate::corridor::Bounds;

/// Evaluates σ(y) = 1/(1 + e^{−y}) without overflow.
#[must_use]
pub fn logistic(y: f64) -> f64 {
    let small = (-y.abs()).exp();
    if y < 0.0 { small / (1.0 + small) } else { 1.0 / (1.0 + small) }
}

/// Evaluates logit(p) = ln(p/(1 − p)), the inverse of σ; not finite outside (0, 1).
#[must_use]
pub fn logit(p: f64) -> f64 {
    (p / (1.0 - p)).ln()
}

/// Evaluates ℓ_δ(p): the logit on [δ, 1 − δ], its tangent of slope 1/(δ(1 − δ)) outside.
///
/// Strictly increasing and finite for every finite p. It is C¹: where a motion crosses p = δ or 1 − δ, the first
/// derivative by time stays continuous and the second one jumps by (1 − 2δ)/(δ(1 − δ))²·ṗ².
#[must_use]
pub fn extended_logit(p: f64, delta: f64) -> f64 {
    let slope = 1.0 / (delta * (1.0 - delta));
    if p < delta {
        logit(delta) + (p - delta) * slope
    } else if p > 1.0 - delta {
        -logit(delta) + (p - (1.0 - delta)) * slope
    } else {
        logit(p)
    }
}

/// Evaluates x = x^L + Wσ(y), kept strictly inside the bounds where rounding would put it on one; NaN for NaN.
pub(super) fn inside(bounds: &Bounds, y: f64) -> f64 {
    if y.is_nan() {
        return y;
    }
    let (lower, upper) = (bounds.lower.position, bounds.upper.position);
    // from the nearer bound, so that the distance to it keeps its digits
    let share = logistic(-y.abs());
    let x = if y < 0.0 { lower + (upper - lower) * share } else { upper - (upper - lower) * share };
    x.max(lower.next_up()).min(upper.next_down())
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    /// Rounding of 1 − σ(y), magnified by the slope e^5 of the logit at y = 5.
    const ROUNDING: f64 = 1e-13;

    #[test]
    fn the_logistic_function_neither_overflows_nor_loses_its_tail() {
        assert_eq!((logistic(0.0), logistic(1e4), logistic(-1e4)), (0.5, 1.0, 0.0));
        assert_relative_eq!(logistic(-700.0), (-700f64).exp(), max_relative = ROUNDING);
    }

    #[test]
    fn the_logit_is_met_with_value_and_slope_where_its_tangent_begins() {
        let (delta, step) = (0.02, 1e-9);
        for edge in [delta, 1.0 - delta] {
            let [before, at, after] = [edge - step, edge, edge + step].map(|p| extended_logit(p, delta));
            assert_relative_eq!(at, logit(edge), max_relative = ROUNDING);
            assert_relative_eq!(after - at, at - before, max_relative = 1e-5);
        }
    }

    #[test]
    fn the_second_derivative_jumps_at_the_margin_by_the_curvature_of_the_logit() {
        let (delta, step) = (0.02, 1e-5);
        let curvature = |p: f64| {
            let [before, at, after] = [p - step, p, p + step].map(|p| extended_logit(p, delta));
            (before - 2.0 * at + after) / (step * step)
        };
        let jump = (1.0 - 2.0 * delta) / (delta * (1.0 - delta)).powi(2);
        assert_relative_eq!(curvature(delta + 2.0 * step), -jump, max_relative = 5e-3);
        assert_relative_eq!(curvature(delta - 2.0 * step), 0.0, epsilon = 1e-3);
    }

    #[test]
    fn a_position_is_strictly_inside_where_the_logistic_function_rounds_to_a_bound() {
        let bounds = Bounds::still(1e3, 1e3 + 1e-3);
        for y in [f64::INFINITY, 1e3, 40.0, -40.0, -1e3, f64::NEG_INFINITY] {
            assert!(bounds.margin(inside(&bounds, y)) > 0.0, "{y}");
        }
        assert!(inside(&bounds, f64::NAN).is_nan());
    }

    proptest! {
        #[test]
        fn logistic_and_logit_are_inverse(y in -5.0f64..5.0) {
            prop_assert!((logit(logistic(y)) - y).abs() < ROUNDING);
        }
    }
}
