//! Smoothed bounds: inside the given ones at all times, and where they are floored.

use approx::assert_abs_diff_eq;
use nalgebra::DMatrix;
use proptest::prelude::*;

use super::*;

/// Roundings of sums of some hundred steps of order one.
const ROUNDING: f64 = 1e-12;

fn column(values: &[f64]) -> DMatrix<f64> {
    DMatrix::from_column_slice(values.len(), 1, values)
}

fn inside(span: &FlooredSpan, time_s: f64) -> bool {
    (span.begin_s..=span.end_s).contains(&time_s)
}

#[test]
fn a_jump_becomes_a_minimum_jerk_step_that_is_over_when_it_comes() {
    // the lower bound jumps from 0 to 1 somewhere within (1, 2); with h = 0.25 the step runs from 0.5 to 1
    let times: Vec<f64> = (0..5).map(f64::from).collect();
    let config = SmoothingConfig { half_window_s: 0.25, ..SmoothingConfig::default() };
    let lower = column(&[0.0, 0.0, 1.0, 1.0, 1.0]);
    let smoothed = smooth(&config, &times, &lower, &column(&[3.0; 5])).unwrap();
    assert!(smoothed.floored.is_empty());
    for (time_s, position) in [(0.0, 0.0), (0.5, 0.0), (0.75, 0.5), (1.0, 1.0), (4.0, 1.0)] {
        assert_abs_diff_eq!(smoothed.corridor.at(time_s, 0).lower.position, position, epsilon = ROUNDING);
        assert_abs_diff_eq!(smoothed.corridor.at(time_s, 0).upper.position, 3.0, epsilon = ROUNDING);
    }
    // 1.875 is the peak speed of the minimum-jerk law over its mean speed, here 1/0.5
    assert_abs_diff_eq!(smoothed.corridor.at(0.75, 0).lower.first, 1.875 * 2.0, epsilon = 1e-9);
}

#[test]
fn a_pinching_end_is_floored_and_reported() {
    // a lens: W = 4t(1 − t), median 0.75
    let times: Vec<f64> = (0..=100).map(|row| 0.01 * f64::from(row)).collect();
    let half: Vec<f64> = times.iter().map(|t| 2.0 * t * (1.0 - t)).collect();
    let lower = column(&half.iter().map(|w| -w).collect::<Vec<_>>());
    let config = SmoothingConfig { half_window_s: 0.02, least_width: 0.1 };
    let smoothed = smooth(&config, &times, &lower, &column(&half)).unwrap();
    let (width, _) = smoothed.corridor.least_width(-1.0, 2.0, 0);
    assert_abs_diff_eq!(width, 0.1 * 0.75, epsilon = 0.1 * 0.01);
    assert_eq!(smoothed.floored.len(), 2);
    assert!(inside(&smoothed.floored[0], 0.0) && inside(&smoothed.floored[1], 1.0));
    assert!(smoothed.floored.iter().all(|span| !inside(span, 0.5)));
    let refused = smooth(&SmoothingConfig { least_width: 0.0, ..config }, &times, &lower, &column(&half));
    assert!(matches!(refused, Err(SkillError::InvalidArgument { argument: "width", .. })));
}

#[test]
fn tables_that_do_not_fit_and_crossed_bounds_are_refused() {
    let smooth = |times: &[f64], lower: &[f64], upper: &[f64]| {
        smooth(&SmoothingConfig::default(), times, &column(lower), &column(upper))
    };
    assert!(matches!(smooth(&[0.0], &[0.0], &[1.0]), Err(SkillError::RowCount { .. })));
    assert!(matches!(smooth(&[0.0, 1.0], &[0.0], &[1.0, 1.0]), Err(SkillError::RowCount { .. })));
    assert!(matches!(smooth(&[0.0, 0.0], &[0.0, 0.0], &[1.0, 1.0]), Err(SkillError::TimesNotIncreasing { .. })));
    assert!(matches!(smooth(&[0.0, 1.0], &[0.0, f64::NAN], &[1.0, 1.0]), Err(SkillError::NonFinite { .. })));
    assert!(matches!(smooth(&[0.0, 1.0], &[1.0, 1.0], &[0.0, 0.0]), Err(SkillError::InvalidArgument { .. })));
    let invalid = SmoothingConfig { half_window_s: 0.0, ..SmoothingConfig::default() };
    assert_eq!(invalid.validate().unwrap_err().field, "half_window_s");
}

proptest! {
    #[test]
    fn the_smooth_corridor_lies_inside_the_given_one_where_it_is_not_floored(
        rows in prop::collection::vec((-1.0..1.0f64, 0.0..3.0f64, 0.01..0.2f64), 3..40),
        half_window_s in 0.01..0.3f64,
    ) {
        let mut clock = 0.0;
        let times: Vec<f64> = rows.iter().map(|row| { clock += row.2; clock }).collect();
        let lower: Vec<f64> = rows.iter().map(|row| row.0).collect();
        let upper: Vec<f64> = rows.iter().map(|row| row.0 + row.1).collect();
        let config = SmoothingConfig { half_window_s, least_width: 0.1 };
        let smoothed = smooth(&config, &times, &column(&lower), &column(&upper)).unwrap();
        for step in 0..=1000 {
            let time_s = times[0] - 0.5 + (clock + 1.0 - times[0]) * f64::from(step) / 1000.0;
            let found = smoothed.corridor.at(time_s, 0);
            prop_assert!(found.width().position > 0.0);
            if smoothed.floored.iter().any(|span| inside(span, time_s)) {
                continue;
            }
            // the tighter of the two samples around the time
            let after = times.partition_point(|sample| *sample < time_s).min(times.len() - 1);
            let before = times.partition_point(|sample| *sample <= time_s).saturating_sub(1);
            prop_assert!(found.lower.position >= lower[before].max(lower[after]) - ROUNDING);
            prop_assert!(found.upper.position <= upper[before].min(upper[after]) + ROUNDING);
        }
    }

    #[test]
    fn derivatives_of_the_smooth_corridor_are_those_of_its_position(
        lower in prop::collection::vec(-1.0..0.0f64, 10),
        at_s in -0.5..1.5f64,
    ) {
        let times: Vec<f64> = (0..10).map(|row| 0.1 * f64::from(row)).collect();
        let config = SmoothingConfig { half_window_s: 0.1, least_width: 0.1 };
        let smoothed = smooth(&config, &times, &column(&lower), &column(&[1.0; 10])).unwrap();
        let step = 1e-4;
        let at = |time_s: f64| smoothed.corridor.at(time_s, 0).lower;
        // third derivatives are at most 60/(2h)³ = 7500 per jump of one, of which some ten overlap
        prop_assert!((at(at_s).first - (at(at_s + step).position - at(at_s - step).position) / (2.0 * step)).abs() < 1e-3);
        prop_assert!((at(at_s).second - (at(at_s + step).first - at(at_s - step).first) / (2.0 * step)).abs() < 10.0);
    }
}
