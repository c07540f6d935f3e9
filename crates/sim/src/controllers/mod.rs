//! Controllers: from joint states and references to joint torques. A controller is one file and its lines here.

mod feedback;
mod gains;
mod impedance;
mod inertia_shaped;
mod joint_pd;
mod literal;
mod terms;

use nalgebra::DVector;
use robot::{FrameId, JointReference, JointState, RobotError, Workspace};
use serde::{Deserialize, Serialize};
use skills::field::FieldError;

pub use feedback::{Feedback, tip_stiffness_n_per_m};
pub(crate) use gains::significant as significant_digits;
pub use impedance::{Impedance, ImpedanceConfig};
pub use inertia_shaped::{InertiaShaped, InertiaShapedConfig};
pub use joint_pd::{JointPd, JointPdConfig};
pub use literal::Literal;

/// Which controller a scenario uses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ControllerConfig {
    /// The paper's impedance controller, corrected.
    Impedance(ImpedanceConfig),
    /// The paper's law with a damping that follows the arm's inertia.
    InertiaShaped(InertiaShapedConfig),
    /// Springs and dampers at the joints with the weight held: the baseline.
    JointPd(JointPdConfig),
    /// The paper's law with the printed sign, for tests: it diverges, and scenarios refuse it.
    Literal(ImpedanceConfig),
}

/// Turns a tracking error into joint torques.
///
/// Adding a controller: implement this in a file of its own, add its variant to [`ControllerConfig`].
pub trait Controller: Send {
    /// Writes the torques of the joints, N m, for one control period; allocates nothing.
    ///
    /// # Errors
    /// A [`RobotError`] if the state has another number of joints than the arm.
    fn torque(
        &mut self,
        workspace: &mut Workspace,
        state: &JointState,
        reference: &JointReference,
        torque_nm: &mut DVector<f64>,
    ) -> Result<(), RobotError>;

    /// What the controller makes of small errors at rest at posture `q`.
    ///
    /// # Errors
    /// A [`RobotError`] if the posture has another number of joints than the arm.
    fn feedback(&self, workspace: &mut Workspace, q: &DVector<f64>) -> Result<Feedback, RobotError>;

    /// Kind of the controller, as configuration names it, and the gain that a stability bound limits first.
    fn decisive_gain(&self) -> (&'static str, &'static str);

    /// What a user should know before the run: stiffness at the joints and at the frame `tool`, settling time, nearness to
    /// instability; one sentence each. For the arm at posture `q` under a loop that runs every `control_period_s`.
    fn describe(
        &self,
        workspace: &mut Workspace,
        q: &DVector<f64>,
        tool: FrameId,
        control_period_s: f64,
    ) -> Vec<String> {
        let (name, _) = self.decisive_gain();
        let feedback = self.feedback(workspace, q);
        let told = feedback.and_then(|feedback| {
            let tip = feedback::tip_stiffness_n_per_m(&feedback, workspace, q, tool)?;
            Ok(feedback::sentences(name, &feedback, tip, control_period_s))
        });
        told.unwrap_or_else(|error| vec![format!("{name}: {error}")])
    }

    /// Checks that the control loop, run every `control_period_s` with torques held in between, is stable about rest at
    /// posture `q`. The bound moves with the posture (a bare Panda's lightest direction weighs 0.0065 kg m² in the ready posture and
    /// 0.0046 with the hand lifted): look at several postures of a plan.
    ///
    /// # Errors
    /// A [`FieldError`] that names the gain and the joint at fault, and what would be stable.
    fn check_stability(
        &self,
        workspace: &mut Workspace,
        q: &DVector<f64>,
        control_period_s: f64,
    ) -> Result<(), FieldError> {
        let (name, gain) = self.decisive_gain();
        let refused = |found: String, expected: String| Err(FieldError::new(gain, found, expected).within(name));
        let feedback = match self.feedback(workspace, q) {
            Ok(feedback) => feedback,
            Err(error) => return refused(format!("a posture that does not fit: {error}"), "one of the arm's".into()),
        };
        let growth = feedback.growth_per_period(control_period_s);
        if growth < 1.0 {
            return Ok(());
        }
        let joint = workspace.manipulator().joints().get(feedback.fastest_joint()).map_or("", |joint| &joint.name);
        let longest_s = feedback.longest_stable_period_s(control_period_s);
        let remedy = if longest_s > 0.0 {
            format!("a smaller gain there, or control every {longest_s:.6} s or faster")
        } else {
            "or gains nearer to each other: no control period makes these stable".into()
        };
        refused(
            format!(
                "gains under which an error grows by a factor of {growth:.3} per control period of {control_period_s} s"
            ),
            format!("a stable loop: rotor inertia at joint `{joint}`, {remedy}"),
        )
    }
}

impl ControllerConfig {
    /// Builds the controller for an arm of `joints` joints.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn build(&self, joints: usize) -> Result<Box<dyn Controller>, FieldError> {
        match self {
            Self::Impedance(config) => boxed("impedance", Impedance::new(config, joints)),
            Self::InertiaShaped(config) => boxed("inertia_shaped", InertiaShaped::new(config, joints)),
            Self::JointPd(config) => boxed("joint_pd", JointPd::new(config, joints)),
            Self::Literal(config) => boxed("literal", Literal::new(config, joints)),
        }
    }

    /// Checks the gains for an arm of `joints` joints, and that the controller is one that can hold an arm.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self, joints: usize) -> Result<(), FieldError> {
        match self {
            Self::Literal(_) => Err(literal::refusal()),
            config => config.build(joints).map(|_| ()),
        }
    }
}

fn boxed<C: Controller + 'static>(name: &str, built: Result<C, FieldError>) -> Result<Box<dyn Controller>, FieldError> {
    built.map(|controller| Box::new(controller) as Box<dyn Controller>).map_err(|error| error.within(name))
}

#[cfg(test)]
#[path = "controllers_tests.rs"]
mod tests;
