//! From a demonstration inside its corridor to the unconstrained coordinate, Eq. (17), and what was found on the way.

use nalgebra::DMatrix;

use super::{ConstrainedDemonstration, ConstraintError};
use crate::corridor::{Bounds, Corridor};
use crate::corridor_map::{CorridorMapConfig, Fallback, MotionEnds};
use crate::error::SkillError;
use crate::trajectory::Trajectory;

/// Part of the samples that may lie outside by more than the tolerance: single outliers of the recording.
const OUTLIERS: f64 = 0.02;
/// Standard deviations of the noise by which a sample may lie outside.
const NOISE_BAND: f64 = 3.0;

/// What is attempted, for errors.
const OPERATION: &str = "separate skill";

/// What was found in the motion that was mapped, one entry per coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct DemonstrationReport {
    /// The coordinates, d entries.
    pub coordinates: Vec<CoordinateReport>,
}

/// What was found in one coordinate of the motion that was mapped.
#[derive(Debug, Clone, PartialEq)]
pub struct CoordinateReport {
    /// Part of the samples that lie outside their bounds, 0 to 1.
    pub outside_fraction: f64,
    /// How far the furthest sample lies outside, in the unit of the samples; 0 if all are inside.
    pub furthest_outside: f64,
    /// Linear margin δ that was chosen, as a share of the width.
    pub delta: f64,
    /// Why the map is not the one asked for, if it is not.
    pub fallback: Option<Fallback>,
}

/// Bounds of one motion at its samples: one list of n per coordinate.
pub(super) type BoundsTable = Vec<Vec<Bounds>>;

/// Checks that a demonstration, its corridor and noise belong together, and that it lies inside but for noise; returns
/// the bounds at its samples.
pub(super) fn check(
    index: usize,
    demonstration: &ConstrainedDemonstration<'_>,
) -> Result<BoundsTable, ConstraintError> {
    let ConstrainedDemonstration { trajectory, corridor, noise } = *demonstration;
    let expected = trajectory.dimension();
    for found in [corridor.dimension(), noise.len()] {
        if found != expected {
            return Err(SkillError::Dimension { operation: OPERATION, found, expected }.into());
        }
    }
    if let Some(found) = noise.iter().copied().find(|noise| !(*noise >= 0.0 && noise.is_finite())) {
        let (argument, expected) = ("noise", "a finite number of at least 0");
        return Err(SkillError::InvalidArgument { operation: OPERATION, argument, found, expected }.into());
    }
    let table = bounds_table(corridor, trajectory)?;
    for (coordinate, (bounds, noise)) in table.iter().zip(noise).enumerate() {
        let tolerance = NOISE_BAND * noise;
        let excess = Excess::of(trajectory, bounds, coordinate, tolerance);
        if excess.fraction > OUTLIERS {
            return Err(ConstraintError::OutsideCorridor {
                demonstration: index,
                coordinate,
                percent: 100.0 * excess.fraction,
                row: excess.row,
                time_s: trajectory.times_s()[excess.row],
                outside: excess.furthest,
                tolerance,
            });
        }
    }
    Ok(table)
}

/// Maps a motion of d coordinates by Eq. (17), coordinate by coordinate; `table` has the bounds at its samples, `noise`
/// d values.
pub(super) fn map(
    index: usize,
    config: &CorridorMapConfig,
    trajectory: &Trajectory,
    table: &BoundsTable,
    noise: &[f64],
) -> Result<(Trajectory, DemonstrationReport), ConstraintError> {
    let (shown, times_s) = (trajectory.samples(), trajectory.times_s());
    let mut samples = DMatrix::zeros(shown.nrows(), shown.ncols());
    let mut coordinates = vec![];
    for (coordinate, (bounds, noise)) in table.iter().zip(noise).enumerate() {
        let last = bounds.len() - 1;
        let ends = MotionEnds {
            start: shown[(0, coordinate)],
            start_bounds: bounds[0],
            goal: shown[(last, coordinate)],
            goal_bounds: bounds[last],
        };
        let delta = ends.delta(*noise, narrowest(bounds));
        let selected = config.map(&ends, delta)?;
        for (row, (time_s, bounds)) in times_s.iter().zip(bounds).enumerate() {
            let progress = (time_s - trajectory.start_time_s()) / trajectory.duration_s();
            let position = shown[(row, coordinate)];
            let unconstrained = selected.map.unconstrained(bounds, progress, position);
            if !unconstrained.is_finite() {
                let (lower, upper) = (bounds.lower.position, bounds.upper.position);
                return Err(ConstraintError::NoValue { demonstration: index, row, coordinate, position, lower, upper });
            }
            samples[(row, coordinate)] = unconstrained;
        }
        let excess = Excess::of(trajectory, bounds, coordinate, 0.0);
        coordinates.push(CoordinateReport {
            outside_fraction: excess.fraction,
            furthest_outside: excess.furthest,
            delta,
            fallback: selected.fallback,
        });
    }
    Ok((Trajectory::new(times_s.to_vec(), samples)?, DemonstrationReport { coordinates }))
}

/// Reads the bounds of every coordinate of a corridor at the samples of a motion.
pub(super) fn bounds_table(corridor: &Corridor, motion: &Trajectory) -> Result<BoundsTable, SkillError> {
    (0..corridor.dimension()).map(|coordinate| bounds(OPERATION, corridor, motion.times_s(), coordinate)).collect()
}

/// Reads the bounds of `coordinate` at every time; refuses a corridor whose interpolated bounds cross between its
/// samples.
pub(super) fn bounds(
    operation: &'static str,
    corridor: &Corridor,
    times_s: &[f64],
    coordinate: usize,
) -> Result<Vec<Bounds>, SkillError> {
    let read = |time_s: &f64| {
        let bounds = corridor.at(*time_s, coordinate);
        let found = bounds.width().position;
        if found > 0.0 && found.is_finite() {
            return Ok(bounds);
        }
        let expected = "an upper bound above the lower one at every sample of the motion";
        Err(SkillError::InvalidArgument { operation, argument: "width", found, expected })
    };
    times_s.iter().map(read).collect()
}

/// Returns the least width.
pub(super) fn narrowest(bounds: &[Bounds]) -> f64 {
    bounds.iter().map(|bounds| bounds.width().position).fold(f64::INFINITY, f64::min)
}

/// How much of one coordinate of a motion is outside.
struct Excess {
    /// Part of the samples outside by more than the tolerance.
    fraction: f64,
    /// How far the furthest sample is outside, at least 0.
    furthest: f64,
    /// Row of that sample.
    row: usize,
}

impl Excess {
    fn of(trajectory: &Trajectory, bounds: &[Bounds], coordinate: usize, tolerance: f64) -> Self {
        let mut excess = Self { fraction: 0.0, furthest: 0.0, row: 0 };
        let mut count = 0usize;
        for (row, bounds) in bounds.iter().enumerate() {
            let outside = -bounds.margin(trajectory.samples()[(row, coordinate)]);
            count += usize::from(outside > tolerance);
            if outside > excess.furthest {
                (excess.furthest, excess.row) = (outside, row);
            }
        }
        excess.fraction = count as f64 / bounds.len() as f64;
        excess
    }
}
