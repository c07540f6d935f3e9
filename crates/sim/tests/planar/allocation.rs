//! What a control step allocates: nothing of ours.

use nalgebra::{DVector, Isometry2, Point2, Translation3, Vector3, Vector6};
use robot::{DifferentialKinematics, FrameMotion, JointReference, JointState, TaskRows};
use sim::controllers::{Controller, Impedance, ImpedanceConfig};
use sim::planar::{ClosedLoop, ClosedLoopConfig, ReferenceSource};
use sim::random::{Purpose, stream};
use sim::sensing::{Camera, CameraConfig};
use skills::plan::{Action, ActionKind, Plan, PlanarMotion, Push, Track};
use skills::pushing::{HoldRenewalConfig, SteeringConfig};

use super::arm::{POSTURE, model};
use super::steering::{object, stick};

/// A push of 20 mm along +y in two seconds with the stick's head.
fn push() -> Plan {
    let track = |x: f64, y: f64| {
        let at = |row: usize| PlanarMotion {
            position: Vector3::new(x, y + 0.01 * row as f64 * 0.002, 0.0),
            velocity: Vector3::new(0.0, 0.01, 0.0),
            acceleration: Vector3::zeros(),
        };
        Track::new(0.002, (0..=1000).map(at).collect()).expect("finite")
    };
    let (from_world, to_world) = (Point2::new(0.0, 0.06), Point2::new(0.0, 0.08));
    let kind = ActionKind::ObjectOperating(Push { surface: 1, place_m: 0.0, from_world, to_world });
    let action = Action { name: "push".into(), kind, tool: track(0.0, 0.018), object: track(0.0, 0.06) };
    Plan::new(vec![action]).expect("one action")
}

#[test]
fn seeing_steering_following_and_controlling_allocate_nothing() {
    let plan = push();
    let tool = stick();
    let camera_config = CameraConfig::default();
    let config = ClosedLoopConfig {
        steering: SteeringConfig::default(),
        response_s: 0.05,
        patience: 2.0,
        hold_renewal: HoldRenewalConfig::default(),
    };
    let mut source = ClosedLoop::new(&plan, &tool, &object(), &camera_config, config, 0.001);
    let mut camera = Camera::new(&camera_config, stream(1, Purpose::Camera, 0));
    let model = model(0.01);
    let mut workspace = model.workspace();
    let gains = ImpedanceConfig { error_gain_per_s: 3.0, damping_nm_s_per_rad: vec![10.0] };
    let mut controller = Impedance::new(&gains, 3).expect("valid gains");
    let posture = DVector::from_column_slice(&POSTURE);
    let (state, reference) = (JointState::at_rest(posture.clone()), JointReference::at_rest(posture));
    let mut torque = DVector::zeros(3);
    let flange = model.frame("flange").expect("known");
    let mut follower = DifferentialKinematics::new(&model, flange, TaskRows::PlanarPose).expect("three joints");
    workspace.set_positions(&state.q).expect("three joints");
    let start = workspace.base_from_frame(flange);
    let mut followed = reference.clone();
    let counted = allocation_counter::measure(|| {
        for step in 0..1500 {
            let time_s = f64::from(step) * 0.001;
            let there = Isometry2::translation(0.0, 0.06 + 0.01 * time_s);
            let sighting = camera.look(time_s, &there);
            source.next(time_s, &Isometry2::translation(0.0, 0.018 + 0.01 * time_s), sighting.as_ref());
            let wanted = FrameMotion {
                base_from_frame: Translation3::new(0.0, 0.01 * time_s, 0.0) * start,
                velocity: Vector6::new(0.0, 0.01, 0.0, 0.0, 0.0, 0.0),
                acceleration: Vector6::zeros(),
            };
            follower.follow(&wanted, &mut followed).expect("within reach");
            controller.torque(&mut workspace, &state, &reference, &mut torque).expect("three joints");
        }
    });
    assert_eq!(counted.count_total, 0, "{counted:?}");
}
