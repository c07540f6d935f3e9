//! Cells by hand: volumes and inertias of textbook bodies, and refusals.

use nalgebra::Matrix3;

use super::*;

/// Sums of a few products of exactly represented numbers, relative to them.
const ROUNDING: f64 = 1e-14;

#[test]
fn mass_properties_of_a_box_are_those_of_the_textbook() {
    let cell = ConvexCell::from_box(&Vector3::new(0.05, 0.02, 0.015)).unwrap();
    let body = cell.mass_properties(1000.0);
    assert!((body.mass_kg - 0.12).abs() < ROUNDING);
    assert!(body.center.coords.norm() < ROUNDING);
    let (a, b, c) = (0.1_f64.powi(2), 0.04_f64.powi(2), 0.03_f64.powi(2));
    let textbook = Matrix3::from_diagonal(&(Vector3::new(b + c, a + c, a + b) * (0.12 / 12.0)));
    assert!((body.inertia_kg_m2 - textbook).norm() < ROUNDING * textbook.norm());
}

#[test]
fn mass_properties_of_a_corner_tetrahedron_are_those_of_the_textbook() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point3::from).to_vec();
    let faces = vec![vec![0, 2, 1], vec![0, 1, 3], vec![1, 2, 3], vec![2, 0, 3]];
    let body = ConvexCell::from_faces(corners, faces).unwrap().mass_properties(6.0);
    assert!((body.mass_kg - 1.0).abs() < ROUNDING);
    assert!((body.center - Point3::new(0.25, 0.25, 0.25)).norm() < ROUNDING);
    // ∫x² = 1/10 and ∫xy = 1/20 per mass about the corner, less 1/16 each about the center
    let textbook = Matrix3::from_fn(|row, column| if row == column { 2.0 * (0.1 - 0.0625) } else { 0.0625 - 0.05 });
    assert!((body.inertia_kg_m2 - textbook).norm() < ROUNDING, "{}", body.inertia_kg_m2);
}

#[test]
fn thickness_is_the_smallest_extent_of_a_box() {
    let cell = ConvexCell::from_box(&Vector3::new(0.05, 0.02, 0.015)).unwrap();
    assert!((cell.thickness_m() - 0.03).abs() < ROUNDING);
}

#[test]
fn a_hollow_prism_is_refused() {
    let dart = [[0.0, 0.0], [0.02, -0.02], [0.0, 0.03], [-0.02, -0.02]].map(Point2::from);
    let error = ConvexCell::prism(&dart, 0.0, 0.01).unwrap_err();
    assert!(matches!(error, GeometryError::NotConvex { .. }), "{error}");
}

#[test]
fn an_inside_out_prism_is_refused() {
    let clockwise = [[0.0, 0.0], [0.0, 0.02], [0.02, 0.02]].map(Point2::from);
    let error = ConvexCell::prism(&clockwise, 0.0, 0.01).unwrap_err();
    assert!(matches!(error, GeometryError::NotConvex { .. }), "{error}");
}

#[test]
fn boxes_without_extent_or_with_nan_are_refused() {
    for extents in [[0.0, 0.01, 0.01], [f64::NAN, 0.01, 0.01], [0.01, -0.01, 0.01], [0.01, f64::INFINITY, 0.01]] {
        assert!(ConvexCell::from_box(&Vector3::from(extents)).is_err(), "{extents:?}");
    }
}
