//! What must hold exactly: conservation, bounds, equal bits on repetition, no allocation.

use nalgebra::Point3;
use sim::pouring::*;

use super::scene::{GRAVITY, Scene, container, filling};

const COUNT: usize = 120;

fn scene() -> Scene {
    let engine = GrainEngineConfig::default();
    let source = container("source_cup");
    let filling = filling(&source, &GrainConfig::default(), &engine, COUNT, 9);
    Scene::new(&source, &filling, Some(&container("tall_bottle")), &engine, LIP)
}

const LIP: Point3<f64> = Point3::new(-0.03, 0.0, 0.26);

/// A hasty pour that spills: 120 degrees in 1.2 s.
fn tilt_rad(time_s: f64) -> f64 {
    (100.0 * time_s).min(120.0).to_radians()
}

#[test]
fn every_grain_is_somewhere_at_every_step_and_none_is_too_fast() {
    let mut scene = scene();
    let limit = (2.0 * GRAVITY * 0.40_f64).sqrt() + 0.5;
    let grams = |scene: &Scene| -> f64 {
        [Place::Source, Place::Target, Place::Flying, Place::Spilt].iter().map(|p| scene.monitor.mass_kg(*p)).sum()
    };
    let total: f64 = scene.grains.batch().masses_kg().sum();
    let mut deepest = 0.0_f64;
    while scene.time_s() < 2.5 {
        let tilt = tilt_rad(scene.time_s());
        scene.step(LIP, tilt);
        assert_eq!(scene.monitor.counts().total(), COUNT);
        assert!((grams(&scene) - total).abs() < 1e-12);
        scene.grains.check_speed(&scene.physics, scene.time_s(), limit).expect("no grain is thrown");
        for (body, diameter) in scene.grains.bodies(&scene.physics).zip(scene.grains.batch().diameters_m()) {
            let depth = 0.5 * diameter - body.translation().z;
            deepest = deepest.max(depth / diameter);
        }
    }
    let counts = scene.monitor.counts();
    println!("hasty pour: {counts:?}, {deepest:.3} diameters into the table at most");
    assert!(deepest < 0.1, "a grain is {deepest} diameters inside the table: a leak in the making");
    assert!(counts.target > 0 && counts.spilt > 0 && counts.source < COUNT / 4, "{counts:?}");
}

fn digest() -> String {
    let (mut scene, mut digest) = (scene(), blake3::Hasher::new());
    while scene.time_s() < 1.0 {
        let tilt = tilt_rad(scene.time_s());
        scene.step(LIP, tilt);
        scene.grains.digest(&scene.physics, &mut digest);
    }
    digest.finalize().to_hex().to_string()
}

#[test]
fn the_same_pour_has_the_same_bits() {
    assert_eq!(digest(), digest());
}

#[test]
fn counting_and_reading_poses_allocate_nothing_and_rolling_resistance_only_within_the_engine() {
    let mut scene = scene();
    let mut poses = Vec::with_capacity(COUNT);
    let (mut ours, mut engines) = (0, 0);
    while scene.time_s() < 1.0 {
        let tilt = tilt_rad(scene.time_s());
        let next = super::scene::pose_with_lip(&container_of(&scene), LIP, tilt);
        let cup = scene.cup;
        scene.physics.bodies[cup].set_next_kinematic_position(rapier3d::math::Pose::from(next));
        let before = allocation_counter::measure(|| scene.grains.before_step(&mut scene.physics));
        scene.physics.step();
        let after = allocation_counter::measure(|| {
            scene.monitor.after_step(&scene.physics, &scene.grains);
            scene.grains.poses(&scene.physics, &mut poses);
        });
        scene.steps += 1;
        engines = engines.max(before.count_total);
        ours += after.count_total;
    }
    assert_eq!(ours, 0);
    // the engine starts its list of touched bodies anew in each step, and doubles it until it holds all grains
    let doublings = u64::from(COUNT.ilog2());
    assert!(engines <= doublings, "{engines} allocations before a step, {doublings} by the engine's list");
}

fn container_of(scene: &Scene) -> Container {
    scene.monitor.source().container().clone()
}
