//! A demonstrated pour seen from the mouth: place and tilt in the frame of pouring, and its phases.

use nalgebra::{Isometry3, Vector3};

use super::container::{Container, Mouth};
use super::refusal::PourError;
use crate::primitive::pose::PoseTrajectory;

/// A human's pour from one cup into one mouth.
#[derive(Debug, Clone, PartialEq)]
pub struct PourDemonstration {
    /// Poses of the cup, `world_from_cup`: see [`Container`] for its frame.
    pub cup: PoseTrajectory,
    /// The cup.
    pub source: Container,
    /// The mouth.
    pub mouth: Mouth,
}

/// One row in the frame of pouring; what lies across its plane, and turns out of it, is noise about the constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Row {
    pub(super) time_s: f64,
    /// Place of the lip along the direction of pouring and above the rim, m.
    pub(super) lip_x_m: f64,
    pub(super) lip_z_m: f64,
    /// Tilt toward the direction of pouring, rad.
    pub(super) tilt_rad: f64,
    /// Origin of the cup's frame, world, m.
    pub(super) place_m: Vector3<f64>,
}

/// Where the phases of a demonstration begin and end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Phases {
    /// Row at which the approach ends and the tilt begins.
    pub(super) tilt: usize,
    /// Row of the greatest tilt.
    pub(super) end: usize,
}

/// Least tilt that counts as a pour, rad.
const LEAST_TILT_RAD: f64 = 1.0;
/// Part of the greatest tilt below which the cup is not tilted yet.
const BEGUN: f64 = 0.06;
/// Part of the greatest tilt that ends the tilt: the rest is a slow creep.
const ENDED: f64 = 0.995;

impl PourDemonstration {
    /// Direction of pouring about z of the world, rad: that of the lip at the greatest tilt.
    pub(super) fn direction_rad(&self) -> f64 {
        let down = |pose: &Isometry3<f64>| (pose.rotation * Vector3::z()).z;
        let steepest = self.cup.poses().iter().min_by(|a, b| down(a).total_cmp(&down(b)));
        // the axis of a cup that is tilted leans toward where it pours
        steepest.map_or(0.0, |pose| {
            let axis = pose.rotation * Vector3::z();
            axis.y.atan2(axis.x)
        })
    }

    pub(super) fn rows(&self) -> Vec<Row> {
        let pour_from_world = self.mouth.world_from_pour(self.direction_rad()).inverse();
        let rows = self.cup.times_s().iter().zip(self.cup.poses());
        rows.map(|(time_s, pose)| {
            let in_pour = pour_from_world * pose;
            let lip = in_pour * self.source.lip();
            let axis = in_pour.rotation * Vector3::z();
            Row {
                time_s: *time_s,
                lip_x_m: lip.x,
                lip_z_m: lip.z,
                tilt_rad: axis.x.atan2(axis.z),
                place_m: pose.translation.vector,
            }
        })
        .collect()
    }

    pub(super) fn phases(rows: &[Row]) -> Result<Phases, PourError> {
        let tilt_rad = rows.iter().map(|row| row.tilt_rad).fold(f64::NEG_INFINITY, f64::max);
        let end = rows.iter().position(|row| row.tilt_rad >= ENDED * tilt_rad).unwrap_or(0);
        let tilt = (0..end).rev().find(|row| rows.get(*row).is_some_and(|row| row.tilt_rad < BEGUN * tilt_rad));
        match tilt.filter(|tilt| tilt_rad >= LEAST_TILT_RAD && *tilt > 2 && end > tilt + 2) {
            Some(tilt) => Ok(Phases { tilt, end }),
            None => Err(PourError::NotTilted { tilt_rad, least_rad: LEAST_TILT_RAD }),
        }
    }
}
