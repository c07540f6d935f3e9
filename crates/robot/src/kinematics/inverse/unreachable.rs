//! Why a pose cannot be reached: too far for the length of the arm, held back by joint limits, or neither.

use std::fmt;

use nalgebra::{Isometry3, Matrix6xX, Vector6};

use crate::joint::JointKind;
use crate::manipulator::{FrameId, Manipulator};
use crate::workspace::Workspace;

/// Distance to a limit (rad or m) at which a joint counts as being there; steps end on limits exactly.
const AT_LIMIT: f64 = 1e-9;
/// Part of the error that a joint must take away per unit of its motion beyond a limit, for the limit to count as binding.
const BINDING: f64 = 1e-3;

/// Why the closest posture does not reach the target.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum UnreachableReason {
    /// No posture of any joint could reach so far: all links end to end are too short.
    TooFar {
        /// The first joint that moves the frame, from whose origin the distance counts.
        joint: String,
        /// Distance of the target from there (m).
        distance_m: f64,
        /// Sum of all links and strokes from there to the frame (m).
        reach_m: f64,
    },
    /// Joints stand at limits beyond which the frame would come closer.
    AtLimits {
        /// Names of the joints, the one that would help most first.
        joints: Vec<String>,
    },
    /// The posture is nearly singular: the frame lags, since the joints would have to move without bound.
    NearlySingular {
        /// Smallest pivot of the Jacobian, damping included (m/rad or one).
        pivot: f64,
    },
    /// No joint motion comes closer, or none was found: the arm is stretched, folded, or cannot turn the frame that way.
    NoCloserMotion,
}

impl fmt::Display for UnreachableReason {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFar { joint, distance_m, reach_m } => write!(
                out,
                "the target is {distance_m:.4} m from joint `{joint}`, and all links from there reach {reach_m:.4} m"
            ),
            Self::AtLimits { joints } if joints.len() == 1 => {
                write!(out, "joint `{}` is at its limit", joints.concat())
            }
            Self::AtLimits { joints } => write!(out, "joints `{}` are at their limits", joints.join("`, `")),
            Self::NearlySingular { pivot } => {
                write!(out, "the posture is nearly singular, with a pivot of {pivot:.2e}")
            }
            Self::NoCloserMotion => write!(out, "no joint is at a limit, and no motion found brings the frame closer"),
        }
    }
}

/// A sphere that the origin of a frame cannot leave, whatever the joints do, limits of strokes aside.
#[derive(Debug, Clone)]
pub(crate) struct ReachBound {
    /// Index of the first joint that moves the frame.
    joint: usize,
    reach_m: f64,
}

impl ReachBound {
    /// Adds up the links from the first joint to the frame; `None` if no joint moves the frame or a slide has no limits.
    pub fn new(manipulator: &Manipulator, frame: FrameId) -> Option<Self> {
        let (mut carrier, body_from_frame) = manipulator.frame_attachment(frame);
        let mut reach_m = body_from_frame.translation.vector.norm();
        loop {
            let index = carrier?;
            let joint = &manipulator.joints[index];
            if joint.kind == JointKind::Prismatic {
                reach_m += joint.limits.lower?.abs().max(joint.limits.upper?.abs());
            }
            if joint.parent.is_none() {
                return Some(Self { joint: index, reach_m });
            }
            reach_m += joint.parent_from_joint.translation.vector.norm();
            carrier = joint.parent;
        }
    }

    /// The reason, if the target lies outside the sphere.
    pub fn refusal(&self, manipulator: &Manipulator, target: &Isometry3<f64>) -> Option<UnreachableReason> {
        let joint = &manipulator.joints[self.joint];
        let distance_m = (target.translation.vector - joint.parent_from_joint.translation.vector).norm();
        let reach_m = self.reach_m;
        (distance_m > reach_m).then(|| UnreachableReason::TooFar { joint: joint.name.clone(), distance_m, reach_m })
    }
}

/// Joints at limits that keep the error from shrinking: the sign of Jᵀ e says where each joint should go.
pub(crate) fn limit_refusal(
    workspace: &Workspace,
    q: &[f64],
    jacobian: &Matrix6xX<f64>,
    displacement: &Vector6<f64>,
) -> UnreachableReason {
    let least = BINDING * displacement.norm_squared();
    let joints = workspace.model.joints.iter().zip(jacobian.column_iter()).zip(q);
    let mut binding: Vec<(f64, &str)> = joints
        .filter_map(|((joint, column), &q)| {
            let gain = column.dot(displacement);
            let beyond = q + gain.signum() * AT_LIMIT;
            let held = joint.limits.clamp(beyond) != beyond;
            (held && gain.abs() > least).then_some((gain.abs(), joint.name.as_str()))
        })
        .collect();
    if binding.is_empty() {
        return UnreachableReason::NoCloserMotion;
    }
    binding.sort_by(|a, b| b.0.total_cmp(&a.0));
    UnreachableReason::AtLimits { joints: binding.into_iter().map(|(_, name)| name.to_owned()).collect() }
}
