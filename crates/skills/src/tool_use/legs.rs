//! Dividing a displacement among the directions in which a tool's surfaces push.

use nalgebra::{DMatrix, DVector, Vector2};

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
/// # Errors
/// [`Undivided`] if no lengths add up, or one of the nearest would be negative: surfaces cannot pull.
pub fn divide(
    directions: &[Vector2<f64>],
    displacement: &Vector2<f64>,
    preferred: &[f64],
) -> Result<Vec<f64>, Undivided> {
    let matrix = DMatrix::from_fn(2, directions.len(), |row, column| directions[column][row]);
    let wanted = DVector::from_column_slice(&[displacement.x, displacement.y]);
    let start = DVector::from_fn(directions.len(), |index, _| preferred.get(index).copied().unwrap_or(0.0));
    let left = &wanted - &matrix * &start;
    let correction = matrix.clone().pseudo_inverse(SINGULAR).map(|inverse| inverse * left);
    let lengths = correction.map_or(start.clone(), |correction| start + correction);
    let miss_m = (&matrix * &lengths - wanted).norm();
    if miss_m > MET_M {
        return Err(Undivided::Directions(miss_m));
    }
    match lengths.iter().enumerate().find(|(_, length)| **length < -MET_M) {
        Some((index, length)) => Err(Undivided::Pull(index, *length)),
        None => Ok(lengths.iter().map(|length| length.max(0.0)).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

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
}
