//! A cylinder cut into three.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector6;

use super::fixture::*;

#[test]
fn a_cylinder_is_cut_into_three_equal_pieces() {
    let mut setup = setup(food(CYLINDER), FRAC_PI_2);
    let whole = setup.food.solid.mass_properties(setup.food.material.density_kg_per_m3).mass_kg;
    let third = 0.150 / 6.0;
    setup.planned = vec![upright(0.0, -third, 0.03708), upright(0.0, third, 0.03708)];
    let top = 0.05;
    let second = upright(0.0, third, 0.0);
    let between = press(-third, top, 0.001, 2.0).to(0.8, upright(0.0, third, top));
    // the middle of the force is fed forward: the arm gives way less, and the blade stays level
    let expected = Vector6::new(0.0, 0.0, 13.0, 0.0, 0.0, 0.0);
    let script = Script { expected, ..stroke(between, second, top, 0.001, 2.0) };
    let outcome = run(&setup, &script);
    let record = &outcome.record;
    assert!(outcome.episode.finished, "{:?}", outcome.episode.interruption);
    assert_eq!(record.failure, None);
    assert_eq!(record.pieces.len(), 3);
    for piece in &record.pieces {
        assert!((piece.mass_kg / (whole / 3.0) - 1.0).abs() < 0.01, "{} kg", piece.mass_kg);
        assert!((piece.extent_in_food_m.x - 0.05).abs() < 5e-4);
    }
    let total: f64 = record.pieces.iter().map(|piece| piece.mass_kg).sum();
    assert!((total / whole - 1.0).abs() < 1e-12, "{total} of {whole} kg");
}
