//! The search: CMA-ES (Hansen 2001, by the crate `cmaes`) in the unit cube of the parameters' ranges.

use cmaes::{CMAESOptions, DVector};

use super::Parameter;

/// First standard deviation, as a share of each parameter's range: the start is one of many.
const FIRST_STEP: f64 = 0.25;

/// Cost of leaving the ranges by the length of one of them, in units of the spread of costs: candidates outside are
/// tried at the nearest point inside, and a little is added so that the search comes back.
const OUTSIDE: f64 = 1.0;

/// What the search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Values of the parameters, inside their ranges.
    pub values: Vec<f64>,
    /// What they cost.
    pub cost: f64,
}

/// Looks for the values with the smallest cost; `evaluate` is asked for `evaluations` candidates, the start first.
///
/// Equal seeds and costs give equal candidates.
///
/// # Errors
/// The first error of `evaluate`, or in words why the search cannot begin.
pub fn search<E: From<String>>(
    parameters: &[Parameter],
    evaluations: usize,
    seed: u64,
    evaluate: &mut dyn FnMut(&[f64]) -> Result<f64, E>,
) -> Result<Found, E> {
    let start: Vec<f64> = parameters.iter().map(|parameter| parameter.start).collect();
    let mut found = Found { cost: evaluate(&start)?, values: start };
    let mut left = evaluations.saturating_sub(1);
    let mut failure = None;
    let unit: Vec<f64> = parameters
        .iter()
        .map(|parameter| (parameter.start - parameter.min) / (parameter.max - parameter.min))
        .collect();
    let spread = found.cost.abs().clamp(1e-6, 1.0);
    let objective = |point: &DVector<f64>| {
        if left == 0 || failure.is_some() {
            return f64::MAX;
        }
        left -= 1;
        let inside: Vec<f64> = point.iter().map(|share| share.clamp(0.0, 1.0)).collect();
        let outside: f64 = point.iter().zip(&inside).map(|(share, inside)| (share - inside).powi(2)).sum();
        let values: Vec<f64> = parameters
            .iter()
            .zip(&inside)
            .map(|(parameter, share)| parameter.min + share * (parameter.max - parameter.min))
            .collect();
        match evaluate(&values) {
            Ok(cost) => {
                if cost < found.cost {
                    found = Found { values, cost };
                }
                cost + OUTSIDE * spread * outside
            }
            Err(error) => {
                failure = Some(error);
                f64::MAX
            }
        }
    };
    let options = CMAESOptions::new(unit, FIRST_STEP).seed(seed).max_function_evals(evaluations.saturating_sub(1));
    let mut state = options.build(objective).map_err(|error| E::from(format!("start the search: {error:?}")))?;
    state.run();
    drop(state);
    match failure {
        Some(error) => Err(error),
        None => Ok(found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters() -> Vec<Parameter> {
        let ranges = [("a", -1.0, 2.0, 1.5), ("b", 10.0, 20.0, 19.0)];
        ranges.map(|(key, min, max, start)| Parameter { key: key.into(), min, max, start }).to_vec()
    }

    fn bowl(values: &[f64]) -> f64 {
        (values[0] - 0.3).powi(2)
            + ((values[1] - 12.0) / 10.0).powi(2)
            + 0.3 * (values[0] - 0.3) * (values[1] - 12.0) / 10.0
    }

    #[test]
    fn the_minimum_of_a_tilted_bowl_is_found() {
        let mut asked = 0;
        let mut evaluate = |values: &[f64]| -> Result<f64, String> {
            asked += 1;
            Ok(bowl(values))
        };
        let found = search(&parameters(), 200, 7, &mut evaluate).unwrap();
        assert!(asked <= 200, "{asked}");
        assert!(found.cost < 1e-4, "{found:?}");
        assert!((found.values[0] - 0.3).abs() < 0.02 && (found.values[1] - 12.0).abs() < 0.2, "{found:?}");
    }

    #[test]
    fn a_minimum_at_the_edge_is_kept_inside() {
        let mut evaluate = |values: &[f64]| -> Result<f64, String> {
            assert!((-1.0..=2.0).contains(&values[0]) && (10.0..=20.0).contains(&values[1]));
            Ok(values[0] + values[1])
        };
        let found = search(&parameters(), 150, 3, &mut evaluate).unwrap();
        assert!((found.values[0] + 1.0).abs() < 0.02 && (found.values[1] - 10.0).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn the_same_seed_asks_for_the_same_candidates() {
        let asked = |seed| {
            let mut asked: Vec<Vec<f64>> = Vec::new();
            let mut evaluate = |values: &[f64]| -> Result<f64, String> {
                asked.push(values.to_vec());
                Ok(bowl(values))
            };
            search(&parameters(), 30, seed, &mut evaluate).unwrap();
            asked
        };
        assert_eq!(asked(1), asked(1));
        assert_ne!(asked(1), asked(2));
    }

    #[test]
    fn an_error_ends_the_search_and_comes_out() {
        let mut count = 0;
        let mut evaluate = |values: &[f64]| {
            count += 1;
            if count == 5 { Err("enough".to_owned()) } else { Ok(bowl(values)) }
        };
        assert_eq!(search(&parameters(), 100, 1, &mut evaluate).unwrap_err(), "enough");
        assert_eq!(count, 5);
    }
}
