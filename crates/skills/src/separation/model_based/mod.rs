//! Model-based separation of a constraint-irrelevant skill, Algorithm 1, Eqs. (7)–(15).
//!
//! Departs from the paper: Eq. (13) sums over demonstrations and their samples; the logarithm of Eq. (11) is taken of a
//! projection that can be positive, or not at all (variable projection, the default); data that do not tell f(s) from Δu
//! are refused, which no iteration notices by itself.
//!
//! The model is F_j = Ψw + Δu_j with Δu_j = γ n_j e^{−βφ_j}, n = R v φ (see [`Hoffmann`]). What the methods cost and when
//! they fail, for M samples of d coordinates and n bases:
//!
//! | method | cost | fails |
//! |---|---|---|
//! | [`VariableProjection`] | one factorization, about 50 passes over the samples | if f can imitate Δu: refused |
//! | [`LogForm::Weighted`] | one factorization, a pass per round: tens of rounds with an obstacle-free demonstration, hundreds without | as above; in noise the positive samples alone are heard |
//! | [`LogForm::Projected`] | as above | it may also diverge, and hears the samples with Δu ≈ 0 loudest |
//! | [`LogForm::LiteralLog`] | as above | it also loses every sample with a component that is not positive |
//!
//! Derivatives of noisy recordings drown Δu: smooth them first, over a time that is short against the turn.
//!
//! [`VariableProjection`]: IdentificationConfig::VariableProjection

mod algorithm_one;
mod brent;
mod config;
mod data;
mod demonstrations;
mod refusal;
mod sensitivity;
mod shared_basis;
mod variable_projection;

pub use config::{AlgorithmOneConfig, IdentificationConfig, LogForm, ModelBasedConfig, VariableProjectionConfig};
pub use data::IdentificationData;
pub use demonstrations::ObstructedDemonstration;
pub use refusal::IdentificationError;

use nalgebra::Matrix2;

use crate::coupling::Hoffmann;
use crate::error::SkillError;
use crate::primitive::Dmp;
use crate::trajectory::Trajectory;
use sensitivity::Sensitivity;
use shared_basis::SharedBasis;

/// Parameters θ of the obstacle term Δu = γ R v φ e^{−βφ}.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameters {
    /// Gain γ, without unit.
    pub gamma: f64,
    /// Decay β, 1/rad.
    pub beta: f64,
}

/// Identified parameters, with what is known of their quality.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// Parameters found.
    pub parameters: Parameters,
    /// Identifiability sin²θ, least first, in [0, 1]: the part of the change of Δu with (ln γ, β) that f(s) cannot
    /// imitate, along its two principal directions.
    pub sin_squared: [f64; 2],
    /// Covariance of (ln γ, β), σ²(Jᵀ(I − P)J)⁻¹, for residuals that are independent between samples; smoothing
    /// correlates them and makes it too small by about the number of samples smoothed over.
    pub covariance: Matrix2<f64>,
    /// Root mean square of F − f − Δu per coordinate, unit of the demonstrations.
    pub residual: f64,
    /// Whether the tolerance was met before the rounds ran out.
    pub converged: bool,
    /// Parameters on the way: after each round of Algorithm 1, or on the grid and at the end of variable projection.
    pub history: Vec<Parameters>,
    /// Equations that the last round used: samples (variable projection, projected forms) or their components.
    pub used: usize,
    /// Equations that the last round lost because a logarithm does not exist; obstacle-free samples do not count.
    pub lost: usize,
}

impl Estimate {
    /// Predicts the factor by which a round of Algorithm 1 with [`LogForm::Weighted`] and the updating factor `eta`
    /// shrinks the error near its limit: max |1 − η sin²θ|.
    #[must_use]
    pub fn contraction(&self, eta: f64) -> f64 {
        self.sin_squared.iter().map(|sin_squared| (1.0 - eta * sin_squared).abs()).fold(0.0, f64::max)
    }
}

/// Constraint-irrelevant skill of Eq. (15) and the obstacle term it was freed of.
#[derive(Debug, Clone, PartialEq)]
pub struct Separation {
    /// Skill without the obstacles, Eq. (15).
    pub skill: Dmp,
    /// Parameters of the obstacle term.
    pub estimate: Estimate,
}

