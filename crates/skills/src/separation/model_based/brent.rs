//! Brent's minimization of a function of one variable between bounds.
//!
//! Source: R. P. Brent, "Algorithms for Minimization without Derivatives", Prentice-Hall 1973, chapter 5.

/// Most evaluations; golden sections alone shrink an interval by 1e-15 in 72.
const EVALUATIONS: usize = 100;
/// (3 − √5)/2, the smaller part of a golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Result of a minimization.
pub(super) struct Minimum {
    /// Where the least value was found.
    pub(super) argument: f64,
    /// Whether the tolerance was met before the evaluations ran out.
    pub(super) converged: bool,
}

/// Point with its value.
#[derive(Clone, Copy)]
struct Point {
    at: f64,
    value: f64,
}

/// Minimizes `function` in `bracket` (lower < upper, both > 0) to the relative error `tolerance` by parabolas through the
/// three best points, and golden sections where those do not help.
pub(super) fn minimize(function: impl Fn(f64) -> f64, bracket: (f64, f64), tolerance: f64) -> Minimum {
    let (mut lower, mut upper) = bracket;
    let evaluated = |at: f64| Point { at, value: function(at) };
    let mut best = evaluated(lower + GOLDEN * (upper - lower));
    let (mut second, mut third) = (best, best);
    // the last step and the one before it
    let (mut step, mut earlier) = (0.0f64, 0.0f64);
    for _ in 1..EVALUATIONS {
        let middle = 0.5 * (lower + upper);
        let least = tolerance * best.at / 3.0;
        if (best.at - middle).abs() + 0.5 * (upper - lower) <= 2.0 * least {
            return Minimum { argument: best.at, converged: true };
        }
        let parabolic = parabola_step(best, second, third).filter(|parabolic| {
            let target = best.at + parabolic;
            parabolic.abs() < 0.5 * earlier.abs() && target > lower && target < upper
        });
        (earlier, step) = match parabolic {
            Some(parabolic) => {
                let target = best.at + parabolic;
                let near_bound = target - lower < 2.0 * least || upper - target < 2.0 * least;
                (step, if near_bound { least.copysign(middle - best.at) } else { parabolic })
            }
            None => {
                let longer = if best.at < middle { upper - best.at } else { lower - best.at };
                (longer, GOLDEN * longer)
            }
        };
        // never closer to the best point than rounding can tell
        let moved = if step.abs() < least { least.copysign(step) } else { step };
        let trial = evaluated(best.at + moved);
        if trial.value <= best.value {
            if trial.at < best.at {
                upper = best.at
            } else {
                lower = best.at
            }
            (third, second, best) = (second, best, trial);
        } else {
            if trial.at < best.at {
                lower = trial.at
            } else {
                upper = trial.at
            }
            if trial.value <= second.value || second.at == best.at {
                (third, second) = (second, trial);
            } else if trial.value <= third.value || third.at == best.at || third.at == second.at {
                third = trial;
            }
        }
    }
    Minimum { argument: best.at, converged: false }
}

// step from the best point to the vertex of the parabola through three points; nothing if they lie on a line
fn parabola_step(best: Point, second: Point, third: Point) -> Option<f64> {
    let r = (best.at - second.at) * (best.value - third.value);
    let q = (best.at - third.at) * (best.value - second.value);
    let numerator = (best.at - third.at) * q - (best.at - second.at) * r;
    let step = numerator / (2.0 * (r - q));
    step.is_finite().then_some(step)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn the_vertex_of_a_parabola_is_found() {
        let minimum = minimize(|x| (x - 2.5).powi(2), (1.0, 7.0), 1e-9);
        assert!(minimum.converged);
        assert_relative_eq!(minimum.argument, 2.5, max_relative = 1e-8);
    }

    #[test]
    fn a_kink_is_found_by_golden_sections() {
        let minimum = minimize(|x| (x - 1.7).abs(), (1.0, 7.0), 1e-9);
        assert!(minimum.converged);
        assert_relative_eq!(minimum.argument, 1.7, max_relative = 1e-8);
    }

    #[test]
    fn a_minimum_at_a_bound_is_approached() {
        for (slope, bound) in [(1.0, 1.0), (-1.0, 7.0)] {
            let minimum = minimize(|x| slope * x, (1.0, 7.0), 1e-9);
            assert!(minimum.converged);
            assert_relative_eq!(minimum.argument, bound, max_relative = 1e-8);
        }
    }

    #[test]
    fn a_function_without_order_ends() {
        assert!(!minimize(|_| f64::NAN, (1.0, 7.0), 1e-15).argument.is_nan());
    }
}
