//! A reference that is steered by the object that is seen.

use nalgebra::{Isometry2, Unit, Vector2};
use skills::outline::Outline;
use skills::plan::{Action, ActionKind, Plan, PlanarMotion, Push};
use skills::pushing::{HoldRenewalConfig, Steering, SteeringConfig};
use skills::tool::Tool;
use skills::transfer::Reach;

use super::renewal::{Hold, Renewals};
use super::settling::Settling;
use super::{ReferenceSource, ToolReference};
use crate::planar::config::{ObjectConfig, WorldConfig};
use crate::planar::tracker::Tracker;
use crate::sensing::{CameraConfig, Sighting};

/// Steers each push by the object that the camera sees, and goes from hold to hold where the object really is.
///
/// Rules. While pushing, the tool's velocity comes from the steering law, fed by a tracker that bridges the camera's
/// latency with the tool's own measured motion; the push ends when the object has come as far along its line as planned,
/// or when it has taken [`ClosedLoopConfig::patience`] times the planned time. Where steering can do no more, the hold is
/// renewed at another place of the surface: see [`HoldRenewalConfig`]. Between pushes the planned way is bent to
/// where the object rests, so that the next hold is taken where it is; every push aims at its planned end.
#[derive(Clone, Debug)]
pub struct ClosedLoop<'a> {
    plan: &'a Plan,
    tool: &'a Tool,
    config: ClosedLoopConfig,
    period_s: f64,
    tracker: Tracker,
    friction_length_m: f64,
    object_radius_m: f64,
    phase: usize,
    begun_s: f64,
    /// Where the tool should be now.
    now: PlanarMotion,
    /// What the current way of the tool must be shifted by at its start, fading to its end.
    start_shift: Vector2<f64>,
    /// What it is shifted by because the object rests elsewhere than planned.
    object_shift: Settling,
    steering: Option<(Push, Steering, Unit<Vector2<f64>>)>,
    renewals: Renewals,
    /// Whether the object rolls on the tool, as steering and renewals take for granted.
    rolls: bool,
    /// Time of the plan's action at which the object should be where it is.
    plan_clock_s: f64,
    /// Whether the current push has come to its end and the tool is stopping.
    is_over: bool,
    /// Whether that was for want of time.
    gives_up: bool,
    finished: bool,
}

/// Settings of [`ClosedLoop`].
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedLoopConfig {
    /// The steering law.
    pub steering: SteeringConfig,
    /// Time constant with which the reference takes up a commanded velocity, s.
    pub response_s: f64,
    /// A push may last this many times its planned duration, renewals not counted.
    pub patience: f64,
    /// When and how a hold is renewed during a push.
    pub hold_renewal: HoldRenewalConfig,
}

/// Slowest speed of a push before it ends, as a share of its mean: what starts and ends at rest must still get there.
const SLOWEST_SHARE: f64 = 0.25;
/// A push ends this far before its line's end, m: what the object still moves while the tool stops.
const STOP_EARLY_M: f64 = 0.0002;

impl<'a> ClosedLoop<'a> {
    /// Prepares to carry out `plan` with `tool` on `object`, one reference every `period_s`.
    #[must_use]
    pub fn new(
        plan: &'a Plan,
        tool: &'a Tool,
        object: &ObjectConfig,
        camera: &CameraConfig,
        config: ClosedLoopConfig,
        period_s: f64,
    ) -> Self {
        let first = plan.actions().first();
        let start = first.map(|action| action.tool.start()).unwrap_or_default();
        let expected = first.map(|action| action.object.start()).unwrap_or_default();
        let friction_length_m = object.shape.mean_radius_m();
        let object_radius_m = object.shape.inscribed_radius_m();
        Self {
            tracker: Tracker::new(tool, object_radius_m, friction_length_m, expected.point(), camera, period_s),
            renewals: Renewals::none(config.hold_renewal.clone()),
            rolls: matches!(object.shape, Outline::Disc { .. }),
            plan,
            tool,
            config,
            period_s,
            friction_length_m,
            object_radius_m,
            phase: 0,
            begun_s: 0.0,
            now: start,
            start_shift: Vector2::zeros(),
            object_shift: Settling::default(),
            steering: None,
            plan_clock_s: 0.0,
            is_over: false,
            gives_up: false,
            finished: false,
        }
    }

