//! Passages: voted by demonstrations, set by the user, of several obstacles; and corridors that keep the margin.

use nalgebra::Isometry2;
use proptest::prelude::*;

use super::super::fixtures::{DISC, block, ell, workplace};
use super::*;
use crate::outline::{Outline, separation_m};

/// A path through places at equal times.
fn path(places: &[[f64; 2]]) -> Trajectory {
    let rows = (places.len() - 1) * 100 + 1;
    let at = |row: usize| {
        let (piece, share) = ((row / 100).min(places.len() - 2), row as f64 / 100.0);
        let share = share - piece as f64;
        let [a, b] = [places[piece], places[piece + 1]];
        [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share]
    };
    let times_s = (0..rows).map(|row| row as f64 * 0.02).collect();
    Trajectory::new(times_s, DMatrix::from_fn(rows, 2, |row, axis| at(row)[axis])).unwrap()
}

fn shown(places: &[[f64; 2]]) -> Vec<Point2<f64>> {
    points(&path(places))
}

const BELOW: [[f64; 2]; 3] = [[0.06, 0.08], [0.0, 0.05], [-0.055, 0.11]];
const ABOVE: [[f64; 2]; 3] = [[0.06, 0.08], [0.0, 0.15], [-0.055, 0.11]];

#[test]
fn the_side_is_set_else_voted_by_demonstrations_else_that_of_the_path() {
    let (tool, obstacles) = (ell(), [block(0.03, 0.04, [0.0, 0.10])]);
    let place = workplace(&tool, &DISC, &obstacles);
    let side = |demonstrations: &[Vec<Point2<f64>>], set: &[Option<Side>]| {
        passages(&place, &path(&BELOW), demonstrations, set).iter().map(|passage| passage.side).collect::<Vec<_>>()
    };
    assert_eq!(side(&[], &[]), [Side::Below]);
    assert_eq!(side(&[shown(&ABOVE), shown(&ABOVE), shown(&BELOW)], &[]), [Side::Above]);
    // a tie is left to the path
    assert_eq!(side(&[shown(&ABOVE), shown(&BELOW)], &[None]), [Side::Below]);
    assert_eq!(side(&[shown(&BELOW)], &[Some(Side::Above)]), [Side::Above]);
    // a path that comes to neither end of it nor into it passes nothing
    assert!(passages(&place, &path(&[[0.06, 0.02], [0.06, 0.06]]), &[], &[]).is_empty());
}

#[test]
fn two_obstacles_are_passed_on_opposite_sides() {
    let tool = ell();
    let obstacles = [block(0.02, 0.04, [0.03, 0.11]), block(0.02, 0.04, [-0.03, 0.05])];
    let place = Workplace { object_margin_m: 0.005, ..workplace(&tool, &DISC, &obstacles) };
    let path = path(&[[0.07, 0.08], [0.03, 0.05], [-0.03, 0.11], [-0.07, 0.08]]);
    let found = passages(&place, &path, &[], &[]);
    let expected = [Passage { obstacle: 0, side: Side::Below }, Passage { obstacle: 1, side: Side::Above }];
    assert_eq!(found, expected);
    let made = corridor(&place, &path, &found, &SmoothingConfig::default()).unwrap();
    assert!(made.floored.is_empty());
    // beside the first one 12 + 5 mm below it, beside the second one 12 + 5 mm above it
    let (first, second) = (made.corridor.at(2.0, 1), made.corridor.at(4.0, 1));
    assert!((first.upper.position - 0.073).abs() < 1e-12 && (second.lower.position - 0.087).abs() < 1e-12);
}

#[test]
fn an_obstacle_beside_the_goal_is_kept_on_the_side_of_the_goal() {
    let (tool, obstacles) = (ell(), [block(0.03, 0.04, [0.0, 0.10])]);
    let place = workplace(&tool, &DISC, &obstacles);
    // to the right of the block and up, the goal below it: the straight way cuts its corner
    let found = passages(&place, &path(&[[0.05, 0.12], [0.0, 0.05]]), &[], &[]);
    assert_eq!(found.len(), 1);
    assert!(matches!(found[0].side, Side::Right | Side::Below), "{found:?}");
    // the goal lies below, where only that side keeps it
    let found = passages(&place, &path(&[[0.02, 0.04], [0.0, 0.06], [-0.01, 0.04]]), &[], &[]);
    assert_eq!(found, [Passage { obstacle: 0, side: Side::Below }]);
}

proptest! {
    #[test]
    fn what_is_inside_the_corridor_beside_an_obstacle_keeps_the_margin(
        sizes in [0.01f64..0.03, 0.01f64..0.03], angle_rad in -1.5f64..1.5, square in any::<bool>(), above in any::<bool>(),
        share in 0.0f64..1.0,
    ) {
        let tool = ell();
        let object = if square { Outline::Box { width_m: 0.024, height_m: 0.016 } } else { DISC };
        let obstacles = [PlacedOutline { angle_rad, ..block(sizes[0], sizes[1], [0.0, 0.09]) }];
        let place = Workplace { object_angle_rad: 0.3, ..workplace(&tool, &object, &obstacles) };
        let path = path(if above { &ABOVE } else { &BELOW });
        let found = passages(&place, &path, &[], &[]);
        prop_assert_eq!(found.len(), 1);
        let made = corridor(&place, &path, &found, &SmoothingConfig::default()).unwrap();
        prop_assume!(made.floored.is_empty());
        for (row, time_s) in path.times_s().iter().enumerate() {
            let bounds = made.corridor.at(*time_s, 1);
            let y = bounds.lower.position + share * (bounds.upper.position - bounds.lower.position);
            let center = Isometry2::new(nalgebra::Vector2::new(path.samples()[(row, 0)], y), 0.3);
            let apart_m = separation_m(&object, &center, &obstacles[0].shape, &obstacles[0].pose()).unwrap();
            prop_assert!(apart_m >= place.object_margin_m - 1e-9, "{apart_m} at {time_s} s");
        }
    }
}
