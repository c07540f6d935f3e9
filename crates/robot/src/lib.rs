//! Kinematics and dynamics of an arm described by a URDF file.
//!
//! A [`Manipulator`] is the constant model; a [`Workspace`] is the scratch memory in which forward kinematics, Jacobians,
//! the mass matrix, the Coriolis matrix, inverse and forward dynamics are evaluated without allocation. Everything is
//! in SI units and radians, in `f64`, and expressed in the axes of the arm's base unless a name says otherwise.
//!
//! | wanted | take |
//! |---|---|
//! | an arm out of a URDF file, and what is odd about the file | [`Manipulator::from_urdf_str`], [`Manipulator::warnings`] |
//! | a tool or load in the hand, another mounting, rotor inertias | [`Manipulator::attach_payload`], [`Manipulator::mount`], [`Manipulator::set_rotor_inertia`] |
//! | poses and velocities of frames, J and J̇ | [`Workspace::base_from_frame`], [`Workspace::frame_velocity`], [`Workspace::jacobian_into`], [`Workspace::jacobian_rate_into`] |
//! | M(q), C(q, q̇), g(q) | [`Workspace::mass_matrix_into`], [`Workspace::coriolis_matrix_into`], [`Workspace::gravity_into`] |
//! | torques of a motion, motion under torques | [`Workspace::inverse_dynamics_into`], [`Workspace::forward_dynamics_into`] |
//! | a posture for a pose, within the limits | [`InverseKinematics`]; a start for it: [`Manipulator::middle_posture`] |
//! | joint positions, velocities and accelerations along a path | [`DifferentialKinematics`], with a [`Redundancy`] for spare joints |
//! | joints that mimic others, as of a gripper | [`Manipulator::couplings`], [`Manipulator::complete_positions`] |
//! | meshes of the links | [`Manipulator::resolve_meshes`] |
//!
//! Programs to begin with, `cargo run --release -p robot --example NAME`: `dynamics` (M, C, g, J, inverse and forward dynamics at a
//! posture, of any URDF file), `inverse_kinematics` (postures within limits, and a pose that is refused), `follow_path` (a circle
//! at 1 kHz, with its torques).
//!
//! ```
//! use nalgebra::{DMatrix, DVector};
//! use robot::{InverseKinematics, InverseKinematicsOptions, Manipulator, TaskRows};
//!
//! # fn main() -> Result<(), robot::RobotError> {
//! let arm = Manipulator::from_urdf_str(include_str!("../../../assets/robots/planar_3r.urdf"))?;
//! let flange = arm.frame("flange")?;
//!
//! let target = nalgebra::Isometry3::translation(0.05, 0.30, 0.0);
//! let mut solver = InverseKinematics::new(&arm, flange, TaskRows::PlanarPose, InverseKinematicsOptions::default())?;
//! let solution = solver.solve(&target, &DVector::from_vec(vec![-0.9, 1.8, -0.9]))?;
//!
//! let mut workspace = arm.workspace();
//! let mut mass_matrix = DMatrix::zeros(3, 3);
//! workspace.set_positions(&solution.q)?;
//! workspace.mass_matrix_into(&mut mass_matrix);
//! assert!(mass_matrix[(0, 0)] > mass_matrix[(2, 2)]);
//! # Ok(())
//! # }
//! ```

mod dynamics;
mod dynamics_check;
mod error;
mod joint;
mod kinematics;
mod manipulator;

mod mesh;
mod mimic;
mod mismatch;
mod shape;
mod spatial;
mod state;
mod urdf;
mod warning;
mod workspace;

pub use error::RobotError;
pub use joint::{Body, Joint, JointKind, JointLimits};
pub use kinematics::differential::{DifferentialKinematics, FollowReport, FrameMotion};
pub use kinematics::inverse::InverseKinematics;
pub use kinematics::inverse::options::{InverseKinematicsOptions, InverseKinematicsReport, InverseKinematicsSolution};
pub use kinematics::inverse::unreachable::UnreachableReason;
pub use kinematics::redundancy::Redundancy;
pub use kinematics::task_rows::{TaskError, TaskRows};
pub use manipulator::{FrameId, Manipulator};
pub use mesh::{MeshOptions, MeshProblem, TriangleMesh};
pub use mimic::{Coupling, Mimic};
pub use shape::{Geometry, Shape};
pub use state::{JointReference, JointState};
pub use warning::Warning;
pub use workspace::Workspace;
