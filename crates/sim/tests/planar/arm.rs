//! The arm in the engine against its own equations, and the controller against its law.

use approx::assert_relative_eq;
use nalgebra::{DVector, Isometry2, Matrix6xX, Vector2, Vector3, Vector6};
use robot::{JointReference, JointState, Manipulator};
use sim::controllers::{Controller, Impedance, ImpedanceConfig};
use sim::planar::{
    ArmDescription, EngineConfig, MapBounds, ObjectConfig, Obstacle, OpenLoop, Party, PlanarArm, PlanarSetup,
    PlanarWorld, SceneDescription, WorldConfig, arm_with_tool, check_reach, simulate,
};
use sim::random::{Purpose, stream};
use sim::sensing::{Camera, CameraConfig};
use sim::support::SupportModel;
use skills::outline::{Outline, PlacedOutline};
use skills::plan::{Action, ActionKind, Plan, PlanarMotion, Track};
use skills::tool::{ContactSurface, SurfaceShape, Tool};

use super::quasi_static;

const FLANGE: &str = "flange";
const PERIOD_S: f64 = 0.001;
pub const POSTURE: [f64; 3] = [-0.9, 1.8, -0.9];

fn stick() -> Tool {
    let shape = SurfaceShape::Face { start_m: [0.006, 0.03], end_m: [-0.006, 0.03] };
    Tool {
        name: "stick".into(),
        description: String::new(),
        mass_kg: 0.05,
        friction: 0.3,
        pieces: vec![PlacedOutline {
            shape: Outline::Box { width_m: 0.012, height_m: 0.03 },
            position_m: [0.0, 0.015],
            angle_rad: 0.0,
        }],
        surfaces: vec![ContactSurface::new("tip", shape)],
    }
}

pub fn model(rotor_inertia: f64) -> Manipulator {
    let arm =
        Manipulator::from_urdf_str(include_str!("../../../../assets/robots/planar_3r.urdf")).expect("a valid file");
    let base = Isometry2::new(Vector2::new(0.0, -0.25), 0.1);
    arm_with_tool(&arm, FLANGE, &stick(), &base, 9.81, &[rotor_inertia; 3]).expect("a valid arm")
}

fn world(obstacles: Vec<Obstacle>, time_step_s: f64) -> PlanarWorld {
    let map = MapBounds { min_m: [-1.0, -1.0], max_m: [1.0, 1.0] };
    let world = WorldConfig { map, gravity_m_per_s2: 9.81, obstacles };
    let object = ObjectConfig {
        name: "disc".into(),
        shape: Outline::Disc { radius_m: 0.012 },
        mass_kg: 0.005,
        table_friction: 0.25,
        support: SupportModel::Ellipsoid,
    };
    let engine = EngineConfig { time_step_s, ..EngineConfig::default() };
    PlanarWorld::new(&world, &object, &engine, &Isometry2::translation(0.5, 0.5)).expect("a valid scene")
}

fn posture() -> DVector<f64> {
    DVector::from_column_slice(&POSTURE)
}

#[test]
fn one_step_from_rest_is_what_forward_dynamics_says() {
    for rotor_inertia in [0.0, 0.01] {
        let model = model(rotor_inertia);
        let time_step_s = 1e-5;
        let mut world = world(vec![], time_step_s);
        let mut arm = PlanarArm::insert(&mut world, &model, FLANGE, &stick(), &posture()).expect("a valid arm");
        let torque = DVector::from_column_slice(&[0.3, -0.2, 0.05]);
        arm.apply_torques(&mut world, &torque);
        world.step();
        let mut state = JointState::at_rest(posture());
        arm.read_state(&world, &mut state);
        let mut workspace = model.workspace();
        workspace.set_positions(&posture()).expect("three joints");
        let mut acceleration = DVector::zeros(3);
        workspace.forward_dynamics_into(&torque, &mut acceleration).expect("three joints");
        // the same equations in another program: rounding only
        assert_relative_eq!(state.dq / time_step_s, acceleration, max_relative = 1e-10);
    }
}

#[test]
fn the_tool_is_where_forward_kinematics_says() {
    let model = model(0.01);
    let mut world = world(vec![], 0.0005);
    let arm = PlanarArm::insert(&mut world, &model, FLANGE, &stick(), &posture()).expect("a valid arm");
    let mut workspace = model.workspace();
    workspace.set_positions(&posture()).expect("three joints");
    let expected = model.world_from_base() * workspace.base_from_frame(model.frame(FLANGE).expect("known"));
    let seen = arm.world_from_tool(&world);
    assert_relative_eq!(seen.translation.vector, expected.translation.vector.xy(), epsilon = 1e-12);
    assert_relative_eq!(seen.rotation.angle(), expected.rotation.scaled_axis().z, epsilon = 1e-12);
}

