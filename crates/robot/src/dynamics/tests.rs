//! Arms whose equations of motion can be written down by hand.

use approx::assert_relative_eq;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::{Manipulator, Workspace};

/// A handful of products and sums of numbers near one.
const ROUNDING: f64 = 1e-13;

/// A point of `mass` at the end of a rod of `length` along x that turns about y; gravity acts along −z.
fn pendulum_workspace(mass: f64, length: f64) -> Workspace {
    let text = format!(
        r#"<robot name="pendulum"><link name="base"/><link name="rod"><inertial><origin xyz="{length} 0 0"/>
        <mass value="{mass}"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
        <joint name="pivot" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>"#
    );
    Manipulator::from_urdf_str(&text).unwrap().workspace()
}

#[test]
fn pendulum_has_inertia_m_l_squared_and_gravity_m_g_l_cosine() {
    let mut pendulum = pendulum_workspace(2.0, 0.5);
    pendulum.set_positions(&DVector::from_element(1, 0.3)).unwrap();
    let (mut mass_matrix, mut gravity) = (DMatrix::zeros(0, 0), DVector::zeros(0));
    pendulum.mass_matrix_into(&mut mass_matrix);
    pendulum.gravity_into(&mut gravity);
    assert_relative_eq!(mass_matrix[0], 2.0 * 0.25, epsilon = ROUNDING);
    // turning about +y lowers the bob, so gravity is held by a negative torque
    assert_relative_eq!(gravity[0], -2.0 * 9.81 * 0.5 * 0.3_f64.cos(), epsilon = ROUNDING);
}

#[test]
fn rotor_inertia_adds_to_the_pendulum_in_every_algorithm() {
    let mut model = pendulum_workspace(2.0, 0.5).manipulator().clone();
    model.set_rotor_inertia(&[0.5]).unwrap();
    model.set_gravity(Vector3::zeros());
    let mut pendulum = model.workspace();
    let (mut mass_matrix, mut torque, mut acceleration) = (DMatrix::zeros(0, 0), DVector::zeros(0), DVector::zeros(0));
    pendulum.mass_matrix_into(&mut mass_matrix);
    pendulum.inverse_dynamics_into(&DVector::from_element(1, 3.0), &mut torque).unwrap();
    pendulum.forward_dynamics_into(&torque, &mut acceleration).unwrap();
    assert_relative_eq!(mass_matrix[0], 1.0, epsilon = ROUNDING);
    assert_relative_eq!(torque[0], 3.0, epsilon = ROUNDING);
    assert_relative_eq!(acceleration[0], 3.0, epsilon = ROUNDING);
}

#[test]
fn payload_adds_its_mass_at_its_place() {
    let model = pendulum_workspace(2.0, 0.5).manipulator().clone();
    let rod = model.frame("rod").unwrap();
    let inertia = Matrix3::from_diagonal_element(0.1);
    let mut loaded = model.attach_payload(rod, 1.0, Vector3::new(0.0, 0.0, 1.0), inertia).unwrap().workspace();
    let mut mass_matrix = DMatrix::zeros(0, 0);
    loaded.mass_matrix_into(&mut mass_matrix);
    assert_relative_eq!(mass_matrix[0], 0.5 + 1.0 + 0.1, epsilon = ROUNDING);
}

/// The textbook planar arm: links of 0.7 and 0.4 m, centers half way, 2 and 1 kg, in a vertical plane (gravity along −y).
fn planar_arm() -> Workspace {
    let text = r#"<robot name="planar"><link name="base"/>
        <link name="upper"><inertial><origin xyz="0.35 0 0"/><mass value="2"/>
            <inertia ixx="0" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
        <link name="lower"><inertial><origin xyz="0.2 0 0"/><mass value="1"/>
            <inertia ixx="0" ixy="0" ixz="0" iyy="0.05" iyz="0" izz="0.05"/></inertial></link>
        <joint name="shoulder" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
        <joint name="elbow" type="continuous"><origin xyz="0.7 0 0"/><parent link="upper"/><child link="lower"/>
            <axis xyz="0 0 1"/></joint></robot>"#;
    let mut model = Manipulator::from_urdf_str(text).unwrap();
    model.set_gravity(Vector3::new(0.0, -9.81, 0.0));
    model.workspace()
}

#[test]
fn two_link_arm_matches_the_textbook() {
    let mut arm = planar_arm();
    let (q1, q2, dq1, dq2): (f64, f64, f64, f64) = (0.4, 0.9, 1.3, -0.7);
    arm.set_state(&DVector::from_vec(vec![q1, q2]), &DVector::from_vec(vec![dq1, dq2])).unwrap();
    let (mut mass_matrix, mut coriolis) = (DMatrix::zeros(0, 0), DMatrix::zeros(0, 0));
    let mut gravity = DVector::zeros(0);
    arm.mass_matrix_into(&mut mass_matrix);
    arm.coriolis_matrix_into(&mut coriolis);
    arm.gravity_into(&mut gravity);
    let coupling = 0.7 * 0.2;
    let far = 0.05 + 0.2 * 0.2;
    let cross = far + coupling * q2.cos();
    let near = 0.1 + 2.0 * 0.35 * 0.35 + 0.7 * 0.7 + far + 2.0 * coupling * q2.cos();
    assert_relative_eq!(mass_matrix, DMatrix::from_row_slice(2, 2, &[near, cross, cross, far]), epsilon = ROUNDING);
    let h = -coupling * q2.sin();
    let expected = DMatrix::from_row_slice(2, 2, &[h * dq2, h * (dq1 + dq2), -h * dq1, 0.0]);
    assert_relative_eq!(coriolis, expected, epsilon = ROUNDING);
    let outer = 9.81 * 0.2 * (q1 + q2).cos();
    let inner = 9.81 * (2.0 * 0.35 + 0.7) * q1.cos();
    assert_relative_eq!(gravity, DVector::from_vec(vec![inner + outer, outer]), epsilon = ROUNDING);
}

#[test]
fn wrong_lengths_are_refused() {
    let mut arm = planar_arm();
    let error = arm.set_positions(&DVector::zeros(3)).unwrap_err();
    assert!(error.to_string().contains("3 entries; expected 2"), "{error}");
}
