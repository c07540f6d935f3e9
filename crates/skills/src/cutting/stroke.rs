//! The stroke of one cut: the learned skill in the corridor of a new section, in as many passes as the edge has room for.

use nalgebra::{DMatrix, dvector};

use super::in_plane::{InPlane, transfer};
use super::learning::{CutSkill, stroke_corridor};
use super::refusal::CutError;
use super::section::{Blade, Section};
use super::task::{CutOptions, Stroke};
use crate::corridor::{Bounds, Corridor};
use crate::corridor_filter::{Certificate, Constrained, FilterRequest, constrain};
use crate::primitive::{Rollout, RolloutRequest};
use crate::spatial::resting;
use crate::time_law::PathState;
use crate::trajectory::Trajectory;

/// Time between the knots of a stroke, s.
const STEP_S: f64 = 0.01;
/// Most passes of a stroke.
const MOST_PASSES: f64 = 40.0;
/// Part of its room that the edge uses, so that the corridor has somewhere to be inside of.
const USED: f64 = 0.9;
/// Shortest pass, s.
const SHORTEST_S: f64 = 0.4;
/// Length by which a saw overlaps the end of the food, and by which the edge stays in it, as a part of the usable edge.
const SAW_OVERLAP: f64 = 0.1;
/// Shortest usable edge that saws, as a part of the food's width: where the overlaps above leave it no room.
const LEAST_SAW: f64 = 0.08;
/// Peak over mean speed of minimum jerk.
const PEAK: f64 = 1.875;

/// A stroke in the frame of its section.
#[derive(Debug, Clone)]
pub(super) struct PlannedStroke {
    /// Times from 0 s on, s, with the states there.
    pub(super) states: Vec<(f64, InPlane)>,
    /// Number of passes to and fro.
    pub(super) passes: usize,
    /// Draw over depth of the passes, unsigned.
    pub(super) slice_push_ratio: f64,
    /// Certified smallest distance of the food from the ends of the usable edge; of a saw, of the edge from leaving it, m.
    pub(super) edge_margin_m: f64,
    /// Certified greatest distance of the edge past the board, m.
    pub(super) past_board_m: f64,
}

/// How a stroke is divided.
#[derive(Debug, Clone, Copy)]
struct Passes {
    count: usize,
    /// Depth from begin to end of all passes, m.
    travel_m: f64,
    /// Half the draw of a pass, m, signed.
    half_draw_m: f64,
    /// Bound of the place along x, m.
    room_m: f64,
    saws: bool,
}

/// What a section asks of a skill.
pub(super) struct StrokeTask<'a> {
    pub(super) cut: usize,
    pub(super) section: &'a Section,
    pub(super) blade: &'a Blade,
    pub(super) options: &'a CutOptions,
}

