//! The regressions that learn the weights W of Eq. (2): their contract and the list of kinds.
//!
//! The paper minimizes Eq. (4) by locally weighted regression; ridge regression on the same bases is the default here
//! because it fits two to three decades closer. Eq. (4) as printed sums over demonstrations only; both sum over
//! demonstrations and their samples.
//!
//! A further kind is one file with an implementation of [`Regression`], and its lines in this one.

mod lwr;
mod recursive;
mod ridge;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

pub use lwr::Lwr;
pub use recursive::{Recursive, RecursiveFit};
pub use ridge::Ridge;

use crate::basis::GaussianBasis;
use crate::error::SkillError;
use crate::field::FieldError;

/// Samples of a forcing term, of one or many demonstrations, in any order.
#[derive(Debug, Clone, PartialEq)]
pub struct ForcingSamples {
    /// Phase s of each sample: M values in (0, 1].
    pub phases: DVector<f64>,
    /// Forcing target f^Tar of Eq. (5) of each sample: M × d, unit of the trajectory.
    pub targets: DMatrix<f64>,
    /// Weight of each sample in the sum of squares: M values ≥ 0; only their ratios matter.
    pub weights: DVector<f64>,
}

/// Fit of weights to samples of a forcing term.
///
/// Contract: the result depends on the samples as a set (up to rounding; unless told to forget) and on the weights' ratios
/// only; it is linear in the targets and treats each target column alone.
pub trait Regression {
    /// Fits W of f(s) = WᵀΨ(s), Eq. (2), to `samples` by Eq. (4); returns n × d.
    ///
    /// # Errors
    /// If the samples do not determine the weights.
    fn fit(&self, samples: &ForcingSamples, basis: &GaussianBasis) -> Result<DMatrix<f64>, SkillError>;

    /// Returns the height in (0, 1) at which neighboring bases should cross for this regression.
    fn default_crossing(&self) -> f64;

    /// Checks the options.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to the options.
    fn validate(&self) -> Result<(), FieldError>;
}

/// Kinds of regression, as a table in a file: `regression.ridge.lambda = 1e-8` or `regression.lwr = {}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum RegressionConfig {
    /// Least squares over all bases at once, with a small ridge (default).
    Ridge(Ridge),
    /// Locally weighted regression, basis by basis: the paper's choice.
    Lwr(Lwr),
    /// The same sample by sample, optionally forgetting.
    Recursive(Recursive),
}

impl Default for RegressionConfig {
    fn default() -> Self {
        Self::Ridge(Ridge::default())
    }
}

impl RegressionConfig {
    /// Returns the regression of this kind.
    #[must_use]
    pub fn regression(&self) -> &dyn Regression {
        match self {
            Self::Ridge(ridge) => ridge,
            Self::Lwr(lwr) => lwr,
            Self::Recursive(recursive) => recursive,
        }
    }

    /// Returns the name of the kind as written in a file.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Ridge(_) => "ridge",
            Self::Lwr(_) => "lwr",
            Self::Recursive(_) => "recursive",
        }
    }

    /// Checks the options of the kind.
    ///
    /// # Errors
    /// A [`FieldError`] with a field such as `ridge.lambda`.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.regression().validate().map_err(|error| error.within(self.name()))
    }
}
