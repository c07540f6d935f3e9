//! The model out of a checked tree: fixed joints merge, movable joints become bodies.

use nalgebra::{Isometry3, Matrix3, SymmetricEigen, Translation3, Unit, UnitQuaternion, Vector3};
use urdf_rs::{JointType, Link, Material, Pose, Robot};

use crate::error::Warning;
use crate::joint::{Body, Joint, JointKind, JointLimits};
use crate::manipulator::{Frame, Manipulator};
use crate::shape::{Geometry, Shape};
use crate::urdf::tree::Tree;

/// Relative room for rounding in the triangle inequality of principal moments, as files give about six digits.
const TRIANGLE_TOLERANCE: f64 = 1e-6;
/// Steps allowed for the eigenvalues of a 3 × 3 matrix, which takes about five.
const EIGENVALUE_STEPS: usize = 100;

/// A link still to be visited, with the joint that leads to it from a body already built.
struct Visit {
    link: usize,
    joint: Option<usize>,
    parent_body: Option<usize>,
    /// Pose of the parent link in the parent body.
    body_from_parent_link: Isometry3<f64>,
}

#[derive(Default)]
struct Parts {
    joints: Vec<Joint>,
    base: Body,
    frames: Vec<Frame>,
    warnings: Vec<Warning>,
}

/// Builds the model, depth first in the order of the file, so that parents come before children.
pub(crate) fn build(robot: &Robot, tree: &Tree) -> Manipulator {
    let mut parts = Parts::default();
    let mut open =
        vec![Visit { link: tree.root, joint: None, parent_body: None, body_from_parent_link: Isometry3::identity() }];
    while let Some(visit) = open.pop() {
        let (body, body_from_link) = parts.enter(visit.joint.map(|joint| &robot.joints[joint]), &visit);
        parts.add_link(&robot.links[visit.link], body, body_from_link, &robot.materials);
        open.extend(tree.children[visit.link].iter().rev().map(|&(joint, link)| Visit {
            link,
            joint: Some(joint),
            parent_body: body,
            body_from_parent_link: body_from_link,
        }));
    }
    let massless = parts.joints.iter().filter(|joint| joint.body.mass_kg == 0.0);
    let warnings: Vec<Warning> = massless.map(|joint| Warning::MasslessBody { joint: joint.name.clone() }).collect();
    parts.warnings.extend(warnings);
    Manipulator::from_parts(robot.name.clone(), parts.joints, parts.base, parts.frames, parts.warnings)
}

impl Parts {
    /// Goes through the joint of a visit; returns the body of the link behind it and the link's pose there.
    fn enter(&mut self, joint: Option<&urdf_rs::Joint>, visit: &Visit) -> (Option<usize>, Isometry3<f64>) {
        let Some(joint) = joint else { return (None, Isometry3::identity()) };
        let parent_from_joint = visit.body_from_parent_link * isometry(&joint.origin);
        let kind = match joint.joint_type {
            JointType::Revolute => JointKind::Revolute,
            JointType::Continuous => JointKind::Continuous,
            JointType::Prismatic => JointKind::Prismatic,
            // the checks refuse every other type but fixed
            _ => return (visit.parent_body, parent_from_joint),
        };
        let limits = joint_limits(joint, kind);
        if kind != JointKind::Continuous && limits.lower.is_none() && limits.upper.is_none() {
            self.warnings.push(Warning::LimitsAbsent { joint: joint.name.clone() });
        }
        self.joints.push(Joint {
            name: joint.name.clone(),
            kind,
            parent: visit.parent_body,
            parent_from_joint,
            axis: Unit::new_normalize(Vector3::from(joint.axis.xyz.0)),
            limits,
            damping: joint.dynamics.as_ref().map_or(0.0, |dynamics| dynamics.damping),
            friction: joint.dynamics.as_ref().map_or(0.0, |dynamics| dynamics.friction),
            rotor_inertia: 0.0,
            body: Body::default(),
        });
        (Some(self.joints.len() - 1), Isometry3::identity())
    }

