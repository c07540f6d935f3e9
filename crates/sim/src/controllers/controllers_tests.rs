//! All controllers against the closed loop that their law promises.

use nalgebra::{DMatrix, DVector, Matrix6xX, Vector6};
use rand::RngExt;
use robot::{JointReference, JointState, Manipulator};

use super::*;
use crate::random::{Purpose, stream};

/// Rounding of sums of torques of up to 1000 N m.
const ROUNDING_NM: f64 = 1e-9;
const ROTORS: [f64; 7] = [0.195, 0.195, 0.195, 0.195, 0.074, 0.074, 0.074];
const PLANAR_ROTORS: [f64; 3] = [0.01; 3];
const READY: [f64; 7] = [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785];

fn panda(rotors: &[f64; 7]) -> Manipulator {
    let mut arm = Manipulator::from_urdf_str(include_str!("../../../../assets/robots/panda.urdf")).expect("valid");
    arm.set_rotor_inertia(rotors).expect("seven joints");
    arm
}

fn ready() -> DVector<f64> {
    DVector::from_column_slice(&READY)
}

fn pd() -> JointPdConfig {
    JointPdConfig { stiffness_nm_per_rad: vec![400.0], damping_nm_s_per_rad: vec![30.0] }
}

/// M ṙ + C r of the closed loop in a random state under a tip force, with what Ξ r and −JᵀF come to there:
/// (M ṙ + C r, r, M, −JᵀF), r = ė + `error_gain` e.
fn closed_loop(
    controller: &mut dyn Controller,
    error_gain: f64,
    trial: u64,
) -> (DVector<f64>, DVector<f64>, DMatrix<f64>, DVector<f64>) {
    let mut random = stream(1, Purpose::Variation, trial);
    let mut draw = |scale: f64| DVector::from_fn(7, |_, _| scale * (2.0 * random.random::<f64>() - 1.0));
    let state = JointState { q: ready() + draw(0.5), dq: draw(1.0) };
    let reference = JointReference { q: &state.q + draw(0.1), dq: draw(1.0), ddq: draw(2.0) };
    let arm = panda(&ROTORS);
    let mut workspace = arm.workspace();
    let (mut torque, mut acceleration) = (DVector::zeros(7), DVector::zeros(7));
    controller.torque(&mut workspace, &state, &reference, &mut torque).expect("seven joints");
    workspace.set_state(&state.q, &state.dq).expect("seven joints");
    let mut jacobian = Matrix6xX::zeros(7);
    workspace.jacobian_into(arm.frame("panda_hand_tcp").expect("known"), &mut jacobian);
    let load = jacobian.tr_mul(&Vector6::new(5.0, -3.0, 8.0, 0.1, -0.2, 0.3));
    workspace.forward_dynamics_into(&(torque + &load), &mut acceleration).expect("seven joints");
    let (mut mass, mut coriolis) = (DMatrix::zeros(7, 7), DMatrix::zeros(7, 7));
    workspace.mass_matrix_into(&mut mass);
    workspace.coriolis_matrix_into(&mut coriolis);
    let rate = &reference.dq - &state.dq;
    let sliding = &rate + (&reference.q - &state.q) * error_gain;
    let sliding_rate = &reference.ddq - acceleration + rate * error_gain;
    (&mass * sliding_rate + coriolis * &sliding, sliding, mass, -load)
}

#[test]
fn the_impedance_law_closes_the_loop_of_equation_34_exactly() {
    for trial in 0..20 {
        let mut controller = Impedance::new(&ImpedanceConfig::paper(), 7).expect("valid");
        let (left, sliding, _, load) = closed_loop(&mut controller, 3.0, trial);
        assert!((left + sliding * 10.0 - load).amax() < ROUNDING_NM);
    }
}

