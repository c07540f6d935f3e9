//! Demonstrations of a push: shown by a synthetic human, or recorded.

use sim::SimError;
use sim::human::{DemonstrationTask, Trial, demonstrate};
use sim::sensing::CameraConfig;
use skills::SkillError;
use skills::demonstration::Demonstration;
use skills::tool::Tool;

use super::{DemonstrationsConfig, PushTask, SyntheticConfig, broken, recorded};
use crate::pipeline::Progress;
use crate::report::number;
use crate::suggest::listed;
use crate::tasks::{DemonstrationTrial, ShownTrial, StageError};

/// Trials that a human may spend on each demonstration wanted.
const TRIALS_PER_DEMONSTRATION: usize = 4;

/// Demonstrations of a push.
#[derive(Default)]
pub struct Shown {
    /// Those that succeeded.
    pub demonstrations: Vec<Demonstration>,
    /// Trials that failed, with the reason.
    pub failed: Vec<String>,
}

/// Loads the recorded demonstrations, or lets the synthetic human show as many as the scenario wants.
pub fn obtain(task: &PushTask<'_>, progress: Progress<'_>) -> Result<Shown, StageError> {
    let mut shown = Shown::default();
    match &task.push.scenario.demonstrations {
        DemonstrationsConfig::Learned { .. } => {}
        DemonstrationsConfig::Recorded { .. } => shown.demonstrations.clone_from(&task.push.recorded),
        DemonstrationsConfig::Synthetic(config) => run_trials(task, config, config.count, progress, &mut |trial| {
            match trial.failure {
                Some(reason) => shown.failed.push(format!("{} {reason}", trial.demonstration.name)),
                None => shown.demonstrations.push(trial.demonstration),
            }
            Ok(())
        })?,
    }
    Ok(shown)
}

/// Lets the synthetic human show the task, and hands on each trial with the text of its file.
pub fn show(
    task: &PushTask<'_>,
    count: Option<usize>,
    progress: Progress<'_>,
    each: &mut dyn FnMut(ShownTrial) -> Result<(), StageError>,
) -> Result<(), StageError> {
    let DemonstrationsConfig::Synthetic(config) = &task.push.scenario.demonstrations else {
        return Err(StageError::Input(
            "the scenario has demonstrations or skills already; expected [demonstrations.synthetic], a human who can \
             show the task"
                .into(),
        ));
    };
    let mut number = 0;
    run_trials(task, config, count.unwrap_or(config.count), progress, &mut |trial| {
        number += 1;
        each(written(task, config, number, &trial))
    })
}

/// Lets the synthetic human try until `count` trials succeeded; too few successes are an error once patience ends.
fn run_trials(
    task: &PushTask<'_>,
    config: &SyntheticConfig,
    count: usize,
    progress: Progress<'_>,
    each: &mut dyn FnMut(Trial) -> Result<(), StageError>,
) -> Result<(), StageError> {
    let scenario = &task.push.scenario;
    let tool = &task.push.demonstration_tool;
    let surfaces = surface_indices(tool, &config.surfaces)?;
    let asked = DemonstrationTask {
        world: &scenario.world,
        object: &scenario.object,
        tool,
        surfaces: &surfaces,
        start_world: config.start_m.into(),
        goal_world: config.goal_m.into(),
        home_world: task.config.home_m.into(),
        park_world: task.config.park_m().into(),
        human: &config.human,
        camera: &scenario.camera,
        engine: &scenario.engine,
    };
    let (most, mut successes, mut reasons) = (count * TRIALS_PER_DEMONSTRATION, 0, Vec::new());
    for index in 0..most {
        if successes == count {
            break;
        }
        let shown = demonstrate(&asked, task.seed, index as u64);
        let trial = shown.map_err(|error| unseen(error, &scenario.camera))?;
        match &trial.failure {
            Some(reason) => reasons.push(format!("{} {reason}", trial.demonstration.name)),
            None => successes += 1,
        }
        each(trial)?;
        progress("demonstrate", Some(successes as f64 / count as f64));
    }
    if successes == count {
        return Ok(());
    }
    Err(StageError::Infeasible(format!(
        "demonstrate: {successes} of {count} demonstrations succeeded in {most} trials ({}); expected all; make the task \
         of the demonstrations easier or the human more able",
        reasons.join("; "),
    )))
}

/// A trial of which the camera saw too little cannot be read, whatever the human did.
fn unseen(error: SimError, camera: &CameraConfig) -> StageError {
    match error {
        SimError::Skill(error @ (SkillError::RecordingGap { .. } | SkillError::RowCount { .. })) => {
            // what was attempted is said before
            let (text, attempt) = (error.to_string(), "read demonstration: ");
            StageError::Infeasible(format!(
                "demonstrate: {}; the camera takes {} frames a second and misses {} % of them: raise camera.rate_hz or \
                 lower camera.drop_out",
                text.strip_prefix(attempt).unwrap_or(&text),
                number(camera.rate_hz),
                number(1e2 * camera.drop_out),
            ))
        }
        other => broken(other),
    }
}

/// A trial with the text of its file, which holds only what the recorders saw.
fn written(task: &PushTask<'_>, config: &SyntheticConfig, number: usize, trial: &Trial) -> ShownTrial {
    let scenario = task.scenario;
    let tool = &task.push.demonstration_tool;
    let surfaces: Vec<&str> = match config.surfaces.as_slice() {
        [] => tool.surfaces.iter().map(|surface| surface.name.as_str()).collect(),
        named => named.iter().map(String::as_str).collect(),
    };
    let about = [
        ("scenario", scenario.name.clone()),
        ("seed", task.seed.to_string()),
        ("trial", number.to_string()),
        ("tool", tool.name.clone()),
        ("surfaces", surfaces.join(", ")),
        ("result", trial.failure.as_ref().map_or_else(|| "success".into(), |reason| format!("failure: {reason}"))),
    ];
    let demonstration = &trial.demonstration;
    let about_trial = DemonstrationTrial {
        trial: number,
        file: format!("{}_{number}.csv", scenario.name),
        success: trial.failure.is_none(),
        failure: trial.failure.clone(),
        goal_error_mm: trial.goal_error_m * 1e3,
        duration_s: demonstration.tool.end_time_s().max(demonstration.object.end_time_s()),
        renewed_holds: trial.renewed_holds,
        touches_s: trial.touches_s.clone(),
    };
    ShownTrial { trial: about_trial, csv: recorded::write(&about, demonstration) }
}

/// Indices of the named surfaces; all of them if none is named.
fn surface_indices(tool: &Tool, names: &[String]) -> Result<Vec<usize>, StageError> {
    let known: Vec<&str> = tool.surfaces.iter().map(|surface| surface.name.as_str()).collect();
    if names.is_empty() {
        return Ok((0..known.len()).collect());
    }
    let find = |name: &String| {
        known.iter().position(|surface| surface == name).ok_or_else(|| {
            let expected = format!("one of {}, the surfaces of the tool `{}`", listed(&known), tool.name);
            StageError::Input(format!("demonstrations.synthetic.surfaces: found `{name}`; expected {expected}"))
        })
    };
    names.iter().map(find).collect()
}
