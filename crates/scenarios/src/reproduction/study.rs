//! What the items work on: the transfer scenario, and one run of it with everything that came up on the way.

use std::sync::OnceLock;

use skills::SkillError;
use skills::corridor_filter::FilterError;
use skills::field::FieldError;
use skills::tool_flipping::FlipError;
use skills::transfer::Transfer;

use crate::scenario::ResolvedScenario;
use crate::tasks::push::{CarriedOut, ExecutionMode, ResolvedPush, carry_out};
use crate::tasks::{ResolvedTask, StageError};

/// Why an item could not be reproduced.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A skill refused.
    #[error(transparent)]
    Skill(#[from] SkillError),
    /// A flip was not found.
    #[error(transparent)]
    Flip(#[from] FlipError),
    /// A corridor was not kept.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// An option makes no sense.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// The run did not come to its end.
    #[error("{0}")]
    Run(String),
}

impl From<StageError> for StudyError {
    fn from(error: StageError) -> Self {
        match error {
            StageError::Infeasible(reason) | StageError::Input(reason) | StageError::Broken(reason) => {
                Self::Run(reason)
            }
        }
    }
}

/// Told how many of how many runs are done.
pub type Count<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// The transfer scenario, its run, and how much work may be spent.
pub struct Study<'a> {
    /// The scenario: the paper's first experiment with its second tool.
    pub scenario: &'a ResolvedScenario,
    /// What is particular to a push in it.
    pub push: &'a ResolvedPush,
    /// Seeds of each experiment that is repeated.
    pub trials: u32,
    /// Told of the repetitions.
    pub count: Count<'a>,
    run: OnceLock<CarriedOut>,
}

impl<'a> Study<'a> {
    /// A study of a scenario that transfers a skill; nothing is run yet.
    ///
    /// # Errors
    /// If the scenario is no push.
    pub fn new(scenario: &'a ResolvedScenario, trials: u32, count: Count<'a>) -> Result<Self, StudyError> {
        let push = scenario.as_push().ok_or_else(|| {
            let (name, kind) = (&scenario.name, scenario.kind());
            StudyError::Run(format!("{name} is a task of the kind `{kind}`; expected a push: [task.push]"))
        })?;
        Ok(Self { scenario, push, trials, count, run: OnceLock::new() })
    }

    /// The scenario with its plan carried out in another way.
    pub fn executed(&self, mode: ExecutionMode) -> ResolvedScenario {
        let mut push = self.push.clone();
        push.scenario.execution.mode = mode;
        ResolvedScenario { task: ResolvedTask::Push(Box::new(push)), ..self.scenario.clone() }
    }

    /// The run with the scenario's seed; made once.
    pub fn run(&self) -> Result<&CarriedOut, StudyError> {
        if self.run.get().is_none() {
            let run = carry_out(self.scenario, self.push, self.scenario.header().seed)?;
            return Ok(self.run.get_or_init(|| run));
        }
        self.run.get().ok_or_else(|| StudyError::Run("the run was lost".into()))
    }

    /// The transfer that the run carried out.
    pub fn transfer(&self) -> Result<&Transfer, StudyError> {
        self.run()?.transfer.as_ref().ok_or_else(|| {
            StudyError::Run(format!("{} transfers no skill; expected [task.push.transfer]", self.scenario.name))
        })
    }
}
