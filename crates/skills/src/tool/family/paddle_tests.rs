//! Tests of the paddle.

use super::*;
use crate::tool::Tool;
use crate::tool::family::tests::{area_m2, tool, top_arc};
use approx::assert_relative_eq;

/// A few roundings of lengths of some centimeters.
const ROUNDING_M: f64 = 1e-15;
/// Rounding of lengths a thousand times larger.
const ROUNDING_OF_FAR_CENTERS_M: f64 = 1e-12;

fn concave(radius_m: f64) -> Paddle {
    Paddle { face: PaddleFace::Concave { radius_m }, ..Paddle::default() }
}

fn convex(radius_m: f64) -> Paddle {
    Paddle { face: PaddleFace::Convex { radius_m }, ..Paddle::default() }
}

/// Area between a chord of 40 mm and its arc of 30 mm, m², and the distance of its centroid from the arc's center, m.
fn segment() -> (f64, f64) {
    let angle_rad = 2.0 * (0.020_f64 / 0.030).asin();
    let area_m2 = 0.5 * 0.030 * 0.030 * (angle_rad - angle_rad.sin());
    (area_m2, 0.040_f64.powi(3) / (12.0 * area_m2))
}

/// Height of that segment, m.
fn rise_m() -> f64 {
    0.030 - (0.030_f64 * 0.030 - 0.020 * 0.020).sqrt()
}

/// Asserts area and height of the centroid to what chords leave out: two thirds of their error times the arc's length.
fn assert_weighs(tool: &Tool, expected_m2: f64, height_m: f64) {
    let left_out_m2 = 2.0 / 3.0 * CHORD_ERROR_M * 2.0 * 0.030 * (0.020_f64 / 0.030).asin();
    assert_relative_eq!(area_m2(tool), expected_m2, epsilon = left_out_m2);
    assert_relative_eq!(tool.centroid().x, 0.0, epsilon = ROUNDING_M);
    assert_relative_eq!(tool.centroid().y, height_m, epsilon = 0.02 * left_out_m2 / expected_m2);
}

#[test]
fn the_default_paddle_is_a_plate_of_40_by_10_mm() {
    assert_weighs(&tool(&Paddle::default()), 400e-6, 0.005);
}

#[test]
fn a_hollow_is_cut_out_and_a_bulge_put_on() {
    let (segment_m2, from_center_m) = segment();
    let rim_m = 0.010 + rise_m();
    let hollow_m2 = 0.040 * rim_m - segment_m2;
    let moment = 0.040 * rim_m * rim_m / 2.0 - segment_m2 * (0.040 - from_center_m);
    assert_weighs(&tool(&concave(0.030)), hollow_m2, moment / hollow_m2);
    let bulge_m2 = 400e-6 + segment_m2;
    let center_m = 0.010 + rise_m() - 0.030;
    let moment = 400e-6 * 0.005 + segment_m2 * (center_m + from_center_m);
    assert_weighs(&tool(&convex(0.030)), bulge_m2, moment / bulge_m2);
}

#[test]
fn the_normals_of_a_hollow_point_to_its_center() {
    for radius_m in [0.022, 0.030, 0.040, 5.0] {
        let hollow = tool(&concave(radius_m));
        let face = &hollow.surfaces[0];
        assert_eq!(face.curvature_radius_m(), -radius_m);
        for share in [-0.5, -0.3, 0.0, 0.2, 0.5] {
            let contact = face.contact_at(share * face.length_m());
            let center = contact.point + contact.normal.into_inner() * radius_m;
            assert_relative_eq!(center, Point2::new(0.0, 0.010 + radius_m), epsilon = ROUNDING_OF_FAR_CENTERS_M);
        }
    }
}

#[test]
fn chords_stay_within_their_error_of_the_arc() {
    for paddle in [concave(0.022), concave(0.030), concave(1.0), convex(0.022), convex(0.030), convex(10.0)] {
        let tool = tool(&paddle);
        let face = &tool.surfaces[0];
        let off = |k: i32| {
            let place_m = face.length_m() * f64::from(k) / 400.0;
            tool.signed_distance_m(&face.contact_at(place_m).point).abs()
        };
        let worst = (-200..=200).map(off).fold(0.0, f64::max);
        assert!(worst <= CHORD_ERROR_M + ROUNDING_OF_FAR_CENTERS_M, "{paddle:?}: {worst}");
    }
}

#[test]
fn a_hollow_of_30_mm_takes_some_tens_of_pieces_and_a_bulge_one() {
    // chords of 2 acos(1 - 0.02/30) = 0.073 rad over 2 asin(20/30) = 1.46 rad
    assert_eq!(concave(0.030).pieces().len(), 20);
    assert_eq!(convex(0.030).pieces().len(), 1);
}

#[test]
fn the_face_ends_a_margin_before_its_rims() {
    let (center_m, radius_m, half_angle_rad) = top_arc(&tool(&convex(0.030)).surfaces[0]);
    assert_relative_eq!(center_m[1], 0.010 + rise_m() - 0.030, epsilon = ROUNDING_M);
    assert_relative_eq!(half_angle_rad, (0.020_f64 / 0.030).asin() - 0.001 / radius_m, epsilon = ROUNDING_M);
}

#[test]
fn lengths_that_make_no_paddle_are_refused_by_name() {
    let refused = |paddle: Paddle| paddle.validate().unwrap_err();
    let paddle = Paddle::default;
    assert_eq!(refused(Paddle { width_m: 0.0, ..paddle() }).field, "width_m");
    assert_eq!(refused(Paddle { thickness_m: 0.0024, ..paddle() }).field, "thickness_m");
    assert_eq!(refused(Paddle { edge_margin_m: f64::NAN, ..paddle() }).field, "edge_margin_m");
    assert_eq!(refused(Paddle { edge_margin_m: 0.02, ..paddle() }).field, "width_m");
    for radius_m in [-0.03, 0.0, 0.021, 11.0, f64::NAN] {
        assert_eq!(refused(concave(radius_m)).field, "face.concave.radius_m");
        assert_eq!(refused(convex(radius_m)).field, "face.convex.radius_m");
    }
    assert!(refused(convex(11.0)).expected.contains("flat"));
}
