//! The way of the lip about the mouth over the angle of tilt, Eq. (28): x^Tf = x^t + k2·x^o.

use nalgebra::{DMatrix, Isometry3, Point3, UnitQuaternion, Vector3, dvector};

use super::container::{Container, Mouth};
use super::refusal::PourError;
use super::stream::Stream;
use super::task::{PourAim, PourTask};
use crate::corridor::smoothing::{SmoothingConfig, smooth};
use crate::corridor::{Bounds, Corridor, quintic};
use crate::corridor_filter::{CorridorFilterConfig, FilterRequest, constrain};
use crate::primitive::{Dmp, MovementPrimitive, Rollout, RolloutRequest};
use crate::spatial::{SpatialError, SpatialKnot, SpatialMotion, SpatialTrack};
use crate::time_law::{PathState, minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};
use crate::trajectory::Trajectory;

/// Pieces of the way over the angle.
const PIECES: usize = 120;
/// Time between knots of a track along the way, s.
const STEP_S: f64 = 0.01;
/// Half the window over which the virtual movement is smoothed, as a part of the tilt.
const WINDOW: f64 = 0.04;
/// Steps of the descent to the least height, and what it may leave, m.
const MOST_STEPS: usize = 200;
const LEFT_M: f64 = 1e-4;
/// Bounds of the lip's height above the virtual movement, in gaps.
const GAPS: (f64, f64) = (0.5, 2.0);
/// Turns in which place and height of the lip are made to agree: the height changes by less than the place.
const THROWS: usize = 6;
/// Part of the room over the mouth that the aim may use: the rest is the corridor filter's.
const NEAREST: f64 = 0.95;
/// Turns in which the goal of the lip's way is moved such that it passes the aim: the way is all but linear in its goal.
const AIMINGS: usize = 3;

/// Way of the lip in the plane of pouring over the part of the tilt, 0 to 1, that is done.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TiltPath {
    pub(super) end_rad: f64,
    /// Part of the tilt from which on the flow may run.
    pub(super) flows_from: f64,
    x: Rollout,
    z: Rollout,
    lip: Point3<f64>,
}

impl TiltPath {
    /// State of the lip's place along x and z at a part of the tilt, m.
    pub(super) fn lip(&self, part: f64) -> [PathState; 2] {
        [&self.x, &self.z].map(|rollout| state_at(rollout, part))
    }

    /// The cup in the frame of pouring while the part of the tilt moves.
    pub(super) fn motion(&self, part: PathState) -> SpatialMotion {
        let chained = |path: PathState| PathState {
            position: path.position,
            first: path.first * part.first,
            second: path.second * part.first * part.first + path.first * part.second,
        };
        let [x, z] = self.lip(part.position.clamp(0.0, 1.0)).map(chained);
        let turn = |value: f64| Vector3::y() * (self.end_rad * value);
        let pose = Isometry3::from_parts(
            nalgebra::Translation3::new(x.position, 0.0, z.position),
            UnitQuaternion::from_scaled_axis(turn(part.position.clamp(0.0, 1.0))),
        );
        let lip = SpatialMotion::new(
            pose,
            [Vector3::new(x.first, 0.0, z.first), turn(part.first)],
            [Vector3::new(x.second, 0.0, z.second), turn(part.second)],
        );
        lip.carrying(&Isometry3::from_parts((-self.lip.coords).into(), UnitQuaternion::identity()))
    }

    /// Track of the cup, `world_from_cup`, along the way as `part` goes, for `duration_s`.
    pub(super) fn track(
        &self,
        world_from_pour: &Isometry3<f64>,
        duration_s: f64,
        part: impl Fn(f64) -> PathState,
    ) -> Result<SpatialTrack, SpatialError> {
        let steps = (duration_s / STEP_S).ceil().max(1.0) as usize;
        let knot = |step: usize| {
            let time_s = duration_s * step as f64 / steps as f64;
            SpatialKnot { time_s, motion: self.motion(part(time_s)).seen_from(world_from_pour) }
        };
        SpatialTrack::new((0..=steps).map(knot).collect())
    }

    /// Time for a tilt from one part to another at a peak rate, rad/s, by minimum jerk, s.
    pub(super) fn duration_s(&self, from: f64, to: f64, rate_rad_per_s: f64) -> f64 {
        (1.875 * self.end_rad * (to - from).abs() / rate_rad_per_s).max(0.2)
    }
}

