//! What counts as spilt, as tilted and as a clog.

use serde::{Deserialize, Serialize};
use skills::field::{FieldError, finite, positive, within};

/// Limits of the classification.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MonitorConfig {
    /// A grain outside both containers whose center is lower than this is spilt, m, world z.
    pub spilt_below_m: f64,
    /// A grain outside both containers that is slower than this, m/s, for [`Self::rest_s`] is spilt wherever it lies.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub rest_m_per_s: f64,
    /// See [`Self::rest_m_per_s`], s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub rest_s: f64,
    /// Tilt of the source above which a stopped flow may be a clog, rad.
    #[schemars(range(min = 0.0, max = std::f64::consts::PI))]
    pub tilted_rad: f64,
    /// Time without flow that is a clog, s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub clog_s: f64,
    /// A source with no more than this share of the grains left is empty and cannot clog.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub empty_share: f64,
    /// Interval that the flow is averaged over, s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub flow_interval_s: f64,
    /// Time off the rim after which the next touch counts again, s.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub rim_pause_s: f64,
}

impl Default for MonitorConfig {
    fn default() -> Self {
        Self {
            spilt_below_m: 0.01,
            rest_m_per_s: 0.02,
            rest_s: 0.25,
            tilted_rad: 0.7,
            clog_s: 0.6,
            empty_share: 0.02,
            flow_interval_s: 0.2,
            rim_pause_s: 0.05,
        }
    }
}

impl MonitorConfig {
    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("spilt_below_m", &[self.spilt_below_m])?;
        positive("rest_m_per_s", self.rest_m_per_s)?;
        positive("rest_s", self.rest_s)?;
        within("tilted_rad", self.tilted_rad, 0.0, std::f64::consts::PI)?;
        positive("clog_s", self.clog_s)?;
        within("empty_share", self.empty_share, 0.0, 1.0)?;
        positive("flow_interval_s", self.flow_interval_s)?;
        positive("rim_pause_s", self.rim_pause_s)
    }
}
