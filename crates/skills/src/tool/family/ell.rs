//! The L: two arms at a right angle, tool 2 of Table 1.

use serde::{Deserialize, Serialize};

use super::{SHORTEST_FACE_M, ToolShape, at_least, at_most, facing_down, facing_left, facing_up, length, rectangle};
use crate::field::{FieldError, not_negative};
use crate::outline::PlacedOutline;
use crate::tool::ContactSurface;

/// Arm along -x and stem along -y; the origin is the middle of the square in which they meet.
///
/// Surfaces: `bottom`, `tip` and `top` of the arm, the surfaces 1, 2 and 3 of Fig. 4, of which `bottom` and `top` begin at
/// the arm's end; with a `stem_length_m` also `stem`, the inner side of the stem from its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Ell {
    /// Length of the arm over all, m.
    pub arm_m: f64,
    /// Length of the stem over all, m.
    pub stem_m: f64,
    /// Thickness of both, m; not in the paper.
    pub thickness_m: f64,
    /// Usable length of the arm's lower side, m.
    pub bottom_length_m: f64,
    /// Usable length of the middle of the arm's end, m.
    pub tip_length_m: f64,
    /// Usable length of the arm's upper side, m.
    pub top_length_m: f64,
    /// Usable length of the stem's left side, m; 0 for none.
    #[schemars(range(min = 0.0))]
    pub stem_length_m: f64,
}

impl Default for Ell {
    /// Table 1, with a thickness that leaves room for its object beside the stem.
    fn default() -> Self {
        Self {
            arm_m: 0.040,
            stem_m: 0.040,
            thickness_m: 0.012,
            bottom_length_m: 0.015,
            tip_length_m: 0.010,
            top_length_m: 0.020,
            stem_length_m: 0.0,
        }
    }
}

impl Ell {
    /// Half the thickness: coordinate of the outer sides.
    fn half(&self) -> f64 {
        self.thickness_m / 2.0
    }
}

impl ToolShape for Ell {
    fn validate(&self) -> Result<(), FieldError> {
        length("arm_m", self.arm_m)?;
        length("stem_m", self.stem_m)?;
        length("thickness_m", self.thickness_m)?;
        let inner = |outer: f64| outer - self.thickness_m;
        at_least("arm_m", self.arm_m, self.thickness_m + SHORTEST_FACE_M, "more than thickness_m")?;
        at_least("stem_m", self.stem_m, self.thickness_m + SHORTEST_FACE_M, "more than thickness_m")?;
        let lengths = [
            ("bottom_length_m", self.bottom_length_m, inner(self.arm_m), "arm_m less thickness_m"),
            ("tip_length_m", self.tip_length_m, self.thickness_m, "thickness_m"),
            ("top_length_m", self.top_length_m, self.arm_m, "arm_m"),
        ];
        for (field, value, most_m, reason) in lengths {
            length(field, value)?;
            at_least(field, value, SHORTEST_FACE_M, "the shortest surface")?;
            at_most(field, value, most_m, reason)?;
        }
        not_negative("stem_length_m", self.stem_length_m)?;
        if self.stem_length_m > 0.0 {
            at_least("stem_length_m", self.stem_length_m, SHORTEST_FACE_M, "the shortest surface, or 0 for none")?;
        }
        at_most("stem_length_m", self.stem_length_m, inner(self.stem_m), "stem_m less thickness_m")
    }

    fn pieces(&self) -> Vec<PlacedOutline> {
        let half = self.half();
        let arm = rectangle(half - self.arm_m, half, -half, half);
        let stem = rectangle(-half, half, half - self.stem_m, -half);
        vec![arm, stem]
    }

