//! Shapes against closed forms: volumes converge with the number of sides, chords follow the circle.

use std::f64::consts::PI;

use nalgebra::{Isometry3, Matrix3, Rotation3, UnitQuaternion, Vector3};

use super::*;
use crate::cutting::geometry::{Section, Solid};

fn solid(shape: &Shape) -> Solid {
    shape.validate().unwrap();
    Solid::from_cells(shape.cells().unwrap()).unwrap()
}

/// Volumes lacking to the closed form, relative to it, at 16, 32 and 64 sides.
fn shortfalls(shape: impl Fn(usize) -> Shape, exact_m3: f64) -> [f64; 3] {
    [16, 32, 64].map(|sides| 1.0 - solid(&shape(sides)).volume_m3() / exact_m3)
}

/// Checks that halving the sides' length quarters the shortfall, and that the finest is below half a percent.
fn assert_second_order(shortfalls: [f64; 3]) {
    for pair in shortfalls.windows(2) {
        // the next term of the error is of the fourth order: its share at 16 sides is about (π/16)² = 4 %
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.2, "{shortfalls:?}");
    }
    assert!(shortfalls[2] > 0.0 && shortfalls[2] < 5e-3, "{shortfalls:?}");
}

#[test]
fn volume_of_a_sphere_converges() {
    let sphere = |sides| Shape::Ellipsoid(Ellipsoid { length_m: 0.035, width_m: 0.035, height_m: 0.035, sides });
    assert_second_order(shortfalls(sphere, PI / 6.0 * 0.035_f64.powi(3)));
}

#[test]
fn volume_of_an_ellipsoid_converges() {
    let grape = |sides| Shape::Ellipsoid(Ellipsoid { length_m: 0.026, width_m: 0.020, height_m: 0.018, sides });
    assert_second_order(shortfalls(grape, PI / 6.0 * 0.026 * 0.020 * 0.018));
}

#[test]
fn volume_of_a_cylinder_converges() {
    let cylinder = |sides| Shape::Cylinder(Cylinder { diameter_m: 0.037, length_m: 0.15, sides });
    assert_second_order(shortfalls(cylinder, PI / 4.0 * 0.037_f64.powi(2) * 0.15));
}

#[test]
fn volume_of_a_berry_converges() {
    let berry = |sides| Shape::Berry(Berry { diameter_m: 0.03, length_m: 0.036, shoulder_m: 0.01, sides });
    // 2/3 of its cylinder for half an ellipsoid, 1/2 for a paraboloid
    let exact = PI * 0.015_f64.powi(2) * (0.01 * 2.0 / 3.0 + 0.026 / 2.0);
    assert_second_order(shortfalls(berry, exact));
}

#[test]
fn volume_of_a_disc_converges() {
    let (radius, half, edge): (f64, f64, f64) = (0.03, 0.0035, 0.0015);
    let disc = |sides| Shape::Disc(Disc { diameter_m: 0.06, thickness_m: 0.007, edge_radius_m: edge, sides });
    // Pappus: the flat core, and per edge the profile's square and quarter circle about the axis
    let core = radius - edge;
    let square = 2.0 * (PI * core * core * edge);
    let centroid = core + 4.0 * edge / (3.0 * PI);
    let quarters = 2.0 * (PI / 4.0 * edge * edge) * (2.0 * PI * centroid);
    let exact = 2.0 * PI * radius * radius * (half - edge) + square + quarters;
    assert_second_order(shortfalls(disc, exact));
}

/// A torus segment with elliptic ends. Pappus: cross sections turn about the center of curvature with their centroids on
/// the center line, so bending does not change the volume.
fn banana_volume(banana: &Banana) -> f64 {
    let (radius, tip) = (banana.diameter_m / 2.0, banana.tip_diameter_m / 2.0);
    let rise = radius - tip;
    let end = tip * tip + 2.0 * tip * rise * PI / 4.0 + rise * rise * 2.0 / 3.0;
    PI * (radius * radius * (banana.length_m - 2.0 * banana.end_length_m) + 2.0 * end * banana.end_length_m)
}

fn banana(sides: usize, wedges: usize) -> Banana {
    Banana {
        diameter_m: 0.03,
        length_m: 0.15,
        curvature_radius_m: 0.12,
        end_length_m: 0.015,
        tip_diameter_m: 0.014,
        sides,
        wedges,
    }
}

