//! Exact conditions under which the constants of Proposition 1 keep what the paper claims: k > 0 and 0 < k_H < 1.
//!
//! Proposition 1 claims k_H, k_L in (0, 1) for every motion. That holds for equal widths and for ends on opposite sides
//! of the middle; else it depends on the widths.

use super::MotionEnds;
use super::logistic::logit;

/// What is wrong with the constants of Proposition 1 for a motion, without computing them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Validity {
    /// k is zero or infinite: no map, or the range of x^u collapses.
    pub singular: bool,
    /// k < 0: the map turns the coordinate round.
    pub reversing: bool,
    /// k_H, and with it k_L = 1 − k_H, is not inside (0, 1).
    pub offset_outside: bool,
}

impl Validity {
    /// Judges a motion whose ends lie strictly inside their bounds.
    ///
    /// For ends on one side of the middle (mirrored to p > ½ if need be) let the far end be the one of larger p, and
    /// q = (ℓ_far/W_far)/(ℓ_near/W_near) with ℓ = logit p. Then k < 0 ⇔ q < 1, and k_H is outside (0, 1)
    /// ⇔ (1 − p_far)/(1 − p_near) ≤ q ≤ p_far/p_near. For p_far = p_near, or q = 1, k is infinite or zero.
    #[must_use]
    pub fn of(ends: &MotionEnds) -> Self {
        let ((p0, pg), (start_width, goal_width)) = (ends.shares(), ends.widths());
        // a secant of σ, or of one point of it
        let secant = start_width == goal_width || (p0 - 0.5) * (pg - 0.5) <= 0.0 && p0 != pg;
        if secant {
            return Self::default();
        }
        if p0 == pg {
            return Self { singular: true, ..Self::default() };
        }
        let mirrored = |p: f64| if p0 < 0.5 { 1.0 - p } else { p };
        let (start, goal) = ((mirrored(p0), start_width), (mirrored(pg), goal_width));
        let ((far, far_width), (near, near_width)) = if start.0 > goal.0 { (start, goal) } else { (goal, start) };
        let q = (logit(far) / far_width) / (logit(near) / near_width);
        let offset_outside = q >= (1.0 - far) / (1.0 - near) && q <= far / near;
        Self { singular: q == 1.0, reversing: q < 1.0, offset_outside }
    }

    /// Tells whether the constants are as the paper claims.
    #[must_use]
    pub fn holds(self) -> bool {
        self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::corridor::Bounds;

    fn of(p0: f64, start_width: f64, pg: f64, goal_width: f64) -> Validity {
        Validity::of(&MotionEnds {
            start: p0 * start_width,
            start_bounds: Bounds::still(0.0, start_width),
            goal: pg * goal_width,
            goal_bounds: Bounds::still(0.0, goal_width),
        })
    }

    #[test]
    fn equal_widths_and_opposite_sides_are_always_valid() {
        assert!(of(0.9, 1.0, 0.95, 1.0).holds());
        assert!(of(0.75, 1.0, 0.75, 1.0).holds());
        assert!(of(0.25, 1.0, 0.75, 4.0).holds());
        assert!(of(0.5, 1.0, 0.75, 4.0).holds());
        assert!(of(0.25, 1.0, 0.5, 4.0).holds());
    }

    #[test]
    fn a_far_end_in_a_much_wider_corridor_reverses_the_map() {
        // ℓ(0.75) = ln 3 and ℓ(0.9) = 2 ln 3: the turning point is a width ratio of 2
        assert!(!of(0.75, 1.0, 0.9, 1.75).reversing);
        assert!(of(0.75, 1.0, 0.9, 2.25).reversing);
        assert!(of(0.25, 1.0, 0.1, 2.25).reversing);
    }

    #[test]
    fn equal_shares_of_unequal_widths_have_no_map() {
        assert_eq!(of(0.75, 1.0, 0.75, 2.0), Validity { singular: true, ..Validity::default() });
        assert!(of(0.5, 1.0, 0.5, 2.0).singular);
    }
}
