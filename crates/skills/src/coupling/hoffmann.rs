//! Hoffmann's obstacle term Δu = γ R v φ e^{−βφ} of Eq. (6), and the regressors it is identified from.
//!
//! The paper leaves the scale of v and the plane of R open. Here v = τẋ as in Eq. (1), so that the path does not depend on
//! the duration, and R turns in the plane of v and the direction to the obstacle, away from it, in any dimension.

use super::{Coupling, MotionState};
use crate::error::SkillError;

/// What is being done, for errors.
const OPERATION: &str = "build obstacle term";

/// Point obstacles that turn a motion away: Δu = Σ_o γ R_o v φ_o e^{−βφ_o}, v = τẋ.
///
/// φ ∈ [0, π] is the angle between v and the direction to the obstacle, R the rotation by π/2 in their plane away from the
/// obstacle. Δu is perpendicular to v, greatest over φ at 1/β, and does not depend on the distance: a motion that does not
/// head for the obstacle is left alone, however near. It is zero at rest, on the obstacle, and where the plane is undefined
/// (φ = 0 and φ = π); φ = 0 is a continuous zero, φ = π leaves a step of γ‖v‖πe^{−βπ} at most.
///
/// An obstacle with fewer coordinates than the motion acts on the first ones alone: (x, y) is a post in space. Coordinates
/// that the motion does not have are ignored.
///
/// Source: H. Hoffmann, P. Pastor, D.-H. Park and S. Schaal, "Biologically-inspired dynamical systems for movement
/// generation: automatic real-time goal adaptation and obstacle avoidance", ICRA 2009, doi:10.1109/ROBOT.2009.5152423.
#[derive(Debug, Clone, PartialEq)]
pub struct Hoffmann {
    gamma: f64,
    beta: f64,
    obstacles: Vec<Vec<f64>>,
}

/// Angle and direction of one obstacle's term.
struct Turn {
    /// φ, rad.
    angle: f64,
    /// Part of the way to the obstacle that lies ahead: d = (`ahead` + `rest`)·v/‖v‖ + d⊥.
    ahead: f64,
    /// What rounding leaves of it.
    rest: f64,
    /// Norm of the velocity, not scaled by τ.
    speed: f64,
    /// n = R v φ = `scale`·d⊥.
    scale: f64,
}

impl Hoffmann {
    /// Builds the term with gain γ (≥ 0, without unit), decay β (≥ 0, 1/rad) and `obstacles` (points of at least two
    /// coordinates, unit and frame of the motion).
    ///
    /// # Errors
    /// If γ or β is negative or not finite, or an obstacle has fewer than two coordinates or one that is not finite.
    pub fn new(gamma: f64, beta: f64, obstacles: Vec<Vec<f64>>) -> Result<Self, SkillError> {
        for (argument, found) in [("gamma", gamma), ("beta", beta)] {
            if !(found >= 0.0 && found.is_finite()) {
                let expected = "a finite number of at least 0";
                return Err(SkillError::InvalidArgument { operation: OPERATION, argument, found, expected });
            }
        }
        for (row, obstacle) in obstacles.iter().enumerate() {
            if obstacle.len() < 2 {
                return Err(SkillError::Dimension { operation: OPERATION, found: obstacle.len(), expected: 2 });
            }
            if let Some((column, found)) = obstacle.iter().enumerate().find(|(_, value)| !value.is_finite()) {
                return Err(SkillError::NonFinite { operation: OPERATION, row, column, found: *found });
            }
        }
        Ok(Self { gamma, beta, obstacles })
    }

    /// Returns the gain γ, without unit.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.gamma
    }

    /// Returns the decay β, 1/rad.
    #[must_use]
    pub fn beta(&self) -> f64 {
        self.beta
    }

    /// Returns the obstacles, unit and frame of the motion.
    #[must_use]
    pub fn obstacles(&self) -> &[Vec<f64>] {
        &self.obstacles
    }

    /// Evaluates the regressors of Eq. (11): writes n = R v φ into `direction` and returns φ, rad, so that
    /// Δu = γ n e^{−βφ}; allocates nothing.
    ///
    /// `position`, `velocity` (v = τẋ) and `direction` have d values. Where the term is zero for every γ and β, n and φ are
    /// zero.
    pub fn features(position: &[f64], velocity: &[f64], obstacle: &[f64], direction: &mut [f64]) -> f64 {
        direction.fill(0.0);
        let Some(turn) = Turn::new(position, velocity, 1.0, obstacle) else { return 0.0 };
        turn.add_to(1.0, position, velocity, obstacle, direction);
        turn.angle
    }
}

impl Coupling for Hoffmann {
    fn add_to(&self, state: &MotionState<'_>, sum: &mut [f64]) {
        for obstacle in &self.obstacles {
            if let Some(turn) = Turn::new(state.position, state.velocity, state.duration_s, obstacle) {
                let gain = self.gamma * (-self.beta * turn.angle).exp();
                turn.add_to(gain, state.position, state.velocity, obstacle, sum);
            }
        }
    }
}

impl Turn {
    /// Measures the turn away from `obstacle` at the velocity v = `tau`·`rate`; nothing where the plane is undefined.
    fn new(position: &[f64], rate: &[f64], tau: f64, obstacle: &[f64]) -> Option<Self> {
        let speed = norm(rate.iter().copied().take(obstacle.len()));
        if speed == 0.0 {
            return None;
        }
        let way = || obstacle.iter().zip(position).map(|(o, x)| o - x);
        // unit vectors first, so that neither a tiny nor a huge velocity loses the angle
        let ahead: f64 = way().zip(rate).map(|(d, v)| d * (v / speed)).sum();
        // what rounding leaves along the velocity is all there is, nearly straight ahead: it is taken out once more
        let rest: f64 = way().zip(rate).map(|(d, v)| (d - ahead * (v / speed)) * (v / speed)).sum();
        let aside = norm(way().zip(rate).map(|(d, v)| d - ahead * (v / speed) - rest * (v / speed)));
        if aside == 0.0 {
            return None;
        }
        let angle = aside.atan2(ahead);
        Some(Self { angle, ahead, rest, speed, scale: -angle * (tau * speed / aside) })
    }

    // sum += gain·n
    fn add_to(&self, gain: f64, position: &[f64], rate: &[f64], obstacle: &[f64], sum: &mut [f64]) {
        let aside = obstacle.iter().zip(position).zip(rate).map(|((o, x), v)| {
            let along = v / self.speed;
            (o - x) - self.ahead * along - self.rest * along
        });
        for (sum, aside) in sum.iter_mut().zip(aside) {
            *sum += gain * (self.scale * aside);
        }
    }
}

/// Euclidean norm that neither overflows nor underflows on the way.
fn norm(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let largest = values.clone().map(f64::abs).fold(0.0, f64::max);
    if largest == 0.0 {
        // zero, or NaN if there is one, which the maximum skips
        return values.sum();
    }
    largest * values.map(|value| (value / largest).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
#[path = "hoffmann_tests.rs"]
mod tests;
