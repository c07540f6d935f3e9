//! Nothing is lost: volume and mass over many cuts, cuts across several pieces, and equal runs.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{UnitQuaternion, Vector3};

use super::fixture::*;

/// Cuts at these places, one after the other.
fn slices(places: &[f64], top: f64, past: f64) -> Script {
    let first = upright(0.0, places[0], top);
    places.iter().fold(Script::from(first), |script, &y| {
        stroke(script.to(0.5, upright(0.0, y, top)), upright(0.0, y, 0.0), top, past, 1.0)
    })
}

#[test]
fn volume_and_mass_are_those_of_the_food_after_every_cut() {
    let mut setup = setup(food(BANANA), FRAC_PI_2);
    let places = [-0.045, -0.02, 0.0, 0.02, 0.045];
    setup.planned = places.iter().map(|y| upright(0.0, *y, 0.03)).collect();
    let outcome = run(&setup, &slices(&places, 0.04, 0.001));
    let record = &outcome.record;
    assert_eq!(record.failure, None, "{:?}", outcome.events);
    assert_eq!(record.pieces.len(), 6);
    assert_eq!(record.cuts.iter().map(|cut| cut.planned).collect::<Vec<_>>(), (0..5).map(Some).collect::<Vec<_>>());
    let whole = setup.food.solid.volume_m3();
    let volume: f64 = record.pieces.iter().map(|piece| piece.volume_m3).sum();
    let mass: f64 = record.pieces.iter().map(|piece| piece.mass_kg).sum();
    assert!((volume / whole - 1.0).abs() < 1e-12, "{volume} of {whole} m³");
    assert!((mass / (whole * setup.food.material.density_kg_per_m3) - 1.0).abs() < 1e-12);
    let mut names = outcome.names.clone();
    assert_eq!(names, record.pieces.iter().map(|piece| piece.name.clone()).collect::<Vec<_>>());
    names.sort();
    names.dedup();
    assert_eq!(names.len(), 6, "each piece has a name of its own");
}

/// Force of the block on a knife that is all the way in: 8 N of fracture and most of 5 N of the flanks, N.
const CROSS_N: f64 = 12.0;

#[test]
fn a_stroke_across_two_pieces_cuts_both() {
    let mut setup = setup(food(BLOCK), FRAC_PI_2);
    let quarter = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2);
    let across = |height: f64| upright(0.0, 0.0, height) * quarter;
    setup.planned = vec![upright(0.0, 0.0, 0.03), across(0.03)];
    let between = press(0.0, 0.05, 0.001, 2.0).to(2.0, across(0.05));
    let mut script = stroke(between, across(0.0), 0.05, 0.001, 2.5);
    // under the block's force the arm gives way and turns, so that the heel would be on the board before the block is through
    script.expected[2] = CROSS_N;
    let outcome = run(&setup, &script);
    let record = &outcome.record;
    assert_eq!(record.pieces.len(), 4, "{:?}", outcome.events);
    // a piece that the knife grazes on its way out is not cut
    let cut = record.cuts.iter().filter(|cut| cut.separated_s.is_some()).map(|cut| cut.planned);
    assert_eq!(cut.collect::<Vec<_>>(), [Some(0), Some(1), Some(1)]);
    let whole = setup.food.solid.volume_m3();
    let volume: f64 = record.pieces.iter().map(|piece| piece.volume_m3).sum();
    assert!((volume / whole - 1.0).abs() < 1e-12, "{volume} of {whole} m³");
}

#[test]
fn equal_runs_are_equal_to_the_last_bit() {
    let digest = || run(&setup(food(BANANA), FRAC_PI_2), &press(0.003, 0.035, 0.001, 1.0)).episode.digest;
    let other = run(&setup(food(BANANA), FRAC_PI_2), &press(0.004, 0.035, 0.001, 1.0)).episode.digest;
    assert_eq!(digest(), digest());
    assert_ne!(digest(), other);
}
