//! The factor k1 of Eqs. (26) and (27) in its printed and its corrected forms.
//!
//! Departs from the paper. With a = g^t − x0 (displacement of the contact on the object) and b = g^o − x0 (on the tool)
//! a touching tool moves by g^Tf − x0 = a − b, so Eq. (39) asks for (I − k1)·a = (1 + k2)·b. The text after (26) swaps the
//! names of a and b; (26) and (27) as printed lack the division by ‖a‖², hence depend on the unit of length, and a scalar
//! k1 exists only where a and b are parallel.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::refusal::FlipError;
use crate::error::SkillError;

/// Range of |k1| in which x^t is of the size of what it was divided from.
const WELL_SCALED: std::ops::RangeInclusive<f64> = 0.1..=10.0;

/// Kinds of the factor k1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FactorKind {
    /// k1 = I, and the goal g^t is solved for: exists always (default).
    #[default]
    Identity,
    /// k1 = 1 − (1 + k2)·tr(b aᴴ): Eq. (26), and (27) for k2 = 1, as printed; misses the goal unless ‖a‖ = 1 and b ∥ a.
    Literal,
    /// k1 = 1 − (1 + k2)·tr(b aᴴ)/‖a‖²: without unit; meets the goal if b ∥ a.
    NormalizedScalar,
    /// k1 = 1 − (1 + k2)·b/a as complex numbers: exact in the plane if a ≠ 0.
    Complex,
    /// k1 = (‖c‖/‖a‖)·R(a → c), c = a − (1 + k2)·b, R the smallest rotation: exact in any dimension if a ≠ 0 and c ≠ 0.
    Similarity,
}

/// Factor k1 of Eq. (23), d × d: a similarity, so that its condition number is 1 wherever it is not zero.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstFactor {
    /// The factor as a matrix, d × d, without unit.
    pub matrix: DMatrix<f64>,
    /// |k1|, by which lengths are multiplied.
    pub scale: f64,
}

impl FirstFactor {
    /// Tells whether |k1| lies within 0.1 to 10; outside, x^t is far larger or smaller than the flip it was divided from.
    #[must_use]
    pub fn is_well_scaled(&self) -> bool {
        WELL_SCALED.contains(&self.scale)
    }

    fn scalar(value: f64, dimension: usize) -> Self {
        Self { matrix: DMatrix::identity(dimension, dimension) * value, scale: value.abs() }
    }
}

impl FactorKind {
    /// Solves Eq. (26) for k1, from `object` = a and `tool` = b (d values each, one unit) and k2.
    ///
    /// # Errors
    /// [`FlipError::NoDisplacement`] if a is zero and divided by, or c is zero and turned to; a [`SkillError`] if the
    /// dimensions differ, are not 2 where complex, or a value is not finite.
    pub fn factor(self, object: &DVector<f64>, tool: &DVector<f64>, k2: f64) -> Result<FirstFactor, FlipError> {
        let dimension = object.len();
        check_pair("solve factor", object, tool)?;
        check_k2(k2)?;
        let sum = 1.0 + k2;
        match self {
            Self::Identity => Ok(FirstFactor::scalar(1.0, dimension)),
            Self::Literal => Ok(FirstFactor::scalar(1.0 - sum * tool.dot(object), dimension)),
            Self::NormalizedScalar => {
                not_zero(object, OBJECT)?;
                Ok(FirstFactor::scalar(1.0 - sum * tool.dot(object) / object.norm_squared(), dimension))
            }
            Self::Complex => {
                let ([ax, ay], [bx, by]) = (object.as_slice(), tool.as_slice()) else {
                    return Err(wrong_dimension("solve factor", dimension, 2).into());
                };
                not_zero(object, OBJECT)?;
                let square = object.norm_squared();
                // b/a = b·conj(a)/|a|²
                let re = 1.0 - sum * (bx * ax + by * ay) / square;
                let im = -sum * (by * ax - bx * ay) / square;
                Ok(FirstFactor { matrix: DMatrix::from_row_slice(2, 2, &[re, -im, im, re]), scale: re.hypot(im) })
            }
            Self::Similarity => {
                let remaining = object - tool * sum;
                not_zero(&remaining, "c = a − (1 + k2)·b")?;
                let matrix = similarity(object, &remaining)?;
                Ok(FirstFactor { matrix, scale: remaining.norm() / object.norm() })
            }
        }
    }
}

