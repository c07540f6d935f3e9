//! What the surroundings exert on the tool, read off the arm's motion: the sum of forces that the motors, the arm's weight and
//! its inertia leave over.

use nalgebra::{DVector, Matrix6, Matrix6xX, Vector6};
use robot::{FrameId, JointState, Manipulator, RobotError, Workspace};

use super::arm_config::{ArmConfig, JointFriction};
use super::frames::turned_into_world;

/// Added to J Jᵀ, m² or rad²: keeps the reading finite in singular postures, and shifts it by 1e-9 of itself in others.
const REGULARIZATION: f64 = 1e-12;

/// Reads the wrench on the tool from ρ = M q̈ + C q̇ + g + friction − τ as F = (J Jᵀ)⁻¹ J ρ, the least-squares solution of
/// ρ = JᵀF, with q̈ the change of velocity over a control period and the rest in its middle.
///
/// Exact, up to the integration error of the period, where all outer forces act on the tool. What acts elsewhere is taken
/// for a force on the tool: a joint at its stop, and Coulomb friction of a joint that sticks, which nothing outside the joint
/// tells apart from a load.
#[derive(Clone, Debug)]
pub struct WrenchSensor {
    workspace: Workspace,
    tool: FrameId,
    friction: Vec<JointFriction>,
    before: JointState,
    middle: JointState,
    acceleration: DVector<f64>,
    torque_nm: DVector<f64>,
    jacobian: Matrix6xX<f64>,
}

impl WrenchSensor {
    /// A sensor for the frame `tool` of the arm that moves, `plant`, at posture `q` at rest.
    #[must_use]
    pub fn new(plant: &Manipulator, tool: FrameId, config: &ArmConfig, q: &DVector<f64>) -> Self {
        let joints = plant.joint_count();
        Self {
            workspace: plant.workspace(),
            tool,
            friction: (0..joints).map(|joint| config.friction_of(joint)).collect(),
            before: JointState::at_rest(q.clone()),
            middle: JointState::at_rest(q.clone()),
            acceleration: DVector::zeros(joints),
            torque_nm: DVector::zeros(joints),
            jacobian: Matrix6xX::zeros(joints),
        }
    }

    /// Force (N, rows 0–2) and moment about the tool's origin (N m, rows 3–5) of the surroundings on the tool, world axes: the
    /// mean over `period_s`, at whose end the arm is in `state`, under motor torques `applied_nm`. Allocates nothing.
    ///
    /// # Errors
    /// [`RobotError::WrongLength`] if the state is another arm's.
    pub fn read(
        &mut self,
        state: &JointState,
        applied_nm: &DVector<f64>,
        period_s: f64,
    ) -> Result<Vector6<f64>, RobotError> {
        for joint in 0..self.friction.len() {
            self.acceleration[joint] = (state.dq[joint] - self.before.dq[joint]) / period_s;
            self.middle.q[joint] = 0.5 * (state.q[joint] + self.before.q[joint]);
            self.middle.dq[joint] = 0.5 * (state.dq[joint] + self.before.dq[joint]);
        }
        self.workspace.set_state(&self.middle.q, &self.middle.dq)?;
        self.workspace.inverse_dynamics_into(&self.acceleration, &mut self.torque_nm)?;
        self.torque_nm -= applied_nm;
        for (joint, friction) in self.friction.iter().enumerate() {
            let speed = self.middle.dq[joint];
            let slides = self.before.dq[joint] * state.dq[joint] > 0.0;
            let dry_nm = if slides { friction.coulomb_nm * speed.signum() } else { 0.0 };
            self.torque_nm[joint] += friction.viscous_nm_s_per_rad * speed + dry_nm;
        }
        self.before.q.copy_from(&state.q);
        self.before.dq.copy_from(&state.dq);
        Ok(self.least_squares())
    }

    /// The wrench, world axes, whose joint torques are nearest to `torque_nm`.
    fn least_squares(&mut self) -> Vector6<f64> {
        self.workspace.jacobian_into(self.tool, &mut self.jacobian);
        let mut normal = Matrix6::from_diagonal_element(REGULARIZATION);
        let mut projected = Vector6::zeros();
        for (column, torque) in self.jacobian.column_iter().zip(self.torque_nm.iter()) {
            normal += column * column.transpose();
            projected += column * *torque;
        }
        let wrench_base = normal.cholesky().map_or_else(Vector6::zeros, |factor| factor.solve(&projected));
        turned_into_world(self.workspace.manipulator(), &wrench_base)
    }
}
