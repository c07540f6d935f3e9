//! A push with everything that came up on the way, for those who want more than its outcome.

use sim::planar::Episode;
use skills::demonstration::Demonstration;
use skills::plan::Plan;
use skills::tool_use::SkillLibrary;
use skills::transfer::Transfer;

use super::{PushTask, ResolvedPush, StageError};
use crate::outcome::Outcome;
use crate::scenario::ResolvedScenario;
use crate::tasks::Task;

/// What each verb of a push gave.
pub struct CarriedOut {
    /// What was shown.
    pub demonstrations: Vec<Demonstration>,
    /// What was learned.
    pub library: SkillLibrary,
    /// What was to be carried out.
    pub plan: Plan,
    /// What the plan was made of, if the skill was transferred.
    pub transfer: Option<Transfer>,
    /// What happened.
    pub episode: Episode,
    /// How well it was done.
    pub outcome: Outcome,
}

/// Carries a push out, from its demonstrations to its outcome.
pub fn carry_out(scenario: &ResolvedScenario, push: &ResolvedPush, seed: u64) -> Result<CarriedOut, StageError> {
    let task = PushTask::new(scenario, push, seed);
    let shown = task.demonstrations(&|_, _| {})?;
    let learned = task.learn(&shown)?;
    let checked = task.plan(&learned)?;
    let episode = task.simulate(&checked, &mut ())?;
    let outcome = task.judge(&shown, &learned, &checked, &episode);
    Ok(CarriedOut {
        demonstrations: shown.demonstrations,
        library: learned.library,
        plan: checked.plan,
        transfer: checked.transfer,
        episode,
        outcome,
    })
}
