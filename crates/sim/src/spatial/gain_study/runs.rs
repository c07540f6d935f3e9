//! The runs of the study, each in a world of its own.

use nalgebra::{DVector, Isometry3, Vector6};
use robot::{JointReference, JointState, Manipulator};
use skills::field::FieldError;

use super::condition::Condition;
use super::gains::StudiedGains;
use super::motion::{DURATION_S, StudyMotion, start_of_study};
use super::outcome::{GainStudy, GainSummary, RunOutcome};
use crate::controllers::{Controller, Impedance, ImpedanceConfig, tip_stiffness_n_per_m};
use crate::error::SimError;
use crate::random::{Purpose, stream};
use crate::spatial::arm::SpatialArm;
use crate::spatial::arm_config::ArmConfig;
use crate::spatial::config::EngineConfig;
use crate::spatial::observer::{Observer, Sample, SceneDescription};
use crate::spatial::process::{Process, Step};
use crate::spatial::simulation::{SpatialSetup, simulate};
use crate::spatial::tool::{HeldTool, TOOL_FRAME, arm_with_tool};
use crate::spatial::world::{SpatialWorld, standard_gravity};

/// Rotor inertias, kg m², of the Franka Research 3 in MuJoCo Menagerie (Apache-2.0); nobody has published the Panda's.
pub const FR3_ROTOR_INERTIA_KG_M2: [f64; 7] = [0.195, 0.195, 0.195, 0.195, 0.074, 0.074, 0.074];

/// Seed of the study's random inertias.
const SEED: u64 = 1;
/// When the pushed conditions begin to push, s.
const PUSH_FROM_S: f64 = 1.0;
/// Joint error from which a run counts as diverged, rad.
const DIVERGED_RAD: f64 = 1.0;
/// Step in all joints whose settling is timed, rad, the share of it that counts as settled, and how long it is watched, s.
const STEP_RAD: f64 = 0.05;
const SETTLED_SHARE: f64 = 0.02;
const WATCHED_S: f64 = 5.0;

/// Runs the study with `arm`, a Panda without rotor inertias whose frame `grip` is the hand's center, for these gains under
/// these conditions. The same input gives the same numbers.
///
/// # Errors
/// [`SimError::Field`] for an arm that has not seven joints, [`SimError::Robot`] for an unknown frame,
/// [`SimError::Unreachable`] if the arm cannot carry out the motion.
pub fn gain_study(
    arm: &Manipulator,
    grip: &str,
    gains: &[StudiedGains],
    conditions: &[Condition],
) -> Result<GainStudy, SimError> {
    let bench = Bench::new(arm, grip, &FR3_ROTOR_INERTIA_KG_M2)?;
    let summaries = gains.iter().map(|gains| bench.summarize(*gains)).collect::<Result<_, _>>()?;
    let pairs = gains.iter().flat_map(|gains| conditions.iter().map(|condition| (*gains, *condition)));
    let runs = pairs.map(|(gains, condition)| bench.run(gains, condition)).collect::<Result<_, _>>()?;
    Ok(GainStudy { summaries, runs })
}

/// Time, s, at which the study's motion diverges with an arm that has no rotor inertia, under the paper's kₑ and `damping` for
/// ξ, although its model is perfect; `None` if it does not. The stability check that a scenario goes through is left out.
///
/// # Errors
/// As [`gain_study`].
pub fn bare_arm_divergence_s(arm: &Manipulator, grip: &str, damping: f64) -> Result<Option<f64>, SimError> {
    let bench = Bench::new(arm, grip, &[0.0; 7])?;
    let config = ImpedanceConfig { damping_nm_s_per_rad: vec![damping], ..ImpedanceConfig::paper() };
    Ok(bench.carry_out(&config, Condition::Perfect)?.diverged_s)
}

/// The arm of the study at the start of its motion.
struct Bench {
    nominal: Manipulator,
    hand: HeldTool,
    engine: EngineConfig,
    q: DVector<f64>,
}

/// What is seen of one run.
struct Watched {
    tip_error_m: f64,
    joint_error_rad: f64,
    peak_torque_nm: f64,
    diverged_s: Option<f64>,
}

impl Bench {
    fn new(arm: &Manipulator, grip: &str, rotors: &[f64; 7]) -> Result<Self, SimError> {
        if arm.joint_count() != rotors.len() {
            let found = format!("an arm of {} joints", arm.joint_count());
            return Err(FieldError::new("arm", found, "a Panda: 7 joints, fingers fixed").into());
        }
        let hand = HeldTool::none();
        let nominal = arm_with_tool(arm, grip, &hand, &Isometry3::identity(), &standard_gravity(), rotors)?;
        let q = start_of_study(&nominal)?;
        Ok(Self { nominal, hand, engine: EngineConfig::default(), q })
    }

    fn run(&self, gains: StudiedGains, condition: Condition) -> Result<RunOutcome, SimError> {
        let Watched { tip_error_m, joint_error_rad, peak_torque_nm, diverged_s } =
            self.carry_out(&gains.config(), condition)?;
        let diverged = diverged_s.is_some();
        Ok(RunOutcome { gains, condition, tip_error_m, joint_error_rad, peak_torque_nm, diverged })
    }

