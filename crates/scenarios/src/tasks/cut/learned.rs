//! The skill of a cut: learned from a demonstration or read from a file, and what a file keeps of it.

use skills::cutting::{CutSkill, SavedCut};

use super::demonstrations::Shown;
use super::{CutTask, KIND};
use crate::scenario::{KeptSkills, Origin, SavedSkills, SkillsFile};
use crate::tasks::StageError;

impl SavedSkills for SavedCut {
    const TASK: &'static str = KIND.name;
    const HELD: &'static str = "knife";
    const EXAMPLE: (&'static str, &'static str) =
        ("assets/skills/cut_cylinder.toml", include_str!("../../../../../assets/skills/cut_cylinder.toml"));

    fn lines(&self) -> Vec<String> {
        let stroke = &self.shown;
        vec![format!(
            "stroke of {:.0} mm in {:.1} s, slice-push ratio {:.2}, rocking {:.2} rad",
            1e3 * stroke.travel_m,
            stroke.duration_s,
            stroke.slice_push_ratio,
            stroke.rock_rad
        )]
    }

    fn summary(&self) -> String {
        format!("cut at a slice-push ratio of {:.2}", self.shown.slice_push_ratio)
    }
}

/// Learns from what was shown, or builds anew what was learned before.
pub(super) fn learn(task: &CutTask<'_>, shown: &Shown) -> Result<CutSkill, StageError> {
    match (&task.cut.learned, &shown.demonstration) {
        (Some(file), _) => file.skills.clone().restore().map_err(|error| StageError::Broken(error.to_string())),
        (None, Some(demonstration)) => CutSkill::learn(&task.cut.scenario.learning, demonstration)
            .map_err(|error| StageError::Infeasible(error.to_string())),
        (None, None) => Err(StageError::Broken("learn cut: nothing was shown".into())),
    }
}

/// Takes the skill down with its origin.
pub(super) fn kept(task: &CutTask<'_>, shown: &Shown, skill: &CutSkill) -> Result<KeptSkills, StageError> {
    let origin = task.cut.learned.as_ref().map_or_else(
        || Origin {
            scenario: task.scenario.name.clone(),
            seed: task.seed,
            tool: task.cut.shown_knife_name().to_owned(),
            demonstrations: vec![shown.name.clone()],
        },
        |file| file.learned.clone(),
    );
    SkillsFile::new(origin, skill.saved()).kept().map_err(StageError::Broken)
}
