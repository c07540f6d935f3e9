//! Goal and duration of a pose motion changed on the way: against the DMP of one angle, and for continuity in general.

use approx::assert_abs_diff_eq;
use nalgebra::{DMatrix, Isometry3, Translation3, UnitQuaternion, Vector3, dvector};
use proptest::prelude::*;

use super::*;
use crate::primitive::RolloutRequest;
use crate::time_law::minimum_jerk;

/// Rounding of turns of some radians; velocities and accelerations in 1/s and 1/s² of the stiff attractor amplify it.
const ROUNDING_RAD: f64 = 1e-9;
/// End error of the attractor once settled for a duration, m and rad: e^{−12.5} of a residual, and of a fit to 50 bases.
const SETTLED: f64 = 1e-4;
/// Control period, s.
const STEP_S: f64 = 0.005;
const ROWS: usize = 401;
const DURATION_S: f64 = 2.0;

fn along(row: usize) -> f64 {
    row as f64 / (ROWS - 1) as f64
}

// an angle that goes to `end` with a swing on its way
fn angle(end: f64, r: f64) -> f64 {
    end * minimum_jerk(r) + 0.4 * (16.0 * (r * (1.0 - r)).powi(2)) * (7.0 * r).sin()
}

fn times_s() -> Vec<f64> {
    (0..ROWS).map(|row| DURATION_S * along(row)).collect()
}

// turns by `end` about z, nodding about x, and goes 0.3 m
fn shown(end: f64, nod: f64) -> PoseTrajectory {
    let pose = |r: f64| {
        let turn = UnitQuaternion::from_scaled_axis(Vector3::x() * (nod * 16.0 * (r * (1.0 - r)).powi(2)))
            * UnitQuaternion::from_scaled_axis(Vector3::z() * angle(end, r));
        Isometry3::from_parts(Translation3::new(angle(0.3, r), 0.1 * minimum_jerk(r), 0.0), turn)
    };
    PoseTrajectory::new(times_s(), (0..ROWS).map(|row| pose(along(row))).collect()).unwrap()
}

fn learned(end: f64, nod: f64) -> (PoseDmp, PoseRequest) {
    let shown = shown(end, nod);
    let request = PoseRequest::new(shown.poses()[0], shown.poses()[ROWS - 1], DURATION_S, STEP_S);
    (PoseDmp::learn(&DmpConfig::default(), &[shown]).unwrap(), request)
}

fn about_z(angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(Vector3::z() * angle)
}

// about one axis rotations add like numbers, so that the pose motion must be the DMP of the angle, whose changes are
// another piece of code
#[test]
fn about_one_axis_a_changed_motion_is_that_of_the_angle_alone() {
    let (primitive, request) = learned(1.2, 0.0);
    let angles = Trajectory::new(times_s(), DMatrix::from_fn(ROWS, 1, |row, _| angle(1.2, along(row)))).unwrap();
    let alone = Dmp::learn(&DmpConfig::default(), &[angles]).unwrap();
    let end = angle(1.2, 1.0);
    let mut alone = alone.stepper(&RolloutRequest::new(dvector![0.0], dvector![end], DURATION_S, STEP_S)).unwrap();
    let mut stepper = primitive.stepper(&request).unwrap();
    for step in 0..800 {
        // two changes of each kind, one of them while another is under way, all before the last quarter
        if let Some((_, goal)) = [(60, 2.0), (180, 0.3)].iter().find(|(at, _)| *at == step) {
            alone.change_goal(&[*goal]).unwrap();
            let place = request.goal.translation;
            stepper.change_goal(&Isometry3::from_parts(place, about_z(*goal))).unwrap();
        }
        if let Some((_, duration_s)) = [(100, 3.0), (220, 2.5)].iter().find(|(at, _)| *at == step) {
            alone.change_duration(*duration_s).unwrap();
            stepper.change_duration(*duration_s).unwrap();
        }
        let motion = stepper.motion();
        let turned = about_z(alone.position()[0]);
        assert!(motion.pose.rotation.angle_to(&turned) < ROUNDING_RAD, "step {step}");
        let (velocity, acceleration) = (alone.velocity()[0], alone.acceleration()[0]);
        assert_abs_diff_eq!(motion.angular_velocity_rad_per_s, Vector3::z() * velocity, epsilon = 1e2 * ROUNDING_RAD);
        let found = motion.angular_acceleration_rad_per_s2;
        assert_abs_diff_eq!(found, Vector3::z() * acceleration, epsilon = 1e4 * ROUNDING_RAD);
        alone.step(STEP_S).unwrap();
        stepper.step(STEP_S).unwrap();
    }
    assert_abs_diff_eq!(stepper.motion().pose.rotation.angle(), 0.3, epsilon = SETTLED);
}

