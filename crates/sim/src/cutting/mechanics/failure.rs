//! How a cut fails, with the thresholds that tell.

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, positive, within};

use super::process::{Cut, Stage};

/// A way in which a cut fails; its text says what was found and what to change.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// The knife stands in the food though it is driven on.
    #[error(
        "cut: the knife stalled {depth_m:.4} m deep for {duration_s:.2} s; allow it more force, or slice instead of pushing"
    )]
    Stalled {
        /// Depth of the cut, m.
        depth_m: f64,
        /// How long it stood, s.
        duration_s: f64,
    },
    /// The stroke ended before the food came apart.
    #[error("cut: {:.1} % of the section is uncut at the end of the stroke; drive the edge down to the board", 100.0 * ligament_share)]
    NotThrough {
        /// Uncut share of the section.
        ligament_share: f64,
    },
    /// The food slid on the board.
    #[error("cut: the food slid {distance_m:.4} m on the board; hold it, or push more and slice less")]
    Slipped {
        /// Distance, m.
        distance_m: f64,
    },
    /// The food turned on the board.
    #[error("cut: the food rolled by {angle_rad:.3} rad; cut nearer to its axis, or hold it")]
    Rolled {
        /// Angle, rad.
        angle_rad: f64,
    },
    /// The food was squeezed and not cut.
    #[error("cut: the food was squeezed by {:.0} % of its height before the edge entered; use a sharper knife, or slice", 100.0 * indentation_share)]
    Crushed {
        /// Depth of the dent as a share of the section's height.
        indentation_share: f64,
    },
    /// A brittle food broke into more pieces than were wanted.
    #[error("cut: the food broke into {pieces} pieces; cut it slowly with a serrated knife, or support it evenly")]
    Shattered {
        /// Number of pieces.
        pieces: usize,
    },
    /// The stroke did not touch the food.
    #[error("cut: the edge never touched the food; check the place of the cut")]
    Missed,
    /// The knife hit the board.
    #[error("cut: the knife struck the board with {force_n:.1} N; slow down before the board")]
    BoardImpact {
        /// Force, N.
        force_n: f64,
    },
}

/// What counts as failure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Thresholds {
    /// Slower than this, a driven knife stands, m/s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stall_speed_m_per_s: f64,
    /// A knife that stands this long is stalled, s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stall_s: f64,
    /// A cut is through when at most this share of the section is uncut.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub ligament_share: f64,
    /// Translation of the food on the board, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub slip_m: f64,
    /// Rotation of the food on the board, rad.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub roll_rad: f64,
    /// Depth of a dent without a cut, as a share of the section's height.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub indentation_share: f64,
    /// Force between knife and board, N.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub board_force_n: f64,
    /// Pieces that a cut of a brittle food makes, at most.
    pub pieces: usize,
}

impl Default for Thresholds {
    fn default() -> Self {
        Self {
            stall_speed_m_per_s: 0.0005,
            stall_s: 0.5,
            ligament_share: super::process::THROUGH_SHARE,
            slip_m: 0.003,
            roll_rad: 15_f64.to_radians(),
            indentation_share: 0.3,
            board_force_n: 20.0,
            pieces: 2,
        }
    }
}

impl Thresholds {
    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("stall_speed_m_per_s", self.stall_speed_m_per_s)?;
        positive("stall_s", self.stall_s)?;
        within("ligament_share", self.ligament_share, 0.0, 1.0)?;
        positive("slip_m", self.slip_m)?;
        positive("roll_rad", self.roll_rad)?;
        within("indentation_share", self.indentation_share, 0.0, 1.0)?;
        positive("board_force_n", self.board_force_n)
    }
}

/// What a scene sees of a cut in one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observation {
    /// Whether the knife is driven into the food.
    pub driven: bool,
    /// Speed of the edge along the cutting direction, m/s.
    pub advance_m_per_s: f64,
    /// Distance of the food from where it lay when it was touched, m.
    pub food_translation_m: f64,
    /// Angle of the food from how it lay when it was touched, rad.
    pub food_rotation_rad: f64,
    /// Force between knife and board, N.
    pub board_force_n: f64,
    /// Pieces that this cut has made of one.
    pub pieces: usize,
}

/// Watches a cut for its first failure.
#[derive(Clone, Debug)]
pub struct FailureMonitor {
    thresholds: Thresholds,
    standing_s: f64,
    failure: Option<Failure>,
}

impl FailureMonitor {
    /// Watches with thresholds.
    ///
    /// # Errors
    /// A [`FieldError`] naming a threshold that cannot be used.
    pub fn new(thresholds: Thresholds) -> Result<Self, FieldError> {
        thresholds.validate()?;
        Ok(Self { thresholds, standing_s: 0.0, failure: None })
    }

    /// Notes one step of length `dt` (s) and returns the first failure so far.
    pub fn observe(&mut self, cut: &Cut, seen: &Observation, dt: f64) -> Option<&Failure> {
        let stands = seen.driven && cut.pressing() && seen.advance_m_per_s < self.thresholds.stall_speed_m_per_s;
        self.standing_s = if stands { self.standing_s + dt } else { 0.0 };
        if self.failure.is_none() {
            self.failure = self.found(cut, seen);
        }
        self.failure.as_ref()
    }

    /// The first failure so far.
    #[must_use]
    pub fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    /// Returns the first failure of a cut whose stroke has ended.
    pub fn finish(&mut self, cut: &Cut) -> Option<&Failure> {
        if self.failure.is_none() {
            self.failure = match cut.stage() {
                Stage::Approaching if !cut.touched() => Some(Failure::Missed),
                Stage::Separated | Stage::Fractured => None,
                _ if cut.ligament_share() <= self.thresholds.ligament_share => None,
                _ => Some(Failure::NotThrough { ligament_share: cut.ligament_share() }),
            };
        }
        self.failure.as_ref()
    }

    fn found(&self, cut: &Cut, seen: &Observation) -> Option<Failure> {
        let limits = &self.thresholds;
        if cut.indentation_share() > limits.indentation_share {
            return Some(Failure::Crushed { indentation_share: cut.indentation_share() });
        }
        if seen.food_translation_m > limits.slip_m {
            return Some(Failure::Slipped { distance_m: seen.food_translation_m });
        }
        if seen.food_rotation_rad.abs() > limits.roll_rad {
            return Some(Failure::Rolled { angle_rad: seen.food_rotation_rad });
        }
        if seen.board_force_n > limits.board_force_n {
            return Some(Failure::BoardImpact { force_n: seen.board_force_n });
        }
        if cut.brittle() && seen.pieces > limits.pieces {
            return Some(Failure::Shattered { pieces: seen.pieces });
        }
        let stalled = self.standing_s > limits.stall_s;
        stalled.then(|| Failure::Stalled { depth_m: cut.depth_m(), duration_s: self.standing_s })
    }
}
