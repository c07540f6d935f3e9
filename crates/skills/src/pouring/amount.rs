//! When to tilt back so that the wanted amount has been poured once the last of it has landed.

use serde::{Deserialize, Serialize};

use crate::field::{FieldError, not_negative, positive};

/// What to do with the cup.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PourCommand {
    /// Go on.
    Pour,
    /// Tilt back, from now on.
    TiltBack,
}

/// Online rule of the amount poured: tilts back as soon as what has landed and what is still to land reach the target.
///
/// To land is flow × (fall + stop): what is in the air, and what leaves the cup until it has tilted back. The flow is the
/// rate of the landed mass, smoothed over `smoothing_s`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AmountStop {
    target_kg: f64,
    fall_s: f64,
    stop_s: f64,
    smoothing_s: f64,
    landed_kg: f64,
    flow_kg_per_s: f64,
    command: PourCommand,
}

impl AmountStop {
    /// Asks for `target_kg`, with a time of fall `fall_s`, a time `stop_s` for which the flow goes on after the command, at
    /// its full rate, and smoothing of the flow over `smoothing_s` (all s).
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn new(target_kg: f64, fall_s: f64, stop_s: f64, smoothing_s: f64) -> Result<Self, FieldError> {
        positive("target_kg", target_kg)?;
        not_negative("fall_s", fall_s)?;
        not_negative("stop_s", stop_s)?;
        positive("smoothing_s", smoothing_s)?;
        let command = PourCommand::Pour;
        Ok(Self { target_kg, fall_s, stop_s, smoothing_s, landed_kg: 0.0, flow_kg_per_s: 0.0, command })
    }

    /// Takes the mass that has landed, kg, after a further `time_step_s` (> 0). Allocates nothing; a number that is not
    /// finite is passed over. Once given, [`PourCommand::TiltBack`] stays.
    pub fn step(&mut self, time_step_s: f64, landed_kg: f64) -> PourCommand {
        if !landed_kg.is_finite() || !time_step_s.is_finite() || time_step_s <= 0.0 {
            return self.command;
        }
        let flow = (landed_kg - self.landed_kg) / time_step_s;
        self.landed_kg = landed_kg;
        self.flow_kg_per_s += (flow - self.flow_kg_per_s) * (1.0 - (-time_step_s / self.smoothing_s).exp());
        if self.expected_kg() >= self.target_kg {
            self.command = PourCommand::TiltBack;
        }
        self.command
    }

    /// Mass still to land if the cup were tilted back now, kg.
    #[must_use]
    pub fn in_flight_kg(&self) -> f64 {
        self.flow_kg_per_s.max(0.0) * (self.fall_s + self.stop_s)
    }

    /// Mass that will have landed if the cup is tilted back now, kg.
    #[must_use]
    pub fn expected_kg(&self) -> f64 {
        self.landed_kg + self.in_flight_kg()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stream of `flow` that lands after `fall_s` and goes on for `stop_s` after the command: the mass in the end, kg.
    fn poured(flow: f64, fall_s: f64, stop_s: f64, rule: &mut AmountStop) -> f64 {
        let step_s = 0.002;
        let (mut stopped, mut landed) = (f64::INFINITY, 0.0);
        for step in 1..20_000 {
            let time_s = f64::from(step) * step_s;
            if time_s > fall_s && time_s - fall_s <= stopped + stop_s {
                landed += flow * step_s;
            }
            if rule.step(step_s, landed) == PourCommand::TiltBack && stopped.is_infinite() {
                stopped = time_s;
            }
        }
        landed
    }

    #[test]
    fn a_steady_stream_ends_at_the_target() {
        for flow in [0.02, 0.05, 0.1] {
            let mut rule = AmountStop::new(0.05, 0.15, 0.3, 0.02).unwrap();
            let landed = poured(flow, 0.15, 0.3, &mut rule);
            // the flow is known late by the smoothing
            assert!((landed - 0.05).abs() < flow * 0.02 + 1e-4, "{flow}: {landed}");
        }
    }

    #[test]
    fn without_the_mass_in_flight_it_is_overshot_by_it() {
        let mut rule = AmountStop::new(0.05, 0.0, 0.0, 0.02).unwrap();
        let over = poured(0.05, 0.15, 0.3, &mut rule) - 0.05;
        assert!((over - 0.05 * 0.45).abs() < 1e-3, "{over}");
    }

    #[test]
    fn the_command_to_tilt_back_stays_and_numbers_that_are_none_are_passed_over() {
        let mut rule = AmountStop::new(0.05, 0.1, 0.1, 0.02).unwrap();
        assert_eq!(rule.step(0.01, f64::NAN), PourCommand::Pour);
        assert_eq!(rule.step(0.01, 0.06), PourCommand::TiltBack);
        assert_eq!(rule.step(0.01, 0.0), PourCommand::TiltBack);
        assert_eq!(AmountStop::new(0.0, 0.1, 0.1, 0.1).unwrap_err().field, "target_kg");
    }
}
