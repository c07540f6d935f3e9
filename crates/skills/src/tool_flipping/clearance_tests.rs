//! Tests of the clearance and of the curve traced on it.

use approx::assert_relative_eq;
use nalgebra::Isometry2;
use proptest::prelude::*;

use super::super::contour::Contour;
use super::*;
use crate::outline::{PlacedOutline, separation_m};
use crate::tool::{ContactSurface, SurfaceShape};

/// A few roundings of lengths of order one, m.
const ROUNDING_M: f64 = 1e-14;

fn tool(pieces: Vec<PlacedOutline>, start_m: [f64; 2], end_m: [f64; 2]) -> Tool {
    let surfaces = vec![ContactSurface::new("face", SurfaceShape::Face { start_m, end_m })];
    Tool { name: "tool".into(), description: String::new(), mass_kg: 1.0, friction: 0.3, pieces, surfaces }
}

fn placed(width_m: f64, height_m: f64, position_m: [f64; 2]) -> PlacedOutline {
    PlacedOutline { shape: Outline::Box { width_m, height_m }, position_m, angle_rad: 0.0 }
}

/// A square of side 2 about the origin.
fn square() -> Tool {
    tool(vec![placed(2.0, 2.0, [0.0, 0.0])], [-1.0, -1.0], [1.0, -1.0])
}

/// An L of two bars of 4 by 1, its inner corner at (0.5, 0.5).
fn angle() -> Tool {
    tool(vec![placed(4.0, 1.0, [1.5, 0.0]), placed(1.0, 4.0, [0.0, 1.5])], [-0.5, -0.5], [3.5, -0.5])
}

fn triangle() -> Outline {
    Outline::Polygon { vertices_m: vec![[-0.5, -0.4], [0.8, -0.2], [-0.1, 0.7]] }
}

#[test]
fn the_contour_round_a_square_has_the_length_of_its_sides_and_a_circle() {
    let bodies = Bodies::new(&square(), &Outline::Disc { radius_m: 0.5 }).unwrap();
    let contour = Contour { bodies: &bodies, angle_rad: 0.0, margin_m: 0.5 };
    let points = contour.trace(Point2::new(0.0, -2.0)).unwrap();
    let pieces = points.iter().zip(points.iter().cycle().skip(1));
    let length_m: f64 = pieces.map(|(a, b)| (b - a).norm()).sum();
    // chords of 0.05 in arcs of radius 1
    assert_relative_eq!(length_m, 8.0 + std::f64::consts::TAU, max_relative = 1e-3);
    assert!(points[1].x > 0.0, "counterclockwise");
    for point in &points {
        assert_relative_eq!(bodies.gap(point, 0.0).distance_m, 0.5, epsilon = 1e-6);
    }
}

#[test]
fn the_contour_passes_the_hollow_of_an_l_by_its_corner() {
    let bodies = Bodies::new(&angle(), &Outline::Disc { radius_m: 0.3 }).unwrap();
    let contour = Contour { bodies: &bodies, angle_rad: 0.0, margin_m: 0.2 };
    let points = contour.trace(Point2::new(1.5, -1.0)).unwrap();
    let nearest = points.iter().map(|point| (point - Point2::new(1.0, 1.0)).norm()).fold(f64::INFINITY, f64::min);
    assert!(nearest < contour.step_m());
    assert!(points.iter().all(|point| bodies.gap(point, 0.0).distance_m > 0.2 - 1e-6));
}

#[test]
fn a_turned_box_extends_by_its_support() {
    let bodies = Bodies::new(&square(), &Outline::Box { width_m: 2.0, height_m: 1.0 }).unwrap();
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_relative_eq!(bodies.support_m(&Vector2::y(), 0.0), 0.5, epsilon = 1e-15);
    assert_relative_eq!(bodies.support_m(&Vector2::y(), quarter), 1.0, epsilon = 1e-15);
    assert_relative_eq!(bodies.gap(&Point2::new(0.0, 3.0), quarter).distance_m, 1.0, epsilon = 1e-15);
    assert_relative_eq!(bodies.lever_m(), 1.25f64.sqrt());
    assert_relative_eq!(bodies.with_circumscribed_disc().lever_m(), 0.0);
}

proptest! {
    #[test]
    fn the_gap_is_the_separation_of_the_outlines_and_opens_along_its_direction(
        x in -3.0f64..3.0, y in -3.0f64..3.0, angle_rad in -3.0f64..3.0, kind in 0usize..3,
    ) {
        let objects = [Outline::Disc { radius_m: 0.4 }, Outline::Box { width_m: 1.5, height_m: 0.5 }, triangle()];
        let (object, tool) = (&objects[kind], square());
        let bodies = Bodies::new(&tool, object).unwrap();
        let place = Point2::new(x, y);
        let gap = bodies.gap(&place, angle_rad);
        let pose = Isometry2::new(place.coords, angle_rad);
        let expected = separation_m(&tool.pieces[0].shape, &Isometry2::identity(), object, &pose).unwrap();
        prop_assert!((gap.distance_m - expected).abs() < ROUNDING_M, "{} {expected}", gap.distance_m);
        prop_assert!((gap.outward.norm() - 1.0).abs() < 1e-12);
        let step_m = 1e-3;
        let farther = bodies.gap(&(place + gap.outward * step_m), angle_rad).distance_m;
        prop_assert!((farther - gap.distance_m - step_m).abs() < 1e-9);
    }

    #[test]
    fn the_gap_changes_no_faster_than_the_object_moves(
        from in [-3.0f64..3.0, -3.0f64..3.0, -3.0f64..3.0], way in [-0.3f64..0.3, -0.3f64..0.3, -0.3f64..0.3],
    ) {
        let bodies = Bodies::new(&angle(), &triangle()).unwrap();
        let at = |[x, y, angle_rad]: [f64; 3]| bodies.gap(&Point2::new(x, y), angle_rad).distance_m;
        let to = [from[0] + way[0], from[1] + way[1], from[2] + way[2]];
        let bound = way[0].hypot(way[1]) + bodies.lever_m() * way[2].abs();
        prop_assert!((at(to) - at(from)).abs() <= bound + 1e-12);
    }
}
