//! Options of a transfer.

use serde::{Deserialize, Serialize};

use crate::corridor::smoothing::SmoothingConfig;
use crate::corridor_filter::CorridorFilterConfig;
use crate::field::{FieldError, not_negative, positive, within};
use crate::tool_flipping::FlipOptions;

/// Options of a transfer to another tool.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct TransferConfig {
    /// Distance of the object from obstacles, m: the paper's safe margin.
    #[schemars(range(min = 0.0, max = LARGEST_MARGIN_M))]
    pub object_margin_m: f64,
    /// Distance of the tool from obstacles, m.
    #[schemars(range(min = 0.0, max = LARGEST_MARGIN_M))]
    pub tool_margin_m: f64,
    /// What is added to both when the plan is made, m: the plan is not followed exactly.
    #[schemars(range(min = 0.0, max = LARGEST_MARGIN_M))]
    pub slack_m: f64,
    /// Gap between tool and object at the end of an approach or flip, m, which the push closes: what a camera may be off
    /// by in a direction in which nothing was touched yet.
    #[schemars(range(min = 0.0, max = LARGEST_MARGIN_M))]
    pub approach_gap_m: f64,
    /// What keeps the generalized path out of the obstacles.
    pub corridor_filter: CorridorFilterConfig,
    /// How the bounds of the obstacles are smoothed, in the time of the generalized path.
    pub smoothing: SmoothingConfig,
    /// How phases are searched for.
    pub search: SearchConfig,
    /// How the tool goes from surface to surface.
    pub flip: FlipOptions,
}

impl Default for TransferConfig {
    fn default() -> Self {
        Self {
            object_margin_m: 0.015,
            tool_margin_m: 0.003,
            slack_m: 0.001,
            approach_gap_m: 0.003,
            corridor_filter: CorridorFilterConfig::default(),
            smoothing: SmoothingConfig::default(),
            search: SearchConfig::default(),
            // a tool that is steered by what a camera sees is off by a millimeter
            flip: FlipOptions {
                margin_m: 0.006,
                least_clearance_m: 0.003,
                contact_tolerance_m: 1e-5,
                ..FlipOptions::default()
            },
        }
    }
}

/// Margins that make sense on a table, m.
const LARGEST_MARGIN_M: f64 = 1.0;

impl TransferConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("object_margin_m", self.object_margin_m, 0.0, LARGEST_MARGIN_M)?;
        within("tool_margin_m", self.tool_margin_m, 0.0, LARGEST_MARGIN_M)?;
        within("slack_m", self.slack_m, 0.0, LARGEST_MARGIN_M)?;
        within("approach_gap_m", self.approach_gap_m, 0.0, LARGEST_MARGIN_M)?;
        self.corridor_filter.validate().map_err(|error| error.within("corridor_filter"))?;
        self.smoothing.validate().map_err(|error| error.within("smoothing"))?;
        self.search.validate().map_err(|error| error.within("search"))?;
        self.flip.validate().map_err(|error| error.within("flip"))
    }
}

/// Options of the search; costs are lengths, m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SearchConfig {
    /// Side of a cell, m.
    #[schemars(range(min = 1e-5, max = 1.0))]
    pub cell_m: f64,
    /// Places on each surface that may be held, 1 to 21.
    pub places: usize,
    /// Cost per length and squared distance from the reference path, 1/m².
    #[schemars(range(min = 0.0))]
    pub deviation_per_m2: f64,
    /// Cost of a change of surface, m.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub switch_cost_m: f64,
    /// Cost per distance of a hold from the middle of its surface.
    #[schemars(range(min = 0.0))]
    pub off_center: f64,
    /// Cost per distance that the tool goes round the object in a change of surface.
    #[schemars(range(min = 0.0))]
    pub flip: f64,
}

impl Default for SearchConfig {
    fn default() -> Self {
        Self { cell_m: 0.001, places: 5, deviation_per_m2: 1500.0, switch_cost_m: 0.06, off_center: 0.5, flip: 0.3 }
    }
}

impl SearchConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("cell_m", self.cell_m, 1e-5, 1.0)?;
        if !(1..=21).contains(&self.places) {
            return Err(FieldError::new("places", self.places, "a whole number from 1 to 21"));
        }
        not_negative("deviation_per_m2", self.deviation_per_m2)?;
        positive("switch_cost_m", self.switch_cost_m)?;
        not_negative("off_center", self.off_center)?;
        not_negative("flip", self.flip)
    }
}
