//! The constant model of an arm: joints, bodies, named frames, mounting and gravity.

use nalgebra::{DVector, Isometry3, Matrix3, Vector3};

use crate::error::RobotError;
use crate::joint::{Body, Joint};
use crate::urdf;
use crate::warning::Warning;
use crate::workspace::Workspace;

/// Standard gravity along the base's −z (m/s²).
const DEFAULT_GRAVITY_M_PER_S2: f64 = 9.81;

/// A named frame of a [`Manipulator`]. Valid for the model that gave it and for models derived from that one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FrameId(pub(crate) usize);

/// A frame fixed to a body (to the base if `body` is `None`).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Frame {
    pub name: String,
    pub body: Option<usize>,
    pub body_from_frame: Isometry3<f64>,
}

/// The constant model of an arm: a tree of movable joints, topologically ordered, on a fixed base.
#[derive(Debug, Clone, PartialEq)]
pub struct Manipulator {
    pub(crate) name: String,
    pub(crate) joints: Vec<Joint>,
    pub(crate) base: Body,
    pub(crate) frames: Vec<Frame>,
    pub(crate) world_from_base: Isometry3<f64>,
    pub(crate) gravity_in_base: Vector3<f64>,
    pub(crate) warnings: Vec<Warning>,
}

impl Manipulator {
    /// Reads the model from the text of a URDF file. Gravity is (0, 0, −9.81) m/s² and the base stands at the world origin.
    ///
    /// Links behind fixed joints merge into the moving body and stay known as frames. Limits of zero effort or zero
    /// velocity are read as "not stated". Rotor inertias are zero, since URDF has no element for them. Mimic joints are
    /// coordinates of their own with a stated coupling, see [`Self::couplings`]. No file is touched: meshes keep
    /// their names until [`Self::resolve_meshes`]. What was left out, mended or is odd stands in [`Self::warnings`].
    ///
    /// # Errors
    /// One variant of [`RobotError`] for each flaw: no XML, xacro, no tree, unknown or repeated names, missing elements or
    /// attributes, values that are no numbers or not finite, zero axes, reversed limits, negative masses, joints with
    /// several freedoms, mimic joints that follow nobody or one another in a circle.
    pub fn from_urdf_str(xml: &str) -> Result<Self, RobotError> {
        urdf::read(xml)
    }

    pub(crate) fn from_parts(
        name: String,
        joints: Vec<Joint>,
        base: Body,
        frames: Vec<Frame>,
        warnings: Vec<Warning>,
    ) -> Self {
        Self {
            name,
            joints,
            base,
            frames,
            world_from_base: Isometry3::identity(),
            gravity_in_base: Vector3::new(0.0, 0.0, -DEFAULT_GRAVITY_M_PER_S2),
            warnings,
        }
    }

    /// Returns the robot's name in the URDF (may be empty).
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the number of movable joints, n.
    pub fn joint_count(&self) -> usize {
        self.joints.len()
    }

    /// Returns the movable joints with their bodies; parents come before children.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Returns what is fixed to the base.
    pub fn base(&self) -> &Body {
        &self.base
    }

    /// Returns oddities of the URDF that did not prevent its use.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Finds a frame by name: the name of a URDF link, or of an added frame.
    ///
    /// # Errors
    /// [`RobotError::UnknownFrame`] with all known names.
    pub fn frame(&self, name: &str) -> Result<FrameId, RobotError> {
        let position = self.frames.iter().position(|frame| frame.name == name);
        position.map(FrameId).ok_or_else(|| RobotError::UnknownFrame {
            frame: name.to_owned(),
            known: self.frame_names().map(str::to_owned).collect(),
        })
    }

    /// Returns the names of all frames, the base link first.
    pub fn frame_names(&self) -> impl Iterator<Item = &str> {
        self.frames.iter().map(|frame| frame.name.as_str())
    }

    /// Returns the name of a frame.
    ///
    /// # Panics
    /// If the frame belongs to another model.
    pub fn frame_name(&self, frame: FrameId) -> &str {
        &self.frame_entry(frame).name
    }

    /// Returns the joint that carries the frame (`None`: the base) and the frame's pose in that body.
    ///
    /// # Panics
    /// If the frame belongs to another model.
    pub fn frame_attachment(&self, frame: FrameId) -> (Option<usize>, Isometry3<f64>) {
        let entry = self.frame_entry(frame);
        (entry.body, entry.body_from_frame)
    }

    pub(crate) fn frame_entry(&self, frame: FrameId) -> &Frame {
        assert!(frame.0 < self.frames.len(), "a frame is used with the model that gave it");
        &self.frames[frame.0]
    }

    /// Adds a named frame, such as the tip of a tool, at a pose in an existing frame.
    ///
    /// # Errors
    /// [`RobotError::DuplicateFrame`] if the name is taken.
    pub fn add_frame(
        &mut self,
        name: &str,
        parent: FrameId,
        parent_from_frame: Isometry3<f64>,
    ) -> Result<FrameId, RobotError> {
        if self.frames.iter().any(|frame| frame.name == name) {
            return Err(RobotError::DuplicateFrame { frame: name.to_owned() });
        }
        let (body, body_from_parent) = self.frame_attachment(parent);
        self.frames.push(Frame { name: name.to_owned(), body, body_from_frame: body_from_parent * parent_from_frame });
        Ok(FrameId(self.frames.len() - 1))
    }