/// Minimum jerk of the part of the tilt.
pub(super) fn transfer(from: f64, to: f64, duration_s: f64) -> impl Fn(f64) -> PathState {
    move |time_s| {
        let ratio = time_s / duration_s;
        PathState {
            position: from + (to - from) * minimum_jerk(ratio),
            first: (to - from) * minimum_jerk_first_derivative(ratio) / duration_s,
            second: (to - from) * minimum_jerk_second_derivative(ratio) / (duration_s * duration_s),
        }
    }
}

/// Where the lip is to begin and end, and when it has to be over the mouth.
#[derive(Debug, Clone, Copy)]
pub(super) struct LipTask {
    pub(super) end_rad: f64,
    pub(super) flows_from: f64,
    pub(super) beside_m: f64,
    pub(super) over_m: f64,
    /// Part of the tilt at which it is to be there.
    pub(super) over_at: f64,
    pub(super) gap_m: f64,
    pub(super) margin_m: f64,
    pub(super) floor_m: f64,
    pub(super) k2: f64,
}

impl LipTask {
    /// Derives the task of the lip: beside the mouth at first, over it when the flow may begin, `shown_over` of its radius or
    /// as the throw of the stream demands.
    pub(super) fn new(task: &PourTask, shown_over: f64) -> Result<Self, PourError> {
        let (options, mouth) = (&task.options, &task.mouth);
        let room_m = mouth.radius_m - options.lip_margin_m;
        if room_m < 0.25 * options.lip_margin_m {
            let least_m = 1.25 * options.lip_margin_m;
            return Err(PourError::MouthTooNarrow { radius_m: mouth.radius_m, least_m });
        }
        let end_rad = std::f64::consts::FRAC_PI_2 + options.beyond_level_rad;
        let onset = task.source.onset_rad(task.fill.height_m, task.fill.stability_rad);
        let flows_from = ((onset - options.before_onset_rad) / end_rad).clamp(0.05, 0.95);
        let (over_m, over_at) = match options.aim {
            PourAim::Shown => (shown_over * mouth.radius_m, 1.0),
            PourAim::Stream => {
                let middle_rad = Stream::new(&task.source, &task.fill, options.pour_rate_rad_per_s).middle_rad;
                (-throw_m(task).0, (middle_rad / end_rad).clamp(flows_from, 1.0))
            }
        };
        Ok(Self {
            end_rad,
            flows_from,
            beside_m: -(mouth.outer_m(task.source.height_m) + options.beside_m),
            over_m: over_m.clamp(-NEAREST * room_m, NEAREST * room_m),
            over_at,
            gap_m: options.gap_m,
            margin_m: options.margin_m,
            floor_m: task.floor_above_rim_m(),
            k2: options.k2,
        })
    }

    /// Generates the way: x^t in the corridor of the mouth, then k2·x^o on top of it.
    pub(super) fn way(&self, task: &PourTask, own: &Dmp) -> Result<TiltPath, PourError> {
        let (x, own_height) = self.aimed(task, own)?;
        let rise = virtual_rise(&task.source, &task.mouth, self.end_rad, [self.margin_m, self.floor_m], &|row| {
            x.positions().samples()[(row.min(PIECES), 0)]
        })?;
        let z = self.lifted(&task.options.corridor_filter, &own_height, &rise)?;
        Ok(TiltPath { end_rad: self.end_rad, flows_from: self.flows_from, x, z, lip: task.source.lip() })
    }

    /// The lip's place, kept over the mouth, and the skill's own height. What was shown drifts on while it pours: the goal
    /// gives way such that the lip is where it should be at `over_at`.
    fn aimed(&self, task: &PourTask, own: &Dmp) -> Result<(Rollout, Rollout), PourError> {
        let farthest_m = NEAREST * (task.mouth.radius_m - task.options.lip_margin_m);
        let mut goal_m = self.over_m;
        let mut found = self.toward(goal_m, task, own)?;
        if self.over_at >= 1.0 {
            return Ok(found);
        }
        for _ in 0..AIMINGS {
            goal_m += self.over_m - state_at(&found.0, self.over_at).position;
            goal_m = goal_m.clamp(-farthest_m, farthest_m);
            found = self.toward(goal_m, task, own)?;
        }
        Ok(found)
    }

