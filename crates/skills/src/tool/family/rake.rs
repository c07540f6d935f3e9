//! The rake: a bar with round-tipped tines that hold a disc between them.

use serde::{Deserialize, Serialize};

use super::{
    PLAY_M, SHORTEST_FACE_M, ToolShape, at_least, facing_down, facing_left, facing_right, facing_up, length, rectangle,
};
use crate::field::{FieldError, not_negative};
use crate::outline::{Outline, PlacedOutline};
use crate::tool::ContactSurface;

/// Bar along x about the origin, tines along -y: it pulls toward the hand, which holds it from above.
///
/// A disc of the stated radius fits between neighboring tines with play, and cannot drift off. Surfaces: for each gap, from
/// the left, `gap_1` on the bar, which pulls, `gap_1_left` and `gap_1_right` on the tines beside it; `front`, `left` and
/// `right` outside.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Rake {
    /// Number of tines, 2 to 5.
    pub tines: u32,
    /// Clear width between neighboring tines, m.
    pub throat_m: f64,
    /// Length of the tines below the bar with their tips, m.
    pub tine_length_m: f64,
    /// Radius of the tines' tips, m: half their width.
    pub tine_radius_m: f64,
    /// Thickness of the bar, m.
    pub thickness_m: f64,
    /// Radius of the disc that the rake is made for, m.
    pub object_radius_m: f64,
    /// Ends of each surface that are left out at outer corners and tips, m.
    #[schemars(range(min = 0.0))]
    pub edge_margin_m: f64,
}

impl Default for Rake {
    fn default() -> Self {
        Self {
            tines: 3,
            throat_m: 0.028,
            tine_length_m: 0.020,
            tine_radius_m: 0.0015,
            thickness_m: 0.006,
            object_radius_m: 0.012,
            edge_margin_m: 0.001,
        }
    }
}

impl Rake {
    /// Half the width over all, m.
    fn half_width(&self) -> f64 {
        let (tines, gaps) = (f64::from(self.tines), f64::from(self.tines.saturating_sub(1)));
        tines * self.tine_radius_m + 0.5 * gaps * self.throat_m
    }

    /// Middle of each tine along x, m, from the left.
    fn tine_places(&self) -> impl Iterator<Item = f64> {
        let (first, pitch) = (self.tine_radius_m - self.half_width(), self.throat_m + 2.0 * self.tine_radius_m);
        (0..self.tines).map(move |tine| first + pitch * f64::from(tine))
    }

    /// Height at which the round tips begin, m.
    fn tip_height(&self) -> f64 {
        -self.thickness_m / 2.0 - (self.tine_length_m - self.tine_radius_m)
    }
}

impl ToolShape for Rake {
    fn validate(&self) -> Result<(), FieldError> {
        if !(2..=5).contains(&self.tines) {
            return Err(FieldError::new("tines", self.tines, "a whole number from 2 to 5"));
        }
        length("throat_m", self.throat_m)?;
        length("tine_length_m", self.tine_length_m)?;
        length("tine_radius_m", self.tine_radius_m)?;
        length("thickness_m", self.thickness_m)?;
        length("object_radius_m", self.object_radius_m)?;
        not_negative("edge_margin_m", self.edge_margin_m)?;
        let caged_m = 2.0 * self.object_radius_m + PLAY_M;
        at_least("throat_m", self.throat_m, caged_m, "twice object_radius_m, and play")?;
        let held_m = self.object_radius_m + self.tine_radius_m + self.edge_margin_m + SHORTEST_FACE_M;
        at_least("tine_length_m", self.tine_length_m, held_m, "tines must reach past the disc's center to hold it")?;
        let ends_m = 2.0 * self.edge_margin_m + SHORTEST_FACE_M;
        at_least("thickness_m", self.thickness_m, ends_m, "its ends push too, less two of edge_margin_m")
    }

