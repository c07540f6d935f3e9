//! Phases: runs of pushes with one hold, and the settling of their lengths on the goal.

use nalgebra::{Matrix2, Point2, Vector2};

use super::holds::Hold;

/// A run of pushes with one hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// The hold.
    pub hold: Hold,
    /// Where the object's center begins, world frame.
    pub from_world: Point2<f64>,
    /// Where it ends, world frame.
    pub to_world: Point2<f64>,
}

/// Phases from start to goal.
#[derive(Debug, Clone, PartialEq)]
pub struct Phases {
    /// The phases in their order, at least one.
    pub phases: Vec<Phase>,
    /// Cost of the way, m.
    pub cost_m: f64,
    /// Distance of the end from the goal, m: what lies aside of all pushes by less than half a cell is left.
    pub miss_m: f64,
    /// States that were looked at.
    pub expanded: usize,
    /// What the search knows of each phase.
    pub(super) states: Vec<PhaseState>,
}

/// A phase in the numbers of its search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PhaseState {
    /// Index of the hold.
    pub(super) hold: usize,
    /// Index of the hold from which the search came to it.
    pub(super) by: usize,
    /// Cell in which it ends.
    pub(super) end: [i32; 2],
}

/// What is left of a way and no more than this needs no settling, m.
const SETTLED_M: f64 = 1e-12;
/// A phase is no shorter than this after settling, m: it goes on along its direction.
const SHORTEST_M: f64 = 1e-6;

/// Changes the lengths of phases, by as little as possible in the sum of squares, so that they end at `goal`, and tells
/// whether anything was changed; nothing if a phase would have to go back.
///
/// A search over oblique steps ends within a step of its goal only; what is aside of all directions is left.
pub(super) fn settled(mut phases: Vec<Phase>, goal: &Point2<f64>) -> Option<(Vec<Phase>, bool)> {
    let left = goal - phases.last()?.to_world;
    let normal: Matrix2<f64> = phases.iter().map(|phase| phase.hold.direction * phase.hold.direction.transpose()).sum();
    // one direction alone cannot mend what is left beside it
    let multiplier = normal.pseudo_inverse(SINGULAR).ok()? * left;
    if left.norm() <= SETTLED_M || multiplier.norm() <= SETTLED_M {
        return Some((phases, false));
    }
    let mut moved = Vector2::zeros();
    for phase in &mut phases {
        phase.from_world += moved;
        moved += phase.hold.direction * phase.hold.direction.dot(&multiplier);
        phase.to_world += moved;
        if (phase.to_world - phase.from_world).dot(&phase.hold.direction) < SHORTEST_M {
            return None;
        }
    }
    Some((phases, true))
}

/// Singular values below this do not count as a direction.
const SINGULAR: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::Isometry2;
    use proptest::prelude::*;

    use super::*;

    /// A few roundings of lengths of some decimeters.
    const ROUNDING_M: f64 = 1e-12;

    /// Phases along directions (rad) by lengths (m) from the origin.
    fn chain(ways: &[(f64, f64)]) -> Vec<Phase> {
        let mut at = Point2::origin();
        let phase = |(angle, length): &(f64, f64)| {
            let direction = Vector2::new(angle.cos(), angle.sin());
            let from_world = at;
            at += direction * *length;
            let center_from_tool = Isometry2::identity();
            let hold =
                Hold { surface: 0, place_m: 0.0, step: [1, 0], direction, tool_angle_rad: 0.0, center_from_tool };
            Phase { hold, from_world, to_world: at }
        };
        ways.iter().map(phase).collect()
    }

    #[test]
    fn two_pushes_across_share_what_is_left_by_its_parts() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let (found, changed) = settled(chain(&[(0.0, 0.1), (quarter, 0.05)]), &Point2::new(0.103, 0.046)).unwrap();
        assert!(changed);
        assert_relative_eq!(found[0].to_world, Point2::new(0.103, 0.0), epsilon = ROUNDING_M);
        assert_relative_eq!(found[1].to_world, Point2::new(0.103, 0.046), epsilon = ROUNDING_M);
    }

    #[test]
    fn what_lies_aside_of_all_pushes_is_left_and_what_would_go_back_is_refused() {
        let (found, changed) = settled(chain(&[(0.0, 0.1)]), &Point2::new(0.1, 0.0004)).unwrap();
        assert!(!changed);
        assert_relative_eq!(found[0].to_world, Point2::new(0.1, 0.0));
        assert_eq!(settled(chain(&[(0.0, 0.1), (1.5, 0.002)]), &Point2::new(0.1, -0.005)), None);
        assert_eq!(settled(Vec::new(), &Point2::origin()), None);
    }

    proptest! {
        #[test]
        fn settled_phases_chain_from_the_start_to_the_goal_without_going_back(
            ways in prop::collection::vec((0.0f64..6.2, 0.02f64..0.1), 2..5), off in [-0.008f64..0.008, -0.008f64..0.008],
        ) {
            let phases = chain(&ways);
            let goal = phases.last().unwrap().to_world + Vector2::from(off);
            let spread = ways.iter().map(|(angle, _)| (angle - ways[0].0).sin().abs()).fold(0.0, f64::max);
            if let Some((found, _)) = settled(phases, &goal) {
                prop_assert_eq!(found[0].from_world, Point2::origin());
                for pair in found.windows(2) {
                    prop_assert!((pair[0].to_world - pair[1].from_world).norm() < ROUNDING_M);
                }
                for phase in &found {
                    let way = phase.to_world - phase.from_world;
                    prop_assert!(way.dot(&phase.hold.direction) > 0.0);
                    prop_assert!(way.perp(&phase.hold.direction).abs() < ROUNDING_M);
                }
                let miss_m = (found.last().unwrap().to_world - goal).norm();
                prop_assert!(spread < 0.01 || miss_m < 1e-9, "{miss_m}");
            }
        }
    }
}
