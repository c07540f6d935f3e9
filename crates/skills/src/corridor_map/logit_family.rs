//! The family of logit maps that exists for every motion: strictly increasing, exact at both ends, without singularity.
//!
//! Replaces the constants k, k_H and k_L of Proposition 1 by an offset that runs with the minimum-jerk law between the
//! ends.

use super::ends::share;
use super::logistic::{extended_logit, inside, logistic, logit};
use super::{CorridorMap, MotionEnds, check, check_delta};
use crate::corridor::Bounds;
use crate::error::SkillError;
use crate::time_law::minimum_jerk;

/// Most steps of the inverse: a handful is usual, and 60 halve the bracket of 1/S ≤ 1000 to the rounding of y.
const MOST_STEPS: usize = 60;
/// Step of Newton's method, relative to y, after which the next one would be below rounding, its convergence being
/// quadratic.
const CONVERGED: f64 = 1e-9;

/// Map x^u = (1 − a)·x + a·M + S·W·ℓ_δ(p) + b(t) with p = (x − x^L)/W, M the middle and W the width of the corridor.
///
/// b(t) = b0 + (bg − b0)·mj(t/T), with b0 and bg such that x^u = x at both ends. dx^u/dx = (1 − a) + S·ℓ_δ′(p) is
/// positive everywhere. From positions the continued logit ℓ_δ is used, which forgives samples outside the bounds; back
/// to positions its inverse is replaced by σ, which stays strictly inside. The two agree for p in [δ, 1 − δ].
#[derive(Debug, Clone, PartialEq)]
pub struct LogitFamily {
    blend: f64,
    strength: f64,
    delta: f64,
    start_offset: f64,
    goal_offset: f64,
}

impl LogitFamily {
    /// Builds the map with blend a in [0, 1], strength S from 0.001 to 1 and linear margin δ above 0 and at most 1/4
    /// for a motion.
    ///
    /// Every motion has one. The ends are also fixed points of [`CorridorMap::constrained`] if they lie at least δ
    /// inside.
    ///
    /// # Errors
    /// If an argument is outside its range, an end point is not finite or the corridor has no width at an end.
    pub fn new(blend: f64, strength: f64, delta: f64, ends: &MotionEnds) -> Result<Self, SkillError> {
        ends.check()?;
        check_delta(delta)?;
        check("blend", blend, (0.0..=1.0).contains(&blend), "a number from 0 to 1")?;
        check("strength", strength, (0.001..=1.0).contains(&strength), "a number from 0.001 to 1")?;
        let mut map = Self { blend, strength, delta, start_offset: 0.0, goal_offset: 0.0 };
        map.start_offset = ends.start - map.without_offset(&ends.start_bounds, ends.start);
        map.goal_offset = ends.goal - map.without_offset(&ends.goal_bounds, ends.goal);
        Ok(map)
    }

    /// Returns the offsets b0 and bg at start and goal, in the unit of the positions.
    #[must_use]
    pub fn offsets(&self) -> (f64, f64) {
        (self.start_offset, self.goal_offset)
    }

    fn offset(&self, progress: f64) -> f64 {
        self.start_offset + (self.goal_offset - self.start_offset) * minimum_jerk(progress)
    }

    fn without_offset(&self, bounds: &Bounds, x: f64) -> f64 {
        let (lower, upper) = (bounds.lower.position, bounds.upper.position);
        let bent = self.strength * (upper - lower) * extended_logit(share(bounds, x), self.delta);
        (1.0 - self.blend) * x + self.blend * 0.5 * (lower + upper) + bent
    }
}

impl CorridorMap for LogitFamily {
    fn unconstrained(&self, bounds: &Bounds, progress: f64, x: f64) -> f64 {
        self.without_offset(bounds, x) + self.offset(progress)
    }

    fn constrained(&self, bounds: &Bounds, progress: f64, unconstrained: f64) -> f64 {
        let (lower, upper) = (bounds.lower.position, bounds.upper.position);
        let fixed = (1.0 - self.blend) * lower + self.blend * 0.5 * (lower + upper) + self.offset(progress);
        let share = (unconstrained - fixed) / (upper - lower);
        inside(bounds, solve(1.0 - self.blend, self.strength, share))
    }
}

