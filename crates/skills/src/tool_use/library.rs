//! What is learned: object-operating (O2) skills and the tool-flipping (TF) skills between them.

use nalgebra::{Point2, Vector2};

use super::intention::Intention;
use super::refusal::LearnError;
use crate::demonstration::{Aligned, Demonstration, path};
use crate::error::SkillError;
use crate::outline::Outline;
use crate::primitive::{MovementPrimitive, PrimitiveConfig};
use crate::segmentation::{PushFragment, pushes};
use crate::tool::Tool;

/// How an object moves under one contact surface.
pub struct ObjectOperatingSkill {
    /// Index of the contact surface that was used.
    pub surface: usize,
    /// Path of the object's center, world axes, m.
    pub primitive: Box<dyn MovementPrimitive>,
    /// Mean displacement of the object over the demonstrations, m.
    pub displacement: Vector2<f64>,
    /// Mean duration in the demonstrations, s.
    pub duration_s: f64,
}

/// How the tool goes from one hold to the next, seen from the object, which rests meanwhile.
pub struct ToolFlippingSkill {
    /// Place of the tool's origin relative to the object's center, world axes, m.
    pub primitive: Box<dyn MovementPrimitive>,
    /// Mean length of the way in the demonstrations, m.
    pub length_m: f64,
}

/// Skills of a task in their order: a flip before the first push, between pushes and after the last one.
pub struct SkillLibrary {
    /// The pushes.
    pub pushes: Vec<ObjectOperatingSkill>,
    /// The ways of the tool before, between and after them: one more than there are pushes.
    pub flips: Vec<ToolFlippingSkill>,
    /// Where the object was to go, whatever the tool.
    pub intention: Intention,
    /// Kind of the primitives, for ways that no demonstration shows.
    pub(super) primitive: PrimitiveConfig,
}

/// What became of the demonstrations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LearningReport {
    /// Names of the demonstrations that were learned from.
    pub used: Vec<String>,
    /// Names of those that were left out, with the reason.
    pub left_out: Vec<(String, String)>,
    /// Times that the hold was renewed within a push, over all demonstrations used.
    pub renewed_holds: usize,
}

/// A demonstration whose tool is turned by more than this is left out, rad: hands keep an angle more closely.
const TURNED_RAD: f64 = 0.2;

impl SkillLibrary {
    /// Learns from demonstrations with `tool` on an object of outline `object`.
    ///
    /// Left out and named are demonstrations without a push, those whose tool does not keep its axes along the world's,
    /// and those whose sequence of contact surfaces differs from the most common one (of equally common ones the first).
    ///
    /// # Errors
    /// [`LearnError::NoPush`] if none is left; whatever the primitive's learning reports.
    pub fn learn(
        primitive: &PrimitiveConfig,
        demonstrations: &[Demonstration],
        tool: &Tool,
        object: &Outline,
    ) -> Result<(Self, LearningReport), LearnError> {
        let cut: Vec<Shown> = demonstrations
            .iter()
            .map(|demonstration| {
                let aligned = demonstration.aligned();
                let fragments = pushes(&aligned, tool, object);
                (aligned, fragments)
            })
            .collect();
        let (used, report) = select(demonstrations, &cut, tool);
        let Some((_, common)) = used.first() else {
            return Err(LearnError::NoPush { found: demonstrations.len(), reasons: bracketed(&report.left_out) });
        };
        let learn_push = |(index, fragment): (usize, &PushFragment)| {
            ObjectOperatingSkill::learn(primitive, &used, index, fragment.surface)
        };
        let pushes = common.iter().enumerate().map(learn_push).collect::<Result<_, _>>()?;
        let flips = (0..=common.len()).map(|index| ToolFlippingSkill::learn(primitive, &used, index));
        let flips = flips.collect::<Result<_, _>>()?;
        let intention = Intention::learn(primitive, &used, tool)?;
        Ok((Self { pushes, flips, intention, primitive: primitive.clone() }, report))
    }

    /// A way that was not shown, through the given places relative to the object's center.
    pub(super) fn way_along(&self, places: Vec<Point2<f64>>) -> Result<ToolFlippingSkill, SkillError> {
        ToolFlippingSkill::along(&self.primitive, &[places])
    }
}

/// A demonstration on one clock, cut into its pushes.
pub(super) type Shown = (Aligned, Vec<PushFragment>);

