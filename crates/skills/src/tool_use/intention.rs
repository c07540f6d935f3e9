//! The intention: where the object was to go, freed from what the tool of the demonstrations could not do (Fig. 5(a), (b)).
//!
//! Within a push, the contact surface keeps the object near a straight line: that is the corridor which Algorithm 2 takes
//! out of each section. What is left of all sections is learned as one primitive from start to goal, which another tool
//! may follow by pushes of its own.

use nalgebra::{DMatrix, Point2, Rotation2, Vector2};

use super::library::Shown;
use crate::corridor::{Bounds, Corridor};
use crate::demonstration::path;
use crate::error::SkillError;
use crate::primitive::{MovementPrimitive, PrimitiveConfig};
use crate::separation::constraint_based::{
    ConstrainedDemonstration, ConstraintBased, ConstraintBasedConfig, ConstraintError,
};
use crate::time_law::PathState;
use crate::tool::Tool;
use crate::trajectory::Trajectory;

/// Noise of a recorded place of an object, m: that of a depth camera after alignment.
const NOISE_M: f64 = 0.0004;
/// Room beyond what was shown, as a share of it: a demonstrated place is inside its corridor, not on its edge.
const ROOM: f64 = 1.1;
/// Half of a corridor's width along the push, as a share of its length: no constraint.
const FREE_ALONG: f64 = 2.0;
/// Points that are kept of a shown path.
const SKETCHED_POINTS: usize = 41;
/// Ends of two sections that follow each other may be this far apart, m: the object rests between them.
const LARGEST_GAP_M: f64 = 0.01;

/// The intention of demonstrations, with what it was learned from.
#[derive(Debug)]
pub struct Intention {
    /// Path of the object's center from start to goal, world axes, m.
    pub primitive: Box<dyn MovementPrimitive>,
    /// Mean displacement of the object over the demonstrations, m.
    pub displacement: Vector2<f64>,
    /// Mean duration of its motion, s.
    pub duration_s: f64,
    /// The object's paths as they were shown, waits cut out, a few points of each, m.
    pub shown: Vec<Vec<Point2<f64>>>,
    /// The same paths freed from the tool's constraints, n × 2, m; absent from a library that was loaded.
    pub unconstrained: Vec<Trajectory>,
}

impl Intention {
    /// Learns the intention of demonstrations with `tool`, all with the same sequence of pushes.
    pub(super) fn learn(primitive: &PrimitiveConfig, shown: &[&Shown], tool: &Tool) -> Result<Self, ConstraintError> {
        let sections = shown.iter().map(|(_, fragments)| fragments.len()).min().unwrap_or(0);
        let mut whole: Vec<[Option<Trajectory>; 2]> = shown.iter().map(|_| [None, None]).collect();
        for index in 0..sections {
            let (paths, freed) = section(primitive, shown, index, tool)?;
            for (whole, parts) in whole.iter_mut().zip(paths.into_iter().zip(freed)) {
                for (whole, part) in whole.iter_mut().zip([parts.0, parts.1]) {
                    *whole = Some(match whole.take() {
                        Some(before) => before.concatenate(&part, LARGEST_GAP_M)?,
                        None => part,
                    });
                }
            }
        }
        let (shown, unconstrained): (Vec<_>, Vec<_>) =
            whole.into_iter().filter_map(|[shown, freed]| Some((shown?, freed?))).unzip();
        let count = shown.len().max(1) as f64;
        let displacement = shown.iter().map(|path| path.end() - path.start()).map(|way| Vector2::new(way[0], way[1]));
        Ok(Self {
            displacement: displacement.sum::<Vector2<f64>>() / count,
            duration_s: shown.iter().map(Trajectory::duration_s).sum::<f64>() / count,
            primitive: primitive.learn(&unconstrained)?,
            shown: shown.iter().map(sketched).collect::<Result<_, _>>()?,
            unconstrained,
        })
    }
}

/// A few points of a path, evenly in time.
fn sketched(path: &Trajectory) -> Result<Vec<Point2<f64>>, SkillError> {
    let few = path.resample(SKETCHED_POINTS)?;
    Ok(few.samples().row_iter().map(|row| Point2::new(row[0], row[1])).collect())
}

/// Section `index` of each demonstration: as it was shown, and freed from its corridor.
fn section(
    primitive: &PrimitiveConfig,
    shown: &[&Shown],
    index: usize,
    tool: &Tool,
) -> Result<(Vec<Trajectory>, Vec<Trajectory>), ConstraintError> {
    let mut paths = Vec::new();
    let mut turn = Rotation2::identity();
    let mut half_width_m = 0.0;
    for (aligned, fragments) in shown {
        let Some(fragment) = fragments.get(index) else { continue };
        paths.push(path(&fragment.object_path(aligned), aligned.time_step_s)?);
        if let Some(surface) = tool.surfaces.get(fragment.surface) {
            turn = Rotation2::rotation_between(&Vector2::x(), &surface.middle().normal.into_inner());
            half_width_m = 0.5 * surface.length_m();
        }
    }
    let along: Vec<Trajectory> = paths.iter().map(|path| rotated(path, &turn.inverse())).collect::<Result<_, _>>()?;
    let corridors = along.iter().map(|path| corridor(path, half_width_m)).collect::<Result<Vec<_>, _>>()?;
    let noise = [NOISE_M; 2];
    let demonstrations: Vec<_> = along
        .iter()
        .zip(&corridors)
        .map(|(trajectory, corridor)| ConstrainedDemonstration { trajectory, corridor, noise: &noise })
        .collect();
    let config = ConstraintBasedConfig { primitive: primitive.clone(), ..ConstraintBasedConfig::default() };
    let separated = ConstraintBased::learn(&config, &demonstrations)?;
    let freed = separated.unconstrained().iter().map(|path| rotated(path, &turn)).collect::<Result<_, _>>()?;
    Ok((paths, freed))
}

/// A path (n × 2) seen from axes that are turned.
fn rotated(path: &Trajectory, turn: &Rotation2<f64>) -> Result<Trajectory, SkillError> {
    let samples = path.samples();
    let point = |row: usize| turn * Point2::new(samples[(row, 0)], samples[(row, 1)]);
    Trajectory::new(path.times_s().to_vec(), DMatrix::from_fn(path.len(), 2, |row, axis| point(row)[axis]))
}

/// Corridor of a push along x: the straight line of its ends, half a surface to either side, more where more was shown.
fn corridor(path: &Trajectory, half_width_m: f64) -> Result<Corridor, SkillError> {
    let (from, to) = (path.start(), path.end());
    let (begin_s, duration_s) = (path.start_time_s(), path.duration_s());
    let slope = (&to - &from) / duration_s;
    let sideways = path.samples().column(1);
    let rows = path.times_s().iter().zip(sideways.iter());
    let off_line = rows.map(|(time_s, y)| (y - (from[1] + slope[1] * (time_s - begin_s))).abs());
    let widest_m = off_line.fold(0.0, f64::max);
    let sideways_m = (half_width_m + NOISE_M).max(ROOM * widest_m);
    let along_m = FREE_ALONG * (&to - &from).norm().max(sideways_m);
    let line = |time_s: f64, axis: usize, offset: f64| PathState {
        position: from[axis] + slope[axis] * (time_s - begin_s) + offset,
        first: slope[axis],
        second: 0.0,
    };
    Corridor::sampled(vec![begin_s, begin_s + duration_s], 2, |time_s, axis| {
        let half_m = [along_m, sideways_m][axis];
        Bounds { lower: line(time_s, axis, -half_m), upper: line(time_s, axis, half_m) }
    })
}
