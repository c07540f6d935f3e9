//! What a planar scene is made of, as a scenario states it.

use nalgebra::{Isometry2, Point2, Vector2};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, finite, positive, within};
use skills::outline::{Outline, PlacedOutline};

use crate::support::SupportModel;

/// The table seen from above: map bounds, gravity into the table, fixed obstacles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WorldConfig {
    /// Area in which the object may be, world frame.
    pub map: MapBounds,
    /// Gravity into the table, m/s².
    #[serde(default = "standard_gravity")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gravity_m_per_s2: f64,
    /// Fixed obstacles.
    #[serde(default)]
    pub obstacles: Vec<Obstacle>,
}

fn standard_gravity() -> f64 {
    9.81
}

/// An axis-aligned rectangle in the world frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MapBounds {
    /// Lower left corner, m.
    pub min_m: [f64; 2],
    /// Upper right corner, m.
    pub max_m: [f64; 2],
}

impl MapBounds {
    /// Length of the longer side, m.
    #[must_use]
    pub fn size_m(&self) -> f64 {
        (Vector2::from(self.max_m) - Vector2::from(self.min_m)).max()
    }

    /// Smallest distance of a point from the bounds, m: negative outside.
    #[must_use]
    pub fn margin_m(&self, point: &Point2<f64>) -> f64 {
        let low = point - Point2::from(self.min_m);
        let high = Point2::from(self.max_m) - point;
        low.x.min(low.y).min(high.x).min(high.y)
    }
}

/// A fixed, named obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Obstacle {
    /// Name, as reports call it.
    pub name: String,
    /// Outline in its own frame.
    pub shape: Outline,
    /// Position of its frame in the world, m.
    pub position_m: [f64; 2],
    /// Rotation of its frame in the world, rad.
    #[serde(default)]
    pub angle_rad: f64,
    /// Coefficient of friction against the object; against the tool, the larger of this and the tool's.
    #[serde(default = "default_obstacle_friction")]
    pub friction: f64,
}

fn default_obstacle_friction() -> f64 {
    0.3
}

impl Obstacle {
    /// The obstacle's outline at its pose in the world.
    #[must_use]
    pub fn placed(&self) -> PlacedOutline {
        PlacedOutline { shape: self.shape.clone(), position_m: self.position_m, angle_rad: self.angle_rad }
    }
}

/// The object that is pushed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjectConfig {
    /// Name, as reports call it.
    #[serde(default = "default_object_name")]
    pub name: String,
    /// Outline in its own frame.
    pub shape: Outline,
    /// Mass, kg.
    #[schemars(range(max = LARGEST_MASS_KG), extend("exclusiveMinimum" = 0))]
    pub mass_kg: f64,
    /// Coefficient of friction between the object and the table.
    #[schemars(range(min = 0.0, max = 5.0))]
    pub table_friction: f64,
    /// Law of friction on the table.
    #[serde(default)]
    pub support: SupportModel,
}

fn default_object_name() -> String {
    "object".into()
}

/// Largest mass of what is pushed over a table, kg.
const LARGEST_MASS_KG: f64 = 1000.0;

impl WorldConfig {
    /// Checks bounds and obstacles.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("map.min_m", &self.map.min_m)?;
        finite("map.max_m", &self.map.max_m)?;
        let size = Vector2::from(self.map.max_m) - Vector2::from(self.map.min_m);
        if size.min() <= 0.0 {
            let found = format!("{:?}, which is not above min_m = {:?}", self.map.max_m, self.map.min_m);
            return Err(FieldError::new("map.max_m", found, "a corner above and to the right of min_m"));
        }
        positive("gravity_m_per_s2", self.gravity_m_per_s2)?;
        for (index, obstacle) in self.obstacles.iter().enumerate() {
            let at = |error: FieldError| error.within(format!("obstacles.{index}"));
            obstacle.placed().validate().map_err(at)?;
            within("friction", obstacle.friction, 0.0, 5.0).map_err(at)?;
        }
        Ok(())
    }

    /// Smallest distance between the outline at `pose` and an obstacle (negative when they overlap) with its index, m.
    #[must_use]
    pub fn clearance_m(&self, outline: &Outline, pose: &Isometry2<f64>) -> Option<(usize, f64)> {
        let clearances = self.obstacles.iter().enumerate().filter_map(|(index, obstacle)| {
            Some((index, skills::outline::separation_m(outline, pose, &obstacle.shape, &obstacle.placed().pose())?))
        });
        clearances.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

impl ObjectConfig {
    /// Checks outline, mass and friction.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.shape.validate().map_err(|error| error.within("shape"))?;
        positive("mass_kg", self.mass_kg)?;
        within("mass_kg", self.mass_kg, 0.0, LARGEST_MASS_KG)?;
        within("table_friction", self.table_friction, 0.0, 5.0)?;
        self.support.validate().map_err(|error| error.within("support"))
    }
}

/// Rounding of decimal numbers in a ratio of two times.
const WHOLE_STEPS: f64 = 1e-6;

/// How time advances and how the engine solves contacts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EngineConfig {
    /// Time step of the physics, s; the control period is a whole multiple of it.
    #[schemars(range(min = 1e-6, max = 0.01))]
    pub time_step_s: f64,
    /// Time between two torques of the controller, s.
    #[schemars(range(max = 0.1))]
    pub control_period_s: f64,
    /// Substeps of the contact solver within a time step.
    pub substeps: usize,
    /// Natural frequency of contacts, Hz: a contact under load gives way by the load's acceleration over (2πf)².
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub contact_frequency_hz: f64,
    /// Size of the smallest features, m: scales the engine's tolerances.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length_unit_m: f64,
}

impl Default for EngineConfig {
    fn default() -> Self {
        Self {
            time_step_s: 0.0005,
            control_period_s: 0.001,
            substeps: 1,
            contact_frequency_hz: 300.0,
            length_unit_m: 0.02,
        }
    }
}

impl EngineConfig {
    /// Time steps of the physics in a control period.
    #[must_use]
    pub fn steps_per_period(&self) -> usize {
        (self.control_period_s / self.time_step_s).round().max(1.0) as usize
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("time_step_s", self.time_step_s, 1e-6, 0.01)?;
        within("control_period_s", self.control_period_s, self.time_step_s, 0.1)?;
        let steps = self.control_period_s / self.time_step_s;
        if (steps - steps.round()).abs() > WHOLE_STEPS {
            let found = format!(
                "{} s, which goes {steps:.3} times into a control period of {} s",
                self.time_step_s, self.control_period_s
            );
            return Err(FieldError::new(
                "time_step_s",
                found,
                "a time step that divides control_period_s without a rest",
            ));
        }
        positive("contact_frequency_hz", self.contact_frequency_hz)?;
        positive("length_unit_m", self.length_unit_m)?;
        if (1..=64).contains(&self.substeps) {
            Ok(())
        } else {
            Err(FieldError::new("substeps", self.substeps, "a number from 1 to 64"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_step_must_divide_the_control_period() {
        assert!(EngineConfig::default().validate().is_ok());
        assert!(EngineConfig { time_step_s: 0.001 / 3.0, ..EngineConfig::default() }.validate().is_ok());
        let refused = EngineConfig { time_step_s: 0.0007, ..EngineConfig::default() }.validate().unwrap_err();
        assert_eq!(refused.field, "time_step_s");
        let refused = EngineConfig { time_step_s: 0.002, ..EngineConfig::default() }.validate().unwrap_err();
        assert_eq!(refused.field, "control_period_s");
    }
}
