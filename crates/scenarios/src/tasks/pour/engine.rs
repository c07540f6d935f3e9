//! How time advances in a pour: one step for arm and grains.

use serde::{Deserialize, Serialize};
use sim::pouring::{FrictionScheme, GrainEngineConfig};
use sim::spatial::EngineConfig;
use skills::field::FieldError;

/// Time steps and contact solver of a pour.
///
/// The steps are those that grains were validated with, 2 ms of 4 substeps. The controller sets its torques once per step, at
/// 500 Hz, because a torque cannot change within one. Measured of 300 beans into the bowl, processor time against a substep of half
/// a millisecond in all of them: at 1 ms and 2 substeps 1.3 times real time, the tool within 0.015 mm of its reference; at
/// 2 ms and 4 substeps 2.2 times and 0.017 mm. What a step costs besides its substeps (contacts sought and warmed up,
/// rolling resistance, monitor) is spent half as often; contacts stay as stiff, the arm's equations are solved as finely.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PourEngineConfig {
    /// Time step of the physics, s; the control period is a whole multiple of it.
    pub time_step_s: f64,
    /// Time between two torques of the controller, s.
    pub control_period_s: f64,
    /// Substeps of the solver within a time step.
    pub substeps: usize,
    /// Size of the objects that the engine's tolerances are scaled to, m.
    pub length_unit_m: f64,
    /// Natural frequency of contacts between grains and with the cup, Hz.
    pub contact_frequency_hz: f64,
    /// The same for contacts with table and target, Hz.
    pub static_contact_frequency_hz: f64,
    /// Whether contacts of pairs that hardly moved are kept instead of determined anew.
    pub contact_recycling: bool,
    /// How friction is solved.
    pub friction: FrictionScheme,
}

impl Default for PourEngineConfig {
    fn default() -> Self {
        let grains = GrainEngineConfig::default();
        Self {
            time_step_s: grains.time_step_s,
            control_period_s: grains.time_step_s,
            substeps: grains.substeps,
            length_unit_m: grains.length_unit_m,
            contact_frequency_hz: grains.contact_frequency_hz,
            static_contact_frequency_hz: grains.static_contact_frequency_hz,
            contact_recycling: grains.contact_recycling,
            friction: grains.friction,
        }
    }
}

impl PourEngineConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.grains().validate()?;
        self.arm().validate()
    }

    /// As grains need it.
    #[must_use]
    pub fn grains(&self) -> GrainEngineConfig {
        GrainEngineConfig {
            time_step_s: self.time_step_s,
            substeps: self.substeps,
            length_unit_m: self.length_unit_m,
            contact_frequency_hz: self.contact_frequency_hz,
            static_contact_frequency_hz: self.static_contact_frequency_hz,
            contact_recycling: self.contact_recycling,
            friction: self.friction,
        }
    }

    /// As the arm's loop needs it.
    #[must_use]
    pub fn arm(&self) -> EngineConfig {
        EngineConfig {
            time_step_s: self.time_step_s,
            control_period_s: self.control_period_s,
            substeps: self.substeps,
            contact_frequency_hz: self.contact_frequency_hz,
            length_unit_m: self.length_unit_m,
            contact_recycling: self.contact_recycling,
        }
    }
}
