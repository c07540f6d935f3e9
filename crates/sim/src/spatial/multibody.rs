//! One joint of an arm in the engine's terms: body, joint, coupling.

use rapier3d::prelude::*;
use robot::{Coupling, Joint};

use super::convert;

/// Which of the engine's six coordinates of a joint is the free one: a joint's axis is its x axis.
pub(super) fn coordinate(rotates: bool) -> usize {
    if rotates { 3 } else { 0 }
}

/// The engine's body for what a joint carries.
pub(super) fn link_body(joint: &Joint) -> RigidBodyBuilder {
    let body = &joint.body;
    let properties = MassProperties::with_inertia_matrix(
        convert::vector(&body.center_of_mass_m),
        body.mass_kg,
        convert::matrix(&body.inertia_kg_m2),
    );
    RigidBodyBuilder::dynamic().additional_mass_properties(properties).can_sleep(false)
}

/// The engine's joint: its x axis is the joint's axis; limits are firm stops.
pub(super) fn engine_joint(joint: &Joint) -> GenericJoint {
    let basis = Pose::from_rotation(GenericJoint::complete_ang_frame(convert::vector(&joint.axis)));
    let (locked, free) = if joint.kind.rotates() {
        (JointAxesMask::LOCKED_REVOLUTE_AXES, JointAxis::AngX)
    } else {
        (JointAxesMask::LOCKED_PRISMATIC_AXES, JointAxis::LinX)
    };
    let mut built = GenericJointBuilder::new(locked)
        .contacts_enabled(false)
        .local_frame1(convert::pose(&joint.parent_from_joint) * basis)
        .local_frame2(basis);
    if joint.limits.lower.is_some() || joint.limits.upper.is_some() {
        let range = [joint.limits.lower.unwrap_or(-Real::MAX), joint.limits.upper.unwrap_or(Real::MAX)];
        built = built.limits(free, range);
    }
    built.build()
}

/// The engine's constraint for a joint that mimics another; the base is its first link.
pub(super) fn engine_coupling(coupling: &Coupling, rotates: impl Fn(usize) -> bool) -> MultibodyDofCoupling {
    MultibodyDofCoupling {
        link1: coupling.leader + 1,
        dof1: 0,
        axis1: coordinate(rotates(coupling.leader)),
        link2: coupling.follower + 1,
        dof2: 0,
        axis2: coordinate(rotates(coupling.follower)),
        coeff: coupling.multiplier,
        offset: coupling.offset,
    }
}
