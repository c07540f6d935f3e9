//! Mimic joints: chains, limits, completion of postures, reduction of the dynamics, refusals.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use common::{Random, model};
use nalgebra::{DMatrix, DVector, Vector3};
use robot::{
    Coupling, DifferentialKinematics, InverseKinematics, InverseKinematicsOptions, Manipulator, RobotError, TaskRows,
    Warning,
};

const MIMICS: &str = include_str!("data/urdf/mimics.urdf");
const PANDA_HAND: &str = include_str!("../../../assets/robots/panda_hand.urdf");

/// Sums of a few products of numbers near 1.
const ROUNDING: f64 = 1e-13;

fn names(model: &Manipulator) -> Vec<&str> {
    model.joints().iter().map(|joint| joint.name.as_str()).collect()
}

fn refusal(old: &str, new: &str) -> RobotError {
    assert!(MIMICS.contains(old));
    Manipulator::from_urdf_str(&MIMICS.replace(old, new)).unwrap_err()
}

#[test]
fn chains_are_resolved_to_the_joint_that_follows_nobody() {
    let hand = model(MIMICS);
    assert_eq!(names(&hand), ["close", "curl", "bend", "push"]);
    // bend = -0.5 (2 close + 0.2) + 0.1 = -close
    let coupling = |follower, multiplier, offset| Coupling { follower, leader: 0, multiplier, offset };
    let couplings: Vec<_> = hand.couplings().collect();
    assert_eq!(couplings, [coupling(1, 2.0, 0.2), coupling(2, -1.0, 0.0), coupling(3, 1.0, 0.0)]);
    assert_eq!(hand.independent_joints().collect::<Vec<_>>(), [0]);
}

#[test]
fn postures_are_completed_from_the_leaders() {
    let hand = model(MIMICS);
    let mut q = DVector::from_vec(vec![0.3, 9.0, 9.0, 9.0]);
    hand.complete_positions(&mut q).unwrap();
    assert!((q - DVector::from_vec(vec![0.3, 0.8, -0.3, 0.3])).amax() < ROUNDING);
    let mut dq = DVector::from_vec(vec![0.5, 9.0, 9.0, 9.0]);
    hand.complete_velocities(&mut dq).unwrap();
    assert_eq!(dq.as_slice(), [0.5, 1.0, -0.5, 0.5]);
    assert!(matches!(hand.complete_positions(&mut DVector::zeros(3)), Err(RobotError::WrongLength { .. })));
    assert!(matches!(hand.complete_velocities(&mut DVector::zeros(5)), Err(RobotError::WrongLength { .. })));
}

#[test]
fn followers_narrow_the_limits_of_their_leader() {
    let hand = model(MIMICS);
    let limits = hand.leader_limits(0).unwrap();
    // curl: (±3 − 0.2) / 2 = −1.6 to 1.4; bend: −0.4 to 1; push: −1 to 1 and 1 m/s
    assert_eq!((limits.lower, limits.upper), (Some(-0.4), Some(1.0)));
    assert_eq!((limits.velocity, limits.effort), (Some(1.0), Some(7.0)));
    let narrowed = Warning::LimitsNarrowed { joint: "close".into(), lower: -0.4, upper: 1.0 };
    assert_eq!(hand.warnings(), [narrowed]);
    assert_eq!(hand.leader_limits(1).unwrap(), hand.joints()[1].limits);
    assert!(matches!(hand.leader_limits(4), Err(RobotError::InvalidArgument { .. })));
}

#[test]
fn every_posture_within_the_leaders_limits_is_within_all() {
    let hand = model(MIMICS);
    let limits = hand.leader_limits(0).unwrap();
    let (lower, upper) = (limits.lower.unwrap(), limits.upper.unwrap());
    for step in 0..=100 {
        let mut q = DVector::zeros(4);
        q[0] = lower + (upper - lower) * f64::from(step) / 100.0;
        hand.complete_positions(&mut q).unwrap();
        for (joint, q) in hand.joints().iter().zip(q.iter()) {
            assert!((joint.limits.clamp(*q) - q).abs() < ROUNDING, "{}: {q}", joint.name);
        }
    }
}

#[test]
fn reduced_mass_matrix_gives_the_kinetic_energy_of_the_coupled_motion() {
    let hand = model(MIMICS);
    let reduction = hand.coupling_matrix();
    let mut random = Random(3);
    for _ in 0..20 {
        let mut q = random.vector(4, 0.4);
        hand.complete_positions(&mut q).unwrap();
        let speed = random.next();
        let mut dq = DVector::zeros(4);
        dq[0] = speed;
        hand.complete_velocities(&mut dq).unwrap();
        assert!((&reduction * DVector::from_vec(vec![speed]) - &dq).amax() < ROUNDING);
        let mut workspace = hand.workspace();
        workspace.set_state(&q, &dq).unwrap();
        let mut mass = DMatrix::zeros(0, 0);
        workspace.mass_matrix_into(&mut mass);
        let reduced = reduction.transpose() * mass * &reduction;
        assert!((0.5 * reduced[(0, 0)] * speed * speed - workspace.kinetic_energy_j()).abs() < ROUNDING);
    }
}

