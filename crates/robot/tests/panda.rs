//! The Panda file against Franka's own parameters: Denavit–Hartenberg chain, limits, masses, shapes.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use common::{PANDA, Random, model};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use robot::{Geometry, Manipulator};

/// Products of ten poses of about 1 m.
const ROUNDING: f64 = 1e-14;

/// Modified Denavit–Hartenberg parameters a, d (m), alpha (rad) of the documentation of the Franka Control Interface,
/// section "Denavit–Hartenberg parameters"; the last row is the flange.
const CHAIN: [[f64; 3]; 8] = [
    [0.0, 0.333, 0.0],
    [0.0, 0.0, -FRAC_PI_2],
    [0.0, 0.316, FRAC_PI_2],
    [0.0825, 0.0, FRAC_PI_2],
    [-0.0825, 0.384, -FRAC_PI_2],
    [0.0, 0.0, FRAC_PI_2],
    [0.088, 0.0, FRAC_PI_2],
    [0.0, 0.107, 0.0],
];

/// Limits of the same documentation: lowest and highest position (rad), speed (rad/s), torque (N m).
const LIMITS: [[f64; 4]; 7] = [
    [-2.8973, 2.8973, 2.175, 87.0],
    [-1.7628, 1.7628, 2.175, 87.0],
    [-2.8973, 2.8973, 2.175, 87.0],
    [-3.0718, -0.0698, 2.175, 87.0],
    [-2.8973, 2.8973, 2.61, 12.0],
    [-0.0175, 3.7525, 2.61, 12.0],
    [-2.8973, 2.8973, 2.61, 12.0],
];

/// Masses of Gaz et al. 2019 (kg); the last body carries the hand of 0.73 kg and two fingers of 0.015 kg as well.
const MASSES: [f64; 7] = [4.970684, 0.646926, 3.228604, 3.587895, 1.225946, 1.666555, 0.735522 + 0.73 + 0.03];

/// One row of Craig's convention: turn and move along x, then along z.
fn row([a, d, alpha]: [f64; 3], theta: f64) -> Isometry3<f64> {
    let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    let along_x = Isometry3::from_parts(Translation3::identity(), about(Vector3::x_axis(), alpha))
        * Translation3::new(a, 0.0, 0.0);
    along_x * about(Vector3::z_axis(), theta) * Translation3::new(0.0, 0.0, d)
}

fn panda() -> Manipulator {
    model(PANDA)
}

#[test]
fn the_hand_stands_where_the_denavit_hartenberg_chain_puts_it() {
    let arm = panda();
    let mut workspace = arm.workspace();
    let mut random = Random(11);
    let hand_from_flange = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -FRAC_PI_4);
    for _ in 0..100 {
        let q = random.posture(&arm, 0.0);
        workspace.set_positions(&q).unwrap();
        let angles = q.iter().copied().chain([0.0]);
        let flange =
            CHAIN.iter().zip(angles).fold(Isometry3::identity(), |pose, (&link, angle)| pose * row(link, angle));
        let tip = flange * hand_from_flange * Translation3::new(0.0, 0.0, 0.1034);
        for (name, expected) in [("panda_link8", flange), ("panda_hand_tcp", tip)] {
            let found = workspace.base_from_frame(arm.frame(name).unwrap());
            let difference = (found.to_homogeneous() - expected.to_homogeneous()).amax();
            assert!(difference < ROUNDING, "{name}: {difference:e}");
        }
    }
}

#[test]
fn seven_joints_move_within_frankas_limits() {
    let arm = panda();
    assert_eq!(arm.joint_count(), 7);
    for (joint, [lower, upper, velocity, effort]) in arm.joints().iter().zip(LIMITS) {
        let limits = joint.limits;
        assert_eq!((limits.lower, limits.upper), (Some(lower), Some(upper)), "{}", joint.name);
        assert_eq!((limits.velocity, limits.effort), (Some(velocity), Some(effort)), "{}", joint.name);
    }
}

#[test]
fn the_file_is_without_oddities_and_fit_for_dynamics() {
    let arm = panda();
    assert_eq!(arm.warnings(), []);
    assert_eq!(arm.check_dynamics(), Ok(()));
    for (joint, mass) in arm.joints().iter().zip(MASSES) {
        assert!((joint.body.mass_kg - mass).abs() < ROUNDING, "{}", joint.name);
    }
}

#[test]
fn every_body_has_the_same_colored_shapes_to_see_and_to_touch() {
    let arm = panda();
    let bodies = arm.joints().iter().map(|joint| &joint.body).chain([arm.base()]);
    for body in bodies {
        assert!(!body.visuals.is_empty() && body.visuals.len() == body.collisions.len(), "{:?}", body.links);
        for (seen, touched) in body.visuals.iter().zip(&body.collisions) {
            assert_eq!((&seen.geometry, seen.body_from_shape), (&touched.geometry, touched.body_from_shape));
            assert!(seen.color_rgba.is_some());
        }
    }
    let hand = &arm.joints()[6].body.collisions;
    let boxes = hand.iter().filter(|shape| matches!(shape.geometry, Geometry::Box { .. })).count();
    assert_eq!((hand.len(), boxes), (12, 8), "two capsules of the last link, two of the hand, four boxes a finger");
}

#[test]
fn the_closed_fingers_touch_in_the_middle_of_the_hand() {
    let arm = panda();
    let (_, body_from_hand) = arm.frame_attachment(arm.frame("panda_hand").unwrap());
    let fingers = arm.joints()[6].body.collisions.iter().filter(|shape| shape.link.ends_with("finger"));
    for shape in fingers {
        let Geometry::Box { size_m } = &shape.geometry else { panic!("a finger of boxes") };
        let side = if shape.link == "panda_leftfinger" { 1.0 } else { -1.0 };
        let hand_from_shape = body_from_hand.inverse() * shape.body_from_shape;
        let corners = (0..8).map(|corner| {
            let sign = |bit: u32| if corner >> bit & 1 == 0 { -0.5 } else { 0.5 };
            let place = Vector3::new(sign(0) * size_m.x, sign(1) * size_m.y, sign(2) * size_m.z);
            side * hand_from_shape.transform_point(&place.into()).y
        });
        // the pads end 0.02 mm beyond the middle in the published boxes
        assert!(corners.fold(f64::INFINITY, f64::min) > -3e-5, "{}", shape.link);
    }
}
