//! The arm in the engine against the equations of motion of the robot crate, two programs that share nothing but the model.

use approx::assert_relative_eq;
use nalgebra::{DVector, Isometry3, Matrix6xX, Point3, Translation3, UnitQuaternion, Vector3, Vector6};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use robot::{JointReference, JointState, Manipulator, RobotError, Workspace};
use sim::controllers::{Controller, Feedback, JointPd, JointPdConfig};
use sim::random::{Purpose, stream};
use sim::spatial::{ArmConfig, HeldTool, arm_with_tool, standard_gravity};

use super::fixture::{PERIOD_S, ROTORS, Scene, engine, free, panda, ready, rod};

/// Difference of the two programs' accelerations from rest, relative to the largest: rounding, times the condition of M (400).
const ROUNDING: f64 = 1e-12;

fn uniform(random: &mut ChaCha8Rng, joints: usize, largest: f64) -> DVector<f64> {
    DVector::from_fn(joints, |_, _| largest * (2.0 * random.random::<f64>() - 1.0))
}

/// A posture well inside the limits.
fn posture(random: &mut ChaCha8Rng, model: &Manipulator) -> DVector<f64> {
    let within = |joint: &robot::Joint| {
        let (lower, upper) = (joint.limits.lower.unwrap_or(-2.0), joint.limits.upper.unwrap_or(2.0));
        lower + (upper - lower) * (0.1 + 0.8 * random.random::<f64>())
    };
    DVector::from_iterator(model.joint_count(), model.joints().iter().map(within))
}

fn accelerations(workspace: &mut Workspace, state: &JointState, torque: &DVector<f64>) -> DVector<f64> {
    let mut acceleration = DVector::zeros(torque.len());
    workspace.set_state(&state.q, &state.dq).expect("as many joints");
    workspace.forward_dynamics_into(torque, &mut acceleration).expect("as many joints");
    acceleration
}

/// A tree with what the Panda lacks: sliding joints, two branches, skew axes, a base that carries two of them.
fn tree(rotors: &[f64]) -> Manipulator {
    let link = |name: &str, mass: f64, center: &str| {
        format!(
            r#"<link name="{name}"><inertial><origin xyz="{center}" rpy="0.3 -0.2 0.5"/><mass value="{mass}"/>
            <inertia ixx="0.02" ixy="0.001" ixz="-0.002" iyy="0.03" iyz="0.0015" izz="0.025"/></inertial></link>"#
        )
    };
    let joint = |name: &str, kind: &str, ends: (&str, &str), origin: &str, axis: &str| {
        format!(
            r#"<joint name="{name}" type="{kind}"><origin xyz="{origin}" rpy="0.4 0.1 -0.3"/><parent link="{}"/>
            <child link="{}"/><axis xyz="{axis}"/><limit lower="-1.5" upper="1.5" effort="500" velocity="9"/></joint>"#,
            ends.0, ends.1
        )
    };
    let text = [
        r#"<robot name="tree"><link name="base"/>"#.into(),
        link("rail", 2.0, "0.1 0 0"),
        link("left", 1.5, "0 0.1 0.05"),
        link("right", 1.0, "-0.1 0 0.1"),
        link("slide", 0.7, "0.02 0.03 0"),
        link("hand", 0.4, "0 0 0.05"),
        link("post", 3.0, "0.05 0.05 0.2"),
        joint("j_rail", "prismatic", ("base", "rail"), "0 0 0.2", "1 0 0"),
        joint("j_left", "revolute", ("rail", "left"), "0.1 0.2 0", "0 0.6 0.8"),
        joint("j_right", "revolute", ("rail", "right"), "0.1 -0.2 0", "0 1 0"),
        joint("j_slide", "prismatic", ("right", "slide"), "0 0 0.3", "0.48 0.6 0.64"),
        joint("j_hand", "continuous", ("slide", "hand"), "0.05 0 0.1", "0 0 1"),
        joint("j_post", "revolute", ("base", "post"), "-0.5 0 0", "0 1 0"),
        "</robot>".into(),
    ];
    let arm = Manipulator::from_urdf_str(&text.concat()).expect("a valid tree");
    let base =
        Isometry3::from_parts(Translation3::new(0.1, 0.2, 0.3), UnitQuaternion::from_euler_angles(0.3, 0.1, -0.7));
    arm_with_tool(&arm, "hand", &rod(), &base, &standard_gravity(), rotors).expect("a valid arm")
}