#[test]
fn a_goal_changed_to_itself_leaves_the_motion_as_it_was() {
    let (primitive, request) = learned(2.0, 0.5);
    let (mut changed, mut plain) = (primitive.stepper(&request).unwrap(), primitive.stepper(&request).unwrap());
    for step in 0..500 {
        if step == 120 {
            changed.change_goal(&request.goal).unwrap();
            changed.change_duration(DURATION_S).unwrap();
        }
        changed.step(STEP_S).unwrap();
        plain.step(STEP_S).unwrap();
        let (changed, plain) = (changed.motion(), plain.motion());
        assert!(changed.pose.rotation.angle_to(&plain.pose.rotation) < ROUNDING_RAD);
        assert_abs_diff_eq!(changed.pose.translation.vector, plain.pose.translation.vector, epsilon = ROUNDING_RAD);
    }
}

#[test]
fn changes_that_are_no_poses_or_durations_are_refused_and_change_nothing() {
    let (primitive, request) = learned(1.0, 0.2);
    let mut stepper = primitive.stepper(&request).unwrap();
    stepper.step(0.3).unwrap();
    let before = stepper.clone();
    let lost = Isometry3::translation(f64::NAN, 0.0, 0.0);
    assert!(matches!(stepper.change_goal(&lost), Err(PoseError::Skill(SkillError::NonFinite { .. }))));
    for duration_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(stepper.change_duration(duration_s).is_err());
    }
    assert_eq!((stepper.motion(), stepper.goal()), (before.motion(), &request.goal));
}

#[test]
fn changing_allocates_nothing() {
    let (primitive, request) = learned(1.0, 0.2);
    let mut stepper = primitive.stepper(&request).unwrap();
    let goal = Isometry3::from_parts(Translation3::new(0.1, 0.2, 0.0), about_z(-0.4));
    let counted = allocation_counter::measure(|| {
        for k in 0..100 {
            stepper.step(STEP_S).unwrap();
            stepper.change_goal(&goal).unwrap();
            stepper.change_duration(2.0 + 0.01 * f64::from(k)).unwrap();
        }
    });
    assert_eq!(counted.count_total, 0);
}

fn any_pose() -> impl Strategy<Value = Isometry3<f64>> {
    (prop::array::uniform3(-0.5f64..0.5), prop::array::uniform3(-2.0f64..2.0)).prop_map(|(place, turn)| {
        Isometry3::from_parts(Vector3::from(place).into(), UnitQuaternion::from_scaled_axis(Vector3::from(turn)))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn pose_and_velocities_are_continuous_under_changes_and_the_last_goal_is_reached(
        changes in prop::collection::vec((1usize..150, any_pose(), 1.0f64..4.0, any::<bool>()), 1..6),
        whole_turns in prop::sample::select(vec![0.0, 6.0]),
    ) {
        let (primitive, request) = learned(1.0 + whole_turns, 0.6);
        let mut stepper = primitive.stepper(&request).unwrap();
        for (steps, goal, duration_s, at_once) in changes {
            for _ in 0..steps {
                stepper.step(STEP_S).unwrap();
            }
            let before = *stepper.motion();
            stepper.change_goal(&goal).unwrap();
            // a new goal alone keeps the acceleration too
            let now = stepper.motion();
            let jump = now.angular_acceleration_rad_per_s2 - before.angular_acceleration_rad_per_s2;
            prop_assert!(jump.norm() < 1e4 * ROUNDING_RAD, "acceleration jumps by {}", jump.norm());
            if at_once {
                stepper.change_duration(duration_s).unwrap();
            }
            let now = stepper.motion();
            prop_assert!(now.pose.rotation.angle_to(&before.pose.rotation) < ROUNDING_RAD);
            prop_assert!((now.pose.translation.vector - before.pose.translation.vector).norm() < ROUNDING_RAD);
            let jump = now.angular_velocity_rad_per_s - before.angular_velocity_rad_per_s;
            prop_assert!(jump.norm() < 1e2 * ROUNDING_RAD, "velocity jumps by {}", jump.norm());
            let jump = now.linear_velocity_m_per_s - before.linear_velocity_m_per_s;
            prop_assert!(jump.norm() < 1e2 * ROUNDING_RAD);
        }
        // the rates are those of the poses, on a changed motion too
        let (before, middle) = (*stepper.motion(), { stepper.step(1e-4).unwrap(); *stepper.motion() });
        stepper.step(1e-4).unwrap();
        let after = stepper.motion();
        let by_difference = (after.pose.rotation * before.pose.rotation.inverse()).scaled_axis() / 2e-4;
        prop_assert!((by_difference - middle.angular_velocity_rad_per_s).norm() < 1e-4);
        let by_difference = (after.angular_velocity_rad_per_s - before.angular_velocity_rad_per_s) / 2e-4;
        prop_assert!((by_difference - middle.angular_acceleration_rad_per_s2).norm() < 1e-1);
        let end = stepper.progress().max(1.0) + 1.0;
        while stepper.progress() < end {
            stepper.step(STEP_S).unwrap();
        }
        prop_assert!(stepper.motion().pose.rotation.angle_to(&stepper.goal().rotation) < SETTLED);
        let place = stepper.motion().pose.translation.vector - stepper.goal().translation.vector;
        prop_assert!(place.norm() < SETTLED);
    }
}