impl StrokeTask<'_> {
    /// Plans the stroke from `lead_m` above the food to `past_board_m` below the board's surface.
    pub(super) fn plan(&self, skill: &CutSkill) -> Result<PlannedStroke, CutError> {
        let passes = self.passes(skill)?;
        let mut planned = PlannedStroke {
            states: Vec::new(),
            passes: passes.count,
            slice_push_ratio: 2.0 * passes.half_draw_m.abs() * passes.count as f64 / passes.travel_m,
            edge_margin_m: f64::INFINITY,
            past_board_m: f64::NEG_INFINITY,
        };
        for pass in 0..passes.count {
            self.add_pass(skill, &passes, pass, &mut planned)?;
        }
        self.add_finish(skill, &passes, &mut planned)?;
        Ok(planned)
    }

    /// The ratio of draw and depth that is asked for, signed.
    fn ratio(&self, skill: &CutSkill) -> f64 {
        match self.options.stroke {
            Stroke::AsShown => skill.shown.slice_push_ratio,
            Stroke::Slice { ratio } => ratio,
            Stroke::Press | Stroke::Rock { .. } => 0.0,
        }
    }

    fn passes(&self, skill: &CutSkill) -> Result<Passes, CutError> {
        let (cut, usable_m, width_m) = (self.cut, self.blade.usable_m(), self.section.width_m);
        let travel_m = self.options.lead_m + self.section.height_m + self.options.past_board_m;
        let draw_m = self.ratio(skill) * travel_m;
        let covers_m = self.blade.reach_m(self.options.largest_rock_rad) - 0.5 * width_m;
        let overlap_m = SAW_OVERLAP * usable_m;
        if covers_m >= overlap_m * 0.5 {
            let found = (draw_m.abs() / (2.0 * USED * covers_m)).ceil().max(1.0);
            let count = self.count(found)?;
            let half_draw_m = 0.5 * draw_m / count as f64;
            return Ok(Passes { count, travel_m, half_draw_m, room_m: covers_m, saws: false });
        }
        if self.ratio(skill).abs() < 0.05 {
            return Err(CutError::TooShortToPress { cut, usable_m, width_m });
        }
        // to and fro until the ends of the edge have passed the ends of the food
        let reach_m = self.blade.reach_m(self.options.largest_rock_rad);
        let half_draw_m = (0.5 * width_m - reach_m).max(self.rolled_width_m(0.0)) + overlap_m;
        let room_m = 0.5 * width_m + reach_m - overlap_m;
        if half_draw_m >= USED * room_m {
            return Err(CutError::TooShort { cut, usable_m, width_m, least_m: LEAST_SAW * width_m });
        }
        let count = self.count((draw_m.abs() / (2.0 * half_draw_m)).ceil().max(1.0))?;
        Ok(Passes { count, travel_m, half_draw_m: half_draw_m.copysign(draw_m), room_m, saws: true })
    }

    fn count(&self, found: f64) -> Result<usize, CutError> {
        if found > MOST_PASSES {
            return Err(CutError::TooManyStrokes { cut: self.cut, found, most: MOST_PASSES });
        }
        Ok(found as usize)
    }

    /// How far the lowest point of a belly has to go to either side of `draw_m` to pass the width, m: 0 for a straight edge.
    fn rolled_width_m(&self, draw_m: f64) -> f64 {
        self.blade.belly_radius_m.map_or(0.0, |radius_m| {
            let level_m = (2.0 * radius_m * self.options.past_board_m).sqrt();
            (0.5 * self.section.width_m + draw_m.abs() - level_m).max(0.0)
        })
    }

    fn speed(&self, skill: &CutSkill) -> f64 {
        self.options.speed_m_per_s.unwrap_or(skill.shown.speed_m_per_s())
    }

    /// Adds one pass: the skill generated in the corridor of the section, and constrained to it, lengths over the depth of
    /// the pass; every other pass is mirrored.
    fn add_pass(
        &self,
        skill: &CutSkill,
        passes: &Passes,
        pass: usize,
        planned: &mut PlannedStroke,
    ) -> Result<(), CutError> {
        let size_m = passes.travel_m / passes.count as f64;
        let begin_m = size_m * pass as f64 - self.options.lead_m;
        let half = passes.half_draw_m / size_m;
        let way_m = size_m * (2.0 * half).hypot(1.0);
        let duration_s = (way_m / self.speed(skill)).max(SHORTEST_S);
        let room = passes.room_m / size_m;
        let limit_m = self.section.height_m + self.options.largest_past_board_m;
        let limit = (limit_m - begin_m) / size_m;
        let rock = self.begin_rock(skill, pass);
        let still = stroke_corridor([-room, room], [-1.0, limit], self.options.largest_rock_rad)?;
        let request = RolloutRequest::new(
            dvector![-half, 0.0, rock],
            dvector![half, 1.0, 0.0],
            duration_s,
            STEP_S.min(duration_s),
        );
        let wanted = self.wanted(skill, &request, &still)?;
        let (place, rocking) = self.kept(&request, wanted, &still, limit, size_m)?;
        self.note(planned, passes, size_m, &place.certificate, &rocking.certificate)?;
        let mirror = if pass.is_multiple_of(2) { 1.0 } else { -1.0 };
        let begin_s = planned.states.last().map_or(0.0, |(time_s, _)| *time_s);
        for (row, time_s) in place.rollout.positions().times_s().iter().enumerate() {
            // the end of the pass before is the begin of this one
            if row == 0 && pass > 0 {
                continue;
            }
            let [draw, depth] = [0, 1].map(|k| scaled(state(&place.rollout, row, k), size_m));
            let depth = PathState { position: depth.position + begin_m, ..depth };
            let (draw, rock) = (scaled(draw, mirror), scaled(state(&rocking.rollout, row, 0), mirror));
            planned.states.push((begin_s + time_s, InPlane { draw, depth, rock }));
        }
        Ok(())
    }

    fn begin_rock(&self, skill: &CutSkill, pass: usize) -> f64 {
        let largest = USED * self.options.largest_rock_rad;
        match self.options.stroke {
            Stroke::Rock { angle_rad } if pass == 0 => angle_rad,
            Stroke::AsShown if pass == 0 => skill.shown.rock_rad.clamp(-largest, largest),
            _ => 0.0,
        }
    }

    /// The stroke that the skill wants: Eqs. (21) and (16), at rest at both ends.
    fn wanted(&self, skill: &CutSkill, request: &RolloutRequest, corridor: &Corridor) -> Result<Rollout, CutError> {
        let stretched = Corridor::sampled(vec![0.0, request.duration_s], 3, |_, k| corridor.at(0.0, k))?;
        let mut samples = skill.stroke.generate(request, &stretched)?.positions;
        if self.options.stroke != Stroke::AsShown {
            samples = self.replaced(&samples, request)?;
        }
        Ok(resting(&samples, request)?)
    }

    /// Keeps the shown profile of depth, and lets draw and rocking follow it.
    fn replaced(&self, shown: &Trajectory, request: &RolloutRequest) -> Result<Trajectory, CutError> {
        let mut samples = shown.samples().clone();
        for row in 0..samples.nrows() {
            let depth = samples[(row, 1)];
            for k in [0, 2] {
                samples[(row, k)] = request.start[k] + (request.goal[k] - request.start[k]) * depth;
            }
        }
        Ok(Trajectory::new(shown.times_s().to_vec(), samples)?)
    }

    /// Constrains draw and depth to the still corridor, then rocking to what the distance from the board leaves.
    fn kept(
        &self,
        request: &RolloutRequest,
        wanted: Rollout,
        still: &Corridor,
        limit: f64,
        size_m: f64,
    ) -> Result<(Constrained, Constrained), CutError> {
        let filter = &self.options.corridor_filter;
        let columns = |from: usize, count: usize| -> Result<Rollout, CutError> {
            let part = |table: &DMatrix<f64>| table.columns(from, count).into_owned();
            let positions = Trajectory::new(wanted.positions().times_s().to_vec(), part(wanted.positions().samples()))?;
            Ok(Rollout::new(positions, part(wanted.velocities()), part(wanted.accelerations()))?)
        };
        let goal = dvector![request.goal[0], request.goal[1]];
        let asked = FilterRequest { start: None, goal, duration_s: request.duration_s };
        let flat = Corridor::sampled(vec![0.0, request.duration_s], 2, |_, k| still.at(0.0, k))?;
        let place = constrain(filter, &columns(0, 2)?, &flat, &asked)?;
        let times_s = place.rollout.positions().times_s().to_vec();
        let largest = self.options.largest_rock_rad;
        let bounds = |row: usize| {
            let depth = state(&place.rollout, row, 1);
            let gap = PathState { position: limit - depth.position, first: -depth.first, second: -depth.second };
            let high = smaller(self.blade.rock_within(scaled(gap, size_m)), largest);
            Bounds { lower: scaled(high, -1.0), upper: high }
        };
        let row_of = |time_s: f64| times_s.partition_point(|sample| *sample < time_s).min(times_s.len() - 1);
        let narrowing = Corridor::sampled(times_s.clone(), 1, |time_s, _| bounds(row_of(time_s)))?;
        let asked = FilterRequest { start: None, goal: dvector![0.0], duration_s: request.duration_s };
        let rocking = constrain(filter, &columns(2, 1)?, &narrowing, &asked)?;
        Ok((place, rocking))
    }

    /// Notes what is certified; refuses what is not.
    fn note(
        &self,
        planned: &mut PlannedStroke,
        passes: &Passes,
        size_m: f64,
        place: &Certificate,
        rocking: &Certificate,
    ) -> Result<(), CutError> {
        let axes = place.axes.iter().chain(&rocking.axes).zip(["draw", "depth", "rocking"]);
        for (axis, coordinate) in axes {
            let margin = axis.lower.at_all_times.min(axis.upper.at_all_times);
            if !axis.holds() {
                return Err(CutError::NotCertified { cut: self.cut, coordinate, margin });
            }
            match coordinate {
                "draw" => planned.edge_margin_m = planned.edge_margin_m.min(margin * size_m),
                // straight or not, rocking stays within what the rest of the depth leaves to the limit
                "depth" => planned.past_board_m = self.options.largest_past_board_m,
                _ => {}
            }
        }
        debug_assert!(planned.edge_margin_m <= passes.room_m, "a margin is no more than the room");
        Ok(())
    }

    /// Adds what is left to do at the board: a belly rolls over the width, a saw goes through once more.
    fn add_finish(&self, skill: &CutSkill, passes: &Passes, planned: &mut PlannedStroke) -> Result<(), CutError> {
        let Some((begin_s, end)) = planned.states.last().copied() else { return Ok(()) };
        let speed = self.speed(skill);
        if passes.saws {
            let (from, depth) = (end.draw.position, end.depth.position);
            let duration_s = (PEAK * 2.0 * from.abs() / speed).max(SHORTEST_S);
            planned.states.extend(timed(begin_s, duration_s, |time_s| {
                let still = InPlane::at_rest(from, depth, 0.0);
                InPlane { draw: transfer(from, -from, time_s, duration_s), ..still }
            }));
            return Ok(());
        }
        // the food's ends lie to either side of where the edge ended up
        let width_m = self.rolled_width_m(end.draw.position);
        let Some(radius_m) = self.blade.belly_radius_m.filter(|_| width_m > 0.0) else { return Ok(()) };
        let roll_rad = width_m / radius_m;
        let largest_rad = self.options.largest_rock_rad;
        if roll_rad > largest_rad {
            return Err(CutError::BellyTooRound { cut: self.cut, roll_rad, largest_rad });
        }
        let mut begin_s = begin_s;
        for (from, to) in [(0.0, roll_rad), (roll_rad, -roll_rad), (-roll_rad, 0.0)] {
            let duration_s = (PEAK * radius_m * f64::abs(to - from) / speed).max(SHORTEST_S);
            let states =
                timed(begin_s, duration_s, |time_s| rolled(&end, radius_m, transfer(from, to, time_s, duration_s)));
            planned.states.extend(states);
            begin_s += duration_s;
        }
        Ok(())
    }
}

