//! What a control step allocates: nothing of ours.

use nalgebra::{DVector, Translation3, Vector6};
use robot::{DifferentialKinematics, FrameMotion, JointReference, JointState, TaskRows};
use sim::controllers::{Controller, ControllerConfig, ImpedanceConfig, InertiaShapedConfig, JointPdConfig};
use sim::spatial::{ArmConfig, EngineConfig, SpatialArm, WrenchSensor};

use super::fixture::{PERIOD_S, ROTORS, panda, ready, rod, world};

#[test]
fn following_controlling_driving_and_sensing_allocate_nothing() {
    let model = panda(&ROTORS);
    let mut scene = world(&EngineConfig::default());
    let mut arm = SpatialArm::insert(&mut scene, &model, &rod(), &ArmConfig::default(), &ready()).expect("a valid arm");
    let pd = JointPdConfig { stiffness_nm_per_rad: vec![400.0], damping_nm_s_per_rad: vec![30.0] };
    let configs = [
        ControllerConfig::Impedance(ImpedanceConfig::paper()),
        ControllerConfig::InertiaShaped(InertiaShapedConfig::default()),
        ControllerConfig::JointPd(pd),
        ControllerConfig::Literal(ImpedanceConfig::paper()),
    ];
    let mut controllers: Vec<Box<dyn Controller>> =
        configs.iter().map(|config| config.build(7).expect("valid gains")).collect();
    let mut workspace = model.workspace();
    let mut sensor = WrenchSensor::new(&model, arm.tool_frame(), &ArmConfig::default(), &ready());
    let mut follower = DifferentialKinematics::new(&model, arm.tool_frame(), TaskRows::Pose).expect("seven joints");
    workspace.set_positions(&ready()).expect("seven joints");
    let start = workspace.base_from_frame(arm.tool_frame());
    let (mut state, mut reference) = (JointState::at_rest(ready()), JointReference::at_rest(ready()));
    let (mut torque, mut poses) = (DVector::zeros(7), Vec::with_capacity(8));
    let counted = allocation_counter::measure(|| {
        for period in 0..200 {
            let time_s = f64::from(period) * PERIOD_S;
            let wanted = FrameMotion {
                base_from_frame: Translation3::new(0.0, 0.05 * time_s, 0.0) * start,
                velocity: Vector6::new(0.0, 0.05, 0.0, 0.0, 0.0, 0.0),
                acceleration: Vector6::zeros(),
            };
            follower.follow(&wanted, &mut reference).expect("within reach");
            arm.read_state(&scene, &mut state);
            for controller in &mut controllers {
                controller.torque(&mut workspace, &state, &reference, &mut torque).expect("seven joints");
            }
            arm.set_torques(&torque, PERIOD_S);
            arm.drive(&mut scene);
            arm.load_tool(&mut scene, &Vector6::repeat(0.1));
            sensor.read(&state, arm.applied_torque_nm(), PERIOD_S).expect("seven joints");
            arm.link_poses(&scene, &mut poses);
            std::hint::black_box(arm.tool_velocity(&scene));
        }
    });
    assert_eq!(counted.count_total, 0, "{counted:?}");
}
