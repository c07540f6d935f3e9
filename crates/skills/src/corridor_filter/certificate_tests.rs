//! Certificates: what is crossed between samples is found, and closed forms are met.

use approx::assert_abs_diff_eq;
use nalgebra::{DMatrix, dmatrix, dvector};

use super::*;
use crate::corridor::Bounds;
use crate::trajectory::Trajectory;

/// The bound of a least value is tight to 1e-9 of numbers of order one.
const TIGHT: f64 = 1e-8;

// the parabola t(1 − t) from sample to sample, its peak of 1/4 in the middle of the only step
fn arch() -> Rollout {
    let positions = Trajectory::new(vec![0.0, 1.0], dmatrix![0.0; 0.0]).unwrap();
    Rollout::new(positions, dmatrix![1.0; -1.0], dmatrix![-2.0; -2.0]).unwrap()
}

#[test]
fn a_bound_that_is_crossed_between_the_samples_only_is_found() {
    let crossed = certify(&arch(), &Corridor::still(&[-1.0], &[0.2]).unwrap(), &dvector![0.5]).unwrap();
    assert!(crossed.holds_at_samples() && !crossed.holds());
    assert_abs_diff_eq!(crossed.axes[0].upper.at_samples, 0.2);
    assert_abs_diff_eq!(crossed.axes[0].upper.at_all_times, 0.2 - 0.25, epsilon = TIGHT);
    // the peak is flat: its time is known to the root of the tolerance only
    assert_abs_diff_eq!(crossed.axes[0].upper.at_all_times_time_s, 0.5, epsilon = 1e-4);
    assert_abs_diff_eq!(crossed.axes[0].lower.at_all_times, 1.0, epsilon = TIGHT);
    assert_eq!((crossed.goal_error(), crossed.peak_acceleration(), crossed.samples_outside()), (0.5, 2.0, 0));
    let kept = certify(&arch(), &Corridor::still(&[-1.0], &[0.26]).unwrap(), &dvector![0.0]).unwrap();
    assert!(kept.holds());
    assert_abs_diff_eq!(kept.smallest_margin(), 0.01, epsilon = TIGHT);
}

#[test]
fn bounds_that_move_between_the_samples_of_the_motion_are_found() {
    // a bump of the lower bound to 0.3 about t = 0.5, over the arch, with samples of its own
    let times = vec![0.0, 0.4, 0.5, 0.6, 1.0];
    let corridor = Corridor::sampled(times, 1, |time_s, _| {
        let position = if time_s == 0.5 { 0.3 } else { -1.0 };
        Bounds { lower: PathState { position, ..PathState::default() }, ..Bounds::still(-1.0, 1.0) }
    });
    let found = certify(&arch(), &corridor.unwrap(), &dvector![0.0]).unwrap();
    assert_abs_diff_eq!(found.axes[0].lower.at_all_times, 0.25 - 0.3, epsilon = TIGHT);
    assert!(!found.holds() && found.holds_at_samples());
}

#[test]
fn samples_on_or_outside_a_bound_are_counted_and_never_hold() {
    let found = certify(&arch(), &Corridor::still(&[0.0], &[1.0]).unwrap(), &dvector![0.0]).unwrap();
    assert_eq!(found.samples_outside(), 2);
    assert!(!found.holds() && !found.holds_at_samples());
}

#[test]
fn other_numbers_of_coordinates_are_refused() {
    let wide = Corridor::still(&[0.0, 0.0], &[1.0, 1.0]).unwrap();
    assert!(certify(&arch(), &wide, &dvector![0.0]).is_err());
    assert!(certify(&arch(), &Corridor::still(&[0.0], &[1.0]).unwrap(), &dvector![0.0, 0.0]).is_err());
}

#[test]
fn each_coordinate_has_a_certificate_of_its_own() {
    let positions = Trajectory::new(vec![0.0, 1.0], dmatrix![0.0, 0.0; 0.0, 3.0]).unwrap();
    let still = DMatrix::zeros(2, 2);
    let motion = Rollout::new(positions, still.clone(), still).unwrap();
    let corridor = Corridor::still(&[-1.0, -1.0], &[1.0, 2.0]).unwrap();
    let found = certify(&motion, &corridor, &dvector![0.0, 0.0]).unwrap();
    assert!(found.axes[0].holds() && !found.axes[1].holds());
    assert_abs_diff_eq!(found.axes[1].upper.at_all_times, -1.0, epsilon = TIGHT);
    assert_eq!((found.axes[1].samples_outside, found.axes[1].upper.at_all_times_time_s), (1, 1.0));
}
