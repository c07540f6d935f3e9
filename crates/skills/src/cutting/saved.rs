//! A cutting skill as plain data, for files.

use serde::{Deserialize, Serialize};

use super::learning::{COORDINATES, CutSkill, LARGEST_ROCK_RAD, ShownStroke, ShownWhole};
use crate::field::{FieldError, finite, not_negative, positive, within};
use crate::primitive::RestoreError;
use crate::primitive::pose::{SavedPose, checked};
use crate::separation::constraint_based::SavedConstraintBased;

/// Everything that a [`CutSkill`] plans with; restored, its plans are equal bit by bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedCut {
    /// What the demonstrated stroke was like.
    pub shown: ShownStroke,
    /// The skill of draw, depth and rocking, lengths over the depth of the stroke.
    pub stroke: SavedConstraintBased,
    /// Where the whole demonstration was shown.
    pub whole: ShownWhole,
    /// Primitive of the whole demonstration.
    pub plain: SavedPose,
}

impl CutSkill {
    /// Returns everything that it plans with, as plain data.
    #[must_use]
    pub fn saved(&self) -> SavedCut {
        SavedCut { shown: self.shown, stroke: self.stroke.saved(), whole: self.whole, plain: self.plain.saved() }
    }
}

impl SavedCut {
    /// Checks the data and makes a skill of them.
    ///
    /// # Errors
    /// A [`RestoreError`] naming the value that cannot be that of a learned cut.
    pub fn restore(self) -> Result<CutSkill, RestoreError> {
        check_stroke(&self.shown).map_err(|error| error.within("shown"))?;
        check_whole(&self.whole).map_err(|error| error.within("whole"))?;
        let plain = self.plain.restore();
        Ok(CutSkill {
            stroke: self.stroke.restore(COORDINATES).map_err(|error| error.within("stroke"))?,
            shown: self.shown,
            plain: plain.map_err(|source| RestoreError::Pose { path: "plain".into(), source })?,
            whole: self.whole,
        })
    }
}

fn check_stroke(shown: &ShownStroke) -> Result<(), FieldError> {
    positive("duration_s", shown.duration_s)?;
    positive("travel_m", shown.travel_m)?;
    finite("slice_push_ratio", &[shown.slice_push_ratio])?;
    within("rock_rad", shown.rock_rad, -2.0 * LARGEST_ROCK_RAD, 2.0 * LARGEST_ROCK_RAD)?;
    positive("lift_m", shown.lift_m)?;
    let across = &shown.out_of_plane;
    let named = [("lateral_m", across.lateral_m), ("tilt_rad", across.tilt_rad), ("yaw_rad", across.yaw_rad)];
    named.iter().try_for_each(|(name, value)| not_negative(name, *value)).map_err(|error| error.within("out_of_plane"))
}

fn check_whole(whole: &ShownWhole) -> Result<(), FieldError> {
    whole.section.validate().map_err(|error| error.within("section"))?;
    for (index, pose) in whole.ends.iter().enumerate() {
        checked(index, pose).map_err(|error| FieldError::new(format!("ends.{index}"), error, "a pose"))?;
    }
    positive("duration_s", whole.duration_s)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Translation3, Vector3};
    use rand::SeedableRng;

    use super::*;
    use crate::cutting::{Blade, CutHuman, CutLearning, CutTask, Section};

    fn down() -> Isometry3<f64> {
        Isometry3::rotation(Vector3::x() * -std::f64::consts::FRAC_PI_2)
    }

    fn learned() -> CutSkill {
        let food =
            Section { world_from_section: Translation3::new(0.4, 0.1, 0.2) * down(), width_m: 0.03, height_m: 0.03 };
        let random = rand_chacha::ChaCha8Rng::seed_from_u64(4);
        let human = CutHuman { rock_rad: 0.2, ..CutHuman::default() };
        let shown = human.demonstrate(&food, &Blade::default(), random).unwrap();
        CutSkill::learn(&CutLearning::default(), &shown).unwrap()
    }

    #[test]
    fn a_restored_skill_plans_the_same_bits() {
        let skill = learned();
        let text = serde_json::to_string(&skill.saved()).unwrap();
        let restored = serde_json::from_str::<SavedCut>(&text).unwrap().restore().unwrap();
        assert_eq!(restored.saved(), skill.saved());
        let wide = Section { world_from_section: down(), width_m: 0.05, height_m: 0.04 };
        let task = CutTask::new(Isometry3::translation(0.0, -0.1, 0.2) * down(), Blade::default(), vec![wide]);
        assert_eq!(restored.plan(&task).unwrap(), skill.plan(&task).unwrap());
        let plans = [restored.plain_dmp(&task).unwrap(), skill.plain_dmp(&task).unwrap()];
        assert_eq!(plans[0].plan, plans[1].plan);
    }

    #[test]
    fn what_cannot_be_that_of_a_cut_is_refused_by_its_place() {
        let place = |change: &dyn Fn(&mut SavedCut)| {
            let mut saved = learned().saved();
            change(&mut saved);
            saved.restore().unwrap_err().path().to_owned()
        };
        assert_eq!(place(&|saved| saved.shown.travel_m = 0.0), "shown.travel_m");
        assert_eq!(place(&|saved| saved.shown.out_of_plane.yaw_rad = f64::NAN), "shown.out_of_plane.yaw_rad");
        assert_eq!(place(&|saved| saved.whole.section.width_m = -1.0), "whole.section.width_m");
        assert_eq!(place(&|saved| saved.whole.ends[1].translation.x = f64::NAN), "whole.ends.1");
        assert_eq!(place(&|saved| saved.plain.end_speed = f64::NAN), "plain");
        let two = |saved: &mut SavedCut| {
            let crate::primitive::SavedPrimitive::Dmp(dmp) = &mut saved.stroke.primitive else {
                panic!("another kind")
            };
            dmp.weights.iter_mut().for_each(|row| row.truncate(2));
        };
        assert_eq!(place(&two), "stroke.primitive");
    }
}