#[test]
fn the_inertia_shaped_law_closes_the_loop_with_its_own_damping_and_stays_passive() {
    let config = InertiaShapedConfig::default();
    for trial in 0..20 {
        let mut controller = InertiaShaped::new(&config, 7).expect("valid");
        let (left, sliding, mass, load) = closed_loop(&mut controller, config.error_gain_per_s, trial);
        let shaped = (mass.diagonal() * config.damping_rate_per_s).add_scalar(config.least_damping_nm_s_per_rad);
        assert!((&left + sliding.component_mul(&shaped) - &load).amax() < ROUNDING_NM);
        // d/dt ½rᵀMr = rᵀ(M ṙ + C r), as Ṁ − 2C is skew: less than the power of the load
        let stored = sliding.dot(&left);
        let least = config.least_damping_nm_s_per_rad * sliding.norm_squared();
        assert!(stored <= sliding.dot(&load) - least, "{stored}");
    }
}

#[test]
fn the_printed_law_feeds_errors_back_with_the_wrong_sign() {
    // on the printed plant −τ acts: M ṙ + C r − Ξ r = what does not fade
    let mut literal = Literal::new(&ImpedanceConfig::paper(), 7).expect("valid");
    let mut corrected = Impedance::new(&ImpedanceConfig::paper(), 7).expect("valid");
    let (arm, reference) = (panda(&ROTORS), JointReference::at_rest(ready()));
    let state = JointState::at_rest(ready().add_scalar(-0.1));
    let mut workspace = arm.workspace();
    let (mut printed, mut mended) = (DVector::zeros(7), DVector::zeros(7));
    literal.torque(&mut workspace, &state, &reference, &mut printed).expect("seven joints");
    corrected.torque(&mut workspace, &state, &reference, &mut mended).expect("seven joints");
    assert_eq!(printed, -mended);
}

/// Time, s, at which a joint of a bare Panda without stops is 50 rad off the ready posture that it is to hold, under torques
/// held for 0.1 ms; Euler steps of the equations of motion. `None` if that does not happen within 0.3 s.
fn time_of_loss_s(controller: &mut dyn Controller) -> Option<f64> {
    const STEP_S: f64 = 1e-4;
    let mut workspace = panda(&[0.0; 7]).workspace();
    let reference = JointReference::at_rest(ready());
    let mut state = JointState::at_rest(ready());
    let (mut torque, mut acceleration) = (DVector::zeros(7), DVector::zeros(7));
    (0..3000).map(|step| f64::from(step) * STEP_S).find(|_| {
        controller.torque(&mut workspace, &state, &reference, &mut torque).expect("seven joints");
        workspace.forward_dynamics_into(&torque, &mut acceleration).expect("seven joints");
        state.dq.axpy(STEP_S, &acceleration, 1.0);
        state.q.axpy(STEP_S, &state.dq, 1.0);
        (&state.q - &reference.q).amax() > 50.0
    })
}

#[test]
fn the_printed_law_loses_a_panda_within_a_fifth_of_a_second_and_the_mended_one_holds_it() {
    let lost_s = time_of_loss_s(&mut Literal::new(&ImpedanceConfig::paper(), 7).expect("valid"));
    println!("lost after {lost_s:?} s");
    assert!(lost_s.is_some_and(|time_s| time_s < 0.2), "{lost_s:?}");
    assert_eq!(time_of_loss_s(&mut Impedance::new(&ImpedanceConfig::paper(), 7).expect("valid")), None);
}

