//! A synthetic human who shows a cut: minimum-jerk segments with pauses, followed by a noisy hand.

use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::demonstration::CutDemonstration;
use super::in_plane::{InPlane, track};
use super::planning::{pose, straight};
use super::refusal::CutError;
use super::section::{Blade, Section};
use crate::field::{FieldError, positive, within};
use crate::spatial::{
    ActionPhase, FreeMoveConfig, Hand, HandConfig, SpatialAction, SpatialKnot, SpatialMotion, SpatialPlan,
    SpatialTrack, free_move,
};

/// How a human cuts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CutHuman {
    /// The hand that holds the knife.
    pub hand: HandConfig,
    /// Draw along the edge over depth.
    #[schemars(range(min = -5.0, max = 5.0))]
    pub slice_push_ratio: f64,
    /// Angle by which the edge is inclined at the begin of the stroke, rad; level at its end.
    #[schemars(range(min = -0.6, max = 0.6))]
    pub rock_rad: f64,
    /// Mean speed of the stroke into the food, m/s.
    #[schemars(range(min = 0.002, max = 0.2))]
    pub speed_m_per_s: f64,
    /// Height above the food at which the stroke begins, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub lead_m: f64,
    /// Height above the food from which the knife comes and to which it goes, m.
    #[schemars(range(max = 0.5))]
    pub lift_m: f64,
}

impl Default for CutHuman {
    fn default() -> Self {
        Self {
            hand: HandConfig::default(),
            slice_push_ratio: 0.6,
            rock_rad: 0.0,
            speed_m_per_s: 0.02,
            lead_m: 0.005,
            lift_m: 0.05,
        }
    }
}

/// Peak over mean speed of minimum jerk.
const PEAK: f64 = 1.875;

impl CutHuman {
    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.hand.validate().map_err(|error| error.within("hand"))?;
        within("slice_push_ratio", self.slice_push_ratio, -5.0, 5.0)?;
        within("rock_rad", self.rock_rad, -0.6, 0.6)?;
        within("speed_m_per_s", self.speed_m_per_s, 0.002, 0.2)?;
        positive("lead_m", self.lead_m)?;
        within("lift_m", self.lift_m, 2.0 * self.lead_m, 0.5)
    }

    /// Shows one cut of a section: down to the food, a pause, the stroke, a pause at the board, up.
    ///
    /// # Errors
    /// A [`CutError`] if a number, the section or the blade is invalid.
    pub fn demonstrate(
        &self,
        section: &Section,
        blade: &Blade,
        random: ChaCha8Rng,
    ) -> Result<CutDemonstration, CutError> {
        self.validate()?;
        section.validate().map_err(|error| error.within("section"))?;
        blade.validate().map_err(|error| error.within("blade"))?;
        let mut hand = Hand::new(self.hand.clone(), random)?;
        let travel_m = self.lead_m + section.height_m;
        let half_m = 0.5 * self.slice_push_ratio * travel_m;
        let begin = InPlane::at_rest(-half_m, -self.lead_m, self.rock_rad);
        let end = InPlane::at_rest(half_m, section.height_m, 0.0);
        let stroke_s = hand.factor() * travel_m / self.speed_m_per_s;
        let down = FreeMoveConfig {
            speed_m_per_s: PEAK * self.lift_m / (0.8 * hand.factor()),
            least_duration_s: 0.5,
            ..FreeMoveConfig::default()
        };
        let at = |state: &InPlane| pose(section, state.draw.position, state.depth.position, state.rock.position);
        let [above, out] =
            [(-half_m, self.rock_rad), (half_m, 0.0)].map(|(x, rock)| pose(section, x, -self.lift_m, rock));
        let action = SpatialAction::new;
        let plan = SpatialPlan::new(vec![
            action("come", ActionPhase::Approach, free_move(&down, &[above, at(&begin)])?),
            action("pause", ActionPhase::Hold, rest(at(&begin), hand.pause_s())?),
            action("cut", ActionPhase::Cut, track(section, &straight(begin, end, stroke_s))?),
            action("pause", ActionPhase::Hold, rest(at(&end), hand.pause_s())?),
            action("go", ActionPhase::Withdraw, free_move(&down, &[at(&end), out])?),
            action("rest", ActionPhase::Hold, rest(out, hand.pause_s())?),
        ])?;
        Ok(CutDemonstration { knife: hand.follow(&plan)?, section: *section, blade: *blade })
    }
}

fn rest(pose: nalgebra::Isometry3<f64>, duration_s: f64) -> Result<SpatialTrack, CutError> {
    let knots = [0.0, duration_s].map(|time_s| SpatialKnot { time_s, motion: SpatialMotion::at_rest(pose) });
    Ok(SpatialTrack::new(knots.to_vec())?)
}
