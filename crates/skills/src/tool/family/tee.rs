//! The T: a bar on a stem.

use serde::{Deserialize, Serialize};

use super::{
    SHORTEST_FACE_M, ToolShape, at_least, facing_down, facing_left, facing_right, facing_up, length, rectangle,
};
use crate::field::{FieldError, not_negative};
use crate::outline::PlacedOutline;
use crate::tool::ContactSurface;

/// Bar along x about the origin and stem along -y.
///
/// Surfaces: `top`, `left` and `right` of the bar, which push away; `bottom_left` and `bottom_right` of the bar, which pull;
/// `stem_left`, `stem_right` and `foot` of the stem.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Tee {
    /// Length of the bar, m.
    pub bar_m: f64,
    /// Length of the stem below the bar, m.
    pub stem_m: f64,
    /// Thickness of both, m.
    pub thickness_m: f64,
    /// Radius of the disc that must fit into the inner corners, m.
    pub object_radius_m: f64,
    /// Ends of each surface that are left out at outer corners, m.
    #[schemars(range(min = 0.0))]
    pub edge_margin_m: f64,
}

impl Default for Tee {
    fn default() -> Self {
        Self { bar_m: 0.040, stem_m: 0.030, thickness_m: 0.010, object_radius_m: 0.012, edge_margin_m: 0.001 }
    }
}

impl ToolShape for Tee {
    fn validate(&self) -> Result<(), FieldError> {
        length("bar_m", self.bar_m)?;
        length("stem_m", self.stem_m)?;
        length("thickness_m", self.thickness_m)?;
        length("object_radius_m", self.object_radius_m)?;
        not_negative("edge_margin_m", self.edge_margin_m)?;
        let ends_m = 2.0 * self.edge_margin_m + SHORTEST_FACE_M;
        at_least("thickness_m", self.thickness_m, ends_m, "its ends push too, less two of edge_margin_m")?;
        let inner_m = self.object_radius_m + self.edge_margin_m + SHORTEST_FACE_M;
        let over_all_m = self.thickness_m + 2.0 * inner_m;
        at_least("bar_m", self.bar_m, over_all_m, "beside the stem there must be room for object_radius_m")?;
        at_least("stem_m", self.stem_m, inner_m, "below the bar there must be room for object_radius_m")
    }

    fn pieces(&self) -> Vec<PlacedOutline> {
        let (end, half) = (self.bar_m / 2.0, self.thickness_m / 2.0);
        vec![rectangle(-end, end, -half, half), rectangle(-half, half, -half - self.stem_m, -half)]
    }

    fn surfaces(&self) -> Vec<ContactSurface> {
        let (half, margin, radius) = (self.thickness_m / 2.0, self.edge_margin_m, self.object_radius_m);
        let (end, foot) = (self.bar_m / 2.0, -half - self.stem_m);
        let (usable_end, usable_half) = (end - margin, half - margin);
        vec![
            facing_up("top", half, -usable_end, usable_end),
            facing_left("left", -end, -usable_half, usable_half),
            facing_right("right", end, -usable_half, usable_half),
            facing_down("bottom_left", -half, -usable_end, -half - radius),
            facing_down("bottom_right", -half, half + radius, usable_end),
            facing_left("stem_left", -half, foot + margin, -half - radius),
            facing_right("stem_right", half, foot + margin, -half - radius),
            facing_down("foot", foot, -usable_half, usable_half),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::family::tests::{area_m2, tool};
    use approx::assert_relative_eq;
    use nalgebra::Point2;

    #[test]
    fn the_default_t_is_a_bar_of_40_mm_on_a_stem_of_30_mm() {
        let tee = tool(&Tee::default());
        // bar 40 x 10 mm about the origin, stem 10 x 30 mm about y = -20 mm
        assert_relative_eq!(area_m2(&tee), 700e-6, epsilon = 1e-15);
        assert_relative_eq!(tee.centroid(), Point2::new(0.0, -0.020 * 300.0 / 700.0), epsilon = 1e-15);
        let lengths: Vec<f64> = tee.surfaces.iter().map(|surface| (surface.length_m() * 1e6).round() / 1e3).collect();
        assert_eq!(lengths, [38.0, 8.0, 8.0, 2.0, 2.0, 17.0, 17.0, 8.0]);
    }

    #[test]
    fn lengths_that_make_no_t_are_refused_by_name() {
        let field = |tee: Tee| tee.validate().unwrap_err().field;
        let tee = Tee::default;
        assert_eq!(field(Tee { bar_m: 0.036, ..tee() }), "bar_m");
        assert_eq!(field(Tee { stem_m: 0.013, ..tee() }), "stem_m");
        assert_eq!(field(Tee { thickness_m: 0.002, ..tee() }), "thickness_m");
        assert_eq!(field(Tee { object_radius_m: -0.012, ..tee() }), "object_radius_m");
        assert_eq!(field(Tee { edge_margin_m: f64::INFINITY, ..tee() }), "edge_margin_m");
    }
}
