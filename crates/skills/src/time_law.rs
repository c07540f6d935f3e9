//! The minimum-jerk time law and the quintic transfer that generalizes it to a start in motion.
//!
//! The paper has no such law; the residual movement primitive, the time-linear offsets of the constraint maps and the
//! timing of free tool paths need one.
//!
//! Source: T. Flash and N. Hogan, "The coordination of arm movements: an experimentally confirmed mathematical model",
//! Journal of Neuroscience 5(7), 1985, doi:10.1523/JNEUROSCI.05-07-01688.1985.

/// Evaluates mj(r) = r³(10 − 15r + 6r²), the rest-to-rest path of least integrated squared jerk; 0 before r = 0, 1 after
/// r = 1.
///
/// `ratio` is time over duration, without unit.
#[must_use]
pub fn minimum_jerk(ratio: f64) -> f64 {
    let r = ratio.clamp(0.0, 1.0);
    r * r * r * (10.0 + r * (6.0 * r - 15.0))
}

/// Evaluates dmj/dr = 30r²(1 − r)²; 0 outside [0, 1].
#[must_use]
pub fn minimum_jerk_first_derivative(ratio: f64) -> f64 {
    let r = ratio.clamp(0.0, 1.0);
    30.0 * r * r * (1.0 - r) * (1.0 - r)
}

/// Evaluates d²mj/dr² = 60r(1 − r)(1 − 2r); 0 outside [0, 1].
#[must_use]
pub fn minimum_jerk_second_derivative(ratio: f64) -> f64 {
    let r = ratio.clamp(0.0, 1.0);
    60.0 * r * (1.0 - r) * (1.0 - 2.0 * r)
}

/// Position of one coordinate with its first two derivatives by the path parameter (time, or time over duration).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathState {
    /// Position.
    pub position: f64,
    /// First derivative of the position.
    pub first: f64,
    /// Second derivative of the position.
    pub second: f64,
}

/// Minimum-jerk transfer of one coordinate from any state to rest at a goal; from rest it is
/// x0 + (g − x0)·mj((r − r0)/D).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MinimumJerkTransfer {
    begin: f64,
    horizon: f64,
    goal: f64,
    // polynomial coefficients in (r − begin)/horizon
    coefficients: [f64; 6],
}

impl MinimumJerkTransfer {
    /// Plans from `state` at the parameter `begin` to rest at `goal` after `horizon` (> 0, same unit as `begin`).
    #[must_use]
    pub fn new(begin: f64, state: PathState, goal: f64, horizon: f64) -> Self {
        let distance = goal - state.position;
        let first = state.first * horizon;
        let second = state.second * horizon * horizon;
        let coefficients = [
            state.position,
            first,
            0.5 * second,
            10.0 * distance - 6.0 * first - 1.5 * second,
            -15.0 * distance + 8.0 * first + 1.5 * second,
            6.0 * distance - 3.0 * first - 0.5 * second,
        ];
        Self { begin, horizon, goal, coefficients }
    }

    /// Rests at `goal` for ever.
    #[must_use]
    pub fn resting(goal: f64) -> Self {
        Self { begin: 0.0, horizon: 1.0, goal, coefficients: [goal, 0.0, 0.0, 0.0, 0.0, 0.0] }
    }

    /// Evaluates the transfer at `parameter`: before the begin it holds the start, after the end it rests at the goal.
    #[must_use]
    pub fn at(&self, parameter: f64) -> PathState {
        let u = (parameter - self.begin) / self.horizon;
        if u >= 1.0 {
            return PathState { position: self.goal, first: 0.0, second: 0.0 };
        }
        let u = u.max(0.0);
        let [c0, c1, c2, c3, c4, c5] = self.coefficients;
        let position = c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))));
        let first = c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)));
        let second = 2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5));
        PathState { position, first: first / self.horizon, second: second / (self.horizon * self.horizon) }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use proptest::prelude::*;

    use super::*;

    /// A handful of roundings of numbers of order one.
    const ROUNDING: f64 = 1e-13;
    /// Error of a central difference with step 1e-5 of a function whose third derivative is at most 360.
    const DIFFERENCE: f64 = 1e-7;

    #[test]
    fn the_law_passes_its_midpoint_at_half_time_with_peak_speed() {
        assert_abs_diff_eq!(minimum_jerk(0.5), 0.5, epsilon = ROUNDING);
        assert_abs_diff_eq!(minimum_jerk_first_derivative(0.5), 1.875, epsilon = ROUNDING);
        assert_abs_diff_eq!(minimum_jerk_second_derivative(0.5), 0.0, epsilon = ROUNDING);
    }

    #[test]
    fn the_law_is_clamped_outside_its_duration() {
        for (ratio, value) in [(-3.0, 0.0), (0.0, 0.0), (1.0, 1.0), (7.0, 1.0)] {
            assert_eq!(minimum_jerk(ratio), value);
            assert_eq!(minimum_jerk_first_derivative(ratio), 0.0);
            assert_eq!(minimum_jerk_second_derivative(ratio), 0.0);
        }
    }

    #[test]
    fn a_transfer_from_rest_is_the_time_law() {
        let transfer = MinimumJerkTransfer::new(0.0, PathState { position: 2.0, ..PathState::default() }, 5.0, 1.0);
        for k in 0..=20 {
            let r = f64::from(k) / 20.0;
            let state = transfer.at(r);
            assert_abs_diff_eq!(state.position, 2.0 + 3.0 * minimum_jerk(r), epsilon = ROUNDING);
            assert_abs_diff_eq!(state.first, 3.0 * minimum_jerk_first_derivative(r), epsilon = ROUNDING);
            assert_abs_diff_eq!(state.second, 3.0 * minimum_jerk_second_derivative(r), epsilon = ROUNDING);
        }
    }

    #[test]
    fn a_resting_transfer_never_moves() {
        let rest = MinimumJerkTransfer::resting(4.0);
        for r in [-1.0, 0.0, 0.3, 1.0, 9.0] {
            assert_eq!(rest.at(r), PathState { position: 4.0, first: 0.0, second: 0.0 });
        }
    }

    proptest! {
        #[test]
        fn the_derivatives_are_those_of_the_law(r in 0.01f64..0.99) {
            let step = 1e-5;
            let first = (minimum_jerk(r + step) - minimum_jerk(r - step)) / (2.0 * step);
            let second = (minimum_jerk_first_derivative(r + step) - minimum_jerk_first_derivative(r - step))
                / (2.0 * step);
            prop_assert!((minimum_jerk_first_derivative(r) - first).abs() < DIFFERENCE);
            prop_assert!((minimum_jerk_second_derivative(r) - second).abs() < DIFFERENCE);
        }

        #[test]
        fn a_transfer_begins_in_its_state_and_ends_at_rest(
            position in -2.0f64..2.0, first in -2.0f64..2.0, second in -2.0f64..2.0, goal in -2.0f64..2.0,
            horizon in 0.3f64..2.0,
        ) {
            let state = PathState { position, first, second };
            let transfer = MinimumJerkTransfer::new(0.5, state, goal, horizon);
            let begin = transfer.at(0.5);
            prop_assert!((begin.position - position).abs() < ROUNDING);
            prop_assert!((begin.first - first).abs() < ROUNDING);
            prop_assert!((begin.second - second).abs() < ROUNDING);
            let end = transfer.at((0.5 + horizon) * (1.0 - 1e-12));
            prop_assert!((end.position - goal).abs() < 1e-9);
            prop_assert!(end.first.abs() < 1e-8);
            prop_assert!(end.second.abs() < 1e-7);
        }
    }
}
