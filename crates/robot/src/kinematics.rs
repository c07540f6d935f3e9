//! Jacobians, inverse kinematics and the following of paths.

pub(crate) mod differential;
pub(crate) mod inverse;
mod jacobian;
mod pseudo_inverse;
pub(crate) mod redundancy;
pub(crate) mod task_rows;
