//! The rules by which the shape of a motion may follow its start and goal.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::config::GeneralizingConfig;
use super::similarity::similarity;
use crate::trajectory::Trajectory;

/// Spreads of the shown displacements beyond which the linear rule no longer extrapolates.
const FARTHEST: f64 = 3.0;

/// How the residual of a motion about its minimum-jerk transfer follows the displacement g − x0 of the task.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// The mean of the shown shapes, moved along: what a residual DMP of all demonstrations does.
    Translation,
    /// Each shown shape turned and scaled as its displacement is to become that of the task, then their mean; for
    /// coordinates of one unit. In more than two dimensions the turn is the smallest one.
    Similarity,
    /// The shape as an affine function of the displacement, by ridge regression; from four demonstrations on.
    Linear,
    /// The mean of the shown shapes weighted by a Gaussian of how far their displacements are from that of the task:
    /// for tasks that were shown to be solved in different ways; from three demonstrations on.
    Local,
}

impl Rule {
    /// Returns the name of the rule as written in a file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Similarity => "similarity",
            Self::Linear => "linear",
            Self::Local => "local",
        }
    }

    /// Returns the number of demonstrations from which on the rule is considered.
    #[must_use]
    pub fn least_demonstrations(self) -> usize {
        match self {
            Self::Translation | Self::Similarity => 1,
            Self::Local => 3,
            Self::Linear => 4,
        }
    }
}

/// What the rules look at of a demonstration.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shown {
    /// Goal minus start, d values.
    pub(super) displacement: DVector<f64>,
    /// Length of the way, in the unit of the samples.
    pub(super) path_length: f64,
}

impl Shown {
    pub(super) fn of(demonstration: &Trajectory) -> Self {
        Self { displacement: demonstration.end() - demonstration.start(), path_length: demonstration.path_length() }
    }
}

/// All demonstrations, to be mixed in parts.
pub(super) struct Mixing<'a> {
    pub(super) config: &'a GeneralizingConfig,
    pub(super) shown: &'a [Shown],
}

