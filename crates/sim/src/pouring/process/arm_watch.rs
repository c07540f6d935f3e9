//! How far the arm's links keep from the table and from the target: the arm has no colliders of its own, so that it would
//! pass through both.

use nalgebra::{Isometry3, Vector3};
use rapier3d::math::Pose;
use rapier3d::parry::query;
use rapier3d::prelude::SharedShape;
use robot::Geometry;

use crate::pouring::container::Container;
use crate::spatial::{SpatialArm, SpatialWorld};

/// Time between two looks, s: at a tenth of a meter per second, 2 mm.
const LOOK_S: f64 = 0.02;
/// Links from here on are looked at: the base, and what turns about the vertical on it, stand on the table.
const FIRST_LINK: usize = 2;

/// The least distances of the arm's links, m; infinite if the arm's model states no shapes that collide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmClearance {
    /// Of their lowest point above the table; below 0 under it.
    pub table_m: f64,
    /// From the container that is poured into; 0 if one touches it or is in it.
    pub target_m: f64,
}

/// Watches the shapes that the arm's model states to collide.
#[derive(Clone)]
pub(super) struct ArmWatch {
    links: Vec<LinkShape>,
    target: SharedShape,
    world_from_target: Pose,
    poses: Vec<Isometry3<f64>>,
    next_s: f64,
    least: ArmClearance,
}

/// A shape on a link of the arm (0: its base).
#[derive(Clone)]
struct LinkShape {
    link: usize,
    link_from_shape: Isometry3<f64>,
    shape: SharedShape,
}

impl ArmWatch {
    /// Watches an arm near `target`, which stands at `world_from_target`.
    pub(super) fn new(arm: &SpatialArm, target: &Container, world_from_target: &Isometry3<f64>) -> Self {
        let joints = arm.model().joints();
        let links = joints.iter().enumerate().skip(FIRST_LINK - 1).flat_map(|(joint, of)| {
            of.body.collisions.iter().filter_map(move |placed| {
                let link_from_shape = placed.body_from_shape;
                solid(&placed.geometry).map(|shape| LinkShape { link: joint + 1, link_from_shape, shape })
            })
        });
        Self {
            links: links.collect(),
            target: target.solid(),
            world_from_target: Pose::from(*world_from_target),
            poses: Vec::with_capacity(joints.len() + 1),
            next_s: 0.0,
            least: ArmClearance { table_m: f64::INFINITY, target_m: f64::INFINITY },
        }
    }

    /// Looks after a step that ends at `time_s`.
    pub(super) fn look(&mut self, arm: &SpatialArm, world: &SpatialWorld, time_s: f64) {
        if time_s < self.next_s {
            return;
        }
        self.next_s = time_s + LOOK_S;
        arm.link_poses(world, &mut self.poses);
        for of in &self.links {
            let Some(world_from_link) = self.poses.get(of.link) else { continue };
            let pose = Pose::from(world_from_link * of.link_from_shape);
            self.least.table_m = self.least.table_m.min(of.shape.compute_aabb(&pose).mins.z);
            let distance = query::distance(&pose, of.shape.as_ref(), &self.world_from_target, self.target.as_ref())
                .map_or(0.0, |found| found.distance);
            self.least.target_m = self.least.target_m.min(distance);
        }
    }

    /// The least distances so far.
    pub(super) fn least(&self) -> ArmClearance {
        self.least
    }
}