impl Separation {
    /// Builds the obstacle term as identified, for other `obstacles` (d values each, unit and frame of the
    /// demonstrations).
    ///
    /// # Errors
    /// As [`Hoffmann::new`].
    pub fn coupling(&self, obstacles: Vec<Vec<f64>>) -> Result<Hoffmann, SkillError> {
        Hoffmann::new(self.estimate.parameters.gamma, self.estimate.parameters.beta, obstacles)
    }
}

/// Separates the constraint-irrelevant skill from demonstrations past known obstacles by Algorithm 1: identifies γ and β,
/// and learns f(s) from F − Δu, Eqs. (12) and (15).
///
/// Demonstrations share the intention, f(s); obstacles must differ between them, or one must have none. Starts and goals
/// may differ in the residual form. In the form of Eq. (1) they may only be shifted: there f(s) depends on g − x0.
///
/// # Errors
/// If the options are invalid, the demonstrations cannot be learned from, no demonstration has an obstacle, or γ and β
/// cannot be identified from them (see [`IdentificationError`]).
pub fn identify(
    config: &ModelBasedConfig,
    demonstrations: &[ObstructedDemonstration],
) -> Result<Separation, IdentificationError> {
    config.validate().map_err(SkillError::from)?;
    let trajectories: Vec<Trajectory> = demonstrations.iter().map(|shown| shown.trajectory.clone()).collect();
    let data = demonstrations::gather(&config.primitive, demonstrations, &trajectories)?;
    let estimate = estimate(config, &data)?;
    let coupling = data.coupling(estimate.parameters);
    let mut samples = data.into_samples();
    samples.targets -= coupling;
    let skill = Dmp::fit(&config.primitive, &samples, &trajectories, &vec![1.0; trajectories.len()])?;
    Ok(Separation { skill, estimate })
}

/// Identifies γ and β from samples of F = f(s) + Δu, Eqs. (9)–(14), and refuses what the samples do not tell.
///
/// # Errors
/// If the options are invalid, no sample has an obstacle, the samples do not determine the weights of f(s), the method
/// fails, or γ and β are not identifiable or lie outside their range.
pub fn estimate(config: &ModelBasedConfig, data: &IdentificationData) -> Result<Estimate, IdentificationError> {
    config.validate().map_err(SkillError::from)?;
    if !data.is_obstructed() {
        return Err(IdentificationError::NoObstacle);
    }
    let basis = SharedBasis::new(&config.primitive, data)?;
    let found = match &config.identification {
        IdentificationConfig::AlgorithmOne(options) => algorithm_one::run(options, data, &basis)?,
        IdentificationConfig::VariableProjection(options) => variable_projection::run(options, data, &basis),
    };
    judge(config, data, &basis, found)
}

/// What a method found, before it is judged.
struct Found {
    parameters: Parameters,
    converged: bool,
    history: Vec<Parameters>,
    used: usize,
    lost: usize,
}

// adds what is known of the quality of what was found, or refuses it
fn judge(
    config: &ModelBasedConfig,
    data: &IdentificationData,
    basis: &SharedBasis,
    found: Found,
) -> Result<Estimate, IdentificationError> {
    let Parameters { gamma, beta } = found.parameters;
    let sensitivity = Sensitivity::at(beta, data, basis);
    let sin_squared = sensitivity.sin_squared();
    let expected = config.least_sin_squared;
    let imitated = || IdentificationError::NotIdentifiable { found: sin_squared[0], expected };
    if sin_squared[0] < expected {
        return Err(imitated());
    }
    config.identification.check_range(found.parameters)?;
    let left = |parameters| basis.residual(&(data.targets() - data.coupling(parameters)));
    let residuals = left(found.parameters);
    let (sum, count) = (data.inner(&residuals, &residuals), residuals.len() as f64);
    let without = left(Parameters { gamma: 0.0, beta });
    let residual_without = (data.inner(&without, &without) / count).sqrt();
    let residual = (sum / count).sqrt();
    if residual.is_nan() || residual > residual_without {
        return Err(IdentificationError::Misfit { residual, residual_without });
    }
    let freedom = residuals.len().saturating_sub(basis.count() * residuals.ncols() + 2).max(1);
    let covariance = sensitivity.covariance(gamma, sum / freedom as f64).ok_or_else(imitated)?;
    Ok(Estimate {
        parameters: found.parameters,
        sin_squared,
        covariance,
        residual,
        converged: found.converged,
        history: found.history,
        used: found.used,
        lost: found.lost,
    })
}
