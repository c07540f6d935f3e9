//! Joint references along paths of a frame: consistent derivatives, redundancy, singular postures, refusals.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use common::{PLANAR_3R, READY, model, panda, planar, planar_pose, planar_start, pose_of};
use nalgebra::{DVector, Isometry3, Matrix6xX, UnitQuaternion, Vector3, Vector6};
use robot::{
    DifferentialKinematics, FollowReport, FrameMotion, InverseKinematics, InverseKinematicsOptions, JointReference,
    Redundancy, RobotError, TaskRows, UnreachableReason,
};

/// A posture is recovered to the tolerance times the worst gain of the inverse Jacobian.
const SAME_POSTURE: f64 = 1e-6;

/// A circle of 3 cm in 2 s with a swinging tool angle, and its exact derivatives.
fn circle(time: f64) -> FrameMotion {
    let rate = std::f64::consts::PI;
    let (sine, cosine) = (rate * time).sin_cos();
    FrameMotion {
        base_from_frame: planar_pose(0.03 * cosine, 0.32 + 0.03 * sine, 0.3 * sine),
        velocity: Vector6::new(-0.03 * rate * sine, 0.03 * rate * cosine, 0.0, 0.0, 0.0, 0.3 * rate * cosine),
        acceleration: Vector6::new(-0.03 * cosine, -0.03 * sine, 0.0, 0.0, 0.0, -0.3 * sine) * rate.powi(2),
    }
}

#[test]
fn followed_path_has_consistent_positions_velocities_and_accelerations() {
    let (arm, flange) = planar();
    let options = InverseKinematicsOptions::default();
    let mut solver = InverseKinematics::new(&arm, flange, TaskRows::PlanarPose, options).unwrap();
    let mut follower = DifferentialKinematics::new(&arm, flange, TaskRows::PlanarPose).unwrap();
    let start = solver.solve(&circle(0.0).base_from_frame, &planar_start()).unwrap();
    let mut reference = JointReference::at_rest(start.q);
    let step = 1e-3;
    let path: Vec<JointReference> = (0..2000)
        .map(|sample| {
            follower.follow(&circle(step * f64::from(sample)), &mut reference).unwrap();
            reference.clone()
        })
        .collect();
    for window in path.windows(3) {
        // central differences at 1 ms: third derivatives near 100 make errors of 2e-5
        let velocity = (&window[2].q - &window[0].q) / (2.0 * step);
        let acceleration = (&window[2].dq - &window[0].dq) / (2.0 * step);
        assert!((velocity - &window[1].dq).amax() < 1e-4);
        assert!((acceleration - &window[1].ddq).amax() < 1e-3);
    }
}

#[test]
fn redundant_arm_follows_the_wanted_twist_and_acceleration() {
    let (arm, tip) = panda();
    let q = DVector::from_vec(vec![0.2, -0.6, 0.1, -2.1, 0.3, 1.7, 0.6]);
    let mut follower = DifferentialKinematics::new(&arm, tip, TaskRows::Pose).unwrap();
    let wanted = FrameMotion {
        base_from_frame: pose_of(&arm, tip, &q),
        velocity: Vector6::new(0.1, -0.2, 0.05, 0.3, 0.1, -0.4),
        acceleration: Vector6::new(1.0, 0.5, -0.7, 0.2, -1.0, 0.3),
    };
    let mut reference = JointReference::at_rest(q.add_scalar(0.01));
    follower.follow(&wanted, &mut reference).unwrap();
    let mut workspace = arm.workspace();
    workspace.set_state(&reference.q, &reference.dq).unwrap();
    let mut jacobian = nalgebra::Matrix6xX::zeros(7);
    workspace.jacobian_into(tip, &mut jacobian);
    let acceleration = jacobian * &reference.ddq + workspace.jacobian_rate_times_velocity(tip);
    assert!((workspace.frame_velocity(tip) - wanted.velocity).amax() < SAME_POSTURE);
    assert!((acceleration - wanted.acceleration).amax() < SAME_POSTURE);
}

#[test]
fn path_through_a_limit_or_a_singularity_is_refused_by_name() {
    let (arm, flange) = planar();
    let mut follower = DifferentialKinematics::new(&arm, flange, TaskRows::PlanarPose).unwrap();
    let still =
        |base_from_frame| FrameMotion { base_from_frame, velocity: Vector6::zeros(), acceleration: Vector6::zeros() };
    let stretched = pose_of(&arm, flange, &DVector::from_vec(vec![0.0, 0.1, 0.0]));
    let mut reference = JointReference::at_rest(DVector::from_vec(vec![0.0, 0.2, 0.0]));
    let error = follower.follow(&still(stretched), &mut reference).unwrap_err();
    assert!(matches!(&error, RobotError::OutsideLimits { joint, .. } if joint == "joint2"), "{error}");
    let mut reference = JointReference::at_rest(DVector::zeros(3));
    let error = follower.follow(&still(planar_pose(0.0, 0.52, 0.0)), &mut reference).unwrap_err();
    assert!(matches!(&error, RobotError::Singular { frame, .. } if frame == "flange"), "{error}");
}

