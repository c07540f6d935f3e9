//! A held rod pressed onto a block that stands fixed.

use nalgebra::{DVector, Isometry3, Matrix3, Matrix6xX, Point3, Translation3, UnitQuaternion, Vector3};
use rapier3d::prelude::{ColliderHandle, SharedShape};
use robot::{JointReference, JointState};
use sim::controllers::{Controller, Impedance, ImpedanceConfig};
use sim::spatial::{
    ArmConfig, EngineConfig, HeldTool, SpatialArm, SpatialWorld, ToolPiece, WrenchSensor, arm_with_tool,
    standard_gravity,
};

use super::fixture::{PERIOD_S, ROTORS, ready};

const RADIUS_M: f64 = 0.005;
const DEPTH_M: f64 = 0.005;

/// A rod along the hand's axis that ends in a ball, centered on the tool's frame.
fn rod() -> HeldTool {
    HeldTool {
        name: "rod".into(),
        mass_kg: 0.1,
        center_of_mass_m: Point3::new(0.0, 0.0, -0.05),
        inertia_kg_m2: Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-4, 1e-5)),
        grip_from_tool: Isometry3::translation(0.0, 0.0, 0.1),
        pieces: vec![ToolPiece {
            shape: SharedShape::capsule_z(0.03, RADIUS_M),
            tool_from_piece: Isometry3::translation(0.0, 0.0, -0.03),
            friction: 0.0,
        }],
        ..HeldTool::none()
    }
}

/// Force of the block on the rod, world axes, N, as the engine solved it.
fn contact_force_n(world: &SpatialWorld, block: ColliderHandle, rod: ColliderHandle) -> Vector3<f64> {
    let Some(pair) = world.physics.narrow_phase.contact_pair(block, rod) else { return Vector3::zeros() };
    let mut total = Vector3::zeros();
    for manifold in pair.solver_manifolds() {
        let impulse: f64 = manifold.points.iter().map(|point| point.data.impulse).sum();
        let normal = Vector3::new(manifold.data.normal.x, manifold.data.normal.y, manifold.data.normal.z);
        let sign = if pair.collider1 == block { 1.0 } else { -1.0 };
        total += normal * (sign * impulse / world.time_step_s());
    }
    total
}

#[test]
fn a_pressed_rod_meets_the_stiffness_law_and_the_arm_feels_it() {
    let tool = rod();
    let arm = robot::Manipulator::from_urdf_str(include_str!("../../../../assets/robots/panda.urdf")).expect("valid");
    let model = arm_with_tool(&arm, "panda_hand_tcp", &tool, &Isometry3::identity(), &standard_gravity(), &ROTORS)
        .expect("a valid arm");
    let engine = EngineConfig::default();
    let mut world = SpatialWorld::new(&engine, &standard_gravity()).expect("a valid scene");
    let q = ready();
    let mut arm = SpatialArm::insert(&mut world, &model, &tool, &ArmConfig::default(), &q).expect("a valid arm");
    let tip = arm.world_from_tool(&world).translation.vector;
    // its upper face is DEPTH_M above the rod's end
    let top = tip.z - RADIUS_M + DEPTH_M;
    let place = Isometry3::from_parts(Translation3::new(tip.x, tip.y, top - 0.1), UnitQuaternion::identity());

    let gains =
        ImpedanceConfig { error_gain_per_s: 10.0, damping_nm_s_per_rad: vec![40.0, 40.0, 40.0, 40.0, 10.0, 10.0, 5.0] };
    let mut controller = Impedance::new(&gains, 7).expect("valid gains");
    let mut workspace = model.workspace();
    // start clear of the block: raised by a centimeter, then led down to the ready posture
    let mut raised = robot::InverseKinematics::new(
        &model,
        arm.tool_frame(),
        robot::TaskRows::Pose,
        robot::InverseKinematicsOptions { preferred_posture: Some(q.clone()), ..Default::default() },
    )
    .expect("seven joints");
    let above = Translation3::new(0.0, 0.0, 0.01) * arm.world_from_tool(&world);
    let high = raised.solve(&above, &q).expect("within reach").q;
    let mut world = SpatialWorld::new(&engine, &standard_gravity()).expect("a valid scene");
    let block = world.insert_fixed(SharedShape::cuboid(0.1, 0.1, 0.1), &place, 0.0);
    arm = SpatialArm::insert(&mut world, &model, &tool, &ArmConfig::default(), &high).expect("a valid arm");
    let mut sensor = WrenchSensor::new(&model, arm.tool_frame(), &ArmConfig::default(), &high);

    let (mut state, mut torque) = (JointState::at_rest(high.clone()), DVector::zeros(7));
    let (mut truth, mut reading, mut count) = (Vector3::zeros(), Vector3::zeros(), 0.0);
    for period in 0..5000 {
        let share = (f64::from(period) * PERIOD_S).min(1.0);
        let wanted = JointReference::at_rest(&high + (&q - &high) * share);
        controller.torque(&mut workspace, &state, &wanted, &mut torque).expect("seven joints");
        arm.set_torques(&torque, PERIOD_S);
        arm.drive(&mut world);
        world.step();
        arm.read_state(&world, &mut state);
        let wrench = sensor.read(&state, arm.applied_torque_nm(), PERIOD_S).expect("seven joints");
        if period >= 4500 {
            truth += contact_force_n(&world, block, arm.tool_colliders()[0]);
            reading += wrench.fixed_rows::<3>(0);
            count += 1.0;
        }
    }
    let (truth, reading) = (truth / count, reading / count);
    // at rest K_q (q_ref − q) = −Jᵀ n F, and the rod's end is pushed up by DEPTH_M: F = DEPTH_M / (nᵀ J K_q⁻¹ Jᵀ n)
    let feedback = controller.feedback(&mut workspace, &q).expect("seven joints");
    let mut jacobian = Matrix6xX::zeros(7);
    workspace.set_positions(&q).expect("seven joints");
    workspace.jacobian_into(arm.tool_frame(), &mut jacobian);
    let expected = DEPTH_M / feedback.point_compliance(&jacobian)[(2, 2)];
    println!("stiffness law {expected} N, contact {} N, reading {} N", truth.z, reading.z);
    assert!((truth.z / expected - 1.0).abs() < 0.03, "{} {expected}", truth.z);
    assert!((reading - truth).norm() < 0.01 * truth.norm(), "{reading} {truth}");
}
