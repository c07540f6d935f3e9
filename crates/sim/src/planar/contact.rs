//! Contact forces as the engine found them.

use nalgebra::{Point2, Unit, Vector2};
use rapier2d::prelude::*;

use super::convert;

/// Something that can touch something else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Party {
    /// The tool in the hand.
    Tool,
    /// The object that is pushed.
    Object,
    /// The obstacle of this index in the scenario.
    Obstacle(usize),
}

/// One contact point with the mean force over the last time step.
#[derive(Clone, Copy, Debug)]
pub struct ContactForce {
    /// The two things that touch.
    pub parties: [Party; 2],
    /// Place of the contact, world frame, m.
    pub point_world: Point2<f64>,
    /// Direction from the first party to the second, world axes.
    pub normal_world: Unit<Vector2<f64>>,
    /// Force of the first party on the second, world axes, N.
    pub force_world_n: Vector2<f64>,
    /// Velocity of the second party against the first along the contact's tangent (normal turned left), m/s.
    pub slip_m_per_s: f64,
}

impl ContactForce {
    /// Whether `party` takes part.
    #[must_use]
    pub fn involves(&self, party: Party) -> bool {
        self.parties.contains(&party)
    }

    /// Whether an obstacle takes part.
    #[must_use]
    pub fn involves_obstacle(&self) -> bool {
        self.parties.iter().any(|party| matches!(party, Party::Obstacle(_)))
    }

    /// Force on `receiver` if the contact is between it and `giver`, world axes, N.
    #[must_use]
    pub fn force_on_n(&self, receiver: Party, giver: Party) -> Option<Vector2<f64>> {
        match self.parties {
            [first, second] if first == giver && second == receiver => Some(self.force_world_n),
            [first, second] if first == receiver && second == giver => Some(-self.force_world_n),
            _ => None,
        }
    }
}

/// Collects the contacts of the last step that carried a force, in a fixed order of collider pairs.
pub(crate) fn read_contacts(
    physics: &PhysicsWorld,
    parties: &[(ColliderHandle, Party)],
    contacts: &mut Vec<ContactForce>,
) {
    contacts.clear();
    for (index, &(first, first_party)) in parties.iter().enumerate() {
        for &(second, second_party) in parties.iter().skip(index + 1) {
            if first_party == second_party {
                continue;
            }
            let Some(pair) = physics.contact_pair(first, second) else { continue };
            // the engine may hold the pair the other way round
            let pair_parties =
                if pair.collider1 == first { [first_party, second_party] } else { [second_party, first_party] };
            read_pair(physics, pair, pair_parties, contacts);
        }
    }
}

fn read_pair(physics: &PhysicsWorld, pair: &ContactPair, parties: [Party; 2], contacts: &mut Vec<ContactForce>) {
    let (Some(collider1), Some(collider2)) =
        (physics.colliders.get(pair.collider1), physics.colliders.get(pair.collider2))
    else {
        return;
    };
    let body = |collider: &Collider| collider.parent().and_then(|handle| physics.bodies.get(handle));
    let inverse_dt = 1.0 / physics.integration_parameters.dt;
    for manifold in pair.solver_manifolds() {
        let normal = manifold.data.normal;
        let tangent = Vector::new(-normal.y, normal.x);
        for point in &manifold.points {
            if point.data.impulse <= 0.0 || contacts.len() == contacts.capacity() {
                continue;
            }
            let place = collider1.position() * point.local_p1;
            let velocity =
                |collider: &Collider| body(collider).map_or(Vector::ZERO, |body| body.velocity_at_point(place));
            let force = (normal * point.data.impulse + tangent * point.data.tangent_impulse[0]) * inverse_dt;
            contacts.push(ContactForce {
                parties,
                point_world: convert::to_point(place),
                normal_world: Unit::new_unchecked(convert::to_vector(normal)),
                force_world_n: convert::to_vector(force),
                slip_m_per_s: (velocity(collider2) - velocity(collider1)).dot(tangent),
            });
        }
    }
}
