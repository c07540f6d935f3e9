//! Learning a pour from one demonstration: the approach without its corridor, the tilt without the rim.

use nalgebra::{DMatrix, Isometry3};
use serde::{Deserialize, Serialize};

use super::approach;
use super::demonstration::{PourDemonstration, Row};
use super::refusal::PourError;
use super::tilting::virtual_rise;
use crate::field::FieldError;
use crate::primitive::pose::{PoseDmp, PoseTrajectory};
use crate::primitive::{Dmp, DmpConfig, PrimitiveConfig};
use crate::separation::constraint_based::{ConstraintBased, ConstraintBasedConfig};
use crate::trajectory::Trajectory;

/// Options of learning a pour.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PourLearning {
    /// Separation of the approach from its corridor; 12 bases by default, to leave the hand's noise out.
    pub approach: ConstraintBasedConfig,
    /// Primitive of the lip's own way about the mouth over the tilt; 8 bases by default.
    pub tilt: DmpConfig,
    /// Primitive of the whole demonstration that [`PourSkill::plain_dmp`] moves.
    pub plain: DmpConfig,
    /// Clearance of the virtual movement that is taken out of what was shown, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub margin_m: f64,
}

impl Default for PourLearning {
    fn default() -> Self {
        let primitive = PrimitiveConfig::Dmp(DmpConfig { bases: 12, ..DmpConfig::default() });
        Self {
            approach: ConstraintBasedConfig { primitive, ..ConstraintBasedConfig::default() },
            tilt: DmpConfig { bases: 8, ..DmpConfig::default() },
            plain: DmpConfig::default(),
            margin_m: 0.005,
        }
    }
}

impl PourLearning {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.approach.validate().map_err(|error| error.within("approach"))?;
        self.tilt.validate().map_err(|error| error.within("tilt"))?;
        self.plain.validate().map_err(|error| error.within("plain"))?;
        crate::field::positive("margin_m", self.margin_m)
    }
}

/// A pour learned from one demonstration.
#[derive(Debug)]
pub struct PourSkill {
    pub(super) approach: ConstraintBased,
    /// x^t: place of the lip in radii of the mouth and height above the virtual movement, m, over the part of the tilt.
    pub(super) tilt: Dmp,
    /// Place of the lip at the end, in radii of the mouth.
    pub(super) over: f64,
    pub(super) plain: PoseDmp,
    pub(super) whole: ShownPour,
}

/// Where the demonstration was shown, up to its greatest tilt: what the plain primitive is moved from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShownPour {
    /// Frame of pouring: origin in the middle of the mouth, z up, x in the direction of pouring.
    pub world_from_pour: Isometry3<f64>,
    /// Pose of the greatest tilt, `world_from_cup`.
    pub steepest: Isometry3<f64>,
    /// Time until then, s.
    pub duration_s: f64,
}

/// Rows of the tilt over its angle; the grid of the virtual movement.
const ROWS: usize = 121;

impl PourSkill {
    /// Learns from one demonstration.
    ///
    /// # Errors
    /// A [`PourError`] if an option, the cup or the mouth is invalid, the demonstration does not approach and tilt, or it
    /// leaves its corridor.
    pub fn learn(config: &PourLearning, shown: &PourDemonstration) -> Result<Self, PourError> {
        config.validate()?;
        shown.source.validate().map_err(|error| error.within("source"))?;
        shown.mouth.validate().map_err(|error| error.within("mouth"))?;
        let rows = shown.rows();
        let phases = PourDemonstration::phases(&rows)?;
        let (approach, _) = approach::learn(&config.approach, &rows[..=phases.tilt])?;
        let tilt = over_the_tilt(&rows[phases.tilt..=phases.end]);
        let steepest = shown.cup.poses()[phases.end];
        let whole = PoseTrajectory::new(
            shown.cup.times_s()[..=phases.end].to_vec(),
            shown.cup.poses()[..=phases.end].to_vec(),
        )?;
        Ok(Self {
            approach,
            tilt: own_way(config, shown, &tilt)?,
            over: tilt.last().map_or(0.0, |(x, _, _)| x / shown.mouth.radius_m),
            plain: PoseDmp::learn(&config.plain, std::slice::from_ref(&whole))?,
            whole: ShownPour {
                world_from_pour: shown.mouth.world_from_pour(shown.direction_rad()),
                steepest,
                duration_s: whole.duration_s(),
            },
        })
    }

    /// Place of the lip over the mouth at the end of what was shown, in radii of the mouth along the direction of pouring.
    #[must_use]
    pub fn over(&self) -> f64 {
        self.over
    }
}

/// Place and height of the lip, m, and tilt, rad, at equal steps of the tilt: where it is first passed.
fn over_the_tilt(rows: &[Row]) -> Vec<(f64, f64, f64)> {
    let (begin, end) = (rows.first().map_or(0.0, |row| row.tilt_rad), rows.last().map_or(0.0, |row| row.tilt_rad));
    let mut passed = 0;
    let at = |k: usize| {
        let tilt = begin + (end - begin) * k as f64 / (ROWS - 1) as f64;
        while passed + 2 < rows.len() && rows[passed + 1].tilt_rad < tilt {
            passed += 1;
        }
        let (a, b) = (&rows[passed], &rows[(passed + 1).min(rows.len() - 1)]);
        let rise = b.tilt_rad - a.tilt_rad;
        let share = if rise > 0.0 { ((tilt - a.tilt_rad) / rise).clamp(0.0, 1.0) } else { 0.0 };
        (a.lip_x_m + share * (b.lip_x_m - a.lip_x_m), a.lip_z_m + share * (b.lip_z_m - a.lip_z_m), tilt)
    };
    (0..ROWS).map(at).collect()
}

/// Takes the virtual movement out, Eq. (25) with k1 = I and k2 = 1: x^t = x^Tf − x^o.
fn own_way(config: &PourLearning, shown: &PourDemonstration, tilt: &[(f64, f64, f64)]) -> Result<Dmp, PourError> {
    let end_rad = tilt.last().map_or(0.0, |row| row.2);
    let stand = shown.cup.poses().first().map_or(0.0, |pose| pose.translation.vector.z);
    let floor_m = stand - shown.mouth.center_world.z;
    let x = |row: usize| tilt.get(row).or(tilt.last()).map_or(0.0, |row| row.0);
    let rise = virtual_rise(&shown.source, &shown.mouth, end_rad, [config.margin_m, floor_m], &x)?;
    let part = |row: usize| row as f64 / (ROWS - 1) as f64;
    let samples = DMatrix::from_fn(tilt.len(), 2, |row, k| match (tilt.get(row), k) {
        (Some((x, _, _)), 0) => x / shown.mouth.radius_m,
        (Some((_, z, _)), _) => z - rise.at(part(row), 0).lower.position,
        (None, _) => f64::NAN,
    });
    let trajectory = Trajectory::new((0..tilt.len()).map(part).collect(), samples)?;
    Ok(Dmp::learn(&config.tilt, &[trajectory])?)
}
