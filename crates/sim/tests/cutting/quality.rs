//! Surfaces that a knife leaves, and a board that it does not pass.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Vector3;
use sim::cutting::mechanics::{Failure, Thresholds};
use sim::cutting::scene::CuttingSetup;

use super::fixture::*;

#[test]
fn a_wobbling_knife_leaves_a_rougher_surface() {
    let roughness = |wobble: fn(f64) -> Vector3<f64>| {
        let script = Script { wobble, ..press(0.0, 0.035, 0.001, 2.0) };
        let outcome = run(&setup(food(BANANA), FRAC_PI_2), &script);
        assert_eq!(outcome.record.pieces.len(), 2, "{:?}", outcome.events);
        let cells = outcome.record.pieces.iter().map(|piece| piece.cells).sum::<usize>();
        (outcome.record.cuts[0].quality.mean_deviation_m, cells)
    };
    let (straight, plain) = roughness(|_| Vector3::zeros());
    let (wobbly, strips) = roughness(|time_s| Vector3::new(0.0, 0.0, 0.001 * (TAU * 1.5 * time_s).sin()));
    assert!(straight < 5e-5, "{straight} m");
    assert!(wobbly > 5.0 * straight, "{wobbly} m and {straight} m");
    assert!(strips > plain, "the pieces have the form of the cut");
}

#[test]
fn the_knife_never_passes_the_board() {
    let setup = CuttingSetup { thresholds: Thresholds::default(), ..setup(food(BANANA), FRAC_PI_2) };
    let outcome = run(&setup, &press(0.0, 0.035, 0.03, 1.0));
    let edge = |sample: &sim::spatial::EpisodeSample| {
        let ends = [-0.09, 0.09].map(|x| sample.world_from_tool * nalgebra::Point3::new(x, 0.0, 0.0));
        ends[0].z.min(ends[1].z) - BOARD[2]
    };
    let lowest = outcome.episode.samples.iter().map(edge).fold(f64::INFINITY, f64::min);
    // a tenth of a millimeter: soft contact of the engine under a blow
    assert!(lowest > -1e-4, "{lowest} m");
    assert!(matches!(outcome.record.failure, Some(Failure::BoardImpact { .. })), "{:?}", outcome.record.failure);
    assert!(outcome.episode.finished);
}
