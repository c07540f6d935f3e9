//! How far the samples tell the change of Δu with its parameters from a change of f(s).

use nalgebra::{DMatrix, Matrix2};

use super::{IdentificationData, Parameters, SharedBasis};

/// Products of J = ∂Δu/∂(ln γ, β) = [Δu, −φΔu] at γ = 1, whole and outside the range of the shared basis.
pub(super) struct Sensitivity {
    /// JᵀJ.
    whole: Matrix2<f64>,
    /// Jᵀ(I − P)J.
    outside: Matrix2<f64>,
}

impl Sensitivity {
    pub(super) fn at(beta: f64, data: &IdentificationData, basis: &SharedBasis) -> Self {
        let by_gain = data.coupling(Parameters { gamma: 1.0, beta });
        let mut by_decay = -&by_gain;
        for mut column in by_decay.column_iter_mut() {
            column.component_mul_assign(data.angles());
        }
        let (gain_outside, decay_outside) = (basis.residual(&by_gain), basis.residual(&by_decay));
        let gram = |a: &DMatrix<f64>, b: &DMatrix<f64>, c: &DMatrix<f64>, d: &DMatrix<f64>| {
            let mixed = data.inner(a, d);
            Matrix2::new(data.inner(a, c), mixed, mixed, data.inner(b, d))
        };
        Self {
            whole: gram(&by_gain, &by_decay, &by_gain, &by_decay),
            outside: gram(&by_gain, &by_decay, &gain_outside, &decay_outside),
        }
    }

    /// Evaluates the eigenvalues of (JᵀJ)⁻¹Jᵀ(I − P)J, least first: squared sines of the principal angles between J and
    /// the shared basis; zero if the two columns of J are parallel.
    pub(super) fn sin_squared(&self) -> [f64; 2] {
        let Some(lower) = self.whole.cholesky().map(|factor| factor.l()) else { return [0.0; 2] };
        let Some(inverse) = lower.try_inverse() else { return [0.0; 2] };
        let values = (inverse * self.outside * inverse.transpose()).symmetric_eigenvalues();
        let (a, b) = (values[0].clamp(0.0, 1.0), values[1].clamp(0.0, 1.0));
        if a.is_nan() || b.is_nan() { [0.0; 2] } else { [a.min(b), a.max(b)] }
    }

    /// Evaluates Cov(ln γ, β) = σ²(γ²Jᵀ(I − P)J)⁻¹ for residuals of the given variance σ².
    pub(super) fn covariance(&self, gamma: f64, variance: f64) -> Option<Matrix2<f64>> {
        self.outside.try_inverse().map(|inverse| inverse * (variance / (gamma * gamma)))
    }
}
