//! A demonstrated cut seen from its section: three coordinates in it, three across it, and its phases.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::refusal::CutError;
use super::section::{Blade, Section};
use crate::primitive::pose::PoseTrajectory;

/// A human's cut of one food at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct CutDemonstration {
    /// Poses of the knife, `world_from_tool`: see [`Blade`] for its frame.
    pub knife: PoseTrajectory,
    /// The section that was cut.
    pub section: Section,
    /// Edge of the knife.
    pub blade: Blade,
}

/// What the knife did across the section while it cut: noise about the constraint.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutOfPlane {
    /// Root mean square distance of the tool's origin from the section, m.
    pub lateral_m: f64,
    /// Root mean square tilt about the edge, rad.
    pub tilt_rad: f64,
    /// Root mean square yaw about the direction of the cut, rad.
    pub yaw_rad: f64,
}

/// One row of a demonstration in the frame of its section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Row {
    pub(super) time_s: f64,
    pub(super) draw_m: f64,
    pub(super) depth_m: f64,
    pub(super) rock_rad: f64,
    lateral_m: f64,
    tilt_rad: f64,
    yaw_rad: f64,
}

/// Distance from the board within which a stroke counts as through, m: what a hand and its recording miss.
const THROUGH_M: f64 = 0.003;
/// Mean deviations from the section beyond which it is another section: of place, m, and of angles, rad.
const LARGEST_MEAN_M: f64 = 0.01;
const LARGEST_MEAN_RAD: f64 = 0.25;
/// Share of the stroke's peak speed below which the knife rests before and after it.
const RESTING: f64 = 0.08;

impl CutDemonstration {
    /// Sees the knife from the section: turns about x and y that bring the blade into the section are tilt and yaw, what
    /// remains is a turn about z, the rocking.
    pub(super) fn rows(&self) -> Vec<Row> {
        let from_world = self.section.world_from_section.inverse();
        let rows = self.knife.times_s().iter().zip(self.knife.poses());
        rows.map(|(time_s, pose)| Row::of(*time_s, &(from_world * pose))).collect()
    }

    /// First and last row of the stroke: from where the knife last rests above the food to where it first rests at the board.
    pub(super) fn stroke(&self, rows: &[Row]) -> Result<(usize, usize), CutError> {
        let height_m = self.section.height_m;
        let deepest = rows.iter().map(|row| row.depth_m).fold(f64::NEG_INFINITY, f64::max);
        if deepest < height_m - THROUGH_M {
            return Err(CutError::NotThrough { depth_m: deepest, height_m, tolerance_m: THROUGH_M });
        }
        let enters = rows.iter().position(|row| row.depth_m > 0.0).unwrap_or(0);
        let reaches = rows.iter().position(|row| row.depth_m > deepest.min(height_m) - THROUGH_M).unwrap_or(0);
        let leaves = rows.iter().skip(reaches).any(|row| row.depth_m < 0.0);
        if enters == 0 {
            return Err(CutError::Phase { phase: "approach" });
        }
        if !leaves {
            return Err(CutError::Phase { phase: "withdrawal" });
        }
        let speed = |k: usize| {
            rows.get(k.saturating_sub(2)).zip(rows.get(k + 2)).map_or(0.0, |(from, to)| {
                ((to.depth_m - from.depth_m).hypot(to.draw_m - from.draw_m)) / (to.time_s - from.time_s)
            })
        };
        let peak = (enters..=reaches).map(speed).fold(0.0, f64::max);
        let slow = |k: &usize| speed(*k) < RESTING * peak;
        // without a rest the stroke begins where the knife enters
        let first = (0..enters).rev().find(slow).unwrap_or(enters - 1);
        let last = (reaches..rows.len()).find(slow).unwrap_or(reaches).max(first + 2);
        if last >= rows.len() {
            return Err(CutError::Phase { phase: "cut" });
        }
        Ok((first, last))
    }

    /// Measures what lies across the section.
    pub(super) fn out_of_plane(stroke: &[Row]) -> Result<OutOfPlane, CutError> {
        let count = stroke.len().max(1) as f64;
        let mean = |of: fn(&Row) -> f64| stroke.iter().map(of).sum::<f64>() / count;
        let rms = |of: fn(&Row) -> f64| (stroke.iter().map(|row| of(row).powi(2)).sum::<f64>() / count).sqrt();
        let means = [
            ("place", mean(|row| row.lateral_m), LARGEST_MEAN_M, "m"),
            ("tilt", mean(|row| row.tilt_rad), LARGEST_MEAN_RAD, "rad"),
            ("yaw", mean(|row| row.yaw_rad), LARGEST_MEAN_RAD, "rad"),
        ];
        if let Some((coordinate, mean, largest, unit)) = means.into_iter().find(|(_, mean, most, _)| mean.abs() > *most)
        {
            return Err(CutError::OutOfPlane { coordinate, mean, largest, unit });
        }
        Ok(OutOfPlane {
            lateral_m: rms(|row| row.lateral_m),
            tilt_rad: rms(|row| row.tilt_rad),
            yaw_rad: rms(|row| row.yaw_rad),
        })
    }
}

impl Row {
    fn of(time_s: f64, section_from_tool: &Isometry3<f64>) -> Self {
        let normal = section_from_tool.rotation * Vector3::z();
        // a blade the wrong way round is half a turn off, about x for want of a better axis
        let into = UnitQuaternion::rotation_between(&normal, &Vector3::z())
            .unwrap_or_else(|| UnitQuaternion::from_scaled_axis(Vector3::x() * std::f64::consts::PI));
        let off = into.inverse().scaled_axis();
        let along = into * section_from_tool.rotation * Vector3::x();
        let place = section_from_tool.translation.vector;
        Self {
            time_s,
            draw_m: place.x,
            depth_m: place.y,
            rock_rad: along.y.atan2(along.x),
            lateral_m: place.z,
            tilt_rad: off.x,
            yaw_rad: off.y,
        }
    }
}
