//! The model out of a checked tree: fixed joints merge, movable joints become bodies.

use std::collections::HashMap;

use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};
use urdf_rs::{JointType, Link, Material, Pose, Robot};

use crate::error::RobotError;
use crate::joint::{Body, Joint, JointKind, JointLimits};
use crate::manipulator::{Frame, Manipulator};
use crate::mesh::MeshProblem;
use crate::mimic;
use crate::shape::{Geometry, Shape};
use crate::urdf::tree::Tree;
use crate::urdf::{inertials, mimics};
use crate::warning::Warning;

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
pub(crate) fn build(robot: &Robot, tree: &Tree, warnings: Vec<Warning>) -> Result<Manipulator, RobotError> {
    let mut parts = Parts { warnings, ..Parts::default() };
    let colors = Colors::new(robot);
    let mut open =
        vec![Visit { link: tree.root, joint: None, parent_body: None, body_from_parent_link: Isometry3::identity() }];
    while let Some(visit) = open.pop() {
        let (body, body_from_link) = parts.enter(visit.joint.map(|joint| &robot.joints[joint]), &visit);
        parts.add_link(&robot.links[visit.link], body, body_from_link, &colors);
        open.extend(tree.children[visit.link].iter().rev().map(|&(joint, link)| Visit {
            link,
            joint: Some(joint),
            parent_body: body,
            body_from_parent_link: body_from_link,
        }));
    }
    mimics::resolve(robot, &mut parts.joints)?;
    let narrowed = mimic::check_limits(&parts.joints)?;
    let massless = parts.joints.iter().filter(|joint| joint.body.mass_kg == 0.0);
    let massless = massless.map(|joint| Warning::MasslessBody { joint: joint.name.clone() });
    parts.warnings.extend(narrowed.into_iter().chain(massless));
    parts.check_finite()?;
    Ok(Manipulator::from_parts(robot.name.clone(), parts.joints, parts.base, parts.frames, parts.warnings))
}

/// Named colors: those of the robot, then those that links define on the way, as files refer to either.
struct Colors<'a>(HashMap<&'a str, [f64; 4]>);

impl<'a> Colors<'a> {
    fn new(robot: &'a Robot) -> Self {
        let of_links = robot.links.iter().flat_map(|link| &link.visual).filter_map(|visual| visual.material.as_ref());
        let mut colors = HashMap::new();
        for material in robot.materials.iter().chain(of_links).filter(|material| !material.name.is_empty()) {
            if let Some(color) = &material.color {
                colors.entry(material.name.as_str()).or_insert(color.rgba.0);
            }
        }
        Self(colors)
    }

