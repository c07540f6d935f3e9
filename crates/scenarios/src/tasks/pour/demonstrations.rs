//! The demonstration of one pour: shown by a synthetic human, or recorded.

use nalgebra::Vector3;
use sim::random::{Purpose, stream};
use skills::pouring::{PourDemonstration, PourSkill};

use super::config::{PourDemonstrations, SyntheticPour};
use super::vessel::{standing, upright};
use super::{PourTask, ShownVessels, refused};
use crate::pipeline::Progress;
use crate::tasks::spatial::{Trial, check_near, run_trials, write_poses};
use crate::tasks::{DemonstrationTrial, ShownTrial, StageError};

/// Distance of a lip from the rim that it pours over, m, from which on something else was recorded.
const FARTHEST_M: f64 = 0.15;

/// A demonstration of a pour.
pub(crate) struct Shown {
    /// The one to learn from; none if the skill was learned before.
    pub demonstration: Option<PourDemonstration>,
    /// Its name.
    pub name: String,
    /// Trials that failed before it, with the reason.
    pub failed: Vec<String>,
}

/// Takes the recorded demonstration, or lets the synthetic human show one.
pub(super) fn obtain(task: &PourTask<'_>, progress: Progress<'_>) -> Result<Shown, StageError> {
    let mut shown = Shown { demonstration: None, name: String::new(), failed: Vec::new() };
    match &task.file().demonstrations {
        PourDemonstrations::Learned { .. } => {}
        PourDemonstrations::Recorded(config) => {
            let (Some(cup), vessels) = (&task.pour.recorded, vessels(task)?) else {
                return Err(StageError::Broken("demonstrate: the recording was not read".into()));
            };
            let mouth = vessels.target.mouth(&standing(config.place_m));
            let most_m = mouth.radius_m + FARTHEST_M;
            check_near(cup, &vessels.source.cup().lip(), &mouth.center_world, "the mouth", most_m)?;
            shown.demonstration = Some(PourDemonstration { cup: cup.clone(), source: vessels.source.cup(), mouth });
            shown.name.clone_from(&config.asset);
        }
        PourDemonstrations::Synthetic(config) => try_to_show(task, config, 1, progress, &mut |trial| {
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

/// Lets the synthetic human show the pour, and hands on each trial with the text of its file.
pub(super) fn show(
    task: &PourTask<'_>,
    count: Option<usize>,
    progress: Progress<'_>,
    each: &mut dyn FnMut(ShownTrial) -> Result<(), StageError>,
) -> Result<(), StageError> {
    let PourDemonstrations::Synthetic(config) = &task.file().demonstrations else {
        return Err(StageError::Input(
            "the scenario has a demonstration or a skill already; expected [demonstrations.synthetic], a human who can \
             show the pour"
                .into(),
        ));
    };
    try_to_show(task, config, count.unwrap_or(1), progress, &mut |trial| each(written(task, config, &trial)))
}

/// Lets the human show the pour until `count` trials can be learned from.
fn try_to_show(
    task: &PourTask<'_>,
    config: &SyntheticPour,
    count: usize,
    progress: Progress<'_>,
    each: &mut dyn FnMut(Trial<PourDemonstration>) -> Result<(), StageError>,
) -> Result<(), StageError> {
    let vessels = vessels(task)?;
    let mouth = vessels.target.mouth(&standing(config.place_m));
    let start = upright(config.start_m, None, &mouth.center_world);
    let cup = vessels.source.cup();
    let mut attempt = |index| {
        let random = stream(task.seed, Purpose::Hand, index);
        let demonstration = config.human.demonstrate(&cup, &mouth, &start, random).map_err(refused)?;
        let failure = PourSkill::learn(&task.file().learning, &demonstration).err().map(|error| error.to_string());
        Ok((demonstration, failure))
    };
    run_trials(count, progress, &mut attempt, each)
}

fn vessels<'a>(task: &PourTask<'a>) -> Result<&'a ShownVessels, StageError> {
    let missing = || StageError::Broken("demonstrate: the containers of the demonstration were not read".into());
    task.pour.shown.as_ref().ok_or_else(missing)
}

/// A trial with the text of its file: poses of the cup.
fn written(task: &PourTask<'_>, config: &SyntheticPour, trial: &Trial<PourDemonstration>) -> ShownTrial {
    let [x, y] = config.place_m;
    let name = &task.scenario.name;
    let lines = [
        ("scenario", name.clone()),
        ("seed", task.seed.to_string()),
        ("trial", trial.number.to_string()),
        ("source", task.pour.shown_source_name().to_owned()),
        ("target", config.target.clone()),
        ("place_m", format!("[{x:?}, {y:?}]")),
        ("result", trial.failure.as_ref().map_or_else(|| "success".into(), |reason| format!("failure: {reason}"))),
    ];
    let shown = &trial.demonstration;
    let about = DemonstrationTrial {
        trial: trial.number,
        file: format!("{name}_{}.csv", trial.number),
        success: trial.failure.is_none(),
        failure: trial.failure.clone(),
        goal_error_mm: 1e3 * off_middle_m(shown),
        duration_s: shown.cup.duration_s(),
        renewed_holds: 0,
        touches_s: Vec::new(),
    };
    ShownTrial { trial: about, csv: write_poses(&lines, &shown.cup) }
}

/// Level distance of the lip from the middle of the mouth at the greatest tilt, m.
fn off_middle_m(shown: &PourDemonstration) -> f64 {
    let upright = |pose: &nalgebra::Isometry3<f64>| (pose.rotation * Vector3::z()).z;
    let steepest = shown.cup.poses().iter().min_by(|a, b| upright(a).total_cmp(&upright(b)));
    steepest.map_or(f64::NAN, |pose| (pose * shown.source.lip() - shown.mouth.center_world).xy().norm())
}
