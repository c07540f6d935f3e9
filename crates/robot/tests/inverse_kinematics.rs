//! Inverse kinematics: round trips, refusals, and references along paths.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use common::{
    GANTRY, PLANAR_3R, READY, Random, THREE_FINGERS, TWO_ARMS, model, panda, planar, planar_pose, planar_start,
    pose_of, within_limits,
};
use nalgebra::{DVector, Isometry3, Vector3};
use robot::{
    FrameId, InverseKinematics, InverseKinematicsOptions, Manipulator, RobotError, TaskRows, UnreachableReason,
};

/// The solver's own default tolerance.
const REACHED: f64 = 1e-9;
/// The tolerance that solvers are customarily compared at (m and rad).
const COMPARED: f64 = 1e-6;

fn solver(arm: &Manipulator, frame: FrameId, rows: TaskRows) -> InverseKinematics {
    InverseKinematics::new(arm, frame, rows, InverseKinematicsOptions::default()).unwrap()
}

fn solver_at(tolerance: f64, arm: &Manipulator, frame: FrameId, rows: TaskRows) -> InverseKinematics {
    let options = InverseKinematicsOptions {
        position_tolerance_m: tolerance,
        angle_tolerance_rad: tolerance,
        ..InverseKinematicsOptions::default()
    };
    InverseKinematics::new(arm, frame, rows, options).unwrap()
}

/// Distance (m) and angle (rad) between two poses.
fn apart(a: &Isometry3<f64>, b: &Isometry3<f64>) -> (f64, f64) {
    let turn = (a.rotation * b.rotation.inverse()).scaled_axis().norm();
    ((a.translation.vector - b.translation.vector).norm(), turn)
}

/// Solves for `count` random reachable poses from the starts that `start` gives, checks every answer by forward kinematics
/// and the joint limits, and returns how many were found.
fn reached(
    count: usize,
    (arm, frame): &(Manipulator, FrameId),
    rows: TaskRows,
    mut start: impl FnMut(&mut Random, &DVector<f64>) -> DVector<f64>,
) -> usize {
    let mut solver = solver_at(COMPARED, arm, *frame, rows);
    let mut workspace = arm.workspace();
    let mut pose_at = |q: &DVector<f64>| {
        workspace.set_positions(q).unwrap();
        workspace.base_from_frame(*frame)
    };
    let mut random = Random(3);
    let mut reached = 0;
    for _ in 0..count {
        let truth = random.posture(arm, 0.0);
        let target = pose_at(&truth);
        let Ok(solution) = solver.solve(&target, &start(&mut random, &truth)) else { continue };
        let (distance, angle) = apart(&pose_at(&solution.q), &target);
        assert!(distance <= COMPARED + REACHED, "{distance}");
        assert!(rows == TaskRows::Position || angle <= COMPARED + REACHED, "{angle}");
        assert!(within_limits(arm, &solution.q));
        reached += 1;
    }
    reached
}

#[test]
fn ten_thousand_random_poses_of_the_panda_are_reached_from_random_starts() {
    let arm = panda();
    let found = reached(10_000, &arm, TaskRows::Pose, |random, _| random.posture(&arm.0, 0.0));
    assert!(found >= 9_990, "{found} of 10000");
}

#[test]
fn ten_thousand_random_poses_of_the_panda_are_reached_from_near() {
    let found = reached(10_000, &panda(), TaskRows::Pose, |random, truth| truth + random.normal_vector(7, 0.1));
    assert!(found >= 9_999, "{found} of 10000");
}

