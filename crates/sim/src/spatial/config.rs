//! How time advances in a spatial scene, and how the engine solves contacts.

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, positive, within};

/// Rounding of decimal numbers in a ratio of two times.
const WHOLE_STEPS: f64 = 1e-6;

/// Time steps and contact solver of a spatial scene.
///
/// Two substeps of half a millisecond are the default: computed torque tracks sinusoids of 0.3 rad at 0.3 to 0.9 Hz within
/// 1.9e-4 rad (root mean square) with one, 9.7e-5 with two and 5.9e-5 with four, at about one, two and four times the engine's
/// cost; torques held for a millisecond leave 1.2e-4 of an ideal arm, so that more than two gain little.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct EngineConfig {
    /// Time step of the physics, s; the control period is a whole multiple of it.
    #[schemars(range(min = 1e-6, max = 0.01))]
    pub time_step_s: f64,
    /// Time between two torques of the controller, s.
    #[schemars(range(max = 0.1))]
    pub control_period_s: f64,
    /// Substeps of the solver within a time step: the arm's equations are evaluated anew in each.
    pub substeps: usize,
    /// Natural frequency of contacts, Hz: a contact under load gives way by the load's acceleration over (2πf)².
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub contact_frequency_hz: f64,
    /// Size of the smallest features, m: scales the engine's tolerances.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length_unit_m: f64,
    /// Whether contacts that barely moved keep their points: quieter piles of grains, but stale normals on round tools.
    pub contact_recycling: bool,
}

impl Default for EngineConfig {
    fn default() -> Self {
        Self {
            time_step_s: 0.001,
            control_period_s: 0.001,
            substeps: 2,
            contact_frequency_hz: 300.0,
            length_unit_m: 0.02,
            contact_recycling: false,
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
