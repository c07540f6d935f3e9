//! A pouring skill as plain data, for files.

use serde::{Deserialize, Serialize};

use super::approach;
use super::learning::{PourSkill, ShownPour};
use crate::error::SkillError;
use crate::field::{FieldError, positive, within};
use crate::primitive::pose::{SavedPose, checked};
use crate::primitive::{MovementPrimitive, RestoreError, SavedDmp};
use crate::separation::constraint_based::SavedConstraintBased;

/// Coordinates of the lip's own way: along the direction of pouring, and height.
const TILT_COORDINATES: usize = 2;
/// Farthest place of the lip, in radii of the mouth.
const FARTHEST_OVER: f64 = 100.0;

/// Everything that a [`PourSkill`] plans with; restored, its plans are equal bit by bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedPour {
    /// Place of the lip over the mouth at the end, in radii of the mouth.
    pub over: f64,
    /// The approach, free of its corridor.
    pub approach: SavedConstraintBased,
    /// The lip's own way about the mouth over the part of the tilt.
    pub tilt: SavedDmp,
    /// Where the demonstration was shown.
    pub whole: ShownPour,
    /// Primitive of the demonstration up to its greatest tilt.
    pub plain: SavedPose,
}

impl PourSkill {
    /// Returns everything that it plans with, as plain data.
    #[must_use]
    pub fn saved(&self) -> SavedPour {
        SavedPour {
            over: self.over,
            approach: self.approach.saved(),
            tilt: self.tilt.saved(),
            whole: self.whole,
            plain: self.plain.saved(),
        }
    }
}

impl SavedPour {
    /// Checks the data and makes a skill of them.
    ///
    /// # Errors
    /// A [`RestoreError`] naming the value that cannot be that of a learned pour.
    pub fn restore(self) -> Result<PourSkill, RestoreError> {
        within("over", self.over, -FARTHEST_OVER, FARTHEST_OVER)?;
        check_whole(&self.whole).map_err(|error| error.within("whole"))?;
        let refused = |source: SkillError| RestoreError::Primitive { path: "tilt".into(), source };
        let tilt = self.tilt.restore().map_err(refused)?;
        let found = tilt.dimension();
        if found != TILT_COORDINATES {
            let operation = "restore primitive";
            return Err(refused(SkillError::Dimension { operation, found, expected: TILT_COORDINATES }));
        }
        let plain = self.plain.restore();
        Ok(PourSkill {
            approach: self.approach.restore(approach::COORDINATES).map_err(|error| error.within("approach"))?,
            tilt,
            over: self.over,
            plain: plain.map_err(|source| RestoreError::Pose { path: "plain".into(), source })?,
            whole: self.whole,
        })
    }
}

fn check_whole(whole: &ShownPour) -> Result<(), FieldError> {
    let poses = [("world_from_pour", &whole.world_from_pour), ("steepest", &whole.steepest)];
    for (field, pose) in poses {
        checked(0, pose).map_err(|error| FieldError::new(field, error, "a pose"))?;
    }
    positive("duration_s", whole.duration_s)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Point3};
    use rand::SeedableRng;

    use super::*;
    use crate::corridor_map::{CorridorMapConfig, Proximal};
    use crate::pouring::{Container, Mouth, PourHuman, PourLearning, PourTask};

    fn bowl() -> Mouth {
        Mouth { center_world: Point3::new(0.5, 0.0, 0.06), radius_m: 0.06, wall_m: 0.003, shoulder: None }
    }

    fn learned() -> PourSkill {
        let random = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        let start = Isometry3::translation(0.2, 0.1, 0.0);
        let shown = PourHuman::default().demonstrate(&Container::default(), &bowl(), &start, random).unwrap();
        PourSkill::learn(&PourLearning::default(), &shown).unwrap()
    }

    #[test]
    fn a_restored_skill_plans_the_same_bits() {
        let skill = learned();
        let text = serde_json::to_string(&skill.saved()).unwrap();
        let restored = serde_json::from_str::<SavedPour>(&text).unwrap().restore().unwrap();
        assert_eq!(restored.saved(), skill.saved());
        let elsewhere = Mouth { center_world: Point3::new(0.4, 0.2, 0.1), radius_m: 0.05, ..bowl() };
        let task = PourTask::new(Isometry3::translation(0.2, 0.0, 0.0), Container::default(), elsewhere);
        assert_eq!(restored.plan(&task).unwrap().plan, skill.plan(&task).unwrap().plan);
        assert_eq!(restored.plain_dmp(&task).unwrap().plan, skill.plain_dmp(&task).unwrap().plan);
    }

    #[test]
    fn what_cannot_be_that_of_a_pour_is_refused_by_its_place() {
        let place = |change: &dyn Fn(&mut SavedPour)| {
            let mut saved = learned().saved();
            change(&mut saved);
            saved.restore().unwrap_err().path().to_owned()
        };
        assert_eq!(place(&|saved| saved.over = f64::NAN), "over");
        assert_eq!(place(&|saved| saved.whole.duration_s = 0.0), "whole.duration_s");
        assert_eq!(place(&|saved| saved.whole.steepest.translation.y = f64::INFINITY), "whole.steepest");
        assert_eq!(place(&|saved| saved.tilt.weights.iter_mut().for_each(|row| row.truncate(1))), "tilt");
        assert_eq!(place(&|saved| saved.plain.end_speed = f64::NAN), "plain");
        let map = |strength| CorridorMapConfig::Proximal(Proximal { strength });
        assert_eq!(place(&|saved| saved.approach.map = map(-1.0)), "approach.map.proximal.strength");
    }
}
