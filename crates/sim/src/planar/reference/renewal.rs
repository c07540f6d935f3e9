//! Renewing a hold during a push: off the object, sideways past it, and back to it.
//!
//! Rules, beside those of [`HoldRenewalConfig`]. A hold is renewed only if the call for it lasts, if enough of the push is
//! left, if the push's renewals are not used up, and if world and reach leave the tool room where it wants to go. The tool
//! backs off along the contact's normal, goes sideways and comes back until it should touch, each on a minimum-jerk way,
//! its angle kept; where it goes follows the object as it is believed to be when a way begins. The time that this
//! takes is not counted against the push's patience.

use nalgebra::{Point2, Unit, Vector2};
use skills::plan::{Action, ActionKind, Plan, PlanarMotion};
use skills::pushing::HoldRenewalConfig;
use skills::time_law::{MinimumJerkTransfer, PathState};
use skills::tool::Tool;
use skills::transfer::Reach;

use super::room::Room;
use crate::planar::config::WorldConfig;

/// A call for a renewal that is over sooner is noise, s.
const CALL_S: f64 = 0.1;
/// No way of a renewal is shorter than this, s.
const SHORTEST_S: f64 = 0.2;

/// Renews the holds of one push after the other.
#[derive(Clone, Debug)]
pub(super) struct Renewals {
    config: HoldRenewalConfig,
    /// Room beside each action of the plan; none where nothing is known of the surroundings.
    rooms: Vec<Room>,
    /// Renewals in this push.
    count: usize,
    /// How long this push has called for a renewal, s.
    called_s: f64,
    /// Time that this push has spent with renewals, s.
    spent_s: f64,
    passage: Option<Passage>,
}

/// What a hold is renewed for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hold {
    /// Index of the push in the plan.
    pub action: usize,
    /// Direction of the push, world axes.
    pub direction: Unit<Vector2<f64>>,
    /// Outward normal of the surface where the object should be held, world axes.
    pub normal: Unit<Vector2<f64>>,
    /// That place seen from the tool's origin, world axes, m.
    pub arm: Vector2<f64>,
    /// Where the tool is in the plan, up to a motion along the push.
    pub planned_world: Point2<f64>,
    /// Distance of the object's center from the contact, m.
    pub object_radius_m: f64,
    /// Speed of the push, m/s.
    pub speed_m_per_s: f64,
}

