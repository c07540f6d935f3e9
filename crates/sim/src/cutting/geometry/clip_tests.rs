//! Clips by hand, and in every degenerate place of a cube.

use nalgebra::{UnitVector3, Vector3};

use super::*;

const ROUNDING: f64 = 1e-15;

fn cube() -> ConvexCell {
    ConvexCell::from_box(&Vector3::new(0.5, 0.5, 0.5)).unwrap()
}

fn plane(point: [f64; 3], normal: [f64; 3]) -> Plane {
    Plane { point: Point3::from(point), normal: UnitVector3::new_normalize(Vector3::from(normal)) }
}

/// Volumes of the parts, 0 for none.
fn volumes(parts: &Parts) -> [f64; 2] {
    [&parts.0, &parts.1].map(|part| part.as_ref().map_or(0.0, ConvexCell::volume_m3))
}

#[test]
fn a_quarter_of_a_cube_is_cut_off() {
    let parts = cube().clip(&plane([0.25, 0.0, 0.0], [1.0, 0.0, 0.0]));
    let [negative, positive] = volumes(&parts);
    assert!((negative - 0.75).abs() < ROUNDING && (positive - 0.25).abs() < ROUNDING);
    assert_eq!(parts.1.unwrap().faces().count(), 6);
}

#[test]
fn a_corner_cut_off_is_a_tetrahedron() {
    let parts = cube().clip(&plane([0.5, 0.5, 0.3], [1.0, 1.0, 1.0]));
    let [_, corner] = volumes(&parts);
    assert!((corner - 0.2_f64.powi(3) / 6.0).abs() < ROUNDING, "{corner}");
    assert_eq!(parts.1.unwrap().faces().count(), 4);
}

#[test]
fn planes_through_corners_and_edges_halve_a_cube() {
    // through 4 corners along two edges, through 4 corners' diagonals, through the middles of 6 edges, through 2 corners
    for normal in [[1.0, 1.0, 0.0], [0.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 2.0], [2.0, -1.0, -1.0]] {
        let [negative, positive] = volumes(&cube().clip(&plane([0.0; 3], normal)));
        assert!((negative - 0.5).abs() < ROUNDING && (positive - 0.5).abs() < ROUNDING, "{normal:?}");
    }
}

#[test]
fn a_plane_that_touches_leaves_the_cube_whole() {
    let touching = [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]];
    for normal in touching {
        let parts = cube().clip(&plane([0.5, 0.5, 0.5], normal));
        assert_eq!(parts, (Some(cube()), None), "{normal:?}");
    }
}

#[test]
fn a_plane_of_nan_leaves_the_cube_whole() {
    let nowhere = Plane { point: Point3::new(f64::NAN, 0.0, 0.0), normal: Vector3::x_axis() };
    assert_eq!(cube().clip(&nowhere), (Some(cube()), None));
}

#[test]
fn neighbors_get_the_same_corners_bit_by_bit() {
    let whole = cube();
    let (left, right) = whole.divide(&plane([0.1, 0.0, 0.0], [1.0, 0.2, 0.1]), FaceKind::Seam(0));
    let oblique = plane([0.03, 0.01, 0.02], [0.3, 0.5, -0.7]);
    let seam_corners = |cell: Option<ConvexCell>| {
        let part = cell.unwrap().clip(&oblique).0.unwrap();
        let mut bits = part.faces().filter(|(_, _, kind)| *kind == FaceKind::Seam(0)).flat_map(|(corners, _, _)| {
            corners.into_iter().map(|corner| [corner.x, corner.y, corner.z].map(f64::to_bits))
        });
        let mut sorted = bits.by_ref().collect::<Vec<_>>();
        sorted.sort_unstable();
        sorted
    };
    let (left, right) = (seam_corners(left), seam_corners(right));
    assert!(left.len() >= 3 && left == right);
}
