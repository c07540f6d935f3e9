//! One grain or a few: rebound, sag of a column, rolling resistance.

use nalgebra::Isometry3;
use rapier3d::math::Vector;
use rapier3d::prelude::*;
use sim::pouring::*;
use sim::random::{Purpose, stream};

use super::scene::{GRAVITY, world};

fn grain(diameter_m: f64, restitution: f64, rolling_friction: f64) -> GrainConfig {
    GrainConfig { diameter_m, size_variation: 0.0, restitution, rolling_friction, ..GrainConfig::default() }
}

fn floor(physics: &mut PhysicsWorld, grain: &GrainConfig) {
    let body = physics.insert_body(RigidBodyBuilder::fixed());
    let floor = ColliderBuilder::cuboid(1.0, 1.0, 0.05).translation(Vector::new(0.0, 0.0, -0.05));
    physics.insert_collider(grain.wall(floor, grain.friction, grain.restitution), Some(body));
}

fn grains_at(physics: &mut PhysicsWorld, grain: &GrainConfig, heights_m: &[f64]) -> Grains {
    let batch = GrainBatch::draw(grain, heights_m.len(), &mut stream(1, Purpose::Variation, 0)).expect("valid");
    let poses: Vec<_> = heights_m.iter().map(|z| Isometry3::translation(0.0, 0.0, *z)).collect();
    Grains::insert(physics, batch, &poses, InteractionGroups::all()).expect("a pose per grain")
}

/// e = √(h'/h); the engine's contact is compliant and the step finite.
const RESTITUTION_TOLERANCE: f64 = 0.02;

#[test]
fn a_dropped_grain_rebounds_by_its_coefficient_of_restitution() {
    for restitution in [0.6, 0.3] {
        let grain = grain(0.007, restitution, 0.1);
        let mut physics = world(&GrainEngineConfig::default());
        floor(&mut physics, &grain);
        let mut grains = grains_at(&mut physics, &grain, &[0.1 + 0.0035]);
        let (mut has_bounced, mut highest) = (false, 0.0_f64);
        for _ in 0..250 {
            grains.before_step(&mut physics);
            physics.step();
            let body = &physics.bodies[grains.handles()[0]];
            has_bounced |= body.linvel().z > 0.0;
            if has_bounced && body.linvel().z <= 0.0 && highest > 0.0 {
                break;
            }
            if has_bounced {
                highest = highest.max(body.translation().z - 0.0035);
            }
        }
        let measured = (highest / 0.1).sqrt();
        println!("restitution {restitution}: rebound {:.2} mm, e = {measured:.4}", 1e3 * highest);
        assert!((measured - restitution).abs() < RESTITUTION_TOLERANCE, "{measured} for {restitution}");
    }
}

/// Relative; the column rests on contacts whose springs are known.
const SAG_TOLERANCE: f64 = 0.05;

#[test]
fn a_column_of_grains_sags_by_the_contacts_stiffness() {
    for frequency in [240.0, 480.0] {
        let engine = GrainEngineConfig {
            contact_frequency_hz: frequency,
            static_contact_frequency_hz: frequency,
            ..GrainEngineConfig::default()
        };
        let grain = grain(0.007, 0.0, 0.0);
        let mut physics = world(&engine);
        floor(&mut physics, &grain);
        let heights: Vec<f64> = (0..15).map(|i| 0.0035 + 0.007 * f64::from(i)).collect();
        let mut grains = grains_at(&mut physics, &grain, &heights);
        for handle in grains.handles().to_vec() {
            physics.bodies[handle].set_enabled_translations(false, false, true, true);
        }
        for _ in 0..2500 {
            grains.before_step(&mut physics);
            physics.step();
        }
        let height: Vec<f64> = grains.bodies(&physics).map(|body| body.translation().z).collect();
        let softness = GRAVITY / (std::f64::consts::TAU * frequency).powi(2);
        let overlap = 0.007 - (height[1] - height[0]);
        // the lowest contact between two grains carries 14 on half their mass; the floor's carries 15 on a whole one
        let expected = 2.0 * 14.0 * softness;
        let lowered = heights[14] - height[14];
        let expected_lowered = (15.0 + 2.0 * (1..=14).sum::<i32>() as f64) * softness;
        println!(
            "{frequency} Hz: overlap {:.4} mm (law {:.4}), top lowered {:.4} mm (law {:.4})",
            1e3 * overlap,
            1e3 * expected,
            1e3 * lowered,
            1e3 * expected_lowered
        );
        assert!((overlap / expected - 1.0).abs() < SAG_TOLERANCE, "{overlap} for {expected}");
        assert!((lowered / expected_lowered - 1.0).abs() < SAG_TOLERANCE, "{lowered} for {expected_lowered}");
        assert!(overlap < 0.02 * 0.007, "an overlap of {overlap} m is more than 2 % of a grain");
    }
}

/// Relative: a step of 2 ms in a roll of 0.4 s.
const ROLL_TOLERANCE: f64 = 0.03;

#[test]
fn a_rolling_ball_stops_after_the_distance_of_its_rolling_resistance() {
    let (rolling, speed) = (0.05, 0.15);
    let grain = grain(0.007, 0.0, rolling);
    let mut physics = world(&GrainEngineConfig::default());
    floor(&mut physics, &grain);
    let mut grains = grains_at(&mut physics, &grain, &[0.0035]);
    let handle = grains.handles()[0];
    for _ in 0..50 {
        grains.before_step(&mut physics);
        physics.step();
    }
    let start = physics.bodies[handle].translation().x;
    physics.bodies[handle].set_linvel(Vector::new(speed, 0.0, 0.0), true);
    physics.bodies[handle].set_angvel(Vector::new(0.0, speed / 0.0035, 0.0), true);
    let mut slowest = f64::INFINITY;
    for _ in 0..1000 {
        grains.before_step(&mut physics);
        physics.step();
        slowest = slowest.min(physics.bodies[handle].angvel().y * 0.0035);
    }
    // m a = −f and (2/5) m r² α = f r − μ_r r m g with a = α r: a = −(5/7) μ_r g
    let expected = speed * speed / (2.0 * 5.0 / 7.0 * rolling * GRAVITY);
    let distance = physics.bodies[handle].translation().x - start;
    println!("rolled {:.3} mm, law {:.3} mm", 1e3 * distance, 1e3 * expected);
    assert!((distance / expected - 1.0).abs() < ROLL_TOLERANCE, "{distance} for {expected}");
    assert!(slowest > -1e-4, "the resistance turned the ball back at {slowest} m/s");
    assert!(physics.bodies[handle].linvel().length() < 1e-4);
}