impl Mixing<'_> {
    /// Mixes one table (rows × d, rows linear in the shape) per demonstration to that of a task by `rule`, from the
    /// demonstrations of the indices `used` (at least one) alone.
    pub(super) fn mix(
        &self,
        rule: Rule,
        used: &[usize],
        displacement: &DVector<f64>,
        tables: &[DMatrix<f64>],
    ) -> DMatrix<f64> {
        let coefficients = match rule {
            Rule::Translation | Rule::Similarity => DVector::repeat(used.len(), 1.0 / used.len() as f64),
            Rule::Linear => self.linear(used, displacement),
            Rule::Local => self.local(used, displacement),
        };
        let table = |index: &usize| match rule {
            Rule::Similarity => {
                let Shown { displacement: from, path_length } = &self.shown[*index];
                &tables[*index] * similarity(from, displacement, *path_length).transpose()
            }
            Rule::Translation | Rule::Linear | Rule::Local => tables[*index].clone(),
        };
        let terms = used.iter().zip(coefficients.iter()).map(|(index, coefficient)| table(index) * *coefficient);
        terms.reduce(|sum, term| sum + term).unwrap_or_else(|| DMatrix::zeros(0, displacement.len()))
    }

    // c = 1/N + (XXᵀ + λs²I)⁻¹X(δ − δ̄): ridge regression of any table on the displacements, in its dual form, with X the
    // N × d displacements about their mean δ̄ and s² their mean square
    fn linear(&self, used: &[usize], displacement: &DVector<f64>) -> DVector<f64> {
        let count = used.len() as f64;
        let mean = self.mean_displacement(used);
        let about = DMatrix::from_fn(used.len(), mean.len(), |row, k| self.shown[used[row]].displacement[k] - mean[k]);
        let even = DVector::repeat(used.len(), 1.0 / count);
        let square = about.norm_squared() / count;
        let away = displacement - mean;
        let distance = away.norm();
        let farthest = FARTHEST * square.sqrt();
        if distance <= f64::MIN_POSITIVE || farthest <= f64::MIN_POSITIVE {
            return even;
        }
        let held = away * (farthest / distance).min(1.0);
        let mut gram = &about * about.transpose();
        for i in 0..used.len() {
            gram[(i, i)] += self.config.shrinkage * square;
        }
        match gram.cholesky() {
            Some(factor) => even + factor.solve(&(about * held)),
            None => even,
        }
    }

    // c_i ∝ exp(−‖δ − δ_i‖²/(2w²s²)), relative to the nearest so that one always remains
    fn local(&self, used: &[usize], displacement: &DVector<f64>) -> DVector<f64> {
        let mean = self.mean_displacement(used);
        let away = |index: &usize, from: &DVector<f64>| (&self.shown[*index].displacement - from).norm_squared();
        let square = used.iter().map(|index| away(index, &mean)).sum::<f64>() / used.len() as f64;
        let width = (self.config.neighborhood * self.config.neighborhood * square).max(f64::MIN_POSITIVE);
        let distances = DVector::from_iterator(used.len(), used.iter().map(|index| away(index, displacement)));
        let nearest = distances.min();
        let heights = distances.map(|distance| (-0.5 * (distance - nearest) / width).exp());
        &heights / heights.sum()
    }

    fn mean_displacement(&self, used: &[usize]) -> DVector<f64> {
        let sum = used.iter().map(|index| self.shown[*index].displacement.clone()).reduce(|sum, next| sum + next);
        sum.unwrap_or_default() / used.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::{dmatrix, dvector};

    use super::*;

    /// A few roundings.
    const ROUNDING: f64 = 1e-12;

    fn shown(displacements: &[[f64; 2]]) -> Vec<Shown> {
        let of = |d: &[f64; 2]| Shown { displacement: dvector![d[0], d[1]], path_length: d[0].hypot(d[1]) };
        displacements.iter().map(of).collect()
    }

    #[test]
    fn the_linear_rule_without_shrinkage_continues_a_linear_dependence() {
        let config = GeneralizingConfig { shrinkage: 1e-6, ..GeneralizingConfig::default() };
        let all = [[1.0, 0.0], [2.0, 0.5], [0.5, 1.0], [1.5, -1.0]];
        // each entry of the table is affine in the displacement
        let table = |d: &[f64; 2]| dmatrix![1.0 + 2.0 * d[0] - d[1], 3.0 * d[1]; d[0], 5.0];
        let shown = shown(&all);
        let mixing = Mixing { config: &config, shown: &shown };
        let tables: Vec<_> = all.iter().map(table).collect();
        let found = mixing.mix(Rule::Linear, &[0, 1, 2, 3], &dvector![2.0, 1.0], &tables);
        // the ridge is a millionth of the spread
        assert_relative_eq!(found, table(&[2.0, 1.0]), epsilon = 1e-4);
    }

    #[test]
    fn the_linear_rule_stops_extrapolating() {
        let config = GeneralizingConfig::default();
        let all = shown(&[[1.0, 0.0], [2.0, 0.0], [3.0, 0.0], [4.0, 0.0]]);
        let mixing = Mixing { config: &config, shown: &all };
        let used = [0, 1, 2, 3];
        let (far, farther) = (mixing.linear(&used, &dvector![100.0, 0.0]), mixing.linear(&used, &dvector![1e6, 0.0]));
        assert_relative_eq!(far, farther, epsilon = ROUNDING);
        assert_relative_eq!(far.sum(), 1.0, epsilon = ROUNDING);
    }

    #[test]
    fn the_local_rule_keeps_the_nearest_however_far() {
        let config = GeneralizingConfig::default();
        let all = shown(&[[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]]);
        let mixing = Mixing { config: &config, shown: &all };
        let found = mixing.local(&[0, 1, 2], &dvector![1e9, 0.0]);
        assert_relative_eq!(found, dvector![1.0, 0.0, 0.0], epsilon = ROUNDING);
    }

    #[test]
    fn equal_displacements_count_alike_in_every_rule() {
        let config = GeneralizingConfig::default();
        let all = shown(&[[1.0, 0.5]; 4]);
        let mixing = Mixing { config: &config, shown: &all };
        let tables: Vec<_> = (0..4).map(|i| dmatrix![f64::from(i), 1.0]).collect();
        for rule in GeneralizingConfig::default().rules {
            let found = mixing.mix(rule, &[0, 1, 2, 3], &dvector![1.0, 0.5], &tables);
            assert_relative_eq!(found, dmatrix![1.5, 1.0], epsilon = ROUNDING);
        }
    }
}
