//! What is learnt: object-operating (O2) skills and the tool-flipping (TF) skills between them.

use nalgebra::{Point2, Vector2};

use crate::demonstration::{Aligned, Demonstration, path};
use crate::error::SkillError;
use crate::outline::Outline;
use crate::primitive::{MovementPrimitive, PrimitiveConfig};
use crate::segmentation::{PushFragment, pushes};
use crate::time_law::minimum_jerk;
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
}

/// What became of the demonstrations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LearningReport {
    /// Names of the demonstrations that were learnt from.
    pub used: Vec<String>,
    /// Names of those that were left out, with the reason.
    pub left_out: Vec<(String, String)>,
    /// Times that the hold was renewed within a push, over all demonstrations used.
    pub renewed_holds: usize,
}

impl SkillLibrary {
    /// Learns from demonstrations with `tool` on an object of outline `object`.
    ///
    /// Demonstrations whose sequence of contact surfaces differs from the most common one are left out and named.
    ///
    /// # Errors
    /// [`SkillError::NoDemonstrations`] if none shows a push; whatever the primitive's learning reports.
    pub fn learn(
        primitive: &PrimitiveConfig,
        demonstrations: &[Demonstration],
        tool: &Tool,
        object: &Outline,
    ) -> Result<(Self, LearningReport), SkillError> {
        let cut: Vec<(Aligned, Vec<PushFragment>)> = demonstrations
            .iter()
            .map(|demonstration| {
                let aligned = demonstration.aligned();
                let fragments = pushes(&aligned, tool, object);
                (aligned, fragments)
            })
            .collect();
        let sequences: Vec<Vec<usize>> =
            cut.iter().map(|(_, fragments)| fragments.iter().map(|fragment| fragment.surface).collect()).collect();
        let common = most_common(&sequences).ok_or(SkillError::NoDemonstrations)?;
        let mut report = LearningReport::default();
        let mut used = Vec::new();
        for ((demonstration, sequence), shown) in demonstrations.iter().zip(&sequences).zip(&cut) {
            if *sequence == common {
                report.used.push(demonstration.name.clone());
                report.renewed_holds += shown.1.iter().map(|fragment| fragment.runs.len() - 1).sum::<usize>();
                used.push(shown);
            } else {
                let reason =
                    format!("used the surfaces {}, most others {}", names(tool, sequence), names(tool, &common));
                report.left_out.push((demonstration.name.clone(), reason));
            }
        }
        let pushes = common.iter().enumerate().map(|(index, &surface)| learn_push(primitive, &used, index, surface));
        let flips = (0..=common.len()).map(|index| learn_flip(primitive, &used, index));
        let library = Self { pushes: pushes.collect::<Result<_, _>>()?, flips: flips.collect::<Result<_, _>>()? };
        Ok((library, report))
    }
}

type Shown<'a> = &'a (Aligned, Vec<PushFragment>);

fn learn_push(
    primitive: &PrimitiveConfig,
    shown: &[Shown<'_>],
    index: usize,
    surface: usize,
) -> Result<ObjectOperatingSkill, SkillError> {
    let mut paths = Vec::new();
    for (aligned, fragments) in shown {
        if let Some(fragment) = fragments.get(index) {
            paths.push(path(&fragment.object_path(aligned), aligned.time_step_s)?);
        }
    }
    let count = paths.len() as f64;
    let displacement =
        paths.iter().map(|path| path.end() - path.start()).map(|d| Vector2::new(d[0], d[1])).sum::<Vector2<f64>>();
    let duration_s = paths.iter().map(|path| path.duration_s()).sum::<f64>() / count;
    Ok(ObjectOperatingSkill {
        surface,
        primitive: primitive.learn(&paths)?,
        displacement: displacement / count,
        duration_s,
    })
}

/// Way of the tool before push `index` (after the last push if there is none of that index), relative to the object.
fn learn_flip(primitive: &PrimitiveConfig, shown: &[Shown<'_>], index: usize) -> Result<ToolFlippingSkill, SkillError> {
    let mut paths = Vec::new();
    for (aligned, fragments) in shown {
        let from = index.checked_sub(1).and_then(|before| fragments.get(before)).map_or(0, PushFragment::end);
        let to = fragments.get(index).map_or(aligned.len(), |fragment| fragment.first() + 1);
        let rows = from.saturating_sub(1)..to;
        let Some((tool, object)) = aligned.tool.get(rows.clone()).zip(aligned.object.get(rows)) else { continue };
        let rest = object.iter().map(|point| point.coords).sum::<Vector2<f64>>() / object.len().max(1) as f64;
        let relative: Vec<_> = tool.iter().map(|pose| Point2::from(pose.translation.vector - rest)).collect();
        paths.push(path(&retimed(&relative), aligned.time_step_s)?);
    }
    let length_m = paths.iter().map(|path| path.path_length()).sum::<f64>() / paths.len().max(1) as f64;
    Ok(ToolFlippingSkill { primitive: primitive.learn(&paths)?, length_m })
}

/// Rows of a retimed way.
const RETIMED_ROWS: usize = 200;

/// The way of a hand without its pauses: the same places, passed with the minimum-jerk time law of one free movement.
///
/// Demonstrations wait at different times for different reasons; only once aligned do they show the same way.
fn retimed(way: &[Point2<f64>]) -> Vec<Point2<f64>> {
    let mut length_m = 0.0;
    let mut marks: Vec<(f64, Point2<f64>)> = Vec::with_capacity(way.len());
    for point in way {
        length_m += marks.last().map_or(0.0, |(_, last)| (point - last).norm());
        marks.push((length_m, *point));
    }
    let at = |along: f64| -> Option<Point2<f64>> {
        let next = marks.partition_point(|(mark, _)| *mark < along).clamp(1, marks.len().saturating_sub(1).max(1));
        let ((from, a), (to, b)) = marks.get(next - 1).zip(marks.get(next))?;
        let share = if to > from { ((along - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        Some(a + (b - a) * share)
    };
    let place = |row: usize| at(length_m * minimum_jerk(row as f64 / (RETIMED_ROWS - 1) as f64));
    (0..RETIMED_ROWS).filter_map(place).collect()
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
