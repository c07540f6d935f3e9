//! Options of the generalization of a tool flip.

use serde::{Deserialize, Serialize};

use crate::field::{FieldError, not_negative, positive};

/// Sense in which the object's center goes round the tool, seen in the tool's frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WayRound {
    /// The shorter one (default).
    #[default]
    Shorter,
    /// With the tool to the left.
    Counterclockwise,
    /// With the tool to the right.
    Clockwise,
}

/// How the factor k2 of Eq. (28) is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SecondFactor {
    /// The smallest that is certified free of collisions (default).
    #[default]
    Smallest,
    /// This one; the paper's is 1.
    Fixed(f64),
}

/// Options of the generalization of a tool flip, Eq. (28).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FlipOptions {
    /// Clearance of the virtual object movement between its ends, m: the object leaves a contact by it along the normal.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub margin_m: f64,
    /// Clearance required of the flip, m, less than `margin_m`; it rises from 0 at a contact while the object leaves it.
    #[schemars(range(min = 0.0))]
    pub least_clearance_m: f64,
    /// Overlap of tool and object allowed at a contact, m, for rounding and for how contacts were measured.
    #[schemars(range(min = FINEST_TOLERANCE_M))]
    pub contact_tolerance_m: f64,
    /// Sense in which to go round the tool.
    pub way_round: WayRound,
    /// How k2 is chosen.
    pub k2: SecondFactor,
    /// Largest k2 tried, at least 1.
    #[schemars(range(min = 1.0, max = MOST_K2))]
    pub largest_k2: f64,
    /// Whether the tool's own way x^t turns and grows with the displacement between the contacts.
    pub scale_with_displacement: bool,
}

impl Default for FlipOptions {
    fn default() -> Self {
        Self {
            margin_m: 0.0035,
            least_clearance_m: 0.001,
            contact_tolerance_m: 1e-6,
            way_round: WayRound::Shorter,
            k2: SecondFactor::Smallest,
            largest_k2: 1.5,
            scale_with_displacement: true,
        }
    }
}

/// Finest contact tolerance, m: clearances carry rounding.
const FINEST_TOLERANCE_M: f64 = 1e-9;
/// Largest factor k2 that may be tried.
const MOST_K2: f64 = 10.0;

impl FlipOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] naming the option.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("margin_m", self.margin_m)?;
        not_negative("least_clearance_m", self.least_clearance_m)?;
        if self.least_clearance_m >= self.margin_m {
            let expected = format!("less than margin_m = {}", self.margin_m);
            return Err(FieldError::new("least_clearance_m", self.least_clearance_m, expected));
        }
        crate::field::within("contact_tolerance_m", self.contact_tolerance_m, FINEST_TOLERANCE_M, self.margin_m)?;
        if let SecondFactor::Fixed(k2) = self.k2 {
            crate::field::within("k2.fixed", k2, 0.0, MOST_K2)?;
        }
        crate::field::within("largest_k2", self.largest_k2, 1.0, MOST_K2)
    }
}
