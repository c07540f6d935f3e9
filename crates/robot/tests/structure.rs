//! Identities that the equations of motion obey on any tree, checked by independent routes.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use common::{BRANCHED, CARTPOLE, GANTRY, PANDA, PLANAR_3R, Random, THREE_FINGERS, TWO_ARMS, model};
use nalgebra::{DMatrix, DVector, Isometry3, Matrix6xX, Translation3, UnitQuaternion, Vector3};
use robot::{FrameId, Manipulator};

/// Algebraic identities of torques up to 100 N m.
const IDENTITY: f64 = 1e-11;
/// Step of central differences (s); truncation and rounding are then both near 1e-9.
const STEP: f64 = 1e-5;
/// Central differences with that step on values up to 100.
const DIFFERENCE: f64 = 2e-7;

const ARMS: [&str; 7] = [BRANCHED, CARTPOLE, PANDA, PLANAR_3R, TWO_ARMS, GANTRY, THREE_FINGERS];

/// The arm with rotors, a tilted gravity and its last frame.
fn loaded(urdf: &str) -> (Manipulator, FrameId) {
    let mut arm = model(urdf);
    let rotors: Vec<f64> = (0..arm.joint_count()).map(|joint| 0.05 + 0.01 * joint as f64).collect();
    arm.set_rotor_inertia(&rotors).unwrap();
    arm.set_gravity(Vector3::new(1.0, -2.0, -9.0));
    let last = arm.frame_names().last().unwrap().to_owned();
    let frame = arm.frame(&last).unwrap();
    (arm, frame)
}

fn mass_matrix(arm: &Manipulator, q: &DVector<f64>) -> DMatrix<f64> {
    let mut workspace = arm.workspace();
    let mut matrix = DMatrix::zeros(0, 0);
    workspace.set_positions(q).unwrap();
    workspace.mass_matrix_into(&mut matrix);
    matrix
}

/// Runs a check on several random states of every arm.
fn on_random_states(check: impl Fn(&Manipulator, FrameId, &DVector<f64>, &DVector<f64>)) {
    for urdf in ARMS {
        let (arm, frame) = loaded(urdf);
        let mut random = Random(7);
        for _ in 0..10 {
            let q = random.posture(&arm, 0.0);
            let dq = random.vector(arm.joint_count(), 2.0);
            check(&arm, frame, &q, &dq);
        }
    }
}

#[test]
fn mass_matrix_rate_minus_twice_coriolis_is_skew() {
    on_random_states(|arm, _, q, dq| {
        let rate = (mass_matrix(arm, &(q + dq * STEP)) - mass_matrix(arm, &(q - dq * STEP))) / (2.0 * STEP);
        let mut workspace = arm.workspace();
        let mut coriolis = DMatrix::zeros(0, 0);
        workspace.set_state(q, dq).unwrap();
        workspace.coriolis_matrix_into(&mut coriolis);
        let skew = rate - 2.0 * coriolis;
        assert!((&skew + skew.transpose()).amax() < DIFFERENCE, "{}", (&skew + skew.transpose()).amax());
    });
}

#[test]
fn coriolis_matrix_is_that_of_the_christoffel_symbols() {
    on_random_states(|arm, _, q, dq| {
        let n = q.len();
        let derivatives: Vec<DMatrix<f64>> = (0..n)
            .map(|joint| {
                let mut change = DVector::zeros(n);
                change[joint] = STEP;
                (mass_matrix(arm, &(q + &change)) - mass_matrix(arm, &(q - &change))) / (2.0 * STEP)
            })
            .collect();
        let expected = DMatrix::from_fn(n, n, |i, j| {
            (0..n)
                .map(|k| 0.5 * (derivatives[k][(i, j)] + derivatives[j][(i, k)] - derivatives[i][(j, k)]) * dq[k])
                .sum::<f64>()
        });
        let mut workspace = arm.workspace();
        let mut coriolis = DMatrix::zeros(0, 0);
        workspace.set_state(q, dq).unwrap();
        workspace.coriolis_matrix_into(&mut coriolis);
        assert!((&coriolis - expected).amax() < DIFFERENCE);
    });
}

#[test]
fn mass_coriolis_and_gravity_add_up_to_inverse_dynamics() {
    on_random_states(|arm, _, q, dq| {
        let ddq = dq.map(|value| 3.0 * value * value - 1.0);
        let mut workspace = arm.workspace();
        workspace.set_state(q, dq).unwrap();
        let (mut mass, mut coriolis) = (DMatrix::zeros(0, 0), DMatrix::zeros(0, 0));
        let (mut gravity, mut bias, mut torques) = (DVector::zeros(0), DVector::zeros(0), DVector::zeros(0));
        workspace.mass_matrix_into(&mut mass);
        workspace.coriolis_matrix_into(&mut coriolis);
        workspace.gravity_into(&mut gravity);
        workspace.bias_into(&mut bias);
        workspace.inverse_dynamics_into(&ddq, &mut torques).unwrap();
        assert!((&coriolis * dq + &gravity - &bias).amax() < IDENTITY);
        assert!((mass * &ddq + coriolis * dq + gravity - &torques).amax() < IDENTITY);
        let mut accelerations = DVector::zeros(0);
        workspace.forward_dynamics_into(&torques, &mut accelerations).unwrap();
        assert!((accelerations - ddq).amax() < 10.0 * IDENTITY, "forward dynamics undo inverse dynamics");
    });
}

