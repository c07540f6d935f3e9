//! Checks of configuration values, and the error that names the field at fault.

use std::fmt::Display;

/// A configuration value that cannot be used.
///
/// `field` is the dotted path of the value relative to the struct that was checked (`shape.radius_m`), so that whoever
/// read the value from a file can point at its line and column.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{field}: found {found}; expected {expected}")]
pub struct FieldError {
    /// Dotted path of the field, relative to the struct that was checked.
    pub field: String,
    /// The value found, with its unit.
    pub found: String,
    /// What would have been accepted.
    pub expected: String,
}

impl FieldError {
    /// Names a field, what was found in it and what was expected.
    pub fn new(field: impl Into<String>, found: impl Display, expected: impl Into<String>) -> Self {
        Self { field: field.into(), found: found.to_string(), expected: expected.into() }
    }

    /// Puts `prefix` before the field's path: `radius_m` inside `shape` becomes `shape.radius_m`.
    #[must_use]
    pub fn within(mut self, prefix: impl Display) -> Self {
        self.field = if self.field.is_empty() { prefix.to_string() } else { format!("{prefix}.{}", self.field) };
        self
    }
}

/// Checks that `value` is finite and greater than zero.
///
/// # Errors
/// A [`FieldError`] naming `field`.
pub fn positive(field: &str, value: f64) -> Result<(), FieldError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(FieldError::new(field, value, "a number greater than 0"))
    }
}

/// Checks that `value` is finite and not negative.
///
/// # Errors
/// A [`FieldError`] naming `field`.
pub fn not_negative(field: &str, value: f64) -> Result<(), FieldError> {
    if value.is_finite() && value >= 0.0 {
        Ok(())
    } else {
        Err(FieldError::new(field, value, "a number of at least 0"))
    }
}

/// Checks that `value` is finite and lies in the closed interval `[lower, upper]`.
///
/// # Errors
/// A [`FieldError`] naming `field`.
pub fn within(field: &str, value: f64, lower: f64, upper: f64) -> Result<(), FieldError> {
    if value.is_finite() && (lower..=upper).contains(&value) {
        Ok(())
    } else {
        Err(FieldError::new(field, value, format!("a number from {lower} to {upper}")))
    }
}

/// Checks that every number of `values` is finite.
///
/// # Errors
/// A [`FieldError`] naming `field`.
pub fn finite(field: &str, values: &[f64]) -> Result<(), FieldError> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(value) => Err(FieldError::new(field, value, "a finite number")),
    }
}
