//! Potential fields about point obstacles: a static one by distance, a dynamic one by distance and heading.
//!
//! What the sources leave open is settled thus. Both fields grow without bound towards an obstacle: nearer than `closest`,
//! and inside, they push as at that distance. v is τẋ of Eq. (1), so that the path does not depend on the duration. The
//! force of several obstacles is their sum. Neither field is a guarantee: a motion that heads straight for an obstacle is
//! slowed by the dynamic field but not turned, and a fast enough one passes through either.

use serde::{Deserialize, Serialize};

use super::{Coupling, MotionState};
use crate::error::SkillError;
use crate::field::{FieldError, finite, not_negative, positive};

/// Obstacle to keep away from: a ball of d dimensions, a point if its radius is zero.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointObstacle {
    /// Center o: d values, unit and frame of the motion.
    pub center: Vec<f64>,
    /// Radius ≥ 0, unit of the motion; the distance is p = ‖x − o‖ − radius.
    pub radius: f64,
}

/// Dynamic potential U = λ(−cos θ)^β·‖v‖/p for θ in (π/2, π], else 0, with θ between v = τẋ and x − o: acts only on what
/// approaches, the more the faster.
///
/// Source: D.-H. Park, H. Hoffmann, P. Pastor, S. Schaal, "Movement reproduction and obstacle avoidance with dynamic
/// movement primitives and potential fields", IEEE-RAS Humanoids 2008, doi:10.1109/ICHR.2008.4755937.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DynamicPotential {
    /// Strength λ ≥ 0, unit of the motion squared; the default suits motions of some decimeters in m.
    pub strength: f64,
    /// Exponent β > 1, without unit: at 1 and below the force would jump as θ passes π/2.
    pub exponent: f64,
    /// Least distance p that counts, > 0, unit of the motion.
    pub closest: f64,
}

impl Default for DynamicPotential {
    fn default() -> Self {
        Self { strength: 0.01, exponent: 2.0, closest: 0.001 }
    }
}

/// Static potential U = ½η(1/p − 1/p₀)² for p ≤ p₀, else 0: acts on whatever is near.
///
/// Source: O. Khatib, "Real-time obstacle avoidance for manipulators and mobile robots", International Journal of Robotics
/// Research 5(1), 1986, doi:10.1177/027836498600500106; Park et al. 2008 compare with it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StaticPotential {
    /// Strength η ≥ 0, unit of the motion to the fourth power; the default suits motions of some decimeters in m.
    pub strength: f64,
    /// Distance p₀ > 0 from which the field acts, unit of the motion.
    pub reach: f64,
    /// Least distance p that counts, > 0, unit of the motion.
    pub closest: f64,
}

impl Default for StaticPotential {
    fn default() -> Self {
        Self { strength: 5e-5, reach: 0.05, closest: 0.001 }
    }
}

/// Kinds of potential, as a table in a file: `potential.dynamic.strength = 0.01`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PotentialConfig {
    /// By distance and heading (default).
    Dynamic(DynamicPotential),
    /// By distance alone.
    Static(StaticPotential),
}

impl Default for PotentialConfig {
    fn default() -> Self {
        Self::Dynamic(DynamicPotential::default())
    }
}

impl PotentialConfig {
    /// Checks the options of the kind.
    ///
    /// # Errors
    /// A [`FieldError`] with a field such as `dynamic.strength`.
    pub fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::Dynamic(dynamic) => dynamic.validate().map_err(|error| error.within("dynamic")),
            Self::Static(fixed) => fixed.validate().map_err(|error| error.within("static")),
        }
    }
}

impl DynamicPotential {
    fn validate(&self) -> Result<(), FieldError> {
        not_negative("strength", self.strength)?;
        if !(self.exponent > 1.0 && self.exponent.is_finite()) {
            return Err(FieldError::new("exponent", self.exponent, "a number above 1"));
        }
        positive("closest", self.closest)
    }

    fn potential(&self, near: &Nearness) -> f64 {
        self.strength * near.approach().powf(self.exponent) * near.speed / near.distance(self.closest)
    }

    // with c = −cos θ: −∇U = λcᵝ⁻¹‖v‖/p·(β∇cos θ + c/p·n), ∇cos θ = (v/‖v‖ − cos θ·n)/‖x − o‖
    fn force(&self, near: &Nearness) -> Force {
        let (approach, distance) = (near.approach(), near.distance(self.closest));
        if approach == 0.0 {
            return Force::default();
        }
        let factor = self.strength * approach.powf(self.exponent - 1.0) / distance;
        let turn = self.exponent / near.to_center.max(self.closest);
        Force {
            along_normal: factor * near.speed * approach * (turn + distance.recip()),
            along_velocity: factor * turn,
        }
    }
}

