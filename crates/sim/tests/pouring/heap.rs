//! The angle of a heap.

use nalgebra::Isometry3;
use rapier3d::math::Vector;
use rapier3d::prelude::*;
use sim::pouring::*;
use sim::random::{Purpose, stream, symmetric};

use super::scene::{table, world};

const DIAMETER_M: f64 = 0.0065;
const DISC_RADIUS_M: f64 = 0.045;
/// Four grains are let go on a ring, from rest, this high above the heap's highest grain, every so many steps.
const RING_M: f64 = 0.006;
const ABOVE_APEX_M: f64 = 0.010;
const PAUSE_STEPS: usize = 25;

/// A disc with a rim one grain high, on a post.
fn disc(physics: &mut PhysicsWorld, grain: &GrainConfig) {
    let dish = super::scene::straight(DISC_RADIUS_M, DIAMETER_M);
    let body = physics.insert_body(RigidBodyBuilder::fixed());
    physics.insert_collider(grain.wall(dish.collider(grain), grain.friction, 0.5), Some(body));
}

/// Angle of a heap made by letting grains rain slowly on the middle of the disc, degrees.
pub fn heap_angle_deg(engine: &GrainEngineConfig, grain: &GrainConfig, count: usize, seed: u64) -> f64 {
    let mut physics = world(engine);
    disc(&mut physics, grain);
    table(&mut physics, grain, -0.06);
    let mut random = stream(seed, Purpose::Variation, 1);
    let batch = GrainBatch::draw(grain, count, &mut random).expect("valid");
    // they wait beside the disc, out of everything's way and without weight, until it is their turn
    let waiting = |i: usize| Isometry3::translation(0.3 + 0.01 * (i % 20) as f64, 0.01 * (i / 20) as f64, 0.1);
    let poses: Vec<_> = (0..count).map(waiting).collect();
    let mut grains = Grains::insert(&mut physics, batch, &poses, InteractionGroups::all()).expect("a pose per grain");
    let handles = grains.handles().to_vec();
    handles.iter().for_each(|handle| physics.bodies[*handle].set_gravity_scale(0.0, true));
    let mut released = 0;
    for step in 0..PAUSE_STEPS * count.div_ceil(4) + 1000 {
        if step % PAUSE_STEPS == 0 {
            let apex = apex_m(&physics, &handles[..released]);
            for handle in handles.iter().skip(released).take(4) {
                let (sin, cos) =
                    (0.5 * std::f64::consts::PI * ((released % 4) as f64 + symmetric(&mut random))).sin_cos();
                let body = &mut physics.bodies[*handle];
                body.set_translation(Vector::new(RING_M * cos, RING_M * sin, apex + ABOVE_APEX_M), true);
                body.set_gravity_scale(1.0, true);
                released += 1;
            }
        }
        grains.before_step(&mut physics);
        physics.step();
    }
    slope_deg(grains.bodies(&physics).map(|body| body.translation()))
}

/// Height of the highest grain, m.
fn apex_m(physics: &PhysicsWorld, released: &[RigidBodyHandle]) -> f64 {
    released.iter().map(|handle| physics.bodies[*handle].translation().z).fold(0.0, f64::max)
}

/// Slope of the highest grains over the radius: per ring one diameter wide and sector of 30°, then a straight line.
fn slope_deg(centers: impl Iterator<Item = Vector>) -> f64 {
    const RINGS: usize = 6;
    const SECTORS: usize = 12;
    let mut top = [[f64::NEG_INFINITY; SECTORS]; RINGS];
    for at in centers.filter(|at| at.z > 0.0) {
        let radius = at.x.hypot(at.y);
        let ring = (radius / DIAMETER_M) as usize;
        let sector = ((at.y.atan2(at.x) / std::f64::consts::TAU + 0.5) * SECTORS as f64) as usize % SECTORS;
        if let Some(cell) = top.get_mut(ring).and_then(|row| row.get_mut(sector)) {
            *cell = cell.max(at.z);
        }
    }
    // the innermost ring is the blunt tip
    let points: Vec<(f64, f64)> = (1..RINGS)
        .filter_map(|ring| {
            let seen: Vec<f64> = top[ring].iter().copied().filter(|z| z.is_finite()).collect();
            let mean = seen.iter().sum::<f64>() / seen.len() as f64;
            (!seen.is_empty()).then_some(((ring as f64 + 0.5) * DIAMETER_M, mean))
        })
        .collect();
    let count = points.len() as f64;
    let (mx, mz) = (points.iter().map(|p| p.0).sum::<f64>() / count, points.iter().map(|p| p.1).sum::<f64>() / count);
    let covariance: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - mz)).sum();
    let variance: f64 = points.iter().map(|p| (p.0 - mx).powi(2)).sum();
    (-covariance / variance).atan().to_degrees()
}

/// Mean over five heaps; measured mung beans stand at 25.9 to 29.4° (Dash 2022), soybeans at 27 to 32° inside (Kibar 2008).
const EXPECTED_DEG: f64 = 25.0;
const TOLERANCE_DEG: f64 = 3.0;

pub fn grain(rolling_friction: f64) -> GrainConfig {
    GrainConfig { diameter_m: DIAMETER_M, rolling_friction, ..GrainConfig::default() }
}

#[test]
#[ignore = "half a minute: cargo test --release -p sim --test pouring -- --ignored --nocapture five_heaps"]
fn five_heaps_stand_as_steep_as_real_ones() {
    let angles: Vec<f64> =
        (0..5).map(|seed| heap_angle_deg(&GrainEngineConfig::default(), &grain(0.1), 500, seed)).collect();
    let mean = angles.iter().sum::<f64>() / 5.0;
    println!("heaps {angles:.1?}, mean {mean:.2} degrees");
    assert!((mean - EXPECTED_DEG).abs() < TOLERANCE_DEG, "{mean} of {angles:?}");
}
