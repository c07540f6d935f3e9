//! Tests of tool files.

use super::*;
use crate::outline::Outline;
use crate::tool::SurfaceShape;
use crate::tool::family::{Ell, Paddle, PaddleFace, ToolShape};
use approx::assert_relative_eq;
use nalgebra::{Point2, Rotation2};

/// A few roundings of lengths of some centimeters.
const ROUNDING_M: f64 = 1e-15;

fn read(text: &str) -> ToolFile {
    serde_json::from_str(text).unwrap()
}

fn ell(grip: Grip) -> ToolFile {
    ToolFile { grip, ..read(r#"{"name": "l", "mass_kg": 0.01, "friction": 0.3, "family": {"l": {}}}"#) }
}

/// A bar of 40 x 10 mm about its own origin that pushes with its upper side.
fn bar() -> ToolFile {
    let shape = Outline::Box { width_m: 0.04, height_m: 0.01 };
    let face = SurfaceShape::Face { start_m: [0.02, 0.005], end_m: [-0.02, 0.005] };
    ToolFile {
        family: None,
        pieces: vec![PlacedOutline { shape, position_m: [0.0, 0.0], angle_rad: 0.0 }],
        surfaces: vec![ContactSurface::new("top", face)],
        ..ell(Grip::default())
    }
}

#[test]
fn without_a_grip_pieces_and_surfaces_are_taken_as_they_stand() {
    let tool = bar().tool().unwrap();
    assert_eq!((tool.pieces, tool.surfaces), (bar().pieces, bar().surfaces));
    let tool = ell(Grip::default()).tool().unwrap();
    let shape = Ell::default();
    assert_eq!((tool.pieces, tool.surfaces), (shape.pieces(), shape.surfaces()));
}

#[test]
fn a_grip_moves_outline_and_surfaces_alike() {
    let grip = Grip { position_m: [0.03, -0.01], angle_rad: 0.7 };
    let hollow = Paddle { face: PaddleFace::Concave { radius_m: 0.030 }, ..Paddle::default() };
    for family in [ToolFamily::L(Ell::default()), ToolFamily::Paddle(hollow)] {
        let file = ToolFile { family: Some(family), ..ell(Grip::default()) };
        let own = file.tool().unwrap();
        let held = ToolFile { grip, ..file }.tool().unwrap();
        assert_eq!(held.validate(), Ok(()));
        let pose = grip.actuator_from_tool();
        assert_relative_eq!(held.centroid(), pose * own.centroid(), epsilon = ROUNDING_M);
        for (moved, surface) in held.surfaces.iter().zip(&own.surfaces) {
            for share in [-0.5, 0.0, 0.3] {
                let (seen, before) =
                    (moved.contact_at(share * moved.length_m()), surface.contact_at(share * surface.length_m()));
                assert_relative_eq!(seen.point, pose * before.point, epsilon = ROUNDING_M);
                let normal = Rotation2::new(0.7) * before.normal.into_inner();
                assert_relative_eq!(seen.normal.into_inner(), normal, epsilon = ROUNDING_M);
            }
        }
        let point = Point2::new(0.011, 0.052);
        let distance_m = own.signed_distance_m(&point);
        assert_relative_eq!(held.signed_distance_m(&(pose * point)), distance_m, epsilon = ROUNDING_M);
    }
}

#[test]
fn a_quarter_turn_in_the_grip_makes_the_top_of_the_l_push_to_the_left() {
    let grip = Grip { position_m: [0.1, 0.2], angle_rad: std::f64::consts::FRAC_PI_2 };
    let top = &ell(grip).tool().unwrap().surfaces[2];
    // (-24, 6) mm turned to (-6, -24) mm
    assert_relative_eq!(top.middle().point, Point2::new(0.094, 0.176), epsilon = ROUNDING_M);
    assert_relative_eq!(top.middle().normal.into_inner(), -Vector2::x(), epsilon = ROUNDING_M);
}

#[test]
fn a_file_states_either_a_family_or_pieces() {
    let field = |file: ToolFile| file.tool().unwrap_err().field;
    let nothing = ToolFile { family: None, ..ell(Grip::default()) };
    assert_eq!(field(nothing.clone()), "pieces");
    assert_eq!(field(ToolFile { surfaces: bar().surfaces, ..nothing }), "pieces");
    assert_eq!(field(ToolFile { surfaces: Vec::new(), ..bar() }), "surfaces");
    assert_eq!(field(ToolFile { pieces: bar().pieces, ..ell(Grip::default()) }), "pieces");
    assert_eq!(field(ToolFile { surfaces: bar().surfaces, ..ell(Grip::default()) }), "surfaces");
}

#[test]
fn what_makes_no_tool_is_named_by_its_key() {
    let field = |file: ToolFile| file.tool().unwrap_err().field;
    assert_eq!(field(ToolFile { mass_kg: 0.0, ..bar() }), "mass_kg");
    assert_eq!(field(ToolFile { friction: f64::NAN, ..bar() }), "friction");
    let grip = |position_m, angle_rad| ToolFile { grip: Grip { position_m, angle_rad }, ..bar() };
    assert_eq!(field(grip([30.0, 0.0], 0.0)), "grip.position_m");
    assert_eq!(field(grip([0.0, f64::NAN], 0.0)), "grip.position_m");
    assert_eq!(field(grip([0.0, 0.0], f64::INFINITY)), "grip.angle_rad");
    let mut file = bar();
    file.pieces[0].shape = Outline::Disc { radius_m: 0.0 };
    assert_eq!(field(file), "pieces.0.shape.disc.radius_m");
}

#[test]
fn unknown_keys_and_families_are_refused() {
    let refused = |text: &str| serde_json::from_str::<ToolFile>(text).unwrap_err().to_string();
    let file = |rest: &str| format!(r#"{{"name": "x", "mass_kg": 0.01, "friction": 0.3, {rest}}}"#);
    assert!(refused(&file(r#""familly": {}"#)).contains("unknown field `familly`"));
    assert!(refused(&file(r#""family": {"spoon": {}}"#)).contains("unknown variant `spoon`"));
    assert!(refused(&file(r#""family": {"hook": {"throat": 0.03}}"#)).contains("unknown field `throat`"));
}