    fn surfaces(&self) -> Vec<ContactSurface> {
        let half = self.half();
        let (end, foot, middle) = (half - self.arm_m, half - self.stem_m, self.tip_length_m / 2.0);
        let mut surfaces = vec![
            facing_down("bottom", -half, end, end + self.bottom_length_m),
            facing_left("tip", end, -middle, middle),
            facing_up("top", half, end, end + self.top_length_m),
        ];
        if self.stem_length_m > 0.0 {
            surfaces.push(facing_left("stem", -half, foot, foot + self.stem_length_m));
        }
        surfaces
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::family::tests::{area_m2, tool};
    use approx::assert_relative_eq;
    use nalgebra::{Point2, Vector2};

    /// A few roundings of lengths of some centimeters.
    const ROUNDING_M: f64 = 1e-15;

    #[test]
    fn the_default_l_has_the_numbers_of_table_1() {
        let ell = tool(&Ell::default());
        // 40 x 40 mm over all, the actuator in the middle of the corner
        for corner in [[-34.0, 6.0], [6.0, 6.0], [6.0, -34.0], [-6.0, -34.0], [-6.0, -6.0], [-34.0, -6.0]] {
            let corner = Point2::from(Vector2::from(corner) * 1e-3);
            assert!(ell.signed_distance_m(&corner).abs() < ROUNDING_M, "{corner}");
        }
        // name, length, middle and normal of each surface
        let expected = [
            ("bottom", 0.015, [-0.0265, -0.006], [0.0, -1.0]),
            ("tip", 0.010, [-0.034, 0.0], [-1.0, 0.0]),
            ("top", 0.020, [-0.024, 0.006], [0.0, 1.0]),
        ];
        assert_eq!(ell.surfaces.len(), expected.len());
        for (surface, (name, length_m, middle, normal)) in ell.surfaces.iter().zip(expected) {
            assert_eq!(surface.name, name);
            assert_relative_eq!(surface.length_m(), length_m, epsilon = ROUNDING_M);
            assert_relative_eq!(surface.middle().point, Point2::from(middle), epsilon = ROUNDING_M);
            assert_relative_eq!(surface.middle().normal.into_inner(), Vector2::from(normal), epsilon = ROUNDING_M);
        }
    }

    #[test]
    fn the_default_l_balances_on_its_diagonal() {
        let ell = tool(&Ell::default());
        // arm 40 x 12 mm about x = -14 mm, rest of the stem 28 x 12 mm about y = -20 mm
        assert_relative_eq!(area_m2(&ell), 816e-6, epsilon = 1e-15);
        let lever_m = -0.014 * 480.0 / 816.0;
        assert_relative_eq!(ell.centroid(), Point2::new(lever_m, lever_m), epsilon = ROUNDING_M);
    }

    #[test]
    fn a_stem_surface_pushes_to_the_left_from_the_stems_end() {
        let ell = tool(&Ell { stem_length_m: 0.016, ..Ell::default() });
        let stem = &ell.surfaces[3];
        assert_eq!(stem.name, "stem");
        assert_relative_eq!(stem.middle().point, Point2::new(-0.006, -0.026), epsilon = ROUNDING_M);
        assert_relative_eq!(stem.middle().normal.into_inner(), -Vector2::x(), epsilon = ROUNDING_M);
    }

    #[test]
    fn lengths_that_make_no_l_are_refused_by_name() {
        let field = |ell: Ell| ell.validate().unwrap_err().field;
        let ell = Ell::default;
        assert_eq!(field(Ell { arm_m: 40.0, ..ell() }), "arm_m");
        assert_eq!(field(Ell { stem_m: 0.012, ..ell() }), "stem_m");
        assert_eq!(field(Ell { thickness_m: 0.0, ..ell() }), "thickness_m");
        assert_eq!(field(Ell { bottom_length_m: 0.0281, ..ell() }), "bottom_length_m");
        assert_eq!(field(Ell { tip_length_m: 0.0121, ..ell() }), "tip_length_m");
        assert_eq!(field(Ell { top_length_m: 0.0401, ..ell() }), "top_length_m");
        for stem_length_m in [-0.001, 0.0001, 0.0281, f64::NAN] {
            assert_eq!(field(Ell { stem_length_m, ..ell() }), "stem_length_m");
        }
    }
}
