//! Joints that mimic others: position = multiplier × leader + offset.
//!
//! A mimic joint stays a coordinate of its own, so that kinematics and dynamics keep their O(n) recursions, as in
//! Pinocchio and MuJoCo; what couples it to its leader is stated beside it. Three ways to use that:
//!
//! - *Kinematics*: choose the independent joints, then [`Manipulator::complete_positions`] and
//!   [`Manipulator::complete_velocities`] fill in the others. [`Manipulator::leader_limits`] is the range that suits all.
//!   [`crate::InverseKinematics`] leads only frames that no mimic joint carries, so that its answers are exact for the joints
//!   up to the frame; complete them before use.
//! - *Dynamics on paper*: q̇ = G ẏ with [`Manipulator::coupling_matrix`] G, hence M_y = Gᵀ M G, τ_y = Gᵀ τ.
//! - *Simulation*: give the engine one constraint for each of [`Manipulator::couplings`], and start from completed
//!   positions and velocities.

use nalgebra::{DMatrix, DVector};

use crate::error::RobotError;
use crate::joint::{Joint, JointLimits};
use crate::manipulator::{FrameId, Manipulator, check_length};
use crate::warning::Warning;

/// What a joint follows: position = multiplier × leader + offset. Chains are resolved, so the leader follows nobody.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mimic {
    /// Index of the leading joint; before or behind the follower.
    pub leader: usize,
    /// Motion of the follower for each unit of the leader's (rad or m for each rad or m).
    pub multiplier: f64,
    /// Position of the follower where the leader stands at zero (rad or m).
    pub offset: f64,
}

/// One joint coupled to another: `q[follower] = multiplier × q[leader] + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coupling {
    /// Index of the joint that follows.
    pub follower: usize,
    /// Index of the joint that leads; it follows nobody.
    pub leader: usize,
    /// Motion of the follower for each unit of the leader's.
    pub multiplier: f64,
    /// Position of the follower where the leader stands at zero (rad or m).
    pub offset: f64,
}

impl Manipulator {
    /// Returns the couplings of all mimic joints, in the order of the followers.
    pub fn couplings(&self) -> impl Iterator<Item = Coupling> {
        self.joints.iter().enumerate().filter_map(|(follower, joint)| {
            joint.mimic.map(|Mimic { leader, multiplier, offset }| Coupling { follower, leader, multiplier, offset })
        })
    }

    /// Returns the indices of the joints that mimic no other, in order.
    pub fn independent_joints(&self) -> impl Iterator<Item = usize> {
        self.joints.iter().enumerate().filter(|(_, joint)| joint.mimic.is_none()).map(|(index, _)| index)
    }

    /// Puts the mimic joints where their leaders ask them to be, in joint positions `q` (n entries; rad or m).
    ///
    /// # Errors
    /// [`RobotError::WrongLength`].
    pub fn complete_positions(&self, q: &mut DVector<f64>) -> Result<(), RobotError> {
        check_length("complete positions: q", q.len(), self.joint_count())?;
        for (follower, joint) in self.joints.iter().enumerate() {
            if let Some(mimic) = joint.mimic {
                q[follower] = mimic.multiplier * q[mimic.leader] + mimic.offset;
            }
        }
        Ok(())
    }

    /// Gives the mimic joints the velocities that their leaders ask for, in `dq` (n entries; rad/s or m/s). Accelerations
    /// obey the same law.
    ///
    /// # Errors
    /// [`RobotError::WrongLength`].
    pub fn complete_velocities(&self, dq: &mut DVector<f64>) -> Result<(), RobotError> {
        check_length("complete velocities: dq", dq.len(), self.joint_count())?;
        for (follower, joint) in self.joints.iter().enumerate() {
            if let Some(mimic) = joint.mimic {
                dq[follower] = mimic.multiplier * dq[mimic.leader];
            }
        }
        Ok(())
    }

    /// Returns G (n rows, one column for each independent joint in order), with which q̇ = G ẏ.
    pub fn coupling_matrix(&self) -> DMatrix<f64> {
        let independent: Vec<usize> = self.independent_joints().collect();
        DMatrix::from_fn(self.joint_count(), independent.len(), |row, column| match self.joints[row].mimic {
            Some(mimic) if mimic.leader == independent[column] => mimic.multiplier,
            None if row == independent[column] => 1.0,
            _ => 0.0,
        })
    }

