//! Stops, friction, rotors and motors of the simulated arm, against closed forms of a single joint.

use nalgebra::{DVector, Isometry3};
use robot::Manipulator;
use sim::spatial::{ArmConfig, EngineConfig, HeldTool, JointFriction, arm_with_tool, standard_gravity};

use super::fixture::{ROTORS, Scene, engine, panda, ready, rod};

/// A wheel of 0.1 kg m² about the vertical: nothing but inertia.
fn wheel(rotor: f64) -> Manipulator {
    let text = r#"<robot name="wheel"><link name="base"/><link name="rim"><inertial><mass value="1"/>
        <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
        <joint name="axle" type="revolute"><parent link="base"/><child link="rim"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="0.5" effort="2" velocity="9"/></joint></robot>"#;
    let arm = Manipulator::from_urdf_str(text).expect("a valid file");
    arm_with_tool(&arm, "rim", &HeldTool::none(), &Isometry3::identity(), &standard_gravity(), &[rotor])
        .expect("a valid arm")
}

fn spin(rotor: f64, friction: JointFriction, engine: &EngineConfig) -> Scene {
    let config = ArmConfig { friction: vec![friction], ..ArmConfig::default() };
    Scene::new(&wheel(rotor), &HeldTool::none(), &config, engine, &DVector::zeros(1))
}

fn torque(value: f64) -> DVector<f64> {
    DVector::from_element(1, value)
}

#[test]
fn a_stop_holds_against_the_motor_and_takes_the_motion() {
    let mut scene = spin(0.0, JointFriction::default(), &engine(1e-3, 2));
    let mut farthest: f64 = 0.0;
    for _ in 0..2000 {
        farthest = farthest.max(scene.step(&torque(1.0)).q[0]);
    }
    // it arrives at √(2·10·0.5) = 3.2 rad/s: at most one substep too far, then it is held
    assert!(farthest < 0.5 + 3.2 * 0.5e-3 + 1e-6, "{farthest}");
    assert!((scene.state.q[0] - 0.5).abs() < 1e-4, "{}", scene.state.q[0]);
    assert!(scene.state.dq[0].abs() < 1e-9, "{:e}", scene.state.dq[0]);
}

#[test]
fn the_stops_of_a_whole_arm_hold() {
    let mut scene = Scene::panda(&ROTORS, &engine(1e-3, 2), &ready());
    for _ in 0..1500 {
        scene.step(&DVector::zeros(7));
        let joints = scene.arm.model().joints().iter().zip(scene.state.q.iter().zip(scene.state.dq.iter()));
        for (joint, (q, dq)) in joints {
            let beyond = q - joint.limits.clamp(*q);
            assert!(beyond.abs() < 0.01 + dq.abs() * 1e-3, "`{}` is {beyond} rad beyond its stop", joint.name);
        }
    }
}

#[test]
fn a_rotor_adds_to_the_inertia() {
    for rotor in [0.0, 0.3] {
        let mut scene = spin(rotor, JointFriction::default(), &engine(1e-3, 1));
        let speed = scene.step(&torque(0.2)).dq[0];
        assert!((speed - 1e-3 * 0.2 / (0.1 + rotor)).abs() < 1e-15, "{speed}");
    }
}

#[test]
fn viscous_friction_lets_a_speed_fade_as_the_closed_form_says() {
    let friction = JointFriction { viscous_nm_s_per_rad: 0.4, ..JointFriction::default() };
    for (time_step_s, bound) in [(1e-3, 4e-3), (1e-4, 4e-4)] {
        let mut scene = spin(0.0, friction, &engine(time_step_s, 1));
        let periods = (0.25 / time_step_s) as usize;
        // dq = (τ/b)(1 − e^{−bt/I}); implicit Euler, so the error falls with the step
        for _ in 0..periods {
            scene.step(&torque(0.2));
        }
        let expected = 0.5 * (1.0 - (-0.4_f64 / 0.1 * 0.25).exp());
        assert!((scene.state.dq[0] / expected - 1.0).abs() < bound, "{} {expected}", scene.state.dq[0]);
    }
}

