//! Continuity of a plan: what jumps where two actions meet, and inside an action between its motions.

use serde::Serialize;

use super::{Action, Plan, PlanarMotion, Track};

/// Who moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// The tool.
    Tool,
    /// The object.
    Object,
}

/// Difference between two motions that should be one: C0 (place, angle), C1 (velocities) and C2 (accelerations).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Jump {
    /// Distance, m.
    pub position_m: f64,
    /// Angle, rad. A whole turn is a jump too: the tool would be asked to turn once.
    pub angle_rad: f64,
    /// Difference of the velocities, m/s.
    pub velocity_m_per_s: f64,
    /// Difference of the angular velocities, rad/s.
    pub angular_velocity_rad_per_s: f64,
    /// Difference of the accelerations, m/s²; reported, never refused.
    pub acceleration_m_per_s2: f64,
    /// Difference of the angular accelerations, rad/s²; reported, never refused.
    pub angular_acceleration_rad_per_s2: f64,
}

/// Where two actions meet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Joint {
    /// Name of the action that ends.
    pub before: String,
    /// Name of the action that begins.
    pub after: String,
    /// Time of the plan, s.
    pub time_s: f64,
    /// Jump of the tool.
    pub tool: Jump,
    /// Jump of the object.
    pub object: Jump,
}

impl Jump {
    /// Compares two motions, world frame.
    #[must_use]
    pub fn between(end: &PlanarMotion, start: &PlanarMotion) -> Self {
        let (place, velocity, acceleration) =
            (start.position - end.position, start.velocity - end.velocity, start.acceleration - end.acceleration);
        Self {
            position_m: place.xy().norm(),
            angle_rad: place.z.abs(),
            velocity_m_per_s: velocity.xy().norm(),
            angular_velocity_rad_per_s: velocity.z.abs(),
            acceleration_m_per_s2: acceleration.xy().norm(),
            angular_acceleration_rad_per_s2: acceleration.z.abs(),
        }
    }

    /// The larger of each two numbers.
    #[must_use]
    pub fn max(&self, other: &Self) -> Self {
        Self {
            position_m: self.position_m.max(other.position_m),
            angle_rad: self.angle_rad.max(other.angle_rad),
            velocity_m_per_s: self.velocity_m_per_s.max(other.velocity_m_per_s),
            angular_velocity_rad_per_s: self.angular_velocity_rad_per_s.max(other.angular_velocity_rad_per_s),
            acceleration_m_per_s2: self.acceleration_m_per_s2.max(other.acceleration_m_per_s2),
            angular_acceleration_rad_per_s2: self
                .angular_acceleration_rad_per_s2
                .max(other.angular_acceleration_rad_per_s2),
        }
    }
}

impl Plan {
    /// Measures what jumps at each joint of the plan.
    #[must_use]
    pub fn joints(&self) -> Vec<Joint> {
        let ends = self.starts_s.iter().skip(1);
        let pairs = self.actions.windows(2).zip(ends);
        pairs.map(|(pair, time_s)| joint(&pair[0], &pair[1], *time_s)).collect()
    }
}

fn joint(before: &Action, after: &Action, time_s: f64) -> Joint {
    Joint {
        before: before.name.clone(),
        after: after.name.clone(),
        time_s,
        tool: Jump::between(&before.tool.end(), &after.tool.start()),
        object: Jump::between(&before.object.end(), &after.object.start()),
    }
}

impl Track {
    /// Jump into the motion of index `row` (from 1): by what its place and velocity differ from where the motion before leads.
    ///
    /// x₁ = x₀ + h/2·(v₀ + v₁) + h²/12·(a₀ − a₁), to h⁵/720 of the fifth derivative, and v₁ = v₀ + h/2·(a₀ + a₁), to h³/12
    /// of the fourth one. Accelerations have nothing to be compared with: 0.
    #[must_use]
    pub fn jump_into(&self, row: usize) -> Jump {
        let Some([from, to]) = row.checked_sub(1).and_then(|before| self.motions().get(before..=row)) else {
            return Jump::default();
        };
        let h = self.time_step_s();
        let position = from.position
            + (from.velocity + to.velocity) * (h / 2.0)
            + (from.acceleration - to.acceleration) * (h * h / 12.0);
        let velocity = from.velocity + (from.acceleration + to.acceleration) * (h / 2.0);
        Jump::between(&PlanarMotion { position, velocity, acceleration: to.acceleration }, to)
    }

    /// The largest jump inside the track, number by number, with [`Track::jump_into`].
    #[must_use]
    pub fn largest_jump(&self) -> Jump {
        (1..self.motions().len())
            .map(|row| self.jump_into(row))
            .fold(Jump::default(), |largest, jump| largest.max(&jump))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    /// A few roundings of numbers of order one.
    const ROUNDING: f64 = 1e-12;
    const STEP_S: f64 = 0.1;

    /// x = t⁴, of which place, velocity and acceleration are known.
    fn motion(time_s: f64) -> PlanarMotion {
        PlanarMotion {
            position: Vector3::new(time_s.powi(4), 0.0, 0.0),
            velocity: Vector3::new(4.0 * time_s.powi(3), 0.0, 0.0),
            acceleration: Vector3::new(12.0 * time_s * time_s, 0.0, 0.0),
        }
    }

    fn motions() -> Vec<PlanarMotion> {
        (0..=10).map(|row| motion(f64::from(row) * STEP_S)).collect()
    }

    #[test]
    fn a_smooth_track_has_no_jump_but_the_rule_s_own_error() {
        let largest = Track::new(STEP_S, motions()).unwrap().largest_jump();
        // exact in the place; h³/12 of the fourth derivative, 24, in the velocity
        assert!(largest.position_m <= ROUNDING);
        assert!((largest.velocity_m_per_s - 24.0 * STEP_S.powi(3) / 12.0).abs() < ROUNDING);
    }

    #[test]
    fn a_jump_inside_a_track_is_measured_where_it_is() {
        let mut moved = motions();
        moved.iter_mut().skip(6).for_each(|motion| motion.position += Vector3::new(0.03, 0.04, -0.2));
        let track = Track::new(STEP_S, moved).unwrap();
        let (before, jump) = (track.jump_into(5), track.jump_into(6));
        assert!(before.position_m <= ROUNDING && before.angle_rad <= ROUNDING);
        assert!((jump.position_m - 0.05).abs() <= ROUNDING && (jump.angle_rad - 0.2).abs() <= ROUNDING);
        assert_eq!((track.jump_into(0), track.jump_into(11)), (Jump::default(), Jump::default()));
    }
}