    fn carry_out(&self, config: &ImpedanceConfig, condition: Condition) -> Result<Watched, SimError> {
        let (mismatch, draw) = condition.mismatch();
        let tool = self.nominal.frame(TOOL_FRAME)?;
        let random = stream(SEED, Purpose::Variation, draw);
        let (plant, model) = mismatch.plant_and_model(&self.nominal, tool, random)?;
        let setup = SpatialSetup {
            plant: &plant,
            model: &model,
            tool: &self.hand,
            arm: &condition.arm(),
            scene: &SceneDescription::default(),
            engine: &self.engine,
            settle_s: 0.0,
            longest_s: DURATION_S + 1.0,
        };
        let mut controller = Impedance::new(config, model.joint_count())?;
        let mut push = Push(condition);
        let mut watch = Watch::default();
        let world = SpatialWorld::new(&self.engine, &standard_gravity())?;
        let run = simulate(&setup, world, &self.q, &mut StudyMotion, &mut controller, &mut push, &mut watch);
        match run {
            Ok(_) => {}
            Err(SimError::Diverged { time_s, .. }) => watch.diverged_s = watch.diverged_s.or(Some(time_s)),
            Err(error) => return Err(error),
        }
        let Watch { tip_error_m, joint_error_rad, peak_torque_nm, diverged_s } = watch;
        Ok(Watched { tip_error_m, joint_error_rad, peak_torque_nm, diverged_s })
    }

    fn summarize(&self, gains: StudiedGains) -> Result<GainSummary, SimError> {
        let mut controller = Impedance::new(&gains.config(), self.q.len())?;
        let mut workspace = self.nominal.workspace();
        let feedback = controller.feedback(&mut workspace, &self.q)?;
        let tool = self.nominal.frame(TOOL_FRAME)?;
        Ok(GainSummary {
            gains,
            settling_s: self.settling_s(&mut controller)?,
            joint_stiffness_nm_per_rad: std::array::from_fn(|joint| feedback.stiffness[joint]),
            tip_stiffness_n_per_m: tip_stiffness_n_per_m(&feedback, &mut workspace, &self.q, tool)?,
            growth_per_period: feedback.growth_per_period(self.engine.control_period_s),
        })
    }

    /// Lets go of the arm beside its posture and times its return.
    fn settling_s(&self, controller: &mut Impedance) -> Result<Option<f64>, SimError> {
        let wanted = JointReference::at_rest(self.q.clone());
        let mut state = JointState::at_rest(self.q.add_scalar(-STEP_RAD));
        let mut world = SpatialWorld::new(&self.engine, &standard_gravity())?;
        let mut arm = SpatialArm::insert(&mut world, &self.nominal, &self.hand, &ArmConfig::default(), &state.q)?;
        let (mut workspace, mut torque) = (self.nominal.workspace(), DVector::zeros(self.q.len()));
        let period_s = self.engine.control_period_s;
        let periods = (WATCHED_S / period_s).round() as usize;
        let mut outside = 0;
        for period in 1..=periods {
            controller.torque(&mut workspace, &state, &wanted, &mut torque)?;
            arm.set_torques(&torque, period_s);
            for _ in 0..self.engine.steps_per_period() {
                arm.drive(&mut world);
                world.step();
            }
            arm.read_state(&world, &mut state);
            if (&wanted.q - &state.q).amax() > SETTLED_SHARE * STEP_RAD {
                outside = period;
            }
        }
        Ok((outside < periods).then_some((outside + 1) as f64 * period_s))
    }
}

/// Pushes the tool as a condition says.
struct Push(Condition);

impl Process for Push {
    fn before_step(&mut self, step: &mut Step<'_>) -> Result<(), SimError> {
        let force = self.0.push_world_n();
        if step.time_s >= PUSH_FROM_S {
            let wrench = Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
            step.arm.load_tool(step.world, &wrench);
        }
        Ok(())
    }
}

/// Keeps the largest errors.
#[derive(Default)]
struct Watch {
    tip_error_m: f64,
    joint_error_rad: f64,
    peak_torque_nm: f64,
    diverged_s: Option<f64>,
}

impl Observer for Watch {
    fn sample(&mut self, sample: &Sample<'_>) {
        let reference = sample.world_from_tool_reference.translation.vector;
        let errors = sample.q_reference_rad.iter().zip(sample.q_rad).map(|(wanted, is)| (wanted - is).abs());
        let joint_error_rad = errors.fold(0.0, f64::max);
        self.tip_error_m = self.tip_error_m.max((sample.world_from_tool.translation.vector - reference).norm());
        self.joint_error_rad = self.joint_error_rad.max(joint_error_rad);
        self.peak_torque_nm = sample.torque_nm.iter().fold(self.peak_torque_nm, |peak, torque| peak.max(torque.abs()));
        if joint_error_rad > DIVERGED_RAD {
            self.diverged_s = self.diverged_s.or(Some(sample.time_s));
        }
    }
}