    /// Lets holds be renewed where obstacles and reach leave the tool room beside its planned pushes.
    ///
    /// Without it none is: a tool that knows nothing of its surroundings keeps to its way. What does not roll gains nothing.
    #[must_use]
    pub fn renewing_holds(mut self, world: &WorldConfig, reach: &dyn Reach) -> Self {
        if self.rolls && self.config.hold_renewal.most_per_push > 0 {
            self.renewals.look_around(self.plan, self.tool, world, reach);
        }
        self
    }

    fn begin(&mut self, phase: usize, time_s: f64) {
        let Some(action) = self.plan.actions().get(phase) else {
            self.finished = true;
            return;
        };
        self.phase = phase;
        self.begun_s = time_s;
        self.plan_clock_s = 0.0;
        self.start_shift = self.now.position.xy() - action.tool.start().position.xy();
        self.object_shift = Settling::at(self.shift_for(action));
        self.is_over = false;
        self.gives_up = false;
        self.renewals.begin_push();
        self.steering = match action.kind {
            ActionKind::ObjectOperating(push) => self.steer(push),
            ActionKind::ToolFlipping => None,
        };
    }

    /// How far the object rests from where the plan has it when a way of the tool ends.
    fn shift_for(&self, action: &Action) -> Vector2<f64> {
        match action.kind {
            // only ways that lead to a hold follow the object
            ActionKind::ToolFlipping if self.is_followed_by_push(action) => {
                self.tracker.object_world() - action.object.end().point()
            }
            _ => Vector2::zeros(),
        }
    }

    fn is_followed_by_push(&self, action: &Action) -> bool {
        let next = self.plan.actions().iter().skip_while(|other| !std::ptr::eq(*other, action)).nth(1);
        matches!(next.map(|next| next.kind), Some(ActionKind::ObjectOperating(_)))
    }

    fn steer(&self, push: Push) -> Option<(Push, Steering, Unit<Vector2<f64>>)> {
        let surface = self.tool.surfaces.get(push.surface)?;
        let direction = Unit::new_normalize(push.direction_world()?);
        let steering = Steering::new(
            &self.config.steering,
            push.to_world,
            direction,
            surface.curvature_radius_m(),
            surface.length_m() / 2.0,
            self.object_radius_m,
            self.friction_length_m,
        );
        Some((push, steering.held_at(push.place_m), direction))
    }

    /// The planned way of the tool, bent from where the tool is to where the object is.
    fn way(&mut self, action: &Action, local_s: f64) -> PlanarMotion {
        // what the camera shows on the way improves where it ends
        let wanted = self.shift_for(action);
        self.object_shift.follow(&wanted, RETARGET_S, self.period_s);
        let shift = self.object_shift;
        let duration = action.tool.duration_s();
        let r = (local_s / duration).clamp(0.0, 1.0);
        let (blend, rate, bend) = (
            skills::time_law::minimum_jerk(r),
            skills::time_law::minimum_jerk_first_derivative(r) / duration,
            skills::time_law::minimum_jerk_second_derivative(r) / (duration * duration),
        );
        let change = shift.place - self.start_shift;
        let mut motion = action.tool.at(local_s);
        motion.position += (self.start_shift + change * blend).push(0.0);
        motion.velocity += (change * rate + shift.rate * blend).push(0.0);
        motion.acceleration += (change * bend + shift.rate * (2.0 * rate) + shift.pull * blend).push(0.0);
        motion
    }

