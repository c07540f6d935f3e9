//! Plans of pours: approach, tilt to the onset, pour, hold, return, all certified to keep clear of the rim.

use nalgebra::Isometry3;

use super::approach;
use super::learning::PourSkill;
use super::refusal::PourError;
use super::task::PourTask;
use super::tilting::{LipTask, TiltPath, throw_m, transfer};
use crate::spatial::{
    ActionPhase, SpatialAction, SpatialError, SpatialKnot, SpatialMotion, SpatialPlan, SpatialTrack,
    certified_clearance,
};
use crate::time_law::PathState;

/// What is known of a planned pour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PourReport {
    /// Tilt at which the fill begins to flow, rad.
    pub onset_rad: f64,
    /// Tilt from which on the lip is over the mouth and the cup tilts slowly, rad.
    pub flows_from_rad: f64,
    /// Tilt at the end, rad.
    pub end_rad: f64,
    /// Greatest height of the lip above the rim while the flow may run, m.
    pub gap_m: f64,
    /// Greatest distance of the lip from the middle of the mouth while the flow may run, m.
    pub off_center_m: f64,
    /// Certified: cup and rim are never nearer than this, m. NaN for the plain primitive, of which nothing is known.
    pub clearance_m: f64,
    /// Time of the plan at which the flow may begin, s.
    pub flows_from_s: f64,
    /// Direction of pouring about z of the world, rad.
    pub direction_rad: f64,
    /// Expected speed of the stream at the lip, m/s.
    pub exit_speed_m_per_s: f64,
    /// Expected level distance from the lip to where the middle of the stream meets the plane of the mouth, m.
    pub throw_m: f64,
    /// Expected place there, m from the middle of the mouth along the direction of pouring: 0 unless the mouth is too narrow for
    /// the lip to be held back that far, or the aim is another.
    pub landing_m: f64,
}

/// Plan of a cup for one pour.
#[derive(Debug, Clone, PartialEq)]
pub struct PourPlan {
    /// Poses of the cup, `world_from_cup`: see [`super::Container`] for its frame.
    pub plan: SpatialPlan,
    /// What is known of it.
    pub report: PourReport,
    pub(super) tilting: Option<Tilting>,
}

/// The way of the tilt and its schedule.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tilting {
    pub(super) path: TiltPath,
    pub(super) world_from_pour: Isometry3<f64>,
    /// Largest rate at which the cup tilts back, rad/s.
    pub(super) rate_rad_per_s: f64,
}

/// Distance within which a certificate meets what is sampled, m.
const RESOLUTION_M: f64 = 4e-4;
/// Parts of the flow at which height and place of the lip are looked at.
const LOOKS: usize = 200;

impl PourSkill {
    /// Plans a pour: every motion certified between samples to keep `least_clearance_m` from the rim.
    ///
    /// # Errors
    /// A [`PourError`] naming what is invalid, why the mouth cannot be reached, or what is not certified.
    pub fn plan(&self, task: &PourTask) -> Result<PourPlan, PourError> {
        task.validate()?;
        let options = &task.options;
        let lip = LipTask::new(task, self.over)?;
        let path = lip.way(task, &self.tilt)?;
        let (gap_m, off_center_m) = flow_place(&path);
        let onset_rad = task.source.onset_rad(task.fill.height_m, task.fill.stability_rad);
        let first_gap_m = path.lip(path.flows_from)[1].position;
        if first_gap_m > options.largest_gap_m {
            return Err(PourError::TooHigh { onset_rad, gap_m: first_gap_m, largest_m: options.largest_gap_m });
        }
        let world_from_pour = task.mouth.world_from_pour(task.direction());
        let ready = path.motion(PathState::default()).seen_from(&world_from_pour).pose;
        let coming = approach::plan(&self.approach, &task.start, &ready, options)?;
        let from = path.flows_from;
        let tilt_s = path.duration_s(0.0, from, options.tilt_rate_rad_per_s);
        let pour_s = path.duration_s(from, 1.0, options.pour_rate_rad_per_s);
        let back_s = path.duration_s(0.0, 1.0, options.tilt_rate_rad_per_s);
        let along = |from: f64, to: f64, duration_s: f64| {
            path.track(&world_from_pour, duration_s, transfer(from, to, duration_s))
        };
        let emptied = path.motion(PathState { position: 1.0, ..PathState::default() }).seen_from(&world_from_pour);
        let action = SpatialAction::new;
        let actions = vec![
            action("approach", ActionPhase::Approach, coming.clone()),
            action("tilt", ActionPhase::Tilt, along(0.0, from, tilt_s)?),
            action("pour", ActionPhase::Pour, along(from, 1.0, pour_s)?),
            action("hold", ActionPhase::Hold, resting_at(emptied.pose, options.hold_s)?),
            action("tilt back", ActionPhase::Return, along(1.0, 0.0, back_s)?),
            action("return", ActionPhase::Return, coming.reversed()?),
        ];
        let clearance_m = certified(task, &actions)?;
        let begin_s = coming.duration_s();
        let (throw_m, exit_speed_m_per_s) = throw_m(task);
        let report = PourReport {
            onset_rad,
            flows_from_rad: from * path.end_rad,
            end_rad: path.end_rad,
            gap_m,
            off_center_m,
            clearance_m,
            flows_from_s: begin_s + tilt_s,
            direction_rad: task.direction(),
            exit_speed_m_per_s,
            throw_m,
            landing_m: lip.over_m + throw_m,
        };
        let tilting = Tilting { path, world_from_pour, rate_rad_per_s: options.tilt_rate_rad_per_s };
        Ok(PourPlan { plan: SpatialPlan::new(actions)?, report, tilting: Some(tilting) })
    }
}

impl PourPlan {
    pub(super) fn plain(plan: SpatialPlan, report: PourReport) -> Self {
        Self { plan, report, tilting: None }
    }
}

/// Greatest height of the lip and greatest distance from the middle while the flow may run, m.
fn flow_place(path: &TiltPath) -> (f64, f64) {
    let places =
        (0..=LOOKS).map(|look| path.lip(path.flows_from + (1.0 - path.flows_from) * look as f64 / LOOKS as f64));
    places.fold((0.0, 0.0), |(gap, off): (f64, f64), [x, z]| (gap.max(z.position), off.max(x.position.abs())))
}

/// Certifies that cup and rim keep clear in every action, m; the last one is the first one backward.
fn certified(task: &PourTask, actions: &[SpatialAction]) -> Result<f64, PourError> {
    let least_m = task.options.least_clearance_m;
    let mut smallest = f64::INFINITY;
    for action in actions.iter().take(actions.len().saturating_sub(1)) {
        let found = certified_clearance(&action.track, task.source.reach_m(), RESOLUTION_M, least_m, |pose| {
            task.mouth.clearance_m(&task.source, pose)
        });
        if found.bound_m < least_m {
            return Err(PourError::NotClear {
                action: action.name.clone(),
                clearance_m: found.bound_m,
                sampled_m: found.sampled_m,
                time_s: found.at_s,
                least_m,
            });
        }
        smallest = smallest.min(found.bound_m);
    }
    Ok(smallest)
}

/// Rests at a pose.
pub(super) fn resting_at(pose: Isometry3<f64>, duration_s: f64) -> Result<SpatialTrack, SpatialError> {
    let knot = |time_s| SpatialKnot { time_s, motion: SpatialMotion::at_rest(pose) };
    SpatialTrack::new(vec![knot(0.0), knot(duration_s)])
}
