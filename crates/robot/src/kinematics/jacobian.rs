//! The geometric Jacobian of a frame, and what its change contributes to the frame's acceleration.

use nalgebra::{Matrix6xX, Vector6};

use crate::manipulator::FrameId;
use crate::workspace::{Workspace, linear_first};

impl Workspace {
    /// Writes the geometric Jacobian J (6 × n) of a frame's origin in base axes: rows 0–2 linear (m/s per joint speed),
    /// rows 3–5 angular (rad/s per joint speed).
    ///
    /// # Panics
    /// If the frame belongs to another model.
    pub fn jacobian_into(&self, frame: FrameId, out: &mut Matrix6xX<f64>) {
        let n = self.model.joint_count();
        if out.ncols() != n {
            *out = Matrix6xX::zeros(n);
        }
        out.fill(0.0);
        let (mut ancestor, point) = self.frame_point(frame);
        while let Some(column) = ancestor {
            let subspace = &self.bodies[column].subspace;
            let linear = subspace.linear + subspace.angular.cross(&point);
            out.set_column(column, &linear_first(linear, subspace.angular));
            ancestor = self.model.joints[column].parent;
        }
    }

    /// Writes the rate of change J̇ (6 × n) of [`Self::jacobian_into`]'s Jacobian in the present state, rows alike.
    ///
    /// # Panics
    /// If the frame belongs to another model.
    pub fn jacobian_rate_into(&self, frame: FrameId, out: &mut Matrix6xX<f64>) {
        let n = self.model.joint_count();
        if out.ncols() != n {
            *out = Matrix6xX::zeros(n);
        }
        out.fill(0.0);
        let (mut ancestor, point) = self.frame_point(frame);
        let point_velocity = self.frame_velocity(frame).fixed_rows::<3>(0).into_owned();
        while let Some(column) = ancestor {
            let (subspace, rate) = (&self.bodies[column].subspace, &self.bodies[column].subspace_rate);
            let linear = rate.linear + rate.angular.cross(&point) + subspace.angular.cross(&point_velocity);
            out.set_column(column, &linear_first(linear, rate.angular));
            ancestor = self.model.joints[column].parent;
        }
    }

    /// Returns J̇ q̇: the acceleration of a frame's origin (m/s², rows 0–2) and its angular acceleration (rad/s², rows 3–5)
    /// in base axes when all joint accelerations are zero.
    ///
    /// # Panics
    /// If the frame belongs to another model.
    pub fn jacobian_rate_times_velocity(&self, frame: FrameId) -> Vector6<f64> {
        let (body, point) = self.frame_point(frame);
        body.map_or_else(Vector6::zeros, |body| {
            let state = &self.bodies[body];
            let bias = &state.bias_acceleration;
            let point_velocity = state.velocity.linear + state.velocity.angular.cross(&point);
            let linear = bias.linear + bias.angular.cross(&point) + state.velocity.angular.cross(&point_velocity);
            linear_first(linear, bias.angular)
        })
    }
}
