//! The least cost that is still to come: the way to the goal if nothing stood in it.

use nalgebra::Vector2;

/// Directions in which a tool can push, and what changing between them costs.
#[derive(Debug, Clone)]
pub(super) struct CostToGo {
    directions: Vec<Vector2<f64>>,
    switch_cost_m: f64,
    /// What may be left of the way at the goal, m.
    tolerance_m: f64,
}

/// Directions that agree within this sine are one.
const SAME: f64 = 1e-9;

impl CostToGo {
    pub(super) fn new(directions: Vec<Vector2<f64>>, switch_cost_m: f64, tolerance_m: f64) -> Self {
        Self { directions, switch_cost_m, tolerance_m: tolerance_m + 1e-9 }
    }

    /// Bounds from below the cost of moving by `left` (m) with direction `now` in hold: length, and switches.
    ///
    /// A shortest way among given directions uses at most two of them, and of those that a way uses the two need no more
    /// switches than the way has: pairs are enough. What may be left at the goal is taken from each length, as far as it
    /// can be. Infinite if no pushes lead there.
    pub(super) fn at(&self, left: &Vector2<f64>, now: usize) -> f64 {
        if left.norm() <= self.tolerance_m {
            return 0.0;
        }
        let mut least = f64::INFINITY;
        for (a, along) in self.directions.iter().enumerate() {
            let switches = f64::from(u8::from(a != now)) * self.switch_cost_m;
            if left.perp(along).abs() <= self.tolerance_m && left.dot(along) >= -self.tolerance_m {
                least = least.min((left.dot(along) - self.tolerance_m).max(0.0) + switches);
            }
            for (b, other) in self.directions.iter().enumerate().skip(a + 1) {
                least = least.min(self.by_pair(left, (a, along), (b, other), now));
            }
        }
        least
    }

    fn by_pair(&self, left: &Vector2<f64>, a: (usize, &Vector2<f64>), b: (usize, &Vector2<f64>), now: usize) -> f64 {
        let sine = a.1.perp(b.1);
        if sine.abs() <= SAME {
            return f64::INFINITY;
        }
        let lengths = [left.perp(b.1) / sine, -left.perp(a.1) / sine];
        let slack_m = self.tolerance_m / sine.abs();
        if lengths.iter().any(|length| *length < -slack_m) {
            return f64::INFINITY;
        }
        let needed = |length: f64, index: usize| {
            let switch = if length > slack_m && index != now { self.switch_cost_m } else { 0.0 };
            (length - slack_m).max(0.0) + switch
        };
        needed(lengths[0], a.0) + needed(lengths[1], b.0)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn three() -> CostToGo {
        CostToGo::new(vec![-Vector2::y(), -Vector2::x(), Vector2::y()], 0.06, 0.0)
    }

    /// Slack of the bound: a nanometer for rounding in each term.
    const ROUNDING_M: f64 = 1e-8;

    #[test]
    fn the_way_of_two_directions_is_the_sum_of_its_legs_and_switches() {
        let left = Vector2::new(-0.115, 0.03);
        for (now, switches) in [(0, 2.0), (1, 1.0), (2, 1.0)] {
            let expected = 0.145 + switches * 0.06;
            assert!((three().at(&left, now) - expected).abs() < ROUNDING_M, "{now}: {}", three().at(&left, now));
        }
        assert!((three().at(&-Vector2::x(), 1) - 1.0).abs() < ROUNDING_M);
    }

    #[test]
    fn what_no_push_leads_to_costs_infinitely_much() {
        assert_eq!(three().at(&Vector2::x(), 0), f64::INFINITY);
        assert_eq!(three().at(&Vector2::zeros(), 0), 0.0);
    }

    proptest! {
        #[test]
        fn no_way_costs_less_than_its_bound(
            angles in prop::collection::vec(0.0f64..6.3, 1..5), runs in prop::collection::vec((0usize..5, 0.0f64..0.1), 1..6),
            now in 0usize..5, tolerance_m in 0.0f64..0.01, off in (0.0f64..6.3, 0.0f64..1.0),
        ) {
            let directions: Vec<_> = angles.iter().map(|angle| Vector2::new(angle.cos(), angle.sin())).collect();
            let (switch_cost_m, now) = (0.06, now % directions.len());
            let (mut held, mut left, mut cost) = (now, Vector2::new(off.0.cos(), off.0.sin()) * off.1 * tolerance_m, 0.0);
            for (index, length) in runs {
                let index = index % directions.len();
                cost += length + if index == held { 0.0 } else { switch_cost_m };
                held = index;
                left += directions[index] * length;
            }
            let bound = CostToGo::new(directions, switch_cost_m, tolerance_m).at(&left, now);
            prop_assert!(bound <= cost + ROUNDING_M, "{bound} of {cost}");
        }
    }
}
