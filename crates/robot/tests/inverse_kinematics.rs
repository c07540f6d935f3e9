//! Inverse kinematics: round trips, refusals, and references along paths.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use common::{PANDA, PLANAR_3R, Random, model};
use nalgebra::{DVector, Isometry3, Translation3, UnitQuaternion, Vector3, Vector6};
use robot::{
    DifferentialKinematics, FrameId, FrameMotion, InverseKinematics, InverseKinematicsOptions, JointReference,
    Manipulator, RobotError, TaskRows,
};

/// The solver's own default tolerance.
const REACHED: f64 = 1e-9;
/// A posture is recovered to the tolerance times the worst gain of the inverse Jacobian.
const SAME_POSTURE: f64 = 1e-6;

fn planar() -> (Manipulator, FrameId) {
    let arm = model(PLANAR_3R);
    let flange = arm.frame("flange").unwrap();
    (arm, flange)
}

fn panda() -> (Manipulator, FrameId) {
    let arm = model(PANDA);
    let tip = arm.frame("panda_hand_tcp").unwrap();
    (arm, tip)
}

fn pose_of(arm: &Manipulator, frame: FrameId, q: &DVector<f64>) -> Isometry3<f64> {
    let mut workspace = arm.workspace();
    workspace.set_positions(q).unwrap();
    workspace.base_from_frame(frame)
}

fn within_limits(arm: &Manipulator, q: &DVector<f64>) -> bool {
    arm.joints().iter().zip(q.iter()).all(|(joint, &q)| joint.limits.clamp(q) == q)
}

fn planar_pose(x: f64, y: f64, angle: f64) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::new(x, y, 0.0), UnitQuaternion::from_euler_angles(0.0, 0.0, angle))
}

fn planar_start() -> DVector<f64> {
    DVector::from_vec(vec![-0.9, 1.8, -0.9])
}

#[test]
fn random_reachable_poses_of_the_panda_are_reached_from_afar() {
    let (arm, tip) = panda();
    let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, InverseKinematicsOptions::default()).unwrap();
    let mut random = Random(3);
    let mut reached = 0;
    for _ in 0..100 {
        let target = pose_of(&arm, tip, &random.posture(&arm, 0.05));
        if let Ok(solution) = solver.solve(&target, &random.posture(&arm, 0.0)) {
            let found = pose_of(&arm, tip, &solution.q);
            assert!((found.translation.vector - target.translation.vector).norm() <= 2.0 * REACHED);
            assert!(found.rotation.angle_to(&target.rotation) <= 1e-7, "rounding of a small angle from a quaternion");
            assert!(within_limits(&arm, &solution.q));
            reached += 1;
        }
    }
    // published success rates of such solvers are 99 % and above
    assert!(reached >= 99, "{reached} of 100");
}

#[test]
fn warm_start_keeps_the_branch_and_takes_few_steps() {
    let (arm, tip) = panda();
    let options = InverseKinematicsOptions { restarts: 0, ..Default::default() };
    let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, options).unwrap();
    let ready = DVector::from_vec(vec![0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]);
    let mut random = Random(5);
    for _ in 0..50 {
        let near = &ready + random.vector(7, 0.02);
        let solution = solver.solve(&pose_of(&arm, tip, &near), &ready).unwrap();
        assert!(solution.iterations <= 8, "{}", solution.iterations);
        assert!((solution.q - &ready).amax() < 0.1);
    }
}

#[test]
fn same_question_has_the_same_answer() {
    let (arm, tip) = panda();
    let target = pose_of(&arm, tip, &Random(11).posture(&arm, 0.1));
    let start = DVector::from_vec(vec![2.0, 1.0, -2.0, -0.5, 2.0, 3.0, -2.0]);
    let solve = || {
        let mut solver =
            InverseKinematics::new(&arm, tip, TaskRows::Pose, InverseKinematicsOptions::default()).unwrap();
        let first = solver.solve(&target, &start).unwrap();
        let second = solver.solve(&target, &start).unwrap();
        assert_eq!(first, second);
        first
    };
    assert_eq!(solve(), solve());
}

#[test]
fn preferred_posture_does_not_disturb_the_pose() {
    let (arm, tip) = panda();
    let ready = DVector::from_vec(vec![0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]);
    let far = DVector::from_vec(vec![1.2, 0.4, -0.9, -1.6, 0.5, 2.2, -0.3]);
    let target = pose_of(&arm, tip, &ready);
    let distance = |preferred_posture: Option<DVector<f64>>| {
        let options = InverseKinematicsOptions { preferred_posture, ..Default::default() };
        let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, options).unwrap();
        (solver.solve(&target, &far).unwrap().q - &ready).norm()
    };
    assert!(distance(Some(ready.clone())) < distance(None));
}

