//! What is certified holds: between the samples, for discs, boxes and polygons, with and without turning.

use nalgebra::{Isometry2, Vector2};
use proptest::prelude::*;
use skills::outline::{Outline, separation_m};
use skills::tool::Tool;
use skills::tool_flipping::{Flip, FlipError, FlipOptions, FlipTask, SecondFactor, WayRound};

use super::scenes::{BOTTOM, TIP, TOP, disc, l_tool, pentagon, square, stick, task};

/// Looks along a flip, ten times as many as a way has pieces.
const LOOKS: usize = 4000;
/// Accuracy of the other program's penetration depths and distances, m.
const OTHER_PROGRAM_M: f64 = 1e-8;

/// The smallest separation of tool and object over a flip, by outlines in the world.
fn looked_at_m(flip: &Flip, task: &FlipTask<'_>) -> f64 {
    let mut smallest_m = f64::INFINITY;
    for look in 0..=LOOKS {
        let tool_world = flip.tool_in_world(flip.duration_s() * look as f64 / LOOKS as f64).pose();
        for piece in &task.tool.pieces {
            let pose = tool_world * piece.pose();
            let apart_m = separation_m(&piece.shape, &pose, task.object, &task.object_world).unwrap();
            smallest_m = smallest_m.min(apart_m);
        }
    }
    smallest_m
}

/// Accuracy of the clearance reported for the middle, above the contact tolerance, m.
const REPORTED_M: f64 = 1.1e-5;

#[test]
fn discs_boxes_and_polygons_flip_with_and_without_turning() {
    let (tools, objects) = ([l_tool(), stick()], [disc(), square(), pentagon()]);
    for tool in &tools {
        for object in &objects {
            for (from, to) in [(0, 1), (1, 0), (1, tool.surfaces.len() - 1)] {
                for tool_angles_rad in [[0.0, 0.0], [0.3, -1.2], [0.0, 3.0]] {
                    let task = FlipTask { tool_angles_rad, ..task(tool, object, from, to) };
                    let flip = task.flip(&FlipOptions::default()).unwrap_or_else(|error| panic!("{error}"));
                    let seen_m = looked_at_m(&flip, &task);
                    let told_m = flip.certificate.smallest_clearance_m;
                    assert!(told_m >= -1e-6 && seen_m >= told_m - OTHER_PROGRAM_M, "{told_m} {seen_m}");
                    let end_rad = flip.tool_in_world(flip.duration_s()).position.z;
                    assert!((end_rad - tool_angles_rad[1]).abs() < 1e-12);
                }
            }
        }
    }
}

#[test]
fn the_clearance_required_is_kept_between_the_contacts() {
    let (tool, object) = (l_tool(), disc());
    for least_clearance_m in [0.0, 0.001, 0.002] {
        let options = FlipOptions { least_clearance_m, ..FlipOptions::default() };
        let flip = task(&tool, &object, BOTTOM, TIP).flip(&options).unwrap();
        assert!(flip.certificate.middle_clearance_m >= least_clearance_m - REPORTED_M);
    }
}

#[test]
fn a_tool_track_between_its_samples_keeps_what_is_certified() {
    let (tool, object) = (l_tool(), disc());
    let task = task(&tool, &object, TIP, TOP);
    let flip = task.flip(&FlipOptions::default()).unwrap();
    let track = flip.tool_track(0.02).unwrap();
    for look in 0..=LOOKS {
        let time_s = flip.duration_s() * look as f64 / LOOKS as f64;
        let off_m = (track.at(time_s).point() - flip.tool_in_world(time_s).point()).norm();
        // cubic pieces of 20 ms through places and velocities of a flip of 2 s
        assert!(off_m < 1e-5, "{off_m} at {time_s}");
    }
}

#[test]
fn velocities_and_accelerations_are_those_of_the_tool() {
    let (tool, object) = (l_tool(), square());
    let task = FlipTask { tool_angles_rad: [0.2, -0.9], ..task(&tool, &object, TIP, TOP) };
    let flip = task.flip(&FlipOptions::default()).unwrap();
    let step = 1e-6;
    for time_s in [0.2001, 0.6103, 1.0007, 1.4411, 1.8013] {
        let at = |time_s| flip.tool_in_world(time_s);
        let velocity = (at(time_s + step).position - at(time_s - step).position) / (2.0 * step);
        let acceleration = (at(time_s + step).velocity - at(time_s - step).velocity) / (2.0 * step);
        assert!((velocity - at(time_s).velocity).norm() < 1e-8);
        assert!((acceleration - at(time_s).acceleration).norm() < 1e-5);
    }
}

