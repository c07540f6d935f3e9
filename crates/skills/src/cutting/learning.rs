//! Learning a cut from one demonstration: the stroke without its section, Eqs. (16) to (21), and the plain primitive of the
//! whole, to compare with.

use nalgebra::{DMatrix, Isometry3};
use serde::{Deserialize, Serialize};

use super::demonstration::{CutDemonstration, OutOfPlane, Row};
use super::refusal::CutError;
use super::section::Section;
use crate::corridor::{Bounds, Corridor};
use crate::field::{FieldError, positive};
use crate::primitive::pose::PoseDmp;
use crate::primitive::{DmpConfig, PrimitiveConfig};
use crate::separation::constraint_based::{ConstrainedDemonstration, ConstraintBased, ConstraintBasedConfig};
use crate::trajectory::Trajectory;

/// Options of learning a cut.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CutLearning {
    /// Separation of the stroke from its corridor. By default 15 bases: what is faster than some seven cycles in a stroke
    /// is the hand's noise.
    pub separation: ConstraintBasedConfig,
    /// Primitive of the whole demonstration that [`CutSkill::plain_dmp`] moves.
    pub plain: DmpConfig,
    /// Standard deviation of the hand and the recording in the section, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub noise_m: f64,
    /// Angle below which rocking is the hand's noise, rad.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub least_rock_rad: f64,
}

impl Default for CutLearning {
    fn default() -> Self {
        let primitive = PrimitiveConfig::Dmp(DmpConfig { bases: 15, ..DmpConfig::default() });
        Self {
            separation: ConstraintBasedConfig { primitive, ..ConstraintBasedConfig::default() },
            plain: DmpConfig::default(),
            noise_m: 0.0007,
            least_rock_rad: 0.08,
        }
    }
}

impl CutLearning {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.separation.validate().map_err(|error| error.within("separation"))?;
        self.plain.validate().map_err(|error| error.within("plain"))?;
        positive("noise_m", self.noise_m)?;
        positive("least_rock_rad", self.least_rock_rad)
    }
}

/// What a demonstrated stroke was like.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShownStroke {
    /// Duration of the stroke, s.
    pub duration_s: f64,
    /// Depth from its begin to its end, m.
    pub travel_m: f64,
    /// Draw along the edge per depth, signed: the slice–push ratio.
    pub slice_push_ratio: f64,
    /// Angle by which the edge rocks at its begin, rad; 0 if it only wobbles.
    pub rock_rad: f64,
    /// Height above the food from which the knife came and to which it left, the lesser, m.
    pub lift_m: f64,
    /// What lay across the section, and was left out.
    pub out_of_plane: OutOfPlane,
}

impl ShownStroke {
    /// Mean speed of the edge, m/s.
    #[must_use]
    pub fn speed_m_per_s(&self) -> f64 {
        self.travel_m * self.slice_push_ratio.hypot(1.0) / self.duration_s
    }
}

/// A cut learned from one demonstration.
///
/// The stroke is a skill of three coordinates: draw, depth and rocking, lengths over the depth of the stroke.
#[derive(Debug)]
pub struct CutSkill {
    pub(super) stroke: ConstraintBased,
    pub(super) shown: ShownStroke,
    pub(super) plain: PoseDmp,
    pub(super) whole: ShownWhole,
}

/// Where the whole demonstration was shown: what the plain primitive is moved from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShownWhole {
    /// The section that was cut.
    pub section: Section,
    /// First and last pose of the knife, `world_from_tool`.
    pub ends: [Isometry3<f64>; 2],
    /// Duration of all of it, s.
    pub duration_s: f64,
}

impl ShownWhole {
    fn of(shown: &CutDemonstration) -> Result<Self, CutError> {
        let (Some(first), Some(last)) = (shown.knife.poses().first(), shown.knife.poses().last()) else {
            return Err(CutError::Phase { phase: "cut" });
        };
        Ok(Self { section: shown.section, ends: [*first, *last], duration_s: shown.knife.duration_s() })
    }
}

/// Distance past the board that a demonstration may reach: a hand does not feel less, m.
const SHOWN_PAST_BOARD_M: f64 = 0.003;
/// Room between the end of a stroke and the bound of its depth, m.
const BOARD_ROOM_M: f64 = 0.0003;
/// Largest rocking that a demonstration may show, rad.
pub(super) const LARGEST_ROCK_RAD: f64 = 0.8;
/// Coordinates of a stroke: draw, depth, rocking.
pub(super) const COORDINATES: usize = 3;
/// Noise of the angle for the separation, rad.
const ROCK_NOISE_RAD: f64 = 0.02;