#[test]
fn position_rows_leave_the_orientation_free() {
    let (arm, tip) = panda();
    let options = InverseKinematicsOptions::default();
    let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Position, options).unwrap();
    let target = Isometry3::translation(0.4, 0.2, 0.3);
    let start = DVector::from_vec(vec![0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]);
    let solution = solver.solve(&target, &start).unwrap();
    let found = pose_of(&arm, tip, &solution.q);
    assert!((found.translation.vector - target.translation.vector).norm() <= 2.0 * REACHED);
    assert!(found.rotation.angle() > 1.0, "the hand still points down");
}

#[test]
fn planar_arm_covers_its_region_away_from_limits_and_singularities() {
    let (arm, flange) = planar();
    assert!(arm.warnings().is_empty(), "{:?}", arm.warnings());
    let options = InverseKinematicsOptions { restarts: 0, ..Default::default() };
    let mut solver = InverseKinematics::new(&arm, flange, TaskRows::PlanarPose, options).unwrap();
    for (column, row, turn) in (0..9).flat_map(|c| (0..9).flat_map(move |r| (0..5).map(move |t| (c, r, t)))) {
        let x = -0.12 + 0.03 * f64::from(column);
        let y = 0.22 + 0.19 / 8.0 * f64::from(row);
        let angle = -0.5 + 0.25 * f64::from(turn);
        let solution = solver.solve(&planar_pose(x, y, angle), &planar_start()).unwrap();
        assert!((solution.q.sum() - angle).abs() < 1e-8, "the joint angles add up to the tool angle");
        for (joint, q) in arm.joints().iter().zip(solution.q.iter()) {
            assert!(q - joint.limits.lower.unwrap() > 0.4 && joint.limits.upper.unwrap() - q > 0.4, "{}", joint.name);
        }
        // 0.24 · 0.22 · sin(elbow) is the determinant of the Jacobian
        assert!(solution.q[1].sin() > 0.6, "elbow at {} rad", solution.q[1]);
    }
}

#[test]
fn unreachable_target_says_how_far() {
    let (arm, flange) = planar();
    let mut solver =
        InverseKinematics::new(&arm, flange, TaskRows::Position, InverseKinematicsOptions::default()).unwrap();
    let error = solver.solve(&planar_pose(0.0, 1.02, 0.0), &planar_start()).unwrap_err();
    let RobotError::Unreachable { position_error_m, limiting_joint, q_closest, .. } = error else {
        panic!("unexpected error {error}");
    };
    // with the elbow at its limit of 0.3 rad the wrist comes out to 0.4549 m, and the hand adds 0.06 m
    let wrist = (0.24_f64.powi(2) + 0.22_f64.powi(2) + 2.0 * 0.24 * 0.22 * 0.3_f64.cos()).sqrt();
    assert!((position_error_m - (1.02 - wrist - 0.06)).abs() < 1e-3, "{position_error_m}");
    assert_eq!(limiting_joint.as_deref(), Some("joint2"));
    assert!((q_closest[1] - 0.3).abs() < 1e-9);
}

#[test]
fn start_outside_the_limits_is_brought_inside() {
    let (arm, tip) = panda();
    let target = pose_of(&arm, tip, &DVector::from_vec(vec![0.3, -0.5, 0.2, -1.9, 0.1, 1.7, 0.4]));
    let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, InverseKinematicsOptions::default()).unwrap();
    let solution = solver.solve(&target, &DVector::zeros(7)).unwrap();
    assert!(within_limits(&arm, &solution.q));
}

#[test]
fn target_that_is_not_finite_is_refused() {
    let (arm, flange) = planar();
    let mut solver =
        InverseKinematics::new(&arm, flange, TaskRows::PlanarPose, InverseKinematicsOptions::default()).unwrap();
    let error = solver.solve(&planar_pose(f64::NAN, 0.3, 0.0), &planar_start()).unwrap_err();
    assert!(matches!(error, RobotError::InvalidArgument { .. }));
}

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

#[test]
fn added_tool_frame_is_led_like_any_other() {
    let (mut arm, flange) = planar();
    let tool = arm.add_frame("tool_tip", flange, Isometry3::translation(0.02, 0.05, 0.0)).unwrap();
    let mut solver =
        InverseKinematics::new(&arm, tool, TaskRows::PlanarPose, InverseKinematicsOptions::default()).unwrap();
    let solution = solver.solve(&planar_pose(0.02, 0.37, 0.0), &planar_start()).unwrap();
    let flange_position = pose_of(&arm, flange, &solution.q).translation.vector;
    assert!((flange_position - Vector3::new(0.0, 0.32, 0.0)).norm() < 1e-8);
}
