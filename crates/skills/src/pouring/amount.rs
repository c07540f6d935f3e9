//! How a cup is tilted so that a wanted amount has been poured once the last of it has landed.

use serde::{Deserialize, Serialize};

use crate::field::{FieldError, not_negative, positive, within};

/// How a wanted amount is approached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct AmountOptions {
    /// Time of fall from the lip to what is weighed, s.
    #[schemars(range(min = 0.0))]
    pub fall_s: f64,
    /// Time for which the flow goes on once the cup begins to tilt back, at its full rate, s.
    #[schemars(range(min = 0.0))]
    pub stop_s: f64,
    /// Time over which the flow is smoothed, s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub smoothing_s: f64,
    /// Mass that is left to be dribbled when the quick pour ends, kg.
    #[schemars(range(min = 0.0))]
    pub dribble_kg: f64,
    /// Rate of tilt while it is dribbled, rad/s.
    #[schemars(range(min = 1e-3, max = 1.0))]
    pub dribble_rate_rad_per_s: f64,
    /// Angle by which the cup is tilted back to stop a flow, rad.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub retreat_rad: f64,
    /// Time without landing after which a flow has stopped, s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub quiet_s: f64,
    /// Lack at which it is left, kg.
    #[schemars(range(min = 0.0))]
    pub tolerance_kg: f64,
    /// Time after which it is left at what was poured, s.
    #[schemars(range(min = 1.0, max = 600.0))]
    pub longest_s: f64,
}

impl Default for AmountOptions {
    fn default() -> Self {
        Self {
            fall_s: 0.12,
            stop_s: 0.2,
            smoothing_s: 0.15,
            dribble_kg: 0.02,
            dribble_rate_rad_per_s: 0.03,
            retreat_rad: 0.12,
            quiet_s: 0.3,
            tolerance_kg: 0.001,
            longest_s: 40.0,
        }
    }
}

impl AmountOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        not_negative("fall_s", self.fall_s)?;
        not_negative("stop_s", self.stop_s)?;
        positive("smoothing_s", self.smoothing_s)?;
        not_negative("dribble_kg", self.dribble_kg)?;
        within("dribble_rate_rad_per_s", self.dribble_rate_rad_per_s, 1e-3, 1.0)?;
        within("retreat_rad", self.retreat_rad, 0.0, 1.0)?;
        positive("quiet_s", self.quiet_s)?;
        not_negative("tolerance_kg", self.tolerance_kg)?;
        within("longest_s", self.longest_s, 1.0, 600.0)
    }
}

/// What to do with the tilt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TiltCommand {
    /// Tilt at this rate, rad/s; back if negative.
    Rate(f64),
    /// Tilt back to upright: done.
    Back,
}

/// What the law is at.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    /// Pours quickly.
    Bulk,
    /// Tilts back to this angle, rad, to stop a flow.
    Retreat(f64),
    /// Waits until nothing lands.
    Wait,
    /// Tilts on slowly, and not while anything lands.
    Dribble,
    Done,
}

/// Online law of the amount poured: a quick pour that ends before the amount is reached, then a dribble.
///
/// A flow is cut as soon as what has landed and what is still to land reach its goal: that of the quick pour lacks
/// `dribble_kg` of the amount. To land is flow × (fall + stop), what is in the air and what leaves until the cup has tilted back; the
/// flow is the rate of the landed mass, smoothed. When nothing lands any more, the lack decides: within the tolerance the cup
/// goes back, else it tilts on slowly, and rests while anything lands: beans leave in slides, and tilting on adds to them.
#[derive(Debug, Clone, PartialEq)]
pub struct AmountControl {
    options: AmountOptions,
    target_kg: f64,
    bulk_rate_rad_per_s: f64,
    stage: Stage,
    time_s: f64,
    landed_kg: f64,
    flow_kg_per_s: f64,
    still_s: f64,
    /// Tilt at which anything landed last, rad.
    flowed_at_rad: f64,
}

