//! The skill of a pour: learned from a demonstration or read from a file, and what a file keeps of it.

use skills::pouring::{PourSkill, SavedPour};

use super::demonstrations::Shown;
use super::{KIND, PourTask, refused};
use crate::scenario::{KeptSkills, Origin, SavedSkills, SkillsFile};
use crate::tasks::StageError;

impl SavedSkills for SavedPour {
    const TASK: &'static str = KIND.name;
    const HELD: &'static str = "cup";
    const EXAMPLE: (&'static str, &'static str) =
        ("assets/skills/pour_wide_cup.toml", include_str!("../../../../../assets/skills/pour_wide_cup.toml"));

    fn lines(&self) -> Vec<String> {
        vec![format!(
            "approach and tilt in {:.1} s, the lip at {:.2} radii of the mouth from its middle",
            self.whole.duration_s, self.over
        )]
    }

    fn summary(&self) -> String {
        format!("pour with the lip at {:.2} radii of the mouth", self.over)
    }
}

/// Learns from what was shown, or builds anew what was learned before.
pub(super) fn learn(task: &PourTask<'_>, shown: &Shown) -> Result<PourSkill, StageError> {
    match (&task.pour.learned, &shown.demonstration) {
        (Some(file), _) => file.skills.clone().restore().map_err(|error| StageError::Broken(error.to_string())),
        (None, Some(demonstration)) => PourSkill::learn(&task.file().learning, demonstration).map_err(refused),
        (None, None) => Err(StageError::Broken("learn pour: nothing was shown".into())),
    }
}

/// Takes the skill down with its origin.
pub(super) fn kept(task: &PourTask<'_>, shown: &Shown, skill: &PourSkill) -> Result<KeptSkills, StageError> {
    let origin = task.pour.learned.as_ref().map_or_else(
        || Origin {
            scenario: task.scenario.name.clone(),
            seed: task.seed,
            tool: task.pour.shown_source_name().to_owned(),
            demonstrations: vec![shown.name.clone()],
        },
        |file| file.learned.clone(),
    );
    SkillsFile::new(origin, skill.saved()).kept().map_err(StageError::Broken)
}
