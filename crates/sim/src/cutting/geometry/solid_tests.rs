//! Solids that come apart: pieces, thirds, horseshoes, cuts that steer.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, UnitVector3, Vector3};

use super::*;

/// Volumes and areas of cells of a few centimeters, relative to them.
const ROUNDING: f64 = 1e-12;

fn cuboid(low: [f64; 3], high: [f64; 3]) -> ConvexCell {
    let base = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]].map(Point2::from);
    ConvexCell::prism(&base, low[2], high[2]).unwrap()
}

fn across_x(x: f64) -> Plane {
    Plane { point: Point3::new(x, 0.0, 0.0), normal: Vector3::x_axis() }
}

/// A section frame whose depth goes along −z and whose normal is x.
fn section_at(x: f64) -> Isometry3<f64> {
    let axes = Matrix3::from_columns(&[-Vector3::y(), -Vector3::z(), Vector3::x()]);
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    Isometry3::from_parts(Vector3::new(x, 0.0, 0.0).into(), turn)
}

/// Three blocks in the shape of a U that opens towards y.
fn horseshoe() -> Solid {
    let left = cuboid([0.0, 0.0, 0.0], [0.01, 0.01, 0.01]);
    let left_arm = cuboid([0.0, 0.01, 0.0], [0.01, 0.04, 0.01]);
    let middle = cuboid([0.01, 0.0, 0.0], [0.04, 0.01, 0.01]);
    let right = cuboid([0.04, 0.0, 0.0], [0.05, 0.01, 0.01]);
    let right_arm = cuboid([0.04, 0.01, 0.0], [0.05, 0.04, 0.01]);
    Solid::from_cells(vec![left, left_arm, middle, right, right_arm]).unwrap()
}

#[test]
fn a_bar_cut_at_its_thirds_has_three_pieces_of_a_third() {
    let bar = Solid::from_cells(vec![cuboid([0.0, 0.0, 0.0], [0.15, 0.02, 0.02])]).unwrap();
    let first = bar.split(&across_x(0.05));
    let pieces = first.iter().flat_map(|piece| piece.split(&across_x(0.1))).collect::<Vec<_>>();
    assert_eq!(pieces.len(), 3);
    for piece in &pieces {
        assert!((piece.volume_m3() / bar.volume_m3() - 1.0 / 3.0).abs() < ROUNDING);
    }
}

#[test]
fn a_horseshoe_cut_across_its_arms_has_three_pieces() {
    let across = Plane { point: Point3::new(0.0, 0.02, 0.0), normal: Vector3::y_axis() };
    let pieces = horseshoe().split(&across);
    let volumes = pieces.iter().map(|piece| piece.volume_m3() * 1e6).collect::<Vec<_>>();
    assert_eq!(volumes.len(), 3);
    // the base with two stumps first, in cm³
    for (found, expected) in volumes.iter().zip([7.0, 2.0, 2.0]) {
        assert!((found - expected).abs() < ROUNDING * 10.0, "{volumes:?}");
    }
}

#[test]
fn a_cut_along_a_seam_parts_the_cells_and_its_section_is_the_seam() {
    let solid = horseshoe();
    let section = solid.section(&section_at(0.04));
    assert!((section.area_m2() - 1e-4).abs() < ROUNDING * 1e-4, "{}", section.area_m2());
    let pieces = solid.split(&across_x(0.04));
    assert_eq!(pieces.iter().map(|piece| piece.cells().len()).collect::<Vec<_>>(), [3, 2]);
}

#[test]
fn a_plane_against_the_outside_cuts_nothing() {
    let solid = horseshoe();
    for x in [0.0, 0.05, 0.06, 0.05 - 0.5 * SLIVER_M] {
        assert!(solid.section(&section_at(x)).is_empty(), "{x}");
        assert_eq!(solid.split(&across_x(x)), vec![solid.clone()], "{x}");
    }
}

#[test]
fn section_polygons_are_counterclockwise_whatever_the_frame() {
    let solid = horseshoe();
    for turn in [UnitQuaternion::identity(), UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI)] {
        let frame = Isometry3::from_parts(Vector3::new(0.0, 0.0, 0.004).into(), turn);
        let section = solid.section(&frame);
        assert_eq!(section.polygons.len(), 5);
        assert!((section.area_m2() - 11e-4).abs() < ROUNDING);
        assert!(section.polygons.iter().all(|outline| polygon::area(outline) > 0.0));
    }
}

