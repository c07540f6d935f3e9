//! Tests of grains: sizes, shapes, friction with walls, refusals.

use std::f64::consts::PI;

use rapier3d::math::Vector;
use rapier3d::prelude::*;

use super::*;
use crate::pouring::GrainEngineConfig;
use crate::random::{Purpose, stream};

fn batch(config: &GrainConfig, count: usize) -> GrainBatch {
    GrainBatch::draw(config, count, &mut stream(4, Purpose::Variation, 0)).expect("valid")
}

#[test]
fn sizes_scatter_as_stated_and_never_beyond_two_deviations() {
    let config = GrainConfig::default();
    let batch = batch(&config, 4000);
    let mean = batch.diameters_m().iter().sum::<f64>() / 4000.0;
    let variance = batch.diameters_m().iter().map(|d| (d - mean).powi(2)).sum::<f64>() / 4000.0;
    let widest = batch.diameters_m().iter().map(|d| (d / 0.007 - 1.0).abs()).fold(0.0, f64::max);
    // standard error of the mean 0.06 %; drawing in at two deviations takes 4 % off the deviation
    assert!((mean / 0.007 - 1.0).abs() < 0.002, "{mean}");
    assert!((variance.sqrt() / mean / 0.04 - 0.96).abs() < 0.04, "{}", variance.sqrt() / mean);
    assert!(widest <= 0.08 + 1e-12, "{widest}");
}

#[test]
fn an_elongated_grain_has_the_volume_of_its_ball() {
    let config = GrainConfig { shape: GrainShape::Capsule { aspect: 1.25 }, ..GrainConfig::default() };
    let (radius, half_length) = config.radius_and_half_length_m(0.007);
    let volume = PI * radius * radius * (4.0 / 3.0 * radius + 2.0 * half_length);
    assert!((volume / (PI / 6.0 * 0.007_f64.powi(3)) - 1.0).abs() < 1e-12);
    assert!(((radius + half_length) / radius - 1.25).abs() < 1e-12);
    let mut physics = PhysicsWorld::new();
    let one = batch(&GrainConfig { size_variation: 0.0, ..config }, 1);
    let mass = one.masses_kg().sum::<f64>();
    let grains = Grains::insert(&mut physics, one, &[Isometry3::identity()], InteractionGroups::all()).expect("one");
    let in_engine = grains.bodies(&physics).map(RigidBody::mass).sum::<f64>();
    assert!((in_engine / mass - 1.0).abs() < 1e-9, "{in_engine} for {mass}");
}

/// On a slope a ball that may not turn slides when tan α exceeds the wall's friction, whichever of the two is larger.
#[test]
fn the_walls_own_friction_holds_against_a_grain() {
    for wall in [0.2, 0.7] {
        for (steepness, slides) in [(0.9_f64, false), (1.1, true)] {
            let angle = (wall * steepness).atan();
            let config = GrainConfig { size_variation: 0.0, restitution: 0.0, ..GrainConfig::default() };
            let mut physics = PhysicsWorld::new();
            GrainEngineConfig::default().apply(&mut physics.integration_parameters);
            physics.gravity = Vector::new(9.81 * angle.sin(), 0.0, -9.81 * angle.cos());
            let floor = ColliderBuilder::cuboid(1.0, 1.0, 0.05).translation(Vector::new(0.0, 0.0, -0.05));
            physics.insert_collider(config.wall(floor, wall, 0.0), None);
            let pose = Isometry3::translation(0.0, 0.0, 0.0035);
            let mut grains =
                Grains::insert(&mut physics, batch(&config, 1), &[pose], InteractionGroups::all()).expect("one");
            let handle = grains.handles()[0];
            physics.bodies[handle].lock_rotations(true, true);
            for _ in 0..250 {
                grains.before_step(&mut physics);
                physics.step();
            }
            let speed = physics.bodies[handle].linvel().x;
            let expected = if slides { 0.5 * 9.81 * (angle.sin() - wall * angle.cos()) } else { 0.0 };
            assert!((speed - expected).abs() < 0.02 * expected + 1e-3, "{speed} for {expected}, wall {wall}");
        }
    }
}

#[test]
fn refusals_name_what_is_wrong() {
    let mut physics = PhysicsWorld::new();
    let refusal = Grains::insert(&mut physics, batch(&GrainConfig::default(), 3), &[], InteractionGroups::all());
    assert_eq!(
        refusal.err().map(|error| error.to_string()),
        Some("world_from_grains: found 0 poses; expected 3, one per grain".into())
    );
    let config = GrainConfig { diameter_m: f64::NAN, ..GrainConfig::default() };
    let refusal = GrainBatch::draw(&config, 1, &mut stream(4, Purpose::Variation, 0)).expect_err("not a number");
    assert_eq!(refusal.field, "diameter_m");
}

#[test]
fn a_grain_that_is_not_a_number_or_too_fast_is_reported() {
    let mut physics = PhysicsWorld::new();
    let config = GrainConfig::default();
    let poses = [Isometry3::identity(), Isometry3::translation(1.0, 0.0, 0.0)];
    let grains = Grains::insert(&mut physics, batch(&config, 2), &poses, InteractionGroups::all()).expect("two");
    assert!(grains.check_speed(&physics, 0.0, 1.0).is_ok());
    physics.bodies[grains.handles()[0]].set_linvel(Vector::new(f64::NAN, 0.0, 0.0), true);
    assert!(grains.check_speed(&physics, 0.0, 1.0).is_err());
    physics.bodies[grains.handles()[0]].set_linvel(Vector::new(0.0, 2.0, 0.0), true);
    assert!(grains.check_speed(&physics, 0.0, 1.0).is_err());
}
