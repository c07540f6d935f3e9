//! The dynamic movement primitive of Eqs. (1)–(5): learned from demonstrations, rolled out to another start, goal and
//! duration.
//!
//! Departs from the paper: by default the primitive moves a residual about a minimum-jerk transfer instead of Eq. (1) as
//! printed (see [`DmpForm`]); τ is the duration T; β = α/4; the step is exact for a forcing term linear in time.

mod assembly;
mod attractor;
mod config;
mod forcing;
mod learning;
mod pair;
mod recording;
mod saved;
mod stepper;

use nalgebra::DMatrix;

pub use config::{DmpConfig, DmpForm};
pub(super) use learning::common_dimension;
pub use pair::{DmpPair, rollout_pair};
pub use saved::SavedDmp;
pub use stepper::DmpStepper;
pub(super) use stepper::SHORTEST_TRANSFER;

use super::{MovementPrimitive, Rollout, RolloutRequest, SavedPrimitive};
use crate::basis::GaussianBasis;
use crate::canonical::CanonicalSystem;
use crate::coupling::Coupling;
use crate::error::SkillError;
use crate::regression::ForcingSamples;
use crate::trajectory::{Trajectory, check_finite};
use attractor::Attractor;
use forcing::ForcingTerm;
use recording::Recording;

/// Dynamic movement primitive of d coordinates, Eq. (1): τv̇ = α(β(g − x) − v) + f(s), τẋ = v.
///
/// Immutable once learned; [`Dmp::stepper`] starts a motion of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Dmp {
    form: DmpForm,
    attractor: Attractor,
    forcing: ForcingTerm,
    end_speed: f64,
}

impl Dmp {
    /// Learns the forcing term from one or more demonstrations by Eqs. (4) and (5), all weighing the same.
    ///
    /// Demonstrations share the dimension d, unit and frame; starts, goals, durations and sampling may differ, each being
    /// learned in its own time over duration, from its own start to its own end. Where one of them does not come to rest,
    /// the forcing term fades before the end of the motion (see [`Dmp::fades_before_end`]).
    ///
    /// A rollout starts at rest unless it is asked for the demonstrated velocity: noise of a sensor, which looks like a
    /// speed at the ends, is better taken out before by [`Trajectory::smoothed`].
    ///
    /// # Errors
    /// If `config` is invalid, there is no demonstration, the dimensions differ, the form is scaled and a coordinate has
    /// no displacement, the samples do not determine the weights, or the derivatives of a demonstration overflow.
    pub fn learn(config: &DmpConfig, demonstrations: &[Trajectory]) -> Result<Self, SkillError> {
        Self::learn_weighted(config, demonstrations, &vec![1.0; demonstrations.len()])
    }

    /// Learns as [`Dmp::learn`] does, each demonstration weighing in Eq. (4) as `weights` tell: one number ≥ 0 per
    /// demonstration, not all zero, of which only the ratios matter; 0 leaves a demonstration out.
    ///
    /// # Errors
    /// As [`Dmp::learn`], and if the weights are not of that kind.
    pub fn learn_weighted(
        config: &DmpConfig,
        demonstrations: &[Trajectory],
        weights: &[f64],
    ) -> Result<Self, SkillError> {
        config.validate()?;
        Self::fit(config, &Self::forcing_samples(config, demonstrations, weights)?, demonstrations, weights)
    }

    /// Gathers the targets of Eq. (5) of all demonstrations, in their order, with the phases of their samples.
    pub(crate) fn forcing_samples(
        config: &DmpConfig,
        demonstrations: &[Trajectory],
        weights: &[f64],
    ) -> Result<ForcingSamples, SkillError> {
        let (attractor, canonical) = (Attractor::new(config.alpha), CanonicalSystem::new(config.gamma));
        learning::forcing_samples(config.form, attractor, canonical, demonstrations, weights)
    }

    /// Fits the forcing term to `samples`, which stem from `demonstrations`; `config` was validated.
    pub(crate) fn fit(
        config: &DmpConfig,
        samples: &ForcingSamples,
        demonstrations: &[Trajectory],
        weights: &[f64],
    ) -> Result<Self, SkillError> {
        let canonical = CanonicalSystem::new(config.gamma);
        let basis = GaussianBasis::uniform_in_time(config.bases, canonical, config.crossing());
        let fitted = match config.form {
            DmpForm::Residual | DmpForm::Eq1Literal => config.regression.regression().fit(samples, &basis)?,
            DmpForm::Scaled => fit_scaled(config, samples, &basis, demonstrations)?,
        };
        let counted = demonstrations.iter().zip(weights).filter(|(_, weight)| **weight > 0.0);
        let ends: Vec<(f64, bool)> = counted.map(|(shown, _)| learning::end_speed(shown)).collect();
        let fades_before_end = ends.iter().any(|(_, rests)| !rests);
        let end_speed = ends.iter().map(|(speed, _)| *speed).fold(0.0, f64::max);
        if !end_speed.is_finite() {
            let (argument, expected) = ("end_speed", "samples whose speeds do not overflow");
            return Err(SkillError::InvalidArgument {
                operation: "learn primitive",
                argument,
                found: end_speed,
                expected,
            });
        }
        Ok(Self {
            form: config.form,
            attractor: Attractor::new(config.alpha),
            forcing: ForcingTerm { canonical, basis, weights: fitted, fades_before_end },
            end_speed,
        })
    }

