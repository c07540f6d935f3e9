//! The hook: a shank, a bar and a prong around a throat that opens toward the hand.

use nalgebra::{Point2, Vector2};
use serde::{Deserialize, Serialize};

use super::{
    PLAY_M, SHORTEST_FACE_M, ToolShape, at_least, face, facing_down, facing_left, facing_right, facing_up, length,
    polygon, rectangle,
};
use crate::field::{FieldError, not_negative, within};
use crate::outline::PlacedOutline;
use crate::tool::ContactSurface;

/// Shank along y from the origin, bar to the left at its end, prong back from the bar's end.
///
/// A disc of the stated radius passes the mouth with play, and held against bar and prong it cannot drift off. Surfaces:
/// `pull`, `prong` and `shank` around the throat; `front`, `left`, `right` and `tip` outside.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Hook {
    /// Length of the shank to the inner side of the bar, m.
    pub shank_m: f64,
    /// Inner length of the bar, between shank and prong, m.
    pub throat_m: f64,
    /// Inner length of the prong, m.
    pub prong_m: f64,
    /// Inner angle between bar and prong, rad: π/3 (the mouth narrows) to π (the prong prolongs the bar).
    #[schemars(range(min = std::f64::consts::FRAC_PI_3, max = std::f64::consts::PI))]
    pub opening_angle_rad: f64,
    /// Thickness of shank, bar and prong, m.
    pub thickness_m: f64,
    /// Radius of the disc that the hook is made for, m.
    pub object_radius_m: f64,
    /// Ends of each surface that are left out at outer corners, m.
    #[schemars(range(min = 0.0))]
    pub edge_margin_m: f64,
}

impl Default for Hook {
    fn default() -> Self {
        Self {
            shank_m: 0.050,
            throat_m: 0.028,
            prong_m: 0.020,
            opening_angle_rad: std::f64::consts::FRAC_PI_2,
            thickness_m: 0.006,
            object_radius_m: 0.012,
            edge_margin_m: 0.001,
        }
    }
}

/// Corners of the prong; the inner ones are on the throat's side.
struct Prong {
    /// Direction from the bar to the tip.
    way: Vector2<f64>,
    /// Normal of the inner side: into the throat.
    normal: Vector2<f64>,
    inner_root: Point2<f64>,
    outer_root: Point2<f64>,
    outer_tip: Point2<f64>,
    inner_tip: Point2<f64>,
}

impl Hook {
    fn prong(&self) -> Prong {
        let (sin, cos) = self.opening_angle_rad.sin_cos();
        let (way, normal) = (Vector2::new(cos, -sin), Vector2::new(sin, cos));
        let inner_root = Point2::new(-self.thickness_m / 2.0 - self.throat_m, self.shank_m);
        let outward = normal * -self.thickness_m;
        // bar and prong meet in a miter
        let outer_root = inner_root + outward - way * (self.thickness_m * self.half_angle_cotangent());
        let inner_tip = inner_root + way * self.prong_m;
        Prong { way, normal, inner_root, outer_root, outer_tip: inner_tip + outward, inner_tip }
    }

    fn half_angle_cotangent(&self) -> f64 {
        (self.opening_angle_rad / 2.0).tan().recip()
    }

    /// Distance from the corner between bar and prong at which a disc that touches both touches them, m.
    fn seat_m(&self) -> f64 {
        self.object_radius_m * self.half_angle_cotangent()
    }
}

impl ToolShape for Hook {
    fn validate(&self) -> Result<(), FieldError> {
        length("shank_m", self.shank_m)?;
        length("throat_m", self.throat_m)?;
        length("prong_m", self.prong_m)?;
        within("opening_angle_rad", self.opening_angle_rad, std::f64::consts::FRAC_PI_3, std::f64::consts::PI)?;
        length("thickness_m", self.thickness_m)?;
        length("object_radius_m", self.object_radius_m)?;
        not_negative("edge_margin_m", self.edge_margin_m)?;
        let (radius, margin) = (self.object_radius_m, self.edge_margin_m);
        let caged_m = radius + radius.max(self.seat_m()) + PLAY_M;
        at_least("throat_m", self.throat_m, caged_m, "object_radius_m on either side of the disc's center, and play")?;
        let narrowing_m = (self.prong_m * self.opening_angle_rad.cos()).max(0.0);
        let mouth_m = 2.0 * radius + PLAY_M + narrowing_m;
        at_least("throat_m", self.throat_m, mouth_m, "the disc must pass between the prong's tip and the shank")?;
        let held_m = self.seat_m() + margin + SHORTEST_FACE_M;
        at_least("prong_m", self.prong_m, held_m, "it must reach past the disc's center to hold it")?;
        let inner_m = radius + margin + SHORTEST_FACE_M;
        at_least("shank_m", self.shank_m, inner_m, "it must reach past the disc's center to hold it")?;
        let ends_m = 2.0 * margin + SHORTEST_FACE_M;
        at_least("thickness_m", self.thickness_m, ends_m, "the tip pushes too, less two of edge_margin_m")
    }

    fn pieces(&self) -> Vec<PlacedOutline> {
        let half = self.thickness_m / 2.0;
        let Prong { inner_root, outer_root, outer_tip, inner_tip, .. } = self.prong();
        let right = [Point2::new(half, self.shank_m), Point2::new(half, self.shank_m + self.thickness_m)];
        vec![
            rectangle(-half, half, 0.0, self.shank_m),
            polygon([inner_root, right[0], right[1], outer_root]),
            polygon([inner_root, outer_root, outer_tip, inner_tip]),
        ]
    }