    /// The color of a material, or that of its name.
    fn of(&self, material: &Material) -> Option<[f64; 4]> {
        let own = material.color.as_ref().map(|color| color.rgba.0);
        own.or_else(|| self.0.get(material.name.as_str()).copied())
    }
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
        self.warnings.extend(zero_limits(joint));
        self.joints.push(Joint {
            name: joint.name.clone(),
            kind,
            parent: visit.parent_body,
            parent_from_joint,
            axis: Unit::new_normalize(Vector3::from(joint.axis.xyz.0)),
            limits,
            mimic: None,
            damping: joint.dynamics.as_ref().map_or(0.0, |dynamics| dynamics.damping),
            friction: joint.dynamics.as_ref().map_or(0.0, |dynamics| dynamics.friction),
            rotor_inertia: 0.0,
            body: Body::default(),
        });
        (Some(self.joints.len() - 1), Isometry3::identity())
    }

    fn add_link(&mut self, link: &Link, body: Option<usize>, body_from_link: Isometry3<f64>, colors: &Colors<'_>) {
        self.frames.push(Frame { name: link.name.clone(), body, body_from_frame: body_from_link });
        let target = match body {
            Some(index) => &mut self.joints[index].body,
            None => &mut self.base,
        };
        target.links.push(link.name.clone());
        inertials::add(link, &body_from_link, body.is_some(), target, &mut self.warnings);
        let mut place = |origin: &Pose, geometry: &urdf_rs::Geometry, color_rgba| {
            let geometry = shape_of(geometry);
            if let Geometry::Mesh { uri, .. } = &geometry {
                let (link, problem) = (link.name.clone(), MeshProblem::NotResolved);
                self.warnings.push(Warning::MeshIgnored { link, uri: uri.clone(), problem });
            }
            let body_from_shape = body_from_link * isometry(origin);
            Shape { link: link.name.clone(), geometry, body_from_shape, color_rgba }
        };
        for visual in &link.visual {
            let color = visual.material.as_ref().and_then(|material| colors.of(material));
            target.visuals.push(place(&visual.origin, &visual.geometry, color));
        }
        for collision in &link.collision {
            target.collisions.push(place(&collision.origin, &collision.geometry, None));
        }
    }

    /// Each number of the file is finite, but products of huge ones may not be.
    fn check_finite(&self) -> Result<(), RobotError> {
        let pose = |pose: &Isometry3<f64>| pose.to_homogeneous().iter().all(|value| value.is_finite());
        let body = |body: &Body| {
            let numbers = body.center_of_mass_m.iter().chain(&body.inertia_kg_m2);
            let shapes = body.visuals.iter().chain(&body.collisions);
            body.mass_kg.is_finite()
                && numbers.copied().all(f64::is_finite)
                && shapes.into_iter().all(|shape| pose(&shape.body_from_shape))
        };
        let refusal = |element: String| RobotError::NonFinite { element, quantity: "a product of its numbers" };
        if !body(&self.base) {
            return Err(refusal("the base".to_owned()));
        }
        let joint = |joint: &&Joint| {
            let axis = joint.axis.iter().all(|value| value.is_finite());
            !(axis && pose(&joint.parent_from_joint) && body(&joint.body))
        };
        if let Some(joint) = self.joints.iter().find(joint) {
            return Err(refusal(format!("joint `{}` with the links it carries", joint.name)));
        }
        match self.frames.iter().find(|frame| !pose(&frame.body_from_frame)) {
            Some(frame) => Err(refusal(format!("link `{}`", frame.name))),
            None => Ok(()),
        }
    }
}

/// What is said of limits that are written as zero. A joint without any <limit> reads as if all were: of it the position limits
/// are told.
fn zero_limits(joint: &urdf_rs::Joint) -> Vec<Warning> {
    let limit = &joint.limit;
    let is_there = [limit.lower, limit.upper, limit.velocity, limit.effort].iter().any(|value| *value != 0.0);
    let limits = [("effort", limit.effort), ("velocity", limit.velocity)].into_iter();
    let zeros = limits.filter(|(_, value)| is_there && *value == 0.0);
    zeros.map(|(attribute, _)| Warning::LimitZero { joint: joint.name.clone(), attribute }).collect()
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

fn shape_of(geometry: &urdf_rs::Geometry) -> Geometry {
    match geometry {
        urdf_rs::Geometry::Box { size } => Geometry::Box { size_m: Vector3::from(size.0) },
        urdf_rs::Geometry::Cylinder { radius, length } => Geometry::Cylinder { radius_m: *radius, length_m: *length },
        urdf_rs::Geometry::Capsule { radius, length } => Geometry::Capsule { radius_m: *radius, length_m: *length },
        urdf_rs::Geometry::Sphere { radius } => Geometry::Sphere { radius_m: *radius },
        urdf_rs::Geometry::Mesh { filename, scale } => Geometry::Mesh {
            uri: filename.trim().to_owned(),
            scale: scale.map_or_else(|| Vector3::repeat(1.0), |scale| Vector3::from(scale.0)),
            triangles: None,
        },
    }
}

pub(crate) fn isometry(pose: &Pose) -> Isometry3<f64> {
    let [roll, pitch, yaw] = pose.rpy.0;
    let [x, y, z] = pose.xyz.0;
    Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_euler_angles(roll, pitch, yaw))
}