    /// One period of a steered push; true when it has come to its end.
    fn push(&mut self, action: &Action, local_s: f64, pose: &Isometry2<f64>) -> bool {
        let Some((push, steering, direction)) = &self.steering else { return true };
        let Some(surface) = self.tool.surfaces.get(push.surface) else { return true };
        let contact = surface.contact_at(push.place_m);
        let normal = pose.rotation * contact.normal;
        let object = self.tracker.object_world();
        if let Some(motion) = self.renewals.advance(&object, self.period_s) {
            self.now = motion;
            return false;
        }
        let left_m = (push.to_world - object).dot(direction) - STOP_EARLY_M;
        let planned = action.tool.duration_s().max(self.period_s);
        // the plan's own time law, read where the object is along its line
        let progress = |clock_s: f64| (action.object.at(clock_s).point() - push.from_world).dot(direction);
        let reached = (object - push.from_world).dot(direction);
        while self.plan_clock_s < planned && progress(self.plan_clock_s) < reached {
            self.plan_clock_s += self.period_s;
        }
        let usual = (push.to_world - push.from_world).norm() / planned;
        let planned_speed = action.object.at(self.plan_clock_s).velocity.xy().dot(direction);
        let speed = planned_speed.max(usual * SLOWEST_SHARE);
        let command = steering.command(&(pose * contact.point), &normal, &object, speed);
        // a late frame does not begin a finished push anew
        self.gives_up |= local_s - self.renewals.spent_s() > planned * self.config.patience;
        self.is_over |= left_m <= 0.0 || self.gives_up;
        let wanted = steering.renewed_offset_m(self.renewals.config(), command.offset_m, command.deviation_m);
        let hold = Hold {
            action: self.phase,
            direction: *direction,
            normal,
            arm: pose.rotation * contact.point.coords,
            planned_world: action.tool.start().point(),
            object_radius_m: self.object_radius_m,
            speed_m_per_s: usual,
        };
        self.approach_velocity(if self.is_over { Vector2::zeros() } else { command.velocity_world }, action, local_s);
        let wanted = wanted.filter(|_| !self.is_over);
        self.renewals.hear(wanted, left_m, &hold, &self.now, &object, self.period_s);
        // the tool is at rest before the next action begins
        self.is_over && self.now.velocity.norm() < REST_M_PER_S
    }

    /// Moves the reference on by one period towards a commanded velocity.
    fn approach_velocity(&mut self, velocity: Vector2<f64>, action: &Action, local_s: f64) {
        let acceleration = (velocity - self.now.velocity.xy()) / self.config.response_s;
        let angle = action.tool.at(local_s);
        let next = self.now.velocity.xy() + acceleration * self.period_s;
        let place = self.now.position.xy() + (self.now.velocity.xy() + next) * (0.5 * self.period_s);
        self.now = PlanarMotion {
            position: place.push(angle.position.z),
            velocity: next.push(angle.velocity.z),
            acceleration: acceleration.push(angle.acceleration.z),
        };
    }
}

/// Time constant with which the end of a way follows what the camera shows, s.
const RETARGET_S: f64 = 0.15;
/// Speed below which the tool counts as resting, m/s.
const REST_M_PER_S: f64 = 0.0005;

impl ReferenceSource for ClosedLoop<'_> {
    fn next(&mut self, time_s: f64, world_from_tool: &Isometry2<f64>, sighting: Option<&Sighting>) -> ToolReference {
        if time_s <= 0.0 {
            self.begin(0, time_s);
        }
        self.tracker.advance(time_s, world_from_tool, sighting);
        let local_s = time_s - self.begun_s;
        let plan = self.plan;
        if let Some(action) = plan.actions().get(self.phase).filter(|_| !self.finished) {
            let over = match action.kind {
                ActionKind::ToolFlipping => {
                    self.now = self.way(action, local_s);
                    local_s >= action.tool.duration_s()
                }
                ActionKind::ObjectOperating(_) => self.push(action, local_s, world_from_tool),
            };
            if over {
                self.begin(self.phase + 1, time_s);
            }
        }
        let due_s = if self.steering.is_some() { self.plan_clock_s } else { time_s - self.begun_s };
        let expected = plan.actions().get(self.phase).map(|action| action.object.at(due_s)).unwrap_or_default();
        if self.finished {
            self.now = PlanarMotion::at_rest(self.now.position);
        }
        ToolReference {
            tool: self.now,
            world_from_object_expected: expected.pose(),
            object_believed_world: Some(self.tracker.object_world()),
            phase: self.phase,
            is_pushing: self.steering.is_some() && !self.renewals.is_under_way(),
            renews_hold: self.renewals.is_under_way(),
            gives_up: self.gives_up,
            finished: self.finished,
        }
    }
}
