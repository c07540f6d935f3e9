//! Algorithm 1: rounds of Eqs. (12)–(14), with the logarithm of Eq. (11) taken in one of three ways.

use nalgebra::{DMatrix, Matrix2, Vector2};

use super::{AlgorithmOneConfig, Found, IdentificationData, IdentificationError, LogForm, Parameters, SharedBasis};

/// Least quotient Δu/n whose logarithm is taken; γe^{−βφ} is far above it wherever an obstacle matters.
const FLOOR: f64 = 1e-9;

/// Linear equations ln q = ln γ − βφ of one round as the sums of their weighted normal equations.
#[derive(Default)]
struct Equations {
    normal: Matrix2<f64>,
    /// Right-hand side for the change of (ln γ, β), Eq. (14).
    innovation: Vector2<f64>,
    used: usize,
    lost: usize,
}

/// Iterates until a round changes (ln γ, β) by less than the tolerance, or the rounds run out.
pub(super) fn run(
    options: &AlgorithmOneConfig,
    data: &IdentificationData,
    basis: &SharedBasis,
) -> Result<Found, IdentificationError> {
    let mut theta = Vector2::new(options.initial_gamma.ln(), options.initial_beta);
    let mut history = Vec::new();
    let mut equations = Equations::default();
    let mut converged = false;
    for round in 0..options.rounds {
        // Eqs. (12) and (13): what the forcing term leaves of F
        let coupling = data.coupling(parameters(&theta));
        let left = basis.residual(&(data.targets() - &coupling)) + coupling;
        equations = Equations::gather(options.form, &theta, &left, data);
        let change = equations.solve(round)? * options.eta;
        theta += change;
        let found = parameters(&theta);
        if !(found.gamma.is_finite() && found.gamma > 0.0 && found.beta.is_finite()) {
            return Err(IdentificationError::Diverged { round });
        }
        history.push(found);
        converged = change.norm() < options.tolerance;
        if converged {
            break;
        }
    }
    let (used, lost) = (equations.used, equations.lost);
    Ok(Found { parameters: parameters(&theta), converged, history, used, lost })
}

fn parameters(theta: &Vector2<f64>) -> Parameters {
    Parameters { gamma: theta[0].exp(), beta: theta[1] }
}

impl Equations {
    /// Gathers the equations of one round from `left` = F − f (M × d), an estimate of Δu.
    fn gather(form: LogForm, theta: &Vector2<f64>, left: &DMatrix<f64>, data: &IdentificationData) -> Self {
        let mut equations = Self::default();
        for (m, angle) in data.angles().iter().enumerate() {
            let (left, direction) = (left.row(m), data.directions().row(m));
            let squared = direction.norm_squared();
            if squared == 0.0 {
                continue;
            }
            match form {
                LogForm::LiteralLog => {
                    for (left, direction) in left.iter().zip(direction.iter()) {
                        // both logarithms of Eq. (11) must exist, whatever the quotient
                        let exists = *left > 0.0 && *direction > 0.0;
                        let quotient = if exists { left / direction } else { 0.0 };
                        equations.add(theta, *angle, quotient, 1.0);
                    }
                }
                LogForm::Projected => equations.add(theta, *angle, left.dot(&direction) / squared, 1.0),
                LogForm::Weighted => {
                    let gain = (theta[0] - theta[1] * angle).exp();
                    let weight = data.weights()[m] * squared * gain * gain;
                    equations.add(theta, *angle, left.dot(&direction) / squared, weight);
                }
            }
        }
        equations
    }

    fn add(&mut self, theta: &Vector2<f64>, angle: f64, quotient: f64, weight: f64) {
        if !(quotient > FLOOR && quotient.is_finite()) {
            self.lost += 1;
            return;
        }
        let regressor = Vector2::new(1.0, -angle);
        self.used += 1;
        self.normal += weight * regressor * regressor.transpose();
        self.innovation += weight * (quotient.ln() - regressor.dot(theta)) * regressor;
    }

    // K(T(F − f) − θᵀΨ) of Eq. (14), with K = (XᵀWX)⁻¹XᵀW
    fn solve(&self, round: usize) -> Result<Vector2<f64>, IdentificationError> {
        let lost = IdentificationError::EquationsLost { round, used: self.used, lost: self.lost };
        let factor = self.normal.cholesky().ok_or(lost)?;
        Ok(factor.solve(&self.innovation))
    }
}