/// A belly that rolls on the board without slip from where it stands level: x = R(φ − sin φ), lifted by R(1 − cos φ).
fn rolled(level: &InPlane, radius_m: f64, rock: PathState) -> InPlane {
    let (sin, cos) = rock.position.sin_cos();
    let (first, second) = (rock.first, rock.second);
    InPlane {
        draw: PathState {
            position: level.draw.position + radius_m * (rock.position - sin),
            first: radius_m * (1.0 - cos) * first,
            second: radius_m * ((1.0 - cos) * second + sin * first * first),
        },
        depth: PathState {
            position: level.depth.position - radius_m * (1.0 - cos),
            first: -radius_m * sin * first,
            second: -radius_m * (sin * second + cos * first * first),
        },
        rock,
    }
}

/// States after `begin_s`, from the first step on.
fn timed(begin_s: f64, duration_s: f64, at: impl Fn(f64) -> InPlane) -> Vec<(f64, InPlane)> {
    let steps = (duration_s / STEP_S).ceil().max(1.0) as usize;
    let time = |step: usize| duration_s * step as f64 / steps as f64;
    (1..=steps).map(|step| (begin_s + time(step), at(time(step)))).collect()
}

fn state(rollout: &Rollout, row: usize, k: usize) -> PathState {
    PathState {
        position: rollout.positions().samples()[(row, k)],
        first: rollout.velocities()[(row, k)],
        second: rollout.accelerations()[(row, k)],
    }
}

fn scaled(state: PathState, by: f64) -> PathState {
    PathState { position: by * state.position, first: by * state.first, second: by * state.second }
}

/// A smooth lower bound of the smaller of a state and a constant: a·b/(a⁴ + b⁴)^¼.
fn smaller(a: PathState, b: f64) -> PathState {
    let ratio = a.position / b;
    let fourth = 1.0 + ratio.powi(4);
    // f = a·(1 + r⁴)^(−¼), f′ = (1 + r⁴)^(−5/4), f″ = −5r³/b·(1 + r⁴)^(−9/4)
    let (rise, bend) = (fourth.powf(-1.25), -5.0 * ratio.powi(3) / b * fourth.powf(-2.25));
    PathState {
        position: a.position * fourth.powf(-0.25),
        first: rise * a.first,
        second: bend * a.first * a.first + rise * a.second,
    }
}