/// The demonstrations to learn from, and what is to be said of all.
fn select<'a>(demonstrations: &[Demonstration], cut: &'a [Shown], tool: &Tool) -> (Vec<&'a Shown>, LearningReport) {
    let sequences: Vec<Vec<usize>> = cut
        .iter()
        .filter(|(aligned, fragments)| turned_rad(aligned, fragments) <= TURNED_RAD)
        .map(|(_, fragments)| surfaces(fragments))
        .collect();
    let common = most_common(&sequences).unwrap_or_default();
    let mut report = LearningReport::default();
    let mut used = Vec::new();
    for (demonstration, shown) in demonstrations.iter().zip(cut) {
        let (aligned, fragments) = shown;
        let turned = turned_rad(aligned, fragments);
        let reason = if fragments.is_empty() {
            "shows no push".to_owned()
        } else if turned > TURNED_RAD {
            format!("holds the tool turned by {turned:.2} rad")
        } else if surfaces(fragments) != common {
            format!("pushes with {}, not with {}", names(tool, &surfaces(fragments)), names(tool, &common))
        } else {
            report.used.push(demonstration.name.clone());
            report.renewed_holds +=
                fragments.iter().map(|fragment| fragment.runs.len().saturating_sub(1)).sum::<usize>();
            used.push(shown);
            continue;
        };
        report.left_out.push((demonstration.name.clone(), reason));
    }
    (used, report)
}

fn surfaces(fragments: &[PushFragment]) -> Vec<usize> {
    fragments.iter().map(|fragment| fragment.surface).collect()
}

/// Mean angle by which the tool is turned while it pushes, without sign, rad.
fn turned_rad(aligned: &Aligned, fragments: &[PushFragment]) -> f64 {
    let rows = fragments.iter().filter_map(|fragment| aligned.tool.get(fragment.first()..fragment.end()));
    let angles: Vec<f64> = rows.flatten().map(|pose| pose.rotation.angle()).collect();
    (angles.iter().sum::<f64>() / angles.len().max(1) as f64).abs()
}

impl ObjectOperatingSkill {
    /// Learns push `index` of all demonstrations.
    fn learn(primitive: &PrimitiveConfig, shown: &[&Shown], index: usize, surface: usize) -> Result<Self, SkillError> {
        let mut paths = Vec::new();
        for (aligned, fragments) in shown {
            if let Some(fragment) = fragments.get(index) {
                paths.push(path(&fragment.object_path(aligned), aligned.time_step_s)?);
            }
        }
        let count = paths.len().max(1) as f64;
        let ways = paths.iter().map(|path| path.end() - path.start()).map(|way| Vector2::new(way[0], way[1]));
        let displacement = ways.sum::<Vector2<f64>>() / count;
        let duration_s = paths.iter().map(|path| path.duration_s()).sum::<f64>() / count;
        Ok(Self { surface, primitive: primitive.learn(&paths)?, displacement, duration_s })
    }
}

fn most_common(sequences: &[Vec<usize>]) -> Option<Vec<usize>> {
    let shown = sequences.iter().filter(|sequence| !sequence.is_empty());
    let count = |sequence: &Vec<usize>| sequences.iter().filter(|other| *other == sequence).count();
    // of equally common ones the first shown wins
    shown.rev().max_by_key(|sequence| count(sequence)).cloned()
}

fn names(tool: &Tool, sequence: &[usize]) -> String {
    let names = sequence.iter().filter_map(|surface| tool.surfaces.get(*surface)).map(|surface| surface.name.as_str());
    let joined = names.collect::<Vec<_>>().join(" - ");
    if joined.is_empty() { "(no push)".into() } else { joined }
}

fn bracketed(left_out: &[(String, String)]) -> String {
    let all: Vec<String> = left_out.iter().map(|(name, reason)| format!("{name} {reason}")).collect();
    if all.is_empty() { String::new() } else { format!(" ({})", all.join("; ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_equally_common_sequences_the_first_shown_wins() {
        let sequences = |all: &[&[usize]]| all.iter().map(|one| one.to_vec()).collect::<Vec<_>>();
        assert_eq!(most_common(&sequences(&[&[1], &[0, 1], &[0, 1], &[1]])), Some(vec![1]));
        assert_eq!(most_common(&sequences(&[&[1], &[0, 1], &[0, 1]])), Some(vec![0, 1]));
        assert_eq!(most_common(&sequences(&[&[], &[], &[0]])), Some(vec![0]));
        assert_eq!(most_common(&sequences(&[&[]])), None);
        assert_eq!(most_common(&[]), None);
    }
}
