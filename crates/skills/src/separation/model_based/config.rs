//! Options of the model-based separation.

use serde::{Deserialize, Serialize};

use super::{IdentificationError, Parameters};
use crate::field::{self, FieldError};
use crate::primitive::{DmpConfig, DmpForm};

/// Part of β within which a result lies on the edge of the range searched.
const AT_EDGE: f64 = 1e-4;

/// Options of the model-based separation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ModelBasedConfig {
    /// Primitive of the skill, Eq. (15), residual or in the form of Eq. (1). Its ridge also holds the basis of f(s) in the
    /// identification; with locally weighted regression, which is no least squares over all bases, the default ridge does.
    pub primitive: DmpConfig,
    /// How γ and β are identified.
    pub identification: IdentificationConfig,
    /// Least sin²θ that counts as identifiable, without unit, 0 to 1.
    pub least_sin_squared: f64,
}

impl Default for ModelBasedConfig {
    fn default() -> Self {
        Self {
            primitive: DmpConfig::default(),
            identification: IdentificationConfig::default(),
            least_sin_squared: 1e-2,
        }
    }
}

impl ModelBasedConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct, such as `identification.algorithm_one.eta`.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.primitive.validate().map_err(|error| error.within("primitive"))?;
        if self.primitive.form == DmpForm::Scaled {
            let expected = "residual or eq1_literal, in which demonstrations past obstacles share one forcing term";
            return Err(FieldError::new("primitive.form", "scaled", expected));
        }
        self.identification.validate().map_err(|error| error.within("identification"))?;
        field::within("least_sin_squared", self.least_sin_squared, 0.0, 1.0)
    }
}

/// Methods of identification, as a table in a file: `[identification.variable_projection]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum IdentificationConfig {
    /// Algorithm 1 of the paper: rounds of Eqs. (12)–(14) in logarithms.
    AlgorithmOne(AlgorithmOneConfig),
    /// Least squares in all unknowns, those that enter linearly eliminated (default).
    VariableProjection(VariableProjectionConfig),
}

impl Default for IdentificationConfig {
    fn default() -> Self {
        Self::VariableProjection(VariableProjectionConfig::default())
    }
}

impl IdentificationConfig {
    /// Checks the options of the method.
    ///
    /// # Errors
    /// A [`FieldError`] with a field such as `algorithm_one.eta`.
    pub fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::AlgorithmOne(options) => options.validate().map_err(|error| error.within("algorithm_one")),
            Self::VariableProjection(options) => {
                options.validate().map_err(|error| error.within("variable_projection"))
            }
        }
    }

    /// Refuses parameters that no obstacle term has, or that the search was kept from leaving.
    pub(super) fn check_range(&self, found: Parameters) -> Result<(), IdentificationError> {
        let Parameters { gamma, beta } = found;
        if gamma <= 0.0 {
            return Err(IdentificationError::Attracted { gamma, beta });
        }
        match self {
            Self::AlgorithmOne(_) if beta < 0.0 => Err(IdentificationError::NegativeDecay { beta }),
            Self::AlgorithmOne(_) => Ok(()),
            Self::VariableProjection(options) => {
                let (least, greatest) = (options.least_beta, options.greatest_beta);
                if beta > least * (1.0 + AT_EDGE) && beta < greatest * (1.0 - AT_EDGE) {
                    return Ok(());
                }
                Err(IdentificationError::AtEdge { beta, least, greatest })
            }
        }
    }
}

/// Transformation T of Eq. (10) that makes Δu linear in θ = (ln γ, β), and the gain K of Eq. (14).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LogForm {
    /// Eq. (11) as printed, component by component: ln Δu_k − ln n_k, with K = X⁺; components that are not positive are
    /// lost.
    LiteralLog,
    /// ln q with q = Δu·n/‖n‖², with K = X⁺; only samples that Δu pulls toward the obstacle are lost.
    Projected,
    /// ln q weighted by ‖n‖²(γe^{−βφ})², the inverse variance of ln q under noise in F, with K = (XᵀWX)⁻¹XᵀW (default).
    #[default]
    Weighted,
}

/// Options of Algorithm 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AlgorithmOneConfig {
    /// Transformation and gain.
    pub form: LogForm,
    /// Updating factor η of Eq. (14), above 0 and below 2, outside which no data converge.
    pub eta: f64,
    /// Change ε of (ln γ, β) in a round, Euclidean, below which the rounds end.
    pub tolerance: f64,
    /// Most rounds K.
    pub rounds: usize,
    /// First guess of γ, θ̂(0).
    pub initial_gamma: f64,
    /// First guess of β, θ̂(0), 1/rad.
    pub initial_beta: f64,
}

