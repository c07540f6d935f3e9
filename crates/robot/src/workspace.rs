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
        }
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
        self.dq.fill(0.0);
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
        self.place(q);
        Ok(())
    }

    /// Forward kinematics and velocities, from the base outward; lengths are checked by the callers.
    pub(crate) fn place(&mut self, q: &DVector<f64>) {
        self.dynamics.stale = true;
        for (index, (joint, transform)) in self.model.joints.iter().zip(&self.transforms).enumerate() {
            let parent = joint.parent.map(|parent| self.bodies[parent]);
            let mut placed = place_body(joint, transform, parent.as_ref(), q[index]);
            let (velocity, bias) =
                parent.map_or((Motion::zeros(), Motion::zeros()), |p| (p.velocity, p.bias_acceleration));
            placed.velocity = velocity + placed.subspace.scaled(self.dq[index]);
            placed.subspace_rate = velocity.cross(&placed.subspace);
            placed.bias_acceleration = bias + placed.subspace_rate.scaled(self.dq[index]);
            self.bodies[index] = placed;
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

/// Poses of one body and the motion its joint allows; the velocities are left at zero.
fn place_body(joint: &Joint, transform: &JointTransform, parent: Option<&BodyState>, q: f64) -> BodyState {
    let (sine, cosine) = if joint.kind.rotates() { q.sin_cos() } else { (0.0, 0.0) };
    let slide = if joint.kind.rotates() { 0.0 } else { q };
    let relative = transform.constant + transform.sine * sine + transform.cosine * cosine;
    let offset = transform.origin_in_parent + transform.axis_in_parent * slide;
    let (rotation, origin, axis) = match parent {
        Some(p) => (p.rotation * relative, p.origin + p.rotation * offset, p.rotation * transform.axis_in_parent),
        None => (relative, offset, transform.axis_in_parent),
    };
    let subspace = if joint.kind.rotates() {
        Motion { angular: axis, linear: origin.cross(&axis) }
    } else {
        Motion { angular: Vector3::zeros(), linear: axis }
    };
    let at_rest = Motion::zeros();
    BodyState { rotation, origin, subspace, subspace_rate: at_rest, velocity: at_rest, bias_acceleration: at_rest }
}

fn pose(rotation: &Matrix3<f64>, origin: &Vector3<f64>) -> Isometry3<f64> {
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*rotation));
    Isometry3::from_parts(Translation3::from(*origin), rotation)
}

pub(crate) fn linear_first(linear: Vector3<f64>, angular: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
