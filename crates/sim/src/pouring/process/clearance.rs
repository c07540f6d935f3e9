//! Distance between two vessels as they collide, for plans that must not touch.

use nalgebra::Isometry3;
use rapier3d::math::Pose;
use rapier3d::parry::query;
use rapier3d::prelude::SharedShape;

use crate::pouring::container::Container;

/// The shapes of a cup and of what it is poured into, as the engine sees them.
#[derive(Clone)]
pub struct VesselClearance {
    source: SharedShape,
    target: SharedShape,
    world_from_target: Isometry3<f64>,
    reach_m: f64,
}

impl VesselClearance {
    /// Compares `source` with `target`, which stands at `world_from_target`.
    #[must_use]
    pub fn new(source: &Container, target: &Container, world_from_target: &Isometry3<f64>) -> Self {
        let reach_m = source.mesh().points.iter().map(|point| point.coords.norm()).fold(0.0, f64::max);
        Self { source: source.solid(), target: target.solid(), world_from_target: *world_from_target, reach_m }
    }

    /// Greatest distance of a point of the source from its origin, m.
    #[must_use]
    pub fn reach_m(&self) -> f64 {
        self.reach_m
    }

    /// Distance between the two with the source at `world_from_source`, m; 0 if they touch or overlap, or if a coordinate
    /// is not finite.
    #[must_use]
    pub fn distance_m(&self, world_from_source: &Isometry3<f64>) -> f64 {
        let (source, target) = (Pose::from(*world_from_source), Pose::from(self.world_from_target));
        query::distance(&source, self.source.as_ref(), &target, self.target.as_ref())
            .map_or(0.0, |found| found.distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pouring::{ContainerFile, Profile, Straight};

    /// A wall of 32 flat sides differs from the circle by half a percent of its radius.
    const FLATNESS_M: f64 = 3e-4;

    fn straight(radius_m: f64, height_m: f64) -> Container {
        let file = ContainerFile {
            name: "cup".into(),
            description: String::new(),
            mass_kg: 0.1,
            friction: 0.3,
            restitution: 0.5,
            wall_m: 0.003,
            facets: 32,
            profile: Profile::Straight(Straight { radius_m, height_m }),
            spout: None,
        };
        Container::new(&file).unwrap()
    }

    #[test]
    fn vessels_beside_and_above_each_other_are_as_far_apart_as_their_walls() {
        let (cup, bowl) = (straight(0.035, 0.09), straight(0.06, 0.06));
        let pair = VesselClearance::new(&cup, &bowl, &Isometry3::translation(0.5, 0.0, 0.0));
        // axes 120 mm apart, less outer radii of 38 and 63 mm
        let beside = pair.distance_m(&Isometry3::translation(0.38, 0.0, 0.0));
        assert!((beside - 0.019).abs() < FLATNESS_M, "{beside}");
        // the floor 20 mm above the rim at 63 mm, over the wall
        let above = pair.distance_m(&Isometry3::translation(0.46, 0.0, 0.083));
        assert!((above - 0.020).abs() < 1e-9, "{above}");
    }

    #[test]
    fn a_cup_inside_a_larger_one_is_clear_and_one_through_its_wall_is_not() {
        let (cup, bowl) = (straight(0.02, 0.05), straight(0.06, 0.06));
        let pair = VesselClearance::new(&cup, &bowl, &Isometry3::identity());
        // 60 less 23 mm to the side, 7 mm above the floor
        let inside = pair.distance_m(&Isometry3::translation(0.0, 0.0, 0.010));
        assert!((inside - 0.007).abs() < 1e-9, "{inside}");
        assert_eq!(pair.distance_m(&Isometry3::translation(0.04, 0.0, 0.010)), 0.0);
        assert!(pair.reach_m() > 0.057 && pair.reach_m() < 0.059);
    }
}
