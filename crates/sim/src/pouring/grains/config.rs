//! What a grain is: shape, size, material.

use std::f64::consts::PI;

use rapier3d::prelude::{CoefficientCombineRule, ColliderBuilder};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, within};

/// A grain's shape.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum GrainShape {
    /// Ball.
    #[default]
    Ball,
    /// Capsule: a ball drawn out along its axis. Its shape resists rolling, so leave `rolling_friction` at zero.
    Capsule {
        /// Length over width; soybeans 1.15 to 1.3.
        aspect: f64,
    },
}

/// A kind of grain. The defaults are soybeans: size and density after Kibar and Öztürk (2008), restitution and friction
/// after Boac et al. (2010), rolling friction such that a heap stands as steep as a real one, 24 to 26°.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct GrainConfig {
    /// Shape.
    pub shape: GrainShape,
    /// Mean diameter of the ball of equal volume, m.
    #[schemars(range(min = 0.001, max = 0.1))]
    pub diameter_m: f64,
    /// Standard deviation of the diameter over its mean; sizes beyond two deviations are drawn in to two.
    #[schemars(range(min = 0.0, max = 0.25))]
    pub size_variation: f64,
    /// Density of a grain, kg/m³.
    #[schemars(range(min = 10.0, max = 20_000.0))]
    pub density_kg_per_m3: f64,
    /// Coefficient of friction between grains.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub friction: f64,
    /// Coefficient of restitution between grains.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
    /// Coefficient of rolling resistance: torque over normal force and rolling radius.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub rolling_friction: f64,
}

impl Default for GrainConfig {
    fn default() -> Self {
        Self {
            shape: GrainShape::Ball,
            diameter_m: 0.007,
            size_variation: 0.04,
            density_kg_per_m3: 1200.0,
            friction: 0.45,
            restitution: 0.6,
            rolling_friction: 0.1,
        }
    }
}

impl GrainConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        if let GrainShape::Capsule { aspect } = self.shape {
            within("shape.capsule.aspect", aspect, 1.0, 4.0)?;
        }
        within("diameter_m", self.diameter_m, 0.001, 0.1)?;
        within("size_variation", self.size_variation, 0.0, 0.25)?;
        within("density_kg_per_m3", self.density_kg_per_m3, 10.0, 20_000.0)?;
        within("friction", self.friction, 0.0, 2.0)?;
        within("restitution", self.restitution, 0.0, 1.0)?;
        within("rolling_friction", self.rolling_friction, 0.0, 1.0)
    }

    /// Volume of a grain of the mean size, m³.
    #[must_use]
    pub fn volume_m3(&self) -> f64 {
        PI / 6.0 * self.diameter_m.powi(3)
    }

    /// Makes `collider` a wall for these grains: between the two, friction and restitution are those given.
    ///
    /// The engine combines the numbers of both sides by a rule; the side that asks for the smaller or the larger number
    /// wins over the grains' average, so the wall asks for whichever is its own.
    pub fn wall(&self, collider: ColliderBuilder, friction: f64, restitution: f64) -> ColliderBuilder {
        let rule = |wall: f64, grain: f64| {
            if wall < grain { CoefficientCombineRule::Min } else { CoefficientCombineRule::Max }
        };
        collider
            .friction(friction)
            .friction_combine_rule(rule(friction, self.friction))
            .restitution(restitution)
            .restitution_combine_rule(rule(restitution, self.restitution))
    }

    /// Radius of a grain's round parts, and half the distance between their centers, m.
    #[must_use]
    pub fn radius_and_half_length_m(&self, diameter_m: f64) -> (f64, f64) {
        match self.shape {
            GrainShape::Ball => (0.5 * diameter_m, 0.0),
            GrainShape::Capsule { aspect } => {
                // π d³/6 = π r³ (4/3 + 2 (aspect − 1))
                let radius = 0.5 * diameter_m / (1.0 + 1.5 * (aspect - 1.0)).cbrt();
                (radius, radius * (aspect - 1.0))
            }
        }
    }

    pub(super) fn collider(&self, diameter_m: f64) -> ColliderBuilder {
        let (radius, half_length) = self.radius_and_half_length_m(diameter_m);
        let shape = match self.shape {
            GrainShape::Ball => ColliderBuilder::ball(radius),
            GrainShape::Capsule { .. } => ColliderBuilder::capsule_x(half_length, radius),
        };
        shape.density(self.density_kg_per_m3).friction(self.friction).restitution(self.restitution)
    }
}