    fn surfaces(&self) -> Vec<ContactSurface> {
        let (half, margin, radius) = (self.thickness_m / 2.0, self.edge_margin_m, self.object_radius_m);
        let Prong { way, normal, inner_root, outer_root, outer_tip, inner_tip } = self.prong();
        let (inner_y, outer_y) = (self.shank_m, self.shank_m + self.thickness_m);
        vec![
            facing_down("pull", inner_y, inner_root.x + self.seat_m(), -half - radius),
            face("prong", inner_tip - way * margin, inner_root + way * self.seat_m()),
            facing_left("shank", -half, margin, inner_y - radius),
            facing_up("front", outer_y, outer_root.x + margin, half - margin),
            face("left", outer_root + way * margin, outer_tip - way * margin),
            facing_right("right", half, margin, outer_y - margin),
            face("tip", outer_tip + normal * margin, inner_tip - normal * margin),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::family::tests::{area_m2, tool};
    use approx::assert_relative_eq;

    /// A few roundings of lengths of some centimeters.
    const ROUNDING_M: f64 = 1e-15;

    #[test]
    fn the_default_hook_is_three_bars_of_6_mm_around_a_throat_of_28_mm() {
        let hook = tool(&Hook::default());
        // shank 6 x 50 about (0, 25); bar of sides 34 and 40 and prong of sides 20 and 26, both 6 thick, cut at 45 degrees
        let (shank, bar, prong) = (300.0, 222.0, 138.0);
        assert_relative_eq!(area_m2(&hook), (shank + bar + prong) * 1e-6, epsilon = 1e-15);
        // bar and prong together are a rectangle 40 x 6 about (-17, 53) and one of 6 x 20 about (-34, 40)
        let x = (240.0 * -17.0 + 120.0 * -34.0) / (shank + bar + prong) * 1e-3;
        let y = (shank * 25.0 + 240.0 * 53.0 + 120.0 * 40.0) / (shank + bar + prong) * 1e-3;
        assert_relative_eq!(hook.centroid(), Point2::new(x, y), epsilon = ROUNDING_M);
    }

    #[test]
    fn the_inner_faces_pull_back_and_to_both_sides() {
        let hook = tool(&Hook::default());
        let normals = [("pull", -Vector2::y()), ("prong", Vector2::x()), ("shank", -Vector2::x())];
        for (surface, (name, normal)) in hook.surfaces.iter().zip(normals) {
            assert_eq!(surface.name, name);
            assert_relative_eq!(surface.middle().normal.into_inner(), normal, epsilon = ROUNDING_M);
        }
    }

    #[test]
    fn a_disc_in_the_seat_touches_bar_and_prong_and_stays_off_the_shank() {
        for (opening_angle_rad, throat_m, prong_m) in [(1.1, 0.038, 0.022), (1.6, 0.028, 0.020), (2.4, 0.026, 0.015)] {
            let shape = Hook { opening_angle_rad, throat_m, prong_m, ..Hook::default() };
            let hook = tool(&shape);
            let half_m = hook.surfaces[0].length_m() / 2.0;
            // places grow to the left of the normal: for a surface that looks down, to the right
            let seat = hook.surfaces[0].contact_at(-half_m);
            let center = seat.point + seat.normal.into_inner() * 0.012;
            let prong = hook.surfaces[1].contact_at(hook.surfaces[1].length_m() / 2.0);
            assert_relative_eq!((center - prong.point).norm(), 0.012, epsilon = ROUNDING_M);
            assert_relative_eq!(hook.signed_distance_m(&center), 0.012, epsilon = ROUNDING_M);
        }
    }

    #[test]
    fn lengths_that_make_no_hook_are_refused_by_name() {
        let refused = |hook: Hook| hook.validate().unwrap_err();
        let hook = Hook::default;
        let narrow = refused(Hook { throat_m: 0.0259, ..hook() });
        assert!(narrow.field == "throat_m" && narrow.expected.contains("0.026 m"), "{narrow}");
        assert_eq!(Hook { throat_m: 0.026, ..hook() }.validate(), Ok(()));
        // a prong that leans inward by 30 degrees narrows the mouth by half its length
        let leaning = Hook { opening_angle_rad: std::f64::consts::FRAC_PI_3, prong_m: 0.024, ..hook() };
        let mouth = refused(Hook { throat_m: 0.0379, ..leaning.clone() });
        assert!(mouth.field == "throat_m" && mouth.expected.contains("0.038 m"), "{mouth}");
        assert_eq!(Hook { throat_m: 0.038, ..leaning }.validate(), Ok(()));
        assert_eq!(refused(Hook { prong_m: 0.013, ..hook() }).field, "prong_m");
        assert_eq!(refused(Hook { shank_m: 0.013, ..hook() }).field, "shank_m");
        assert_eq!(refused(Hook { thickness_m: 0.002, ..hook() }).field, "thickness_m");
        assert_eq!(refused(Hook { object_radius_m: 12.0, ..hook() }).field, "object_radius_m");
        assert_eq!(refused(Hook { edge_margin_m: -0.001, ..hook() }).field, "edge_margin_m");
        for opening_angle_rad in [1.0, 3.2, f64::NAN] {
            assert_eq!(refused(Hook { opening_angle_rad, ..hook() }).field, "opening_angle_rad");
        }
    }
}