    /// The skill's own way to a place of the lip, m, its place kept over the mouth.
    fn toward(&self, goal_m: f64, task: &PourTask, own: &Dmp) -> Result<(Rollout, Rollout), PourError> {
        let radius = task.mouth.radius_m;
        let request = RolloutRequest::new(
            dvector![self.beside_m / radius, self.gap_m],
            dvector![goal_m / radius, self.gap_m],
            1.0,
            1.0 / PIECES as f64,
        );
        let wanted = crate::spatial::resting(&own.rollout(&request)?.into_positions(), &request)?;
        let x = self.over_the_mouth(task, &column(&wanted, 0, radius)?, goal_m)?;
        Ok((x, column(&wanted, 1, 1.0)?))
    }

    /// The way of one who moves the lip in by minimum jerk until the flow may begin.
    pub(super) fn plain_way(&self, source: &Container, mouth: &Mouth) -> Result<TiltPath, PourError> {
        let x = |part: f64| {
            let at = transfer(self.beside_m, self.over_m, self.flows_from)(part);
            if part > self.flows_from { PathState { position: self.over_m, ..PathState::default() } } else { at }
        };
        let rise = virtual_rise(source, mouth, self.end_rad, [self.margin_m, self.floor_m], &|row| {
            x(row as f64 / PIECES as f64).position
        })?;
        let z = |part: f64| {
            let low = rise.at(part, 0).lower;
            PathState { position: low.position + self.gap_m, ..low }
        };
        Ok(TiltPath {
            end_rad: self.end_rad,
            flows_from: self.flows_from,
            x: sampled(x)?,
            z: sampled(z)?,
            lip: source.lip(),
        })
    }

    /// Keeps the lip over the mouth from where the flow may begin.
    fn over_the_mouth(&self, task: &PourTask, wanted: &Rollout, goal_m: f64) -> Result<Rollout, PourError> {
        let room_m = task.mouth.radius_m - task.options.lip_margin_m;
        let low = transfer(self.beside_m - 0.01, -room_m, self.flows_from);
        let corridor = Corridor::sampled(grid(), 1, |part, _| Bounds {
            lower: low(part.min(self.flows_from)),
            upper: PathState { position: room_m, ..PathState::default() },
        })?;
        let asked = FilterRequest { start: None, goal: dvector![goal_m], duration_s: 1.0 };
        let kept = constrain(&task.options.corridor_filter, wanted, &corridor, &asked)?;
        if !kept.certificate.holds() {
            return Err(PourError::NotInside { motion: "lip", margin: kept.certificate.smallest_margin() });
        }
        Ok(kept.rollout)
    }

    /// Adds the virtual movement to the skill's own height.
    fn lifted(&self, filter: &CorridorFilterConfig, own: &Rollout, rise: &Corridor) -> Result<Rollout, PourError> {
        let raised = |part: f64, gaps: f64| {
            let low = rise.at(part, 0).lower;
            PathState {
                position: self.k2 * low.position + gaps * self.gap_m,
                first: self.k2 * low.first,
                second: self.k2 * low.second,
            }
        };
        let mut tables = [own.positions().samples().clone(), own.velocities().clone(), own.accelerations().clone()];
        for (row, part) in own.positions().times_s().iter().enumerate() {
            let lift = raised(*part, 0.0);
            for (table, value) in tables.iter_mut().zip([lift.position, lift.first, lift.second]) {
                table[(row, 0)] += value;
            }
        }
        let [positions, velocities, accelerations] = tables;
        let goal = dvector![positions[(positions.nrows() - 1, 0)]];
        let positions = Trajectory::new(own.positions().times_s().to_vec(), positions)?;
        let wanted = Rollout::new(positions, velocities, accelerations)?;
        let corridor = Corridor::sampled(grid(), 1, |part, _| Bounds {
            lower: raised(part, GAPS.0),
            upper: raised(part, GAPS.1),
        })?;
        let kept = constrain(filter, &wanted, &corridor, &FilterRequest { start: None, goal, duration_s: 1.0 })?;
        if !kept.certificate.holds() {
            return Err(PourError::NotInside { motion: "lip's height", margin: kept.certificate.smallest_margin() });
        }
        Ok(kept.rollout)
    }
}