/// Solves c·σ(y) + S·y = u for y: Newton's method, kept within the bracket that 0 < σ < 1 gives.
fn solve(c: f64, strength: f64, u: f64) -> f64 {
    if c == 0.0 || !u.is_finite() {
        return u / strength;
    }
    let (mut low, mut high) = ((u - c) / strength, u / strength);
    // where S is small, σ(y) is about u/c inside the corridor
    let mut y = logit((u / c).clamp(0.01, 0.99)).clamp(low, high);
    for _ in 0..MOST_STEPS {
        let p = logistic(y);
        let residual = c * p + strength * y - u;
        if residual > 0.0 {
            high = y;
        } else {
            low = y;
        }
        let newton = y - residual / (c * p * (1.0 - p) + strength);
        if (newton - y).abs() <= CONVERGED * (1.0 + y.abs()) {
            return newton;
        }
        y = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
    }
    y
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    /// Roundings of p and y, magnified by the slope 1/δ of the logit.
    const ROUNDING: f64 = 1e-12;

    fn still(blend: f64, strength: f64) -> LogitFamily {
        let bounds = Bounds::still(0.0, 1.0);
        let ends = MotionEnds { start: 0.5, start_bounds: bounds, goal: 0.5, goal_bounds: bounds };
        LogitFamily::new(blend, strength, 0.02, &ends).unwrap()
    }

    #[test]
    fn the_middle_of_a_standing_corridor_has_the_slope_of_the_formula() {
        // M-form: S·4 = 1; proximal: 1 + S·4 = 1.2
        for (map, slope) in [(still(1.0, 0.25), 1.0), (still(0.0, 0.05), 1.2)] {
            let at = |x| map.unconstrained(&Bounds::still(0.0, 1.0), 0.3, x);
            assert_relative_eq!(at(0.5), 0.5, max_relative = ROUNDING);
            assert_relative_eq!((at(0.5 + 1e-5) - at(0.5 - 1e-5)) / 2e-5, slope, max_relative = 1e-8);
        }
    }

    #[test]
    fn the_proximal_map_returns_the_position_moved_by_the_barrier() {
        let expected = 0.9 + 0.05 * 9f64.ln();
        assert_relative_eq!(
            still(0.0, 0.05).unconstrained(&Bounds::still(0.0, 1.0), 0.0, 0.9),
            expected,
            max_relative = ROUNDING
        );
    }

    #[test]
    fn arguments_outside_their_range_are_refused_by_name() {
        let bounds = Bounds::still(0.0, 1.0);
        let ends = MotionEnds { start: 0.5, start_bounds: bounds, goal: 0.5, goal_bounds: bounds };
        let named = |blend, strength, delta| match LogitFamily::new(blend, strength, delta, &ends) {
            Err(SkillError::InvalidArgument { argument, .. }) => argument,
            other => panic!("{other:?}"),
        };
        assert_eq!([named(2.0, 0.1, 0.01), named(f64::NAN, 0.1, 0.01)], ["blend"; 2]);
        assert_eq!([named(0.0, 0.0, 0.01), named(0.0, f64::INFINITY, 0.01)], ["strength"; 2]);
        assert_eq!(named(0.0, 0.1, 0.5), "delta");
    }

    #[test]
    fn an_infinite_coordinate_lands_inside_and_one_that_is_no_number_stays_so() {
        let bounds = Bounds::still(0.0, 1.0);
        for map in [still(0.0, 0.05), still(0.5, 0.1), still(1.0, 0.25)] {
            for infinite in [f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN] {
                assert!(bounds.margin(map.constrained(&bounds, 0.5, infinite)) > 0.0);
            }
            assert!(map.constrained(&bounds, 0.5, f64::NAN).is_nan());
            assert!(map.unconstrained(&bounds, 0.5, f64::NAN).is_nan());
        }
    }

    proptest! {
        #[test]
        fn the_inverse_solves_its_equation(c in 0.0f64..1.0, strength in 0.001f64..1.0, u in -100.0f64..100.0) {
            let y = solve(c, strength, u);
            prop_assert!((c * logistic(y) + strength * y - u).abs() <= ROUNDING * (1.0 + u.abs()), "y = {y}");
        }
    }
}