    /// Returns the model with a rigid payload, such as a tool in the hand, fixed to a frame.
    ///
    /// `center_of_mass_m` is in the frame; `inertia_kg_m2` is about the center of mass in the frame's axes. A payload
    /// on the base changes nothing but the base's mass.
    ///
    /// # Errors
    /// [`RobotError::NegativeMass`] or [`RobotError::NonFinite`].
    pub fn attach_payload(
        &self,
        frame: FrameId,
        mass_kg: f64,
        center_of_mass_m: Vector3<f64>,
        inertia_kg_m2: Matrix3<f64>,
    ) -> Result<Self, RobotError> {
        let element = || format!("payload on `{}`", self.frame_name(frame));
        let finite = mass_kg.is_finite()
            && center_of_mass_m.iter().all(|value| value.is_finite())
            && inertia_kg_m2.iter().all(|value| value.is_finite());
        if !finite {
            return Err(RobotError::NonFinite { element: element(), quantity: "inertial" });
        }
        if mass_kg < 0.0 {
            return Err(RobotError::NegativeMass { element: element(), mass_kg });
        }
        let (body, body_from_frame) = self.frame_attachment(frame);
        let axes = body_from_frame.rotation.to_rotation_matrix();
        let inertia = axes.matrix() * inertia_kg_m2 * axes.matrix().transpose();
        let center = body_from_frame.transform_point(&center_of_mass_m.into()).coords;
        let mut loaded = self.clone();
        let target = match body {
            Some(joint) => &mut loaded.joints[joint].body,
            None => &mut loaded.base,
        };
        target.add_part(mass_kg, center, inertia);
        Ok(loaded)
    }

    /// Sets the rotor inertia felt at each joint (n entries; kg m², or kg for prismatic joints).
    ///
    /// # Errors
    /// [`RobotError::WrongLength`], or [`RobotError::InvalidArgument`] for a negative or non-finite value.
    pub fn set_rotor_inertia(&mut self, rotor_inertia: &[f64]) -> Result<(), RobotError> {
        check_length("set rotor inertia: the list", rotor_inertia.len(), self.joint_count())?;
        if let Some(&found) = rotor_inertia.iter().find(|value| !(value.is_finite() && **value >= 0.0)) {
            let expected = "zero or more, finite";
            return Err(RobotError::InvalidArgument { quantity: "rotor inertia", found, expected });
        }
        for (joint, &value) in self.joints.iter_mut().zip(rotor_inertia) {
            joint.rotor_inertia = value;
        }
        Ok(())
    }

    /// Returns the pose of the base in the world. Kinematics stay in base axes; this is for the caller's conversions.
    pub fn world_from_base(&self) -> &Isometry3<f64> {
        &self.world_from_base
    }

    /// Sets the pose of the base in the world, and gravity from its value in world axes (m/s²).
    pub fn mount(&mut self, world_from_base: Isometry3<f64>, gravity_in_world: Vector3<f64>) {
        self.world_from_base = world_from_base;
        self.gravity_in_base = world_from_base.rotation.inverse() * gravity_in_world;
    }

    /// Returns gravity in base axes (m/s²).
    pub fn gravity_in_base(&self) -> Vector3<f64> {
        self.gravity_in_base
    }

    /// Sets gravity in base axes (m/s²).
    pub fn set_gravity(&mut self, gravity_in_base: Vector3<f64>) {
        self.gravity_in_base = gravity_in_base;
    }

    /// Returns the posture in the middle of the joints' ranges (n entries; rad or m): one that any arm may take, as a start of
    /// [`crate::InverseKinematics`] or as a preferred posture. Zero is outside the limits of many arms, a Panda among them.
    ///
    /// A joint without limits stands at zero, one with a single limit as near to zero as that allows, one that mimics
    /// another where it puts it; a leader stays where its followers can follow.
    pub fn middle_posture(&self) -> DVector<f64> {
        let middle = |joint: usize| {
            // a model that was read has a position for leader and followers
            let limits = self.leader_limits(joint).unwrap_or(self.joints[joint].limits);
            match (limits.lower, limits.upper) {
                // a sum of halves, as the sum of huge limits overflows
                (Some(lower), Some(upper)) => 0.5 * lower + 0.5 * upper,
                _ => limits.clamp(0.0),
            }
        };
        let mut q = DVector::from_fn(self.joint_count(), |joint, _| middle(joint));
        for coupling in self.couplings() {
            q[coupling.follower] = coupling.multiplier * q[coupling.leader] + coupling.offset;
        }
        q
    }

    /// Allocates the scratch memory in which this model is evaluated. Later changes of the model do not reach it.
    pub fn workspace(&self) -> Workspace {
        Workspace::new(self.clone())
    }
}

pub(crate) fn check_length(quantity: &'static str, found: usize, expected: usize) -> Result<(), RobotError> {
    if found == expected { Ok(()) } else { Err(RobotError::WrongLength { quantity, found, expected }) }
}

pub(crate) fn check_finite<'a>(
    quantity: &'static str,
    mut values: impl Iterator<Item = &'a f64>,
) -> Result<(), RobotError> {
    match values.find(|value| !value.is_finite()) {
        Some(&found) => Err(RobotError::InvalidArgument { quantity, found, expected: "a finite number" }),
        None => Ok(()),
    }
}