#[test]
fn the_linear_feedback_is_the_derivative_of_the_law() {
    const STEP: f64 = 1e-6;
    let arm = panda(&ROTORS);
    let configs = [
        ControllerConfig::Impedance(ImpedanceConfig::paper()),
        ControllerConfig::InertiaShaped(InertiaShapedConfig::default()),
        ControllerConfig::JointPd(pd()),
        ControllerConfig::Literal(ImpedanceConfig::paper()),
    ];
    for config in configs {
        let mut controller = config.build(7).expect("valid");
        let mut workspace = arm.workspace();
        let feedback = controller.feedback(&mut workspace, &ready()).expect("seven joints");
        let state = JointState::at_rest(ready());
        let mut at = |reference: &JointReference| {
            let mut torque = DVector::zeros(7);
            controller.torque(&mut workspace, &state, reference, &mut torque).expect("seven joints");
            torque
        };
        let rest = at(&JointReference::at_rest(ready()));
        for joint in 0..7 {
            let mut moved = JointReference::at_rest(ready());
            moved.q[joint] += STEP;
            let by_position = (at(&moved) - &rest) / STEP;
            moved = JointReference::at_rest(ready());
            moved.dq[joint] += STEP;
            let by_velocity = (at(&moved) - &rest) / STEP;
            let mut stiffness = DVector::zeros(7);
            stiffness[joint] = feedback.stiffness[joint];
            assert!((by_position - stiffness).amax() < 1e-5, "{config:?}");
            assert!((by_velocity - feedback.damping.column(joint)).amax() < 1e-5, "{config:?}");
        }
    }
}

/// A posture with the hand lifted, in which the wrist is lightest: 0.0046 kg m² against 0.0065 in the ready posture.
fn lifted() -> DVector<f64> {
    let mut posture = ready();
    posture[5] += 1.5;
    posture
}

#[test]
fn the_bound_moves_with_the_posture() {
    let controller = ControllerConfig::Impedance(ImpedanceConfig::paper()).build(7).expect("valid");
    let mut bare = panda(&[0.0; 7]).workspace();
    assert!(controller.check_stability(&mut bare, &ready(), 1e-3).is_ok());
    assert!(controller.check_stability(&mut bare, &lifted(), 1e-3).is_err());
}

#[test]
fn the_papers_gains_on_a_bare_panda_are_refused_with_the_remedy() {
    let controller = ControllerConfig::Impedance(ImpedanceConfig::paper()).build(7).expect("valid");
    let refused = controller.check_stability(&mut panda(&[0.0; 7]).workspace(), &lifted(), 1e-3).expect_err("unstable");
    let text = refused.to_string();
    assert_eq!(refused.field, "impedance.damping_nm_s_per_rad");
    for word in ["panda_joint7", "rotor inertia", "smaller gain", "control every 0.0009"] {
        assert!(text.contains(word), "{text}");
    }
    controller.check_stability(&mut panda(&ROTORS).workspace(), &lifted(), 1e-3).expect("rotors make it stable");
    controller.check_stability(&mut panda(&[0.0; 7]).workspace(), &lifted(), 0.5e-3).expect("2 kHz make it stable");
    let wrist = ImpedanceConfig {
        damping_nm_s_per_rad: vec![10.0, 10.0, 10.0, 10.0, 6.0, 6.0, 1.5],
        ..ImpedanceConfig::paper()
    };
    let controller = ControllerConfig::Impedance(wrist).build(7).expect("valid");
    controller.check_stability(&mut panda(&[0.0; 7]).workspace(), &lifted(), 1e-3).expect("a softer wrist is stable");
}

#[test]
fn the_printed_controller_is_built_for_tests_and_refused_in_scenarios() {
    let config: ControllerConfig = toml::from_str("[literal]\n").expect("a known controller");
    let text = config.validate(7).expect_err("refused").to_string();
    assert!(text.contains("literal") && text.contains("impedance") && text.contains("sign"), "{text}");
    let controller = config.build(7).expect("for tests");
    assert!(controller.check_stability(&mut panda(&ROTORS).workspace(), &ready(), 1e-3).is_err());
}

#[test]
fn a_description_tells_stiffness_settling_and_stability() {
    let arm = panda(&ROTORS);
    let tool = arm.frame("panda_hand_tcp").expect("known");
    let controller = ControllerConfig::Impedance(ImpedanceConfig::paper()).build(7).expect("valid");
    let text = controller.describe(&mut arm.workspace(), &ready(), tool, 1e-3).join("\n");
    for word in ["joint stiffness 30 N m/rad", "stiffness at the tool", "N/m", "settle to 2 % in 1.", "stable below 1"]
    {
        assert!(text.contains(word), "{text}");
    }
}

