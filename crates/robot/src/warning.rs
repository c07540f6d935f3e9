//! What is odd in a URDF but does not prevent its use, as values.

use thiserror::Error;

use crate::mesh::MeshProblem;

/// Something odd in a URDF that does not prevent its use.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Warning {
    /// An element that this crate does not know was left out.
    #[error(
        "line {line}: <{element}> in <{parent}> {}is ignored ({times} in the file); if it is no misspelling, nothing needs to be done",
        undeclared_prefix.as_ref().map(|prefix| format!("has the undeclared prefix `{prefix}` and ")).unwrap_or_default()
    )]
    ElementIgnored {
        /// Line of the first of them.
        line: usize,
        /// Its name.
        element: String,
        /// Name of the element it stands in.
        parent: &'static str,
        /// Its namespace prefix, if the file declares none of that name.
        undeclared_prefix: Option<String>,
        /// How many of them were left out.
        times: usize,
    },
    /// An element of which one is expected stands there again; the first counts.
    #[error("line {line}: {element} stands there again and is ignored; expected one; remove one of them")]
    ElementRepeated {
        /// Line of the ignored element.
        line: usize,
        /// The element, and whose it is.
        element: String,
    },
    /// A visual or collision was left out, as it holds no shape of URDF.
    #[error(
        "line {line}: {element} is ignored, as it holds {found}; expected a box, cylinder, capsule, sphere or mesh"
    )]
    ShapeIgnored {
        /// Line of the visual or collision.
        line: usize,
        /// The element, and whose it is.
        element: String,
        /// What stands there instead of a shape.
        found: String,
    },
    /// A value was written in a way that URDF does not know, and was understood nevertheless.
    #[error(
        "line {line}: {attribute}=\"{found}\" of {element} is read as \"{used}\"; write it so if that is what it means"
    )]
    ValueMended {
        /// Line of the element.
        line: usize,
        /// The element, and whose it is.
        element: String,
        /// The attribute.
        attribute: &'static str,
        /// The value as written.
        found: String,
        /// The value as read.
        used: String,
    },
    /// The inertia tensor cannot belong to any rigid body.
    #[error(
        "link `{link}`: ITS INERTIA IS IMPOSSIBLE: no rigid body has the principal moments {} kg m²; expected none below zero and \
         none above the sum of the others; the link is simulated as written, so do not trust how it turns; correct <inertia>, \
         for instance with the moments that a drawing program computes from its shape",
        listed(moments)
    )]
    UnphysicalInertia {
        /// The link.
        link: String,
        /// Principal moments of inertia about the center of mass (kg m²).
        moments: [f64; 3],
    },
    /// A moving link has mass but no inertia.
    #[error("link `{link}`: {mass_kg} kg without inertia count as a point; expected an inertia tensor; add <inertia>")]
    PointMass {
        /// The link.
        link: String,
        /// Its mass (kg).
        mass_kg: f64,
    },
    /// A moving body has no mass at all.
    #[error(
        "joint `{joint}` moves a body without mass; expected an <inertial> on its links; dynamics need one or a rotor inertia"
    )]
    MasslessBody {
        /// The joint that moves the body.
        joint: String,
    },
    /// A mesh was left out.
    #[error("link `{link}`: mesh `{uri}` is ignored: {problem}")]
    MeshIgnored {
        /// The link.
        link: String,
        /// The mesh's file name as written.
        uri: String,
        /// What prevents its use.
        problem: MeshProblem,
    },
    /// A revolute or prismatic joint has no usable position limits.
    #[error("joint `{joint}` has no position limits (absent, or both zero); it is taken as unlimited")]
    LimitsAbsent {
        /// The joint.
        joint: String,
    },
    /// A limit of zero was taken as none.
    #[error(
        "joint `{joint}`: {attribute}=\"0\" is taken as unlimited; write the true limit, or leave {attribute} out if there is none"
    )]
    LimitZero {
        /// The joint.
        joint: String,
        /// The attribute: effort or velocity.
        attribute: &'static str,
    },
    /// A joint that others mimic may not use all of its own range.
    #[error(
        "joint `{joint}`: the limits of the joints that mimic it leave {lower} to {upper} (rad or m) of its own range"
    )]
    LimitsNarrowed {
        /// The joint that leads.
        joint: String,
        /// The least position that suits all (rad or m; −∞ if unlimited).
        lower: f64,
        /// The largest position that suits all (rad or m; ∞ if unlimited).
        upper: f64,
    },
}

/// Principal moments with four digits.
fn listed(moments: &[f64; 3]) -> String {
    moments.map(|moment| format!("{moment:.3e}")).join(", ")
}
