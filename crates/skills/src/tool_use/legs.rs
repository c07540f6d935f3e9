//! Dividing a displacement among the directions in which a tool's surfaces push.

use nalgebra::{DVector, Matrix2xX, Vector2};

/// Why a displacement cannot be divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Undivided {
    /// The direction of this index would have to pull by this length, m.
    Pull(usize, f64),
    /// The directions miss the displacement by this length, m.
    Directions(f64),
}

/// A displacement is met when less than this is left of it, m.
const MET_M: f64 = 1e-9;
/// Singular values below this do not count as a direction.
const SINGULAR: f64 = 1e-9;

/// Lengths of pushes along unit `directions` that add up to `displacement` and are nearest to the `preferred` lengths, m.
///
/// Surfaces cannot pull: directions whose lengths come out negative are left out one after another, the shortest first.
///
/// # Errors
/// [`Undivided`] if no lengths add up: then the first one that would have to be negative is named, if there is one.
pub fn divide(
    directions: &[Vector2<f64>],
    displacement: &Vector2<f64>,
    preferred: &[f64],
) -> Result<Vec<f64>, Undivided> {
    divide_within(directions, displacement, preferred, MET_M)
}

/// As [`divide`], the displacement met to `tolerance_m` and no push shorter than that unless it is needed for it.
pub(super) fn divide_within(
    directions: &[Vector2<f64>],
    displacement: &Vector2<f64>,
    preferred: &[f64],
    tolerance_m: f64,
) -> Result<Vec<f64>, Undivided> {
    let finite = directions.iter().chain([displacement]).all(|vector| vector.norm().is_finite());
    let mut used: Vec<usize> = if finite { (0..directions.len()).collect() } else { Vec::new() };
    let (mut refusal, mut accepted) = (None, None);
    loop {
        let (lengths, miss_m) = nearest(directions, displacement, preferred, &used);
        // not met if it is no number either
        if miss_m.is_nan() || miss_m > tolerance_m {
            return accepted.ok_or(refusal.unwrap_or(Undivided::Directions(miss_m)));
        }
        let length = |index: usize| lengths.get(index).copied().unwrap_or(0.0);
        let shortest = used.iter().copied().min_by(|a, b| length(*a).total_cmp(&length(*b)));
        let Some(shortest) = shortest.filter(|shortest| length(*shortest) < tolerance_m) else { return Ok(lengths) };
        used.retain(|index| *index != shortest);
        if length(shortest) < 0.0 {
            refusal = refusal.or(Some(Undivided::Pull(shortest, length(shortest))));
        } else {
            accepted = Some(lengths);
        }
    }
}

