//! What evaluating an arm allocates after construction: nothing.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod common;

use common::{PLANAR_3R, READY, Random, THREE_FINGERS, model, panda, pose_of};
use nalgebra::{DMatrix, DVector, Matrix6xX, Vector6};
use robot::{
    DifferentialKinematics, FrameId, FrameMotion, InverseKinematics, InverseKinematicsOptions, JointReference,
    Manipulator, Redundancy, TaskRows,
};

fn allocations(work: impl FnOnce()) -> u64 {
    allocation_counter::measure(work).count_total
}

#[test]
fn counting_sees_an_allocation() {
    assert!(allocations(|| drop(std::hint::black_box(vec![1.0; 7]))) > 0);
}

#[test]
fn kinematics_and_dynamics_allocate_nothing() {
    for (arm, frame) in [panda(), with_last_frame(model(THREE_FINGERS)), with_last_frame(model(PLANAR_3R))] {
        let n = arm.joint_count();
        let mut workspace = arm.workspace();
        let mut random = Random(2);
        let (q, dq, efforts) = (random.posture(&arm, 0.0), random.vector(n, 2.0), random.vector(n, 5.0));
        let (mut matrix, mut vector, mut jacobian) = (DMatrix::zeros(n, n), DVector::zeros(n), Matrix6xX::zeros(n));
        let counted = allocations(|| {
            workspace.set_positions(&q).unwrap();
            workspace.set_state(&q, &dq).unwrap();
            std::hint::black_box(workspace.base_from_frame(frame));
            std::hint::black_box(workspace.frame_velocity(frame));
            workspace.jacobian_into(frame, &mut jacobian);
            workspace.jacobian_rate_into(frame, &mut jacobian);
            std::hint::black_box(workspace.jacobian_rate_times_velocity(frame));
            workspace.mass_matrix_into(&mut matrix);
            workspace.coriolis_matrix_into(&mut matrix);
            workspace.gravity_into(&mut vector);
            workspace.bias_into(&mut vector);
            workspace.inverse_dynamics_into(&efforts, &mut vector).unwrap();
            workspace.forward_dynamics_into(&efforts, &mut vector).unwrap();
            std::hint::black_box(workspace.kinetic_energy_j() + workspace.potential_energy_j());
        });
        assert_eq!(counted, 0, "{}", arm.name());
    }
}

fn with_last_frame(arm: Manipulator) -> (Manipulator, FrameId) {
    let last = arm.frame_names().last().unwrap().to_owned();
    let frame = arm.frame(&last).unwrap();
    (arm, frame)
}

#[test]
fn inverse_kinematics_allocate_nothing_with_restarts_and_with_a_preferred_posture() {
    let (arm, tip) = panda();
    for preferred_posture in [None, Some(DVector::from_column_slice(&READY))] {
        let options = InverseKinematicsOptions { preferred_posture, ..Default::default() };
        let mut solver = InverseKinematics::new(&arm, tip, TaskRows::Pose, options).unwrap();
        let mut random = Random(8);
        let mut longest = 0;
        for _ in 0..50 {
            let target = pose_of(&arm, tip, &random.posture(&arm, 0.1));
            let mut q = random.posture(&arm, 0.0);
            let mut solved = None;
            let counted = allocations(|| solved = Some(solver.solve_in_place(&target, &mut q)));
            let Some(Ok(report)) = solved else { continue };
            assert_eq!(counted, 0);
            longest = longest.max(report.iterations);
        }
        assert!(longest > 100, "some of them restarted: {longest}");
    }
}

#[test]
fn following_allocates_nothing() {
    let (arm, tip) = panda();
    let ready = DVector::from_column_slice(&READY);
    let wanted = FrameMotion {
        base_from_frame: pose_of(&arm, tip, &ready),
        velocity: Vector6::new(0.1, 0.0, -0.1, 0.2, 0.0, 0.1),
        acceleration: Vector6::zeros(),
    };
    let policy = Redundancy::toward(ready.add_scalar(0.1), 1e-3);
    for mut follower in [
        DifferentialKinematics::new(&arm, tip, TaskRows::Pose).unwrap(),
        DifferentialKinematics::with_redundancy(&arm, tip, TaskRows::Pose, policy).unwrap(),
    ] {
        let mut reference = JointReference::at_rest(ready.add_scalar(0.001));
        let counted = allocations(|| {
            for _ in 0..3 {
                follower.follow(&wanted, &mut reference).unwrap();
            }
        });
        assert_eq!(counted, 0);
    }
}
