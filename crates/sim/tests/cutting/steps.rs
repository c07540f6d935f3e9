//! Single steps of the scene: what they allocate, and a rig that takes them.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{DVector, Isometry3, Vector3, Vector6};
use robot::{DifferentialKinematics, FrameMotion, JointReference, JointState, TaskRows, Workspace};
use sim::controllers::{Controller, Impedance};
use sim::cutting::scene::{CuttingProcess, CuttingSetup};
use sim::spatial::{ArmConfig, EngineConfig, Process, SpatialArm, SpatialWorld, Step, check_reach, standard_gravity};

use super::fixture::*;

/// The control loop step by step.
pub struct Rig {
    world: SpatialWorld,
    arm: SpatialArm,
    process: CuttingProcess,
    script: Script,
    follower: DifferentialKinematics,
    workspace: Workspace,
    controller: Impedance,
    state: JointState,
    reference: JointReference,
    torque: DVector<f64>,
    steps: usize,
}

impl Rig {
    pub fn new(setup: &CuttingSetup, script: &Script, gravity: &Vector3<f64>) -> Self {
        let tool = held(&setup.knife);
        let model = panda(&tool, gravity);
        let mut world = SpatialWorld::new(&EngineConfig::default(), gravity).expect("a valid scene");
        let process = CuttingProcess::insert(&mut world, setup).expect("a valid setup");
        let mut source = |time_s: f64, _: &Isometry3<f64>| script.reference(time_s);
        let near = DVector::from_column_slice(&READY);
        let q = check_reach(&model, &near, script.duration_s(), &mut source).expect("within reach");
        let arm = SpatialArm::insert(&mut world, &model, &tool, &ArmConfig::default(), &q).expect("a valid arm");
        let frame = model.frame("tool").expect("known");
        Self {
            world,
            arm,
            process,
            script: script.clone(),
            follower: DifferentialKinematics::new(&model, frame, TaskRows::Pose).expect("valid"),
            workspace: model.workspace(),
            controller: Impedance::new(&stiff(), 7).expect("valid gains"),
            state: JointState::at_rest(q.clone()),
            reference: JointReference::at_rest(q),
            torque: DVector::zeros(7),
            steps: 0,
        }
    }

    /// One control period; returns what the process allocated.
    pub fn step(&mut self) -> u64 {
        let wanted = self.script.reference(self.steps as f64 * PERIOD_S);
        let motion = FrameMotion {
            base_from_frame: wanted.world_from_tool,
            velocity: wanted.velocity,
            acceleration: wanted.acceleration,
        };
        self.follower.follow(&motion, &mut self.reference).expect("within reach");
        self.arm.read_state(&self.world, &mut self.state);
        self.controller
            .torque(&mut self.workspace, &self.state, &self.reference, &mut self.torque)
            .expect("seven joints");
        self.arm.set_torques(&self.torque, PERIOD_S);
        self.arm.drive(&mut self.world);
        let mut step = Step {
            time_s: self.world.time_s(),
            time_step_s: self.world.time_step_s(),
            world: &mut self.world,
            arm: &self.arm,
            phase: 0,
            world_from_tool_reference: wanted.world_from_tool,
        };
        let process = &mut self.process;
        let before = allocation_counter::measure(|| process.before_step(&mut step).expect("finite"));
        step.world.step();
        let after = allocation_counter::measure(|| process.after_step(&mut step).expect("finite"));
        self.steps += 1;
        before.count_total + after.count_total
    }

    pub fn wrench(&self) -> Vector6<f64> {
        self.process.tool_wrench()
    }

    /// Mass and velocity of the food, before it is cut.
    pub fn food(&self) -> (f64, Vector3<f64>) {
        let whole = self.process.record().pieces[0].mass_kg;
        let bodies = self.world.physics.rigid_bodies();
        let (_, body) = bodies.filter(|(_, body)| body.mass() == whole).last().expect("the food");
        (whole, Vector3::new(body.linvel().x, body.linvel().y, body.linvel().z))
    }
}

#[test]
fn steps_in_a_cut_allocate_nothing() {
    let script = press(0.0, 0.035, 0.001, 1.0);
    let mut rig = Rig::new(&setup(food(BANANA), FRAC_PI_2), &script, &standard_gravity());
    let counts: Vec<u64> = (0..2000).map(|_| rig.step()).collect();
    let cut = &rig.process.record().cuts[0];
    let separated_s = cut.separated_s.expect("comes apart");
    let [begun, apart] = [cut.begun_s, separated_s].map(|time_s| (time_s / PERIOD_S).round() as usize);
    for (step, count) in counts.iter().enumerate().filter(|(step, _)| *step != begun && step.abs_diff(apart) > 1) {
        // with two pieces the engine's own list of bodies that were touched outgrows its eight places
        assert!(*count <= u64::from(step > apart), "{count} in step {step}, begun in {begun}, apart in {apart}");
    }
}
