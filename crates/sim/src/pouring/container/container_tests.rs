//! Tests of containers: volumes, frames, closed meshes, walls without gaps, refusals.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use rapier3d::math::{Pose, Vector};

use super::*;

const FILES: [&str; 6] = [
    include_str!("../../../../../assets/containers/source_cup.toml"),
    include_str!("../../../../../assets/containers/beaker_spout.toml"),
    include_str!("../../../../../assets/containers/jug.toml"),
    include_str!("../../../../../assets/containers/wide_bowl.toml"),
    include_str!("../../../../../assets/containers/wide_cup.toml"),
    include_str!("../../../../../assets/containers/tall_bottle.toml"),
];

fn file(index: usize) -> ContainerFile {
    toml::from_str(FILES[index]).expect("a valid file")
}

fn shipped() -> Vec<Container> {
    (0..FILES.len()).map(|index| Container::new(&file(index)).expect("a valid container")).collect()
}

/// Rounding of sums of a few products.
const ROUNDING: f64 = 1e-12;

#[test]
fn the_capacity_is_the_volume_up_to_the_rim() {
    let cup = Container::new(&file(0)).expect("valid");
    assert!((cup.capacity_m3 - PI * 0.035 * 0.035 * 0.09).abs() < ROUNDING);
    let bowl = Container::new(&file(3)).expect("valid");
    let frustum = PI * 0.06 / 3.0 * (0.045_f64.powi(2) + 0.045 * 0.065 + 0.065_f64.powi(2));
    assert!((bowl.capacity_m3 - frustum).abs() < ROUNDING);
    assert!((bowl.volume_to_m3(1.0) - frustum).abs() < ROUNDING);
}

#[test]
fn rim_and_lip_are_where_the_file_puts_them() {
    let cup = Container::new(&file(0)).expect("valid");
    assert_eq!(cup.rim.center_in_container, Point3::new(0.0, 0.0, 0.093));
    assert_eq!(cup.lip.point_in_container, Point3::new(0.035, 0.0, 0.093));
    let jug = Container::new(&file(2)).expect("valid");
    let lip = jug.lip.point_in_container;
    // 30 mm out of the wall's sides, which lie 0.16 % inside the circle; 24 mm below the rim and 8 mm up
    assert!((lip.x - 0.070).abs() < 1e-4 && (lip.z - (0.103 - 0.024 + 0.008)).abs() < ROUNDING, "{lip}");
    assert!((jug.lip.width_m - 0.020).abs() < ROUNDING);
}

#[test]
fn the_area_of_the_hole_is_that_of_the_circle() {
    for facets in [24, 32, 64] {
        let apothem = revolved::apothem_ratio(facets);
        let area = facets as f64 * apothem * apothem * (PI / facets as f64).tan();
        assert!((area - PI).abs() < ROUNDING, "{area} with {facets} sides");
    }
}

/// From a point on the axis, every ray to the side or downward ends in the wall: nothing is left open but the mouth.
#[test]
fn rays_from_inside_meet_the_wall_within_its_circle() {
    for container in shipped() {
        let shape = container.shape().build();
        for height in [0.2, 0.5, 0.8, 0.97] {
            let top = container.spout.as_ref().map_or(container.meridian.top_m(), spout::Trough::bottom_m);
            let from = Vector::new(0.0, 0.0, container.floor_m + height * (top - container.floor_m));
            for i in 0..720 {
                let (sin, cos) = (TAU * f64::from(i) / 720.0).sin_cos();
                for down in [0.0, -0.5, -2.0] {
                    let ray = rapier3d::parry::query::Ray::new(from, Vector::new(cos, sin, down).normalize());
                    let hit = rapier3d::parry::query::RayCast::cast_local_ray(shape.shape(), &ray, 1.0, false);
                    let at = hit.map(|length| ray.point_at(length)).expect("a wall in every direction");
                    let here = Point3::new(at.x, at.y, at.z - 1e-9);
                    // the polygon's corners lie 0.3 % outside the circle: the wall begins no farther out than that
                    let outside = here.x.hypot(here.y) > 1.005 * widest(&container);
                    assert!(!outside, "{}: open at {here}", container.name);
                }
            }
        }
    }
}

fn widest(container: &Container) -> f64 {
    container.meridian.parts().map(|((_, r0), (_, r1))| r0.max(r1)).fold(0.0, f64::max)
}