#[test]
fn other_arms_are_solved_alike() {
    let arm = |urdf: &str, frame: &str| {
        let arm = model(urdf);
        let frame = arm.frame(frame).unwrap();
        (arm, frame)
    };
    let cases = [
        // six joints, two of them slides, for six rows
        (arm(GANTRY, "cutter"), TaskRows::Pose, 1000),
        // a branch of four joints, and one of five in a tree of eight
        (arm(TWO_ARMS, "left_tool"), TaskRows::Position, 1000),
        (arm(THREE_FINGERS, "long_far"), TaskRows::Position, 1000),
        // fewer joints than rows: only poses of the plane can be met, and are
        (arm(PLANAR_3R, "flange"), TaskRows::Pose, 300),
        (arm(PLANAR_3R, "flange"), TaskRows::PlanarPose, 1000),
    ];
    for (case, rows, count) in cases {
        let found = reached(count, &case, rows, |random, _| random.posture(&case.0, 0.0));
        assert!(found * 1000 >= count * 995, "{} {rows:?}: {found} of {count}", case.0.name());
    }
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
fn preferred_posture_is_approached_as_far_as_the_target_allows() {
    let (arm, tip) = panda();
    let ready = DVector::from_column_slice(&READY);
    let preferred = InverseKinematicsOptions { preferred_posture: Some(ready.clone()), ..Default::default() };
    let mut drawn = InverseKinematics::new(&arm, tip, TaskRows::Pose, preferred).unwrap();
    let mut plain = solver(&arm, tip, TaskRows::Pose);
    let mut random = Random(17);
    let (mut compared, mut missed) = (0, 0);
    for _ in 0..200 {
        let target = pose_of(&arm, tip, &random.posture(&arm, 0.2));
        let Ok(best) = drawn.solve(&target, &random.posture(&arm, 0.0)) else { continue };
        let (distance, angle) = apart(&pose_of(&arm, tip, &best.q), &target);
        assert!(distance <= 2.0 * REACHED && angle <= 2.0 * REACHED, "the target is kept");
        // other postures of the same target, to either side along the self-motion, are farther from the preferred one
        for _ in 0..4 {
            let aside = &best.q + random.vector(7, 0.05);
            let Ok(other) = plain.solve(&target, &aside) else { continue };
            if (&other.q - &best.q).norm() > 0.2 {
                continue;
            }
            let (nearest, farther) = ((&best.q - &ready).norm(), (&other.q - &ready).norm());
            compared += 1;
            missed += usize::from(nearest > farther + 1e-4);
        }
    }
    assert!(compared > 600, "{compared}");
    // the self-motion branches at singular postures, where the glide may halt; elsewhere it arrives
    assert!(missed * 100 <= compared, "{missed} of {compared}");
}

#[test]
fn target_of_the_preferred_posture_is_met_by_it() {
    let (arm, tip) = panda();
    let ready = DVector::from_column_slice(&READY);
    let options = InverseKinematicsOptions { preferred_posture: Some(ready.clone()), ..Default::default() };
    let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, options).unwrap();
    let turned = &ready + DVector::from_vec(vec![0.5, 0.2, -0.5, 0.2, 0.3, 0.2, -0.3]);
    let solution = solver.solve(&pose_of(&arm, tip, &ready), &turned).unwrap();
    assert!((&solution.q - &ready).norm() < 1e-3, "{}", solution.q);
}

