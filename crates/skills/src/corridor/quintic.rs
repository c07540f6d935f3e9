//! Quintic pieces: their value, and a certified least value by their Bernstein coefficients.

use crate::time_law::PathState;

/// Part of the largest coefficient to which a least value is tight.
const TIGHTNESS: f64 = 1e-9;
/// Most halvings of a piece; the hull of the coefficients closes by four with each.
const MOST_HALVINGS: u32 = 24;

/// Evaluates at u = t/h in [0, 1] the quintic that meets both states.
pub(crate) fn quintic(from: PathState, to: PathState, h: f64, u: f64) -> PathState {
    // what is left at the end of the parabola that leaves `from`, in units of the whole piece
    let (v, a) = (from.first * h, from.second * h * h);
    let position = to.position - (from.position + v + 0.5 * a);
    let first = to.first * h - (v + a);
    let second = to.second * h * h - a;
    let c3 = 10.0 * position - 4.0 * first + 0.5 * second;
    let c4 = -15.0 * position + 7.0 * first - second;
    let c5 = 6.0 * position - 3.0 * first + 0.5 * second;
    PathState {
        position: from.position + u * (v + u * (0.5 * a + u * (c3 + u * (c4 + u * c5)))),
        first: (v + u * (a + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))) / h,
        second: (a + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))) / (h * h),
    }
}

/// Finds the least value below `known` of the quintic of duration `h` that meets both states, and its time after the
/// begin; nothing if it is not below.
///
/// The value is a lower bound of the quintic up to rounding: a polynomial lies in the convex hull of its Bernstein
/// coefficients. Halving the piece closes the hull until bound and attained value differ by 1e-9 of the largest
/// coefficient. A value that is not finite counts as −∞.
pub(crate) fn least_value(from: PathState, to: PathState, h: f64, known: f64) -> Option<(f64, f64)> {
    let (v0, a0) = (from.first * h / 5.0, from.second * h * h / 20.0);
    let (v1, a1) = (to.first * h / 5.0, to.second * h * h / 20.0);
    let coefficients = [
        from.position,
        from.position + v0,
        from.position + 2.0 * v0 + a0,
        to.position - 2.0 * v1 + a1,
        to.position - v1,
        to.position,
    ];
    if coefficients.iter().any(|c| !c.is_finite()) {
        return Some((f64::NEG_INFINITY, 0.0));
    }
    let largest = coefficients.iter().fold(0.0, |largest: f64, c| largest.max(c.abs()));
    let mut search = Search { tolerance: TIGHTNESS * largest, least: known, at: None };
    search.descend(coefficients, 0.0, 1.0, MOST_HALVINGS);
    search.at.map(|u| (search.least, u * h))
}

struct Search {
    tolerance: f64,
    least: f64,
    at: Option<f64>,
}

impl Search {
    fn descend(&mut self, coefficients: [f64; 6], begin: f64, end: f64, halvings: u32) {
        let hull = coefficients.iter().copied().fold(f64::INFINITY, f64::min);
        if hull >= self.least {
            return;
        }
        let [first, .., last] = coefficients;
        if first.min(last) - hull <= self.tolerance || halvings == 0 {
            self.least = hull;
            self.at = Some(if first <= last { begin } else { end });
            return;
        }
        let (left, right) = halve(coefficients);
        let middle = 0.5 * (begin + end);
        // the lower end first, so that the other half is cut off sooner
        if first <= last {
            self.descend(left, begin, middle, halvings - 1);
            self.descend(right, middle, end, halvings - 1);
        } else {
            self.descend(right, middle, end, halvings - 1);
            self.descend(left, begin, middle, halvings - 1);
        }
    }
}

/// Divides a Bernstein polynomial at its middle (de Casteljau).
fn halve(coefficients: [f64; 6]) -> ([f64; 6], [f64; 6]) {
    let (mut left, mut right, mut row) = (coefficients, coefficients, coefficients);
    for level in 1..6 {
        for k in 0..6 - level {
            row[k] = 0.5 * (row[k] + row[k + 1]);
        }
        left[level] = row[0];
        right[5 - level] = row[5 - level];
    }
    (left, right)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn state() -> impl Strategy<Value = PathState> {
        (-1.0..1.0f64, -10.0..10.0f64, -100.0..100.0f64).prop_map(|(position, first, second)| PathState {
            position,
            first,
            second,
        })
    }

    #[test]
    fn a_value_that_is_not_below_is_not_reported() {
        let still = PathState { position: 1.0, ..PathState::default() };
        assert_eq!(least_value(still, still, 1.0, 1.0), None);
        assert_eq!(least_value(still, still, 1.0, 2.0), Some((1.0, 0.0)));
    }

    #[test]
    fn a_number_that_is_none_is_never_certified() {
        let bad = PathState { position: 1.0, first: f64::NAN, second: 0.0 };
        assert_eq!(least_value(bad, bad, 1.0, 0.0), Some((f64::NEG_INFINITY, 0.0)));
    }

    proptest! {
        #[test]
        fn the_least_value_bounds_a_dense_scan_from_below_and_tightly(from in state(), to in state(), h in 0.01..2.0f64) {
            let (least, at) = least_value(from, to, h, f64::INFINITY).unwrap();
            let scale = 1.0 + 10.0 * h + 100.0 * h * h;
            let scan = |u: f64| quintic(from, to, h, u).position;
            let lowest = (0..=2000).map(|k| scan(f64::from(k) / 2000.0)).fold(f64::INFINITY, f64::min);
            // the scan is the less exact of the two: it may miss the least value by curvature · (h/4000)²
            prop_assert!(least <= lowest + 1e-12 * scale);
            prop_assert!(lowest - least <= 1e-4 * scale);
            prop_assert!((scan(at / h) - least).abs() <= 1e-8 * scale);
        }
    }
}
