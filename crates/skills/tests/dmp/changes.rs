//! Goal and duration changed at random on the way.

use proptest::prelude::*;
use skills::DmpForm;

use super::common::{learn, request};

/// Rounding of positions of some hundred mm, mm; velocities and accelerations in units of 1/s and 1/s² more.
const ROUNDING_MM: f64 = 1e-9;
/// End error of the primitive once settled, mm.
const SETTLED_MM: f64 = 0.005;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn position_and_velocity_are_continuous_under_changes_and_the_last_goal_is_reached(
        changes in prop::collection::vec((1usize..150, -300.0f64..300.0, 0.5f64..4.0, any::<bool>()), 1..8),
    ) {
        let mut stepper = learn(DmpForm::Residual).stepper(&request(0.0, 200.0, 2.0, 0.005)).unwrap();
        for (steps, goal, duration_s, at_once) in changes {
            for _ in 0..steps {
                stepper.step(0.005).unwrap();
            }
            let before = stepper.clone();
            stepper.change_goal(&[goal]).unwrap();
            // a new goal alone keeps the acceleration too
            let jump = (stepper.acceleration()[0] - before.acceleration()[0]).abs();
            prop_assert!(jump < 1e3 * ROUNDING_MM, "acceleration jumps by {}", jump);
            if at_once {
                stepper.change_duration(duration_s).unwrap();
            }
            prop_assert!((stepper.position()[0] - before.position()[0]).abs() < ROUNDING_MM);
            prop_assert!((stepper.velocity()[0] - before.velocity()[0]).abs() < 10.0 * ROUNDING_MM);
        }
        let end = stepper.progress().max(1.0) + 1.0;
        while stepper.progress() < end {
            stepper.step(0.005).unwrap();
        }
        prop_assert!((stepper.position()[0] - stepper.goal()[0]).abs() < SETTLED_MM);
    }
}
