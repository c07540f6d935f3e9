//! What the human decides: where to take hold, how to push, when to let go.

use nalgebra::{Isometry2, Point2, Unit, Vector2};
use skills::outline::{Outline, PlacedOutline};
use skills::pushing::{Steering, SteeringConfig};
use skills::time_law::{minimum_jerk, minimum_jerk_first_derivative};
use skills::tool::Tool;
use skills::tool_use::Surroundings;

use super::config::HumanConfig;
use super::motor::MotorNoise;
use crate::planar::Tracker;

/// One push that the human intends.
#[derive(Clone, Debug)]
pub(crate) struct Leg {
    pub(crate) surface: usize,
    pub(crate) to_world: Point2<f64>,
    pub(crate) direction: Unit<Vector2<f64>>,
}

/// What the human does now.
#[derive(Clone, Debug)]
enum Doing {
    /// Waiting until a time.
    Pausing { until_s: f64, then: Next },
    /// Following a way through free space, begun at a time.
    Moving { way: Vec<Point2<f64>>, begun_s: f64, then: Next },
    /// Closing in on the object.
    Approaching,
    /// Pushing.
    Pushing { begun_s: f64 },
    /// At the end.
    Done,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    TakeHold,
    Approach,
    Push,
    GoHome,
    Finish,
}

/// The human's mind during one trial.
pub(crate) struct Operator<'a> {
    tool: &'a Tool,
    obstacles: &'a [PlacedOutline],
    config: HumanConfig,
    legs: Vec<Leg>,
    leg: usize,
    doing: Doing,
    /// Where the tool is put in the end.
    park: Point2<f64>,
    object_radius_m: f64,
    /// Radius of the disc that holds the object, m.
    bounding_radius_m: f64,
    friction_length_m: f64,
    /// Where the hand should be.
    place: Vector2<f64>,
    velocity: Vector2<f64>,
    noise: MotorNoise,
    /// Times that the hold was renewed.
    pub(crate) renewed_holds: usize,
}

/// Distance from the object at which an approach begins and a release ends, m.
const HOLD_BACK_M: f64 = 0.008;
/// A hand reaches this far past the seen contact before it notices, m.
const OVERSHOOT_M: f64 = 0.0005;
/// A push that has lasted this long with the object beyond reach of the surface is given up, s.
const NOTICE_S: f64 = 0.3;
/// Correction of the hand towards the way that it follows, 1/s.
const WAY_GAIN_PER_S: f64 = 6.0;

impl<'a> Operator<'a> {
    pub(crate) fn new(
        tool: &'a Tool,
        obstacles: &'a [PlacedOutline],
        config: &HumanConfig,
        legs: Vec<Leg>,
        [home, park]: [Point2<f64>; 2],
        object: &Outline,
        mut noise: MotorNoise,
    ) -> Self {
        let mut config = config.clone();
        for value in [&mut config.push_speed_m_per_s, &mut config.free_speed_m_per_s, &mut config.gain_per_s] {
            *value *= noise.factor(config.trial_variation);
        }
        let doing = Doing::Pausing { until_s: noise.pause_s(config.pause_s), then: Next::TakeHold };
        Self {
            tool,
            obstacles,
            config,
            legs,
            leg: 0,
            doing,
            park,
            object_radius_m: object.inscribed_radius_m(),
            bounding_radius_m: object.radius_m(),
            friction_length_m: object.mean_radius_m(),
            place: home.coords,
            velocity: Vector2::zeros(),
            noise,
            renewed_holds: 0,
        }
    }

    /// Whether the human has put the tool back.
    pub(crate) fn is_done(&self) -> bool {
        matches!(self.doing, Doing::Done)
    }

    /// Where the hand should be and how fast it should go, given the tool's pose and what is believed of the object.
    pub(crate) fn act(
        &mut self,
        time_s: f64,
        dt: f64,
        tool: &Isometry2<f64>,
        belief: &Tracker,
    ) -> (Vector2<f64>, Vector2<f64>) {
        let object = belief.object_world();
        let intended = match self.doing.clone() {
            Doing::Done => Vector2::zeros(),
            Doing::Pausing { until_s, then } => {
                if time_s >= until_s {
                    self.start(then, time_s, &object);
                }
                Vector2::zeros()
            }
            Doing::Moving { way, begun_s, then } => self.follow(&way, begun_s, then, time_s, &object),
            Doing::Approaching => self.approach(time_s, tool, &object),
            Doing::Pushing { begun_s } => self.push(begun_s, time_s, tool, &object),
        };
        self.velocity = intended + self.noise.velocity(intended.norm(), dt);
        self.place += self.velocity * dt;
        let (tremor, tremor_rate) = self.noise.tremor(time_s);
        (self.place + tremor, self.velocity + tremor_rate)
    }

    fn start(&mut self, next: Next, time_s: f64, object: &Point2<f64>) {
        match next {
            Next::TakeHold => {
                let to = self.leg_hold(object, HOLD_BACK_M);
                self.go(to.unwrap_or(self.park), time_s, Next::Approach, object);
            }
            Next::Approach => self.doing = Doing::Approaching,
            Next::Push => self.doing = Doing::Pushing { begun_s: time_s },
            Next::GoHome => self.go(self.park, time_s, Next::Finish, object),
            Next::Finish => self.doing = Doing::Done,
        }
    }