/// A shape as the engine knows it: a mesh by its convex hull; none for a mesh that was not read or is flat.
fn solid(geometry: &Geometry) -> Option<SharedShape> {
    match geometry {
        Geometry::Box { size_m } => Some(SharedShape::cuboid(0.5 * size_m.x, 0.5 * size_m.y, 0.5 * size_m.z)),
        // the engine's stand along y
        Geometry::Cylinder { radius_m, length_m } => {
            let upright = Pose::from(Isometry3::rotation(Vector3::x() * std::f64::consts::FRAC_PI_2));
            let cylinder = SharedShape::cylinder(0.5 * length_m, *radius_m);
            Some(SharedShape::compound(vec![(upright, cylinder)]))
        }
        Geometry::Capsule { radius_m, length_m } => Some(SharedShape::capsule_z(0.5 * length_m, *radius_m)),
        Geometry::Sphere { radius_m } => Some(SharedShape::ball(*radius_m)),
        Geometry::Mesh { triangles, .. } => {
            let points: Vec<_> = triangles.as_ref()?.vertices_m.iter().map(|p| p.coords.into()).collect();
            SharedShape::convex_hull(&points)
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;
    use robot::Manipulator;

    use super::*;
    use crate::pouring::{ContainerFile, Profile, Straight};
    use crate::spatial::{ArmConfig, EngineConfig, HeldTool, arm_with_tool, standard_gravity};

    /// Its walls lie 63 mm from its axis.
    fn bowl() -> Container {
        let file = ContainerFile {
            name: "bowl".into(),
            description: String::new(),
            mass_kg: 0.1,
            friction: 0.3,
            restitution: 0.5,
            wall_m: 0.003,
            facets: 32,
            profile: Profile::Straight(Straight { radius_m: 0.06, height_m: 0.06 }),
            spout: None,
        };
        Container::new(&file).unwrap()
    }

    /// Distances of a Panda whose base stands `base_m` above the table, with a bowl at a place.
    fn least(base_m: f64, q: &[f64; 7], bowl_at_m: [f64; 3]) -> ArmClearance {
        let arm = Manipulator::from_urdf_str(include_str!("../../../../../assets/robots/panda.urdf")).unwrap();
        let (tool, base, gravity) = (HeldTool::none(), Isometry3::translation(0.0, 0.0, base_m), standard_gravity());
        let model = arm_with_tool(&arm, "panda_hand_tcp", &tool, &base, &gravity, &[]).unwrap();
        let mut world = SpatialWorld::new(&EngineConfig::default(), &gravity).unwrap();
        let q = DVector::from_column_slice(q);
        let arm = SpatialArm::insert(&mut world, &model, &tool, &ArmConfig::default(), &q).unwrap();
        let [x, y, z] = bowl_at_m;
        let mut watch = ArmWatch::new(&arm, &bowl(), &Isometry3::translation(x, y, z));
        watch.look(&arm, &world, 0.0);
        watch.least()
    }

    const UPRIGHT: [f64; 7] = [0.0, 0.0, 0.0, -0.1, 0.0, 1.6, 0.8];
    const FAR: [f64; 3] = [2.0, 0.0, 0.0];

    #[test]
    fn an_arm_upright_keeps_above_the_table_and_one_bent_down_goes_through_it() {
        // its second link lies level in the shoulder, 333 mm high, 60 mm thick about its axis
        let upright_m = least(0.0, &UPRIGHT, FAR).table_m;
        assert!((upright_m - (0.333 - 0.06)).abs() < 0.001, "{upright_m}");
        assert!((least(0.2, &UPRIGHT, FAR).table_m - upright_m - 0.2).abs() < 1e-9);
        let bent = [0.0, 1.7, 0.0, -0.3, 0.0, 1.6, 0.8];
        assert!(least(0.0, &bent, FAR).table_m < 0.0);
    }

    #[test]
    fn a_bowl_beside_the_shoulder_is_as_far_as_its_wall_and_one_around_it_is_touched() {
        // the axis of the second link is along y in the shoulder: a capsule 120 mm long, with half balls of 60 mm; the bowl is
        // beyond its end, at its height
        let beside = least(0.0, &UPRIGHT, [0.0, 0.06 + 0.06 + 0.063 + 0.05, 0.333 - 0.03]).target_m;
        // a wall of 32 flat sides differs from the circle by half a percent of its radius
        assert!((beside - 0.05).abs() < 5e-4, "{beside}");
        assert_eq!(least(0.0, &UPRIGHT, [0.0, 0.1, 0.3]).target_m, 0.0);
    }

    #[test]
    fn shapes_are_as_large_as_they_are_stated() {
        let lowest = |geometry: &Geometry| solid(geometry).unwrap().compute_aabb(&Pose::IDENTITY).mins.z;
        assert_eq!(lowest(&Geometry::Box { size_m: Vector3::new(1.0, 2.0, 3.0) }), -1.5);
        assert_eq!(lowest(&Geometry::Capsule { radius_m: 0.5, length_m: 2.0 }), -1.5);
        assert_eq!(lowest(&Geometry::Sphere { radius_m: 0.5 }), -0.5);
        assert!((lowest(&Geometry::Cylinder { radius_m: 0.5, length_m: 2.0 }) + 1.0).abs() < 1e-12);
        let unread = Geometry::Mesh { uri: "a.stl".into(), scale: Vector3::repeat(1.0), triangles: None };
        assert!(solid(&unread).is_none());
    }
}