#[test]
fn cells_that_do_not_touch_are_refused() {
    let apart = vec![cuboid([0.0; 3], [0.01; 3]), cuboid([0.02, 0.0, 0.0], [0.03, 0.01, 0.01])];
    assert!(Solid::from_cells(apart).unwrap_err().to_string().contains("cell 1 apart from cell 0"));
    assert!(Solid::from_cells(vec![]).is_err());
}

/// A block 40 mm wide (x of the section), 30 mm high (y, from the top), 100 mm long (z).
fn block() -> Solid {
    Solid::from_cells(vec![cuboid([-0.02, 0.0, -0.05], [0.02, 0.03, 0.05])]).unwrap()
}

#[test]
fn a_cut_of_one_strip_is_a_plane_cut() {
    let cut = CutSurface::from_profile(&Isometry3::identity(), &[Point2::new(0.0, 0.01), Point2::new(0.03, 0.01)]);
    let pieces = block().split_along(&cut.unwrap()).into_iter().map(|piece| piece.solid).collect::<Vec<_>>();
    let plane = Plane { point: Point3::new(0.0, 0.0, 0.01), normal: Vector3::z_axis() };
    assert_eq!(pieces, block().split(&plane));
}

#[test]
fn a_cut_that_steers_leaves_two_pieces_of_the_profiles_area() {
    let profile = [[-0.001, 0.0], [0.01, 0.002], [0.02, 0.001], [0.031, 0.004]].map(Point2::from);
    let cut = CutSurface::from_profile(&Isometry3::identity(), &profile).unwrap();
    let pieces = block().split_along(&cut);
    assert_eq!(pieces.iter().map(|piece| piece.side).collect::<Vec<_>>(), [Side::Negative, Side::Positive]);
    // trapezoids under the profile between y = 0 and 0.03, where its first and last pieces are cut off by the block
    let at_top = 0.002 * (0.001 / 0.011);
    let at_board = 0.001 + 0.003 * (0.010 / 0.011);
    let area = 0.01 * ((at_top + 0.002) + (0.002 + 0.001) + (0.001 + at_board)) / 2.0;
    let expected = 0.04 * (0.05 * 0.03 + area);
    assert!((pieces[0].solid.volume_m3() - expected).abs() < ROUNDING * expected);
    assert!((pieces[0].solid.volume_m3() + pieces[1].solid.volume_m3() - block().volume_m3()).abs() < 1e-18);
}

#[test]
fn a_step_in_the_cut_parts_the_pieces_too() {
    let strip = |z: f64| Plane { point: Point3::new(0.0, 0.0, z), normal: Vector3::z_axis() };
    let border = Plane { point: Point3::new(0.0, 0.01, 0.0), normal: Vector3::y_axis() };
    let cut = CutSurface::new(vec![strip(0.0), strip(0.01)], vec![border]).unwrap();
    let pieces = block().split_along(&cut);
    let volumes = pieces.iter().map(|piece| piece.solid.volume_m3() * 1e6).collect::<Vec<_>>();
    assert_eq!(volumes.len(), 2);
    // 40 mm × (10 mm × 50 mm + 20 mm × 60 mm), in cm³
    assert!((volumes[0] - 68.0).abs() < 1e-9 && (volumes[1] - 52.0).abs() < 1e-9, "{volumes:?}");
}

#[test]
fn a_steered_cut_that_misses_changes_nothing() {
    let profile = [[0.0, 0.06], [0.01, 0.07], [0.03, 0.065]].map(Point2::from);
    let cut = CutSurface::from_profile(&Isometry3::identity(), &profile).unwrap();
    let pieces = block().split_along(&cut);
    assert_eq!(pieces.len(), 1);
    assert_eq!(pieces[0].solid.cells(), block().cells());
}

#[test]
fn cut_surfaces_out_of_order_are_refused() {
    let plane = |y: f64| Plane { point: Point3::new(0.0, y, 0.0), normal: Vector3::y_axis() };
    let strips = vec![across_x(0.0); 3];
    assert!(CutSurface::new(strips.clone(), vec![plane(0.0)]).is_err());
    assert!(CutSurface::new(strips.clone(), vec![plane(0.01), plane(0.0)]).is_err());
    let tilted = Plane { normal: UnitVector3::new_normalize(Vector3::new(0.0, 1.0, 0.1)), ..plane(0.01) };
    assert!(CutSurface::new(strips, vec![plane(0.0), tilted]).is_err());
    let back = [Point2::new(0.0, 0.0), Point2::new(-0.01, 0.0)];
    assert!(CutSurface::from_profile(&Isometry3::identity(), &back).is_err());
}