/// Lengths nearest to the preferred ones along the `used` directions, zero along the others, and what they miss, m.
fn nearest(
    directions: &[Vector2<f64>],
    displacement: &Vector2<f64>,
    preferred: &[f64],
    used: &[usize],
) -> (Vec<f64>, f64) {
    let mut lengths = vec![0.0; directions.len()];
    let columns: Vec<Vector2<f64>> = used.iter().filter_map(|index| directions.get(*index).copied()).collect();
    if columns.is_empty() {
        return (lengths, displacement.norm());
    }
    let matrix = Matrix2xX::from_columns(&columns);
    let mut found = DVector::from_iterator(
        used.len(),
        used.iter().map(|index| preferred.get(*index).copied().filter(|length| length.is_finite()).unwrap_or(0.0)),
    );
    if let Ok(inverse) = matrix.clone().pseudo_inverse(SINGULAR) {
        found += inverse * (displacement - &matrix * &found);
    }
    let miss_m = (&matrix * &found - displacement).norm();
    for (index, length) in used.iter().zip(&found) {
        lengths.iter_mut().skip(*index).take(1).for_each(|place| *place = *length);
    }
    (lengths, miss_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    #[test]
    fn two_directions_divide_a_displacement_in_one_way() {
        let lengths = divide(&[-Vector2::x(), Vector2::y()], &Vector2::new(-0.12, 0.075), &[0.0, 0.0]).unwrap();
        assert_relative_eq!(lengths[0], 0.12, epsilon = 1e-12);
        assert_relative_eq!(lengths[1], 0.075, epsilon = 1e-12);
    }

    #[test]
    fn a_third_push_shares_as_it_was_preferred() {
        let directions = [Vector2::y(), -Vector2::x(), Vector2::y()];
        let lengths = divide(&directions, &Vector2::new(-0.1, 0.06), &[0.02, 0.1, 0.02]).unwrap();
        assert_relative_eq!(lengths[0], 0.03, epsilon = 1e-12);
        assert_relative_eq!(lengths[2], 0.03, epsilon = 1e-12);
    }

    #[test]
    fn surfaces_do_not_pull() {
        let refused = divide(&[-Vector2::x(), Vector2::y()], &Vector2::new(0.05, 0.075), &[0.0, 0.0]);
        assert!(matches!(refused, Err(Undivided::Pull(0, length)) if (length + 0.05).abs() < 1e-9));
        let refused = divide(&[Vector2::y()], &Vector2::new(0.05, 0.075), &[0.0]);
        assert!(matches!(refused, Err(Undivided::Directions(miss)) if (miss - 0.05).abs() < 1e-9));
    }

    #[test]
    fn a_push_that_would_pull_is_left_out_if_the_others_get_there() {
        // nearest to 20 and 100 mm along +y would be -15 and 65 mm
        let directions = [Vector2::y(), -Vector2::x(), Vector2::y()];
        let lengths = divide(&directions, &Vector2::new(-0.1, 0.05), &[0.02, 0.1, 0.1]).unwrap();
        assert_eq!(lengths[0], 0.0);
        assert_relative_eq!(lengths[1], 0.1, epsilon = 1e-12);
        assert_relative_eq!(lengths[2], 0.05, epsilon = 1e-12);
    }

    #[test]
    fn a_push_below_the_tolerance_is_left_out_and_a_pull_below_it_forgiven() {
        let directions = [-Vector2::x(), Vector2::y()];
        for aside in [-0.0009, 0.0009] {
            let lengths = divide_within(&directions, &Vector2::new(aside, 0.075), &[0.1, 0.1], 0.001).unwrap();
            assert_eq!(lengths[0], 0.0);
            assert_relative_eq!(lengths[1], 0.075, epsilon = 1e-12);
        }
        let refused = divide_within(&directions, &Vector2::new(0.0011, 0.075), &[0.1, 0.1], 0.001);
        assert!(matches!(refused, Err(Undivided::Pull(0, _))));
        // both are short, but one of them is needed
        let lengths = divide_within(&directions, &Vector2::new(-0.0009, 0.0009), &[0.1, 0.1], 0.001).unwrap();
        assert!(lengths.iter().any(|length| *length > 0.0), "{lengths:?}");
    }

    #[test]
    fn nothing_and_what_is_no_number_are_refused() {
        assert_eq!(divide(&[], &Vector2::new(0.3, 0.4), &[]), Err(Undivided::Directions(0.5)));
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(divide(&[Vector2::x()], &Vector2::new(bad, 0.0), &[0.1]).is_err());
            assert!(divide(&[Vector2::new(bad, 0.0)], &Vector2::x(), &[0.1]).is_err());
            assert_eq!(divide(&[Vector2::x()], &Vector2::x(), &[bad]), Ok(vec![1.0]));
        }
    }

    proptest! {
        #[test]
        fn lengths_add_up_and_never_pull(
            angles in prop::collection::vec(0.0f64..6.3, 1..6), preferred in prop::collection::vec(0.0f64..0.2, 6),
            x in -0.2f64..0.2, y in -0.2f64..0.2,
        ) {
            let directions: Vec<_> = angles.iter().map(|angle| Vector2::new(angle.cos(), angle.sin())).collect();
            let wanted = Vector2::new(x, y);
            if let Ok(lengths) = divide(&directions, &wanted, &preferred) {
                prop_assert!(lengths.iter().all(|length| *length >= 0.0));
                let sum: Vector2<f64> = directions.iter().zip(&lengths).map(|(along, length)| along * *length).sum();
                prop_assert!((sum - wanted).norm() <= MET_M);
            }
        }
    }
}
