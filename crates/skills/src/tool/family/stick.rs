//! The stick: a shaft with a round head, tool 1 of Table 1.

use serde::{Deserialize, Serialize};

use super::{SHORTEST_FACE_M, ToolShape, at_least, at_most, facing_left, length, rectangle};
use crate::field::{FieldError, within};
use crate::outline::{Outline, PlacedOutline};
use crate::tool::{ContactSurface, SurfaceShape};

/// Shaft along y with a round head; the origin is the middle of its rear end.
///
/// Surfaces: `side` to the left, up to the head; `head`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Stick {
    /// Length with the head, m.
    pub length_m: f64,
    /// Width of the shaft, m.
    pub width_m: f64,
    /// Radius of the head, m; at most half the width.
    pub head_radius_m: f64,
    /// Largest usable angle on the head to either side of +y, rad.
    #[schemars(range(min = SMALLEST_ANGLE_RAD, max = std::f64::consts::FRAC_PI_2))]
    pub head_half_angle_rad: f64,
    /// Usable length of the left side, from the middle of the head to the rear, m.
    pub side_length_m: f64,
}

impl Default for Stick {
    /// Table 1.
    fn default() -> Self {
        Self { length_m: 0.030, width_m: 0.012, head_radius_m: 0.006, head_half_angle_rad: 0.08, side_length_m: 0.010 }
    }
}

impl ToolShape for Stick {
    fn validate(&self) -> Result<(), FieldError> {
        length("length_m", self.length_m)?;
        length("width_m", self.width_m)?;
        length("head_radius_m", self.head_radius_m)?;
        length("side_length_m", self.side_length_m)?;
        at_most("head_radius_m", self.head_radius_m, self.width_m / 2.0, "half of width_m")?;
        at_least("side_length_m", self.side_length_m, SHORTEST_FACE_M, "the shortest surface")?;
        let shaft_m = self.length_m - self.head_radius_m;
        at_most("side_length_m", self.side_length_m, shaft_m, "length_m less head_radius_m")?;
        within("head_half_angle_rad", self.head_half_angle_rad, SMALLEST_ANGLE_RAD, std::f64::consts::FRAC_PI_2)
    }

    fn pieces(&self) -> Vec<PlacedOutline> {
        let half = self.width_m / 2.0;
        let shaft_m = self.length_m - self.head_radius_m;
        let shape = Outline::Disc { radius_m: self.head_radius_m };
        let head = PlacedOutline { shape, position_m: [0.0, shaft_m], angle_rad: 0.0 };
        vec![rectangle(-half, half, 0.0, shaft_m), head]
    }

    fn surfaces(&self) -> Vec<ContactSurface> {
        let shaft_m = self.length_m - self.head_radius_m;
        let head = SurfaceShape::Arc {
            center_m: [0.0, shaft_m],
            radius_m: self.head_radius_m,
            direction_rad: std::f64::consts::FRAC_PI_2,
            half_angle_rad: self.head_half_angle_rad,
        };
        let side = facing_left("side", -self.width_m / 2.0, shaft_m - self.side_length_m, shaft_m);
        vec![side, ContactSurface::new("head", head)]
    }
}

/// Smallest usable angle on a head, rad.
const SMALLEST_ANGLE_RAD: f64 = 1e-3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::family::tests::{tool, top_arc};
    use approx::assert_relative_eq;

    /// A few roundings of lengths of some centimeters.
    const ROUNDING_M: f64 = 1e-15;

    #[test]
    fn the_default_stick_has_the_numbers_of_table_1() {
        let stick = tool(&Stick::default());
        // the shaft and the whole disc of the head, whose rear half lies on it
        let disc_m2 = std::f64::consts::PI * 0.006 * 0.006;
        let area: f64 = stick.pieces.iter().map(|piece| piece.shape.area_m2()).sum();
        assert_relative_eq!(area, 0.012 * 0.024 + disc_m2, epsilon = 1e-15);
        let height = (0.012 * 0.024 * 0.012 + disc_m2 * 0.024) / area;
        assert_relative_eq!(stick.centroid(), nalgebra::Point2::new(0.0, height), epsilon = ROUNDING_M);
        let SurfaceShape::Face { start_m, end_m } = stick.surfaces[0].shape else { panic!("a face") };
        assert_relative_eq!(start_m[..], [-0.006, 0.024], epsilon = ROUNDING_M);
        assert_relative_eq!(end_m[..], [-0.006, 0.014], epsilon = ROUNDING_M);
        let (center_m, radius_m, half_angle_rad) = top_arc(&stick.surfaces[1]);
        assert_relative_eq!(center_m[..], [0.0, 0.024], epsilon = ROUNDING_M);
        assert_eq!((radius_m, half_angle_rad), (0.006, 0.08));
    }

    #[test]
    fn lengths_that_make_no_stick_are_refused_by_name() {
        let field = |stick: Stick| stick.validate().unwrap_err().field;
        let stick = Stick::default;
        assert_eq!(field(Stick { length_m: f64::NAN, ..stick() }), "length_m");
        assert_eq!(field(Stick { width_m: 12.0, ..stick() }), "width_m");
        assert_eq!(field(Stick { head_radius_m: 0.0061, ..stick() }), "head_radius_m");
        assert_eq!(field(Stick { head_half_angle_rad: 0.0, ..stick() }), "head_half_angle_rad");
        assert_eq!(field(Stick { side_length_m: 0.0241, ..stick() }), "side_length_m");
    }
}
