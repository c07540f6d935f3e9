//! A motion of a dynamic movement primitive in progress: step by step, with goal and duration free to change.

use nalgebra::DVector;

use super::attractor::{Attractor, Propagator};
use super::config::DmpForm;
use super::forcing::ForcingTerm;
use super::{Dmp, RolloutRequest};
use crate::coupling::{Coupling, MotionState, add_up};
use crate::error::SkillError;
use crate::primitive::rollout::check_vector;
use crate::time_law::{MinimumJerkTransfer, PathState};

/// Least part of the duration that a changed transfer takes, so that a late change of goal stays gentle.
pub(in crate::primitive) const SHORTEST_TRANSFER: f64 = 0.25;
/// Steps over the duration for which the closed form of the attractor neither underflows nor overflows.
const STEP_RATIOS: std::ops::RangeInclusive<f64> = 1e-12..=1e6;

/// Motion of a [`Dmp`] in progress, Eq. (6) when a coupling is given: τv̇ = α(β(g − x) − v) + f(s) + Δu, τẋ = v.
///
/// All memory is taken when the motion starts: stepping and changes allocate nothing. The same steps give the same bits
/// as a rollout.
#[derive(Debug, Clone, PartialEq)]
pub struct DmpStepper {
    form: DmpForm,
    attractor: Attractor,
    forcing: ForcingTerm,
    propagator: Propagator,
    duration_s: f64,
    elapsed_s: f64,
    // t/τ; advances by dt/τ whatever τ is at the time
    progress: f64,
    start: DVector<f64>,
    goal: DVector<f64>,
    // what the attractor is tied to: the transfer to the goal (residual) or the goal itself
    baselines: Vec<MinimumJerkTransfer>,
    // u = x − baseline and v = τu̇
    offset: DVector<f64>,
    rate: DVector<f64>,
    // f at the present progress, not scaled, and Δu held over the last step; each with scratch
    term: DVector<f64>,
    next_term: DVector<f64>,
    coupling: DVector<f64>,
    next_coupling: DVector<f64>,
    activations: DVector<f64>,
    position: DVector<f64>,
    velocity: DVector<f64>,
    acceleration: DVector<f64>,
}

impl DmpStepper {
    // the request was validated against the dimension of the primitive
    pub(super) fn new(dmp: &Dmp, request: &RolloutRequest) -> Self {
        let dimension = request.start.len();
        let baseline = |k: usize| match dmp.form {
            DmpForm::Residual => {
                let from = PathState { position: request.start[k], ..PathState::default() };
                MinimumJerkTransfer::new(0.0, from, request.goal[k], 1.0)
            }
            DmpForm::Eq1Literal | DmpForm::Scaled => MinimumJerkTransfer::resting(request.goal[k]),
        };
        let baselines: Vec<_> = (0..dimension).map(baseline).collect();
        let offset = DVector::from_fn(dimension, |k, _| request.start[k] - baselines[k].at(0.0).position);
        let rate = match &request.start_velocity {
            Some(velocity) => velocity * request.duration_s,
            None => DVector::zeros(dimension),
        };
        let mut stepper = Self {
            form: dmp.form,
            attractor: dmp.attractor,
            forcing: dmp.forcing.clone(),
            propagator: dmp.attractor.propagator(request.time_step_s / request.duration_s),
            duration_s: request.duration_s,
            elapsed_s: 0.0,
            progress: 0.0,
            start: request.start.clone(),
            goal: request.goal.clone(),
            baselines,
            offset,
            rate,
            term: DVector::zeros(dimension),
            next_term: DVector::zeros(dimension),
            coupling: DVector::zeros(dimension),
            next_coupling: DVector::zeros(dimension),
            activations: DVector::zeros(dmp.forcing.basis.count()),
            position: DVector::zeros(dimension),
            velocity: DVector::zeros(dimension),
            acceleration: DVector::zeros(dimension),
        };
        stepper.forcing.evaluate_into(0.0, &mut stepper.activations, &mut stepper.term);
        stepper.publish();
        // not a rounding away from what was asked
        stepper.position.copy_from(&request.start);
        stepper
    }

