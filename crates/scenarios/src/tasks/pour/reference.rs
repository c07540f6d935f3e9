//! Where the cup should be: the plan, the weight that the arm is told of, and the steered tilt when an amount is wanted.

use nalgebra::{Isometry3, Vector6};
use sim::pouring::PourGauge;
use sim::spatial::{ReferenceSource, SpatialReference};
use skills::field::FieldError;
use skills::pouring::{AmountControl, PourPlan, TiltCommand, TiltSteering};
use skills::spatial::{ActionPhase, SpatialMotion, SpatialTrack};

use super::config::PourConfig;

/// Follows the plan of a pour; with an amount wanted, steers the tilt from where the flow may begin until it is poured.
pub(super) struct PourSource<'a> {
    plan: &'a PourPlan,
    gauge: PourGauge,
    feed_forward: bool,
    period_s: f64,
    amount: Option<Steered<'a>>,
    /// Action that pours, action that tilts back, and when the latter ends, s of the plan.
    pours: usize,
    tilts_back: (usize, f64),
}

/// A tilt that depends on what has landed.
struct Steered<'a> {
    from_s: f64,
    control: AmountControl,
    steering: TiltSteering<'a>,
    back: Option<TiltingBack>,
}

/// The way back from where the pour was ended.
struct TiltingBack {
    since_s: f64,
    track: SpatialTrack,
}

/// Within this of its greatest tilt a cup is tilted as far as it goes, rad.
const AT_END_RAD: f64 = 0.01;

impl<'a> PourSource<'a> {
    /// Follows `plan`; `gauge` tells what is poured and what is in the cup.
    pub(super) fn new(
        plan: &'a PourPlan,
        gauge: PourGauge,
        config: &PourConfig,
        period_s: f64,
    ) -> Result<Self, FieldError> {
        let actions = plan.plan.actions();
        let at = |phase: ActionPhase| actions.iter().position(|action| action.phase == phase).unwrap_or(actions.len());
        let back = at(ActionPhase::Return);
        let ends_s = plan.plan.starts_s().get(back + 1).copied().unwrap_or(plan.plan.duration_s());
        let amount = match (&config.amount, plan.steered()) {
            (Some(amount), Some((from_s, steering))) => {
                let rate = config.options.pour_rate_rad_per_s;
                let control = AmountControl::new(amount.wanted_kg, rate, amount.approach.clone())?;
                Some(Steered { from_s, control, steering, back: None })
            }
            _ => None,
        };
        let (pours, tilts_back) = (at(ActionPhase::Pour), (back, ends_s));
        Ok(Self { plan, gauge, feed_forward: config.feed_forward, period_s, amount, pours, tilts_back })
    }

    /// Action, motion, and whether all is done.
    fn due(&mut self, time_s: f64) -> (usize, SpatialMotion, bool) {
        let plan = &self.plan.plan;
        let on_plan = |time_s: f64| (plan.due_at(time_s).0, plan.at(time_s), time_s >= plan.duration_s());
        let Some(steered) = self.amount.as_mut().filter(|steered| time_s >= steered.from_s) else {
            return on_plan(time_s);
        };
        if steered.back.is_none() {
            steered.advance(time_s, self.period_s, self.gauge.read().collected_kg);
        }
        let Some(back) = &steered.back else { return (self.pours, steered.steering.motion(), false) };
        let (since_s, lasts_s) = (time_s - back.since_s, back.track.duration_s());
        if since_s <= lasts_s {
            return (self.tilts_back.0, back.track.at(since_s), false);
        }
        on_plan(self.tilts_back.1 + since_s - lasts_s)
    }
}

impl Steered<'_> {
    /// Asks the law once per control period, and does what it says.
    fn advance(&mut self, time_s: f64, period_s: f64, landed_kg: f64) {
        let tilt_rad = self.steering.tilt_rad();
        let at_end = tilt_rad >= self.steering.end_rad() - AT_END_RAD;
        match self.control.step(period_s, landed_kg, tilt_rad, at_end) {
            TiltCommand::Rate(rate) => self.steering.step(period_s, rate),
            TiltCommand::Back => {
                // a state that is not finite has no way back: the run ends with an error of its own
                self.back = self.steering.back().ok().map(|track| TiltingBack { since_s: time_s, track });
            }
        }
    }
}

impl ReferenceSource for PourSource<'_> {
    fn next(&mut self, time_s: f64, _world_from_tool: &Isometry3<f64>) -> SpatialReference {
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