#[test]
fn task_with_more_rows_than_joints_is_refused() {
    let (arm, flange) = planar();
    let error = DifferentialKinematics::new(&arm, flange, TaskRows::Pose).unwrap_err();
    assert_eq!(error, RobotError::TooFewJoints { frame: "flange".into(), rows: 6, joints: 3 });
}

/// A figure of 12 cm with a rolling hand, two seconds long, in front of the Panda, and its exact derivatives.
fn weave(time: f64) -> FrameMotion {
    let rate = std::f64::consts::PI;
    let at = |amplitude: f64, rate: f64, phase: f64| {
        let (sine, cosine) = (rate * time + phase).sin_cos();
        (amplitude * sine, amplitude * rate * cosine, -amplitude * rate * rate * sine)
    };
    let ((x, dx, ddx), (y, dy, ddy)) = (at(0.06, rate, 0.0), at(0.12, rate, 1.0));
    let ((z, dz, ddz), (roll, droll, ddroll)) = (at(0.04, 2.0 * rate, 0.5), at(0.4, rate, 0.3));
    // a fixed axis, so that the angular velocity is the rate of one angle
    let axis = Vector3::new(1.0, 0.5, -0.2).normalize();
    let turn = UnitQuaternion::from_scaled_axis(axis * roll) * UnitQuaternion::from_euler_angles(3.0, 0.1, 0.2);
    let linear = |x: f64, y: f64, z: f64, angular: Vector3<f64>| Vector6::new(x, y, z, angular.x, angular.y, angular.z);
    FrameMotion {
        base_from_frame: Isometry3::from_parts(Vector3::new(0.45 + x, y, 0.35 + z).into(), turn),
        velocity: linear(dx, dy, dz, axis * droll),
        acceleration: linear(ddx, ddy, ddz, axis * ddroll),
    }
}

fn still(base_from_frame: Isometry3<f64>) -> FrameMotion {
    FrameMotion { base_from_frame, velocity: Vector6::zeros(), acceleration: Vector6::zeros() }
}

fn start_of_weave() -> DVector<f64> {
    let (arm, tip) = panda();
    let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, InverseKinematicsOptions::default()).unwrap();
    solver.solve(&weave(0.0).base_from_frame, &DVector::from_column_slice(&READY)).unwrap().q
}

/// Follows the weave for two seconds at a time step (s).
fn woven(follower: &mut DifferentialKinematics, step_s: f64) -> Vec<(JointReference, FollowReport)> {
    let mut reference = JointReference::at_rest(start_of_weave());
    let samples = (2.0 / step_s).round() as usize;
    (0..samples)
        .map(|sample| {
            let report = follower.follow(&weave(step_s * sample as f64), &mut reference).unwrap();
            (reference.clone(), report)
        })
        .collect()
}

/// Largest differences between central differences along a path and the velocities and accelerations it states.
fn inconsistency(path: &[(JointReference, FollowReport)], step_s: f64) -> (f64, f64) {
    path.windows(3).fold((0.0, 0.0), |(velocity, acceleration), window| {
        let [(before, _), (now, _), (after, _)] = window else { panic!("windows of three") };
        let slope = (&after.q - &before.q) / (2.0 * step_s) - &now.dq;
        let bend = (&after.dq - &before.dq) / (2.0 * step_s) - &now.ddq;
        (slope.amax().max(velocity), bend.amax().max(acceleration))
    })
}

fn policy(step_s: f64) -> Redundancy {
    // a posture beside the path's, so that the null-space motion has something to do
    let preferred = DVector::from_column_slice(&READY) + DVector::from_vec(vec![0.4, 0.0, -0.5, 0.0, 0.3, 0.0, 0.0]);
    Redundancy::toward(preferred, step_s)
}

