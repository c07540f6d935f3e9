//! The demonstration of one cut: shown by a synthetic human, or recorded.

use nalgebra::Isometry3;
use sim::cutting::scene::knife_from_tool;
use sim::random::{Purpose, stream};
use skills::cutting::{CutDemonstration, CutSkill};
use skills::primitive::pose::PoseTrajectory;
use skills::spatial::HandConfig;

use super::CutTask;
use super::holding::LevelEdge;
use super::places::{extent_m, lying, place};
use super::recorded;
use super::sections::{DemonstrationsConfig, RecordedConfig, SyntheticConfig};
use crate::pipeline::Progress;
use crate::tasks::{DemonstrationTrial, ShownTrial, StageError};

/// Trials that a human may spend on each demonstration wanted.
const TRIALS_PER_DEMONSTRATION: usize = 4;

/// A demonstration of a cut.
pub(crate) struct Shown {
    /// The one to learn from.
    pub demonstration: CutDemonstration,
    /// Trials that failed before it, with the reason.
    pub failed: Vec<String>,
}

/// One trial of the human.
struct Trial {
    demonstration: CutDemonstration,
    /// Why nothing can be learned from it.
    failure: Option<String>,
}

/// Takes the recorded demonstration, or lets the synthetic human show one.
pub(super) fn obtain(task: &CutTask<'_>, progress: Progress<'_>) -> Result<Shown, StageError> {
    match &task.cut.scenario.demonstrations {
        DemonstrationsConfig::Recorded(config) => {
            let demonstration = recorded_cut(task, config)?;
            Ok(Shown { demonstration, failed: Vec::new() })
        }
        DemonstrationsConfig::Synthetic(config) => {
            let (mut shown, mut failed) = (None, Vec::new());
            run_trials(task, config, 1, progress, &mut |number, trial| {
                match trial.failure {
                    Some(reason) => failed.push(format!("trial {number}: {reason}")),
                    None => shown = Some(trial.demonstration),
                }
                Ok(())
            })?;
            let missing = || StageError::Broken("demonstrate: no trial was handed on".into());
            Ok(Shown { demonstration: shown.ok_or_else(missing)?, failed })
        }
    }
}

/// Lets the synthetic human show the cut, and hands on each trial with the text of its file.
pub(super) fn show(
    task: &CutTask<'_>,
    count: Option<usize>,
    progress: Progress<'_>,
    each: &mut dyn FnMut(ShownTrial) -> Result<(), StageError>,
) -> Result<(), StageError> {
    let DemonstrationsConfig::Synthetic(config) = &task.cut.scenario.demonstrations else {
        return Err(StageError::Input(
            "the scenario has a recorded demonstration already; expected [demonstrations.synthetic], a human who can show \
             the cut"
                .into(),
        ));
    };
    run_trials(task, config, count.unwrap_or(1), progress, &mut |number, trial| each(written(task, number, &trial)))
}

/// Lets the human try until `count` trials succeeded; too few successes are an error once patience ends.
fn run_trials(
    task: &CutTask<'_>,
    config: &SyntheticConfig,
    count: usize,
    progress: Progress<'_>,
    each: &mut dyn FnMut(usize, Trial) -> Result<(), StageError>,
) -> Result<(), StageError> {
    let scenario = &task.cut.scenario;
    let (food, knife) = (&task.cut.shown_food, &task.cut.shown_knife);
    let top_m = scenario.board.top_m();
    let food = food.food().map_err(|error| StageError::Input(format!("food of the demonstration: {error}")))?;
    let world_from_food = lying(&food, scenario.cut().food_at_m, scenario.cut().food_angle_rad, top_m);
    let along_m = config.at_share * extent_m(&food, &world_from_food).0;
    let section = place(&food, &world_from_food, top_m, along_m, 0.0).map_err(StageError::Input)?.section;
    let blade = LevelEdge::of(knife).blade;
    let (most, mut successes, mut reasons) = (count * TRIALS_PER_DEMONSTRATION, 0, Vec::new());
    for number in 1..=most {
        if successes == count {
            break;
        }
        let random = stream(task.seed, Purpose::Hand, number as u64 - 1);
        let shown = config.human.demonstrate(&section, &blade, random);
        let demonstration = shown.map_err(|error| StageError::Input(format!("demonstrate: {error}")))?;
        let failure = CutSkill::learn(&scenario.learning, &demonstration).err().map(|error| error.to_string());
        match &failure {
            Some(reason) => reasons.push(reason.clone()),
            None => successes += 1,
        }
        each(number, Trial { demonstration, failure })?;
        progress("demonstrate", Some(successes as f64 / count as f64));
    }
    if successes == count {
        return Ok(());
    }
    Err(StageError::Infeasible(format!(
        "demonstrate: {successes} of {count} cuts could be learned from in {most} trials ({}); expected all; let the human \
         cut slower, or another food",
        reasons.join("; "),
    )))
}

