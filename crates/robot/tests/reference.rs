//! Kinematics, dynamics and free fall against the numbers of another program (Pinocchio 4.1.0; trajectories by SciPy's
//! DOP853 and by a classical Runge-Kutta method on Pinocchio's forward dynamics).
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use common::{CARTPOLE, DOUBLE_PENDULUM, GANTRY, PANDA, THREE_FINGERS, TWO_ARMS, model};
use nalgebra::{DMatrix, DVector, Matrix3, Matrix6xX, Vector3};
use robot::{Manipulator, Workspace};
use serde_json::Value;

/// Poses and Jacobians: lengths near one, a chain of up to ten rotations.
const KINEMATIC: f64 = 1e-12;
/// Masses, torques: values up to 60 N m, a few hundred products each.
const DYNAMIC: f64 = 1e-10;
/// Forward dynamics, relative to the largest acceleration: the mass matrices have condition numbers of 1e3 to 1e5.
const FORWARD: f64 = 1e-9;
/// Free fall up to 0.3 s against the exact solution, relative to the state.
const FALL: f64 = 1e-9;
/// Step at which light links that swing fast meet that; the Panda does at 1 ms.
const FINE_STEP_S: f64 = 2e-4;
/// Free fall of one second against the same method, relative to the state: the flow magnifies rounding about ten thousand fold.
const FALL_ALIKE: f64 = 1e-10;
/// Step of the references' Runge-Kutta method.
const FALL_STEP_S: f64 = 1e-3;

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

fn check(arm: &Manipulator, reference: &str) {
    let n = arm.joint_count();
    let mut workspace = arm.workspace();
    let reference: Value = serde_json::from_str(reference).unwrap();
    let names: Vec<&str> = arm.joints().iter().map(|joint| joint.name.as_str()).collect();
    assert_eq!(serde_json::json!(names), reference["joints"], "both programs order the joints alike");
    let samples = reference["samples"].as_array().unwrap();
    assert!(samples.len() >= 4, "the reference has its samples");
    for sample in samples {
        workspace.set_state(&vector(&sample["q"]), &vector(&sample["dq"])).unwrap();
        check_kinematics(arm, &workspace, sample);
        check_dynamics(&mut workspace, sample, n);
    }
}

/// Positions and velocities under no torque.
struct Fall {
    workspace: Workspace,
    q: DVector<f64>,
    dq: DVector<f64>,
    step_s: f64,
    steps: u32,
}

impl Fall {
    fn new(arm: &Manipulator, q: DVector<f64>, step_s: f64) -> Self {
        Self { workspace: arm.workspace(), dq: DVector::zeros(q.len()), q, step_s, steps: 0 }
    }

    /// Falls on to a time; returns the positions, then the velocities.
    fn at(&mut self, time_s: f64) -> Vec<f64> {
        while f64::from(self.steps) * self.step_s < time_s - 0.5 * self.step_s {
            self.step();
            self.steps += 1;
        }
        [self.q.as_slice(), self.dq.as_slice()].concat()
    }

    fn acceleration(&mut self, q: &DVector<f64>, dq: &DVector<f64>) -> DVector<f64> {
        let mut ddq = DVector::zeros(q.len());
        self.workspace.set_state(q, dq).unwrap();
        self.workspace.forward_dynamics_into(&DVector::zeros(q.len()), &mut ddq).unwrap();
        ddq
    }

    /// One step of the classical Runge-Kutta method.
    fn step(&mut self) {
        let h = self.step_s;
        let (q, dq) = (self.q.clone(), self.dq.clone());
        let a1 = self.acceleration(&q, &dq);
        let v2 = &dq + 0.5 * h * &a1;
        let a2 = self.acceleration(&(&q + 0.5 * h * &dq), &v2);
        let v3 = &dq + 0.5 * h * &a2;
        let a3 = self.acceleration(&(&q + 0.5 * h * &v2), &v3);
        let v4 = &dq + h * &a3;
        let a4 = self.acceleration(&(&q + h * &v3), &v4);
        self.q += h / 6.0 * (dq + 2.0 * v2 + 2.0 * v3 + v4);
        self.dq += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
}

/// Compares free fall with the same method at its step, and with the exact solution at `exact_step_s`.
fn check_fall(arm: &Manipulator, reference: &str, exact_step_s: f64) {
    let reference: Value = serde_json::from_str(reference).unwrap();
    let start = vector(&reference["free_fall"]["q"]);
    let mut alike = Fall::new(arm, start.clone(), FALL_STEP_S);
    let mut exact = Fall::new(arm, start, exact_step_s);
    for row in reference["free_fall"]["rows"].as_array().unwrap() {
        let time_s = row["time_s"].as_f64().unwrap();
        let expected = numbers(&row["rk4"]);
        let scale = expected.iter().fold(1.0_f64, |largest, value| largest.max(value.abs()));
        assert_close(&format!("fall of {time_s} s, same method"), &alike.at(time_s), &expected, FALL_ALIKE * scale);
        if time_s <= 0.3 {
            assert_close(&format!("fall of {time_s} s"), &exact.at(time_s), &numbers(&row["truth"]), FALL * scale);
        }
    }
    assert_eq!((alike.steps, f64::from(exact.steps) * exact_step_s), (1000, 0.3));
}

/// Checks a URDF against its reference, samples and free fall.
fn check_urdf(urdf: &str, reference: &str, exact_step_s: f64) {
    let arm = model(urdf);
    check(&arm, reference);
    check_fall(&arm, reference, exact_step_s);
}

#[test]
fn double_pendulum_matches_the_reference() {
    check_urdf(DOUBLE_PENDULUM, include_str!("data/double_pendulum.json"), FINE_STEP_S);
}

#[test]
fn cartpole_matches_the_reference() {
    check_urdf(CARTPOLE, include_str!("data/cartpole.json"), FINE_STEP_S);
}

#[test]
fn panda_matches_the_reference() {
    check_urdf(PANDA, include_str!("data/panda.json"), FALL_STEP_S);
}

#[test]
fn tree_of_two_arms_on_a_lift_matches_the_reference() {
    check_urdf(TWO_ARMS, include_str!("data/two_arms.json"), FINE_STEP_S);
}

#[test]
fn gantry_with_skew_axes_matches_the_reference() {
    check_urdf(GANTRY, include_str!("data/gantry.json"), FINE_STEP_S);
}

#[test]
fn hand_of_three_fingers_matches_the_reference() {
    check_urdf(THREE_FINGERS, include_str!("data/three_fingers.json"), FINE_STEP_S);
}

/// 1.2 kg beside a frame's origin, with an inertia of its own; the references have it as one more link with a fixed joint.
fn with_payload(urdf: &str, frame: &str) -> Manipulator {
    let arm = model(urdf);
    let inertia = Matrix3::new(0.004, 0.0005, -0.0003, 0.0005, 0.003, 0.0002, -0.0003, 0.0002, 0.002);
    let frame = arm.frame(frame).unwrap();
    let mut loaded = arm.attach_payload(frame, 1.2, Vector3::new(0.02, -0.03, 0.05), inertia).unwrap();
    loaded.add_frame("payload", frame, nalgebra::Isometry3::identity()).unwrap();
    loaded
}

#[test]
fn payload_in_the_pandas_hand_acts_like_a_link_of_the_reference() {
    check(&with_payload(PANDA, "panda_hand_tcp"), include_str!("data/panda_payload.json"));
}

#[test]
fn payload_behind_a_slide_and_turned_mounts_acts_like_a_link_of_the_reference() {
    check(&with_payload(TWO_ARMS, "left_tool"), include_str!("data/two_arms_payload.json"));
}
