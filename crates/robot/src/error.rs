//! What prevents the use of a URDF text, a request or a pose, as values.

use nalgebra::DVector;
use thiserror::Error;

use crate::kinematics::inverse::unreachable::UnreachableReason;

/// A refusal of this crate: what was found, what was expected, how to mend it.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RobotError {
    /// The text is no URDF that can be parsed.
    #[error(
        "read urdf: the text does not parse ({reason}); expected one <robot> element with <link> and <joint> children; correct the XML"
    )]
    NotUrdf {
        /// The parser's own words.
        reason: String,
    },
    /// The text is a xacro source, not a URDF.
    #[error(
        "read urdf: line {line}: found the xacro construct `{found}`; expected plain URDF; expand it first: xacro FILE > robot.urdf"
    )]
    Xacro {
        /// The construct that gave it away.
        found: String,
        /// Its line.
        line: usize,
    },
    /// The file is XML, but of another kind.
    #[error("read urdf: line {line}: the root element is <{found}>; expected <robot>; convert the file to URDF first")]
    NotRobot {
        /// Line of the root element.
        line: usize,
        /// Its name.
        found: String,
    },
    /// An element lacks an attribute that it cannot do without.
    #[error("read urdf: line {line}: {element} has no `{attribute}`; expected {attribute}=\"…\"; add it")]
    MissingAttribute {
        /// Line of the element.
        line: usize,
        /// The element, and whose it is.
        element: String,
        /// The missing attribute.
        attribute: &'static str,
    },
    /// An element lacks a child that it cannot do without.
    #[error("read urdf: line {line}: {element} has no <{child}>; expected one; add it")]
    MissingElement {
        /// Line of the element.
        line: usize,
        /// The element, and whose it is.
        element: String,
        /// The missing child.
        child: &'static str,
    },
    /// A value is not the number, or the list of numbers, that belongs there.
    #[error("read urdf: line {line}: {attribute}=\"{found}\" of {element}; expected {expected}; correct the value")]
    NotNumbers {
        /// Line of the element.
        line: usize,
        /// The element, and whose it is.
        element: String,
        /// The attribute.
        attribute: &'static str,
        /// Its value.
        found: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A joint has a type that URDF does not know.
    #[error(
        "read urdf: line {line}: joint `{joint}` has the type `{found}`; expected fixed, revolute, continuous or prismatic; correct it"
    )]
    UnknownJointType {
        /// Line of the joint.
        line: usize,
        /// The joint.
        joint: String,
        /// The type found.
        found: String,
    },
    /// There are no links.
    #[error("read urdf: found no link; expected at least the base link; add a <link>")]
    NoLinks,
    /// More than one link has no parent joint.
    #[error("read urdf: {} root links ({}); expected one base; join the others to the tree with fixed joints", roots.len(), roots.join(", "))]
    SeveralRoots {
        /// Names of the links without a parent joint.
        roots: Vec<String>,
    },
    /// The joints close a loop.
    #[error(
        "read urdf: link `{link}` lies on a cycle of joints; expected a tree; remove the joint that closes the loop"
    )]
    Cycle {
        /// A link on, or hanging from, the loop.
        link: String,
    },
    /// A link is the child of two joints.
    #[error(
        "read urdf: link `{link}` is the child of joints `{first}` and `{second}`; expected one parent; remove one of the joints"
    )]
    SeveralParents {
        /// The child link.
        link: String,
        /// The joint met first.
        first: String,
        /// The joint met second.
        second: String,
    },
    /// Two links share a name.
    #[error("read urdf: two links are named `{link}`; expected unique names; rename one")]
    DuplicateLink {
        /// The shared name.
        link: String,
    },
    /// Two joints share a name.
    #[error("read urdf: two joints are named `{joint}`; expected unique names; rename one")]
    DuplicateJoint {
        /// The shared name.
        joint: String,
    },
    /// A joint hangs from a link that does not exist.
    #[error(
        "read urdf: joint `{joint}` names the parent link `{link}`, which does not exist; expected a <link> of that name; add it or correct the name"
    )]
    UnknownParent {
        /// The joint.
        joint: String,
        /// The missing link.
        link: String,
    },
    /// A joint carries a link that does not exist.
    #[error(
        "read urdf: joint `{joint}` names the child link `{link}`, which does not exist; expected a <link> of that name; add it or correct the name"
    )]
    UnknownChild {
        /// The joint.
        joint: String,
        /// The missing link.
        link: String,
    },
    /// A movable joint has no direction.
    #[error("read urdf: joint `{joint}` has a zero axis; expected a direction such as 0 0 1; correct <axis xyz>")]
    ZeroAxis {
        /// The joint.
        joint: String,
    },
    /// A joint's lower limit lies above its upper limit.
    #[error(
        "read urdf: joint `{joint}` has lower limit {lower} above upper limit {upper}; expected lower <= upper; exchange them"
    )]
    LimitsReversed {
        /// The joint.
        joint: String,
        /// Lower limit (rad or m).
        lower: f64,
        /// Upper limit (rad or m).
        upper: f64,
    },
    /// A number is NaN or infinite.
    #[error("read urdf: {quantity} of {element} is not a finite number; expected finite numbers; correct the value")]
    NonFinite {
        /// Link or joint, by kind and name.
        element: String,
        /// The quantity at fault.
        quantity: &'static str,
    },
    /// A body has negative mass.
    #[error("read urdf: {element} has mass {mass_kg} kg; expected zero or more; correct <mass value>")]
    NegativeMass {
        /// Link or payload, by kind and name.
        element: String,
        /// The mass found.
        mass_kg: f64,
    },
    /// A quantity that may not be negative is negative.
    #[error("read urdf: {quantity} of {element} is {found}; expected zero or more; correct the value")]
    Negative {
        /// Link or joint, by kind and name.
        element: String,
        /// The quantity at fault.
        quantity: &'static str,
        /// The value found.
        found: f64,
    },
    /// A joint has more than one degree of freedom.
    #[error(
        "read urdf: joint `{joint}` is {kind}; expected fixed, revolute, continuous or prismatic; split it into such joints"
    )]
    UnsupportedJoint {
        /// The joint.
        joint: String,
        /// Its type in the file.
        kind: &'static str,
    },
    /// A mimic joint follows a joint that does not exist.
    #[error(
        "read urdf: joint `{joint}` mimics `{target}`, which does not exist; expected the name of a joint; correct <mimic joint>"
    )]
    MimicTargetMissing {
        /// The following joint.
        joint: String,
        /// The joint it names.
        target: String,
    },
    /// A mimic joint follows a joint that cannot move.
    #[error(
        "read urdf: joint `{joint}` mimics `{target}`, which is fixed; expected a movable joint; make `{joint}` fixed too or correct <mimic joint>"
    )]
    MimicTargetFixed {
        /// The following joint.
        joint: String,
        /// The fixed joint it names.
        target: String,
    },
    /// Mimic joints follow one another in a circle.
    #[error(
        "read urdf: joint `{joint}` mimics itself, directly or through other joints; expected a chain of <mimic> that ends at a joint without one; remove the <mimic> that closes it"
    )]
    MimicCycle {
        /// A joint on, or leading to, the circle.
        joint: String,
    },
    /// The limits of a joint and of those that mimic it exclude each other.
    #[error(
        "limit joint `{joint}`: no position within its own limits keeps `{follower}`, which mimics it, within {lower} to {upper} (rad or m); expected limits that meet; widen the limits of `{follower}` or correct its multiplier and offset"
    )]
    MimicLimitsEmpty {
        /// The joint that leads.
        joint: String,
        /// The joint that follows.
        follower: String,
        /// Lower limit of the follower (rad or m).
        lower: f64,
        /// Upper limit of the follower (rad or m).
        upper: f64,
    },
    /// A frame hangs behind a mimic joint, where the coordinates are not independent.
    #[error(
        "lead frame `{frame}`: joint `{joint}`, which carries it, mimics another joint; expected only independent joints between base and frame; lead a frame before `{joint}`"
    )]
    FrameBehindMimic {
        /// The frame.
        frame: String,
        /// The mimic joint.
        joint: String,
    },
    /// A joint moves nothing that has inertia, so that its acceleration has no meaning.
    #[error(
        "check dynamics: joint `{joint}` feels an inertia of {inertia:.2e} kg m² (kg if it slides); expected more than zero; give the links it moves an <inertial>, make it fixed, or set its rotor inertia"
    )]
    NoInertia {
        /// The joint.
        joint: String,
        /// What it feels when the joints behind it move freely.
        inertia: f64,
    },
    /// The inertia tensor of a moving body is negative about some axis.
    #[error(
        "check dynamics: the body of joint `{joint}` has principal moments {moments:?} kg m²; expected none below zero; correct <inertia> of {}", links.join(", ")
    )]
    NegativeInertia {
        /// The joint that moves the body.
        joint: String,
        /// Links that form the body.
        links: Vec<String>,
        /// Principal moments about the center of mass (kg m²).
        moments: [f64; 3],
    },
    /// No frame has the requested name.
    #[error("find frame: found no frame `{frame}`; expected one of {}; correct the name", known.join(", "))]
    UnknownFrame {
        /// The name asked for.
        frame: String,
        /// All names of the model.
        known: Vec<String>,
    },
    /// A frame of that name exists already.
    #[error("add frame: a frame named `{frame}` exists already; expected a new name; choose another")]
    DuplicateFrame {
        /// The name.
        frame: String,
    },
    /// A vector has the wrong number of entries.
    #[error(
        "{quantity} has {found} entries; expected {expected}, one per movable joint; give one value for each joint"
    )]
    WrongLength {
        /// What the vector holds.
        quantity: &'static str,
        /// Its length.
        found: usize,
        /// The number of movable joints.
        expected: usize,
    },
    /// An argument is outside its domain.
    #[error("{quantity} is {found}; expected {expected}; correct the value")]
    InvalidArgument {
        /// What the argument means.
        quantity: &'static str,
        /// The value found.
        found: f64,
        /// The domain.
        expected: &'static str,
    },
    /// The arm has fewer joints than the task has rows.
    #[error(
        "follow frame `{frame}`: the task has {rows} rows but the arm has {joints} joints; expected rows <= joints; choose fewer task rows"
    )]
    TooFewJoints {
        /// The frame to be led.
        frame: String,
        /// Rows of the task.
        rows: usize,
        /// Movable joints of the arm.
        joints: usize,
    },
    /// No joint vector within the limits reaches the pose.
    #[error(
        "reach pose: the closest posture found misses by {position_error_m:.6} m and {angle_error_rad:.6} rad ({reason}); expected a reachable pose; move the target or the base"
    )]
    Unreachable {
        /// Distance left at the closest posture (m).
        position_error_m: f64,
        /// Angle left at the closest posture (rad).
        angle_error_rad: f64,
        /// What holds the arm back.
        reason: UnreachableReason,
        /// The closest posture found (one entry per joint; rad or m).
        q_closest: DVector<f64>,
    },
    /// A posture that follows a path leaves the joint limits.
    #[error(
        "follow path: joint `{joint}` would stand at {found:.4} (rad or m); expected {lower} to {upper}; move the path or the base"
    )]
    OutsideLimits {
        /// The joint.
        joint: String,
        /// Its position (rad or m).
        found: f64,
        /// Lower limit (rad or m).
        lower: f64,
        /// Upper limit (rad or m).
        upper: f64,
    },
    /// The Jacobian has lost rank, so that some velocity of the frame cannot be made.
    #[error(
        "follow frame `{frame}`: the posture is singular (smallest pivot {pivot:.2e}); expected a posture with full rank; keep the path away from stretched or folded postures"
    )]
    Singular {
        /// The led frame.
        frame: String,
        /// Smallest squared pivot of J Jᵀ.
        pivot: f64,
    },
}
