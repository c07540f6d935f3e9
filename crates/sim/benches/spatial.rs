//! Cost of the spatial arm and of its control loop, without planning or recording.
//!
//! One iteration is one simulated millisecond: divide a millisecond by the printed time for the real-time factor.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{DVector, Isometry3, Translation3, Vector6};
use robot::{DifferentialKinematics, FrameMotion, JointReference, JointState, Manipulator, Redundancy, TaskRows};
use sim::controllers::{Controller, Impedance, ImpedanceConfig};
use sim::spatial::{
    ArmConfig, EngineConfig, HeldTool, SpatialArm, SpatialWorld, WrenchSensor, arm_with_tool, standard_gravity,
};

const PERIOD_S: f64 = 0.001;
const READY: [f64; 7] = [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785];
const ROTORS: [f64; 7] = [0.195, 0.195, 0.195, 0.195, 0.074, 0.074, 0.074];

/// What one control period is made of.
struct Loop {
    model: Manipulator,
    world: SpatialWorld,
    arm: SpatialArm,
    controller: Impedance,
    workspace: robot::Workspace,
    follower: DifferentialKinematics,
    sensor: WrenchSensor,
    state: JointState,
    reference: JointReference,
    torque: DVector<f64>,
    start: Isometry3<f64>,
    period: u64,
}

impl Loop {
    fn new(substeps: usize) -> Self {
        let arm = Manipulator::from_urdf_str(include_str!("../../../assets/robots/panda.urdf")).expect("a valid arm");
        let (tool, base) = (HeldTool::none(), Isometry3::identity());
        let model = arm_with_tool(&arm, "panda_hand_tcp", &tool, &base, &standard_gravity(), &ROTORS).expect("an arm");
        let engine = EngineConfig { substeps, ..EngineConfig::default() };
        let mut world = SpatialWorld::new(&engine, &standard_gravity()).expect("a valid scene");
        let posture = DVector::from_column_slice(&READY);
        let arm = SpatialArm::insert(&mut world, &model, &tool, &ArmConfig::default(), &posture).expect("an arm");
        let gains = ImpedanceConfig { error_gain_per_s: 10.0, damping_nm_s_per_rad: vec![10.0] };
        let policy = Redundancy::toward(posture.clone(), PERIOD_S);
        Self {
            controller: Impedance::new(&gains, 7).expect("valid gains"),
            workspace: model.workspace(),
            // as in a run: without a policy the spare joint would drift over a million circles
            follower: DifferentialKinematics::with_redundancy(&model, arm.tool_frame(), TaskRows::Pose, policy)
                .expect("seven joints"),
            sensor: WrenchSensor::new(&model, arm.tool_frame(), &ArmConfig::default(), &posture),
            state: JointState::at_rest(posture.clone()),
            reference: JointReference::at_rest(posture),
            torque: DVector::zeros(7),
            start: arm.world_from_tool(&world),
            period: 0,
            model,
            world,
            arm,
        }
    }

    /// Joint references for a slow circle of 5 cm.
    fn follow(&mut self) {
        let angle = self.period as f64 * PERIOD_S;
        self.period += 1;
        let (sine, cosine) = angle.sin_cos();
        let wanted = FrameMotion {
            base_from_frame: Translation3::new(0.05 * sine, 0.05 * (1.0 - cosine), 0.0) * self.start,
            velocity: Vector6::new(0.05 * cosine, 0.05 * sine, 0.0, 0.0, 0.0, 0.0),
            acceleration: Vector6::new(-0.05 * sine, 0.05 * cosine, 0.0, 0.0, 0.0, 0.0),
        };
        self.follower.follow(&wanted, &mut self.reference).expect("within reach");
    }

    fn control(&mut self) {
        self.arm.read_state(&self.world, &mut self.state);
        let (state, reference) = (&self.state, &self.reference);
        self.controller.torque(&mut self.workspace, state, reference, &mut self.torque).expect("seven joints");
        self.arm.set_torques(&self.torque, PERIOD_S);
    }

    fn sense(&mut self) {
        self.arm.read_state(&self.world, &mut self.state);
        self.sensor.read(&self.state, self.arm.applied_torque_nm(), PERIOD_S).expect("seven joints");
    }

    fn period(&mut self) {
        self.follow();
        self.control();
        self.arm.drive(&mut self.world);
        self.world.step();
        self.sense();
    }
}

fn spatial(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("panda, one simulated millisecond");
    for substeps in [1, 2, 4] {
        let mut whole = Loop::new(substeps);
        group.bench_function(format!("arm under control, {substeps} substeps"), |bench| bench.iter(|| whole.period()));
    }
    group.finish();
    let mut group = criterion.benchmark_group("panda, parts of a millisecond");
    let mut parts = Loop::new(2);
    group.bench_function("references by inverse kinematics", |bench| bench.iter(|| parts.follow()));
    group.bench_function("controller", |bench| bench.iter(|| parts.control()));
    group.bench_function("torque pairs", |bench| bench.iter(|| parts.arm.drive(&mut parts.world)));
    group.bench_function("wrench sensor", |bench| bench.iter(|| parts.sense()));
    let mut workspace = parts.model.workspace();
    let (mut mass, state) = (nalgebra::DMatrix::zeros(7, 7), parts.state.clone());
    group.bench_function("mass matrix", |bench| {
        bench.iter(|| {
            workspace.set_state(&state.q, &state.dq).expect("seven joints");
            workspace.mass_matrix_into(&mut mass);
        });
    });
    group.bench_function("coriolis matrix", |bench| {
        bench.iter(|| {
            workspace.set_state(&state.q, &state.dq).expect("seven joints");
            workspace.coriolis_matrix_into(&mut mass);
        });
    });
    group.bench_function("engine's step, 2 substeps", |bench| bench.iter(|| parts.world.step()));
    group.finish();
}

criterion_group!(benches, spatial);
criterion_main!(benches);
