//! Tests of the trajectory: hand cases, exactness on polynomials, invariants.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use nalgebra::{DMatrix, dmatrix, dvector};
use proptest::prelude::*;

use super::*;

/// A few roundings of numbers of order one, divided by steps of order a tenth.
const ROUNDING: f64 = 1e-12;

fn parabola(times_s: &[f64]) -> Trajectory {
    let samples = DMatrix::from_fn(times_s.len(), 2, |row, column| {
        let t = times_s[row];
        if column == 0 { 1.0 + 2.0 * t + 3.0 * t * t } else { -t }
    });
    Trajectory::new(times_s.to_vec(), samples).unwrap()
}

#[test]
fn fewer_than_two_rows_are_refused() {
    let error = Trajectory::new(vec![0.0], dmatrix![1.0]).unwrap_err();
    assert!(matches!(error, SkillError::RowCount { found: 1, .. }));
}

#[test]
fn times_that_repeat_or_are_not_numbers_are_refused() {
    let repeated = Trajectory::new(vec![0.0, 1.0, 1.0], dmatrix![1.0; 2.0; 3.0]).unwrap_err();
    assert_eq!(repeated, SkillError::TimesNotIncreasing { row: 2, previous_s: 1.0, time_s: 1.0 });
    assert!(Trajectory::new(vec![f64::NAN, 1.0], dmatrix![1.0; 2.0]).is_err());
    assert!(Trajectory::new(vec![0.0, f64::INFINITY], dmatrix![1.0; 2.0]).is_err());
}

#[test]
fn a_sample_that_is_not_a_number_is_refused_with_its_place() {
    let error = Trajectory::new(vec![0.0, 1.0], dmatrix![1.0, 2.0; 3.0, f64::NAN]).unwrap_err();
    assert!(matches!(error, SkillError::NonFinite { row: 1, column: 1, .. }));
}

#[test]
fn rows_and_times_must_agree_and_a_coordinate_must_exist() {
    assert!(Trajectory::new(vec![0.0, 1.0, 2.0], dmatrix![1.0; 2.0]).is_err());
    assert!(Trajectory::new(vec![0.0, 1.0], DMatrix::zeros(2, 0)).is_err());
    assert!(Trajectory::uniform(0.0, dmatrix![1.0; 2.0]).is_err());
}

#[test]
fn ends_duration_and_samples_are_those_given() {
    let trajectory = parabola(&[1.0, 1.5, 3.0]);
    assert_eq!((trajectory.len(), trajectory.dimension()), (3, 2));
    assert_eq!(trajectory.duration_s(), 2.0);
    assert_eq!(trajectory.start(), dvector![6.0, -1.0]);
    assert_eq!(trajectory.end(), dvector![34.0, -3.0]);
    assert_eq!(trajectory.sample(1), Some(dvector![10.75, -1.5]));
    assert_eq!(trajectory.sample(3), None);
}

#[test]
fn linear_interpolation_halves_a_segment_and_holds_the_ends() {
    let line = Trajectory::new(vec![0.0, 2.0], dmatrix![1.0; 5.0]).unwrap();
    assert_eq!(line.at(1.0), dvector![3.0]);
    assert_eq!(line.at(-9.0), dvector![1.0]);
    assert_eq!(line.at(9.0), dvector![5.0]);
    assert_eq!(line.at(2.0), dvector![5.0]);
    assert_eq!(line.at_smooth(f64::NAN), dvector![1.0]);
}

#[test]
fn smooth_interpolation_reproduces_a_parabola_on_an_uneven_grid() {
    let trajectory = parabola(&[0.0, 0.1, 0.35, 0.4, 0.9, 1.0]);
    for k in 0..=100 {
        let t = f64::from(k) / 100.0;
        assert_abs_diff_eq!(trajectory.at_smooth(t)[0], 1.0 + 2.0 * t + 3.0 * t * t, epsilon = ROUNDING);
    }
}

#[test]
fn smooth_interpolation_has_no_kink_at_a_sample() {
    let times_s: Vec<f64> = (0..9).map(|k| f64::from(k) * 0.1).collect();
    let samples = DMatrix::from_fn(9, 1, |row, _| (times_s[row] * 7.0).sin());
    let trajectory = Trajectory::new(times_s, samples).unwrap();
    let step = 1e-7;
    let value = |t: f64| trajectory.at_smooth(t)[0];
    let left = (value(0.3) - value(0.3 - step)) / step;
    let right = (value(0.3 + step) - value(0.3)) / step;
    // curvature of order 50 times the step, and cancellation of 1e-16/1e-7
    assert_abs_diff_eq!(left, right, epsilon = 3e-5);
}

