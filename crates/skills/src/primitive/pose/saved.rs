//! The pose primitive as plain data, for files.

use nalgebra::{DMatrix, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::turning::ShownTurn;
use super::{PoseDmp, PoseError, check_form};
use crate::error::SkillError;
use crate::field::{FieldError, finite};
use crate::primitive::{Dmp, DmpConfig};

/// Angle that whole turns may miss the identity by, rad.
const WHOLE_RAD: f64 = 1e-6;

/// Everything a [`PoseDmp`] was learned to; restored, its rollouts are equal bit by bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedPose {
    /// Options it was learned with.
    pub config: DmpConfig,
    /// Weights of x, y, z (m) and the residual rotation vector (rad), n × 6.
    pub weights: DMatrix<f64>,
    /// Greatest speed at which a demonstration ended, over all six coordinates.
    pub end_speed: f64,
    /// Whether a demonstration ended in motion.
    pub fades_before_end: bool,
    /// The way round that was shown.
    pub turn: ShownTurn,
    /// Rotation vector of whole turns at which the residual ends, rad; zero as a rule.
    pub unwound_rad: Vector3<f64>,
}

impl SavedPose {
    /// Checks the data and makes a primitive of them.
    ///
    /// # Errors
    /// If the options are invalid, the weights have another shape, a value is not finite, or what should be whole turns
    /// are none.
    pub fn restore(self) -> Result<PoseDmp, PoseError> {
        check_form(&self.config)?;
        if self.weights.ncols() != 6 {
            let found = self.weights.ncols();
            return Err(SkillError::Dimension { operation: "restore primitive", found, expected: 6 }.into());
        }
        let dmp = Dmp::assemble(&self.config, self.weights, self.end_speed, self.fades_before_end)?;
        let ShownTurn { whole_rad, rest_rad } = self.turn;
        finite("turn.rest_rad", rest_rad.as_slice()).map_err(SkillError::from)?;
        for (field, turns) in [("turn.whole_rad", whole_rad), ("unwound_rad", self.unwound_rad)] {
            finite(field, turns.as_slice()).map_err(SkillError::from)?;
            let angle = UnitQuaternion::from_scaled_axis(turns).angle();
            if angle > WHOLE_RAD {
                let error = FieldError::new(field, format!("{angle} rad beside whole turns"), "whole turns");
                return Err(SkillError::from(error).into());
            }
        }
        Ok(PoseDmp { config: self.config, dmp, turn: self.turn, unwound_rad: self.unwound_rad })
    }
}

impl PoseDmp {
    /// Returns everything that was learned, as plain data.
    #[must_use]
    pub fn saved(&self) -> SavedPose {
        SavedPose {
            config: self.config.clone(),
            weights: self.dmp.weights().clone(),
            end_speed: self.dmp.end_speed(),
            fades_before_end: self.dmp.fades_before_end(),
            turn: self.turn,
            unwound_rad: self.unwound_rad,
        }
    }
}