    fn add_link(&mut self, link: &Link, body: Option<usize>, body_from_link: Isometry3<f64>, materials: &[Material]) {
        self.frames.push(Frame { name: link.name.clone(), body, body_from_frame: body_from_link });
        let target = match body {
            Some(index) => &mut self.joints[index].body,
            None => &mut self.base,
        };
        target.links.push(link.name.clone());
        add_inertial(link, &body_from_link, target, &mut self.warnings);
        let mut place = |origin: &Pose, geometry: &urdf_rs::Geometry, color_rgba| {
            let body_from_shape = body_from_link * isometry(origin);
            match primitive(geometry) {
                Ok(geometry) => Some(Shape { link: link.name.clone(), geometry, body_from_shape, color_rgba }),
                Err(file) => {
                    let warning = Warning::MeshIgnored { link: link.name.clone(), file: file.to_owned() };
                    self.warnings.push(warning);
                    None
                }
            }
        };
        for visual in &link.visual {
            let color = visual.material.as_ref().and_then(|material| color_of(material, materials));
            target.visuals.extend(place(&visual.origin, &visual.geometry, color));
        }
        for collision in &link.collision {
            target.collisions.extend(place(&collision.origin, &collision.geometry, None));
        }
    }
}

fn add_inertial(link: &Link, body_from_link: &Isometry3<f64>, body: &mut Body, warnings: &mut Vec<Warning>) {
    let written = &link.inertial.inertia;
    let tensor = Matrix3::new(
        written.ixx,
        written.ixy,
        written.ixz, //
        written.ixy,
        written.iyy,
        written.iyz, //
        written.ixz,
        written.iyz,
        written.izz,
    );
    if let Some(moments) = unphysical_moments(&tensor) {
        warnings.push(Warning::UnphysicalInertia { link: link.name.clone(), moments });
    }
    let body_from_inertial = body_from_link * isometry(&link.inertial.origin);
    let axes = body_from_inertial.rotation.to_rotation_matrix().into_inner();
    let rotated = axes * tensor * axes.transpose();
    body.add_part(link.inertial.mass.value, body_from_inertial.translation.vector, rotated);
}

/// The principal moments (kg m²) of a tensor that belongs to no rigid body; `None` for a physical one.
fn unphysical_moments(tensor: &Matrix3<f64>) -> Option<[f64; 3]> {
    let scale = tensor.amax();
    if scale == 0.0 {
        return None;
    }
    // scaled, so that huge numbers do not overflow inside the decomposition
    let decomposition = SymmetricEigen::try_new(tensor / scale, f64::EPSILON, EIGENVALUE_STEPS);
    let moments = decomposition.map_or(Vector3::repeat(f64::NAN), |found| found.eigenvalues);
    let physical = moments.min() >= -TRIANGLE_TOLERANCE && 2.0 * moments.max() <= moments.sum() + TRIANGLE_TOLERANCE;
    (!physical).then(|| (moments * scale).into())
}

/// Reads limits; the parser gives 0 or infinity for what the file does not state.
fn joint_limits(joint: &urdf_rs::Joint, kind: JointKind) -> JointLimits {
    let limit = &joint.limit;
    let positions_stated = kind != JointKind::Continuous && (limit.lower != 0.0 || limit.upper != 0.0);
    let stated = |value: f64| (value.is_finite() && value > 0.0).then_some(value);
    JointLimits {
        lower: (positions_stated && limit.lower.is_finite()).then_some(limit.lower),
        upper: (positions_stated && limit.upper.is_finite()).then_some(limit.upper),
        velocity: stated(limit.velocity),
        effort: stated(limit.effort),
    }
}

/// The primitive, or the file name of a mesh.
fn primitive(geometry: &urdf_rs::Geometry) -> Result<Geometry, &str> {
    match geometry {
        urdf_rs::Geometry::Box { size } => Ok(Geometry::Box { size_m: Vector3::from(size.0) }),
        urdf_rs::Geometry::Cylinder { radius, length } => {
            Ok(Geometry::Cylinder { radius_m: *radius, length_m: *length })
        }
        urdf_rs::Geometry::Capsule { radius, length } => Ok(Geometry::Capsule { radius_m: *radius, length_m: *length }),
        urdf_rs::Geometry::Sphere { radius } => Ok(Geometry::Sphere { radius_m: *radius }),
        urdf_rs::Geometry::Mesh { filename, .. } => Err(filename),
    }
}

/// The color of a material, or of the robot's material of the same name.
fn color_of(material: &Material, materials: &[Material]) -> Option<[f64; 4]> {
    let named = || materials.iter().find(|other| other.name == material.name).and_then(|other| other.color.as_ref());
    material.color.as_ref().or_else(named).map(|color| color.rgba.0)
}

fn isometry(pose: &Pose) -> Isometry3<f64> {
    let [roll, pitch, yaw] = pose.rpy.0;
    let [x, y, z] = pose.xyz.0;
    Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_euler_angles(roll, pitch, yaw))
}
