//! The arms and scenes that these tests share.

use nalgebra::{DVector, Isometry3, Matrix3, Point3, Translation3, UnitQuaternion, Vector3};
use robot::{JointReference, JointState, Manipulator};
use sim::controllers::Controller;
use sim::spatial::{ArmConfig, EngineConfig, HeldTool, SpatialArm, SpatialWorld, arm_with_tool, standard_gravity};

pub const READY: [f64; 7] = [
    0.0,
    -std::f64::consts::FRAC_PI_4,
    0.0,
    -3.0 * std::f64::consts::FRAC_PI_4,
    0.0,
    std::f64::consts::FRAC_PI_2,
    std::f64::consts::FRAC_PI_4,
];
/// Rotor inertias of the successor of the Panda, as MuJoCo Menagerie gives them, kg m².
pub const ROTORS: [f64; 7] = [0.195, 0.195, 0.195, 0.195, 0.074, 0.074, 0.074];
pub const PERIOD_S: f64 = 0.001;

pub fn ready() -> DVector<f64> {
    DVector::from_column_slice(&READY)
}

/// A rod of 0.2 kg along z, whose tip is the tool's frame.
pub fn rod() -> HeldTool {
    HeldTool {
        name: "rod".into(),
        mass_kg: 0.2,
        center_of_mass_m: Point3::new(0.01, 0.0, -0.06),
        inertia_kg_m2: Matrix3::from_diagonal(&Vector3::new(2.5e-4, 2.4e-4, 2e-5)),
        grip_from_tool: Isometry3::from_parts(
            Translation3::new(0.0, 0.01, 0.1),
            UnitQuaternion::from_euler_angles(0.2, -0.1, 0.3),
        ),
        ..HeldTool::none()
    }
}

/// The Panda on a turned base, with `tool` in its hand.
pub fn panda_with(tool: &HeldTool, rotors: &[f64]) -> Manipulator {
    let arm = Manipulator::from_urdf_str(include_str!("../../../../assets/robots/panda.urdf")).expect("a valid file");
    let base = Isometry3::new(Vector3::new(0.3, -0.2, 0.1), Vector3::new(0.1, -0.2, 0.4));
    arm_with_tool(&arm, "panda_hand_tcp", tool, &base, &standard_gravity(), rotors).expect("a valid arm")
}

pub fn panda(rotors: &[f64]) -> Manipulator {
    panda_with(&rod(), rotors)
}

/// Engine of one time step per control period.
pub fn engine(time_step_s: f64, substeps: usize) -> EngineConfig {
    EngineConfig { time_step_s, control_period_s: time_step_s, substeps, ..EngineConfig::default() }
}

pub fn world(engine: &EngineConfig) -> SpatialWorld {
    SpatialWorld::new(engine, &standard_gravity()).expect("a valid scene")
}

/// An arm in a scene of its own.
pub struct Scene {
    pub world: SpatialWorld,
    pub arm: SpatialArm,
    pub state: JointState,
}

impl Scene {
    pub fn new(
        model: &Manipulator,
        tool: &HeldTool,
        config: &ArmConfig,
        engine: &EngineConfig,
        q: &DVector<f64>,
    ) -> Self {
        let mut world = world(engine);
        let arm = SpatialArm::insert(&mut world, model, tool, config, q).expect("a valid arm");
        Self { world, arm, state: JointState::at_rest(q.clone()) }
    }

    /// The Panda with the rod, frictionless.
    pub fn panda(rotors: &[f64], engine: &EngineConfig, q: &DVector<f64>) -> Self {
        Self::new(&panda(rotors), &rod(), &ArmConfig::default(), engine, q)
    }

    /// One step of the engine under these torques; returns the state after it.
    pub fn step(&mut self, torque_nm: &DVector<f64>) -> &JointState {
        self.arm.set_torques(torque_nm, self.world.time_step_s());
        self.arm.drive(&mut self.world);
        self.world.step();
        self.arm.read_state(&self.world, &mut self.state);
        &self.state
    }

    /// Runs a controller that believes in `model` for `seconds`; `push` acts before each step. Returns the largest joint error.
    pub fn run(
        &mut self,
        model: &Manipulator,
        controller: &mut dyn Controller,
        reference: &dyn Fn(f64) -> JointReference,
        seconds: f64,
        push: &dyn Fn(&SpatialArm, &mut SpatialWorld),
    ) -> f64 {
        let (mut workspace, mut torque) = (model.workspace(), DVector::zeros(model.joint_count()));
        let mut largest: f64 = 0.0;
        for period in 0..(seconds / PERIOD_S).round() as usize {
            let wanted = reference(period as f64 * PERIOD_S);
            self.arm.read_state(&self.world, &mut self.state);
            largest = largest.max((&wanted.q - &self.state.q).amax());
            controller.torque(&mut workspace, &self.state, &wanted, &mut torque).expect("as many joints");
            self.arm.set_torques(&torque, PERIOD_S);
            for _ in 0..(PERIOD_S / self.world.time_step_s()).round() as usize {
                self.arm.drive(&mut self.world);
                push(&self.arm, &mut self.world);
                self.world.step();
            }
        }
        self.arm.read_state(&self.world, &mut self.state);
        largest
    }
}

/// Nothing pushes.
pub fn free(_: &SpatialArm, _: &mut SpatialWorld) {}
