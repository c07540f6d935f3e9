//! How a food comes to rest on the board before anything is cut: laid down in the engine, and seen where it then lies.

use nalgebra::{Isometry3, Point3, Vector3};
use rapier3d::prelude::SharedShape;

use super::piece::{Lie, Piece};
use super::setup::{BOARD_GROUPS, CuttingSetup};
use crate::SimError;
use crate::spatial::{EngineConfig, SpatialWorld, standard_gravity};

/// Shortest and longest time that a food is given to come to rest, s: what is laid down in balance takes a while to fall.
const SHORTEST_S: f64 = 1.0;
const LONGEST_S: f64 = 6.0;
/// Time between two looks at it, s.
const LOOK_S: f64 = 0.1;
/// What has moved by less than this between two looks lies still, m, for the contacts of the engine creep: the origin of the food's frame, and the points on its axes
/// at this distance, m.
const STILL_M: f64 = 2e-5;
const REACH_M: f64 = 0.1;

/// Pose in which the food of `setup` comes to rest after it was laid down at its `world_from_food`; a round food rolls onto
/// one of the faces that it is made of, and a tapered one tips.
///
/// # Errors
/// [`SimError::Cutting`] if it does not come to rest, [`SimError::Diverged`] if the engine breaks down, or a field error.
pub fn pose_at_rest(setup: &CuttingSetup, engine: &EngineConfig) -> Result<Isometry3<f64>, SimError> {
    setup.validate()?;
    let mut world = SpatialWorld::new(engine, &standard_gravity())?;
    let [x, y, z] = setup.board.half_extents_m;
    let middle = setup.board.world_from_middle();
    let board = world.insert_fixed(SharedShape::cuboid(x, y, z), &middle, setup.board.friction);
    if let Some(collider) = world.physics.colliders.get_mut(board) {
        collider.set_collision_groups(BOARD_GROUPS);
    }
    let zero = Vector3::zeros();
    let still = Lie {
        world_from_food: setup.world_from_food,
        velocity: zero,
        angular_velocity: zero,
        center: Point3::origin(),
    };
    let food = &setup.food;
    let mut whole = Piece::insert(&mut world, food.name.clone(), food.solid.clone(), &food.material, &still, true);
    let steps = (LOOK_S / engine.time_step_s).round().max(1.0) as usize;
    let mut moved_m = f64::INFINITY;
    for _ in 0..(LONGEST_S / LOOK_S) as usize {
        let before = whole.lie.world_from_food;
        (0..steps).for_each(|_| world.step());
        whole.refresh(&world);
        moved_m = farthest_m(&before, &whole.lie.world_from_food);
        let time_s = world.time_s();
        if !moved_m.is_finite() {
            return Err(SimError::Diverged { quantity: "the food's place".into(), value: moved_m, time_s });
        }
        if moved_m < STILL_M && time_s >= SHORTEST_S {
            return Ok(whole.lie.world_from_food);
        }
    }
    let (name, speed) = (&food.name, moved_m / LOOK_S);
    let reason = format!(
        "`{name}` still moves at {speed:.4} m/s {LONGEST_S} s after it was laid down; expected it to come to rest; lay it on \
         the middle of the board, or on its flat side"
    );
    Err(SimError::Cutting { reason })
}

/// How far the origin of a frame or one of the points on its axes went, m.
fn farthest_m(before: &Isometry3<f64>, now: &Isometry3<f64>) -> f64 {
    let points = [[0.0; 3], [REACH_M, 0.0, 0.0], [0.0, REACH_M, 0.0], [0.0, 0.0, REACH_M]].map(Point3::from);
    let ways = points.iter().map(|point| (now * point - before * point).norm());
    ways.fold(0.0, |most, way| if way.is_nan() { f64::NAN } else { most.max(way) })
}