    /// Returns the limits of joint `leader`, narrowed so that all joints that mimic it stay within their own positions and
    /// speeds. The effort stays its own. For a joint that nobody mimics these are its limits.
    ///
    /// # Errors
    /// [`RobotError::MimicLimitsEmpty`] if no position suits all, which a model out of a URDF has been checked for;
    /// [`RobotError::InvalidArgument`] if there is no joint of that index.
    pub fn leader_limits(&self, leader: usize) -> Result<JointLimits, RobotError> {
        leader_limits(&self.joints, leader)
    }

    /// Checks that no mimic joint carries the frame, so that its Jacobian is that of independent joints.
    ///
    /// # Errors
    /// [`RobotError::FrameBehindMimic`].
    ///
    /// # Panics
    /// If the frame belongs to another model.
    pub fn check_independent(&self, frame: FrameId) -> Result<(), RobotError> {
        let (mut carrier, _) = self.frame_attachment(frame);
        while let Some(joint) = carrier.map(|index| &self.joints[index]) {
            if joint.mimic.is_some() {
                let frame = self.frame_name(frame).to_owned();
                return Err(RobotError::FrameBehindMimic { frame, joint: joint.name.clone() });
            }
            carrier = joint.parent;
        }
        Ok(())
    }
}

fn leader_limits(joints: &[Joint], leader: usize) -> Result<JointLimits, RobotError> {
    let Some(joint) = joints.get(leader) else {
        let expected = "less than the number of joints";
        return Err(RobotError::InvalidArgument { quantity: "joint index", found: leader as f64, expected });
    };
    let mut limits = joint.limits;
    for follower in joints {
        let Some(mimic) = follower.mimic.filter(|mimic| mimic.leader == leader) else { continue };
        narrow(&mut limits, &mimic, &follower.limits).ok_or_else(|| RobotError::MimicLimitsEmpty {
            joint: joint.name.clone(),
            follower: follower.name.clone(),
            lower: follower.limits.lower.unwrap_or(f64::NEG_INFINITY),
            upper: follower.limits.upper.unwrap_or(f64::INFINITY),
        })?;
    }
    Ok(limits)
}

/// Narrows a leader's limits by those of one follower; `None` if nothing is left.
fn narrow(limits: &mut JointLimits, mimic: &Mimic, follower: &JointLimits) -> Option<()> {
    let Mimic { multiplier, offset, .. } = *mimic;
    if multiplier == 0.0 {
        return (follower.clamp(offset) == offset).then_some(());
    }
    // a sum with zero, so that no bound reads "-0"
    let bound = |limit: Option<f64>| limit.map(|limit| (limit - offset) / multiplier + 0.0);
    let (lower, upper) = match multiplier > 0.0 {
        true => (bound(follower.lower), bound(follower.upper)),
        false => (bound(follower.upper), bound(follower.lower)),
    };
    let speed = follower.velocity.map(|velocity| velocity / multiplier.abs());
    limits.lower = larger(limits.lower, lower);
    limits.upper = smaller(limits.upper, upper);
    limits.velocity = smaller(limits.velocity, speed);
    (limits.lower.unwrap_or(f64::NEG_INFINITY) <= limits.upper.unwrap_or(f64::INFINITY)).then_some(())
}

fn larger(first: Option<f64>, second: Option<f64>) -> Option<f64> {
    first.zip(second).map(|(first, second)| first.max(second)).or(first).or(second)
}

fn smaller(first: Option<f64>, second: Option<f64>) -> Option<f64> {
    first.zip(second).map(|(first, second)| first.min(second)).or(first).or(second)
}

/// Checks the limits of every leader; returns warnings for those that are narrowed.
pub(crate) fn check_limits(joints: &[Joint]) -> Result<Vec<Warning>, RobotError> {
    let mut leads = vec![false; joints.len()];
    for mimic in joints.iter().filter_map(|joint| joint.mimic) {
        leads[mimic.leader] = true;
    }
    let mut warnings = Vec::new();
    for (leader, joint) in joints.iter().enumerate().filter(|(leader, _)| leads[*leader]) {
        let limits = leader_limits(joints, leader)?;
        if (limits.lower, limits.upper) != (joint.limits.lower, joint.limits.upper) {
            let lower = limits.lower.unwrap_or(f64::NEG_INFINITY);
            let upper = limits.upper.unwrap_or(f64::INFINITY);
            warnings.push(Warning::LimitsNarrowed { joint: joint.name.clone(), lower, upper });
        }
    }
    Ok(warnings)
}
