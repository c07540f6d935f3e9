//! Two motions in progress that are coupled to one another.

use super::recording::Recording;
use super::stepper::DmpStepper;
use super::{Dmp, Rollout, RolloutRequest};
use crate::coupling::CooperativeCoupling;
use crate::error::SkillError;

/// Two motions in progress, stepped together under a [`CooperativeCoupling`]; stepping allocates nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct DmpPair {
    first: DmpStepper,
    second: DmpStepper,
    coupling: CooperativeCoupling,
    on_first: Vec<f64>,
    on_second: Vec<f64>,
}

impl DmpPair {
    /// Couples two motions, which may be under way.
    ///
    /// # Errors
    /// If a motion has another dimension than the coupling.
    pub fn new(first: DmpStepper, second: DmpStepper, coupling: CooperativeCoupling) -> Result<Self, SkillError> {
        let expected = coupling.dimension();
        for found in [first.goal().len(), second.goal().len()] {
            if found != expected {
                return Err(SkillError::Dimension { operation: "couple motions", found, expected });
            }
        }
        Ok(Self { first, second, coupling, on_first: vec![0.0; expected], on_second: vec![0.0; expected] })
    }

    /// Advances both motions by `time_step_s` (> 0, s) with Δu₁ and Δu₂ of the coupling at their present states, held
    /// over the step.
    ///
    /// # Errors
    /// If the step is not between 1e-12 and 1e6 durations of either motion, or the coupling overflows; both motions then
    /// stay where they are.
    pub fn step(&mut self, time_step_s: f64) -> Result<(), SkillError> {
        self.on_first.fill(0.0);
        self.on_second.fill(0.0);
        let (first, second) = (self.first.state(), self.second.state());
        self.coupling.add_to_pair(&first, &second, &mut self.on_first, &mut self.on_second);
        self.second.check_step(time_step_s, &self.on_second)?;
        self.first.step_with_coupling(time_step_s, &self.on_first)?;
        self.second.step_with_coupling(time_step_s, &self.on_second)
    }

    /// Returns the first motion.
    #[must_use]
    pub fn first(&self) -> &DmpStepper {
        &self.first
    }

    /// Returns the second motion.
    #[must_use]
    pub fn second(&self) -> &DmpStepper {
        &self.second
    }
}

/// Rolls two primitives out together, each with its request, under `coupling`; a coupling without strength leaves each
/// rollout as it is alone, bit for bit.
///
/// # Errors
/// As [`Dmp::rollout_coupled`] for either, and if the requests differ in duration, step or settling time.
pub fn rollout_pair(
    first: (&Dmp, &RolloutRequest),
    second: (&Dmp, &RolloutRequest),
    coupling: &CooperativeCoupling,
) -> Result<(Rollout, Rollout), SkillError> {
    let (request, other) = (first.1, second.1);
    let shared = [
        ("duration_s", request.duration_s, other.duration_s),
        ("time_step_s", request.time_step_s, other.time_step_s),
        ("settle_s", request.settle_s, other.settle_s),
    ];
    if let Some((argument, _, found)) = shared.into_iter().find(|(_, first, second)| first != second) {
        let (operation, expected) = ("roll out pair", "the same in both requests");
        return Err(SkillError::InvalidArgument { operation, argument, found, expected });
    }
    let mut pair = DmpPair::new(first.0.stepper(request)?, second.0.stepper(other)?, coupling.clone())?;
    let mut recordings = [Recording::begin(request, pair.first()), Recording::begin(other, pair.second())];
    for time_step_s in request.time_steps_s() {
        pair.step(time_step_s)?;
        recordings[0].add(pair.first());
        recordings[1].add(pair.second());
    }
    let [first, second] = recordings;
    Ok((first.finish()?, second.finish()?))
}
