//! Controllers: from joint states and references to joint torques. A controller is one file and its lines here.

mod impedance;

use nalgebra::DVector;
use robot::{JointReference, JointState, Workspace};
use serde::{Deserialize, Serialize};
use skills::field::FieldError;

pub use impedance::{Impedance, ImpedanceConfig};

/// Which controller a scenario uses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ControllerConfig {
    /// The paper's impedance controller, corrected.
    Impedance(ImpedanceConfig),
}

/// Turns a tracking error into joint torques.
///
/// Adding a controller: implement this in a file of its own, add its variant to [`ControllerConfig`].
pub trait Controller: Send {
    /// Writes the torques of the joints, N m, for one control period; allocates nothing.
    ///
    /// # Errors
    /// A [`robot::RobotError`] if the state has another number of joints than the arm.
    fn torque(
        &mut self,
        workspace: &mut Workspace,
        state: &JointState,
        reference: &JointReference,
        torque_nm: &mut DVector<f64>,
    ) -> Result<(), robot::RobotError>;

    /// What a user should know before the run: gains, stability bound, settling; one sentence each.
    fn describe(&self, workspace: &mut Workspace, q: &DVector<f64>, control_period_s: f64) -> Vec<String>;

    /// Checks that the sampled control loop is stable at posture `q`.
    ///
    /// # Errors
    /// A [`FieldError`] that names the gain at fault, the bound and its value.
    fn check_stability(
        &self,
        workspace: &mut Workspace,
        q: &DVector<f64>,
        control_period_s: f64,
    ) -> Result<(), FieldError>;
}

impl ControllerConfig {
    /// Builds the controller for an arm of `joints` joints.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn build(&self, joints: usize) -> Result<Box<dyn Controller>, FieldError> {
        match self {
            Self::Impedance(config) => {
                Ok(Box::new(Impedance::new(config, joints).map_err(|error| error.within("impedance"))?))
            }
        }
    }

    /// Checks the gains for an arm of `joints` joints.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self, joints: usize) -> Result<(), FieldError> {
        self.build(joints).map(|_| ())
    }
}
