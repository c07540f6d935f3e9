//! End points of a motion and the bounds there, which fix the constants of a map, and the choice of its linear margin.

use super::check;
use crate::corridor::Bounds;
use crate::error::SkillError;

/// Range of the linear margin, as a share of the width: below it noise is magnified by more than 100/W, above it a
/// tenth of the corridor at either bound is no longer mapped by the logit.
const DELTA: (f64, f64) = (0.01, 0.1);
/// Standard deviations of the noise that the linear margin holds.
const NOISE_BAND: f64 = 3.0;

/// End points x0 and g of one coordinate of a motion, with the bounds at either.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionEnds {
    /// Start x0.
    pub start: f64,
    /// Bounds x0^L, x0^H at the start.
    pub start_bounds: Bounds,
    /// Goal g.
    pub goal: f64,
    /// Bounds xg^L, xg^H at the goal.
    pub goal_bounds: Bounds,
}

impl MotionEnds {
    /// Returns p0 and pg, the shares (x − x^L)/W of the width at which the ends lie; inside the bounds between 0 and 1.
    #[must_use]
    pub fn shares(&self) -> (f64, f64) {
        (share(&self.start_bounds, self.start), share(&self.goal_bounds, self.goal))
    }

    /// Returns the widths W0 and Wg at start and goal.
    #[must_use]
    pub fn widths(&self) -> (f64, f64) {
        (self.start_bounds.width().position, self.goal_bounds.width().position)
    }

    /// Returns the smaller distance of an end from its nearer bound, as a share of the width; not positive if an end is
    /// on or outside a bound.
    #[must_use]
    pub fn clearance(&self) -> f64 {
        let (start, goal) = self.shares();
        start.min(1.0 - start).min(goal).min(1.0 - goal)
    }

    /// Chooses δ, the share of the width next to each bound in which the logit is continued by its tangent:
    /// δ = clamp(3σ/W, 0.01, 0.1), but no more than the clearance of the ends as long as that exceeds σ/W.
    ///
    /// Noise of standard deviation `noise` (≥ 0, unit of the positions) then grows by at most 1/(δ(1 − δ)W), W being
    /// `narrowest` (> 0), the least width of the corridor during the motion. The second clause keeps δ off the ends, so
    /// that they are generated as they were shown; an end that is nearer to its bound than the noise is kept to within
    /// the noise.
    #[must_use]
    pub fn delta(&self, noise: f64, narrowest: f64) -> f64 {
        let (smallest, largest) = DELTA;
        let relative = noise / narrowest;
        let chosen = (NOISE_BAND * relative).clamp(smallest, largest);
        let clearance = self.clearance();
        if clearance > 0.0 { chosen.min(clearance.max(relative)) } else { chosen }
    }

    /// Checks that both ends are finite and both corridors have a width.
    pub(super) fn check(&self) -> Result<(), SkillError> {
        let (start_width, goal_width) = self.widths();
        for (argument, found) in [("start", self.start), ("goal", self.goal)] {
            check(argument, found, found.is_finite(), "a finite number")?;
        }
        for (argument, found) in [("start_width", start_width), ("goal_width", goal_width)] {
            check(
                argument,
                found,
                found > 0.0 && found.is_finite(),
                "an upper bound above the lower one, both finite",
            )?;
        }
        Ok(())
    }
}

/// Returns p = (x − x^L)/W.
pub(super) fn share(bounds: &Bounds, x: f64) -> f64 {
    (x - bounds.lower.position) / (bounds.upper.position - bounds.lower.position)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(start: f64, goal: f64) -> MotionEnds {
        MotionEnds { start, start_bounds: Bounds::still(0.0, 2.0), goal, goal_bounds: Bounds::still(0.0, 1.0) }
    }

    #[test]
    fn delta_holds_three_standard_deviations_within_its_range() {
        let inside = ends(1.0, 0.5);
        assert_eq!(inside.delta(0.0, 1.0), 0.01);
        assert_eq!(inside.delta(0.02, 2.0), 0.03);
        assert_eq!(inside.delta(5.0, 1.0), 0.1);
    }

    #[test]
    fn delta_stays_off_the_ends_unless_the_noise_reaches_them() {
        assert_eq!(ends(1.0, 0.005).clearance(), 0.005);
        assert_eq!(ends(1.0, 0.005).delta(0.0, 1.0), 0.005);
        assert_eq!(ends(1.0, 0.005).delta(0.01, 1.0), 0.01);
        assert_eq!(ends(1.0, -0.2).delta(0.01, 1.0), 0.03);
    }
}