/// A tool on its way from one place of its surface to another.
#[derive(Clone, Debug)]
struct Passage {
    leg: Leg,
    hold: Hold,
    /// Offset at which the object is to be held, m.
    offset_m: f64,
    lift_m: f64,
    angle_rad: f64,
    clock_s: f64,
    duration_s: f64,
    way: [MinimumJerkTransfer; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Leg {
    Off,
    Sideways,
    Back,
}

impl Renewals {
    /// Renews no hold: nothing is known of the surroundings.
    pub(super) fn none(config: HoldRenewalConfig) -> Self {
        Self { config, rooms: Vec::new(), count: 0, called_s: 0.0, spent_s: 0.0, passage: None }
    }

    /// Looks beside each push of a plan for the room that renewals need.
    pub(super) fn look_around(&mut self, plan: &Plan, tool: &Tool, world: &WorldConfig, reach: &dyn Reach) {
        let room = |action| match push_direction(action) {
            Some(direction) => Room::beside(action, &direction, self.config.lift_m, tool, world, reach),
            None => Room::default(),
        };
        self.rooms = plan.actions().iter().map(room).collect();
    }

    /// Forgets the push before.
    pub(super) fn begin_push(&mut self) {
        (self.count, self.called_s, self.spent_s, self.passage) = (0, 0.0, 0.0, None);
    }

    /// The rules in numbers.
    pub(super) fn config(&self) -> &HoldRenewalConfig {
        &self.config
    }

    /// Whether the tool is off the object now.
    pub(super) fn is_under_way(&self) -> bool {
        self.passage.is_some()
    }

    /// Time that this push has spent with renewals, s.
    pub(super) fn spent_s(&self) -> f64 {
        self.spent_s
    }

    /// Hears for one period where the object should be held anew, if it should, and sets out when the rules say so.
    pub(super) fn hear(
        &mut self,
        wanted_offset_m: Option<f64>,
        left_m: f64,
        hold: &Hold,
        now: &PlanarMotion,
        object: &Point2<f64>,
        period_s: f64,
    ) {
        let Some(offset_m) = wanted_offset_m.filter(|_| left_m >= self.config.least_remaining_m) else {
            self.called_s = 0.0;
            return;
        };
        self.called_s += period_s;
        if self.called_s < CALL_S || self.count >= self.config.most_per_push || !self.has_room(hold, offset_m, object) {
            return;
        }
        self.called_s = 0.0;
        self.count += 1;
        let goal = now.position.xy() - hold.normal.into_inner() * self.config.lift_m;
        let (duration_s, way) = transfer(now, &goal, hold.speed_m_per_s);
        self.passage = Some(Passage {
            leg: Leg::Off,
            hold: *hold,
            offset_m,
            lift_m: self.config.lift_m,
            angle_rad: now.position.z,
            clock_s: 0.0,
            duration_s,
            way,
        });
    }

    /// Whether the tool may go on from a hold at this offset to the push's end.
    fn has_room(&self, hold: &Hold, offset_m: f64, object: &Point2<f64>) -> bool {
        let left = Vector2::new(-hold.direction.y, hold.direction.x);
        let aside_m = (hold.touching(offset_m, object) - hold.planned_world).dot(&left);
        self.rooms.get(hold.action).is_some_and(|room| room.allows(aside_m))
    }

    /// Where the tool should be after one more period of a renewal; `None` if none is under way.
    pub(super) fn advance(&mut self, object: &Point2<f64>, period_s: f64) -> Option<PlanarMotion> {
        let passage = self.passage.as_mut()?;
        self.spent_s += period_s;
        passage.clock_s += period_s;
        let motion = passage.motion();
        if passage.clock_s >= passage.duration_s && !passage.turn(&motion, object) {
            self.passage = None;
        }
        Some(motion)
    }
}

impl Hold {
    /// Where the tool's origin is if it touches the object at an offset, world frame.
    fn touching(&self, offset_m: f64, object: &Point2<f64>) -> Point2<f64> {
        let tangent = Vector2::new(-self.normal.y, self.normal.x);
        object - self.normal.into_inner() * self.object_radius_m - tangent * offset_m - self.arm
    }
}

impl Passage {
    fn motion(&self) -> PlanarMotion {
        let [x, y] = self.way.map(|way| way.at(self.clock_s));
        PlanarMotion {
            position: Vector2::new(x.position, y.position).push(self.angle_rad),
            velocity: Vector2::new(x.first, y.first).push(0.0),
            acceleration: Vector2::new(x.second, y.second).push(0.0),
        }
    }

    /// Begins the next way; false after the last.
    fn turn(&mut self, now: &PlanarMotion, object: &Point2<f64>) -> bool {
        let touching = self.hold.touching(self.offset_m, object).coords;
        let (leg, goal) = match self.leg {
            Leg::Off => (Leg::Sideways, touching - self.hold.normal.into_inner() * self.lift_m),
            Leg::Sideways => (Leg::Back, touching),
            Leg::Back => return false,
        };
        (self.leg, self.clock_s) = (leg, 0.0);
        (self.duration_s, self.way) = transfer(now, &goal, self.hold.speed_m_per_s);
        true
    }
}

/// Duration and way from a motion to rest at a goal, at a mean speed.
fn transfer(now: &PlanarMotion, goal: &Vector2<f64>, speed_m_per_s: f64) -> (f64, [MinimumJerkTransfer; 2]) {
    let duration_s = ((goal - now.position.xy()).norm() / speed_m_per_s).max(SHORTEST_S);
    let way = [0, 1].map(|axis| {
        let state =
            PathState { position: now.position[axis], first: now.velocity[axis], second: now.acceleration[axis] };
        MinimumJerkTransfer::new(0.0, state, goal[axis], duration_s)
    });
    (duration_s, way)
}

fn push_direction(action: &Action) -> Option<Unit<Vector2<f64>>> {
    match action.kind {
        ActionKind::ObjectOperating(push) => Some(Unit::new_unchecked(push.direction_world()?)),
        ActionKind::ToolFlipping => None,
    }
}