#[test]
fn refusals_say_what_is_in_the_way() {
    let (tool, object) = (l_tool(), disc());
    let good = task(&tool, &object, BOTTOM, TIP);
    // an object too wide for the hollow of the L at the middle of the bottom
    let wide = Outline::Disc { radius_m: 0.025 };
    assert!(matches!(
        task(&tool, &wide, BOTTOM, TIP).flip(&FlipOptions::default()),
        Err(FlipError::ContactOverlaps { end: "first", .. })
    ));
    let strict = FlipOptions { least_clearance_m: 0.00349, k2: SecondFactor::Fixed(1.0), ..FlipOptions::default() };
    let error = good.flip(&strict).unwrap_err();
    assert!(matches!(error, FlipError::Collides { .. }) && error.to_string().contains("raise margin_m"), "{error}");
    for broken in [
        FlipOptions { margin_m: 0.0, ..FlipOptions::default() },
        FlipOptions { least_clearance_m: 0.01, ..FlipOptions::default() },
        FlipOptions { largest_k2: 0.5, ..FlipOptions::default() },
        FlipOptions { k2: SecondFactor::Fixed(f64::NAN), ..FlipOptions::default() },
        FlipOptions { contact_tolerance_m: 0.0, ..FlipOptions::default() },
    ] {
        assert!(matches!(good.flip(&broken), Err(FlipError::Skill(_))));
    }
    assert!(FlipTask { duration_s: 0.0, ..good }.flip(&FlipOptions::default()).is_err());
    assert!(FlipTask { tool_angles_rad: [0.0, f64::NAN], ..good }.flip(&FlipOptions::default()).is_err());
    let nothing = Outline::Polygon { vertices_m: vec![] };
    assert!(task(&tool, &nothing, BOTTOM, TIP).flip(&FlipOptions::default()).is_err());
    let flip = good.flip(&FlipOptions::default()).unwrap();
    assert!(flip.tool_track(0.0).is_err() && flip.tool_track(1e-9).is_err() && flip.tool_track(f64::NAN).is_err());
}

fn tool(kind: usize) -> Tool {
    if kind == 0 { l_tool() } else { stick() }
}

fn object(kind: usize, size: f64) -> Outline {
    match kind {
        0 => Outline::Disc { radius_m: 0.010 * size },
        1 => Outline::Box { width_m: 0.018 * size, height_m: 0.009 * size },
        _ => match pentagon() {
            Outline::Polygon { vertices_m } => {
                Outline::Polygon { vertices_m: vertices_m.iter().map(|[x, y]| [x * size, y * size]).collect() }
            }
            other => other,
        },
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn random_flips_keep_what_is_certified_and_end_exactly(
        kinds in (0usize..2, 0usize..3), size in 0.5f64..1.2, surfaces in (0usize..3, 0usize..3),
        places in (-0.5f64..0.5, -0.5f64..0.5), angles in [-3.0f64..3.0, -3.0f64..3.0], turns in any::<bool>(),
        object_rad in -3.0f64..3.0, margin_m in 0.002f64..0.006, round in 0usize..3,
    ) {
        let (tool, object) = (tool(kinds.0), object(kinds.1, size));
        let contact = |surface: usize, place: f64| {
            let surface = &tool.surfaces[surface % tool.surfaces.len()];
            surface.contact_at(place * surface.length_m())
        };
        let task = FlipTask {
            object_world: Isometry2::new(Vector2::new(0.1, -0.2), object_rad),
            contacts: [contact(surfaces.0, places.0), contact(surfaces.1, places.1)],
            tool_angles_rad: if turns { angles } else { [angles[0]; 2] },
            ..task(&tool, &object, 0, 1)
        };
        let way_round = [WayRound::Shorter, WayRound::Counterclockwise, WayRound::Clockwise][round];
        let options = FlipOptions { margin_m, way_round, ..FlipOptions::default() };
        match task.flip(&options) {
            Ok(flip) => {
                let seen_m = looked_at_m(&flip, &task);
                prop_assert!(flip.certificate.smallest_clearance_m >= -options.contact_tolerance_m);
                prop_assert!(seen_m >= flip.certificate.smallest_clearance_m - OTHER_PROGRAM_M);
                // the object's origin lies on the normal of the contact, at both ends
                for (time_s, contact) in [(0.0, task.contacts[0]), (flip.duration_s(), task.contacts[1])] {
                    let offset = flip.object_in_tool(time_s).point() - contact.point;
                    prop_assert!(offset.perp(&contact.normal).abs() < 1e-12);
                    prop_assert!(flip.tool_in_world(time_s).velocity.norm() < 1e-12);
                }
            }
            // corners of a box beside a short surface, or in the hollow of the L
            Err(FlipError::ContactOverlaps { .. } | FlipError::NoRetreat { .. }) => {}
            Err(error) => prop_assert!(false, "{}", error),
        }
    }
}
