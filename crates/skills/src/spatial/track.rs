//! Timed poses between which position and orientation are quintics: twice continuously differentiable everywhere.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::motion::SpatialMotion;
use super::refusal::SpatialError;
use crate::corridor::quintic;
use crate::primitive::pose::rotation::angular_motion;
use crate::time_law::PathState;

/// Largest turn between two knots, rad: the way round stays beyond doubt below half a turn.
const LARGEST_TURN_RAD: f64 = 3.0;
/// Span of time below which a piece has no part in another span, s.
const SHORTEST_S: f64 = 1e-12;
/// Angle below which a coefficient of the inverse Jacobian is summed as a series, rad.
const SERIES_BELOW_RAD: f64 = 1e-2;

/// Motion at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialKnot {
    /// Time since the begin of the track, s.
    pub time_s: f64,
    /// Pose, velocity and acceleration there.
    pub motion: SpatialMotion,
}

/// Certified upper bounds over a span of time.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct SpeedBounds {
    /// Speed of the tool's origin, m/s.
    pub speed_m_per_s: f64,
    /// Angular speed, rad/s.
    pub angular_speed_rad_per_s: f64,
    /// Acceleration of the tool's origin, m/s².
    pub acceleration_m_per_s2: f64,
    /// Angular acceleration, rad/s².
    pub angular_acceleration_rad_per_s2: f64,
}

impl SpeedBounds {
    /// The larger of each two numbers.
    #[must_use]
    pub fn max(&self, other: &Self) -> Self {
        Self {
            speed_m_per_s: self.speed_m_per_s.max(other.speed_m_per_s),
            angular_speed_rad_per_s: self.angular_speed_rad_per_s.max(other.angular_speed_rad_per_s),
            acceleration_m_per_s2: self.acceleration_m_per_s2.max(other.acceleration_m_per_s2),
            angular_acceleration_rad_per_s2: self
                .angular_acceleration_rad_per_s2
                .max(other.angular_acceleration_rad_per_s2),
        }
    }
}

/// Motion of a tool over time, from 0 s: through the pose, velocity and acceleration of every knot.
///
/// Between two knots x, y and z are quintics, and the orientation is e^ρ·q with a rotation vector ρ of three quintics.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialTrack {
    knots: Vec<SpatialKnot>,
    // ρ, ρ̇ and ρ̈ at the end of each piece
    turns: Vec<[Vector3<f64>; 3]>,
}

impl SpatialTrack {
    /// Checks and takes knots: at least two, the first at 0 s.
    ///
    /// # Errors
    /// If there are fewer than two, the times do not increase strictly from 0, a number is not finite, or the tool turns by
    /// more than 3 rad between two knots.
    pub fn new(knots: Vec<SpatialKnot>) -> Result<Self, SpatialError> {
        let first_s = knots.first().map_or(f64::NAN, |knot| knot.time_s);
        if knots.len() < 2 || first_s != 0.0 {
            return Err(SpatialError::Knots { found: knots.len(), first_s });
        }
        for (row, knot) in knots.iter().enumerate() {
            if !knot.time_s.is_finite() || knot.motion.numbers().any(|number| !number.is_finite()) {
                return Err(SpatialError::NonFinite { row, time_s: knot.time_s });
            }
        }
        let mut turns = Vec::with_capacity(knots.len() - 1);
        for (row, (from, to)) in knots.iter().zip(knots.iter().skip(1)).enumerate() {
            if to.time_s <= from.time_s {
                return Err(SpatialError::TimesNotIncreasing { row: row + 1, time_s: to.time_s });
            }
            let rho = (to.motion.pose.rotation * from.motion.pose.rotation.inverse()).scaled_axis();
            if rho.norm() > LARGEST_TURN_RAD {
                let (turn_rad, largest_rad) = (rho.norm(), LARGEST_TURN_RAD);
                return Err(SpatialError::FastTurn { row: row + 1, turn_rad, largest_rad });
            }
            turns.push(turn_rates(rho, &to.motion));
        }
        Ok(Self { knots, turns })
    }

    /// The knots.
    #[must_use]
    pub fn knots(&self) -> &[SpatialKnot] {
        &self.knots
    }

