//! Lists of gains in configuration: one number for all joints, or one for each.

use nalgebra::DVector;
use skills::field::{FieldError, positive};

/// The gains of `joints` joints from a list of one or `joints` positive numbers.
///
/// # Errors
/// A [`FieldError`] naming `field`.
pub(super) fn per_joint(field: &str, gains: &[f64], joints: usize) -> Result<DVector<f64>, FieldError> {
    gains.iter().try_for_each(|gain| positive(field, *gain))?;
    match gains {
        [one] => Ok(DVector::repeat(joints, *one)),
        gains if gains.len() == joints => Ok(DVector::from_column_slice(gains)),
        gains => {
            let expected = format!("one number, or {joints}: one for each joint of the arm");
            Err(FieldError::new(field, format!("{} numbers", gains.len()), expected))
        }
    }
}

/// Gains as a reader compares them: one number if all are equal.
pub(super) fn listed(gains: &DVector<f64>) -> String {
    let texts: Vec<String> = gains.iter().map(|gain| significant(*gain)).collect();
    match texts.first() {
        Some(first) if texts.iter().all(|text| text == first) => first.clone(),
        _ => texts.join(" / "),
    }
}

/// A number with three significant digits.
pub(crate) fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (2 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{value:.decimals$}");
    match text.split_once('.') {
        Some(_) => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_three_digits_at_most() {
        for (value, text) in [(30.0, "30"), (0.0123456, "0.0123"), (1234.5, "1234"), (2.5, "2.5"), (-0.5, "-0.5")] {
            assert_eq!(significant(value), text);
        }
    }

    #[test]
    fn equal_gains_are_told_once() {
        assert_eq!(listed(&DVector::from_vec(vec![10.0, 10.0])), "10");
        assert_eq!(listed(&DVector::from_vec(vec![40.0, 5.0])), "40 / 5");
    }
}