impl CutSkill {
    /// Learns from one demonstration.
    ///
    /// # Errors
    /// A [`CutError`] if an option, the section or the blade is invalid, the demonstration does not cut the section, or the
    /// stroke leaves the corridor of section, board and edge.
    pub fn learn(config: &CutLearning, shown: &CutDemonstration) -> Result<Self, CutError> {
        config.validate()?;
        shown.section.validate().map_err(|error| error.within("section"))?;
        shown.blade.validate().map_err(|error| error.within("blade"))?;
        let rows = shown.rows();
        let (first, last) = shown.stroke(&rows)?;
        let stroke = rows.get(first..=last).unwrap_or_default();
        let out_of_plane = CutDemonstration::out_of_plane(stroke)?;
        let (Some(begin), Some(end)) = (stroke.first(), stroke.last()) else {
            return Err(CutError::Phase { phase: "cut" });
        };
        let rocks = stroke.iter().any(|row| (row.rock_rad - end.rock_rad).abs() > config.least_rock_rad);
        let above = |rows: &[Row]| -rows.iter().map(|row| row.depth_m).fold(f64::INFINITY, f64::min);
        let described = ShownStroke {
            duration_s: end.time_s - begin.time_s,
            travel_m: end.depth_m - begin.depth_m,
            slice_push_ratio: (end.draw_m - begin.draw_m) / (end.depth_m - begin.depth_m),
            rock_rad: if rocks { begin.rock_rad - end.rock_rad } else { 0.0 },
            lift_m: above(&rows[..first]).min(above(&rows[last..])).max(0.01),
            out_of_plane,
        };
        Ok(Self {
            stroke: separated(config, shown, stroke, &described)?,
            shown: described,
            plain: PoseDmp::learn(&config.plain, std::slice::from_ref(&shown.knife))?,
            whole: ShownWhole::of(shown)?,
        })
    }

    /// What the demonstrated stroke was like.
    #[must_use]
    pub fn shown(&self) -> &ShownStroke {
        &self.shown
    }

    /// The skill of draw, depth and rocking, lengths over the depth of the stroke: free of section, board and edge.
    #[must_use]
    pub fn stroke(&self) -> &ConstraintBased {
        &self.stroke
    }
}

/// Takes section, board and edge out of a stroke.
fn separated(
    config: &CutLearning,
    shown: &CutDemonstration,
    stroke: &[Row],
    described: &ShownStroke,
) -> Result<ConstraintBased, CutError> {
    let travel_m = described.travel_m;
    let (Some(begin), Some(end)) = (stroke.first(), stroke.last()) else {
        return Err(CutError::Phase { phase: "cut" });
    };
    let middle_m = 0.5 * (begin.draw_m + end.draw_m);
    let rocks = f64::from(u8::from(described.rock_rad != 0.0));
    let samples = DMatrix::from_fn(stroke.len(), COORDINATES, |row, coordinate| match (stroke.get(row), coordinate) {
        (Some(row), 0) => (row.draw_m - middle_m) / travel_m,
        (Some(row), 1) => (row.depth_m - begin.depth_m) / travel_m,
        (Some(row), _) => rocks * (row.rock_rad - end.rock_rad),
        (None, _) => f64::NAN,
    });
    let times_s = stroke.iter().map(|row| row.time_s - begin.time_s).collect();
    let trajectory = Trajectory::new(times_s, samples)?;
    // whatever the edge still touches: who shows a cut may use the ends of the edge
    let room_m = 0.5 * (shown.section.width_m + shown.blade.edge_m);
    let deepest_m = stroke.iter().map(|row| row.depth_m).fold(f64::NEG_INFINITY, f64::max);
    // the board is where the knife stopped: as near to the bound as a planned stroke comes, so that the map is undone alike
    let board_m = deepest_m.min(shown.section.height_m + SHOWN_PAST_BOARD_M) + BOARD_ROOM_M;
    let corridor = stroke_corridor(
        [(-room_m - middle_m) / travel_m, (room_m - middle_m) / travel_m],
        [-1.0, (board_m - begin.depth_m) / travel_m],
        LARGEST_ROCK_RAD,
    )?;
    let noise = [config.noise_m / travel_m, config.noise_m / travel_m, ROCK_NOISE_RAD];
    let demonstration = ConstrainedDemonstration { trajectory: &trajectory, corridor: &corridor, noise: &noise };
    Ok(ConstraintBased::learn(&config.separation, &[demonstration])?)
}

/// Corridor of draw and depth, over the depth of the stroke, and of rocking, rad.
pub(super) fn stroke_corridor(draw: [f64; 2], depth: [f64; 2], rock_rad: f64) -> Result<Corridor, CutError> {
    let bounds = [draw, depth, [-rock_rad, rock_rad]];
    Ok(Corridor::sampled(vec![0.0, 1.0], COORDINATES, |_, coordinate| {
        let [lower, upper] = bounds.get(coordinate).copied().unwrap_or_default();
        Bounds::still(lower, upper)
    })?)
}