#[test]
fn mimics_that_cannot_be_followed_are_refused() {
    let joint = |name: &str| name.to_owned();
    assert_eq!(
        refusal(
            r#"<mimic joint="close"/>
  </joint>"#,
            r#"<mimic joint="open"/></joint>"#
        ),
        RobotError::MimicTargetMissing { joint: joint("push"), target: joint("open") }
    );
    assert_eq!(
        refusal(r#"<mimic joint="curl""#, r#"<mimic joint="stare""#),
        RobotError::MimicTargetFixed { joint: joint("bend"), target: joint("stare") }
    );
    for target in ["curl", "bend"] {
        let error =
            refusal(r#"<mimic joint="close" multiplier="2""#, &format!(r#"<mimic joint="{target}" multiplier="2""#));
        assert!(matches!(&error, RobotError::MimicCycle { .. }), "{error}");
        assert!(error.to_string().contains("mimics itself"), "{error}");
    }
    for number in ["inf", "nan"] {
        let error = refusal(r#"multiplier="2""#, &format!(r#"multiplier="{number}""#));
        assert_eq!(error, RobotError::NonFinite { element: joint("joint `curl`"), quantity: "mimic" });
    }
    let error = refusal(r#"offset="0.2""#, r#"offset="20""#);
    assert!(
        matches!(&error, RobotError::MimicLimitsEmpty { joint, follower, .. } if joint == "close" && follower == "curl")
    );
    assert!(error.to_string().contains("widen the limits of `curl`"), "{error}");
    let error = refusal(r#"multiplier="2" offset="0.2""#, r#"multiplier="0" offset="3.5""#);
    assert!(matches!(error, RobotError::MimicLimitsEmpty { .. }), "{error}");
}

#[test]
fn frames_behind_a_mimic_joint_are_not_led() {
    let hand = model(MIMICS);
    let lead = |frame: &str| {
        let frame = hand.frame(frame).unwrap();
        hand.check_independent(frame)?;
        InverseKinematics::new(&hand, frame, TaskRows::Pose, InverseKinematicsOptions::default()).map(|_| ())
    };
    assert_eq!(lead("knuckle"), Ok(()));
    let behind =
        |frame: &str, joint: &str| Err(RobotError::FrameBehindMimic { frame: frame.into(), joint: joint.into() });
    assert_eq!(lead("tip"), behind("tip", "bend"));
    assert_eq!(lead("thumb"), behind("thumb", "push"));
    let tip = hand.frame("tip").unwrap();
    assert!(InverseKinematics::new(&hand, tip, TaskRows::Pose, InverseKinematicsOptions::default()).is_err());
    assert!(DifferentialKinematics::new(&hand, tip, TaskRows::PlanarPose).is_err());
}

#[test]
fn the_fingers_of_the_panda_hand_close_together() {
    let hand = model(PANDA_HAND);
    assert_eq!(names(&hand), ["panda_finger_joint1", "panda_finger_joint2"]);
    assert_eq!(hand.warnings(), []);
    assert_eq!(hand.check_dynamics(), Ok(()));
    let mut workspace = hand.workspace();
    for opening in [0.0, 0.013, 0.04] {
        let mut q = DVector::from_vec(vec![opening, -1.0]);
        hand.complete_positions(&mut q).unwrap();
        workspace.set_positions(&q).unwrap();
        for (finger, side) in [("panda_leftfinger", 1.0), ("panda_rightfinger", -1.0)] {
            let place = workspace.base_from_frame(hand.frame(finger).unwrap()).translation.vector;
            assert!((place - Vector3::new(0.0, side * opening, 0.0584)).amax() < ROUNDING, "{finger}: {place}");
        }
    }
    assert!((hand.joints().iter().map(|joint| joint.body.mass_kg).sum::<f64>() - 0.03).abs() < ROUNDING);
    assert_eq!(hand.leader_limits(0).unwrap(), hand.joints()[0].limits);
}

#[test]
fn the_middle_posture_is_one_that_the_arm_may_take() {
    for urdf in [common::PANDA, common::PLANAR_3R, common::THREE_FINGERS, common::BRANCHED, PANDA_HAND, MIMICS] {
        let arm = model(urdf);
        let q = arm.middle_posture();
        assert!(common::within_limits(&arm, &q), "{}: {q}", arm.name());
        let mut completed = q.clone();
        arm.complete_positions(&mut completed).unwrap();
        assert_eq!(completed, q, "{}", arm.name());
    }
    // (lower + upper)/2 of the file; the continuous joint of the branched tree stands at zero
    let panda = model(common::PANDA).middle_posture();
    assert!((panda[3] - 0.5 * (-3.0718 - 0.0698)).abs() < ROUNDING && (panda[5] - 1.8675).abs() < ROUNDING);
    assert_eq!(model(common::BRANCHED).middle_posture(), DVector::zeros(4));
}
