//! Surfaces: closed edge by edge after plane cuts, and marked as skin or cut.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Point2};

use super::super::{ConvexCell, CutSurface, Plane};
use super::*;
use crate::cutting::food::FoodFile;

fn banana() -> Solid {
    let text = include_str!("../../../../../assets/foods/banana.toml");
    toml::from_str::<FoodFile>(text).unwrap().food().unwrap().solid
}

/// Area of the triangles of a surface, m².
fn area(mesh: &TriangleMesh, surface: Surface) -> f64 {
    let area = |[a, b, c]: [u32; 3]| {
        let at = |corner: u32| mesh.vertices[corner as usize];
        (at(b) - at(a)).cross(&(at(c) - at(a))).norm() / 2.0
    };
    let triangles = mesh.triangles.iter().zip(&mesh.surfaces).filter(|(_, found)| **found == surface);
    triangles.map(|(triangle, _)| area(*triangle)).sum()
}

/// Every edge is run through once in each direction.
fn assert_closed_edge_by_edge(mesh: &TriangleMesh) {
    let mut edges = BTreeMap::new();
    for [a, b, c] in &mesh.triangles {
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_insert(0) += 1;
        }
    }
    for ((from, to), count) in &edges {
        assert_eq!((*count, edges.get(&(*to, *from))), (1, Some(&1)), "edge {from} to {to}");
    }
}

#[test]
fn every_edge_of_a_banana_and_its_slices_has_two_triangles() {
    let mut pieces = vec![banana()];
    assert_closed_edge_by_edge(&pieces[0].mesh());
    for (x, angle) in [(0.0, 0.0), (-0.03, 0.3), (0.02, -0.7), (0.041, 0.1), (0.0, 1.2)] {
        let plane = Plane::of_frame(&Isometry3::new(Vector3::new(x, 0.003, 0.001), Vector3::new(0.1, 1.57, angle)));
        pieces = pieces.iter().flat_map(|piece| piece.split(&plane)).collect();
        pieces.iter().for_each(|piece| assert_closed_edge_by_edge(&piece.mesh()));
    }
    assert!(pieces.len() > 6);
}

#[test]
fn a_whole_banana_is_all_skin_and_its_halves_share_a_cut() {
    let whole = banana();
    let mesh = whole.mesh();
    assert_eq!(area(&mesh, Surface::Cut), 0.0);
    let frame = Isometry3::new(Vector3::new(0.013, 0.0, 0.0), Vector3::new(0.0, 1.4, 0.0));
    let section = whole.section(&frame).area_m2();
    let halves = whole.split(&Plane::of_frame(&frame));
    assert_eq!(halves.len(), 2);
    for half in &halves {
        // rounding of some hundred triangles
        assert!((area(&half.mesh(), Surface::Cut) / section - 1.0).abs() < 1e-12);
    }
    let skins = halves.iter().map(|half| area(&half.mesh(), Surface::Skin)).sum::<f64>();
    assert!((skins / area(&mesh, Surface::Skin) - 1.0).abs() < 1e-12);
}

#[test]
fn a_step_of_a_cut_is_part_of_the_surface() {
    let block = Solid::from_cells(vec![ConvexCell::from_box(&Vector3::new(0.02, 0.015, 0.05)).unwrap()]).unwrap();
    let strip = |z: f64| Plane { point: Point3::new(0.0, 0.0, z), normal: Vector3::z_axis() };
    let border = Plane { point: Point3::origin(), normal: Vector3::y_axis() };
    let cut = CutSurface::new(vec![strip(0.0), strip(0.01)], vec![border]).unwrap();
    for piece in block.split_along(&cut) {
        // two strips of 15 mm and a step of 10 mm, 40 mm wide
        assert!((area(&piece.solid.mesh(), Surface::Cut) - 0.04 * 0.04).abs() < 1e-15);
    }
}

#[test]
fn a_steered_cut_has_the_area_of_its_profile() {
    let block = Solid::from_cells(vec![ConvexCell::from_box(&Vector3::new(0.02, 0.015, 0.05)).unwrap()]).unwrap();
    let profile = [[-0.015, 0.0], [0.0, 0.003], [0.015, -0.002]].map(Point2::from);
    let cut = CutSurface::from_profile(&Isometry3::identity(), &profile).unwrap();
    let length = profile.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>();
    for piece in block.split_along(&cut) {
        assert!((area(&piece.solid.mesh(), Surface::Cut) - 0.04 * length).abs() < 1e-15);
    }
}