#[test]
fn volume_of_a_torus_segment_converges() {
    // a torus without taper, whose ends are too short for their finer wedges to count
    let torus = |sides: usize| {
        let ends = Banana { tip_diameter_m: 0.03, end_length_m: 0.001, ..banana(sides, sides / 2) };
        Shape::Banana(ends)
    };
    assert_second_order(shortfalls(torus, PI * 0.015_f64.powi(2) * 0.15));
}

#[test]
fn volume_of_the_shipped_banana_is_that_of_its_closed_form_within_a_few_percent() {
    let banana = banana(64, 24);
    let ratio = solid(&Shape::Banana(banana)).volume_m3() / banana_volume(&banana);
    // four wedges per end follow the quarter ellipse from within; sides and wedges add 0.2 %
    assert!(ratio < 1.0 && ratio > 0.99, "{ratio}");
}

/// The section across x at `x_m`: x of the section along y of the food, y of the section downwards.
fn across(solid: &Solid, x_m: f64) -> Section {
    let axes = Matrix3::from_columns(&[-Vector3::y(), -Vector3::z(), Vector3::x()]);
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    solid.section(&Isometry3::from_parts(Vector3::new(x_m, 0.0, 0.0).into(), turn))
}

#[test]
fn chord_of_a_round_cross_section_is_that_of_the_circle() {
    let radius = 0.03708_f64 / 2.0;
    let cylinder = solid(&Shape::Cylinder(Cylinder { diameter_m: 2.0 * radius, length_m: 0.15, sides: 128 }));
    let section = across(&cylinder, 0.0123);
    for depth in [0.004, 0.00616, 0.01, radius, 0.03] {
        let chord = 2.0 * (2.0 * radius * depth - depth * depth).sqrt();
        // a side of 128 lies at most r (1 − cos(π/128)) = 6 µm inside the circle; steeply cut, a chord loses several times that
        assert!(
            (section.width_at(depth - radius) - chord).abs() < 5e-5,
            "{depth}: {}",
            section.width_at(depth - radius)
        );
    }
    let polygon = 0.5 * 128.0 * radius * radius * (2.0 * PI / 128.0).sin();
    assert!((section.area_m2() - polygon).abs() < 1e-15);
}

#[test]
fn every_cross_section_of_the_banana_is_a_round_one() {
    let banana = solid(&Shape::Banana(banana(32, 10)));
    let section = across(&banana, 0.0);
    let polygon = 0.5 * 32.0 * 0.015_f64.powi(2) * (2.0 * PI / 32.0).sin();
    // the middle is a seam between two wedges, exactly one of the cross sections it is made of
    assert!((section.area_m2() - polygon).abs() < 1e-15, "{}", section.area_m2());
    assert_eq!(section.polygons.len(), 1);
}

#[test]
fn a_scaled_shape_has_the_cube_of_the_volume() {
    let shapes = [
        Shape::Block(Block { length_m: 0.1, width_m: 0.04, height_m: 0.03 }),
        Shape::Disc(Disc { diameter_m: 0.06, thickness_m: 0.007, edge_radius_m: 0.001, sides: 32 }),
        Shape::Berry(Berry { diameter_m: 0.03, length_m: 0.036, shoulder_m: 0.01, sides: 32 }),
        Shape::Banana(banana(16, 6)),
    ];
    for shape in shapes {
        let ratio = solid(&shape.scaled(1.1)).volume_m3() / solid(&shape).volume_m3();
        assert!((ratio - 1.331).abs() < 1e-12, "{shape:?}: {ratio}");
    }
}

#[test]
fn lengths_that_make_no_shape_are_named() {
    let refused = |shape: Shape| shape.validate().unwrap_err().field;
    assert_eq!(refused(Shape::Block(Block { length_m: 40.0, width_m: 0.04, height_m: 0.03 })), "block.length_m");
    assert_eq!(refused(Shape::Cylinder(Cylinder { diameter_m: 0.03, length_m: 0.1, sides: 5 })), "cylinder.sides");
    let tight = Banana { curvature_radius_m: 0.01, ..banana(32, 10) };
    assert_eq!(refused(Shape::Banana(tight)), "banana.curvature_radius_m");
    let nan = Berry { diameter_m: f64::NAN, length_m: 0.036, shoulder_m: 0.01, sides: 32 };
    assert_eq!(refused(Shape::Berry(nan)), "berry.diameter_m");
}