    /// Time of the whole track, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.time_s)
    }

    /// The first motion.
    #[must_use]
    pub fn start(&self) -> SpatialMotion {
        self.knots.first().map_or_else(|| SpatialMotion::at_rest(Isometry3::identity()), |knot| knot.motion)
    }

    /// The last motion.
    #[must_use]
    pub fn end(&self) -> SpatialMotion {
        self.knots.last().map_or_else(|| SpatialMotion::at_rest(Isometry3::identity()), |knot| knot.motion)
    }

    /// The motion at a time since the begin, s; before the begin and after the end at rest at the nearer end (NaN: the
    /// first).
    #[must_use]
    pub fn at(&self, time_s: f64) -> SpatialMotion {
        if time_s.is_nan() || time_s < 0.0 {
            return SpatialMotion::at_rest(self.start().pose);
        }
        if time_s > self.duration_s() {
            return SpatialMotion::at_rest(self.end().pose);
        }
        let row = self.knots.partition_point(|knot| knot.time_s <= time_s).saturating_sub(1).min(self.turns.len() - 1);
        self.inside(row, time_s)
    }

    /// Evaluates the piece `row`.
    fn inside(&self, row: usize, time_s: f64) -> SpatialMotion {
        let (Some(from), Some(to), Some(turn)) = (self.knots.get(row), self.knots.get(row + 1), self.turns.get(row))
        else {
            return self.end();
        };
        if time_s == to.time_s {
            return to.motion;
        }
        let h = to.time_s - from.time_s;
        let u = (time_s - from.time_s) / h;
        let [place, linear, linear_change] = vectors(|k| quintic(place(&from.motion, k), place(&to.motion, k), h, u));
        let [rho, rate, second] = vectors(|k| quintic(turned(&from.motion, k), end_of_turn(turn, k), h, u));
        let (angular, angular_change) = angular_motion(&rho, &rate, &second);
        let rotation = UnitQuaternion::from_scaled_axis(rho) * from.motion.pose.rotation;
        SpatialMotion::new(
            Isometry3::from_parts(Translation3::from(place), rotation),
            [linear, angular],
            [linear_change, angular_change],
        )
    }

    /// Bounds the rates between two times, s, from above: by the control polygons of the quintics, |ω| ≤ |ρ̇| and
    /// |ω̇| ≤ |ρ̈| + |ρ̇|²/2.
    #[must_use]
    pub fn bounds(&self, from_s: f64, to_s: f64) -> SpeedBounds {
        let rows = self.knots.windows(2).enumerate();
        // what rounding makes of a neighbor's end is no part of the span
        let overlap_s = |pair: &[SpatialKnot]| to_s.min(pair[1].time_s) - from_s.max(pair[0].time_s);
        let touched = rows.filter(|(_, pair)| overlap_s(pair) > SHORTEST_S);
        touched.fold(SpeedBounds::default(), |bounds, (row, pair)| {
            bounds.max(&self.piece_bounds(row, from_s.max(pair[0].time_s), to_s.min(pair[1].time_s)))
        })
    }

    fn piece_bounds(&self, row: usize, from_s: f64, to_s: f64) -> SpeedBounds {
        let (Some(from), Some(to), Some(turn)) = (self.knots.get(row), self.knots.get(row + 1), self.turns.get(row))
        else {
            return SpeedBounds::default();
        };
        let h = to.time_s - from.time_s;
        let part = |begin: PathState, end: PathState| {
            let at = |time_s: f64| quintic(begin, end, h, (time_s - from.time_s) / h);
            control_rates(at(from_s), at(to_s), to_s - from_s)
        };
        let [speed, acceleration] = largest(|k| part(place(&from.motion, k), place(&to.motion, k)));
        let [rate, second] = largest(|k| part(turned(&from.motion, k), end_of_turn(turn, k)));
        SpeedBounds {
            speed_m_per_s: speed,
            angular_speed_rad_per_s: rate,
            acceleration_m_per_s2: acceleration,
            angular_acceleration_rad_per_s2: second + 0.5 * rate * rate,
        }
    }

    /// The same way backward over the same time; accelerations are those of before.
    ///
    /// # Errors
    /// None but of rounding: the poses are those of a track.
    pub fn reversed(&self) -> Result<Self, SpatialError> {
        let duration_s = self.duration_s();
        let back = |knot: &SpatialKnot| SpatialKnot {
            time_s: duration_s - knot.time_s,
            motion: SpatialMotion { velocity: -knot.motion.velocity, ..knot.motion },
        };
        Self::new(self.knots.iter().rev().map(back).collect())
    }

    /// The same track in another frame, `other_from_world`.
    #[must_use]
    pub fn seen_from(&self, other_from_world: &Isometry3<f64>) -> Self {
        let knots = self.knots.iter();
        let knots =
            knots.map(|knot| SpatialKnot { motion: knot.motion.seen_from(other_from_world), ..*knot }).collect();
        let turns = self.turns.iter().map(|turn| turn.map(|vector| other_from_world.rotation * vector)).collect();
        Self { knots, turns }
    }
}

