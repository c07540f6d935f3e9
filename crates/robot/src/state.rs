//! Where the joints are, and where they should be.

use nalgebra::DVector;

/// Measured joint positions and velocities.
#[derive(Debug, Clone, PartialEq)]
pub struct JointState {
    /// Positions, one per movable joint (rad or m).
    pub q: DVector<f64>,
    /// Velocities, one per movable joint (rad/s or m/s).
    pub dq: DVector<f64>,
}

impl JointState {
    /// Returns the state at rest at positions `q` (rad or m).
    pub fn at_rest(q: DVector<f64>) -> Self {
        let dq = DVector::zeros(q.len());
        Self { q, dq }
    }
}

/// Desired joint positions, velocities and accelerations.
#[derive(Debug, Clone, PartialEq)]
pub struct JointReference {
    /// Positions, one per movable joint (rad or m).
    pub q: DVector<f64>,
    /// Velocities, one per movable joint (rad/s or m/s).
    pub dq: DVector<f64>,
    /// Accelerations, one per movable joint (rad/s² or m/s²).
    pub ddq: DVector<f64>,
}

impl JointReference {
    /// Returns the reference that holds positions `q` (rad or m).
    pub fn at_rest(q: DVector<f64>) -> Self {
        let zeros = DVector::zeros(q.len());
        Self { q, dq: zeros.clone(), ddq: zeros }
    }
}