/// Level distance from the lip to where the middle of the stream meets the plane of the mouth, m, and its speed at the lip,
/// m/s, once half of the fill has left. The lip is as high as it must be to clear the rim where that distance puts it.
pub(super) fn throw_m(task: &PourTask) -> (f64, f64) {
    let options = &task.options;
    let stream = Stream::new(&task.source, &task.fill, options.pour_rate_rad_per_s);
    let here = Mouth { center_world: Point3::origin(), ..task.mouth };
    let tilt_rad = stream.middle_rad;
    let standing_m = task.floor_above_rim_m() + task.source.height_m * tilt_rad.cos().max(0.0);
    let mut thrown_m = 0.0;
    for _ in 0..THROWS {
        let rise_m = least_height(&task.source, &here, tilt_rad, -thrown_m, options.margin_m).max(standing_m);
        thrown_m = stream.throw_m(tilt_rad, rise_m + options.gap_m);
    }
    (thrown_m, stream.speed_m_per_s)
}

/// Virtual movement x^o: the least height of the lip above the rim at which the cup clears the mouth by the margin, and the
/// table at `floor_m` above the rim, over the part of the tilt, smoothed from above to a C² lower bound; `x` gives the place of the lip at a row of the grid, m.
pub(super) fn virtual_rise(
    cup: &Container,
    mouth: &Mouth,
    end_rad: f64,
    [margin_m, floor_m]: [f64; 2],
    x: &dyn Fn(usize) -> f64,
) -> Result<Corridor, PourError> {
    let here = Mouth { center_world: Point3::origin(), ..*mouth };
    let parts = grid();
    let heights = parts.iter().enumerate().map(|(row, part)| {
        let tilt_rad = end_rad * part;
        // the lowest point of a cup up to level is the corner of its bottom below the lip
        let standing = floor_m + cup.height_m * tilt_rad.cos().max(0.0);
        least_height(cup, &here, tilt_rad, x(row), margin_m).max(standing)
    });
    let lower = DMatrix::from_iterator(parts.len(), 1, heights);
    let upper = lower.map(|height| height + 1.0);
    let config = SmoothingConfig { half_window_s: WINDOW, least_width: 0.0 };
    Ok(smooth(&config, &parts, &lower, &upper)?.corridor)
}

/// Lowers the cup from above until it is as near to the mouth as the margin, or its lip is level with the rim: the
/// clearance falls no faster than the cup, so that nothing is passed.
fn least_height(cup: &Container, mouth: &Mouth, tilt_rad: f64, lip_x_m: f64, margin_m: f64) -> f64 {
    let rotation = UnitQuaternion::from_scaled_axis(Vector3::y() * tilt_rad);
    let arm = rotation * cup.lip().coords;
    let mut z = 2.0 * cup.reach_m() + margin_m;
    for _ in 0..MOST_STEPS {
        let place = Vector3::new(lip_x_m, 0.0, z) - arm;
        let room = mouth.clearance_m(cup, &Isometry3::from_parts(place.into(), rotation)) - margin_m;
        if room < LEFT_M {
            return z;
        }
        z -= room;
        if z <= 0.0 {
            return 0.0;
        }
    }
    z
}

fn grid() -> Vec<f64> {
    (0..=PIECES).map(|piece| piece as f64 / PIECES as f64).collect()
}

fn sampled(at: impl Fn(f64) -> PathState) -> Result<Rollout, PourError> {
    let parts = grid();
    let states: Vec<PathState> = parts.iter().map(|part| at(*part)).collect();
    let table = |of: fn(&PathState) -> f64| DMatrix::from_iterator(states.len(), 1, states.iter().map(of));
    let positions = Trajectory::new(parts, table(|state| state.position))?;
    Ok(Rollout::new(positions, table(|state| state.first), table(|state| state.second))?)
}

fn column(rollout: &Rollout, k: usize, by: f64) -> Result<Rollout, PourError> {
    let part = |table: &DMatrix<f64>| table.columns(k, 1) * by;
    let positions = Trajectory::new(rollout.positions().times_s().to_vec(), part(rollout.positions().samples()))?;
    Ok(Rollout::new(positions, part(rollout.velocities()), part(rollout.accelerations()))?)
}

/// State between the rows of a way.
fn state_at(rollout: &Rollout, part: f64) -> PathState {
    let times = rollout.positions().times_s();
    let row = times.partition_point(|time| *time <= part).saturating_sub(1).min(times.len() - 2);
    let step = times[row + 1] - times[row];
    quintic(state(rollout, row), state(rollout, row + 1), step, (part - times[row]) / step)
}

fn state(rollout: &Rollout, row: usize) -> PathState {
    PathState {
        position: rollout.positions().samples()[(row, 0)],
        first: rollout.velocities()[(row, 0)],
        second: rollout.accelerations()[(row, 0)],
    }
}