    /// Advances by `time_step_s` (> 0, s) without coupling, Eq. (1).
    ///
    /// # Errors
    /// If the step is not between 1e-12 and 1e6 durations.
    pub fn step(&mut self, time_step_s: f64) -> Result<(), SkillError> {
        let ratio = self.ratio(time_step_s)?;
        self.coupling.fill(0.0);
        self.advance(time_step_s, ratio);
        Ok(())
    }

    /// Advances by `time_step_s` (> 0, s) with the coupling Δu of Eq. (6), d values held over the step.
    ///
    /// Δu stands next to the forcing term: an acceleration a (per second squared) is Δu = τ²a, τ being
    /// [`DmpStepper::duration_s`].
    ///
    /// # Errors
    /// If the step is not between 1e-12 and 1e6 durations or the coupling has not d finite values.
    pub fn step_with_coupling(&mut self, time_step_s: f64, coupling: &[f64]) -> Result<(), SkillError> {
        let ratio = self.check_step(time_step_s, coupling)?;
        self.coupling.copy_from_slice(coupling);
        self.advance(time_step_s, ratio);
        Ok(())
    }

    /// Advances by `time_step_s` (> 0, s) with the sum of `couplings` at the present state as Δu of Eq. (6), held.
    ///
    /// # Errors
    /// If the step is not between 1e-12 and 1e6 durations, or a coupling is of another dimension or yields a number that
    /// is not finite; the motion then stays where it is.
    pub fn step_coupled(&mut self, time_step_s: f64, couplings: &[&dyn Coupling]) -> Result<(), SkillError> {
        let ratio = self.ratio(time_step_s)?;
        // taken out, for the state borrows the rest; takes no memory
        let mut sum = std::mem::take(&mut self.next_coupling);
        let evaluated = add_up(couplings, &self.state(), sum.as_mut_slice());
        self.next_coupling = sum;
        evaluated?;
        std::mem::swap(&mut self.coupling, &mut self.next_coupling);
        self.advance(time_step_s, ratio);
        Ok(())
    }

    /// Changes the goal to `goal` (d finite values, unit and frame of the demonstrations) from now on.
    ///
    /// Position and velocity stay continuous. The residual form plans a minimum-jerk transfer from its present state over
    /// what is left of the duration, at least a quarter of it, so that the acceleration is continuous too; the other
    /// forms step it by αβ(g_new − g)/τ², as Eq. (1) implies.
    ///
    /// # Errors
    /// If the goal has another dimension or a value that is not finite.
    pub fn change_goal(&mut self, goal: &[f64]) -> Result<(), SkillError> {
        check_vector("goal", self.goal.len(), goal)?;
        self.goal.copy_from_slice(goal);
        self.replan(1.0);
        self.publish();
        Ok(())
    }

    /// Changes the duration T = τ to `duration_s` (> 0, s) from now on: what is left of the motion, a part 1 − t/τ of it,
    /// takes that part of the new duration.
    ///
    /// Position and velocity stay continuous, the acceleration steps; change the duration little by little to keep the
    /// steps small.
    ///
    /// # Errors
    /// If the duration is not a positive finite number.
    pub fn change_duration(&mut self, duration_s: f64) -> Result<(), SkillError> {
        if !(duration_s > 0.0 && duration_s.is_finite()) {
            return Err(refused("duration_s", duration_s, "a positive finite number"));
        }
        let stretch = duration_s / self.duration_s;
        self.duration_s = duration_s;
        self.rate *= stretch;
        self.replan(stretch);
        self.publish();
        Ok(())
    }

