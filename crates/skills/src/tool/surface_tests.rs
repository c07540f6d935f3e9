//! Tests of contact surfaces.

use super::*;
use approx::assert_relative_eq;

/// A few roundings of lengths of some centimeters.
const ROUNDING_M: f64 = 1e-15;

fn side() -> ContactSurface {
    let shape = SurfaceShape::Face { start_m: [-0.006, 0.024], end_m: [-0.006, 0.014] };
    ContactSurface::new("side", shape)
}

fn head() -> ContactSurface {
    let direction_rad = std::f64::consts::FRAC_PI_2;
    let shape = SurfaceShape::Arc { center_m: [0.0, 0.024], radius_m: 0.006, direction_rad, half_angle_rad: 0.08 };
    ContactSurface::new("head", shape)
}

#[test]
fn the_normal_of_a_face_points_right_of_its_way() {
    assert_relative_eq!(side().middle().normal.into_inner(), Vector2::new(-1.0, 0.0), epsilon = ROUNDING_M);
    assert_relative_eq!(side().middle().point, Point2::new(-0.006, 0.019), epsilon = ROUNDING_M);
    assert_relative_eq!(side().length_m(), 0.010, epsilon = ROUNDING_M);
}

#[test]
fn the_tip_of_a_round_head_lies_one_radius_before_its_center() {
    assert_relative_eq!(head().middle().point, Point2::new(0.0, 0.030), epsilon = ROUNDING_M);
    assert_relative_eq!(head().length_m(), 0.00096, epsilon = ROUNDING_M);
}

/// A hollow of 30 mm radius that opens along +y; its deepest point is the origin.
fn hollow() -> ContactSurface {
    let direction_rad = std::f64::consts::FRAC_PI_2;
    let shape = SurfaceShape::Arc { center_m: [0.0, 0.03], radius_m: -0.03, direction_rad, half_angle_rad: 0.5 };
    ContactSurface::new("hollow", shape)
}

#[test]
fn the_normal_of_a_hollow_points_from_its_bottom_to_its_center() {
    assert_relative_eq!(hollow().middle().point, Point2::origin(), epsilon = ROUNDING_M);
    assert_relative_eq!(hollow().middle().normal.into_inner(), Vector2::y(), epsilon = ROUNDING_M);
    for place in [-0.01, 0.004, 0.015] {
        let contact = hollow().contact_at(place);
        let center = contact.point + contact.normal.into_inner() * 0.03;
        assert_relative_eq!(center, Point2::new(0.0, 0.03), epsilon = ROUNDING_M);
    }
    assert_relative_eq!(hollow().length_m(), 0.03, epsilon = ROUNDING_M);
    assert_eq!(hollow().curvature_radius_m(), -0.03);
}

#[test]
fn places_grow_to_the_left_of_the_normal_on_every_shape() {
    for surface in [side(), head(), hollow()] {
        let (middle, beside) = (surface.middle(), surface.contact_at(1e-4));
        let left = Vector2::new(-middle.normal.y, middle.normal.x);
        assert_relative_eq!((beside.point - middle.point).dot(&left), 1e-4, max_relative = 1e-3);
    }
}

#[test]
fn place_and_contact_are_inverse() {
    for surface in [side(), head(), hollow()] {
        for place in [-0.0004, 0.0, 0.0003] {
            let contact = surface.contact_at(place);
            let out = contact.point + contact.normal.into_inner() * 0.012;
            assert_relative_eq!(surface.place_m(&out), place, epsilon = 1e-12);
        }
    }
}

#[test]
fn the_nearest_contact_stays_on_the_usable_part() {
    let far = side().nearest(&Point2::new(-0.02, 0.5));
    assert_relative_eq!(far.point, Point2::new(-0.006, 0.024), epsilon = ROUNDING_M);
    // half a radian to the right of the bottom, seen from the center
    let right = Point2::new(0.03 * 0.5_f64.sin(), 0.03 - 0.03 * 0.5_f64.cos());
    for point in [Point2::new(0.029, 0.029), Point2::new(1.0, 0.0), Point2::new(0.01, 0.06)] {
        assert_relative_eq!(hollow().nearest(&point).point, right, epsilon = ROUNDING_M);
    }
}

#[test]
fn no_usable_contact_of_an_arc_is_nearer_than_the_nearest() {
    for surface in [head(), hollow()] {
        let half = surface.length_m() / 2.0;
        for point in [[0.0, 0.05], [0.003, 0.031], [-0.02, 0.01], [0.004, 0.029], [0.01, 0.055]] {
            let point = Point2::from(point);
            let found = (surface.nearest(&point).point - point).norm();
            let all = (-50..=50).map(|k| surface.contact_at(half * f64::from(k) / 50.0));
            let least = all.map(|contact| (contact.point - point).norm()).fold(f64::INFINITY, f64::min);
            assert!(found <= least + ROUNDING_M, "{}: {found} {least}", surface.name);
        }
    }
}

#[test]
fn surfaces_that_are_none_are_refused_by_field() {
    let field = |shape| ContactSurface::new("none", shape).validate().unwrap_err().field;
    let face = |start_m, end_m| field(SurfaceShape::Face { start_m, end_m });
    assert_eq!(face([0.0, f64::NAN], [1.0, 0.0]), "shape.face.start_m");
    assert_eq!(face([0.0, 0.0], [f64::INFINITY, 0.0]), "shape.face.end_m");
    assert_eq!(face([1.0, 2.0], [1.0, 2.0]), "shape.face.end_m");
    let arc = |center_m, radius_m, direction_rad, half_angle_rad| {
        field(SurfaceShape::Arc { center_m, radius_m, direction_rad, half_angle_rad })
    };
    assert_eq!(arc([f64::NAN, 0.0], 1.0, 0.0, 0.1), "shape.arc.center_m");
    assert_eq!(arc([0.0, 0.0], 0.0, 0.0, 0.1), "shape.arc.radius_m");
    assert_eq!(arc([0.0, 0.0], f64::INFINITY, 0.0, 0.1), "shape.arc.radius_m");
    assert_eq!(arc([0.0, 0.0], 1.0, f64::NAN, 0.1), "shape.arc.direction_rad");
    for half_angle_rad in [-0.1, 0.0, 3.2, f64::NAN] {
        assert_eq!(arc([0.0, 0.0], 1.0, 0.0, half_angle_rad), "shape.arc.half_angle_rad");
    }
    assert_eq!((side().validate(), head().validate(), hollow().validate()), (Ok(()), Ok(()), Ok(())));
}
