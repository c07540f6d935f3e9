//! Chains of mimic joints, resolved to the joint that follows nobody.

use std::collections::HashMap;

use urdf_rs::Robot;

use crate::error::RobotError;
use crate::joint::Joint;
use crate::mimic::Mimic;

/// Sets the mimics of the movable joints; names are checked before.
pub(crate) fn resolve(robot: &Robot, joints: &mut [Joint]) -> Result<(), RobotError> {
    let places: HashMap<&str, usize> = joints.iter().map(|joint| joint.name.as_str()).zip(0..).collect();
    let mut written: Vec<Option<Mimic>> = vec![None; joints.len()];
    for joint in &robot.joints {
        let (Some(&follower), Some(mimic)) = (places.get(joint.name.as_str()), &joint.mimic) else { continue };
        written[follower] = places.get(mimic.joint.as_str()).map(|&leader| Mimic {
            leader,
            multiplier: mimic.multiplier.unwrap_or(1.0),
            offset: mimic.offset.unwrap_or(0.0),
        });
    }
    for (follower, joint) in joints.iter_mut().enumerate() {
        joint.mimic = follow(follower, &written).map_err(|flaw| match flaw {
            Flaw::Cycle => RobotError::MimicCycle { joint: joint.name.clone() },
            Flaw::NotFinite => RobotError::NonFinite { element: format!("joint `{}`", joint.name), quantity: "mimic" },
        })?;
    }
    Ok(())
}

enum Flaw {
    Cycle,
    NotFinite,
}

/// Goes from leader to leader: q = m₁ (m₂ q₂ + o₂) + o₁ = (m₁ m₂) q₂ + (m₁ o₂ + o₁).
fn follow(follower: usize, written: &[Option<Mimic>]) -> Result<Option<Mimic>, Flaw> {
    let Some(mut mimic) = written[follower] else { return Ok(None) };
    let mut steps = 0;
    while let Some(next) = written[mimic.leader] {
        steps += 1;
        if steps > written.len() {
            return Err(Flaw::Cycle);
        }
        mimic = Mimic {
            leader: next.leader,
            multiplier: mimic.multiplier * next.multiplier,
            offset: mimic.multiplier * next.offset + mimic.offset,
        };
    }
    let finite = mimic.multiplier.is_finite() && mimic.offset.is_finite();
    if finite { Ok(Some(mimic)) } else { Err(Flaw::NotFinite) }
}
