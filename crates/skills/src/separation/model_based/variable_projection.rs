//! Variable projection: least squares in w, γ and β with w and γ, which enter linearly, eliminated.
//!
//! Source: G. H. Golub and V. Pereyra, "The differentiation of pseudo-inverses and nonlinear least squares problems whose
//! variables separate", SIAM Journal on Numerical Analysis 10(2), 1973, doi:10.1137/0710036.

use nalgebra::DMatrix;

use super::brent::minimize;
use super::{Found, IdentificationData, Parameters, SharedBasis, VariableProjectionConfig};

/// Part of a direction's squared length outside the shared basis below which it counts as inside.
const INSIDE: f64 = 1e-20;

/// Searches β on a grid and around its best point; γ = ⟨r_a, r_F⟩/⟨r_a, r_a⟩ with r = (I − P)(·) and a = n e^{−βφ}.
pub(super) fn run(options: &VariableProjectionConfig, data: &IdentificationData, basis: &SharedBasis) -> Found {
    let targets = basis.residual(data.targets());
    let cost = |beta: f64| reduced(beta, &targets, data, basis).1;
    let found = |beta: f64| Parameters { gamma: reduced(beta, &targets, data, basis).0, beta };

    let last = options.grid - 1;
    let ratio = options.greatest_beta / options.least_beta;
    let point = |k: usize| options.least_beta * ratio.powf(k.min(last) as f64 / last as f64);
    let costs = (0..=last).map(|k| (k, cost(point(k))));
    let best = costs.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(k, _)| k);

    let bracket = (point(best.saturating_sub(1)), point(best + 1));
    let minimum = minimize(cost, bracket, options.tolerance);
    let parameters = found(minimum.argument);
    let used = data.directions().row_iter().filter(|row| row.iter().any(|value| *value != 0.0)).count();
    let history = vec![found(point(best)), parameters];
    Found { parameters, converged: minimum.converged, history, used, lost: 0 }
}

// γ and the weighted sum of squares ‖r_F − γr_a‖² that is left at β
fn reduced(beta: f64, targets: &DMatrix<f64>, data: &IdentificationData, basis: &SharedBasis) -> (f64, f64) {
    let direction = data.coupling(Parameters { gamma: 1.0, beta });
    let outside = basis.residual(&direction);
    let squared = data.inner(&outside, &outside);
    if squared <= INSIDE * data.inner(&direction, &direction) {
        return (0.0, data.inner(targets, targets));
    }
    let gamma = data.inner(&outside, targets) / squared;
    let left = targets - outside * gamma;
    (gamma, data.inner(&left, &left))
}