/// Largest difference of the engine's acceleration from rest from that of the equations, relative, over random postures,
/// torques and forces on a point of the tool.
fn worst_from_rest(model: &Manipulator, pushed: bool) -> f64 {
    let mut random = stream(1, Purpose::Variation, 0);
    let mut workspace = model.workspace();
    let joints = model.joint_count();
    let mut jacobian = Matrix6xX::zeros(joints);
    let draws = (0..50).map(|_| {
        let q = posture(&mut random, model);
        let torque = uniform(&mut random, joints, 10.0);
        let mut scene = Scene::new(model, &rod(), &ArmConfig::default(), &engine(1e-3, 1), &q);
        let mut load = torque.clone();
        scene.arm.set_torques(&torque, PERIOD_S);
        scene.arm.drive(&mut scene.world);
        if pushed {
            let force = Vector3::from_fn(|_, _| 20.0 * (random.random::<f64>() - 0.5));
            let at = scene.arm.world_from_tool(&scene.world) * Point3::new(0.02, -0.01, 0.03);
            scene.arm.push_tool(&mut scene.world, &force, &at);
            let (force, at) = (model.world_from_base().inverse() * force, model.world_from_base().inverse() * at);
            workspace.set_positions(&q).expect("as many joints");
            let tool = model.frame("tool").expect("added");
            workspace.jacobian_into(tool, &mut jacobian);
            let moment = (at.coords - workspace.base_from_frame(tool).translation.vector).cross(&force);
            load += jacobian.tr_mul(&Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z));
        }
        scene.world.step();
        scene.arm.read_state(&scene.world, &mut scene.state);
        let expected = accelerations(&mut workspace, &JointState::at_rest(q), &load);
        (&scene.state.dq / 1e-3 - &expected).amax() / expected.amax()
    });
    draws.fold(0.0, f64::max)
}

#[test]
fn one_step_from_rest_is_what_forward_dynamics_says() {
    for (name, model) in [
        ("panda", panda(&[])),
        ("panda with rotors", panda(&ROTORS)),
        ("tree", tree(&[])),
        ("tree with rotors", tree(&[0.5, 0.1, 0.2, 0.3, 0.05, 0.4])),
    ] {
        let worst = worst_from_rest(&model, false);
        assert!(worst < ROUNDING, "{name}: {worst:e}");
    }
}

#[test]
fn a_force_on_the_tool_acts_by_the_transposed_jacobian() {
    for (name, model) in [("panda", panda(&[])), ("tree", tree(&[0.5, 0.1, 0.2, 0.3, 0.05, 0.4]))] {
        let worst = worst_from_rest(&model, true);
        assert!(worst < ROUNDING, "{name}: {worst:e}");
    }
}

/// Mean relative difference of the engine's acceleration from that of the equations, from states of up to 1 rad/s.
fn moving(model: &Manipulator, time_step_s: f64, substeps: usize) -> f64 {
    let mut random = stream(2, Purpose::Variation, 0);
    let mut workspace = model.workspace();
    let joints = model.joint_count();
    let mut total = 0.0;
    const DRAWS: usize = 40;
    for _ in 0..DRAWS {
        let q = posture(&mut random, model);
        let mut scene = Scene::new(model, &rod(), &ArmConfig::default(), &engine(time_step_s, substeps), &q);
        // brought to speed by the engine itself: torques for an acceleration of 1 rad/s within ten steps
        let wanted = uniform(&mut random, joints, 1.0);
        let mut torque = DVector::zeros(joints);
        for _ in 0..10 {
            workspace.set_state(&scene.state.q, &scene.state.dq).expect("as many joints");
            workspace.inverse_dynamics_into(&(&wanted / (10.0 * time_step_s)), &mut torque).expect("as many joints");
            let limitless = torque.clone();
            scene.arm.preload(&limitless);
            scene.arm.drive(&mut scene.world);
            scene.world.step();
            scene.arm.read_state(&scene.world, &mut scene.state);
        }
        let before = scene.state.clone();
        let torque = uniform(&mut random, joints, 10.0);
        let expected = accelerations(&mut workspace, &before, &torque);
        scene.step(&torque);
        let seen = (&scene.state.dq - &before.dq) / time_step_s;
        total += (seen - &expected).amax() / expected.amax();
    }
    total / DRAWS as f64
}

#[test]
fn the_error_of_a_step_in_motion_falls_with_the_substep() {
    let model = panda(&[]);
    let coarse = moving(&model, 1e-3, 1);
    let fine = moving(&model, 1e-4, 1);
    println!("mean error of one step at up to 1 rad/s: {coarse:e} at 1 ms, {fine:e} at 0.1 ms");
    // 7e-4 and 7e-5 are what the engine's semi-implicit step is known to leave
    assert!(coarse < 1e-3, "{coarse:e}");
    assert!(fine < coarse / 5.0, "at least first order in the step: {coarse:e} {fine:e}");
}

#[test]
fn the_tool_is_and_moves_where_forward_kinematics_says() {
    let model = panda(&ROTORS);
    let mut scene = Scene::panda(&ROTORS, &engine(1e-3, 1), &ready());
    let tool = model.frame("tool").expect("added");
    let mut workspace = model.workspace();
    for _ in 0..50 {
        scene.step(&DVector::from_column_slice(&[5.0, -40.0, 3.0, 20.0, -1.0, 2.0, 1.0]));
    }
    workspace.set_state(&scene.state.q, &scene.state.dq).expect("seven joints");
    let expected = model.world_from_base() * workspace.base_from_frame(tool);
    let seen = scene.arm.world_from_tool(&scene.world);
    assert_relative_eq!(seen.to_homogeneous(), expected.to_homogeneous(), epsilon = 1e-12);
    let twist = scene.arm.tool_velocity(&scene.world);
    let in_base = workspace.frame_velocity(tool);
    let turn = model.world_from_base().rotation;
    assert_relative_eq!(twist.fixed_rows::<3>(0).into_owned(), turn * in_base.fixed_rows::<3>(0), epsilon = 1e-12);
    assert_relative_eq!(twist.fixed_rows::<3>(3).into_owned(), turn * in_base.fixed_rows::<3>(3), epsilon = 1e-12);
}

