//! Spatial (six-dimensional) vectors and inertias, all in base axes about the base origin.
//!
//! With one common origin nothing needs to be transformed between bodies: velocities, forces and inertias simply add.

use std::ops::{Add, AddAssign};

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// A spatial velocity or acceleration: angular part, and linear part of the body point at the base origin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    pub angular: Vector3<f64>,
    pub linear: Vector3<f64>,
}

impl Motion {
    pub fn zeros() -> Self {
        Self { angular: Vector3::zeros(), linear: Vector3::zeros() }
    }

    pub fn scaled(&self, factor: f64) -> Self {
        Self { angular: self.angular * factor, linear: self.linear * factor }
    }

    /// Spatial cross product of two motions.
    pub fn cross(&self, other: &Self) -> Self {
        Self {
            angular: self.angular.cross(&other.angular),
            linear: self.angular.cross(&other.linear) + self.linear.cross(&other.angular),
        }
    }

    /// Spatial cross product of a motion and a force.
    pub fn cross_force(&self, other: &Force) -> Force {
        Force {
            moment: self.angular.cross(&other.moment) + self.linear.cross(&other.force),
            force: self.angular.cross(&other.force),
        }
    }

    /// Power of a force on this motion.
    pub fn dot(&self, other: &Force) -> f64 {
        self.angular.dot(&other.moment) + self.linear.dot(&other.force)
    }

    /// The same as six numbers, angular first.
    pub fn to_vector(self) -> Vector6<f64> {
        stack(self.angular, self.linear)
    }
}

impl Add for Motion {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { angular: self.angular + other.angular, linear: self.linear + other.linear }
    }
}

/// A spatial force or momentum: moment about the base origin, and force.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Force {
    pub moment: Vector3<f64>,
    pub force: Vector3<f64>,
}

impl Force {
    pub fn zeros() -> Self {
        Self { moment: Vector3::zeros(), force: Vector3::zeros() }
    }

    /// The same as six numbers, moment first.
    pub fn to_vector(self) -> Vector6<f64> {
        stack(self.moment, self.force)
    }
}

impl Add for Force {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { moment: self.moment + other.moment, force: self.force + other.force }
    }
}

/// Inertia of a rigid body or of a rigid cluster: mass, first moment and inertia tensor about the base origin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RigidInertia {
    pub mass: f64,
    pub first_moment: Vector3<f64>,
    pub about_origin: Matrix3<f64>,
}

impl RigidInertia {
    pub fn zeros() -> Self {
        Self { mass: 0.0, first_moment: Vector3::zeros(), about_origin: Matrix3::zeros() }
    }

    /// Momentum of the body at a velocity, or the force that an acceleration asks for.
    pub fn apply(&self, motion: &Motion) -> Force {
        Force {
            moment: self.about_origin * motion.angular + self.first_moment.cross(&motion.linear),
            force: motion.linear * self.mass - self.first_moment.cross(&motion.angular),
        }
    }

    /// Gyroscopic force v × I v.
    pub fn gyroscopic(&self, velocity: &Motion) -> Force {
        velocity.cross_force(&self.apply(velocity))
    }

    /// The 6 × 6 matrix, angular rows and columns first.
    pub fn to_matrix(self) -> Matrix6<f64> {
        let skew = self.first_moment.cross_matrix();
        let mut matrix = Matrix6::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.about_origin);
        matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&skew);
        matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&(-skew));
        matrix.fixed_view_mut::<3, 3>(3, 3).fill_diagonal(self.mass);
        matrix
    }
}

impl AddAssign for RigidInertia {
    fn add_assign(&mut self, other: Self) {
        self.mass += other.mass;
        self.first_moment += other.first_moment;
        self.about_origin += other.about_origin;
    }
}

fn stack(upper: Vector3<f64>, lower: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(upper.x, upper.y, upper.z, lower.x, lower.y, lower.z)
}