    /// Replaces the weights W of Eq. (2) by `weights` (n × d as [`Dmp::weights`]), such as those of a
    /// [`crate::regression::RecursiveFit`] that has absorbed further samples.
    ///
    /// # Errors
    /// If the shape is another or a weight is not finite.
    pub fn with_weights(&self, weights: DMatrix<f64>) -> Result<Self, SkillError> {
        let operation = "replace weights";
        if weights.nrows() != self.weights().nrows() {
            let expected = format!("{}, one per basis", self.weights().nrows());
            return Err(SkillError::RowCount { operation, found: weights.nrows(), expected });
        }
        if weights.ncols() != self.dimension() {
            return Err(SkillError::Dimension { operation, found: weights.ncols(), expected: self.dimension() });
        }
        check_finite(operation, &weights)?;
        Ok(Self { forcing: ForcingTerm { weights, ..self.forcing.clone() }, ..self.clone() })
    }

    /// Tells whether both have one form, attractor, phase, basis and fading, so that their weights may be added.
    pub(crate) fn shares_system(&self, other: &Self) -> bool {
        let (mine, others) = (&self.forcing, &other.forcing);
        self.form == other.form
            && self.attractor == other.attractor
            && mine.canonical == others.canonical
            && mine.basis == others.basis
            && mine.fades_before_end == others.fades_before_end
    }

    /// Returns the form of Eq. (1) this was learned in.
    #[must_use]
    pub fn form(&self) -> DmpForm {
        self.form
    }

    /// Returns the weights W of Eq. (2), n × d; per unit of displacement if the form is scaled.
    #[must_use]
    pub fn weights(&self) -> &DMatrix<f64> {
        &self.forcing.weights
    }

    /// Returns the basis functions of Eq. (2).
    #[must_use]
    pub fn basis(&self) -> &GaussianBasis {
        &self.forcing.basis
    }

    /// Returns the canonical system of Eq. (3).
    #[must_use]
    pub fn canonical(&self) -> CanonicalSystem {
        self.forcing.canonical
    }

    /// Returns the greatest speed at which a demonstration ended (Euclidean, unit of the demonstrations per second).
    #[must_use]
    pub fn end_speed(&self) -> f64 {
        self.end_speed
    }

    /// Tells whether the forcing term fades over the last 5 % of the motion instead of the 5 % after it, as it does if a
    /// demonstration ended faster than 5 % of its peak speed.
    ///
    /// The primitive then misses the goal at T by what it is still short of, and settles later: end demonstrations with
    /// a rest to avoid it.
    #[must_use]
    pub fn fades_before_end(&self) -> bool {
        self.forcing.fades_before_end
    }

    /// Starts a motion that is stepped from outside, as inside a control loop; `time_step_s` of the request is only the
    /// step expected, `settle_s` is ignored.
    ///
    /// # Errors
    /// As [`MovementPrimitive::rollout`].
    pub fn stepper(&self, request: &RolloutRequest) -> Result<DmpStepper, SkillError> {
        request.validate(self.dimension())?;
        Ok(DmpStepper::new(self, request))
    }

    /// Rolls the primitive out as [`MovementPrimitive::rollout`] does, with the sum of `couplings` as Δu of Eq. (6), each
    /// evaluated at the beginning of a step and held over it.
    ///
    /// An acceleration of the rollout contains the couplings of the step before it, the first one none.
    ///
    /// # Errors
    /// As [`MovementPrimitive::rollout`], and if a coupling is of another dimension or yields a number that is not finite.
    pub fn rollout_coupled(
        &self,
        request: &RolloutRequest,
        couplings: &[&dyn Coupling],
    ) -> Result<Rollout, SkillError> {
        self.roll(request, |stepper, time_step_s| stepper.step_coupled(time_step_s, couplings))
    }

    fn roll(
        &self,
        request: &RolloutRequest,
        mut step: impl FnMut(&mut DmpStepper, f64) -> Result<(), SkillError>,
    ) -> Result<Rollout, SkillError> {
        let mut stepper = self.stepper(request)?;
        let mut recording = Recording::begin(request, &stepper);
        for time_step_s in request.time_steps_s() {
            step(&mut stepper, time_step_s)?;
            recording.add(&stepper);
        }
        recording.finish()
    }
}

impl MovementPrimitive for Dmp {
    fn dimension(&self) -> usize {
        self.forcing.weights.ncols()
    }

    fn saved(&self) -> SavedPrimitive {
        SavedPrimitive::Dmp(Self::saved(self))
    }

    /// Rolls the primitive out to the requested start, goal and duration.
    ///
    /// The step is exact for a forcing term linear over it, hence of order 2: on a motion of amplitude 0.6 in one second
    /// the error against the solution of Eq. (1) is 6.2e-4 for steps of 0.02 s, 3.9e-5 for 0.005 s and 2.4e-6 for
    /// 0.00125 s (rms), whatever the stiffness. One evaluation of the forcing term per step buys that; Runge and Kutta's
    /// order 4 takes two and is bound to steps below some 5.6τ/α.
    fn rollout(&self, request: &RolloutRequest) -> Result<Rollout, SkillError> {
        self.roll(request, DmpStepper::step)
    }
}

// the scale of a coordinate weighs its samples, so each coordinate is a fit of its own
fn fit_scaled(
    config: &DmpConfig,
    samples: &ForcingSamples,
    basis: &GaussianBasis,
    demonstrations: &[Trajectory],
) -> Result<DMatrix<f64>, SkillError> {
    let mut weights = DMatrix::zeros(basis.count(), samples.targets.ncols());
    for coordinate in 0..samples.targets.ncols() {
        let scaled = learning::scale_by_displacement(samples, coordinate, demonstrations)?;
        let fitted = config.regression.regression().fit(&scaled, basis)?;
        weights.column_mut(coordinate).copy_from(&fitted.column(0));
    }
    Ok(weights)
}
