//! Which elements and attributes of a URDF this crate uses, and what their values are.

/// What an attribute holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Value {
    Text,
    /// One number.
    Number,
    /// That many numbers.
    Vector(usize),
    /// Three factors; one stands for all, and a fourth is left out.
    Scale,
    /// Red, green, blue, opacity; without the last it is opaque.
    Color,
}

/// What a missing attribute means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Absent {
    /// The parser knows.
    Fine,
    /// This value, which the parser would miss.
    Means(&'static str),
    /// The file cannot be used.
    Refused,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct AttributeRule {
    pub name: &'static str,
    pub value: Value,
    pub absent: Absent,
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct ElementRule {
    pub name: &'static str,
    pub attributes: &'static [AttributeRule],
    pub children: &'static [ElementRule],
    /// Children without which the file cannot be used.
    pub required: &'static [&'static str],
    /// True if the parent may have several.
    pub several: bool,
}

/// Elements that say nothing about an arm at rest or in motion, and that are therefore left out without a word.
/// Elements with a declared prefix, which are extensions for one program, are left out likewise.
pub(crate) const KNOWN_BUT_UNUSED: [&str; 19] = [
    "transmission",
    "gazebo",
    "sensor",
    "ros2_control",
    "mujoco",
    "safety_controller",
    "calibration",
    "texture",
    "contact",
    "contact_coefficients",
    "self_collision_checking",
    "collision_checking",
    "self_filter",
    "surface",
    "gravity",
    "kinematic",
    // of a collision, which has no color
    "material",
    "verbose",
    "group_state",
];

pub(crate) const JOINT_TYPES: [&str; 7] =
    ["fixed", "revolute", "continuous", "prismatic", "floating", "planar", "spherical"];

/// Shapes that a <geometry> may hold.
pub(crate) const SHAPES: [ElementRule; 5] = [
    element("box", &[required("size", Value::Vector(3))], &[]),
    element("cylinder", &[required("radius", Value::Number), required("length", Value::Number)], &[]),
    element("capsule", &[required("radius", Value::Number), required("length", Value::Number)], &[]),
    element("sphere", &[required("radius", Value::Number)], &[]),
    element("mesh", &[required("filename", Value::Text), optional("scale", Value::Scale)], &[]),
];

/// The whole file.
pub(crate) const ROBOT: ElementRule = element(
    "robot",
    &[optional("name", Value::Text), optional("version", Value::Text)],
    &[several(LINK), several(JOINT), several(MATERIAL)],
);

const LINK: ElementRule =
    element("link", &[required("name", Value::Text)], &[INERTIAL, several(VISUAL), several(COLLISION)]);

const INERTIAL: ElementRule = needing(
    &["mass", "inertia"],
    element("inertial", &[], &[ORIGIN, element("mass", &[required("value", Value::Number)], &[]), INERTIA]),
);

const INERTIA: ElementRule = element(
    "inertia",
    &[
        required("ixx", Value::Number),
        defaulted("ixy", Value::Number, "0"),
        defaulted("ixz", Value::Number, "0"),
        required("iyy", Value::Number),
        defaulted("iyz", Value::Number, "0"),
        required("izz", Value::Number),
    ],
    &[],
);

const VISUAL: ElementRule = element("visual", &[], &[ORIGIN, GEOMETRY, MATERIAL]);
const COLLISION: ElementRule = element("collision", &[], &[ORIGIN, GEOMETRY]);
const GEOMETRY: ElementRule = element("geometry", &[], &SHAPES);
const MATERIAL: ElementRule = element(
    "material",
    &[defaulted("name", Value::Text, "")],
    &[element("color", &[required("rgba", Value::Color)], &[])],
);

const JOINT: ElementRule = needing(
    &["parent", "child"],
    element(
        "joint",
        &[required("name", Value::Text), required("type", Value::Text)],
        &[
            ORIGIN,
            element("parent", &[required("link", Value::Text)], &[]),
            element("child", &[required("link", Value::Text)], &[]),
            element("axis", &[required("xyz", Value::Vector(3))], &[]),
            LIMIT,
            element("dynamics", &[optional("damping", Value::Number), optional("friction", Value::Number)], &[]),
            MIMIC,
        ],
    ),
);

const LIMIT: ElementRule = element(
    "limit",
    &[
        optional("lower", Value::Number),
        optional("upper", Value::Number),
        defaulted("effort", Value::Number, "inf"),
        defaulted("velocity", Value::Number, "inf"),
    ],
    &[],
);

const MIMIC: ElementRule = element(
    "mimic",
    &[required("joint", Value::Text), optional("multiplier", Value::Number), optional("offset", Value::Number)],
    &[],
);

const ORIGIN: ElementRule = element(
    "origin",
    &[optional("xyz", Value::Vector(3)), optional("rpy", Value::Vector(3)), optional("quat_xyzw", Value::Vector(4))],
    &[],
);

const fn element(
    name: &'static str,
    attributes: &'static [AttributeRule],
    children: &'static [ElementRule],
) -> ElementRule {
    ElementRule { name, attributes, children, required: &[], several: false }
}

const fn needing(required: &'static [&'static str], rule: ElementRule) -> ElementRule {
    ElementRule { required, ..rule }
}

const fn several(rule: ElementRule) -> ElementRule {
    ElementRule { several: true, ..rule }
}

const fn required(name: &'static str, value: Value) -> AttributeRule {
    AttributeRule { name, value, absent: Absent::Refused }
}

const fn optional(name: &'static str, value: Value) -> AttributeRule {
    AttributeRule { name, value, absent: Absent::Fine }
}

const fn defaulted(name: &'static str, value: Value, means: &'static str) -> AttributeRule {
    AttributeRule { name, value, absent: Absent::Means(means) }
}