#[test]
fn gravity_is_the_gradient_of_the_potential_energy() {
    on_random_states(|arm, _, q, _| {
        let mut workspace = arm.workspace();
        let mut gravity = DVector::zeros(0);
        workspace.set_positions(q).unwrap();
        workspace.gravity_into(&mut gravity);
        for joint in 0..q.len() {
            let mut energy_at = |offset: f64| {
                let mut moved = q.clone();
                moved[joint] += offset;
                workspace.set_positions(&moved).unwrap();
                workspace.potential_energy_j()
            };
            let slope = (energy_at(STEP) - energy_at(-STEP)) / (2.0 * STEP);
            assert!((slope - gravity[joint]).abs() < DIFFERENCE);
        }
    });
}

#[test]
fn kinetic_energy_is_half_the_mass_matrix_form() {
    on_random_states(|arm, _, q, dq| {
        let mut workspace = arm.workspace();
        workspace.set_state(q, dq).unwrap();
        let expected = 0.5 * dq.dot(&(mass_matrix(arm, q) * dq));
        assert!((workspace.kinetic_energy_j() - expected).abs() < IDENTITY);
    });
}

#[test]
fn jacobian_gives_the_frame_velocity_and_its_rate_the_bias_acceleration() {
    on_random_states(|arm, frame, q, dq| {
        let mut workspace = arm.workspace();
        let mut jacobian = Matrix6xX::zeros(0);
        let mut velocity_at = |time: f64| {
            workspace.set_state(&(q + dq * time), dq).unwrap();
            workspace.jacobian_into(frame, &mut jacobian);
            assert!((&jacobian * dq - workspace.frame_velocity(frame)).amax() < IDENTITY);
            (workspace.frame_velocity(frame), workspace.base_from_frame(frame))
        };
        let (ahead, pose_ahead) = velocity_at(STEP);
        let (behind, pose_behind) = velocity_at(-STEP);
        let (now, _) = velocity_at(0.0);
        let slope = (pose_ahead.translation.vector - pose_behind.translation.vector) / (2.0 * STEP);
        assert!((slope - now.fixed_rows::<3>(0)).amax() < DIFFERENCE);
        let turn = (pose_ahead.rotation * pose_behind.rotation.inverse()).scaled_axis() / (2.0 * STEP);
        assert!((turn - now.fixed_rows::<3>(3)).amax() < DIFFERENCE);
        let bias = workspace.jacobian_rate_times_velocity(frame);
        assert!(((ahead - behind) / (2.0 * STEP) - bias).amax() < DIFFERENCE);
    });
}

#[test]
fn jacobian_rate_is_the_derivative_of_the_jacobian() {
    on_random_states(|arm, frame, q, dq| {
        let mut workspace = arm.workspace();
        let mut jacobian_at = |time: f64| {
            let mut jacobian = Matrix6xX::zeros(0);
            workspace.set_positions(&(q + dq * time)).unwrap();
            workspace.jacobian_into(frame, &mut jacobian);
            jacobian
        };
        let expected = (jacobian_at(STEP) - jacobian_at(-STEP)) / (2.0 * STEP);
        let mut rate = Matrix6xX::zeros(0);
        workspace.set_state(q, dq).unwrap();
        workspace.jacobian_rate_into(frame, &mut rate);
        assert!((&rate - expected).amax() < DIFFERENCE);
        assert!((rate * dq - workspace.jacobian_rate_times_velocity(frame)).amax() < IDENTITY);
    });
}

#[test]
fn joint_description_rebuilds_the_body_poses() {
    on_random_states(|arm, _, q, _| {
        let mut workspace = arm.workspace();
        workspace.set_positions(q).unwrap();
        for (index, joint) in arm.joints().iter().enumerate() {
            let base_from_parent = joint.parent.map_or(Isometry3::identity(), |p| workspace.base_from_body(p).unwrap());
            let expected = base_from_parent * joint.parent_from_body(q[index]);
            let found = workspace.base_from_body(index).unwrap();
            assert!((found.to_homogeneous() - expected.to_homogeneous()).amax() < IDENTITY);
        }
    });
}

#[test]
fn mounting_turns_gravity_into_base_axes() {
    let mut arm = model(PLANAR_3R);
    let quarter = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2);
    arm.mount(Isometry3::from_parts(Translation3::new(0.0, -0.25, 0.0), quarter), Vector3::new(0.0, 0.0, -9.81));
    // the base's y axis points up in the world
    assert!((arm.gravity_in_base() - Vector3::new(0.0, -9.81, 0.0)).amax() < IDENTITY);
}

#[test]
fn gravity_does_no_work_on_the_planar_arm() {
    let arm = model(PLANAR_3R);
    let mut workspace = arm.workspace();
    let mut gravity = DVector::zeros(3);
    workspace.set_positions(&DVector::from_vec(vec![-0.7, 1.8, -1.0])).unwrap();
    workspace.gravity_into(&mut gravity);
    assert!(gravity.amax() < IDENTITY);
}