#[test]
fn states_and_references_of_another_arm_are_refused() {
    let arm = panda(&ROTORS);
    let configs = [ControllerConfig::Impedance(ImpedanceConfig::paper()), ControllerConfig::JointPd(pd())];
    for config in configs {
        let mut controller = config.build(7).expect("valid");
        let (right, wrong) = (ready(), DVector::zeros(6));
        for (q, wanted) in [(&wrong, &right), (&right, &wrong)] {
            let (state, reference) = (JointState::at_rest(q.clone()), JointReference::at_rest(wanted.clone()));
            let told = controller.torque(&mut arm.workspace(), &state, &reference, &mut DVector::zeros(7));
            assert!(told.is_err(), "{config:?}");
        }
    }
}

#[test]
fn gains_that_are_no_gains_are_named() {
    let impedance = |error_gain_per_s, damping_nm_s_per_rad| {
        ControllerConfig::Impedance(ImpedanceConfig { error_gain_per_s, damping_nm_s_per_rad })
    };
    let field = |config: ControllerConfig| config.validate(7).expect_err("invalid").field;
    assert_eq!(field(impedance(0.0, vec![1.0])), "impedance.error_gain_per_s");
    assert_eq!(field(impedance(1.0, vec![f64::NAN])), "impedance.damping_nm_s_per_rad");
    assert_eq!(field(impedance(1.0, vec![1.0; 6])), "impedance.damping_nm_s_per_rad");
    assert_eq!(
        field(ControllerConfig::InertiaShaped(InertiaShapedConfig { damping_rate_per_s: -1.0, ..Default::default() })),
        "inertia_shaped.damping_rate_per_s"
    );
    assert_eq!(
        field(ControllerConfig::JointPd(JointPdConfig { stiffness_nm_per_rad: vec![], ..pd() })),
        "joint_pd.stiffness_nm_per_rad"
    );
}

#[test]
fn joint_pd_without_gains_holds_the_shipped_arms_at_nearly_twice_their_control_period() {
    let planar = {
        let text = include_str!("../../../../assets/robots/planar_3r.urdf");
        let mut arm = Manipulator::from_urdf_str(text).expect("valid");
        // as the shipped pushes state it
        arm.set_rotor_inertia(&PLANAR_ROTORS).expect("three joints");
        arm
    };
    // stretched out, folded, and in between
    let planar_postures = [[0.0, 0.0, 0.0], [0.5, 1.2, 0.8], [0.3, 2.4, -1.5]].map(|q| DVector::from_column_slice(&q));
    let of_panda = [ready(), ready() * 0.5];
    for (arm, postures) in [(planar, &planar_postures[..]), (panda(&ROTORS), &of_panda[..])] {
        let mut controller = ControllerConfig::JointPd(JointPdConfig::default())
            .build(arm.joint_count())
            .expect("one number serves all");
        let mut workspace = arm.workspace();
        for q in postures {
            controller.check_stability(&mut workspace, q, 0.0019).expect("stable");
            let feedback = controller.feedback(&mut workspace, q).expect("its joints");
            assert!(feedback.stiffness.iter().all(|stiffness| *stiffness == 600.0));
        }
        let still = DVector::zeros(arm.joint_count());
        let state = JointState { q: postures[0].clone(), dq: still.clone() };
        let reference = JointReference { q: postures[0].clone(), dq: still.clone(), ddq: still.clone() };
        let mut torque = still.clone();
        controller.torque(&mut workspace, &state, &reference, &mut torque).expect("its joints");
        let mut gravity = still;
        workspace.set_state(&state.q, &state.dq).expect("its joints");
        workspace.gravity_into(&mut gravity);
        assert_eq!(torque, gravity, "where it should be, it holds the arm's weight and nothing else");
    }
}