impl StaticPotential {
    fn validate(&self) -> Result<(), FieldError> {
        not_negative("strength", self.strength)?;
        positive("reach", self.reach)?;
        positive("closest", self.closest)
    }

    // 1/p − 1/p₀ within reach
    fn excess(&self, near: &Nearness) -> f64 {
        (near.distance(self.closest).recip() - self.reach.recip()).max(0.0)
    }

    fn potential(&self, near: &Nearness) -> f64 {
        0.5 * self.strength * self.excess(near).powi(2)
    }

    // −∇U = η(1/p − 1/p₀)/p²·n
    fn force(&self, near: &Nearness) -> Force {
        let along_normal = self.strength * self.excess(near) / near.distance(self.closest).powi(2);
        Force { along_normal, along_velocity: 0.0 }
    }
}

/// Coupling Δu = −∇U of Eq. (6) by a potential about each of some obstacles.
#[derive(Debug, Clone, PartialEq)]
pub struct PotentialCoupling {
    potential: PotentialConfig,
    obstacles: Vec<PointObstacle>,
    dimension: usize,
}

impl PotentialCoupling {
    /// Puts `potential` about `obstacles`, for motions of `dimension` coordinates.
    ///
    /// # Errors
    /// If an option is out of range, or an obstacle has another dimension, a center that is not finite or a radius below
    /// zero.
    pub fn new(
        potential: PotentialConfig,
        obstacles: Vec<PointObstacle>,
        dimension: usize,
    ) -> Result<Self, SkillError> {
        potential.validate()?;
        for (index, obstacle) in obstacles.iter().enumerate() {
            let found = obstacle.center.len();
            if found != dimension {
                return Err(SkillError::Dimension { operation: "place obstacle", found, expected: dimension });
            }
            finite("center", &obstacle.center)
                .and_then(|()| not_negative("radius", obstacle.radius))
                .map_err(|error| error.within(format!("obstacles[{index}]")))?;
        }
        Ok(Self { potential, obstacles, dimension })
    }

    /// Evaluates U at `state`, summed over the obstacles.
    #[must_use]
    pub fn potential(&self, state: &MotionState<'_>) -> f64 {
        let near = self.obstacles.iter().map(|obstacle| Nearness::of(obstacle, state));
        near.map(|near| match &self.potential {
            PotentialConfig::Dynamic(dynamic) => dynamic.potential(&near),
            PotentialConfig::Static(fixed) => fixed.potential(&near),
        })
        .sum()
    }
}

impl Coupling for PotentialCoupling {
    fn dimension(&self) -> Option<usize> {
        Some(self.dimension)
    }

    fn add_to(&self, state: &MotionState<'_>, sum: &mut [f64]) {
        for obstacle in &self.obstacles {
            let near = Nearness::of(obstacle, state);
            let force = match &self.potential {
                PotentialConfig::Dynamic(dynamic) => dynamic.force(&near),
                PotentialConfig::Static(fixed) => fixed.force(&near),
            };
            // at the very center there is no direction away
            let per_offset = if near.to_center > 0.0 { force.along_normal / near.to_center } else { 0.0 };
            let per_velocity = force.along_velocity * state.duration_s;
            for (k, sum) in sum.iter_mut().enumerate() {
                *sum += per_offset * (state.position[k] - obstacle.center[k]) + per_velocity * state.velocity[k];
            }
        }
    }
}

/// How a motion stands to an obstacle.
struct Nearness {
    // ‖x − o‖
    to_center: f64,
    radius: f64,
    // ‖v‖ with v = τẋ
    speed: f64,
    // cos θ between v and x − o; 0 if either vanishes
    cosine: f64,
}

/// Force as multiples of the unit normal (x − o)/‖x − o‖ and of v.
#[derive(Default)]
struct Force {
    along_normal: f64,
    along_velocity: f64,
}

impl Nearness {
    fn of(obstacle: &PointObstacle, state: &MotionState<'_>) -> Self {
        let (mut offset, mut speed, mut product) = (0.0, 0.0, 0.0);
        for ((position, velocity), center) in state.position.iter().zip(state.velocity).zip(&obstacle.center) {
            let (away, velocity) = (position - center, velocity * state.duration_s);
            offset += away * away;
            speed += velocity * velocity;
            product += away * velocity;
        }
        let (to_center, speed) = (offset.sqrt(), speed.sqrt());
        let norms = to_center * speed;
        let cosine = if norms > 0.0 { (product / norms).clamp(-1.0, 1.0) } else { 0.0 };
        Self { to_center, radius: obstacle.radius, speed, cosine }
    }

    // p
    fn distance(&self, closest: f64) -> f64 {
        (self.to_center - self.radius).max(closest)
    }

    // −cos θ where the motion approaches, else 0
    fn approach(&self) -> f64 {
        (-self.cosine).max(0.0)
    }
}

#[cfg(test)]
#[path = "potential_tests.rs"]
mod tests;
