//! How far the arm's links keep above the table: the arm has no colliders of its own, so that it would pass through.

use nalgebra::{Isometry3, Point3, Vector3};
use robot::Geometry;

use crate::spatial::{SpatialArm, SpatialWorld};

/// Time between two looks, s: at a tenth of a meter per second, 2 mm.
const LOOK_S: f64 = 0.02;
/// Links from here on are looked at: the base, and what turns about the vertical on it, stand on the table.
const FIRST_LINK: usize = 2;

/// Watches the lowest point of the arm.
#[derive(Clone, Debug)]
pub(super) struct ArmHeight {
    /// Link of the arm (0: its base), point of it, and radius about that point, m.
    balls: Vec<(usize, Point3<f64>, f64)>,
    poses: Vec<Isometry3<f64>>,
    next_s: f64,
    least_m: f64,
}

impl ArmHeight {
    /// Watches the shapes that the arm's model states to collide; a cylinder counts with half balls on its ends.
    pub(super) fn new(arm: &SpatialArm) -> Self {
        let joints = arm.model().joints();
        let shapes = joints.iter().enumerate().skip(FIRST_LINK - 1).flat_map(|(joint, of)| {
            of.body.collisions.iter().flat_map(move |shape| {
                let placed = move |(point, radius_m)| (joint + 1, shape.body_from_shape * point, radius_m);
                balls(&shape.geometry).into_iter().map(placed)
            })
        });
        let balls = shapes.collect();
        Self { balls, poses: Vec::with_capacity(joints.len() + 1), next_s: 0.0, least_m: f64::INFINITY }
    }

    /// Looks after a step that ends at `time_s`.
    pub(super) fn look(&mut self, arm: &SpatialArm, world: &SpatialWorld, time_s: f64) {
        if time_s < self.next_s {
            return;
        }
        self.next_s = time_s + LOOK_S;
        arm.link_poses(world, &mut self.poses);
        for (link, point, radius_m) in &self.balls {
            if let Some(pose) = self.poses.get(*link) {
                self.least_m = self.least_m.min((pose * point).z - radius_m);
            }
        }
    }

    /// Height of the lowest point above the table so far, m; infinite if the model states no shapes.
    pub(super) fn least_m(&self) -> f64 {
        self.least_m
    }
}

/// Balls whose hull holds a shape, in its frame; none for a mesh that was not read.
fn balls(geometry: &Geometry) -> Vec<(Point3<f64>, f64)> {
    match geometry {
        Geometry::Box { size_m } => {
            let half = |index: usize, k: usize| if index >> k & 1 == 0 { -0.5 } else { 0.5 };
            let corner = |index: usize| Vector3::from_fn(|k, _| half(index, k) * size_m[k]);
            (0..8).map(|index| (Point3::from(corner(index)), 0.0)).collect()
        }
        Geometry::Cylinder { radius_m, length_m } | Geometry::Capsule { radius_m, length_m } => {
            [-0.5, 0.5].map(|end| (Point3::new(0.0, 0.0, end * length_m), *radius_m)).to_vec()
        }
        Geometry::Sphere { radius_m } => vec![(Point3::origin(), *radius_m)],
        Geometry::Mesh { triangles, .. } => {
            let points = triangles.iter().flat_map(|mesh| &mesh.vertices_m);
            points.map(|point| (*point, 0.0)).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DVector, Vector3};
    use robot::Manipulator;

    use super::*;
    use crate::spatial::{ArmConfig, EngineConfig, HeldTool, arm_with_tool, standard_gravity};

    /// Height of the lowest point of a Panda whose base stands `base_m` above the table, stretched out or bent down.
    fn least_m(base_m: f64, q: &[f64; 7]) -> f64 {
        let arm = Manipulator::from_urdf_str(include_str!("../../../../../assets/robots/panda.urdf")).unwrap();
        let (tool, base, gravity) = (HeldTool::none(), Isometry3::translation(0.0, 0.0, base_m), standard_gravity());
        let model = arm_with_tool(&arm, "panda_hand_tcp", &tool, &base, &gravity, &[]).unwrap();
        let mut world = SpatialWorld::new(&EngineConfig::default(), &gravity).unwrap();
        let q = DVector::from_column_slice(q);
        let arm = SpatialArm::insert(&mut world, &model, &tool, &ArmConfig::default(), &q).unwrap();
        let mut height = ArmHeight::new(&arm);
        height.look(&arm, &world, 0.0);
        height.least_m()
    }

    #[test]
    fn an_arm_upright_keeps_above_the_table_and_one_bent_down_goes_through_it() {
        let upright = [0.0, 0.0, 0.0, -0.1, 0.0, 1.6, 0.8];
        // its second link lies level in the shoulder, 333 mm high, 60 mm thick about its axis
        assert!((least_m(0.0, &upright) - (0.333 - 0.06)).abs() < 0.001, "{}", least_m(0.0, &upright));
        assert!((least_m(0.2, &upright) - least_m(0.0, &upright) - 0.2).abs() < 1e-9);
        let bent = [0.0, 1.7, 0.0, -0.3, 0.0, 1.6, 0.8];
        assert!(least_m(0.0, &bent) < 0.0, "{}", least_m(0.0, &bent));
    }

    #[test]
    fn a_shape_lies_within_its_balls() {
        let lowest = |geometry: &Geometry| {
            balls(geometry).iter().map(|(point, radius_m)| point.z - radius_m).fold(f64::INFINITY, f64::min)
        };
        assert_eq!(lowest(&Geometry::Box { size_m: Vector3::new(1.0, 2.0, 3.0) }), -1.5);
        assert_eq!(balls(&Geometry::Box { size_m: Vector3::new(1.0, 2.0, 3.0) }).len(), 8);
        assert_eq!(lowest(&Geometry::Capsule { radius_m: 0.5, length_m: 2.0 }), -1.5);
        assert_eq!(lowest(&Geometry::Sphere { radius_m: 0.5 }), -0.5);
    }
}