/// The recorded cut, in the section that the scenario says it was shown in.
fn recorded_cut(task: &CutTask<'_>, config: &RecordedConfig) -> Result<CutDemonstration, StageError> {
    let (food, knife) = (&task.cut.shown_food, &task.cut.shown_knife);
    let Some(poses) = &task.cut.recorded else {
        return Err(StageError::Broken("demonstrate: the recording was not read".into()));
    };
    let food = food.food().map_err(|error| StageError::Input(format!("food of the demonstration: {error}")))?;
    let world_from_food = lying(&food, config.food_at_m, config.food_angle_rad, config.board_top_m);
    let along_m = config.at_share * extent_m(&food, &world_from_food).0;
    let section = place(&food, &world_from_food, config.board_top_m, along_m, 0.0).map_err(StageError::Input)?.section;
    let edge = LevelEdge::of(knife);
    let tool_from_blade = knife_from_tool(knife).inverse() * edge.knife_from_blade;
    let knife = other_frame(poses, &tool_from_blade)?;
    Ok(CutDemonstration { knife, section, blade: edge.blade })
}

/// The same motion of another frame of the body: `from_other` is its pose in the frame of the poses.
fn other_frame(poses: &PoseTrajectory, from_other: &Isometry3<f64>) -> Result<PoseTrajectory, StageError> {
    let moved = poses.poses().iter().map(|pose| pose * from_other).collect();
    PoseTrajectory::new(poses.times_s().to_vec(), moved).map_err(|error| StageError::Broken(error.to_string()))
}

/// A trial with the text of its file: poses of the middle of the edge.
fn written(task: &CutTask<'_>, number: usize, trial: &Trial) -> ShownTrial {
    let (scenario, cut) = (task.scenario, &task.cut.scenario);
    let shown = &trial.demonstration;
    let edge = LevelEdge::of(&task.cut.shown_knife);
    let blade_from_tool = edge.knife_from_blade.inverse() * knife_from_tool(&task.cut.shown_knife);
    // a frame that is fixed to the knife moves as smoothly as the knife
    let poses = other_frame(&shown.knife, &blade_from_tool).unwrap_or_else(|_| shown.knife.clone());
    let at = cut.cut();
    let DemonstrationsConfig::Synthetic(SyntheticConfig { at_share, human, .. }) = &cut.demonstrations else {
        return ShownTrial { trial: about(scenario, number, trial), csv: String::new() };
    };
    let lines = [
        ("scenario", scenario.name.clone()),
        ("seed", task.seed.to_string()),
        ("trial", number.to_string()),
        ("food", format!("{}, at {:?} m, turned by {} rad", task.cut.shown_food.name, at.food_at_m, at.food_angle_rad)),
        ("cut at this share of its length", at_share.to_string()),
        ("upper side of the board, m", cut.board.top_m().to_string()),
        ("knife", task.cut.shown_knife.name.clone()),
        ("hand", if human.hand == HandConfig::steady() { "steady".into() } else { "human".into() }),
        ("result", trial.failure.as_ref().map_or_else(|| "success".into(), |reason| format!("failure: {reason}"))),
    ];
    ShownTrial { trial: about(scenario, number, trial), csv: recorded::write(&lines, &poses) }
}

/// What is known of a trial: how far the edge was from the board at its deepest, and when it was in the food.
fn about(scenario: &crate::scenario::ResolvedScenario, number: usize, trial: &Trial) -> DemonstrationTrial {
    let shown = &trial.demonstration;
    let from_world = shown.section.world_from_section.inverse();
    let depths: Vec<f64> = shown.knife.poses().iter().map(|pose| (from_world * pose).translation.y).collect();
    let deepest_m = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let inside = |row: &usize| depths.get(*row).is_some_and(|depth| *depth > 0.0);
    let time = |row: usize| shown.knife.times_s().get(row).copied().unwrap_or(0.0);
    let rows = 0..depths.len();
    let touch = rows.clone().find(inside).zip(rows.rev().find(inside)).map(|(from, to)| (time(from), time(to)));
    DemonstrationTrial {
        trial: number,
        file: format!("{}_{number}.csv", scenario.name),
        success: trial.failure.is_none(),
        failure: trial.failure.clone(),
        goal_error_mm: (deepest_m - shown.section.height_m).abs() * 1e3,
        duration_s: shown.knife.duration_s(),
        renewed_holds: 0,
        touches_s: touch.into_iter().collect(),
    }
}