impl AmountControl {
    /// Asks for `target_kg`, poured quickly at `bulk_rate_rad_per_s` at first.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn new(target_kg: f64, bulk_rate_rad_per_s: f64, options: AmountOptions) -> Result<Self, FieldError> {
        positive("target_kg", target_kg)?;
        positive("bulk_rate_rad_per_s", bulk_rate_rad_per_s)?;
        options.validate()?;
        Ok(Self {
            options,
            target_kg,
            bulk_rate_rad_per_s,
            stage: Stage::Bulk,
            time_s: 0.0,
            landed_kg: 0.0,
            flow_kg_per_s: 0.0,
            still_s: 0.0,
            flowed_at_rad: f64::INFINITY,
        })
    }

    /// Takes the mass that has landed, kg, after a further `time_step_s` (> 0), the tilt, rad, and whether it is at its
    /// greatest. Allocates nothing; numbers that are not finite are passed over. Once given, [`TiltCommand::Back`] stays.
    pub fn step(&mut self, time_step_s: f64, landed_kg: f64, tilt_rad: f64, at_end: bool) -> TiltCommand {
        let usable = landed_kg.is_finite() && tilt_rad.is_finite() && time_step_s.is_finite() && time_step_s > 0.0;
        if usable {
            self.weigh(time_step_s, landed_kg, tilt_rad);
            self.decide(tilt_rad, at_end);
        }
        self.command(tilt_rad)
    }

    fn weigh(&mut self, time_step_s: f64, landed_kg: f64, tilt_rad: f64) {
        let change = landed_kg - self.landed_kg;
        self.time_s += time_step_s;
        self.landed_kg = landed_kg;
        let smoothing = 1.0 - (-time_step_s / self.options.smoothing_s).exp();
        self.flow_kg_per_s += (change / time_step_s - self.flow_kg_per_s) * smoothing;
        if change == 0.0 {
            self.still_s += time_step_s;
        } else {
            (self.still_s, self.flowed_at_rad) = (0.0, tilt_rad);
        }
    }

    fn decide(&mut self, tilt_rad: f64, at_end: bool) {
        let lacks_kg = self.target_kg - self.landed_kg;
        let is_still = self.still_s >= self.options.quiet_s;
        let retreat = Stage::Retreat(tilt_rad - self.options.retreat_rad);
        self.stage = match self.stage {
            Stage::Done => Stage::Done,
            _ if self.time_s > self.options.longest_s => Stage::Done,
            Stage::Bulk if self.expected_kg() >= self.target_kg - self.options.dribble_kg => retreat,
            Stage::Dribble if self.expected_kg() >= self.target_kg => retreat,
            // an empty cup has no more to give
            Stage::Bulk | Stage::Dribble if at_end && is_still => Stage::Done,
            Stage::Retreat(to_rad) if tilt_rad <= to_rad => Stage::Wait,
            Stage::Wait if is_still && lacks_kg <= self.options.tolerance_kg => Stage::Done,
            Stage::Wait if is_still => Stage::Dribble,
            stage => stage,
        };
    }

    fn command(&self, tilt_rad: f64) -> TiltCommand {
        let dribble = self.options.dribble_rate_rad_per_s;
        TiltCommand::Rate(match self.stage {
            Stage::Bulk => self.bulk_rate_rad_per_s,
            Stage::Retreat(_) => -RETREAT_RAD_PER_S,
            Stage::Wait => 0.0,
            // quickly up to half of the way that it was tilted back by, where nothing can flow yet
            Stage::Dribble if tilt_rad < self.flowed_at_rad - 0.5 * self.options.retreat_rad => {
                dribble.max(0.5 * self.bulk_rate_rad_per_s)
            }
            Stage::Dribble if self.still_s >= self.options.quiet_s => dribble,
            Stage::Dribble => 0.0,
            Stage::Done => return TiltCommand::Back,
        })
    }

    /// Mass still to land if the flow were cut now, kg.
    #[must_use]
    pub fn in_flight_kg(&self) -> f64 {
        self.flow_kg_per_s.max(0.0) * (self.options.fall_s + self.options.stop_s)
    }

    /// Mass that will have landed if the flow is cut now, kg.
    #[must_use]
    pub fn expected_kg(&self) -> f64 {
        self.landed_kg + self.in_flight_kg()
    }
}

/// Rate at which a flow is cut, rad/s: as quick as the plan lets it.
const RETREAT_RAD_PER_S: f64 = 10.0;

#[cfg(test)]
#[path = "amount_tests.rs"]
mod tests;
