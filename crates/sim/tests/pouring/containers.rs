//! Every shipped container keeps what is in it.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rapier3d::math::Pose;
use sim::pouring::*;

use super::scene::{Scene, container, filling, pose_with_lip};

pub const SHIPPED: [&str; 6] = ["source_cup", "beaker_spout", "jug", "wide_bowl", "wide_cup", "tall_bottle"];

/// Grains sink into a wall by the contacts' compliance; more than this share of a diameter would lead to leaks.
const DEEPEST: f64 = 0.1;

/// How far the center of a grain lies outside the hollow's inner floor or wall plus the grain's radius, m.
fn depth_in_wall(container: &Container, at: &Point3<f64>, radius_m: f64) -> f64 {
    container.floor_m + radius_m - at.z
}

fn shake(name: &str, grain: &GrainConfig) {
    let source = container(name);
    let engine = GrainEngineConfig::default();
    let filling = filling(&source, grain, &engine, 300, 5);
    let lip = Point3::new(0.0, 0.0, 0.4);
    let mut scene = Scene::new(&source, &filling, None, &engine, lip);
    let rest = pose_with_lip(&source, lip, 0.0);
    let mut deepest = 0.0_f64;
    // 8 mm sideways at 2.5 Hz is 0.2 g, with 10 degrees of rocking
    for step in 0..350 {
        let (t, tau) = (f64::from(step) * 0.002, std::f64::consts::TAU);
        let swing = (t / 0.2).min(1.0);
        let rock = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), swing * 0.17 * (tau * 1.7 * t).sin());
        let moved =
            Translation3::new(0.008 * swing * (tau * 2.5 * t).sin(), 0.005 * swing * (tau * 3.1 * t).sin(), 0.0);
        let pose: Isometry3<f64> = moved * rest * rock;
        let cup = scene.cup;
        scene.physics.bodies[cup].set_next_kinematic_position(Pose::from(pose));
        scene.advance();
        let world_from_cup = scene.monitor.source().world_from_container(&scene.physics);
        for (body, radius) in scene.grains.bodies(&scene.physics).zip(scene.grains.batch().radii_m()) {
            let at = body.translation();
            let inside = world_from_cup.inverse() * Point3::new(at.x, at.y, at.z);
            deepest = deepest.max(depth_in_wall(&source, &inside, radius));
        }
    }
    let held = scene.monitor.counts().source;
    println!("{name}: {held} of 300 held, floor penetration at most {:.3} mm", 1e3 * deepest);
    assert_eq!(held, 300, "{name} leaked: {:?}", scene.monitor.counts());
    assert!(deepest < DEEPEST * grain.diameter_m, "{name}: a grain is {deepest} m inside the floor");
}

#[test]
fn no_shipped_container_leaks_when_300_balls_are_shaken_in_it() {
    SHIPPED.iter().for_each(|name| shake(name, &GrainConfig::default()));
}

#[test]
fn the_cup_does_not_leak_when_300_elongated_grains_are_shaken_in_it() {
    let shape = GrainShape::Capsule { aspect: 1.25 };
    shake("source_cup", &GrainConfig { shape, rolling_friction: 0.0, ..GrainConfig::default() });
}
