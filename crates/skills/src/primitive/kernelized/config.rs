//! Options of the kernelized movement primitive.

use serde::{Deserialize, Serialize};

use crate::field::{FieldError, within};

/// Options of the kernelized movement primitive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct KernelizedConfig {
    /// Number N of reference points, uniform in time from start to end, 4 to 200; learning takes N³ steps.
    pub references: usize,
    /// Length l of the Gaussian kernel in parts of the duration, 0.005 to 1: shorter features are smoothed away. At least
    /// half the distance of two reference points, so that the kernel bridges them.
    #[schemars(range(max = 1.0))]
    pub length_scale: f64,
    /// Regularization λ of the paper, 1e-6 to 1e6: at 1 a reference is trusted as far as its covariance tells.
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub lambda: f64,
    /// Least standard deviation of a reference, relative to the size of the motion's shape, 1e-5 to 1; the whole of it
    /// if there is one demonstration only. Raise it to have via points bend the motion over more than a reference or two.
    #[schemars(range(min = 1e-5, max = 1.0))]
    pub deviation: f64,
}

impl Default for KernelizedConfig {
    fn default() -> Self {
        Self { references: 50, length_scale: 0.05, lambda: 1.0, deviation: 1e-3 }
    }
}

impl KernelizedConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct, such as `length_scale`.
    pub fn validate(&self) -> Result<(), FieldError> {
        if !(4..=200).contains(&self.references) {
            return Err(FieldError::new("references", self.references, "a whole number from 4 to 200"));
        }
        let least = (0.5 / (self.references - 1) as f64).max(0.005);
        within("length_scale", self.length_scale, least, 1.0)?;
        within("lambda", self.lambda, 1e-6, 1e6)?;
        within("deviation", self.deviation, 1e-5, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive::PrimitiveConfig;

    #[test]
    fn an_invalid_option_is_named_by_its_path() {
        let field = |config: KernelizedConfig| PrimitiveConfig::Kernelized(config).validate().unwrap_err().field;
        let valid = KernelizedConfig::default;
        assert_eq!(PrimitiveConfig::Kernelized(valid()).validate(), Ok(()));
        assert_eq!(field(KernelizedConfig { references: 3, ..valid() }), "kernelized.references");
        assert_eq!(field(KernelizedConfig { references: 10, ..valid() }), "kernelized.length_scale");
        assert_eq!(field(KernelizedConfig { length_scale: f64::NAN, ..valid() }), "kernelized.length_scale");
        assert_eq!(field(KernelizedConfig { lambda: 0.0, ..valid() }), "kernelized.lambda");
        assert_eq!(field(KernelizedConfig { deviation: 2.0, ..valid() }), "kernelized.deviation");
    }

    #[test]
    fn an_empty_table_is_the_default_and_a_misspelled_key_is_refused() {
        let parsed: PrimitiveConfig = serde_json::from_str(r#"{"kernelized": {}}"#).unwrap();
        assert_eq!(parsed, PrimitiveConfig::Kernelized(KernelizedConfig::default()));
        assert!(serde_json::from_str::<PrimitiveConfig>(r#"{"kernelized": {"lamda": 1.0}}"#).is_err());
    }
}
