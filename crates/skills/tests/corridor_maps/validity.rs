//! How often the claims of Proposition 1 fail, and that the predicate knows exactly when.

use skills::corridor_map::{MotionEnds, NormalForm, Validity};

use super::random_ends;

/// Cases per frequency: a standard deviation of 0.2 percentage points or less.
const CASES: usize = 20_000;
/// Percentage points.
const FREQUENCY: f64 = 1.0;

// by the constants themselves
fn computed(ends: &MotionEnds) -> Validity {
    let map = NormalForm::solve(ends, 0.01).unwrap();
    let offset_outside = !(map.k_high() > 0.0 && map.k_high() < 1.0);
    Validity { singular: false, reversing: map.k() < 0.0, offset_outside }
}

fn percentages(ratio: f64) -> [f64; 3] {
    let mut counts = [0; 3];
    for ends in random_ends(7, ratio).take(CASES) {
        let validity = Validity::of(&ends);
        for (count, holds) in counts.iter_mut().zip([validity.reversing, validity.offset_outside, !validity.holds()]) {
            *count += u32::from(holds);
        }
    }
    counts.map(|count| 100.0 * f64::from(count) / CASES as f64)
}

fn near(found: [f64; 3], expected: [f64; 3]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < FREQUENCY, "{found} % instead of {expected} %");
    }
}

#[test]
fn the_predicate_agrees_with_the_constants_in_60000_cases() {
    for (seed, ratio) in [(1, 1.0), (2, 2.0), (3, 5.0)] {
        for ends in random_ends(seed, ratio).take(20_000) {
            assert_eq!(Validity::of(&ends), computed(&ends), "{ends:?}");
        }
    }
}

#[test]
fn proposition_1_fails_in_one_of_sixteen_motions_with_widths_up_to_a_ratio_of_two() {
    near(percentages(2.0), [5.2, 3.7, 6.4]);
}

#[test]
fn proposition_1_fails_in_one_of_eight_motions_with_widths_up_to_a_ratio_of_five() {
    near(percentages(5.0), [10.9, 6.4, 12.7]);
}

#[test]
fn proposition_1_never_fails_between_equal_widths() {
    assert_eq!(percentages(1.0), [0.0; 3]);
}
