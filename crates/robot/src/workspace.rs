//! Scratch memory of one model, and the forward kinematics of all its bodies.

use nalgebra::{DVector, Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3, Vector6};

use crate::dynamics::scratch::DynamicsScratch;
use crate::error::RobotError;
use crate::joint::Joint;
use crate::manipulator::{FrameId, Manipulator, check_length};
use crate::spatial::Motion;

/// A joint's constants in the form in which forward kinematics uses them:
/// `parent_from_body` has rotation `constant + sine·sin q + cosine·cos q`.
#[derive(Debug, Clone)]
struct JointTransform {
    constant: Matrix3<f64>,
    sine: Matrix3<f64>,
    cosine: Matrix3<f64>,
    axis_in_parent: Vector3<f64>,
    origin_in_parent: Vector3<f64>,
    rotates: bool,
    parent: Option<usize>,
}

impl JointTransform {
    fn new(joint: &Joint) -> Self {
        let rotation = joint.parent_from_joint.rotation.to_rotation_matrix().into_inner();
        let axis = joint.axis.into_inner();
        let along = axis * axis.transpose();
        let turning = if joint.kind.rotates() { 1.0 } else { 0.0 };
        let across = (Matrix3::identity() - along) * turning;
        Self {
            constant: rotation * (Matrix3::identity() - across),
            sine: rotation * axis.cross_matrix() * turning,
            cosine: rotation * across,
            axis_in_parent: rotation * axis,
            origin_in_parent: joint.parent_from_joint.translation.vector,
            rotates: joint.kind.rotates(),
            parent: joint.parent,
        }
    }

    /// Writes the pose of the joint's body, and the motion that the joint allows, at position `q` (rad or m).
    fn place_body(&self, parent: Option<&BodyState>, q: f64, body: &mut BodyState) {
        let (relative, offset) = if self.rotates {
            let (sine, cosine) = q.sin_cos();
            (self.constant + self.sine * sine + self.cosine * cosine, self.origin_in_parent)
        } else {
            (self.constant, self.origin_in_parent + self.axis_in_parent * q)
        };
        let (rotation, origin, axis) = match parent {
            Some(p) => (p.rotation * relative, p.origin + p.rotation * offset, p.rotation * self.axis_in_parent),
            None => (relative, offset, self.axis_in_parent),
        };
        body.rotation = rotation;
        body.origin = origin;
        body.subspace = if self.rotates {
            Motion { angular: axis, linear: origin.cross(&axis) }
        } else {
            Motion { angular: Vector3::zeros(), linear: axis }
        };
    }
}

/// Where one body is and how it moves, in base axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BodyState {
    pub rotation: Matrix3<f64>,
    pub origin: Vector3<f64>,
    /// The joint's motion per unit of its velocity.
    pub subspace: Motion,
    /// Rate of change of `subspace`.
    pub subspace_rate: Motion,
    pub velocity: Motion,
    /// Acceleration of the body when all joint accelerations are zero, without gravity.
    pub bias_acceleration: Motion,
}

/// Scratch memory for one [`Manipulator`]; set a state, then ask. No call allocates after construction, unless an
/// output has the wrong size, in which case it is replaced.
#[derive(Debug, Clone)]
pub struct Workspace {
    pub(crate) model: Manipulator,
    transforms: Vec<JointTransform>,
    pub(crate) bodies: Vec<BodyState>,
    pub(crate) dq: DVector<f64>,
    pub(crate) dynamics: DynamicsScratch,
}

impl Workspace {
    pub(crate) fn new(model: Manipulator) -> Self {
        let n = model.joint_count();
        let at_origin = BodyState {
            rotation: Matrix3::identity(),
            origin: Vector3::zeros(),
            subspace: Motion::zeros(),
            subspace_rate: Motion::zeros(),
            velocity: Motion::zeros(),
            bias_acceleration: Motion::zeros(),
        };
        let mut workspace = Self {
            transforms: model.joints.iter().map(JointTransform::new).collect(),
            bodies: vec![at_origin; n],
            dq: DVector::zeros(n),
            dynamics: DynamicsScratch::new(n),
            model,
        };
        workspace.place(&DVector::zeros(n));
        workspace
    }

    /// Returns the model, as it was when the workspace was made.
    pub fn manipulator(&self) -> &Manipulator {
        &self.model
    }