    /// Place of the tool's origin that holds the object with the current leg's surface.
    fn leg_hold(&self, object: &Point2<f64>, gap_m: f64) -> Option<Point2<f64>> {
        let surface = self.legs.get(self.leg).and_then(|leg| self.tool.surfaces.get(leg.surface))?;
        let pose = self.tool.pose_touching(&surface.middle(), object, self.object_radius_m, gap_m, 0.0);
        Some(Point2::from(pose.translation.vector))
    }

    /// Sets out to a place, round the object and obstacles.
    fn go(&mut self, to: Point2<f64>, time_s: f64, then: Next, object: &Point2<f64>) {
        let surroundings = Surroundings {
            tool: self.tool,
            angle_rad: 0.0,
            object_world: *object,
            object_radius_m: self.bounding_radius_m,
            obstacles: self.obstacles,
            margin_m: HOLD_BACK_M * 0.6,
        };
        let from = Point2::from(self.place);
        let wide = Surroundings { margin_m: self.config.detour_m, ..surroundings.clone() };
        // as wide as the human likes to go, or as wide as there is room
        let way = wide.way(from, to).or_else(|| surroundings.way(from, to)).unwrap_or_else(|| vec![from, to]);
        self.doing = Doing::Moving { way, begun_s: time_s, then };
    }

    /// Velocity along a way, each part a minimum-jerk movement.
    fn follow(
        &mut self,
        way: &[Point2<f64>],
        begun_s: f64,
        then: Next,
        time_s: f64,
        object: &Point2<f64>,
    ) -> Vector2<f64> {
        let mut left_s = time_s - begun_s;
        for part in way.windows(2) {
            let &[from, to] = part else { continue };
            let length = (to - from).norm();
            let duration_s = (length / self.config.free_speed_m_per_s).max(0.1);
            if left_s < duration_s {
                let r = left_s / duration_s;
                let place = from + (to - from) * minimum_jerk(r);
                let velocity = (to - from) * (minimum_jerk_first_derivative(r) / duration_s);
                return velocity + (place.coords - self.place) * WAY_GAIN_PER_S;
            }
            left_s -= duration_s;
        }
        self.start(then, time_s, object);
        Vector2::zeros()
    }

    fn approach(&mut self, time_s: f64, tool: &Isometry2<f64>, object: &Point2<f64>) -> Vector2<f64> {
        let Some(hold) = self.leg_hold(object, -OVERSHOOT_M) else { return Vector2::zeros() };
        let left = hold.coords - self.place;
        let gap = self.tool.signed_distance_m(&tool.inverse_transform_point(object)) - self.object_radius_m;
        if gap <= 0.0 || left.norm() < OVERSHOOT_M {
            let pause = self.noise.pause_s(self.config.pause_s);
            self.doing = Doing::Pausing { until_s: time_s + pause, then: Next::Push };
            return Vector2::zeros();
        }
        let speed = self.config.approach_speed_m_per_s;
        left * (speed / left.norm()).min(self.config.gain_per_s * 2.0)
    }

    fn push(&mut self, begun_s: f64, time_s: f64, tool: &Isometry2<f64>, object: &Point2<f64>) -> Vector2<f64> {
        let Some(leg) = self.legs.get(self.leg).cloned() else { return Vector2::zeros() };
        let Some(surface) = self.tool.surfaces.get(leg.surface) else { return Vector2::zeros() };
        let steering = Steering::new(
            // a human corrects as fast as the reaction time allows
            &SteeringConfig {
                offset_length_m: self.config.push_speed_m_per_s / self.config.gain_per_s,
                ..SteeringConfig::default()
            },
            leg.to_world,
            leg.direction,
            surface.curvature_radius_m(),
            surface.length_m() / 2.0,
            self.object_radius_m,
            self.friction_length_m,
        );
        let middle = surface.middle();
        let normal = tool.rotation * middle.normal;
        let command = steering.command(&(tool * middle.point), &normal, object, self.config.push_speed_m_per_s);
        let left = (leg.to_world - object).dot(&leg.direction);
        if left <= 0.0 {
            self.let_go(time_s, tool, true);
            return Vector2::zeros();
        }
        if command.offset_m.abs() > self.config.recontact_m && time_s - begun_s > NOTICE_S {
            self.renewed_holds += 1;
            self.let_go(time_s, tool, false);
            return Vector2::zeros();
        }
        // slower near the end, as one who aims
        command.velocity_world * (left / 0.008).clamp(0.3, 1.0)
    }

    /// Backs off along the normal, then takes the next hold or goes home.
    fn let_go(&mut self, time_s: f64, tool: &Isometry2<f64>, leg_done: bool) {
        let surface = self.legs.get(self.leg).and_then(|leg| self.tool.surfaces.get(leg.surface));
        let normal =
            surface.map_or_else(Vector2::zeros, |surface| (tool.rotation * surface.middle().normal).into_inner());
        let from = Point2::from(self.place);
        self.leg += usize::from(leg_done);
        let then = if self.leg < self.legs.len() { Next::TakeHold } else { Next::GoHome };
        self.doing = Doing::Moving { way: vec![from, from - normal * HOLD_BACK_M], begun_s: time_s, then };
    }
}
