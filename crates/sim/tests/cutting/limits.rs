//! Where free foods begin to slide under the knife, against the closed forms of the balance of forces.

use std::f64::consts::FRAC_PI_2;

use sim::cutting::food::FoodFile;
use sim::cutting::mechanics::{Failure, roll_limit_offset_m, slicing_ratio_at_which_food_slides};
use sim::cutting::scene::CuttingSetup;

use super::fixture::*;

/// Force of a push without slicing, R w, and weight of the block of 40 x 30 x 100 mm, N.
const PUSH_N: f64 = 4.5;
const WEIGHT_N: f64 = 1.177;
/// Tolerance of the ratio at which it slides: the dent of 0.4 mm at the begin of a cut of 18 mm.
const RATIO: f64 = 0.03;

/// A block without flanks that is free on a board of this friction.
fn block_on(board_friction: f64) -> CuttingSetup {
    let mut block = food(BLOCK);
    let material = &mut block.material;
    (material.toughness_j_per_m2, material.flank_shear_pa, material.rate_exponent) = (PUSH_N / 0.04, 0.0, 0.0);
    (material.yield_stress_pa, material.board_friction) = (0.0, 2.0);
    let mut setup = setup(block, FRAC_PI_2);
    setup.board.friction = board_friction;
    setup.thresholds.slip_m = 0.05;
    setup
}

/// Slides the edge by `ratio` times its way down to 12 mm above the board; returns the mean ratio over the food, and how far
/// the food slid, m.
fn slice(board_friction: f64, ratio: f64) -> (f64, f64) {
    let (top, low) = (0.033, 0.012);
    let half = 0.5 * ratio * (top - low);
    let script = Script::from(upright(-half, 0.0, top)).to(2.5, upright(half, 0.0, low));
    let outcome = run(&block_on(board_friction), &script);
    let cut = &outcome.record.cuts[0];
    let inside = |sample: &&sim::spatial::EpisodeSample| sample.time_s >= cut.begun_s && sample.time_s < 2.5;
    let samples: Vec<_> = outcome.episode.samples.iter().filter(inside).collect();
    let [first, last] =
        [samples[0], samples[samples.len() - 1]].map(|sample| sample.world_from_tool.translation.vector);
    let slip_m = outcome.record.food_slip_m;
    ((last.x - first.x - slip_m) / (first.z - last.z), slip_m)
}

#[test]
fn a_sliced_block_slides_as_fast_as_keeps_the_ratio_at_its_limit() {
    for friction in [0.4, 0.3] {
        let limit = slicing_ratio_at_which_food_slides(PUSH_N, WEIGHT_N, friction).expect("it slides");
        let (_, below_m) = slice(friction, limit - 0.1);
        assert!(below_m < 3e-4, "{friction}: slid by {below_m} m below the limit");
        let (ratio, above_m) = slice(friction, limit + 0.3);
        assert!(above_m > 3e-3, "{friction}: slid by {above_m} m only");
        // the food is taken along, so that the edge slides over it no faster than the board's friction bears
        assert!((ratio - limit).abs() < RATIO, "{friction}: {ratio}, expected {limit}");
    }
}

/// Radius of the cylinder, m.
const RADIUS_M: f64 = 0.010;
/// Tolerance of the offset at which it slides away: half a flat side of 128 is 0.25 mm.
const OFFSET_M: f64 = 3e-4;

/// Presses along a cylinder that is too tough to be cut, `offset_m` beside its axis; says whether it slides away.
fn slides_away(offset_m: f64, friction: f64) -> bool {
    let text = CYLINDER.replace("0.03708", "0.020").replace("length_m = 0.150", "length_m = 0.050");
    let text = text.replace("sides = 64", "sides = 128");
    let mut cylinder = toml::from_str::<FoodFile>(&text).expect("a food file").food().expect("a food");
    let material = &mut cylinder.material;
    (material.toughness_j_per_m2, material.indentation_stiffness_pa) = (5000.0, 4e6);
    material.board_friction = 2.0;
    let mut setup = setup(cylinder, 0.0);
    (setup.board.friction, setup.knife.edge.friction) = (friction, friction);
    let touch = RADIUS_M + (RADIUS_M * RADIUS_M - offset_m * offset_m).sqrt();
    let script = Script::from(upright(0.0, offset_m, 0.026)).to(2.0, upright(0.0, offset_m, touch - 0.001));
    matches!(run(&setup, &script).record.failure, Some(Failure::Slipped { .. }))
}

#[test]
fn a_cylinder_slides_away_beyond_the_offset_of_the_two_contacts() {
    // rougher contacts bear more force across the knife than the arm does without giving way: there the food turns under the
    // knife by a tenth of a radian, and the limit of a rigid guide cannot be told
    let friction = 0.1;
    let limit = roll_limit_offset_m(RADIUS_M, friction, friction);
    assert!(!slides_away(limit - OFFSET_M, friction), "slides below {limit} m");
    assert!(slides_away(limit + OFFSET_M, friction), "stays beyond {limit} m");
}