#[test]
fn redundant_references_are_derivatives_of_each_other_to_second_order() {
    let (arm, tip) = panda();
    let follow = |step_s: f64, shortest: bool| {
        let mut follower = match shortest {
            true => DifferentialKinematics::new(&arm, tip, TaskRows::Pose).unwrap(),
            false => DifferentialKinematics::with_redundancy(&arm, tip, TaskRows::Pose, policy(step_s)).unwrap(),
        };
        inconsistency(&woven(&mut follower, step_s), step_s)
    };
    for shortest in [true, false] {
        let (coarse, fine) = (follow(2e-3, shortest), follow(1e-3, shortest));
        // central differences at 1 ms: third derivatives near 200 make errors of 3e-5, fourth ones of 1000 of 2e-4
        assert!(fine.0 < 1e-4 && fine.1 < 1e-3, "{shortest} {fine:?}");
        let orders = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
        assert!(orders.0 > 1.8 && orders.1 > 1.8, "{shortest} {orders:?}");
    }
}

#[test]
fn redundant_references_keep_the_pose_velocity_and_acceleration() {
    let (arm, tip) = panda();
    let mut follower = DifferentialKinematics::with_redundancy(&arm, tip, TaskRows::Pose, policy(1e-3)).unwrap();
    let mut workspace = arm.workspace();
    let mut jacobian = Matrix6xX::zeros(7);
    for (sample, (reference, report)) in woven(&mut follower, 1e-3).iter().enumerate() {
        let wanted = weave(1e-3 * sample as f64);
        workspace.set_state(&reference.q, &reference.dq).unwrap();
        workspace.jacobian_into(tip, &mut jacobian);
        let pose = workspace.base_from_frame(tip);
        assert!((pose.translation.vector - wanted.base_from_frame.translation.vector).norm() < 1e-10);
        assert!((workspace.frame_velocity(tip) - wanted.velocity).amax() < 1e-10);
        let acceleration = &jacobian * &reference.ddq + workspace.jacobian_rate_times_velocity(tip);
        assert!((acceleration - wanted.acceleration).amax() < 1e-9);
        assert_eq!(report.damping, 0.0);
        assert!(report.velocity_loss.amax() < 1e-12);
    }
}

#[test]
fn standing_hand_lets_the_arm_settle_where_inverse_kinematics_would_put_it() {
    let (arm, tip) = panda();
    let policy = policy(1e-3);
    let preferred_posture = Some(policy.preferred_posture.clone());
    let mut follower = DifferentialKinematics::with_redundancy(&arm, tip, TaskRows::Pose, policy).unwrap();
    let wanted = still(weave(0.0).base_from_frame);
    let mut reference = JointReference::at_rest(start_of_weave());
    let options = InverseKinematicsOptions { preferred_posture, ..Default::default() };
    let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, options).unwrap();
    let expected = solver.solve(&wanted.base_from_frame, &reference.q).unwrap().q;
    let begun = (&reference.q - &expected).norm();
    for _ in 0..8000 {
        follower.follow(&wanted, &mut reference).unwrap();
    }
    assert!(begun > 0.1, "there was a way to go: {begun}");
    assert!((&reference.q - &expected).norm() < 1e-3, "{}", (&reference.q - &expected).norm());
    assert!(reference.dq.amax() < 1e-3);
}

#[test]
fn joints_are_kept_from_their_limits() {
    let (arm, tip) = panda();
    let last_joint = |limit_rate_per_s: f64| {
        // the hand's position leaves four joints free, and the posture draws the last one beyond its limit of 2.8973 rad
        let preferred = DVector::from_column_slice(&READY) + DVector::from_vec(vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0]);
        let policy = Redundancy { limit_rate_per_s, posture_rate_per_s: 1.0, ..Redundancy::toward(preferred, 1e-3) };
        let mut follower = DifferentialKinematics::with_redundancy(&arm, tip, TaskRows::Position, policy).unwrap();
        let wanted = still(weave(0.0).base_from_frame);
        let mut reference = JointReference::at_rest(start_of_weave());
        for _ in 0..10_000 {
            follower.follow(&wanted, &mut reference)?;
        }
        Ok(reference.q[6])
    };
    let refused = last_joint(0.0).unwrap_err();
    assert!(matches!(&refused, RobotError::OutsideLimits { joint, .. } if joint == "panda_joint7"), "{refused}");
    // springs in balance: 1² (4.785 − q) = 10² (q − 2.6973)
    let balance = (4.785 + 100.0 * 2.6973) / 101.0;
    let found = last_joint(10.0).unwrap();
    assert!((found - balance).abs() < 1e-3, "{found} {balance}");
}

/// The planar arm without joint limits, which can stretch fully: 0.52 m from its base to the flange.
fn unlimited_planar_follower(step_s: f64) -> DifferentialKinematics {
    let arm = model(&PLANAR_3R.replace("type=\"revolute\"", "type=\"continuous\""));
    let flange = arm.frame("flange").unwrap();
    let policy = Redundancy::toward(planar_start(), step_s);
    DifferentialKinematics::with_redundancy(&arm, flange, TaskRows::PlanarPose, policy).unwrap()
}

