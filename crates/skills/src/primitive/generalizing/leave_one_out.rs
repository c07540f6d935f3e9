//! How well each rule foretells a demonstration from the others, and the share in the answer it is given for it.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::config::{GeneralizingConfig, Selection};
use super::rule::{Mixing, Rule, Shown};

/// Part of the mean square of the shapes below which errors of rules count as equal.
const EQUAL: f64 = 1e-12;

/// One row of the table of rules.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RuleScore {
    /// The rule.
    pub rule: Rule,
    /// Root mean square distance, in the unit of the demonstrations, of a demonstration from what the others foretell for
    /// its start and goal at the same part of the duration, over all demonstrations; nothing if there is only one.
    pub error: Option<f64>,
    /// Share in the answer, 0 to 1; the shares add up to 1.
    pub share: f64,
}

/// Scores the rules of `config` that can do with as many demonstrations; the translation if none can.
pub(super) fn scores(config: &GeneralizingConfig, shown: &[Shown], residuals: &[DMatrix<f64>]) -> Vec<RuleScore> {
    let able = |rule: &&Rule| rule.least_demonstrations() <= shown.len();
    let mut rules: Vec<Rule> = config.rules.iter().filter(able).copied().collect();
    if rules.is_empty() {
        rules.push(Rule::Translation);
    }
    let mixing = Mixing { config, shown };
    let squares: Option<Vec<f64>> = rules.iter().map(|rule| mean_square(&mixing, *rule, residuals)).collect();
    let shares = match &squares {
        Some(squares) => shares(config.selection, squares, mean_of_squares(residuals)),
        None => shares(config.selection, &vec![1.0; rules.len()], 1.0),
    };
    let error = |index: usize| squares.as_ref().map(|squares| squares[index].sqrt());
    let score = |(index, (rule, share))| RuleScore { rule, error: error(index), share };
    rules.into_iter().zip(shares).enumerate().map(score).collect()
}

// over demonstrations and rows, summed over coordinates
fn mean_square(mixing: &Mixing<'_>, rule: Rule, residuals: &[DMatrix<f64>]) -> Option<f64> {
    let count = residuals.len();
    if count < 2 {
        return None;
    }
    let left_out = |index: usize| {
        let others: Vec<usize> = (0..count).filter(|other| *other != index).collect();
        let foretold = mixing.mix(rule, &others, &mixing.shown[index].displacement, residuals);
        foretold - &residuals[index]
    };
    Some(mean_of_squares(&(0..count).map(left_out).collect::<Vec<_>>()))
}

fn mean_of_squares(tables: &[DMatrix<f64>]) -> f64 {
    let rows: usize = tables.iter().map(DMatrix::nrows).sum();
    tables.iter().map(DMatrix::norm_squared).sum::<f64>() / rows.max(1) as f64
}

fn shares(selection: Selection, squares: &[f64], scale: f64) -> Vec<f64> {
    let least = EQUAL * scale + f64::MIN_POSITIVE;
    let best = squares.iter().copied().fold(f64::INFINITY, f64::min).max(least);
    match selection {
        Selection::Chosen => {
            let first = squares.iter().position(|square| *square <= best);
            (0..squares.len()).map(|index| if Some(index) == first { 1.0 } else { 0.0 }).collect()
        }
        Selection::Blended => {
            let merits: Vec<f64> = squares.iter().map(|square| (best / square.max(least)).powi(2)).collect();
            let sum: f64 = merits.iter().sum();
            merits.iter().map(|merit| merit / sum).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twice_the_error_is_a_sixteenth_of_the_share() {
        assert_eq!(shares(Selection::Blended, &[1.0, 4.0], 1.0), [16.0 / 17.0, 1.0 / 17.0]);
    }

    #[test]
    fn of_equal_errors_the_first_is_chosen() {
        assert_eq!(shares(Selection::Chosen, &[2.0, 1.0, 1.0], 1.0), [0.0, 1.0, 0.0]);
        assert_eq!(shares(Selection::Chosen, &[0.0, 0.0], 0.0), [1.0, 0.0]);
    }

    #[test]
    fn errors_of_rounding_share_alike() {
        assert_eq!(shares(Selection::Blended, &[1e-30, 0.0], 1.0), [0.5, 0.5]);
        assert_eq!(shares(Selection::Blended, &[0.0, 0.0], 0.0), [0.5, 0.5]);
    }
}