/// Computed torque: τ = M (q̈ᵈ + D ė + K e) + C q̇ + g.
struct ComputedTorque {
    proportional: f64,
    derivative: f64,
}

impl Controller for ComputedTorque {
    fn torque(
        &mut self,
        workspace: &mut Workspace,
        state: &JointState,
        reference: &JointReference,
        torque_nm: &mut DVector<f64>,
    ) -> Result<(), RobotError> {
        workspace.set_state(&state.q, &state.dq)?;
        let wanted = &reference.ddq
            + (&reference.dq - &state.dq) * self.derivative
            + (&reference.q - &state.q) * self.proportional;
        workspace.inverse_dynamics_into(&wanted, torque_nm)
    }

    fn feedback(&self, workspace: &mut Workspace, q: &DVector<f64>) -> Result<Feedback, RobotError> {
        let config = JointPdConfig { stiffness_nm_per_rad: vec![1.0], damping_nm_s_per_rad: vec![1.0] };
        JointPd::new(&config, q.len()).expect("positive gains").feedback(workspace, q)
    }

    fn decisive_gain(&self) -> (&'static str, &'static str) {
        ("computed_torque", "derivative")
    }
}

/// Sinusoids of 0.3 rad, 0.3 to 0.9 Hz, about the ready posture.
fn sinusoids(t: f64) -> JointReference {
    let mut reference = JointReference::at_rest(ready());
    for joint in 0..7 {
        let rate = std::f64::consts::TAU * (0.3 + 0.1 * joint as f64);
        reference.q[joint] += 0.3 * (rate * t).sin();
        reference.dq[joint] = 0.3 * rate * (rate * t).cos();
        reference.ddq[joint] = -0.3 * rate * rate * (rate * t).sin();
    }
    reference
}

/// Root mean square joint error, rad, of computed torque on sinusoids over 5 s.
fn tracking_rmse(substeps: usize) -> f64 {
    let model = panda(&[]);
    let mut scene = Scene::panda(&[], &engine(PERIOD_S, substeps), &ready());
    let mut controller = ComputedTorque { proportional: 400.0, derivative: 40.0 };
    let (mut workspace, mut torque) = (model.workspace(), DVector::zeros(7));
    let (mut total, mut count) = (0.0, 0.0);
    // the first second is left out: the arm starts at rest, the reference in motion
    for period in 0..6000 {
        let wanted = sinusoids(f64::from(period) * PERIOD_S);
        controller.torque(&mut workspace, &scene.state, &wanted, &mut torque).expect("seven joints");
        if period >= 1000 {
            total += (&wanted.q - &scene.state.q).norm_squared() / 7.0;
            count += 1.0;
        }
        scene.step(&torque);
    }
    f64::sqrt(total / count)
}

#[test]
fn computed_torque_tracks_sinusoids_as_closely_as_held_torques_can() {
    // an ideal plant under torques held for 1 ms is left 1.2e-4 rad behind
    for (substeps, bound) in [(1, 2e-4), (2, 1.5e-4), (4, 1.2e-4)] {
        let rmse = tracking_rmse(substeps);
        println!("{substeps} substeps: {rmse:e} rad");
        assert!(rmse < bound, "{substeps} substeps: {rmse:e}");
    }
}

#[test]
fn a_compensated_weight_stays_where_it_is() {
    let model = panda(&[]);
    let mut scene = Scene::panda(&[], &engine(PERIOD_S, 1), &ready());
    let (mut workspace, mut torque) = (model.workspace(), DVector::zeros(7));
    for _ in 0..5000 {
        workspace.set_positions(&scene.state.q).expect("seven joints");
        workspace.gravity_into(&mut torque);
        scene.step(&torque);
    }
    let drift = (&scene.state.q - ready()).amax();
    assert!(drift < 1e-9, "{drift:e} rad in 5 s");
}

#[test]
fn a_bare_hand_is_a_tool_too() {
    let model = super::fixture::panda_with(&HeldTool::none(), &ROTORS);
    let mut scene = Scene::new(&model, &HeldTool::none(), &ArmConfig::default(), &engine(PERIOD_S, 2), &ready());
    let config = JointPdConfig { stiffness_nm_per_rad: vec![400.0], damping_nm_s_per_rad: vec![20.0] };
    let mut controller = JointPd::new(&config, 7).expect("valid gains");
    let error = scene.run(&model, &mut controller, &|_| JointReference::at_rest(ready()), 0.5, &free);
    assert!(error < 1e-9, "{error:e}");
}