    /// Places all joints at positions `q` (n entries; rad or m) at rest.
    ///
    /// # Errors
    /// [`RobotError::WrongLength`].
    pub fn set_positions(&mut self, q: &DVector<f64>) -> Result<(), RobotError> {
        check_length("set positions: q", q.len(), self.model.joint_count())?;
        self.rest();
        self.place(q);
        Ok(())
    }

    /// Places all joints at positions `q` (n entries; rad or m) with velocities `dq` (n entries; rad/s or m/s).
    ///
    /// # Errors
    /// [`RobotError::WrongLength`].
    pub fn set_state(&mut self, q: &DVector<f64>, dq: &DVector<f64>) -> Result<(), RobotError> {
        check_length("set state: q", q.len(), self.model.joint_count())?;
        check_length("set state: dq", dq.len(), self.model.joint_count())?;
        self.dq.copy_from(dq);
        self.place_moving(q);
        Ok(())
    }

    /// Forward kinematics and velocities, from the base outward; lengths are checked by the callers.
    fn place_moving(&mut self, q: &DVector<f64>) {
        self.place(q);
        for index in 0..self.bodies.len() {
            let (before, rest) = self.bodies.split_at_mut(index);
            let body = &mut rest[0];
            let dq = self.dq[index];
            let (velocity, bias) = self.transforms[index]
                .parent
                .map_or((Motion::zeros(), Motion::zeros()), |p| (before[p].velocity, before[p].bias_acceleration));
            body.velocity = velocity + body.subspace.scaled(dq);
            body.subspace_rate = velocity.cross(&body.subspace);
            body.bias_acceleration = bias + body.subspace_rate.scaled(dq);
        }
    }

    /// Forward kinematics alone, from the base outward; velocities keep their old values, and lengths are checked by the
    /// callers.
    pub(crate) fn place(&mut self, q: &DVector<f64>) {
        self.dynamics.stale = true;
        for (index, (transform, &q)) in self.transforms.iter().zip(q.iter()).enumerate() {
            let (before, rest) = self.bodies.split_at_mut(index);
            transform.place_body(transform.parent.map(|parent| &before[parent]), q, &mut rest[0]);
        }
    }

    fn rest(&mut self) {
        self.dq.fill(0.0);
        for body in &mut self.bodies {
            body.velocity = Motion::zeros();
            body.subspace_rate = Motion::zeros();
            body.bias_acceleration = Motion::zeros();
        }
    }

    /// Returns the pose in the base frame of the body that joint `joint` carries; `None` if there is no such joint.
    pub fn base_from_body(&self, joint: usize) -> Option<Isometry3<f64>> {
        self.bodies.get(joint).map(|body| pose(&body.rotation, &body.origin))
    }

    /// Returns the pose of a frame in the base frame.
    ///
    /// # Panics
    /// If the frame belongs to another model.
    pub fn base_from_frame(&self, frame: FrameId) -> Isometry3<f64> {
        let entry = self.model.frame_entry(frame);
        match entry.body {
            Some(body) => pose(&self.bodies[body].rotation, &self.bodies[body].origin) * entry.body_from_frame,
            None => entry.body_from_frame,
        }
    }

    /// Returns the velocity of a frame's origin (m/s, rows 0–2) and its angular velocity (rad/s, rows 3–5) in base axes.
    ///
    /// # Panics
    /// If the frame belongs to another model.
    pub fn frame_velocity(&self, frame: FrameId) -> Vector6<f64> {
        let (body, point) = self.frame_point(frame);
        body.map_or_else(Vector6::zeros, |body| {
            let velocity = &self.bodies[body].velocity;
            let linear = velocity.linear + velocity.angular.cross(&point);
            linear_first(linear, velocity.angular)
        })
    }

    /// The body that carries a frame, and the frame's origin in base axes (m).
    pub(crate) fn frame_point(&self, frame: FrameId) -> (Option<usize>, Vector3<f64>) {
        let entry = self.model.frame_entry(frame);
        let offset = entry.body_from_frame.translation.vector;
        let point = entry.body.map_or(offset, |body| self.bodies[body].origin + self.bodies[body].rotation * offset);
        (entry.body, point)
    }
}

fn pose(rotation: &Matrix3<f64>, origin: &Vector3<f64>) -> Isometry3<f64> {
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*rotation));
    Isometry3::from_parts(Translation3::from(*origin), rotation)
}

pub(crate) fn linear_first(linear: Vector3<f64>, angular: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
