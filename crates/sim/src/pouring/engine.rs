//! Engine settings that make grains behave, each beside the measurement that chose it.

use rapier3d::prelude::{FrictionModel, IntegrationParameters};
use serde::{Deserialize, Serialize};
use skills::field::{FieldError, within};

/// Speed cap and push-out cap of the engine's contact solver, m/s. The engine scales both by the length unit.
const MAX_SPEED_M_PER_S: f64 = 400.0;
const MAX_PUSH_OUT_M_PER_S: f64 = 0.5;

/// How the engine solves friction between free bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FrictionScheme {
    /// One friction constraint per contact point.
    #[default]
    Coulomb,
    /// One friction constraint and one twist constraint per contact manifold.
    Simplified,
}

/// Settings of the engine for a world with grains.
///
/// Measured for the choice: processor time per grain and step, root mean square speed and deepest overlap of 300 grains
/// at rest in the cup; the mean of two heaps (real ones 24 to 30°); discharge of a small silo over Mankoc's law (seeds
/// of one setting differ by 7 to 20 %):
///
/// | setting | μs | rest, m/s | overlap, mm | heap | discharge |
/// |---|---|---|---|---|---|
/// | these defaults | 2.5 | 2e-5 | 0.08 | 23° | 0.88 |
/// | length unit 0.02 m | 2.7 | 6e-6 | 0.07 | 26° | 1.01 |
/// | 200/400 Hz | 2.3 | 2e-6 | 0.13 | 25° | 1.00 |
/// | 480/480 Hz | 2.3 | 9e-6 | 0.03 | 25° | 0.99 |
/// | simplified friction | 2.5 | 4e-5 | 0.08 | 26° | 0.90 |
///
/// None stands out beyond the scatter of heaps (1.5°) and discharges, so accuracy of single contacts decides: 240 Hz is the
/// softest that keeps a column of 15 grains within 2 % overlap (0.12 mm) by the contact's closed form, and Coulomb's
/// law holds at every point of a wall. Without recycling the cost at rest is about 1.4 times as high.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GrainEngineConfig {
    /// Time step of the engine, s.
    pub time_step_s: f64,
    /// Solver substeps within one time step.
    pub substeps: usize,
    /// Size of the objects that the engine's tolerances are scaled to, m.
    pub length_unit_m: f64,
    /// Stiffness of contacts as a natural frequency, Hz; a quarter of the substep rate is the most that is solved well.
    pub contact_frequency_hz: f64,
    /// The same for contacts with fixed bodies, Hz.
    pub static_contact_frequency_hz: f64,
    /// Whether contacts of pairs that hardly moved are kept instead of determined anew.
    pub contact_recycling: bool,
    /// How friction is solved.
    pub friction: FrictionScheme,
}

impl Default for GrainEngineConfig {
    fn default() -> Self {
        Self {
            time_step_s: 0.002,
            substeps: 4,
            length_unit_m: 0.01,
            contact_frequency_hz: 240.0,
            static_contact_frequency_hz: 480.0,
            contact_recycling: true,
            friction: FrictionScheme::Coulomb,
        }
    }
}

impl GrainEngineConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("time_step_s", self.time_step_s, 1e-5, 0.01)?;
        if !(1..=64).contains(&self.substeps) {
            return Err(FieldError::new("substeps", self.substeps, "a number from 1 to 64"));
        }
        within("length_unit_m", self.length_unit_m, 1e-3, 1.0)?;
        within("contact_frequency_hz", self.contact_frequency_hz, 10.0, 10_000.0)?;
        within("static_contact_frequency_hz", self.static_contact_frequency_hz, 10.0, 10_000.0)
    }

    /// Writes these settings into the engine's parameters; what they do not name stays as it is.
    pub fn apply(&self, parameters: &mut IntegrationParameters) {
        parameters.dt = self.time_step_s;
        parameters.num_solver_iterations = self.substeps;
        parameters.length_unit = self.length_unit_m;
        parameters.normalized_max_linear_velocity = MAX_SPEED_M_PER_S / self.length_unit_m;
        parameters.normalized_max_corrective_velocity = MAX_PUSH_OUT_M_PER_S / self.length_unit_m;
        parameters.contact_softness.natural_frequency = self.contact_frequency_hz;
        parameters.static_contact_softness.natural_frequency = self.static_contact_frequency_hz;
        parameters.contact_recycling = self.contact_recycling;
        parameters.friction_model = match self.friction {
            FrictionScheme::Coulomb => FrictionModel::Coulomb,
            FrictionScheme::Simplified => FrictionModel::Simplified,
        };
        // walls are thicker than what a grain travels in a step: sweeps would cost time and change nothing
        parameters.max_ccd_substeps = 0;
    }
}