/// A grain's center that keeps its radius from the wall is in no piece: nothing sticks out into the hollow.
#[test]
fn no_piece_reaches_into_the_hollow() {
    for container in shipped() {
        let shape = container.shape().build();
        let (floor, top) = (container.floor_m, container.meridian.top_m());
        for i in 0..=40 {
            let z = floor + 1e-4 + (top - floor - 2e-4) * f64::from(i) / 40.0;
            for j in 0..96 {
                let (sin, cos) = (TAU * f64::from(j) / 96.0).sin_cos();
                // 0.995: the sides of the polygon lie up to 0.2 % inside the circle
                let radius = (0..1000).map(|k| 0.1 * f64::from(k) / 1000.0);
                let inside = |r: &f64| container.meridian.contains(&Point3::new(r / 0.995, 0.0, z));
                let r = radius.take_while(inside).last().unwrap_or(0.0);
                let point = Vector::new(r * cos, r * sin, z);
                assert!(!shape.shape().contains_local_point(point), "{}: a wall at {point}", container.name);
            }
        }
    }
}

#[test]
fn what_is_drawn_is_closed_and_turned_outward() {
    for container in shipped() {
        let mesh = container.mesh();
        let mut edges = BTreeMap::new();
        let mut volume = 0.0;
        for [a, b, c] in &mesh.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*from, *to)).or_insert(0) += 1;
            }
            let [a, b, c] = [a, b, c].map(|i| mesh.points[*i as usize].coords);
            volume += a.dot(&b.cross(&c)) / 6.0;
        }
        // every edge is passed once in each direction
        assert!(edges.iter().all(|((a, b), count)| *count == 1 && edges.get(&(*b, *a)) == Some(&1)));
        // pieces overlap at their edges, so together they hold more than the union
        let pieces = container.shape().density(1.0).build().mass_properties().mass();
        assert!(volume > 0.97 * pieces && volume < 1.001 * pieces, "{}: {volume} of {pieces}", container.name);
    }
}

#[test]
fn the_mass_is_the_stated_one_and_the_center_lies_on_the_axis() {
    let cup = Container::new(&file(0)).expect("valid");
    let properties = cup.mass_properties();
    assert!((properties.mass_kg - 0.08).abs() < ROUNDING);
    let center = properties.center_m;
    assert!(center.x.hypot(center.y) < 1e-9 && center.z > 0.02 && center.z < 0.06, "{center}");
    // a thin tube of that mass has m R² about its axis; floor and corners change that by less than a fifth
    let about_axis = properties.inertia_kg_m2[(2, 2)];
    assert!(about_axis > 0.8 * 0.08 * 0.0365_f64.powi(2), "{about_axis}");
}

#[test]
fn the_spout_holds_what_lies_in_its_channel_only() {
    let jug = Container::new(&file(2)).expect("valid");
    assert!(jug.holds(&Point3::new(0.055, 0.0, 0.095)));
    assert!(!jug.holds(&Point3::new(0.055, 0.0, 0.110)), "above the rim");
    assert!(!jug.holds(&Point3::new(0.055, 0.015, 0.095)), "beside the channel");
    assert!(!jug.holds(&Point3::new(-0.055, 0.0, 0.095)), "on the other side");
}

#[test]
fn an_attached_container_follows_its_body() {
    let cup = Container::new(&file(0)).expect("valid");
    let mut physics = rapier3d::prelude::PhysicsWorld::new();
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.5);
    let pose = Isometry3::from_parts(nalgebra::Translation3::new(0.1, 0.2, 0.3), turn);
    let body = rapier3d::prelude::RigidBodyBuilder::kinematic_position_based().pose(Pose::from(pose));
    let body = physics.insert_body(body);
    let grip = Isometry3::translation(0.0, 0.0, -0.04);
    let all = rapier3d::prelude::InteractionGroups::all();
    let held = cup.attach(&mut physics, body, &grip, all, &crate::pouring::GrainConfig::default());
    assert!((held.tilt_rad(&physics) - 0.5).abs() < 1e-9);
    let (lip, _) = held.lip_in_world(&physics);
    assert!((lip - pose * grip * Point3::new(0.035, 0.0, 0.093)).norm() < ROUNDING);
}

#[test]
fn a_bad_value_is_refused_by_the_name_of_its_key() {
    let refusal = |change: &dyn Fn(&mut ContainerFile)| {
        let mut file = file(5);
        change(&mut file);
        Container::new(&file).expect_err("a bad value").field
    };
    assert_eq!(refusal(&|file| file.wall_m = 0.0), "wall_m");
    assert_eq!(refusal(&|file| file.facets = 12), "facets");
    assert_eq!(refusal(&|file| file.mass_kg = f64::NAN), "mass_kg");
    let neck = |file: &mut ContainerFile| {
        if let Profile::Bottle(bottle) = &mut file.profile {
            bottle.neck_radius_m = 0.04;
        }
    };
    assert_eq!(refusal(&neck), "profile.bottle.neck_radius_m");
    let spout = Spout { width_m: 0.02, lip_width_m: 0.02, length_m: 0.02, depth_m: 0.02, rise_m: 0.0 };
    assert_eq!(refusal(&|file| file.spout = Some(spout.clone())), "spout");
}
