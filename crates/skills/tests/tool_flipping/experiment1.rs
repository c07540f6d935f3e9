//! The flips of the paper's first experiment: the L-shaped tool round a disc of 12 mm, from bottom to tip to top.

use approx::assert_relative_eq;
use nalgebra::{Point2, Vector2};
use skills::tool_flipping::{FlipError, FlipOptions, SecondFactor, WayRound};

use super::scenes::{BOTTOM, TIP, TOP, disc, l_tool, number, numbers, task, vectors};

/// Both programs work in double precision; numbers of the file are in cm.
const VECTORS_CM: f64 = 1e-9;
/// Certified bounds lie at most this far below what they bound, m.
const BOUND_M: f64 = 2e-6;

/// Touching allowed, as in the reference.
fn options(k2: SecondFactor) -> FlipOptions {
    FlipOptions { least_clearance_m: 0.0, k2, ..FlipOptions::default() }
}

#[test]
fn distances_from_the_concave_tool_agree_with_the_reference() {
    let (tool, file) = (l_tool(), vectors());
    let points = file["signed_distance"]["points"].as_array().unwrap();
    for (point, expected) in points.iter().zip(numbers(&file["signed_distance"]["sd"])) {
        let point = Point2::from_slice(&numbers(point)) / 100.0;
        assert_relative_eq!(100.0 * tool.signed_distance_m(&point), expected, epsilon = VECTORS_CM);
    }
    // the file's polygon has its corners on the outline of the pieces
    for corner in file["tool2_polygon"].as_array().unwrap() {
        let corner = Point2::from_slice(&numbers(corner)) / 100.0;
        assert_relative_eq!(tool.signed_distance_m(&corner), 0.0, epsilon = 1e-15);
    }
}

#[test]
fn enlarging_k2_does_not_free_a_bulge_that_leaves_the_contact_sideways() {
    let tool = l_tool();
    let sideways = Vector2::new(-1.0, -1.0) / 2f64.sqrt();
    let (a, b) = (Point2::new(-2.65, -1.8), Point2::new(-4.6, 0.0));
    let clearance_cm = |k2: f64, z: f64| {
        let place = a + (b - a) * z + sideways * (k2 * 16.0 * (z * (1.0 - z)).powi(2) * 1.2);
        100.0 * tool.signed_distance_m(&(place / 100.0)) - 1.2
    };
    for row in vectors()["k2_scan"].as_array().unwrap() {
        let (k2, expected) = (number(&row[0]), number(&row[1]));
        let least = (20..=1980).map(|k| clearance_cm(k2, f64::from(k) / 2000.0)).fold(f64::INFINITY, f64::min);
        assert_relative_eq!(least, expected, epsilon = VECTORS_CM);
        // it gets better with k2 and never good
        assert!(least < -0.05);
    }
}

#[test]
fn a_straight_flip_runs_through_the_tool_and_the_refusal_says_how_deep() {
    let (tool, object) = (l_tool(), disc());
    for (from, to, depth_m) in [(BOTTOM, TIP, 0.0083), (TIP, TOP, 0.0090)] {
        let refused = task(&tool, &object, from, to).flip(&options(SecondFactor::Fixed(0.0))).unwrap_err();
        let FlipError::Collides { k2, clearance_m, .. } = refused else { panic!("{refused}") };
        assert_eq!(k2, 0.0);
        assert_relative_eq!(clearance_m, -depth_m, epsilon = 5e-5);
    }
}

#[test]
fn the_whole_virtual_movement_is_clear_and_the_smallest_factor_about_seven_tenths() {
    let (tool, object) = (l_tool(), disc());
    for (from, to, k2) in [(BOTTOM, TIP, 0.71), (TIP, TOP, 0.73)] {
        let task = task(&tool, &object, from, to);
        let whole = task.flip(&options(SecondFactor::Fixed(1.0))).unwrap();
        println!("k2 = 1: {:?}, {:.4} m", whole.certificate, whole.virtual_length_m);
        assert!(whole.certificate.smallest_clearance_m >= -BOUND_M);
        assert!(whole.certificate.middle_clearance_m >= 0.0033);
        let smallest = task.flip(&options(SecondFactor::Smallest)).unwrap();
        println!("smallest: {} {:?}", smallest.k2, smallest.certificate);
        // another curve round the tool than the reference's search on a grid, so another factor, but near
        assert_relative_eq!(smallest.k2, k2, epsilon = 0.06);
        // nothing smaller will do
        let fixed = |k2| options(SecondFactor::Fixed(k2));
        for share in [0.5, 0.9, 0.99] {
            assert!(matches!(task.flip(&fixed(share * smallest.k2)), Err(FlipError::Collides { .. })));
        }
        assert!(task.flip(&fixed(1.2)).is_ok());
    }
}

#[test]
fn flips_begin_and_end_exactly_in_contact_and_at_rest() {
    let (tool, object) = (l_tool(), disc());
    let task = task(&tool, &object, BOTTOM, TIP);
    let flip = task.flip(&FlipOptions::default()).unwrap();
    let track = flip.tool_track(0.01).unwrap();
    let center = Point2::from(task.object_world.translation.vector);
    for (motion, contact) in [(track.start(), task.contacts[0]), (track.end(), task.contacts[1])] {
        let expected = tool.pose_touching(&contact, &center, 0.012, 0.0, 0.0);
        assert_relative_eq!(motion.point().coords, expected.translation.vector, epsilon = 1e-15);
        assert_relative_eq!(motion.velocity.norm(), 0.0, epsilon = 1e-15);
        // the second derivative of a cubic through mj is off by h²/12·360·length at its end
        assert_relative_eq!(motion.acceleration.norm(), 0.0, epsilon = 1e-5);
    }
    assert_eq!(track.motions().len(), 201);
    assert!(flip.certificate.contact_clearances_m.iter().all(|clearance_m| clearance_m.abs() < 1e-15));
}

#[test]
fn either_way_round_the_tool_can_be_asked_for() {
    let (tool, object) = (l_tool(), disc());
    let length = |way_round| {
        let options = FlipOptions { way_round, ..FlipOptions::default() };
        let flip = task(&tool, &object, BOTTOM, TIP).flip(&options).unwrap();
        (flip.virtual_length_m, flip.way_round)
    };
    let (short_m, taken) = length(WayRound::Shorter);
    assert_eq!(taken, WayRound::Clockwise);
    assert_eq!(length(WayRound::Clockwise), (short_m, WayRound::Clockwise));
    let (long_m, _) = length(WayRound::Counterclockwise);
    // the rest of the way round an L of 40 x 40 mm, at 15.5 mm from it
    assert!(long_m > 0.12 && short_m < 0.06, "{short_m} {long_m}");
}