#[test]
fn target_at_a_singular_posture_is_reached() {
    // without limits the arm stretches fully, where its Jacobian loses rank
    let text = PLANAR_3R.replace("type=\"revolute\"", "type=\"continuous\"");
    let arm = model(&text);
    let flange = arm.frame("flange").unwrap();
    let mut solver = solver_at(COMPARED, &arm, flange, TaskRows::PlanarPose);
    let target = pose_of(&arm, flange, &DVector::from_vec(vec![0.4, 0.0, 0.3]));
    let solution = solver.solve(&target, &DVector::from_vec(vec![-0.9, 1.8, -0.9])).unwrap();
    // at the edge of the reach a millionth of a meter is a thousandth of a radian at the elbow
    assert!(solution.q[1].abs() < 1e-2, "{}", solution.q);
    let (panda, tip) = panda();
    // shoulder and wrist singular at once: joints 1, 3 on one line, and joints 5, 7 parallel
    let target = pose_of(&panda, tip, &DVector::from_vec(vec![0.3, 0.0, 0.4, -1.8, 0.2, 0.0, 0.1]));
    let start = DVector::from_column_slice(&READY);
    let mut solver = solver_at(COMPARED, &panda, tip, TaskRows::Pose);
    let solution = solver.solve(&target, &start).unwrap();
    let (distance, angle) = apart(&pose_of(&panda, tip, &solution.q), &target);
    assert!(distance <= 2.0 * COMPARED && angle <= 2.0 * COMPARED);
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
fn unreachable_target_says_how_far_and_which_limit_binds() {
    let (arm, flange) = planar();
    let error =
        solver(&arm, flange, TaskRows::Position).solve(&planar_pose(0.0, 0.5199, 0.0), &planar_start()).unwrap_err();
    assert!(error.to_string().contains("joint `joint2` is at its limit"), "{error}");
    let RobotError::Unreachable { position_error_m, angle_error_rad, reason, q_closest } = error else {
        panic!("unexpected error {error}");
    };
    // with the elbow at its limit of 0.3 rad the wrist comes out to 0.4549 m, and the hand adds 0.06 m
    let wrist = (0.24_f64.powi(2) + 0.22_f64.powi(2) + 2.0 * 0.24 * 0.22 * 0.3_f64.cos()).sqrt();
    assert!((position_error_m - (0.5199 - wrist - 0.06)).abs() < 1e-6, "{position_error_m}");
    assert_eq!(angle_error_rad, 0.0);
    assert_eq!(reason, UnreachableReason::AtLimits { joints: vec!["joint2".into()] });
    assert!((q_closest[1] - 0.3).abs() < 1e-9);
}

#[test]
fn target_beyond_the_length_of_the_arm_is_named_so() {
    let (arm, flange) = planar();
    let error =
        solver(&arm, flange, TaskRows::Position).solve(&planar_pose(0.0, 1.02, 0.0), &planar_start()).unwrap_err();
    let RobotError::Unreachable { reason: UnreachableReason::TooFar { joint, distance_m, reach_m }, .. } = &error
    else {
        panic!("unexpected error {error}");
    };
    assert_eq!(joint, "joint1");
    assert!((distance_m - 1.02).abs() < 1e-12 && (reach_m - 0.52).abs() < 1e-12);
    assert!(
        error.to_string().contains("is 1.0200 m from joint `joint1`, and all links from there reach 0.5200 m"),
        "{error}"
    );
}

#[test]
fn target_too_near_is_told_from_a_limit() {
    // links of 0.24 m and 0.28 m (the hand fixed) cannot fold to less than 0.04 m
    let text = PLANAR_3R.replace("type=\"revolute\"", "type=\"continuous\"");
    let text = text.replacen("name=\"joint3\" type=\"continuous\"", "name=\"joint3\" type=\"fixed\"", 1);
    let arm = model(&text);
    assert_eq!(arm.joint_count(), 2, "the hand is fixed");
    let flange = arm.frame("flange").unwrap();
    let start = DVector::from_vec(vec![0.3, 1.0]);
    let error = solver(&arm, flange, TaskRows::Position).solve(&planar_pose(0.0, 0.01, 0.0), &start).unwrap_err();
    let RobotError::Unreachable { position_error_m, reason, .. } = error else { panic!("unexpected error {error}") };
    assert_eq!(reason, UnreachableReason::NoCloserMotion);
    assert!((position_error_m - 0.03).abs() < 1e-6, "{position_error_m}");
}

#[test]
fn no_random_posture_comes_closer_than_the_closest_one_of_a_refusal() {
    let (arm, tip) = panda();
    let mut random = Random(23);
    let mut workspace = arm.workspace();
    let mut random_pose = || {
        workspace.set_positions(&random.posture(&arm, 0.0)).unwrap();
        workspace.base_from_frame(tip)
    };
    let postures: Vec<Isometry3<f64>> = (0..20_000).map(|_| random_pose()).collect();
    let mut solver = solver(&arm, tip, TaskRows::Pose);
    for place in [[0.9, 0.3, 0.6], [0.3, 0.5, 1.15], [0.0, 0.5, 1.4], [-0.6, -0.4, -0.5]] {
        let target = Isometry3::translation(place[0], place[1], place[2]);
        let error = solver.solve(&target, &DVector::from_column_slice(&READY)).unwrap_err();
        let RobotError::Unreachable { position_error_m, angle_error_rad, q_closest, .. } = error else {
            panic!("unexpected error {error}");
        };
        let (distance, angle) = apart(&pose_of(&arm, tip, &q_closest), &target);
        assert!((distance - position_error_m).abs() < 1e-9 && (angle - angle_error_rad).abs() < 1e-7);
        let nearest = postures.iter().map(|pose| apart(pose, &target)).map(|(d, a)| d.hypot(a));
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        assert!(position_error_m.hypot(angle_error_rad) <= nearest, "{position_error_m} {angle_error_rad} {nearest}");
    }
}

#[test]
fn options_that_make_no_sense_are_refused() {
    let (arm, flange) = planar();
    for options in [
        InverseKinematicsOptions { position_tolerance_m: 0.0, ..Default::default() },
        InverseKinematicsOptions { angle_tolerance_rad: f64::NAN, ..Default::default() },
        InverseKinematicsOptions { longest_step: -0.1, ..Default::default() },
        InverseKinematicsOptions { preferred_posture: Some(DVector::repeat(3, f64::NAN)), ..Default::default() },
    ] {
        let error = InverseKinematics::new(&arm, flange, TaskRows::PlanarPose, options).unwrap_err();
        assert!(matches!(error, RobotError::InvalidArgument { .. }), "{error}");
    }
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

#[test]
fn a_joint_goes_no_farther_than_those_that_mimic_it() {
    // two links of 1 m; a flap on the first one turns along with the second, by half a radian at most
    let link = |name: &str| {
        format!(
            r#"<link name="{name}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"#
        )
    };
    let joint = |name: &str, parent: &str, child: &str, x: f64, limit: f64, mimic: &str| {
        format!(
            r#"<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/><origin xyz="{x} 0 0"/><axis xyz="0 0 1"/><limit lower="-{limit}" upper="{limit}" effort="1" velocity="1"/>{mimic}</joint>"#
        )
    };
    let mimic = r#"<mimic joint="second"/>"#;
    let text = format!(
        r#"<robot name="r">{}{}{}{}{}{}{}{}<joint name="end" type="fixed"><parent link="b"/><child link="tip"/><origin xyz="1 0 0"/></joint></robot>"#,
        link("base"),
        link("a"),
        link("b"),
        link("flap"),
        r#"<link name="tip"/>"#,
        joint("first", "base", "a", 0.0, 3.0, ""),
        joint("second", "a", "b", 1.0, 2.0, ""),
        joint("third", "a", "flap", 0.5, 0.5, mimic),
    );
    let arm = Manipulator::from_urdf_str(&text).unwrap();
    let tip = arm.frame("tip").unwrap();
    let mut solver = solver(&arm, tip, TaskRows::Position);
    let start = DVector::from_column_slice(&[0.1, 0.1, 0.1]);
    let at = |second: f64| Isometry3::translation(1.0 + second.cos(), second.sin(), 0.0);
    let within = solver.solve(&at(0.4), &start).unwrap();
    assert!(within.q[1].abs() <= 0.5, "{}", within.q);
    let refused = solver.solve(&at(1.2), &start).unwrap_err();
    assert!(
        matches!(&refused, RobotError::Unreachable { reason: UnreachableReason::AtLimits { .. }, .. }),
        "{refused}"
    );
}