    /// Returns the state a coupling sees.
    #[must_use]
    pub fn state(&self) -> MotionState<'_> {
        MotionState {
            position: self.position.as_slice(),
            velocity: self.velocity.as_slice(),
            elapsed_s: self.elapsed_s,
            duration_s: self.duration_s,
        }
    }

    /// Returns the position, d values, unit and frame of the demonstrations.
    #[must_use]
    pub fn position(&self) -> &DVector<f64> {
        &self.position
    }

    /// Returns the velocity, d values per second.
    #[must_use]
    pub fn velocity(&self) -> &DVector<f64> {
        &self.velocity
    }

    /// Returns the acceleration by the dynamics, d values per second squared; with the coupling of the last step.
    #[must_use]
    pub fn acceleration(&self) -> &DVector<f64> {
        &self.acceleration
    }

    /// Returns the goal, d values, unit and frame of the demonstrations.
    #[must_use]
    pub fn goal(&self) -> &DVector<f64> {
        &self.goal
    }

    /// Returns the duration T = τ, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Returns the time since the motion started, s.
    #[must_use]
    pub fn elapsed_s(&self) -> f64 {
        self.elapsed_s
    }

    /// Returns t/τ, without unit: 0 at the start, 1 at the end of the motion, more while it settles.
    #[must_use]
    pub fn progress(&self) -> f64 {
        self.progress
    }

    // checks a step with a coupling given as numbers and returns dt/τ
    pub(super) fn check_step(&self, time_step_s: f64, coupling: &[f64]) -> Result<f64, SkillError> {
        check_vector("coupling", self.goal.len(), coupling)?;
        self.ratio(time_step_s)
    }

    fn ratio(&self, time_step_s: f64) -> Result<f64, SkillError> {
        let ratio = time_step_s / self.duration_s;
        if STEP_RATIOS.contains(&ratio) {
            return Ok(ratio);
        }
        Err(refused("time_step_s", time_step_s, "a number from 1e-12 to 1e6 durations"))
    }

    fn advance(&mut self, time_step_s: f64, ratio: f64) {
        if ratio != self.propagator.ratio {
            self.propagator = self.attractor.propagator(ratio);
        }
        self.progress += ratio;
        self.elapsed_s += time_step_s;
        self.forcing.evaluate_into(self.progress, &mut self.activations, &mut self.next_term);
        for k in 0..self.goal.len() {
            let from = self.scale(k) * self.term[k] + self.coupling[k];
            let to = self.scale(k) * self.next_term[k] + self.coupling[k];
            (self.offset[k], self.rate[k]) = self.propagator.step(self.offset[k], self.rate[k], from, to);
        }
        std::mem::swap(&mut self.term, &mut self.next_term);
        self.publish();
    }

    // sums baseline and offset to position, velocity and acceleration at the present progress
    fn publish(&mut self) {
        let tau = self.duration_s;
        for k in 0..self.goal.len() {
            let baseline = self.baselines[k].at(self.progress);
            let forcing = self.scale(k) * self.term[k] + self.coupling[k];
            let second = self.attractor.acceleration(self.offset[k], self.rate[k], forcing);
            self.position[k] = baseline.position + self.offset[k];
            self.velocity[k] = (baseline.first + self.rate[k]) / tau;
            self.acceleration[k] = (baseline.second + second) / (tau * tau);
        }
    }

    // ties the attractor to the present goal; `stretch` is new over old duration
    fn replan(&mut self, stretch: f64) {
        for k in 0..self.goal.len() {
            let mut present = self.baselines[k].at(self.progress);
            match self.form {
                DmpForm::Residual => {
                    present.first *= stretch;
                    present.second *= stretch * stretch;
                    let horizon = (1.0 - self.progress).max(SHORTEST_TRANSFER);
                    self.baselines[k] = MinimumJerkTransfer::new(self.progress, present, self.goal[k], horizon);
                }
                DmpForm::Eq1Literal | DmpForm::Scaled => {
                    self.offset[k] += present.position - self.goal[k];
                    self.baselines[k] = MinimumJerkTransfer::resting(self.goal[k]);
                }
            }
        }
    }

    fn scale(&self, k: usize) -> f64 {
        match self.form {
            DmpForm::Residual | DmpForm::Eq1Literal => 1.0,
            DmpForm::Scaled => self.goal[k] - self.start[k],
        }
    }
}

fn refused(argument: &'static str, found: f64, expected: &'static str) -> SkillError {
    SkillError::InvalidArgument { operation: "step primitive", argument, found, expected }
}
