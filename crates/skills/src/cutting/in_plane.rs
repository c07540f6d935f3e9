//! Motion of a knife within a section: draw along the edge, depth and rocking.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::section::Section;
use crate::spatial::{SpatialError, SpatialKnot, SpatialMotion, SpatialTrack};
use crate::time_law::{PathState, minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative};

/// Where the tool's origin is in the frame of a section, and how the edge rocks there.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct InPlane {
    /// Place along x, m.
    pub(super) draw: PathState,
    /// Place along y, m: 0 at the top of the food.
    pub(super) depth: PathState,
    /// Angle about z, rad.
    pub(super) rock: PathState,
}

impl InPlane {
    /// At rest.
    pub(super) fn at_rest(draw: f64, depth: f64, rock: f64) -> Self {
        let at = |position| PathState { position, ..PathState::default() };
        Self { draw: at(draw), depth: at(depth), rock: at(rock) }
    }

    /// The motion in the world, exactly in the plane of the section.
    pub(super) fn in_world(&self, section: &Section) -> SpatialMotion {
        let Self { draw, depth, rock } = self;
        let pose = Isometry3::from_parts(
            Translation3::new(draw.position, depth.position, 0.0),
            UnitQuaternion::from_scaled_axis(Vector3::z() * rock.position),
        );
        let in_section = SpatialMotion::new(
            pose,
            [Vector3::new(draw.first, depth.first, 0.0), Vector3::z() * rock.first],
            [Vector3::new(draw.second, depth.second, 0.0), Vector3::z() * rock.second],
        );
        in_section.seen_from(&section.world_from_section)
    }
}

/// Minimum jerk from one value to another, as a function of time over `duration_s`.
pub(super) fn transfer(from: f64, to: f64, time_s: f64, duration_s: f64) -> PathState {
    let ratio = time_s / duration_s;
    PathState {
        position: from + (to - from) * minimum_jerk(ratio),
        first: (to - from) * minimum_jerk_first_derivative(ratio) / duration_s,
        second: (to - from) * minimum_jerk_second_derivative(ratio) / (duration_s * duration_s),
    }
}

/// Track of a motion in a section, from its states at times from 0 s on.
pub(super) fn track(section: &Section, states: &[(f64, InPlane)]) -> Result<SpatialTrack, SpatialError> {
    let knot = |(time_s, state): &(f64, InPlane)| SpatialKnot { time_s: *time_s, motion: state.in_world(section) };
    SpatialTrack::new(states.iter().map(knot).collect())
}