    fn pieces(&self) -> Vec<PlacedOutline> {
        let (half, tip, radius_m) = (self.thickness_m / 2.0, self.tip_height(), self.tine_radius_m);
        let bar = rectangle(-self.half_width(), self.half_width(), -half, half);
        let tines = self.tine_places().flat_map(|x| {
            let round = PlacedOutline { shape: Outline::Disc { radius_m }, position_m: [x, tip], angle_rad: 0.0 };
            [rectangle(x - radius_m, x + radius_m, tip, -half), round]
        });
        std::iter::once(bar).chain(tines).collect()
    }

    fn surfaces(&self) -> Vec<ContactSurface> {
        let (half, margin, radius) = (self.thickness_m / 2.0, self.edge_margin_m, self.object_radius_m);
        let (low, seat, side) = (self.tip_height() + margin, -half - radius, self.half_width());
        let gaps = self.tine_places().zip(self.tine_places().skip(1)).zip(1..).flat_map(|((before, after), gap)| {
            let (left, right) = (before + self.tine_radius_m, after - self.tine_radius_m);
            [
                facing_down(&format!("gap_{gap}"), -half, left + radius, right - radius),
                facing_right(&format!("gap_{gap}_left"), left, low, seat),
                facing_left(&format!("gap_{gap}_right"), right, low, seat),
            ]
        });
        let outside = [
            facing_up("front", half, margin - side, side - margin),
            facing_left("left", -side, low, half - margin),
            facing_right("right", side, low, half - margin),
        ];
        gaps.chain(outside).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::family::tests::{area_m2, tool};
    use approx::assert_relative_eq;
    use nalgebra::Point2;

    #[test]
    fn the_default_rake_has_three_tines_of_3_mm_and_two_gaps_of_28_mm() {
        let rake = tool(&Rake::default());
        // bar 65 x 6 about the origin, tines 3 x 18.5 about y = -12.25, whole discs of the tips about y = -21.5
        let (bar, tine, tip) = (390.0, 55.5, std::f64::consts::PI * 2.25);
        let area = bar + 3.0 * (tine + tip);
        assert_relative_eq!(area_m2(&rake), area * 1e-6, epsilon = 1e-15);
        let y = 3.0 * (tine * -12.25 + tip * -21.5) / area * 1e-3;
        assert_relative_eq!(rake.centroid(), Point2::new(0.0, y), epsilon = 1e-15);
        let names: Vec<&str> = rake.surfaces.iter().map(|surface| surface.name.as_str()).collect();
        let gaps = ["gap_1", "gap_1_left", "gap_1_right", "gap_2", "gap_2_left", "gap_2_right"];
        assert_eq!(names, [&gaps[..], &["front", "left", "right"]].concat());
        // the bar between two tines, less the disc's radius on either side
        assert_relative_eq!(rake.surfaces[0].length_m(), 0.004, epsilon = 1e-15);
        assert_relative_eq!(rake.surfaces[0].middle().point, Point2::new(-0.0155, -0.003), epsilon = 1e-15);
    }

    #[test]
    fn lengths_that_make_no_rake_are_refused_by_name() {
        let field = |rake: Rake| rake.validate().unwrap_err().field;
        let rake = Rake::default;
        assert_eq!(field(Rake { tines: 1, ..rake() }), "tines");
        assert_eq!(field(Rake { tines: 6, ..rake() }), "tines");
        assert_eq!(field(Rake { throat_m: 0.0259, ..rake() }), "throat_m");
        assert_eq!(Rake { throat_m: 0.026, ..rake() }.validate(), Ok(()));
        assert_eq!(field(Rake { tine_length_m: 0.0149, ..rake() }), "tine_length_m");
        assert_eq!(field(Rake { tine_radius_m: 0.0, ..rake() }), "tine_radius_m");
        assert_eq!(field(Rake { thickness_m: 0.0024, ..rake() }), "thickness_m");
        assert_eq!(field(Rake { object_radius_m: f64::NAN, ..rake() }), "object_radius_m");
        assert_eq!(field(Rake { edge_margin_m: -1.0, ..rake() }), "edge_margin_m");
    }
}
