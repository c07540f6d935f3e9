//! Where the knife is in the world, how it moves, and what mass the arm shows at it.

use nalgebra::{DMatrix, DVector, Isometry3, Matrix3xX, Matrix6xX, Point3, Vector3};
use robot::{JointState, RobotError};

use crate::cutting::knife::Edge;
use crate::spatial::{SpatialArm, SpatialWorld, Step};

/// Pose and velocity of the knife at the beginning of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct KnifeMotion {
    /// Pose of the knife's frame.
    pub world_from_knife: Isometry3<f64>,
    /// Origin of the tool's frame.
    pub tool_in_world: Point3<f64>,
    /// Velocity of the knife's origin, the heel, m/s.
    pub heel_velocity: Vector3<f64>,
    /// Angular velocity, rad/s.
    pub angular_velocity: Vector3<f64>,
    /// Where the heel should be.
    pub wanted_heel: Point3<f64>,
    /// How fast it should move, m/s.
    pub wanted_velocity: Vector3<f64>,
}

impl KnifeMotion {
    /// Reads the arm; `before` is where the heel should have been a step ago.
    pub fn read(step: &Step<'_>, tool_from_knife: &Isometry3<f64>, before: Option<Point3<f64>>) -> Self {
        let world_from_tool = step.arm.world_from_tool(step.world);
        let world_from_knife = world_from_tool * tool_from_knife;
        let velocity = step.arm.tool_velocity(step.world);
        let angular_velocity = velocity.fixed_rows::<3>(3).into_owned();
        let tool_in_world = Point3::from(world_from_tool.translation.vector);
        let heel = Point3::from(world_from_knife.translation.vector);
        let wanted_heel = Point3::from((step.world_from_tool_reference * tool_from_knife).translation.vector);
        Self {
            world_from_knife,
            tool_in_world,
            heel_velocity: velocity.fixed_rows::<3>(0) + angular_velocity.cross(&(heel - tool_in_world)),
            angular_velocity,
            wanted_heel,
            wanted_velocity: before.map_or_else(Vector3::zeros, |before| (wanted_heel - before) / step.time_step_s),
        }
    }

    /// The knife's origin.
    pub fn heel(&self) -> Point3<f64> {
        Point3::from(self.world_from_knife.translation.vector)
    }
}

/// Least mass that the arm shows at heel, middle and tip of the edge in any direction, kg: 1/λ_max(J M⁻¹ Jᵀ) with J of the
/// point (Khatib, "A unified approach for motion and force control of robot manipulators", 1987). Allocates.
pub(super) fn least_mass_kg(
    arm: &SpatialArm,
    world: &SpatialWorld,
    edge: &Edge,
    tool_from_knife: &Isometry3<f64>,
) -> Result<f64, RobotError> {
    let model = arm.model();
    let joints = model.joint_count();
    let mut state = JointState::at_rest(DVector::zeros(joints));
    arm.read_state(world, &mut state);
    let (mut workspace, mut mass) = (model.workspace(), DMatrix::zeros(joints, joints));
    let mut jacobian = Matrix6xX::zeros(joints);
    workspace.set_positions(&state.q)?;
    workspace.mass_matrix_into(&mut mass);
    workspace.jacobian_into(arm.tool_frame(), &mut jacobian);
    let base_from_tool = workspace.base_from_frame(arm.tool_frame());
    let Some(factor) = mass.cholesky() else { return Ok(f64::INFINITY) };
    let mobility = |corner: f64| {
        let at = tool_from_knife * Point3::new(corner, 0.0, 0.0);
        let arm_in_base = base_from_tool.rotation * at.coords;
        let of_point = point_jacobian(&jacobian, &arm_in_base);
        let inverse = &of_point * factor.solve(&of_point.transpose());
        inverse.symmetric_eigenvalues().max()
    };
    let length = edge.length_m();
    let greatest = [0.0, 0.5 * length, length].map(mobility).into_iter().fold(0.0, f64::max);
    Ok(1.0 / greatest)
}

/// Rows of the velocity of a point `arm` away from the frame's origin.
fn point_jacobian(jacobian: &Matrix6xX<f64>, arm: &Vector3<f64>) -> Matrix3xX<f64> {
    let mut rows = jacobian.fixed_rows::<3>(0).into_owned();
    for (mut column, whole) in rows.column_iter_mut().zip(jacobian.column_iter()) {
        column += whole.fixed_rows::<3>(3).cross(arm);
    }
    rows
}