/// Builds the similarity (‖to‖/‖from‖)·R(from → to), R the smallest rotation: d × d.
///
/// Opposite vectors are turned within the plane of `from` and the axis most perpendicular to it; in one dimension the
/// result is the quotient.
///
/// # Errors
/// [`FlipError::NoDisplacement`] if `from` is zero; a [`SkillError`] if the dimensions differ or a value is not finite.
pub fn similarity(from: &DVector<f64>, to: &DVector<f64>) -> Result<DMatrix<f64>, FlipError> {
    check_pair("build similarity", from, to)?;
    not_zero(from, OBJECT)?;
    let dimension = from.len();
    let scale = to.norm() / from.norm();
    if scale <= 0.0 {
        return Ok(DMatrix::zeros(dimension, dimension));
    }
    if let ([from], [to]) = (from.as_slice(), to.as_slice()) {
        return Ok(DMatrix::from_element(1, 1, to / from));
    }
    let (u, v) = (from.normalize(), to.normalize());
    let cos = u.dot(&v);
    let across = &v - &u * cos;
    // the second axis of the plane of rotation, and the sine by it; rounding decides nothing for opposite vectors
    let (w, sin) = match across.norm() {
        norm if norm > NEARLY_PARALLEL => (&across / norm, norm),
        norm => (perpendicular(&u), norm),
    };
    let (uu_ww, wu) = (&u * u.transpose() + &w * w.transpose(), &w * u.transpose());
    let rotation = DMatrix::identity(dimension, dimension) + uu_ww * (cos - 1.0) + (&wu - wu.transpose()) * sin;
    Ok(rotation * scale)
}

/// Sine below which two directions count as parallel when an axis across them is sought.
const NEARLY_PARALLEL: f64 = 1e-12;
const OBJECT: &str = "a = g^t − x0, the displacement on the object,";

// a unit vector perpendicular to a unit vector, in the plane of it and the axis it leans to least
fn perpendicular(u: &DVector<f64>) -> DVector<f64> {
    let axis = u.iamin();
    let across = DVector::from_fn(u.len(), |row, _| f64::from(u8::from(row == axis)) - u[row] * u[axis]);
    across.normalize()
}

fn not_zero(vector: &DVector<f64>, displacement: &'static str) -> Result<(), FlipError> {
    if vector.norm() > 0.0 { Ok(()) } else { Err(FlipError::NoDisplacement { displacement }) }
}

pub(super) fn check_k2(k2: f64) -> Result<(), SkillError> {
    if k2.is_finite() {
        return Ok(());
    }
    let (operation, argument, expected) = ("check flip factors", "k2", "a finite number");
    Err(SkillError::InvalidArgument { operation, argument, found: k2, expected })
}

fn wrong_dimension(operation: &'static str, found: usize, expected: usize) -> SkillError {
    SkillError::Dimension { operation, found, expected }
}

fn check_pair(operation: &'static str, first: &DVector<f64>, second: &DVector<f64>) -> Result<(), SkillError> {
    if first.is_empty() {
        return Err(wrong_dimension(operation, 0, 1));
    }
    if first.len() != second.len() {
        return Err(wrong_dimension(operation, second.len(), first.len()));
    }
    for (column, vector) in [first, second].into_iter().enumerate() {
        if let Some(row) = vector.iter().position(|value| !value.is_finite()) {
            return Err(SkillError::NonFinite { operation, row, column, found: vector[row] });
        }
    }
    Ok(())
}
