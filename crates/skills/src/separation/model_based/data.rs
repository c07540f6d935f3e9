//! Samples of F = f(s) + Δu, Eq. (9), with the regressors of Δu.

use nalgebra::{DMatrix, DVector};

use super::Parameters;
use crate::error::SkillError;
use crate::regression::ForcingSamples;
use crate::trajectory::check_finite;

/// What is being done, for errors.
pub(super) const OPERATION: &str = "identify obstacle term";

/// M samples of F = f(s) + γ n e^{−βφ}, of one or many demonstrations, in any order.
#[derive(Debug, Clone, PartialEq)]
pub struct IdentificationData {
    samples: ForcingSamples,
    directions: DMatrix<f64>,
    angles: DVector<f64>,
}

impl IdentificationData {
    /// Checks and takes `samples` of F by Eq. (8), `directions` n (M × d, rows of zeros where there is no obstacle) and
    /// `angles` φ (M values, rad).
    ///
    /// # Errors
    /// If there is no sample or coordinate, the shapes differ, a value is not finite, a weight is negative, or none is
    /// positive.
    pub fn new(
        mut samples: ForcingSamples,
        directions: DMatrix<f64>,
        angles: DVector<f64>,
    ) -> Result<Self, SkillError> {
        let (rows, dimension) = samples.targets.shape();
        if rows == 0 {
            return Err(SkillError::RowCount { operation: OPERATION, found: 0, expected: "at least 1".into() });
        }
        if dimension == 0 || directions.ncols() != dimension {
            let (found, expected) = (directions.ncols(), dimension.max(1));
            return Err(SkillError::Dimension { operation: OPERATION, found, expected });
        }
        for found in [samples.phases.len(), samples.weights.len(), directions.nrows(), angles.len()] {
            if found != rows {
                let expected = format!("{rows}, one per target");
                return Err(SkillError::RowCount { operation: OPERATION, found, expected });
            }
        }
        for table in [&samples.targets, &directions] {
            check_finite(OPERATION, table)?;
        }
        for values in [&samples.phases, &samples.weights, &angles] {
            check_finite(OPERATION, &DMatrix::from_column_slice(rows, 1, values.as_slice()))?;
        }
        // their mean is 1, so that a weighted sum of squares is one of so many samples
        let mean = samples.weights.mean();
        let least = samples.weights.min();
        if !(least >= 0.0 && mean > 0.0 && mean.is_finite()) {
            let expected = "weights of at least 0 with a positive finite sum";
            return Err(SkillError::InvalidArgument {
                operation: OPERATION,
                argument: "weights",
                found: least,
                expected,
            });
        }
        samples.weights /= mean;
        Ok(Self { samples, directions, angles })
    }

    /// Gives the samples away.
    pub(super) fn into_samples(self) -> ForcingSamples {
        self.samples
    }

    /// Returns the phases s, M values.
    #[must_use]
    pub fn phases(&self) -> &DVector<f64> {
        &self.samples.phases
    }

    /// Returns the targets F, M × d.
    #[must_use]
    pub fn targets(&self) -> &DMatrix<f64> {
        &self.samples.targets
    }

    /// Returns the weights of the samples, M values with mean 1.
    #[must_use]
    pub fn weights(&self) -> &DVector<f64> {
        &self.samples.weights
    }

    /// Returns the directions n = R v φ, M × d.
    #[must_use]
    pub fn directions(&self) -> &DMatrix<f64> {
        &self.directions
    }

    /// Returns the angles φ, M values, rad.
    #[must_use]
    pub fn angles(&self) -> &DVector<f64> {
        &self.angles
    }

    /// Evaluates Δu = γ n e^{−βφ} of every sample, M × d.
    #[must_use]
    pub fn coupling(&self, parameters: Parameters) -> DMatrix<f64> {
        let gains = self.angles.map(|angle| parameters.gamma * (-parameters.beta * angle).exp());
        let mut coupling = self.directions.clone();
        for mut column in coupling.column_iter_mut() {
            column.component_mul_assign(&gains);
        }
        coupling
    }

    /// Tells whether an obstacle acts on any sample.
    pub(super) fn is_obstructed(&self) -> bool {
        self.directions.iter().any(|value| *value != 0.0)
    }

    /// Sums the products of two M × d tables with the weights of the samples.
    pub(super) fn inner(&self, a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
        let column = |(a, b): (nalgebra::DVectorView<'_, f64>, nalgebra::DVectorView<'_, f64>)| -> f64 {
            a.iter().zip(b.iter()).zip(self.samples.weights.iter()).map(|((a, b), weight)| weight * a * b).sum()
        };
        a.column_iter().zip(b.column_iter()).map(column).sum()
    }
}