/// Runs the paper's controller on `reference(t)` and returns the last state and the largest joint error after `from_s`.
fn track(
    world: &mut PlanarWorld,
    model: &Manipulator,
    config: &ImpedanceConfig,
    reference: impl Fn(f64) -> JointReference,
    seconds: f64,
    disturb: Vector2<f64>,
) -> (JointState, f64) {
    let mut arm = PlanarArm::insert(world, model, FLANGE, &stick(), &reference(0.0).q).expect("a valid arm");
    let mut controller = Impedance::new(config, 3).expect("valid gains");
    let mut workspace = model.workspace();
    let mut state = JointState::at_rest(reference(0.0).q);
    let mut torque = DVector::zeros(3);
    let mut largest: f64 = 0.0;
    for period in 0..(seconds / PERIOD_S) as usize {
        let wanted = reference(period as f64 * PERIOD_S);
        arm.read_state(world, &mut state);
        largest = largest.max((&wanted.q - &state.q).amax());
        controller.torque(&mut workspace, &state, &wanted, &mut torque).expect("three joints");
        arm.apply_torques(world, &torque);
        arm.disturb(world, &disturb);
        for _ in 0..(PERIOD_S / world.time_step_s()).round() as usize {
            world.step();
        }
    }
    arm.read_state(world, &mut state);
    (state, largest)
}

fn paper() -> ImpedanceConfig {
    ImpedanceConfig { error_gain_per_s: 3.0, damping_nm_s_per_rad: vec![10.0] }
}

#[test]
fn a_smooth_reference_is_tracked_closely_with_the_papers_gains() {
    let reference = |t: f64| {
        let wave = |a: f64, w: f64| (a * (w * t).sin(), a * w * (w * t).cos(), -a * w * w * (w * t).sin());
        let waves = [wave(0.2, 1.5), wave(0.15, 2.0), wave(0.2, 2.5)];
        JointReference {
            q: posture() + DVector::from_iterator(3, waves.iter().map(|wave| wave.0)),
            dq: DVector::from_iterator(3, waves.iter().map(|wave| wave.1)),
            ddq: DVector::from_iterator(3, waves.iter().map(|wave| wave.2)),
        }
    };
    let start = |t: f64| {
        // begin at rest: the amplitude grows smoothly from zero
        let mut wanted = reference(t);
        if t <= 0.0 {
            wanted.q = posture();
        }
        wanted
    };
    let (_, largest) = track(&mut world(vec![], 0.0005), &model(0.01), &paper(), start, 3.0, Vector2::zeros());
    // it starts with the wrong velocity, 0.5 rad/s at the most: r fades at xi/m, the error it leaves at k_e
    assert!(largest < 0.02, "{largest}");
}

#[test]
fn a_constant_tip_force_leaves_the_error_of_the_law() {
    let model = model(0.01);
    let force = Vector2::new(0.8, -0.5);
    let (state, _) =
        track(&mut world(vec![], 0.0005), &model, &paper(), |_| JointReference::at_rest(posture()), 6.0, force);
    let mut workspace = model.workspace();
    workspace.set_positions(&state.q).expect("three joints");
    let mut jacobian = Matrix6xX::zeros(3);
    workspace.jacobian_into(model.frame(FLANGE).expect("known"), &mut jacobian);
    let in_base = model.world_from_base().rotation.inverse() * nalgebra::Vector3::new(force.x, force.y, 0.0);
    let load = jacobian.tr_mul(&Vector6::new(in_base.x, in_base.y, in_base.z, 0.0, 0.0, 0.0));
    // M ṙ + C r + ξ r = −JᵀF at rest: e = −JᵀF/(k_e ξ)
    let expected = load / -(3.0 * 10.0);
    assert_relative_eq!(posture() - &state.q, expected, max_relative = 1e-3);
}

