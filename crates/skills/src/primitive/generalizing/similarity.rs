//! The similarity that turns and scales one displacement into another.

use nalgebra::{DMatrix, DVector};

use crate::time_law::minimum_jerk;

/// Displacement over length of the way up to which a demonstration has no direction: it returns to its start.
const CLOSED: f64 = 0.05;
/// Displacement over length of the way from which on its direction and length are trusted in full.
const OPEN: f64 = 0.2;
/// Length of the sum of two opposite unit vectors below which its direction is rounding.
const OPPOSITE: f64 = 1e-9;

/// Builds the d × d map that turns and scales the displacement `from` into `to`: |to|/|from| times the smallest rotation.
///
/// A demonstration whose displacement is small against its `path_length` has no direction to turn by and would be blown
/// up by a new goal: between a fifth and a twentieth of the length the map passes over to the identity.
pub(super) fn similarity(from: &DVector<f64>, to: &DVector<f64>, path_length: f64) -> DMatrix<f64> {
    let identity = DMatrix::identity(from.len(), from.len());
    let directness = if path_length > 0.0 { from.norm() / path_length } else { 0.0 };
    let trust = minimum_jerk((directness - CLOSED) / (OPEN - CLOSED));
    if trust == 0.0 {
        return identity;
    }
    let turned = if to.norm() > 0.0 {
        smallest_rotation(&from.normalize(), &to.normalize()) * (to.norm() / from.norm())
    } else {
        DMatrix::zeros(from.len(), from.len())
    };
    turned * trust + identity * (1.0 - trust)
}

// the rotation in the plane of two unit vectors that takes the first to the second: a reflection along the first and one
// along their bisector; in one dimension the sign
fn smallest_rotation(from: &DVector<f64>, to: &DVector<f64>) -> DMatrix<f64> {
    if from.len() == 1 {
        return DMatrix::from_element(1, 1, from[0] * to[0]);
    }
    let sum = from + to;
    let bisector = if sum.norm() > OPPOSITE { sum.normalize() } else { any_perpendicular(from) };
    reflection(&bisector) * reflection(from)
}

fn reflection(unit: &DVector<f64>) -> DMatrix<f64> {
    DMatrix::identity(unit.len(), unit.len()) - unit * unit.transpose() * 2.0
}

// the axis least along a unit vector, made perpendicular to it
fn any_perpendicular(unit: &DVector<f64>) -> DVector<f64> {
    let mut axis = DVector::zeros(unit.len());
    axis[unit.iamin()] = 1.0;
    let along = unit.dot(&axis);
    (axis - unit * along).normalize()
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::{dmatrix, dvector};
    use proptest::prelude::*;

    use super::*;

    /// A few roundings of numbers of order ten.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn in_the_plane_it_is_the_product_of_complex_numbers() {
        let found = similarity(&dvector![1.0, 0.0], &dvector![0.0, 3.0], 1.0);
        assert_relative_eq!(found, dmatrix![0.0, -3.0; 3.0, 0.0], epsilon = ROUNDING);
        let about = similarity(&dvector![0.6, 0.8], &dvector![-0.6, -0.8], 1.0);
        assert_relative_eq!(about, -DMatrix::identity(2, 2), epsilon = ROUNDING);
    }

    #[test]
    fn on_a_line_it_is_the_ratio_with_its_sign() {
        assert_relative_eq!(similarity(&dvector![2.0], &dvector![-3.0], 2.0)[(0, 0)], -1.5, epsilon = ROUNDING);
    }

    #[test]
    fn a_way_that_returns_to_its_start_is_kept() {
        for from in [dvector![0.0, 0.0], dvector![0.04, 0.0]] {
            assert_eq!(similarity(&from, &dvector![5.0, 5.0], 1.0), DMatrix::identity(2, 2));
        }
        assert_eq!(similarity(&dvector![0.0, 0.0], &dvector![1.0, 0.0], 0.0), DMatrix::identity(2, 2));
    }

    #[test]
    fn no_displacement_shrinks_the_shape_to_nothing() {
        assert_eq!(similarity(&dvector![1.0, 0.0], &dvector![0.0, 0.0], 1.0), DMatrix::zeros(2, 2));
    }

    proptest! {
        #[test]
        fn it_takes_one_displacement_to_the_other_and_keeps_angles(
            from in prop::array::uniform4(-1.0f64..1.0), to in prop::array::uniform4(-1.0f64..1.0), opposite: bool,
        ) {
            let from = DVector::from_row_slice(&from);
            prop_assume!(from.norm() > 0.1);
            let to = if opposite { &from * -2.0 } else { DVector::from_row_slice(&to) };
            prop_assume!(to.norm() > 0.1);
            let map = similarity(&from, &to, from.norm());
            prop_assert!((&map * &from - &to).norm() < ROUNDING);
            let ratio = to.norm() / from.norm();
            let gram = map.transpose() * &map / (ratio * ratio);
            prop_assert!((gram - DMatrix::identity(4, 4)).norm() < ROUNDING);
            prop_assert!(map.determinant() > 0.0);
        }
    }
}
