//! One movable joint and the rigid body it carries.

use nalgebra::{Isometry3, Matrix3, Unit, Vector3};

use crate::mimic::Mimic;
use crate::shape::Shape;

/// The motion a joint allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// Rotation about the axis, within limits.
    Revolute,
    /// Rotation about the axis without position limits.
    Continuous,
    /// Translation along the axis.
    Prismatic,
}

impl JointKind {
    /// True if the joint turns, false if it slides.
    pub fn rotates(self) -> bool {
        !matches!(self, Self::Prismatic)
    }
}

/// Limits of a joint; `None` where the URDF states none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointLimits {
    /// Smallest position (rad or m).
    pub lower: Option<f64>,
    /// Largest position (rad or m).
    pub upper: Option<f64>,
    /// Largest speed (rad/s or m/s).
    pub velocity: Option<f64>,
    /// Largest torque or force (N m or N).
    pub effort: Option<f64>,
}

impl JointLimits {
    /// Returns the nearest position within the limits (rad or m).
    pub fn clamp(&self, q: f64) -> f64 {
        q.max(self.lower.unwrap_or(f64::NEG_INFINITY)).min(self.upper.unwrap_or(f64::INFINITY))
    }
}

/// A rigid body: everything that one joint carries, fixed links merged.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Mass (kg).
    pub mass_kg: f64,
    /// Center of mass in the body frame (m).
    pub center_of_mass_m: Vector3<f64>,
    /// Inertia tensor about the center of mass, in the axes of the body frame (kg m²).
    pub inertia_kg_m2: Matrix3<f64>,
    /// Names of the URDF links that form the body, the one next to the joint first.
    pub links: Vec<String>,
    /// Shapes to draw.
    pub visuals: Vec<Shape>,
    /// Shapes to collide with.
    pub collisions: Vec<Shape>,
}

impl Default for Body {
    fn default() -> Self {
        Self {
            mass_kg: 0.0,
            center_of_mass_m: Vector3::zeros(),
            inertia_kg_m2: Matrix3::zeros(),
            links: Vec::new(),
            visuals: Vec::new(),
            collisions: Vec::new(),
        }
    }
}

impl Body {
    /// Adds a rigid part: mass (kg), center of mass in the body frame (m), inertia about that center in body axes (kg m²).
    pub(crate) fn add_part(&mut self, mass_kg: f64, center_m: Vector3<f64>, inertia_kg_m2: Matrix3<f64>) {
        let total = self.mass_kg + mass_kg;
        let center =
            if total > 0.0 { (self.center_of_mass_m * self.mass_kg + center_m * mass_kg) / total } else { center_m };
        self.inertia_kg_m2 += inertia_kg_m2
            + parallel_axis(self.mass_kg, self.center_of_mass_m - center)
            + parallel_axis(mass_kg, center_m - center);
        self.center_of_mass_m = center;
        self.mass_kg = total;
    }
}

/// Steiner's term: inertia (kg m²) of a point mass (kg) at an offset (m).
pub(crate) fn parallel_axis(mass_kg: f64, offset_m: Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * offset_m.norm_squared() - offset_m * offset_m.transpose()) * mass_kg
}

/// A movable joint with the body it carries. The body frame is the joint frame, moved by the joint.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Joint {
    /// Name in the URDF.
    pub name: String,
    /// The motion it allows.
    pub kind: JointKind,
    /// Index of the joint that carries the parent body; `None` for the base. Always smaller than the joint's own index.
    pub parent: Option<usize>,
    /// Pose of the joint frame, at position zero, in the parent body's frame.
    pub parent_from_joint: Isometry3<f64>,
    /// Unit axis in the joint frame.
    pub axis: Unit<Vector3<f64>>,
    /// Position, speed and effort limits.
    pub limits: JointLimits,
    /// The joint it follows, if it is not independent; see [`crate::Manipulator::couplings`].
    pub mimic: Option<Mimic>,
    /// Viscous damping of `<dynamics>` (N m s/rad or N s/m). Reported, not part of the equations of motion here.
    pub damping: f64,
    /// Coulomb friction of `<dynamics>` (N m or N). Reported, not part of the equations of motion here.
    pub friction: f64,
    /// Rotor inertia felt at the joint (kg m², or kg for a prismatic joint); zero unless set on the manipulator.
    pub rotor_inertia: f64,
    /// The body the joint carries.
    pub body: Body,
}

impl Joint {
    /// Returns the pose of the body frame in the parent body's frame at position `q` (rad or m).
    pub fn parent_from_body(&self, q: f64) -> Isometry3<f64> {
        let motion = if self.kind.rotates() {
            Isometry3::rotation(self.axis.into_inner() * q)
        } else {
            Isometry3::translation(self.axis.x * q, self.axis.y * q, self.axis.z * q)
        };
        self.parent_from_joint * motion
    }
}
