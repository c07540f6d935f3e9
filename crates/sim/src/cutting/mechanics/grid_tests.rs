//! Lengths and areas of sections against closed forms.

use super::*;
use approx::assert_relative_eq;
use std::f64::consts::TAU;

const CELL_M: f64 = 0.00025;

fn disc(radius: f64, corners: u32) -> Vec<Point2<f64>> {
    let at = |k: u32| TAU * f64::from(k) / f64::from(corners);
    (0..corners).map(|k| Point2::new(radius * at(k).cos(), radius * at(k).sin())).collect()
}

fn block(x: [f64; 2], y: [f64; 2]) -> Vec<Point2<f64>> {
    vec![Point2::new(x[0], y[0]), Point2::new(x[1], y[0]), Point2::new(x[1], y[1]), Point2::new(x[0], y[1])]
}

fn chord(grid: &SectionGrid, y: f64) -> f64 {
    (0..grid.columns()).map(|column| grid.tributary(column, [y; 2]).iter().sum::<f64>()).sum()
}

#[test]
fn the_chord_of_a_disc_is_right_to_half_a_column_and_exact_away_from_its_upright_sides() {
    let radius = 0.01167;
    let grid = SectionGrid::new(&[disc(radius, 720)], CELL_M).unwrap();
    for step in -90..=90 {
        let y = radius * f64::from(step) / 100.0;
        let expected = 2.0 * (radius * radius - y * y).sqrt();
        // in the outermost columns a root is taken for a straight line: at most a quarter of a column at each end,
        // and the polygon lies 0.1 µm within the circle
        let tolerance = if y.abs() < 0.4 * radius { 0.5 * CELL_M + 1e-6 } else { 1e-5 };
        assert_relative_eq!(chord(&grid, y), expected, epsilon = tolerance);
    }
}

#[test]
fn the_area_of_a_section_is_that_of_its_polygons_whether_in_one_or_in_pieces() {
    let whole = SectionGrid::new(&[block([-0.0201, 0.0199], [0.0, 0.03])], CELL_M).unwrap();
    let pieces = [
        block([-0.0201, 0.00313], [0.0, 0.011]),
        block([-0.0201, 0.00313], [0.011, 0.03]),
        block([0.00313, 0.0199], [0.0, 0.03]),
    ];
    let parts = SectionGrid::new(&pieces, CELL_M).unwrap();
    for grid in [&whole, &parts] {
        assert_relative_eq!(grid.area(), 0.0012, max_relative = 1e-12);
        assert_relative_eq!(chord(grid, 0.02), 0.04, max_relative = 1e-6);
    }
    assert_eq!(parts.spans(3).len(), 1);
}

#[test]
fn a_gap_between_pieces_is_not_food() {
    let stacked = [block([0.0, 0.04], [0.0, 0.01]), block([0.0, 0.04], [0.02, 0.03])];
    let grid = SectionGrid::new(&stacked, CELL_M).unwrap();
    assert_eq!(grid.spans(10).len(), 2);
    assert_relative_eq!(chord(&grid, 0.015), 0.0);
    assert_relative_eq!(chord(&grid, 0.025), 0.04, max_relative = 1e-9);
    assert!(grid.has_food_at(10, 0.005) && !grid.has_food_at(10, 0.015));
}

#[test]
fn area_above_a_sloped_profile_is_that_of_a_trapezoid() {
    let grid = SectionGrid::new(&[block([0.0, 0.04], [0.0, 0.03])], CELL_M).unwrap();
    let depth = |node: usize| 0.6 * grid.x(node) - 0.006;
    let area: f64 = (0..grid.columns()).map(|k| grid.area_above(k, [depth(k), depth(k + 1)])).sum();
    // a triangle from x = 0.01 to 0.04, 0.018 deep
    assert_relative_eq!(area, 0.5 * 0.03 * 0.018, max_relative = 1e-9);
}

#[test]
fn shapes_that_are_no_section_are_refused_with_the_reason() {
    let hollow = vec![
        Point2::new(0.0, 0.0),
        Point2::new(0.04, 0.0),
        Point2::new(0.02, 0.01),
        Point2::new(0.04, 0.03),
        Point2::new(0.0, 0.03),
    ];
    let message = |polygons: &[Vec<Point2<f64>>]| SectionGrid::new(polygons, CELL_M).unwrap_err().to_string();
    assert_eq!(message(&[hollow]), "polygons[0]: found a hollow corner; expected a convex polygon with an area");
    assert!(message(&[]).contains("0 polygons"));
    assert!(message(&[vec![Point2::origin(); 3]]).contains("no area"));
    assert!(message(&[vec![Point2::new(f64::NAN, 0.0); 3]]).contains("not finite"));
}
