//! What every map that keeps the ends promises, for random motions and samples.

use proptest::prelude::*;
use skills::corridor::Bounds;
use skills::corridor_map::{CorridorMap, LogitFamily, MotionEnds};

use super::{end_error, ends, kinds};

/// Roundings of x^u, which is within a few widths over δ of the bounds; all lengths are of order one.
const ROUNDING: f64 = 1e-11;
const DELTA: f64 = 0.02;

fn motion() -> impl Strategy<Value = MotionEnds> {
    let end = || (0.02f64..0.98, -3.0f64..3.0, 0.2f64..5.0);
    (end(), end()).prop_map(|(start, goal)| ends(start.into(), goal.into()))
}

fn corridor() -> impl Strategy<Value = Bounds> {
    (-3.0f64..3.0, 0.2f64..5.0).prop_map(|(lower, width)| Bounds::still(lower, lower + width))
}

fn at(bounds: &Bounds, share: f64) -> f64 {
    bounds.lower.position + share * bounds.width().position
}

proptest! {
    #[test]
    fn the_ends_are_fixed_points_both_ways(motion in motion()) {
        for kind in kinds() {
            let map = kind.map(&motion, DELTA).unwrap().map;
            prop_assert!(end_error(map.as_ref(), &motion) < ROUNDING);
            let start = map.constrained(&motion.start_bounds, 0.0, motion.start);
            let goal = map.constrained(&motion.goal_bounds, 1.0, motion.goal);
            prop_assert!((start - motion.start).abs() < ROUNDING && (goal - motion.goal).abs() < ROUNDING);
        }
    }

    #[test]
    fn ends_outside_their_bounds_are_fixed_points_of_what_is_learned(
        mut motion in motion(), start in -1.0f64..2.0, goal in -1.0f64..2.0,
    ) {
        motion.start = at(&motion.start_bounds, start);
        motion.goal = at(&motion.goal_bounds, goal);
        for kind in kinds() {
            let map = kind.map(&motion, motion.delta(0.01, 0.2)).unwrap().map;
            prop_assert!(end_error(map.as_ref(), &motion) < ROUNDING);
        }
    }

    #[test]
    fn a_sample_that_keeps_the_margin_comes_back(
        motion in motion(), bounds in corridor(), progress in 0.0f64..1.0, share in DELTA..1.0 - DELTA,
    ) {
        let x = at(&bounds, share);
        for kind in kinds() {
            let map = kind.map(&motion, DELTA).unwrap().map;
            let back = map.constrained(&bounds, progress, map.unconstrained(&bounds, progress, x));
            prop_assert!((back - x).abs() < ROUNDING, "{}: {x} came back as {back}", kind.name());
        }
    }

    #[test]
    fn every_member_of_the_family_has_its_inverse(
        motion in motion(), bounds in corridor(), progress in 0.0f64..1.0, share in DELTA..1.0 - DELTA,
        blend in 0.0f64..1.0, strength in 0.001f64..1.0,
    ) {
        let map = LogitFamily::new(blend, strength, DELTA, &motion).unwrap();
        let x = at(&bounds, share);
        let back = map.constrained(&bounds, progress, map.unconstrained(&bounds, progress, x));
        prop_assert!((back - x).abs() < ROUNDING);
    }

    #[test]
    fn maps_increase_strictly_across_and_beyond_the_bounds(
        motion in motion(), bounds in corridor(), progress in -0.5f64..1.5, share in -1.0f64..2.0, step in 1e-6f64..1.0,
    ) {
        for kind in kinds() {
            let map = kind.map(&motion, DELTA).unwrap().map;
            let [low, high] =
                [share, share + step].map(|share| map.unconstrained(&bounds, progress, at(&bounds, share)));
            prop_assert!(high > low);
        }
    }

    #[test]
    fn the_inverse_increases_strictly_inside(
        motion in motion(), bounds in corridor(), progress in 0.0f64..1.0, share in DELTA..0.9f64, step in 1e-4f64..0.08,
    ) {
        for kind in kinds() {
            let map = kind.map(&motion, DELTA).unwrap().map;
            let unconstrained = |share| map.unconstrained(&bounds, progress, at(&bounds, share));
            let [low, high] = [share, share + step].map(|share| map.constrained(&bounds, progress, unconstrained(share)));
            prop_assert!(high > low);
        }
    }

    #[test]
    fn every_finite_position_has_a_finite_coordinate_and_every_coordinate_a_position_strictly_inside(
        motion in motion(), bounds in corridor(), progress in -1.0f64..3.0, x in -1e100f64..1e100, scale in 0u32..101,
    ) {
        let x = x / 10f64.powi(scale as i32);
        for kind in kinds() {
            let map = kind.map(&motion, DELTA).unwrap().map;
            prop_assert!(map.unconstrained(&bounds, progress, x).is_finite());
            prop_assert!(bounds.margin(map.constrained(&bounds, progress, x)) > 0.0);
        }
    }

    #[test]
    fn an_end_next_to_its_bound_is_generated_exactly(mut motion in motion(), share in 1e-9f64..0.02, upper: bool) {
        motion.start = at(&motion.start_bounds, if upper { 1.0 - share } else { share });
        for kind in kinds() {
            let map = kind.map(&motion, motion.delta(0.0, 0.2)).unwrap().map;
            let start = map.constrained(&motion.start_bounds, 0.0, motion.start);
            prop_assert!((start - motion.start).abs() < ROUNDING);
        }
    }
}