/// Out along y to `farthest_m` and back in four seconds.
fn reaching_out(time: f64, farthest_m: f64) -> FrameMotion {
    let rate = std::f64::consts::FRAC_PI_2;
    let (sine, cosine) = (rate * time).sin_cos();
    let middle_m = 0.5 * (0.42 + farthest_m);
    let amplitude_m = farthest_m - middle_m;
    FrameMotion {
        base_from_frame: planar_pose(0.0, middle_m - amplitude_m * cosine, 0.0),
        velocity: Vector6::new(0.0, amplitude_m * rate * sine, 0.0, 0.0, 0.0, 0.0),
        acceleration: Vector6::new(0.0, amplitude_m * rate * rate * cosine, 0.0, 0.0, 0.0, 0.0),
    }
}

fn reach_out(farthest_m: f64) -> Result<Vec<(JointReference, FollowReport)>, RobotError> {
    let mut follower = unlimited_planar_follower(1e-3);
    // the wrist is 0.06 m behind the flange, at 0.36 m: the elbow's angle by the law of cosines
    let elbow = ((0.36_f64.powi(2) - 0.24_f64.powi(2) - 0.22_f64.powi(2)) / (2.0 * 0.24 * 0.22)).acos();
    let shoulder = -(0.22 * elbow.sin()).atan2(0.24 + 0.22 * elbow.cos());
    let mut reference = JointReference::at_rest(DVector::from_vec(vec![shoulder, elbow, -shoulder - elbow]));
    let step = |sample: u32| {
        let report = follower.follow(&reaching_out(1e-3 * f64::from(sample), farthest_m), &mut reference)?;
        Ok((reference.clone(), report))
    };
    (0..4000).map(step).collect()
}

#[test]
fn nearly_stretched_arm_lags_by_no_more_than_the_tolerance_and_says_so() {
    // 0.2 mm short of the full reach, where the elbow is 0.06 rad from straight
    let path = reach_out(0.5198).unwrap();
    let damped = path.iter().filter(|(_, report)| report.damping > 0.0).count();
    let lag = path.iter().map(|(_, report)| report.pose_error.position_error_m).fold(0.0, f64::max);
    let loss = path.iter().map(|(_, report)| report.velocity_loss.amax()).fold(0.0, f64::max);
    assert!(damped > 50 && damped < 2000, "{damped}");
    assert!(lag > 1e-9 && lag <= 1e-4, "{lag}");
    assert!(loss > 1e-9 && loss < 1e-3, "{loss}");
    let regular = path.iter().filter(|(_, report)| report.damping == 0.0);
    assert!(regular.map(|(_, report)| report.pose_error.position_error_m).fold(0.0, f64::max) < 1e-10);
    let (velocity, _) = inconsistency(&path, 1e-3);
    // the damped step brings the lag back within a few samples, beside the velocities of up to 1 rad/s
    assert!(velocity < 0.05, "{velocity}");
}

#[test]
fn path_beyond_the_reach_is_refused_with_the_distance_it_is_missed_by() {
    let error = reach_out(0.53).unwrap_err();
    let RobotError::Unreachable { position_error_m, reason: UnreachableReason::NearlySingular { pivot }, .. } = error
    else {
        panic!("unexpected error {error}")
    };
    assert!(position_error_m > 1e-4 && position_error_m < 1e-3, "{position_error_m}");
    assert!(pivot < 0.02, "{pivot}");
}

#[test]
fn policy_that_makes_no_sense_is_refused() {
    let (arm, tip) = panda();
    let good = policy(1e-3);
    let short = Redundancy { preferred_posture: DVector::zeros(3), ..good.clone() };
    let error = DifferentialKinematics::with_redundancy(&arm, tip, TaskRows::Pose, short).unwrap_err();
    assert!(matches!(error, RobotError::WrongLength { .. }), "{error}");
    for policy in [
        Redundancy { time_step_s: 0.0, ..good.clone() },
        Redundancy { limit_rate_per_s: 600.0, ..good.clone() },
        Redundancy { posture_rate_per_s: f64::NAN, ..good.clone() },
        Redundancy { limit_margin: -0.1, ..good.clone() },
        Redundancy { damped_below: 0.0, ..good.clone() },
    ] {
        let error = DifferentialKinematics::with_redundancy(&arm, tip, TaskRows::Pose, policy).unwrap_err();
        assert!(matches!(error, RobotError::InvalidArgument { .. }), "{error}");
    }
}