fn place(motion: &SpatialMotion, k: usize) -> PathState {
    PathState { position: motion.pose.translation.vector[k], first: motion.velocity[k], second: motion.acceleration[k] }
}

// at ρ = 0 the rates of ρ are those of the orientation
fn turned(motion: &SpatialMotion, k: usize) -> PathState {
    PathState { position: 0.0, first: motion.velocity[k + 3], second: motion.acceleration[k + 3] }
}

fn end_of_turn(turn: &[Vector3<f64>; 3], k: usize) -> PathState {
    PathState { position: turn[0][k], first: turn[1][k], second: turn[2][k] }
}

fn vectors(at: impl Fn(usize) -> PathState) -> [Vector3<f64>; 3] {
    let [x, y, z] = [at(0), at(1), at(2)];
    [
        Vector3::new(x.position, y.position, z.position),
        Vector3::new(x.first, y.first, z.first),
        Vector3::new(x.second, y.second, z.second),
    ]
}

/// ρ with the rates that belong to the motion at its end: ω = J(ρ)ρ̇, and ω̇ alike.
fn turn_rates(rho: Vector3<f64>, motion: &SpatialMotion) -> [Vector3<f64>; 3] {
    let rate = inverse_jacobian(&rho, &motion.angular_velocity());
    // what ω̇ is without ρ̈
    let (_, carried) = angular_motion(&rho, &rate, &Vector3::zeros());
    [rho, rate, inverse_jacobian(&rho, &(motion.angular_acceleration() - carried))]
}

/// J(ρ)⁻¹x = x − ρ × x/2 + c·ρ × (ρ × x), c = 1/φ² − cot(φ/2)/(2φ).
fn inverse_jacobian(rho: &Vector3<f64>, x: &Vector3<f64>) -> Vector3<f64> {
    let angle = rho.norm();
    let c = if angle < SERIES_BELOW_RAD {
        1.0 / 12.0 + angle * angle / 720.0
    } else {
        1.0 / (angle * angle) - 1.0 / (2.0 * angle * (0.5 * angle).tan())
    };
    let once = rho.cross(x);
    x - once * 0.5 + rho.cross(&once) * c
}

/// Control values of the first (5) and second (4) derivative of a quintic between two states.
fn control_rates(from: PathState, to: PathState, h: f64) -> ([f64; 5], [f64; 4]) {
    let (v0, a0) = (from.first * h / 5.0, from.second * h * h / 20.0);
    let (v1, a1) = (to.first * h / 5.0, to.second * h * h / 20.0);
    let b = [
        from.position,
        from.position + v0,
        from.position + 2.0 * v0 + a0,
        to.position - 2.0 * v1 + a1,
        to.position - v1,
        to.position,
    ];
    let first = [0, 1, 2, 3, 4].map(|k| 5.0 * (b[k + 1] - b[k]) / h);
    (first, [0, 1, 2, 3].map(|k| 4.0 * (first[k + 1] - first[k]) / h))
}

/// Longest control vectors of the first and second derivative of three coordinates.
fn largest(of: impl Fn(usize) -> ([f64; 5], [f64; 4])) -> [f64; 2] {
    let [x, y, z] = [of(0), of(1), of(2)];
    let first = (0..5).map(|k| Vector3::new(x.0[k], y.0[k], z.0[k]).norm()).fold(0.0, f64::max);
    let second = (0..4).map(|k| Vector3::new(x.1[k], y.1[k], z.1[k]).norm()).fold(0.0, f64::max);
    [first, second]
}

#[cfg(test)]
#[path = "track_tests.rs"]
mod tests;
