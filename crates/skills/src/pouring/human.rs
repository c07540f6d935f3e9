//! A synthetic human who shows a pour: minimum-jerk segments with pauses, followed by a noisy hand.

use nalgebra::Isometry3;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::container::{Container, Mouth};
use super::demonstration::PourDemonstration;
use super::planning::resting_at;
use super::refusal::PourError;
use super::task::{Fill, PourAim, PourOptions, PourTask};
use super::tilting::{LipTask, transfer};
use crate::field::{FieldError, positive, within};
use crate::spatial::{ActionPhase, FreeMoveConfig, Hand, HandConfig, SpatialAction, SpatialPlan, free_move};
use crate::time_law::PathState;

/// How a human pours.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PourHuman {
    /// The hand that holds the cup.
    pub hand: HandConfig,
    /// What is in the cup.
    pub fill: Fill,
    /// Place of the lip over the mouth while it pours, in radii of the mouth along the direction of pouring.
    #[schemars(range(min = -0.9, max = 0.9))]
    pub over: f64,
    /// Height at which the lip is kept above what the cup clears, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gap_m: f64,
    /// Peak speed of the approach, m/s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub speed_m_per_s: f64,
    /// Height by which the cup is lifted on its way, m.
    #[schemars(range(min = 0.0, max = 0.12))]
    pub lift_m: f64,
    /// Peak rate of the tilt, rad/s.
    #[schemars(range(min = 0.05, max = 5.0))]
    pub tilt_rate_rad_per_s: f64,
}

impl Default for PourHuman {
    fn default() -> Self {
        Self {
            hand: HandConfig { constant_noise_rad_per_s: 0.08, ..HandConfig::default() },
            fill: Fill::default(),
            over: -0.3,
            gap_m: 0.012,
            speed_m_per_s: 0.25,
            lift_m: 0.04,
            tilt_rate_rad_per_s: 0.5,
        }
    }
}

impl PourHuman {
    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.hand.validate().map_err(|error| error.within("hand"))?;
        within("over", self.over, -0.9, 0.9)?;
        positive("gap_m", self.gap_m)?;
        positive("speed_m_per_s", self.speed_m_per_s)?;
        within("lift_m", self.lift_m, 0.0, 0.12)?;
        within("tilt_rate_rad_per_s", self.tilt_rate_rad_per_s, 0.05, 5.0)
    }

    /// Shows one pour: up and over to the mouth, a pause, the tilt, a pause, back.
    ///
    /// `start` is where the cup stands upright, `world_from_cup`.
    ///
    /// # Errors
    /// A [`PourError`] if a number, the cup or the mouth is invalid, or the mouth is too narrow.
    pub fn demonstrate(
        &self,
        source: &Container,
        mouth: &Mouth,
        start: &Isometry3<f64>,
        random: ChaCha8Rng,
    ) -> Result<PourDemonstration, PourError> {
        self.validate()?;
        let options = PourOptions { gap_m: self.gap_m, aim: PourAim::Shown, ..PourOptions::default() };
        let task = PourTask { fill: self.fill, options, ..PourTask::new(*start, *source, *mouth) };
        task.validate()?;
        let mut hand = Hand::new(self.hand.clone(), random)?;
        let path = LipTask::new(&task, self.over)?.plain_way(source, mouth)?;
        let world_from_pour = mouth.world_from_pour(task.direction());
        let at = |part: f64| {
            let part = PathState { position: part, ..PathState::default() };
            path.motion(part).seen_from(&world_from_pour).pose
        };
        let ready = at(0.0);
        let mut middle = start.lerp_slerp(&ready, 0.5);
        middle.translation.vector.z = start.translation.vector.z.max(ready.translation.vector.z) + self.lift_m;
        let come = FreeMoveConfig {
            speed_m_per_s: self.speed_m_per_s / hand.factor(),
            overlap: 0.5,
            ..FreeMoveConfig::default()
        };
        let tilt_s = hand.factor() * path.duration_s(0.0, 1.0, self.tilt_rate_rad_per_s);
        let back_s = 0.6 * tilt_s;
        let action = SpatialAction::new;
        let plan = SpatialPlan::new(vec![
            action("rest", ActionPhase::Hold, resting_at(*start, hand.pause_s())?),
            action("come", ActionPhase::Approach, free_move(&come, &[*start, middle, ready])?),
            action("pause", ActionPhase::Hold, resting_at(ready, hand.pause_s())?),
            action("pour", ActionPhase::Pour, path.track(&world_from_pour, tilt_s, transfer(0.0, 1.0, tilt_s))?),
            action("hold", ActionPhase::Hold, resting_at(at(1.0), hand.pause_s())?),
            action("return", ActionPhase::Return, path.track(&world_from_pour, back_s, transfer(1.0, 0.0, back_s))?),
        ])?;
        Ok(PourDemonstration { cup: hand.follow(&plan)?, source: *source, mouth: *mouth })
    }
}