impl Default for AlgorithmOneConfig {
    fn default() -> Self {
        let form = LogForm::default();
        Self { form, eta: 1.0, tolerance: 1e-8, rounds: 1000, initial_gamma: 10.0, initial_beta: 1.0 }
    }
}

impl AlgorithmOneConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        if !(self.eta > 0.0 && self.eta < 2.0) {
            return Err(FieldError::new("eta", self.eta, "a number above 0 and below 2"));
        }
        field::positive("tolerance", self.tolerance)?;
        if !(1..=1_000_000).contains(&self.rounds) {
            return Err(FieldError::new("rounds", self.rounds, "a whole number from 1 to 1000000"));
        }
        field::positive("initial_gamma", self.initial_gamma)?;
        field::not_negative("initial_beta", self.initial_beta)
    }
}

/// Options of variable projection.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct VariableProjectionConfig {
    /// Least β searched, 1/rad.
    pub least_beta: f64,
    /// Greatest β searched, 1/rad.
    pub greatest_beta: f64,
    /// Points of the first search, in equal ratios from the least to the greatest β, 3 to 10000.
    pub grid: usize,
    /// Relative error of β at which the second search ends.
    pub tolerance: f64,
}

impl Default for VariableProjectionConfig {
    fn default() -> Self {
        Self { least_beta: 0.05, greatest_beta: 50.0, grid: 25, tolerance: 1e-8 }
    }
}

impl VariableProjectionConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        field::positive("least_beta", self.least_beta)?;
        field::positive("greatest_beta", self.greatest_beta)?;
        if self.greatest_beta < 1.01 * self.least_beta {
            let expected = format!("more than least_beta = {}", self.least_beta);
            return Err(FieldError::new("greatest_beta", self.greatest_beta, expected));
        }
        if !(3..=10_000).contains(&self.grid) {
            return Err(FieldError::new("grid", self.grid, "a whole number from 3 to 10000"));
        }
        field::within("tolerance", self.tolerance, 1e-12, 1e-1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field(config: ModelBasedConfig) -> String {
        match config.validate() {
            Err(error) => error.field,
            Ok(()) => panic!("accepted"),
        }
    }

    fn with(identification: IdentificationConfig) -> ModelBasedConfig {
        ModelBasedConfig { identification, ..ModelBasedConfig::default() }
    }

    #[test]
    fn the_defaults_are_valid() {
        assert_eq!(ModelBasedConfig::default().validate(), Ok(()));
        assert_eq!(AlgorithmOneConfig::default().validate(), Ok(()));
    }

    #[test]
    fn an_invalid_option_is_named_by_its_path() {
        let scaled = DmpConfig { form: DmpForm::Scaled, ..DmpConfig::default() };
        assert_eq!(field(ModelBasedConfig { primitive: scaled, ..ModelBasedConfig::default() }), "primitive.form");
        let threshold = ModelBasedConfig { least_sin_squared: f64::NAN, ..ModelBasedConfig::default() };
        assert_eq!(field(threshold), "least_sin_squared");
        let eta = AlgorithmOneConfig { eta: 2.0, ..AlgorithmOneConfig::default() };
        assert_eq!(field(with(IdentificationConfig::AlgorithmOne(eta))), "identification.algorithm_one.eta");
        let empty = VariableProjectionConfig { greatest_beta: 0.05, ..VariableProjectionConfig::default() };
        let path = "identification.variable_projection.greatest_beta";
        assert_eq!(field(with(IdentificationConfig::VariableProjection(empty))), path);
    }

    #[test]
    fn an_empty_table_is_the_default_and_a_misspelled_key_is_refused() {
        let parsed: ModelBasedConfig = serde_json::from_str("{}").unwrap();
        assert_eq!(parsed, ModelBasedConfig::default());
        let chosen = r#"{"identification": {"algorithm_one": {"form": "literal_log"}}}"#;
        let chosen: ModelBasedConfig = serde_json::from_str(chosen).unwrap();
        let literal = AlgorithmOneConfig { form: LogForm::LiteralLog, ..AlgorithmOneConfig::default() };
        assert_eq!(chosen, with(IdentificationConfig::AlgorithmOne(literal)));
        assert!(serde_json::from_str::<ModelBasedConfig>(r#"{"identification": {"algorithm_1": {}}}"#).is_err());
        assert!(serde_json::from_str::<ModelBasedConfig>(r#"{"least_sin": 0.1}"#).is_err());
    }
}