#[test]
fn coulomb_friction_holds_below_its_limit_and_takes_its_share_above() {
    let friction = JointFriction { coulomb_nm: 0.5, ..JointFriction::default() };
    let mut scene = spin(0.0, friction, &engine(1e-3, 1));
    for _ in 0..1000 {
        scene.step(&torque(0.49));
    }
    assert!(scene.state.q[0].abs() < 1e-9, "creeps by {:e} rad", scene.state.q[0]);
    for _ in 0..100 {
        scene.step(&torque(0.7));
    }
    let expected = 0.1 * (0.7 - 0.5) / 0.1;
    assert!((scene.state.dq[0] / expected - 1.0).abs() < 0.01, "{} {expected}", scene.state.dq[0]);
}

#[test]
fn motors_give_no_more_than_they_can_nor_faster() {
    let config = ArmConfig { torque_rate_limit_nm_per_s: Some(1000.0), ..ArmConfig::default() };
    let model = panda(&ROTORS);
    let mut scene = Scene::new(&model, &rod(), &config, &engine(1e-3, 1), &ready());
    let wanted = DVector::from_column_slice(&[500.0, -500.0, 3.5, 0.5, 20.0, 0.0, 0.0]);
    // 1 N m per millisecond
    assert!(scene.arm.set_torques(&wanted, 1e-3));
    assert_eq!(scene.arm.applied_torque_nm().as_slice(), &[1.0, -1.0, 1.0, 0.5, 1.0, 0.0, 0.0]);
    for _ in 0..100 {
        scene.arm.set_torques(&wanted, 1e-3);
    }
    assert_eq!(scene.arm.applied_torque_nm().as_slice(), &[87.0, -87.0, 3.5, 0.5, 12.0, 0.0, 0.0]);
    assert!(!scene.arm.set_torques(&DVector::from_column_slice(&[87.0, -87.0, 3.5, 0.5, 12.0, 0.0, 0.0]), 1e-3));
    scene.arm.preload(&wanted);
    assert_eq!(scene.arm.applied_torque_nm()[0], 87.0);
}

/// A wheel of 0.1 kg m² whose twin turns half as far the other way, 0.2 rad ahead.
fn coupled_wheels() -> Manipulator {
    let wheel = |name: &str| {
        format!(
            r#"<link name="{name}"><inertial><mass value="1"/>
            <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>"#
        )
    };
    let text = format!(
        r#"<robot name="wheels"><link name="base"/>{}{}
        <joint name="first" type="continuous"><parent link="base"/><child link="leader"/><axis xyz="0 0 1"/></joint>
        <joint name="second" type="continuous"><parent link="base"/><child link="follower"/><axis xyz="0 0 1"/>
        <mimic joint="first" multiplier="-0.5" offset="0.2"/></joint></robot>"#,
        wheel("leader"),
        wheel("follower")
    );
    let arm = Manipulator::from_urdf_str(&text).expect("a valid file");
    arm_with_tool(&arm, "leader", &HeldTool::none(), &Isometry3::identity(), &standard_gravity(), &[])
        .expect("a valid arm")
}

#[test]
fn a_joint_that_mimics_another_follows_it_and_weighs_on_it() {
    // the engine mends positions of a coupling softly: a thousandth of a radian is far more than it leaves
    const SOFTNESS_RAD: f64 = 1e-3;
    let (still, config) = (DVector::zeros(2), ArmConfig::default());
    let mut scene = Scene::new(&coupled_wheels(), &HeldTool::none(), &config, &engine(1e-3, 2), &still);
    for _ in 0..500 {
        let state = scene.step(&DVector::from_column_slice(&[0.2, 0.0]));
        assert!((state.q[1] - (0.2 - 0.5 * state.q[0])).abs() < SOFTNESS_RAD, "{:?}", state.q);
    }
    // energy: ½ (I + I/4) ω² = τ q
    let expected = (2.0 * 0.2 * scene.state.q[0] / (0.1 + 0.025)).sqrt();
    assert!((scene.state.dq[0] / expected - 1.0).abs() < 0.01, "{} and {expected}", scene.state.dq[0]);
}
