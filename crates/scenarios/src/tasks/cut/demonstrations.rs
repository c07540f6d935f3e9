//! The demonstration of one cut: shown by a synthetic human, or recorded.

use nalgebra::{Isometry3, Point3};
use sim::cutting::knife::Knife;
use sim::cutting::scene::knife_from_tool;
use sim::random::{Purpose, stream};
use skills::cutting::{CutDemonstration, CutSkill};
use skills::primitive::pose::{PoseError, PoseTrajectory};

use super::CutTask;
use super::holding::LevelEdge;
use super::places::{extent_m, lying, place};
use super::showing::{DemonstrationsConfig, RecordedConfig, SyntheticConfig};
use crate::pipeline::Progress;
use crate::scenario::ResolvedScenario;
use crate::tasks::spatial::{Trial, check_near, run_trials, write_poses};
use crate::tasks::{DemonstrationTrial, ShownTrial, StageError};

/// Distance of the middle of an edge from what it cuts, m, from which on something else was recorded.
const FARTHEST_M: f64 = 0.25;

/// A demonstration of a cut.
pub(crate) struct Shown {
    /// The one to learn from; none if the skill was learned before.
    pub demonstration: Option<CutDemonstration>,
    /// Its name.
    pub name: String,
    /// Trials that failed before it, with the reason.
    pub failed: Vec<String>,
}

/// Takes the recorded demonstration, or lets the synthetic human show one.
pub(super) fn obtain(task: &CutTask<'_>, progress: Progress<'_>) -> Result<Shown, StageError> {
    let mut shown = Shown { demonstration: None, name: String::new(), failed: Vec::new() };
    match &task.cut.scenario.demonstrations {
        DemonstrationsConfig::Learned { .. } => {}
        DemonstrationsConfig::Recorded(config) => {
            shown.demonstration = Some(recorded_cut(task, config)?);
            shown.name.clone_from(&config.asset);
        }
        DemonstrationsConfig::Synthetic(config) => try_to_show(task, config, 1, progress, &mut |trial| {
            let name = format!("trial {}", trial.number);
            match trial.failure {
                Some(reason) => shown.failed.push(format!("{name}: {reason}")),
                None => (shown.demonstration, shown.name) = (Some(trial.demonstration), name),
            }
            Ok(())
        })?,
    }
    Ok(shown)
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
            "the scenario has a demonstration or a skill already; expected [demonstrations.synthetic], a human who can \
             show the cut"
                .into(),
        ));
    };
    try_to_show(task, config, count.unwrap_or(1), progress, &mut |trial| each(written(task, config, &trial)?))
}

/// Lets the human show the cut until `count` trials can be learned from.
fn try_to_show(
    task: &CutTask<'_>,
    config: &SyntheticConfig,
    count: usize,
    progress: Progress<'_>,
    each: &mut dyn FnMut(Trial<CutDemonstration>) -> Result<(), StageError>,
) -> Result<(), StageError> {
    let scenario = &task.cut.scenario;
    let (food, knife) = (&task.cut.shown_food, &task.cut.shown_knife);
    let top_m = scenario.board.top_m();
    let food = food.food().map_err(|error| StageError::Input(format!("food of the demonstration: {error}")))?;
    let world_from_food = lying(&food, scenario.cut().food_at_m, scenario.cut().food_angle_rad, top_m);
    let along_m = config.at_share * extent_m(&food, &world_from_food).0;
    let section = place(&food, &world_from_food, top_m, along_m, 0.0).map_err(StageError::Input)?.section;
    let blade = LevelEdge::of(knife).blade;
    let mut attempt = |index| {
        let random = stream(task.seed, Purpose::Hand, index);
        let shown = config.human.demonstrate(&section, &blade, random);
        let demonstration = shown.map_err(|error| StageError::Input(format!("demonstrate: {error}")))?;
        let failure = CutSkill::learn(&scenario.learning, &demonstration).err().map(|error| error.to_string());
        Ok((demonstration, failure))
    };
    run_trials(count, progress, &mut attempt, each)
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
    let top = Point3::from(section.world_from_section.translation.vector);
    check_near(poses, &Point3::origin(), &top, "the food", FARTHEST_M)?;
    let knife_motion = other_frame(poses, &tool_from_blade(knife))
        .map_err(|error| StageError::Broken(format!("demonstrate: {error}")))?;
    Ok(CutDemonstration { knife: knife_motion, section, blade: LevelEdge::of(knife).blade })
}

/// Where skills see a knife: pose of the middle of the level part of its edge in the frame that recordings tell of, the middle of
/// all of the edge.
fn tool_from_blade(knife: &Knife) -> Isometry3<f64> {
    knife_from_tool(knife).inverse() * LevelEdge::of(knife).knife_from_blade
}

/// The same motion of another frame of the body: `from_other` is its pose in the frame of the poses.
fn other_frame(poses: &PoseTrajectory, from_other: &Isometry3<f64>) -> Result<PoseTrajectory, PoseError> {
    let moved = poses.poses().iter().map(|pose| pose * from_other).collect();
    PoseTrajectory::new(poses.times_s().to_vec(), moved)
}

/// A trial with the text of its file: poses of the middle of the edge.
fn written(
    task: &CutTask<'_>,
    config: &SyntheticConfig,
    trial: &Trial<CutDemonstration>,
) -> Result<ShownTrial, StageError> {
    let poses = other_frame(&trial.demonstration.knife, &tool_from_blade(&task.cut.shown_knife).inverse())
        .map_err(|error| StageError::Broken(format!("demonstrate: {error}")))?;
    let cut = &task.cut.scenario;
    let [x, y] = cut.cut().food_at_m;
    let lines = [
        ("scenario", task.scenario.name.clone()),
        ("seed", task.seed.to_string()),
        ("trial", trial.number.to_string()),
        ("knife", task.cut.shown_knife_name().to_owned()),
        ("food", task.cut.shown_food_name().to_owned()),
        ("food_at_m", format!("[{x:?}, {y:?}]")),
        ("food_angle_rad", format!("{:?}", cut.cut().food_angle_rad)),
        ("board_top_m", format!("{:?}", cut.board.top_m())),
        ("at_share", format!("{:?}", config.at_share)),
        ("result", trial.failure.as_ref().map_or_else(|| "success".into(), |reason| format!("failure: {reason}"))),
    ];
    Ok(ShownTrial { trial: about(task.scenario, trial), csv: write_poses(&lines, &poses) })
}

/// What is known of a trial: how far the edge was from the board at its deepest, and when it was in the food.
fn about(scenario: &ResolvedScenario, trial: &Trial<CutDemonstration>) -> DemonstrationTrial {
    let shown = &trial.demonstration;
    let from_world = shown.section.world_from_section.inverse();
    let depths: Vec<f64> = shown.knife.poses().iter().map(|pose| (from_world * pose).translation.y).collect();
    let deepest_m = depths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let inside = |row: &usize| depths.get(*row).is_some_and(|depth| *depth > 0.0);
    let time = |row: usize| shown.knife.times_s().get(row).copied().unwrap_or(0.0);
    let rows = 0..depths.len();
    let touch = rows.clone().find(inside).zip(rows.rev().find(inside)).map(|(from, to)| (time(from), time(to)));
    DemonstrationTrial {
        trial: trial.number,
        file: format!("{}_{}.csv", scenario.name, trial.number),
        success: trial.failure.is_none(),
        failure: trial.failure.clone(),
        goal_error_mm: (deepest_m - shown.section.height_m).abs() * 1e3,
        duration_s: shown.knife.duration_s(),
        renewed_holds: 0,
        touches_s: touch.into_iter().collect(),
    }
}