/// Largest joint error, rad, of a reference at rest held for a second from an error of 1 mrad, the torque of (34) entering
/// the plant of (33) with `sign`; Euler steps of the plant itself, without an engine.
fn held(sign: f64) -> f64 {
    const STEP_S: f64 = 1e-4;
    let model = model(0.01);
    let mut controller = Impedance::new(&paper(), 3).expect("valid gains");
    let mut workspace = model.workspace();
    let wanted = JointReference::at_rest(posture());
    let mut state = JointState::at_rest(posture() + DVector::repeat(3, 1e-3));
    let (mut torque, mut acceleration) = (DVector::zeros(3), DVector::zeros(3));
    let mut largest: f64 = 0.0;
    for _ in 0..10_000 {
        controller.torque(&mut workspace, &state, &wanted, &mut torque).expect("three joints");
        workspace.set_state(&state.q, &state.dq).expect("three joints");
        workspace.forward_dynamics_into(&(&torque * sign), &mut acceleration).expect("three joints");
        state.dq += &acceleration * STEP_S;
        state.q += &state.dq * STEP_S;
        largest = largest.max((&wanted.q - &state.q).amax());
        if largest > 1.0 {
            break;
        }
    }
    largest
}

#[test]
fn e14_the_sign_printed_in_equation_33_feeds_back_positively_and_the_used_one_does_not() {
    // printed, unit inertia, no force: s² − (k_e + ξ)s − k_e ξ has a positive root for all gains
    assert!(held(-1.0) > 1.0);
    assert!(held(1.0) <= 1e-3 * (1.0 + 1e-9));
}

#[test]
fn gains_beyond_the_sampled_bound_are_refused_and_do_diverge() {
    let bare = model(0.0);
    let controller = Impedance::new(&paper(), 3).expect("valid gains");
    let refused = controller.check_stability(&mut bare.workspace(), &posture(), PERIOD_S).expect_err("unstable");
    assert_eq!(refused.field, "impedance.damping_nm_s_per_rad");
    let nudged = |_| {
        let mut wanted = JointReference::at_rest(posture());
        wanted.q[2] += 1e-3;
        wanted
    };
    let mut at_rest = world(vec![], 0.0005);
    let (state, _) = track(&mut at_rest, &bare, &paper(), nudged, 0.5, Vector2::new(1e-3, 0.0));
    assert!(state.dq.amax() > 0.1, "the bound is not sharp: {}", state.dq);
    let with_rotors = model(0.01);
    controller.check_stability(&mut with_rotors.workspace(), &posture(), PERIOD_S).expect("stable");
}

#[test]
fn torques_stop_at_what_the_motors_give() {
    let model = model(0.01);
    let mut world = world(vec![], 0.0005);
    let mut arm = PlanarArm::insert(&mut world, &model, FLANGE, &stick(), &posture()).expect("a valid arm");
    let limits: Vec<f64> = model.joints().iter().map(|joint| joint.limits.effort.expect("given")).collect();
    assert!(arm.apply_torques(&mut world, &DVector::from_column_slice(&[1e3, -1e3, 0.0])));
    assert_eq!(arm.applied_torque_nm().as_slice(), &[limits[0], -limits[1], 0.0]);
    assert!(!arm.apply_torques(&mut world, &DVector::zeros(3)));
}

#[test]
fn pressing_on_a_wall_is_felt_in_the_joints() {
    let model = model(0.01);
    let mut scout = world(vec![], 0.0005);
    let arm = PlanarArm::insert(&mut scout, &model, FLANGE, &stick(), &posture()).expect("a valid arm");
    let tip = arm.world_from_tool(&scout) * nalgebra::Point2::new(0.0, 0.03);
    // a wide wall, square to the tool, that the tip overlaps by 0.1 mm
    let turn = arm.world_from_tool(&scout).rotation;
    let center = tip + turn * Vector2::new(0.0, 0.01 - 0.0001);
    let wall = Obstacle {
        name: "wall".into(),
        shape: Outline::Box { width_m: 0.2, height_m: 0.02 },
        position_m: [center.x, center.y],
        angle_rad: turn.angle(),
        friction: 0.0,
    };
    let mut walled = world(vec![wall], 0.0005);
    let (state, _) =
        track(&mut walled, &model, &paper(), |_| JointReference::at_rest(posture()), 5.0, Vector2::zeros());
    // at rest the motors hold against J^T F: stiffness k_e xi times the error
    let mut workspace = model.workspace();
    workspace.set_positions(&state.q).expect("three joints");
    let flange = model.frame(FLANGE).expect("known");
    let mut jacobian = Matrix6xX::zeros(3);
    workspace.jacobian_into(flange, &mut jacobian);
    let world_from_base = model.world_from_base();
    let origin = world_from_base * nalgebra::Point3::from(workspace.base_from_frame(flange).translation.vector);
    let mut load = DVector::zeros(3);
    for contact in walled.contacts() {
        let force = contact.force_on_n(Party::Tool, Party::Obstacle(0)).expect("only the wall is touched");
        let arm = contact.point_world - origin.xy();
        let in_base = world_from_base.rotation.inverse() * nalgebra::Vector3::new(force.x, force.y, 0.0);
        load += jacobian.tr_mul(&Vector6::new(in_base.x, in_base.y, in_base.z, 0.0, 0.0, arm.perp(&force)));
    }
    assert!(load.amax() > 1e-3, "no contact force: {load}");
    assert_relative_eq!((posture() - &state.q) * (3.0 * 10.0), -load, max_relative = 0.02);
}

