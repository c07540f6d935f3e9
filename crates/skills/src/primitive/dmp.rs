//! The dynamic movement primitive of Eqs. (1)–(5): learned from demonstrations, rolled out to another start, goal and
//! duration.
//!
//! Departs from the paper: by default the primitive moves a residual about a minimum-jerk transfer instead of Eq. (1) as
//! printed (see [`DmpForm`]); τ is the duration T; β = α/4; the step is exact for a forcing term linear in time.

mod attractor;
mod config;
mod forcing;
mod learning;
mod stepper;

use nalgebra::DMatrix;

pub use config::{DmpConfig, DmpForm};
pub use stepper::DmpStepper;

use super::{MovementPrimitive, Rollout, RolloutRequest};
use crate::basis::GaussianBasis;
use crate::canonical::CanonicalSystem;
use crate::error::SkillError;
use crate::regression::ForcingSamples;
use crate::trajectory::Trajectory;
use attractor::Attractor;
use forcing::ForcingTerm;

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
    /// Learns the forcing term from one or more demonstrations by Eqs. (4) and (5).
    ///
    /// Demonstrations share the dimension d, unit and frame; starts, goals, durations and sampling may differ, each being
    /// learned in its own time over duration, from its own start to its own end. Where one of them does not come to rest,
    /// the forcing term fades before the end of the motion (see [`Dmp::fades_before_end`]).
    ///
    /// # Errors
    /// If `config` is invalid, there is no demonstration, the dimensions differ, the form is scaled and a coordinate has
    /// no displacement, the samples do not determine the weights, or the derivatives of a demonstration overflow.
    pub fn learn(config: &DmpConfig, demonstrations: &[Trajectory]) -> Result<Self, SkillError> {
        config.validate()?;
        let canonical = CanonicalSystem::new(config.gamma);
        let basis = GaussianBasis::uniform_in_time(config.bases, canonical, config.crossing());
        let attractor = Attractor::new(config.alpha);
        let samples = learning::forcing_samples(config.form, attractor, canonical, demonstrations)?;
        let weights = match config.form {
            DmpForm::Residual | DmpForm::Eq1Literal => config.regression.regression().fit(&samples, &basis)?,
            DmpForm::Scaled => fit_scaled(config, &samples, &basis, demonstrations)?,
        };
        let ends: Vec<(f64, bool)> = demonstrations.iter().map(learning::end_speed).collect();
        let fades_before_end = ends.iter().any(|(_, rests)| !rests);
        let end_speed = ends.iter().map(|(speed, _)| *speed).fold(0.0, f64::max);
        Ok(Self {
            form: config.form,
            attractor,
            forcing: ForcingTerm { canonical, basis, weights, fades_before_end },
            end_speed,
        })
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
}

impl MovementPrimitive for Dmp {
    fn dimension(&self) -> usize {
        self.forcing.weights.ncols()
    }

    fn rollout(&self, request: &RolloutRequest) -> Result<Rollout, SkillError> {
        let mut stepper = self.stepper(request)?;
        let times_s = request.times_s();
        let mut tables = [(); 3].map(|()| DMatrix::zeros(times_s.len(), self.dimension()));
        let mut record = |row: usize, stepper: &DmpStepper| {
            for (table, values) in
                tables.iter_mut().zip([stepper.position(), stepper.velocity(), stepper.acceleration()])
            {
                table.row_mut(row).tr_copy_from(values);
            }
        };
        record(0, &stepper);
        for (row, step_s) in request.time_steps_s().enumerate() {
            stepper.step(step_s)?;
            record(row + 1, &stepper);
        }
        let [positions, velocities, accelerations] = tables;
        Rollout::new(Trajectory::new(times_s, positions)?, velocities, accelerations)
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
