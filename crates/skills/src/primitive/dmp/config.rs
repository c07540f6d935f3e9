//! Options of the dynamic movement primitive.

use serde::{Deserialize, Serialize};

use crate::field::FieldError;
use crate::regression::RegressionConfig;

/// Which form of Eq. (1) the forcing term stands in; the attractor is the same in all three.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DmpForm {
    /// x = x0 + (g − x0)·mj(t/T) + ξ with τ²ξ̈ = −αβξ − ατξ̇ + f: no jump in acceleration for a new goal, an end error that
    /// does not depend on start and goal, and g = x0 is no special case (default).
    #[default]
    Residual,
    /// Eq. (1) as printed: a new goal steps the acceleration at the start by αβ(g_new − g_demo)/τ².
    Eq1Literal,
    /// Eq. (1) with f·(g − x0) per coordinate (Ijspeert et al. 2013): the shape scales and mirrors with the displacement,
    /// vanishes for g = x0, and cannot be learned from a coordinate that ends where it started.
    Scaled,
}

/// Options of the dynamic movement primitive of Eqs. (1)–(5).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct DmpConfig {
    /// Form the forcing term stands in.
    pub form: DmpForm,
    /// Number n of bases, 2 to 1000.
    pub bases: usize,
    /// Stiffness α of Eq. (1), without unit, 1e-6 to 1e4; β = α/4, so that the attractor is critically damped.
    #[schemars(range(min = 1e-6, max = 1e4))]
    pub alpha: f64,
    /// Decay γ of Eq. (3), without unit, 0.1 to 20; the phase ends at e^{−γ}.
    #[schemars(range(min = 0.1, max = 20.0))]
    pub gamma: f64,
    /// Regression that learns the weights.
    pub regression: RegressionConfig,
    /// Height at which neighboring bases cross, between 0 and 1; by default 0.72 for ridge and 0.5 for locally weighted
    /// regression.
    pub overlap: Option<f64>,
}

impl Default for DmpConfig {
    fn default() -> Self {
        Self {
            form: DmpForm::Residual,
            bases: 50,
            alpha: 25.0,
            gamma: 100f64.ln(),
            regression: RegressionConfig::default(),
            overlap: None,
        }
    }
}

impl DmpConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct, such as `regression.ridge.lambda`.
    pub fn validate(&self) -> Result<(), FieldError> {
        let bases = (2..=1000).contains(&self.bases);
        check(bases, "bases", self.bases, "a whole number from 2 to 1000")?;
        check((1e-6..=1e4).contains(&self.alpha), "alpha", self.alpha, "a number from 0.000001 to 10000")?;
        check((0.1..=20.0).contains(&self.gamma), "gamma", self.gamma, "a number from 0.1 to 20")?;
        self.regression.validate().map_err(|error| error.within("regression"))?;
        let crossing = self.crossing();
        check((0.01..=0.99).contains(&crossing), "overlap", crossing, "a number from 0.01 to 0.99")
    }

    /// Returns the height at which neighboring bases cross: `overlap`, or what the regression prefers.
    #[must_use]
    pub fn crossing(&self) -> f64 {
        self.overlap.unwrap_or_else(|| self.regression.regression().default_crossing())
    }
}

fn check(holds: bool, field: &str, found: impl std::fmt::Display, expected: &str) -> Result<(), FieldError> {
    if holds { Ok(()) } else { Err(FieldError::new(field, found, expected)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive::PrimitiveConfig;
    use crate::regression::{Lwr, Ridge};

    fn field(config: DmpConfig) -> String {
        match PrimitiveConfig::Dmp(config).validate() {
            Err(error) => error.field,
            Ok(()) => panic!("accepted"),
        }
    }

    #[test]
    fn the_defaults_are_valid() {
        assert_eq!(PrimitiveConfig::default().validate(), Ok(()));
        assert_eq!(DmpConfig::default().crossing(), 0.72);
        let lwr = DmpConfig { regression: RegressionConfig::Lwr(Lwr {}), ..DmpConfig::default() };
        assert_eq!(lwr.crossing(), 0.5);
    }

    #[test]
    fn an_invalid_option_is_named_by_its_path() {
        assert_eq!(field(DmpConfig { bases: 1, ..DmpConfig::default() }), "dmp.bases");
        assert_eq!(field(DmpConfig { alpha: f64::NAN, ..DmpConfig::default() }), "dmp.alpha");
        // its square, by which the closed form of the step divides, underflows
        assert_eq!(field(DmpConfig { alpha: 1e-170, ..DmpConfig::default() }), "dmp.alpha");
        assert_eq!(field(DmpConfig { gamma: 0.0, ..DmpConfig::default() }), "dmp.gamma");
        assert_eq!(field(DmpConfig { overlap: Some(1.0), ..DmpConfig::default() }), "dmp.overlap");
        let regression = RegressionConfig::Ridge(Ridge { lambda: -1.0 });
        assert_eq!(field(DmpConfig { regression, ..DmpConfig::default() }), "dmp.regression.ridge.lambda");
    }

    #[test]
    fn an_empty_table_is_the_default_and_a_misspelled_key_is_refused() {
        let parsed: PrimitiveConfig = serde_json::from_str(r#"{"dmp": {}}"#).unwrap();
        assert_eq!(parsed, PrimitiveConfig::default());
        let chosen = r#"{"dmp": {"form": "eq1_literal", "regression": {"lwr": {}}, "overlap": 0.4}}"#;
        let PrimitiveConfig::Dmp(chosen) = serde_json::from_str(chosen).unwrap() else { panic!("another kind") };
        assert_eq!((chosen.form, chosen.regression.name()), (DmpForm::Eq1Literal, "lwr"));
        assert!(serde_json::from_str::<PrimitiveConfig>(r#"{"dmp": {"base": 3}}"#).is_err());
        assert!(serde_json::from_str::<PrimitiveConfig>(r#"{"dmpp": {}}"#).is_err());
    }
}