/// Pushes a disc with a face in the arm's hand, 20 degrees off its normal, 50 mm; returns x, y and rotation of the disc.
fn oblique_push_by_the_arm(config: &ImpedanceConfig) -> Vector3<f64> {
    let face = Tool {
        pieces: vec![PlacedOutline {
            shape: Outline::Box { width_m: 0.1, height_m: 0.01 },
            position_m: [0.0, 0.025],
            angle_rad: 0.0,
        }],
        ..stick()
    };
    let arm =
        Manipulator::from_urdf_str(include_str!("../../../../assets/robots/planar_3r.urdf")).expect("a valid file");
    let base = Isometry2::translation(0.0, -0.25);
    let model = arm_with_tool(&arm, FLANGE, &face, &base, 9.81, &[0.01; 3]).expect("a valid arm");
    let (angle, speed, step_s) = (20.0_f64.to_radians(), 0.02, 0.002);
    let velocity = Vector3::new(speed * angle.sin(), speed * angle.cos(), 0.0);
    let at = |row: usize| PlanarMotion {
        position: velocity * (row as f64 * step_s),
        velocity,
        acceleration: Vector3::zeros(),
    };
    let track = Track::new(step_s, (0..=1250).map(at).collect()).expect("finite");
    let action = Action { name: "push".into(), kind: ActionKind::ToolFlipping, tool: track.clone(), object: track };
    let plan = Plan::new(vec![action]).expect("one action");
    let map = MapBounds { min_m: [-1.0, -1.0], max_m: [1.0, 1.0] };
    let object = ObjectConfig {
        name: "disc".into(),
        shape: Outline::Disc { radius_m: 0.012 },
        mass_kg: 0.0054,
        table_friction: 0.25,
        support: SupportModel::Ellipsoid,
    };
    let start = Isometry2::translation(0.0, 0.030 + 0.012);
    let world = WorldConfig { map, gravity_m_per_s2: 9.81, obstacles: vec![] };
    let scene = SceneDescription {
        world: world.clone(),
        object: object.clone(),
        tool: face.clone(),
        arm: ArmDescription::default(),
        phases: vec!["push".into()],
        tool_path_world: vec![],
        object_path_world: vec![],
        goal_world: nalgebra::Point2::origin(),
        control_period_s: PERIOD_S,
    };
    let setup = PlanarSetup {
        world: &world,
        object: &object,
        world_from_object: start,
        tool: &face,
        model: &model,
        flange: FLANGE,
        engine: &EngineConfig::default(),
        scene: &scene,
        settle_s: 0.0,
        longest_s: 5.0,
    };
    let posture = check_reach(&plan, &model, FLANGE).expect("within reach");
    let mut camera = Camera::new(&CameraConfig::perfect(), stream(1, Purpose::Camera, 0));
    let mut controller = Impedance::new(config, 3).expect("valid gains");
    let episode = simulate(&setup, &posture, &mut OpenLoop::new(&plan), &mut controller, &mut camera, &mut ());
    let episode = episode.expect("no divergence");
    let moved = start.inverse() * episode.samples.last().expect("some samples").world_from_object;
    moved.translation.vector.push(moved.rotation.angle())
}

#[test]
fn p9_the_arm_pushes_as_the_quasi_static_law_says() {
    let angle = 20.0_f64.to_radians();
    let expected = quasi_static::disc_on_face(0.012, 0.008, 0.3, Vector2::new(angle.sin(), angle.cos()) * 0.05, 1000);
    // the arm starts from rest against a reference that moves at once: stiff gains keep what it lags small
    let stiff = ImpedanceConfig { error_gain_per_s: 20.0, damping_nm_s_per_rad: vec![8.0] };
    let seen = oblique_push_by_the_arm(&stiff);
    println!("{seen} {expected}");
    assert_relative_eq!(seen.y, expected.y, max_relative = 0.05);
    assert_relative_eq!(seen.x, expected.x, max_relative = 0.05);
    assert_relative_eq!(seen.z, expected.z, max_relative = 0.05);
}
