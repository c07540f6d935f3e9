//! Kinematics and dynamics against the numbers of another program (Pinocchio 4.1.0).
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use common::{CARTPOLE, DOUBLE_PENDULUM, PANDA, model};
use nalgebra::{DMatrix, DVector, Matrix6xX};
use robot::{Manipulator, Workspace};
use serde_json::Value;

/// Poses and Jacobians: lengths near one, a chain of up to ten rotations.
const KINEMATIC: f64 = 1e-12;
/// Masses, torques: values up to 60 N m, a few hundred products each.
const DYNAMIC: f64 = 1e-10;
/// Forward dynamics, relative to the largest acceleration: the mass matrix has a condition number near 1e3.
const FORWARD: f64 = 1e-9;

fn samples(text: &str) -> Vec<Value> {
    let file: Value = serde_json::from_str(text).unwrap();
    file["samples"].as_array().unwrap().clone()
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().unwrap()],
    }
}

fn vector(value: &Value) -> DVector<f64> {
    DVector::from_vec(numbers(value))
}

fn square(value: &Value, n: usize) -> DMatrix<f64> {
    DMatrix::from_row_slice(n, n, &numbers(value))
}

fn assert_close(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let worst = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst <= tolerance, "{what}: differs by {worst:e}");
}

fn check_kinematics(arm: &Manipulator, workspace: &Workspace, sample: &Value) {
    for (name, pose) in sample["frames"].as_object().unwrap() {
        let found = workspace.base_from_frame(arm.frame(name).unwrap());
        let rotation = found.rotation.to_rotation_matrix().matrix().transpose();
        assert_close(name, rotation.as_slice(), &numbers(&pose["R"]), KINEMATIC);
        assert_close(name, found.translation.vector.as_slice(), &numbers(&pose["p"]), KINEMATIC);
    }
    for (name, rates) in sample["jacobians"].as_object().unwrap() {
        let frame = arm.frame(name).unwrap();
        let mut jacobian = Matrix6xX::zeros(0);
        workspace.jacobian_into(frame, &mut jacobian);
        assert_close("J", jacobian.transpose().as_slice(), &numbers(&rates["J"]), KINEMATIC);
        let velocity = workspace.frame_velocity(frame);
        assert_close("velocity", velocity.as_slice(), &numbers(&rates["velocity"]), KINEMATIC);
        let bias = workspace.jacobian_rate_times_velocity(frame);
        assert_close("J̇ q̇", bias.as_slice(), &numbers(&rates["bias_acceleration"]), 10.0 * KINEMATIC);
    }
}

fn check_dynamics(workspace: &mut Workspace, sample: &Value, n: usize) {
    let (mut matrix, mut torques) = (DMatrix::zeros(n, n), DVector::zeros(n));
    workspace.mass_matrix_into(&mut matrix);
    assert_close("M", matrix.as_slice(), square(&sample["M"], n).as_slice(), DYNAMIC);
    workspace.coriolis_matrix_into(&mut matrix);
    assert_close("C", matrix.as_slice(), square(&sample["C"], n).as_slice(), DYNAMIC);
    workspace.gravity_into(&mut torques);
    assert_close("g", torques.as_slice(), &numbers(&sample["g"]), DYNAMIC);
    workspace.bias_into(&mut torques);
    assert_close("bias", torques.as_slice(), &numbers(&sample["bias"]), DYNAMIC);
    workspace.inverse_dynamics_into(&vector(&sample["ddq"]), &mut torques).unwrap();
    assert_close("inverse dynamics", torques.as_slice(), &numbers(&sample["inverse_dynamics"]), DYNAMIC);
    assert_close("kinetic energy", &[workspace.kinetic_energy_j()], &numbers(&sample["kinetic"]), DYNAMIC);
    workspace.forward_dynamics_into(&vector(&sample["torque"]), &mut torques).unwrap();
    let expected = vector(&sample["forward_dynamics"]);
    let tolerance = FORWARD * expected.amax().max(1.0);
    assert_close("forward dynamics", torques.as_slice(), expected.as_slice(), tolerance);
}

fn check(urdf: &str, reference: &str) {
    let arm = model(urdf);
    let n = arm.joint_count();
    let mut workspace = arm.workspace();
    let samples = samples(reference);
    assert!(samples.len() >= 10, "the reference has its samples");
    for sample in &samples {
        workspace.set_state(&vector(&sample["q"]), &vector(&sample["dq"])).unwrap();
        check_kinematics(&arm, &workspace, sample);
        check_dynamics(&mut workspace, sample, n);
    }
}

#[test]
fn double_pendulum_matches_the_reference() {
    check(DOUBLE_PENDULUM, include_str!("data/double_pendulum.json"));
}

#[test]
fn cartpole_matches_the_reference() {
    check(CARTPOLE, include_str!("data/cartpole.json"));
}

#[test]
fn panda_matches_the_reference() {
    check(PANDA, include_str!("data/panda.json"));
}
