//! The generalizing primitive: how the shape of a motion follows its start and goal is chosen by leaving demonstrations
//! out.
//!
//! Not in the paper, whose primitive keeps one shape for every start and goal. Each demonstration is learned by a residual
//! DMP of its own; a task is answered by the DMP whose weights are mixed from theirs, by one rule or by several.

mod config;
mod leave_one_out;
mod rule;
mod saved;
mod similarity;

use nalgebra::{DMatrix, DVector};

pub use config::{GeneralizingConfig, Selection};
pub use leave_one_out::RuleScore;
pub use rule::Rule;
pub use saved::SavedGeneralizing;

use super::dmp::common_dimension;
use super::{Dmp, MovementPrimitive, Rollout, RolloutRequest, SavedPrimitive};
use crate::error::SkillError;
use crate::primitive::rollout::check_vector;
use crate::time_law::minimum_jerk;
use crate::trajectory::Trajectory;
use rule::{Mixing, Shown};

/// Rows at which residuals are compared when a demonstration is left out.
const COMPARED_ROWS: usize = 101;

/// Residual DMPs of several demonstrations and what mixes them for a task: W = Σ_i c_i·W_i·M_iᵀ.
///
/// The coefficients c_i and the maps M_i (d × d) follow from the displacement g − x0 of the task by the rules of
/// [`Rule`]; which of them, and how much of each, was learned from how well each foretells a demonstration from the
/// others. A single demonstration leaves nothing to compare: the rules that can do with one count alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Generalizing {
    config: GeneralizingConfig,
    shown: Vec<Shown>,
    // n × d each
    weights: Vec<DMatrix<f64>>,
    scores: Vec<RuleScore>,
    end_speed: f64,
    fades_before_end: bool,
}

impl Generalizing {
    /// Learns each of the demonstrations and how to mix them.
    ///
    /// Demonstrations share the dimension d, unit and frame; starts, goals, durations and sampling may differ, each being
    /// learned in its own time over duration. Errors of rules are compared over all coordinates together, so coordinates
    /// should have one unit; otherwise leave [`Rule::Similarity`] out.
    ///
    /// # Errors
    /// If `config` is invalid, there is no demonstration, the dimensions differ, the samples do not determine the weights,
    /// or their squares overflow.
    pub fn learn(config: &GeneralizingConfig, demonstrations: &[Trajectory]) -> Result<Self, SkillError> {
        config.validate()?;
        common_dimension(demonstrations)?;
        let learned = demonstrations.iter().map(|shown| Dmp::learn(&config.dmp, std::slice::from_ref(shown)));
        let learned = learned.collect::<Result<Vec<_>, _>>()?;
        let shown: Vec<Shown> = demonstrations.iter().map(Shown::of).collect();
        let residuals: Vec<DMatrix<f64>> = demonstrations.iter().map(residual).collect();
        let scores = leave_one_out::scores(config, &shown, &residuals);
        if let Some(found) = scores.iter().filter_map(|score| score.error).find(|error| !error.is_finite()) {
            let expected = "samples whose squares do not overflow";
            return Err(SkillError::InvalidArgument {
                operation: "learn primitive",
                argument: "error of a rule",
                found,
                expected,
            });
        }
        Ok(Self {
            scores,
            config: config.clone(),
            shown,
            end_speed: learned.iter().map(Dmp::end_speed).fold(0.0, f64::max),
            fades_before_end: learned.iter().any(Dmp::fades_before_end),
            weights: learned.iter().map(|dmp| dmp.weights().clone()).collect(),
        })
    }

    /// Returns how each rule did when each demonstration in turn was left out, and the share it was given.
    #[must_use]
    pub fn scores(&self) -> &[RuleScore] {
        &self.scores
    }

    /// Returns the rule of the largest share; of equal ones the first.
    #[must_use]
    pub fn chosen(&self) -> Rule {
        let first = RuleScore { rule: Rule::Translation, error: None, share: 0.0 };
        self.scores.iter().fold(first, |best, score| if score.share > best.share { *score } else { best }).rule
    }

    /// Returns the number of demonstrations.
    #[must_use]
    pub fn demonstrations(&self) -> usize {
        self.shown.len()
    }

    /// Mixes the DMP of the task that leads from `start` to `goal` (d values each); its steppers lead there.
    ///
    /// # Errors
    /// If a vector has not d finite values.
    pub fn dmp(&self, start: &DVector<f64>, goal: &DVector<f64>) -> Result<Dmp, SkillError> {
        check_vector("start", self.dimension(), start.as_slice())?;
        check_vector("goal", self.dimension(), goal.as_slice())?;
        let mixing = Mixing { config: &self.config, shown: &self.shown };
        let all: Vec<usize> = (0..self.shown.len()).collect();
        let displacement = goal - start;
        let mut weights = DMatrix::zeros(self.config.dmp.bases, self.dimension());
        for score in self.scores.iter().filter(|score| score.share > 0.0) {
            weights += mixing.mix(score.rule, &all, &displacement, &self.weights) * score.share;
        }
        Dmp::assemble(&self.config.dmp, weights, self.end_speed, self.fades_before_end)
    }
}

impl MovementPrimitive for Generalizing {
    fn dimension(&self) -> usize {
        self.weights.first().map_or(0, DMatrix::ncols)
    }

    fn saved(&self) -> SavedPrimitive {
        SavedPrimitive::Generalizing(Self::saved(self))
    }

    fn rollout(&self, request: &RolloutRequest) -> Result<Rollout, SkillError> {
        request.validate(self.dimension())?;
        self.dmp(&request.start, &request.goal)?.rollout(request)
    }
}

// what a demonstration adds to the minimum-jerk transfer between its ends, at instants uniform in time
fn residual(demonstration: &Trajectory) -> DMatrix<f64> {
    let (start, goal) = (demonstration.start(), demonstration.end());
    let mut residual = DMatrix::zeros(COMPARED_ROWS, demonstration.dimension());
    for row in 0..COMPARED_ROWS {
        let progress = row as f64 / (COMPARED_ROWS - 1) as f64;
        let at = demonstration.at_smooth(demonstration.start_time_s() + progress * demonstration.duration_s());
        let transfer = &start + (&goal - &start) * minimum_jerk(progress);
        residual.row_mut(row).tr_copy_from(&(at - transfer));
    }
    residual
}

#[cfg(test)]
#[path = "generalizing_tests.rs"]
mod tests;
