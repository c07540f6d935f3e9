//! Numbers of the synthetic human, with their sources.

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, not_negative, positive, within};

/// How a synthetic human sees, decides and moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct HumanConfig {
    /// Delay from seeing to acting, s.
    #[schemars(range(min = 0.0, max = 2.0))]
    pub reaction_s: f64,
    /// Correction speed per seen error, 1/s.
    #[schemars(range(min = 0.0))]
    pub gain_per_s: f64,
    /// Speed of the hand while it pushes, m/s.
    #[schemars(range(min = SLOWEST_M_PER_S, max = FASTEST_M_PER_S))]
    pub push_speed_m_per_s: f64,
    /// Speed of the hand while it approaches a contact, m/s.
    #[schemars(range(min = SLOWEST_M_PER_S, max = FASTEST_M_PER_S))]
    pub approach_speed_m_per_s: f64,
    /// Speed of the hand through free space, m/s.
    #[schemars(range(min = SLOWEST_M_PER_S, max = FASTEST_M_PER_S))]
    pub free_speed_m_per_s: f64,
    /// Clearance that the hand keeps while it goes round the object, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub detour_m: f64,
    /// Noise of the hand's velocity per speed (signal-dependent noise; Harris and Wolpert 1998).
    #[schemars(range(min = 0.0, max = 1.0))]
    pub velocity_noise: f64,
    /// Constant noise of the hand's velocity, m/s.
    #[schemars(range(min = 0.0))]
    pub constant_noise_m_per_s: f64,
    /// Root mean square of the tremor at 8–12 Hz, m (Riviere, Rader and Khosla 1997: 0.05–0.15 mm in fine work).
    #[schemars(range(min = 0.0))]
    pub tremor_m: f64,
    /// Median pause at a change of contact, s.
    #[schemars(range(min = 0.0, max = 10.0))]
    pub pause_s: f64,
    /// Offset of the object from the middle of the surface at which the human lets go and takes hold again, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub recontact_m: f64,
    /// Coefficient of variation between trials of speeds and gains.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub trial_variation: f64,
    /// Mass of the hand, kg.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub hand_mass_kg: f64,
    /// Stiffness of the hand, N/m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub hand_stiffness_n_per_m: f64,
    /// A trial that leaves the object farther than this from where it was wanted has failed, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub satisfied_m: f64,
    /// A trial that takes longer has failed, s.
    #[schemars(range(min = 0.1, max = LONGEST_PATIENCE_S))]
    pub patience_s: f64,
}

impl Default for HumanConfig {
    fn default() -> Self {
        Self {
            reaction_s: 0.18,
            gain_per_s: 3.0,
            push_speed_m_per_s: 0.030,
            approach_speed_m_per_s: 0.025,
            free_speed_m_per_s: 0.080,
            detour_m: 0.020,
            velocity_noise: 0.10,
            constant_noise_m_per_s: 0.0015,
            tremor_m: 0.00008,
            pause_s: 0.25,
            recontact_m: 0.004,
            trial_variation: 0.07,
            hand_mass_kg: 0.3,
            hand_stiffness_n_per_m: 200.0,
            satisfied_m: 0.006,
            patience_s: 60.0,
        }
    }
}

/// Speeds of a hand, m/s, and the longest trial, s.
const SLOWEST_M_PER_S: f64 = 1e-3;
const FASTEST_M_PER_S: f64 = 2.0;
const LONGEST_PATIENCE_S: f64 = 3600.0;

impl HumanConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("reaction_s", self.reaction_s, 0.0, 2.0)?;
        not_negative("gain_per_s", self.gain_per_s)?;
        within("push_speed_m_per_s", self.push_speed_m_per_s, SLOWEST_M_PER_S, FASTEST_M_PER_S)?;
        within("approach_speed_m_per_s", self.approach_speed_m_per_s, SLOWEST_M_PER_S, FASTEST_M_PER_S)?;
        within("free_speed_m_per_s", self.free_speed_m_per_s, SLOWEST_M_PER_S, FASTEST_M_PER_S)?;
        positive("detour_m", self.detour_m)?;
        within("velocity_noise", self.velocity_noise, 0.0, 1.0)?;
        not_negative("constant_noise_m_per_s", self.constant_noise_m_per_s)?;
        not_negative("tremor_m", self.tremor_m)?;
        within("pause_s", self.pause_s, 0.0, 10.0)?;
        positive("recontact_m", self.recontact_m)?;
        within("trial_variation", self.trial_variation, 0.0, 0.5)?;
        positive("hand_mass_kg", self.hand_mass_kg)?;
        positive("hand_stiffness_n_per_m", self.hand_stiffness_n_per_m)?;
        positive("satisfied_m", self.satisfied_m)?;
        within("patience_s", self.patience_s, 0.1, LONGEST_PATIENCE_S)
    }
}