#[test]
fn derivatives_of_a_parabola_are_exact_on_an_uneven_grid() {
    let trajectory = parabola(&[0.0, 0.1, 0.35, 0.4, 0.9, 1.0]);
    let (first, second) = (trajectory.first_derivative(), trajectory.second_derivative());
    for (row, t) in trajectory.times_s().iter().enumerate() {
        assert_abs_diff_eq!(first[(row, 0)], 2.0 + 6.0 * t, epsilon = ROUNDING);
        assert_abs_diff_eq!(second[(row, 0)], 6.0, epsilon = 10.0 * ROUNDING);
        assert_abs_diff_eq!(second[(row, 1)], 0.0, epsilon = 10.0 * ROUNDING);
    }
}

#[test]
fn derivatives_on_a_uniform_grid_are_the_textbook_differences() {
    let trajectory = Trajectory::uniform(0.5, dmatrix![1.0; 4.0; 2.0; 8.0]).unwrap();
    let expected = dmatrix![-3.0 + 16.0 - 2.0; 1.0; 4.0; 3.0 * 8.0 - 8.0 + 4.0];
    assert_relative_eq!(trajectory.first_derivative(), expected, max_relative = ROUNDING);
}

#[test]
fn two_samples_have_one_slope() {
    let line = Trajectory::new(vec![0.0, 2.0], dmatrix![1.0; 5.0]).unwrap();
    assert_eq!(line.first_derivative(), dmatrix![2.0; 2.0]);
    assert_eq!(line.second_derivative(), dmatrix![0.0; 0.0]);
}

#[test]
fn the_path_length_of_a_right_angle_is_the_sum_of_its_sides() {
    let corner = Trajectory::uniform(1.0, dmatrix![0.0, 0.0; 3.0, 0.0; 3.0, 4.0]).unwrap();
    assert_eq!(corner.path_length(), 7.0);
}

#[test]
fn resampling_keeps_the_ends_exactly() {
    let trajectory = parabola(&[0.3, 0.7, 1.1]).resample(8).unwrap();
    assert_eq!(trajectory.len(), 8);
    assert_eq!((trajectory.start_time_s(), trajectory.end_time_s()), (0.3, 1.1));
    assert_eq!(trajectory.end(), parabola(&[0.3, 0.7, 1.1]).end());
    assert!(trajectory.resample(1).is_err());
}

#[test]
fn concatenation_moves_the_clock_and_keeps_one_sample_at_the_joint() {
    let first = Trajectory::uniform(1.0, dmatrix![0.0; 1.0]).unwrap();
    let second = Trajectory::new(vec![5.0, 7.0], dmatrix![1.0; 4.0]).unwrap();
    let joined = first.concatenate(&second, 0.0).unwrap();
    assert_eq!(joined.times_s(), [0.0, 1.0, 3.0]);
    assert_eq!(joined.samples(), &dmatrix![0.0; 1.0; 4.0]);
}

#[test]
fn concatenation_refuses_a_gap_and_another_dimension() {
    let first = Trajectory::uniform(1.0, dmatrix![0.0; 1.0]).unwrap();
    assert_eq!(first.concatenate(&first, 0.5).unwrap_err(), SkillError::Gap { gap: 1.0, largest_gap: 0.5 });
    let plane = Trajectory::uniform(1.0, dmatrix![1.0, 0.0; 1.0, 1.0]).unwrap();
    assert!(matches!(first.concatenate(&plane, 9.0), Err(SkillError::Dimension { .. })));
}

proptest! {
    #[test]
    fn reversing_twice_gives_the_same_motion(values in proptest::collection::vec(-9.0f64..9.0, 2..20)) {
        let trajectory = Trajectory::uniform(0.1, DMatrix::from_vec(values.len(), 1, values)).unwrap();
        let twice = trajectory.reversed().reversed();
        prop_assert_eq!(twice.samples(), trajectory.samples());
        for (a, b) in twice.times_s().iter().zip(trajectory.times_s()) {
            prop_assert!((a - b).abs() < ROUNDING);
        }
        prop_assert_eq!(trajectory.reversed().start(), trajectory.end());
    }

    #[test]
    fn linear_interpolation_stays_between_the_samples(
        values in proptest::collection::vec(-9.0f64..9.0, 2..20), time_s in -1.0f64..3.0,
    ) {
        let trajectory = Trajectory::uniform(0.1, DMatrix::from_vec(values.len(), 1, values)).unwrap();
        let value = trajectory.at(time_s)[0];
        prop_assert!(value >= trajectory.samples().min() - ROUNDING);
        prop_assert!(value <= trajectory.samples().max() + ROUNDING);
    }
}
