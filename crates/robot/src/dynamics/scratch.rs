//! Arrays that the dynamics algorithms write to, allocated once.

use nalgebra::{DVector, Matrix3, Matrix6, Vector3, Vector6};

use crate::spatial::{Force, Motion, RigidInertia};

/// Per-body storage of the dynamics algorithms.
#[derive(Debug, Clone)]
pub(crate) struct DynamicsScratch {
    /// True until inertias belong to the present state.
    pub stale: bool,
    /// True until composites belong to the inertias.
    pub composites_stale: bool,
    pub inertias: Vec<RigidInertia>,
    /// Inertia of each body together with everything it carries.
    pub composites: Vec<RigidInertia>,
    /// Angular block of the Coriolis operator of each composite.
    pub coriolis_blocks: Vec<Matrix3<f64>>,
    /// Linear momentum of each composite.
    pub momenta: Vec<Vector3<f64>>,
    pub accelerations: Vec<Motion>,
    pub forces: Vec<Force>,
    pub articulated: Vec<Matrix6<f64>>,
    pub articulated_forces: Vec<Vector6<f64>>,
    pub articulated_columns: Vec<Vector6<f64>>,
    pub pivots: Vec<f64>,
    pub efforts: Vec<f64>,
    /// A vector of zeros, for calls without accelerations.
    pub zeros: DVector<f64>,
}

impl DynamicsScratch {
    pub fn new(n: usize) -> Self {
        Self {
            stale: true,
            composites_stale: true,
            inertias: vec![RigidInertia::zeros(); n],
            composites: vec![RigidInertia::zeros(); n],
            coriolis_blocks: vec![Matrix3::zeros(); n],
            momenta: vec![Vector3::zeros(); n],
            accelerations: vec![Motion::zeros(); n],
            forces: vec![Force::zeros(); n],
            articulated: vec![Matrix6::zeros(); n],
            articulated_forces: vec![Vector6::zeros(); n],
            articulated_columns: vec![Vector6::zeros(); n],
            pivots: vec![0.0; n],
            efforts: vec![0.0; n],
            zeros: DVector::zeros(n),
        }
    }
}
