//! Where the cup should be: the plan, the weight that the arm is told of, and the stop once enough is poured.

use nalgebra::{Isometry3, Vector6};
use sim::pouring::PourGauge;
use sim::spatial::{ReferenceSource, SpatialReference};
use skills::field::FieldError;
use skills::pouring::{AmountStop, PourCommand, PourPlan};
use skills::spatial::{ActionPhase, SpatialMotion, SpatialTrack};

use super::config::AmountConfig;

/// Follows the plan of a pour, and leaves it to tilt back when the wanted amount is poured.
pub(super) struct PourSource<'a> {
    plan: &'a PourPlan,
    gauge: PourGauge,
    feed_forward: bool,
    period_s: f64,
    stop: Option<AmountStop>,
    tilting_back: Option<TiltingBack>,
    /// Action that tilts back, and when it begins and ends, s of the plan.
    back: (usize, f64),
}

/// The way back from where the flow was stopped.
struct TiltingBack {
    since_s: f64,
    track: SpatialTrack,
}

impl<'a> PourSource<'a> {
    /// Follows `plan`; `gauge` tells what is poured and what is in the cup.
    pub(super) fn new(
        plan: &'a PourPlan,
        gauge: PourGauge,
        feed_forward: bool,
        amount: Option<&AmountConfig>,
        period_s: f64,
    ) -> Result<Self, FieldError> {
        let stop =
            |amount: &AmountConfig| AmountStop::new(amount.wanted_kg, amount.fall_s, amount.stop_s, amount.smoothing_s);
        let actions = plan.plan.actions();
        let back = actions.iter().position(|action| action.phase == ActionPhase::Return).unwrap_or(actions.len());
        let ends_s = plan.plan.starts_s().get(back + 1).copied().unwrap_or(plan.plan.duration_s());
        let stop = amount.map(stop).transpose()?;
        Ok(Self { plan, gauge, feed_forward, period_s, stop, tilting_back: None, back: (back, ends_s) })
    }

    /// Asks the rule whether to stop, once per control period, while the cup may flow.
    fn decide(&mut self, time_s: f64) {
        let Some(stop) = self.stop.as_mut().filter(|_| self.tilting_back.is_none()) else { return };
        if stop.step(self.period_s, self.gauge.read().collected_kg) == PourCommand::Pour {
            return;
        }
        // before the tilt and once it has ended, the plan does by itself what is right
        if let Ok(Some(track)) = self.plan.tilt_back(time_s) {
            self.tilting_back = Some(TiltingBack { since_s: time_s, track });
        }
    }

    /// Action, motion, and whether the plan is at its end.
    fn due(&self, time_s: f64) -> (usize, SpatialMotion, bool) {
        let plan = &self.plan.plan;
        let on_plan = |time_s: f64| (plan.due_at(time_s).0, plan.at(time_s), time_s >= plan.duration_s());
        let Some(back) = &self.tilting_back else { return on_plan(time_s) };
        let (since_s, lasts_s) = (time_s - back.since_s, back.track.duration_s());
        if since_s <= lasts_s {
            return (self.back.0, back.track.at(since_s), false);
        }
        on_plan(self.back.1 + since_s - lasts_s)
    }
}

impl ReferenceSource for PourSource<'_> {
    fn next(&mut self, time_s: f64, _world_from_tool: &Isometry3<f64>) -> SpatialReference {
        self.decide(time_s);
        let (phase, motion, finished) = self.due(time_s);
        let weight = if self.feed_forward { self.gauge.read().weight_wrench } else { Vector6::zeros() };
        SpatialReference {
            world_from_tool: motion.pose,
            velocity: motion.velocity,
            acceleration: motion.acceleration,
            expected_wrench: weight,
            phase,
            finished,
        }
    }
}
