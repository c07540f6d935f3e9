//! Tracks: meeting of pieces, rates against differences, bounds that hold.

use proptest::prelude::*;

use super::*;
use crate::spatial::SpatialJump;

fn knot(time_s: f64, numbers: [f64; 12], angle: f64) -> SpatialKnot {
    let v = |k: usize| Vector3::new(numbers[k], numbers[k + 1], numbers[k + 2]);
    let rotation = UnitQuaternion::from_scaled_axis(v(3) * angle);
    let pose = Isometry3::from_parts(Translation3::from(v(0)), rotation);
    SpatialKnot { time_s, motion: SpatialMotion::new(pose, [v(6), v(9)], [v(9) * 2.0, v(6) * 3.0]) }
}

prop_compose! {
    fn track()(a in prop::array::uniform12(-1.0f64..1.0), b in prop::array::uniform12(-1.0f64..1.0),
        c in prop::array::uniform12(-1.0f64..1.0), turn in 0.0f64..1.0) -> SpatialTrack {
        SpatialTrack::new(vec![knot(0.0, a, turn), knot(0.7, b, turn), knot(1.5, c, turn)]).unwrap()
    }
}

proptest! {
    #[test]
    fn rates_are_those_of_the_poses(track in track(), time_s in 0.01f64..1.49) {
        prop_assume!((time_s - 0.7).abs() > 1e-3);
        let h = 1e-4;
        let [before, at, after] = [time_s - h, time_s, time_s + h].map(|t| track.at(t));
        let linear = (after.pose.translation.vector - before.pose.translation.vector) / (2.0 * h);
        let angular = (after.pose.rotation * before.pose.rotation.inverse()).scaled_axis() / (2.0 * h);
        let change = (after.velocity - before.velocity) / (2.0 * h);
        // central differences over 1e-4 of functions whose third derivatives are some thousand
        prop_assert!((linear - at.linear_velocity()).norm() < 1e-5);
        prop_assert!((angular - at.angular_velocity()).norm() < 1e-5);
        prop_assert!((change - at.acceleration).norm() < 1e-3);
    }

    #[test]
    fn pieces_meet_in_pose_velocity_and_acceleration(track in track()) {
        let (before, after) = (track.at(0.7 - 1e-9), track.at(0.7 + 1e-9));
        let jump = SpatialJump::between(&before, &after);
        prop_assert!(jump.position_m < 1e-7 && jump.angle_rad < 1e-7, "{jump:?}");
        prop_assert!(jump.velocity_m_per_s < 1e-6 && jump.angular_velocity_rad_per_s < 1e-6, "{jump:?}");
        prop_assert!(jump.acceleration_m_per_s2 < 1e-4 && jump.angular_acceleration_rad_per_s2 < 1e-4, "{jump:?}");
    }

    #[test]
    fn rates_stay_below_their_bounds(track in track(), from_s in 0.0f64..1.4, part in 0.0f64..1.0) {
        let bounds = track.bounds(from_s, from_s + 0.1);
        let at = track.at(from_s + 0.1 * part);
        prop_assert!(at.linear_velocity().norm() <= bounds.speed_m_per_s + 1e-9);
        prop_assert!(at.angular_velocity().norm() <= bounds.angular_speed_rad_per_s + 1e-9);
        prop_assert!(at.linear_acceleration().norm() <= bounds.acceleration_m_per_s2 + 1e-9);
        prop_assert!(at.angular_acceleration().norm() <= bounds.angular_acceleration_rad_per_s2 + 1e-9);
    }

    #[test]
    fn a_track_turned_and_moved_is_the_motion_turned_and_moved(track in track(), time_s in 0.0f64..1.5) {
        let other = Isometry3::new(Vector3::new(0.3, -0.2, 1.0), Vector3::new(0.5, 0.4, -1.0));
        let jump = SpatialJump::between(&track.seen_from(&other).at(time_s), &track.at(time_s).seen_from(&other));
        prop_assert!(jump.position_m < 1e-12 && jump.angle_rad < 1e-7 && jump.velocity_m_per_s < 1e-12);
        prop_assert!(jump.acceleration_m_per_s2 < 1e-11 && jump.angular_acceleration_rad_per_s2 < 1e-10, "{jump:?}");
    }
}

#[test]
fn knots_that_make_no_track_are_refused() {
    let rest = |time_s: f64, z: f64| SpatialKnot {
        time_s,
        motion: SpatialMotion::at_rest(Isometry3::translation(0.0, 0.0, z)),
    };
    let half_turn = SpatialKnot {
        time_s: 1.0,
        motion: SpatialMotion::at_rest(Isometry3::rotation(Vector3::x() * std::f64::consts::PI)),
    };
    assert!(matches!(SpatialTrack::new(vec![rest(0.0, 0.0)]), Err(SpatialError::Knots { found: 1, .. })));
    assert!(matches!(SpatialTrack::new(vec![rest(1.0, 0.0), rest(2.0, 0.0)]), Err(SpatialError::Knots { .. })));
    assert!(matches!(
        SpatialTrack::new(vec![rest(0.0, 0.0), rest(0.0, 0.0)]),
        Err(SpatialError::TimesNotIncreasing { row: 1, .. })
    ));
    assert!(matches!(
        SpatialTrack::new(vec![rest(0.0, 0.0), rest(1.0, f64::NAN)]),
        Err(SpatialError::NonFinite { .. })
    ));
    assert!(matches!(SpatialTrack::new(vec![rest(0.0, 0.0), half_turn]), Err(SpatialError::FastTurn { .. })));
}

#[test]
fn outside_its_time_a_track_rests_at_its_ends() {
    let ends = [Isometry3::identity(), Isometry3::translation(1.0, 0.0, 0.0)];
    let knots = ends.iter().zip([0.0, 1.0]);
    let knots = knots.map(|(pose, time_s)| SpatialKnot { time_s, motion: SpatialMotion::at_rest(*pose) });
    let track = SpatialTrack::new(knots.collect()).unwrap();
    assert_eq!(track.at(-1.0), SpatialMotion::at_rest(ends[0]));
    assert_eq!(track.at(f64::NAN), SpatialMotion::at_rest(ends[0]));
    assert_eq!(track.at(2.0), SpatialMotion::at_rest(ends[1]));
    // minimum jerk passes the middle at 1.875 lengths per duration
    assert!((track.at(0.5).velocity[0] - 1.875).abs() < 1e-12);
}
