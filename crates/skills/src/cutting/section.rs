//! What is cut and what with: the section of a food, and the edge of a knife.

use nalgebra::{Isometry3, Translation3};
use serde::{Deserialize, Serialize};

use crate::field::{FieldError, finite, not_negative, positive};
use crate::time_law::PathState;

/// Section of a food that a cut is to make.
///
/// Its frame lies in the middle of the section's top: x along the chord, y in the direction of the cut, down to the board,
/// z along the normal of the section.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Pose of the section, `world_from_section`, m.
    pub world_from_section: Isometry3<f64>,
    /// Greatest chord along x, m.
    pub width_m: f64,
    /// Distance from the top of the food down to the board, m.
    pub height_m: f64,
}

impl Section {
    /// Checks pose and sizes; the direction of the cut is within 45 degrees of straight down.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("width_m", self.width_m)?;
        positive("height_m", self.height_m)?;
        let pose = &self.world_from_section;
        finite("world_from_section", pose.translation.vector.as_slice())?;
        finite("world_from_section", pose.rotation.coords.as_slice())?;
        let down = -(pose.rotation * nalgebra::Vector3::y()).z;
        if down < std::f64::consts::FRAC_1_SQRT_2 {
            let found = format!("y axis that points down by {down:.3} of its length");
            return Err(FieldError::new("world_from_section", found, "y within 45 degrees of straight down"));
        }
        Ok(())
    }

    /// The same section elsewhere in the food, `along_m` along its normal.
    #[must_use]
    pub fn shifted(&self, along_m: f64) -> Self {
        Self { world_from_section: self.world_from_section * Translation3::new(0.0, 0.0, along_m), ..*self }
    }

    /// Frame of the section on the board, below its own, `world_from_board`.
    pub(super) fn world_from_board(&self) -> Isometry3<f64> {
        self.world_from_section * Translation3::new(0.0, self.height_m, 0.0)
    }
}

/// Edge of a knife in the tool's frame: origin in the middle of the edge, x along it, y in the direction of the cut,
/// z along the normal of the blade.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Blade {
    /// Length of the edge, m.
    pub edge_m: f64,
    /// Radius of the belly on which the edge rocks, m; straight if absent.
    pub belly_radius_m: Option<f64>,
    /// Length at each end of the edge that is not to be used, m.
    pub spare_m: f64,
}

impl Default for Blade {
    fn default() -> Self {
        Self { edge_m: 0.18, belly_radius_m: None, spare_m: 0.005 }
    }
}

impl Blade {
    /// Checks the sizes.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        positive("edge_m", self.edge_m)?;
        not_negative("spare_m", self.spare_m)?;
        positive("edge_m", self.usable_m()).map_err(|_| {
            FieldError::new("spare_m", self.spare_m, format!("less than half of edge_m = {}", self.edge_m))
        })?;
        let Some(radius_m) = self.belly_radius_m else { return Ok(()) };
        positive("belly_radius_m", radius_m)?;
        if self.edge_m > std::f64::consts::FRAC_PI_2 * radius_m {
            let expected =
                format!("more than {} for an edge of {} m", self.edge_m / std::f64::consts::FRAC_PI_2, self.edge_m);
            return Err(FieldError::new("belly_radius_m", radius_m, expected));
        }
        Ok(())
    }

    /// Length of the edge that may be used, m.
    #[must_use]
    pub fn usable_m(&self) -> f64 {
        self.edge_m - 2.0 * self.spare_m
    }

    /// Point of the edge at the arc length `along_m` from its middle: x and y in the tool's frame, m.
    #[must_use]
    pub fn point(&self, along_m: f64) -> [f64; 2] {
        match self.belly_radius_m {
            None => [along_m, 0.0],
            Some(radius_m) => {
                let (sin, cos) = (along_m / radius_m).sin_cos();
                [radius_m * sin, radius_m * (cos - 1.0)]
            }
        }
    }

    /// Least distance to which the usable edge extends from the tool's origin along x, to either side, while it rocks by
    /// at most `rock_rad`, m.
    pub(super) fn reach_m(&self, rock_rad: f64) -> f64 {
        match self.belly_radius_m {
            None => 0.5 * self.usable_m() * rock_rad.cos(),
            Some(radius_m) => {
                let half = 0.25 * self.usable_m() / radius_m;
                2.0 * radius_m * half.sin() * (half + rock_rad).cos()
            }
        }
    }

    /// Largest angle by which the edge may rock, rad, without reaching deeper than `gap` beyond the tool's origin, with its
    /// derivatives by time: asin of 2·gap/edge, with a belly acos(1 − gap/R).
    pub(super) fn rock_within(&self, gap: PathState) -> PathState {
        // d/dt f(g) = f′ġ, d²/dt² f(g) = f″ġ² + f′g̈
        let chained = |value: f64, first: f64, second: f64| PathState {
            position: value,
            first: first * gap.first,
            second: second * gap.first * gap.first + first * gap.second,
        };
        match self.belly_radius_m {
            // atan is below asin and has no end
            None => {
                let half = 0.5 * self.edge_m;
                let square = half * half + gap.position * gap.position;
                chained((gap.position / half).atan(), half / square, -2.0 * half * gap.position / (square * square))
            }
            Some(radius) => {
                // 2·atan(√(g/2R)) is acos(1 − g/R) to the third order, below it, and has no end
                let root = (gap.position / (2.0 * radius)).max(0.0).sqrt();
                let rise = 1.0 / (4.0 * radius * root);
                let fall = 1.0 + root * root;
                chained(
                    2.0 * root.atan(),
                    2.0 * rise / fall,
                    -2.0 * rise * rise * (1.0 + 3.0 * root * root) / (root * fall * fall),
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn an_edge_that_rocks_within_its_bound_reaches_no_deeper(
            gap in 1e-5f64..0.05, radius in prop::option::of(0.15f64..3.0), part in 0.0f64..1.0,
        ) {
            let blade = Blade { belly_radius_m: radius, ..Blade::default() };
            let rock = part * blade.rock_within(PathState { position: gap, first: 0.0, second: 0.0 }).position;
            let deepest = (0..=400).map(|k| {
                let [x, y] = blade.point(blade.edge_m * (f64::from(k) / 400.0 - 0.5));
                x * rock.sin() + y * rock.cos()
            }).fold(f64::MIN, f64::max);
            prop_assert!(deepest <= gap + 1e-12, "{deepest}");
        }

        #[test]
        fn the_bound_of_rocking_has_the_derivatives_it_tells(
            gap in 1e-3f64..0.05, radius in prop::option::of(0.15f64..3.0), first in -0.1f64..0.1, second in -1.0f64..1.0,
        ) {
            let blade = Blade { belly_radius_m: radius, ..Blade::default() };
            let at = |t: f64| blade.rock_within(PathState {
                position: gap + t * (first + 0.5 * t * second), first: first + t * second, second,
            });
            let h = 1e-5;
            let scale = 1.0 + at(0.0).second.abs();
            prop_assert!(((at(h).position - at(-h).position) / (2.0 * h) - at(0.0).first).abs() < 1e-4 * scale);
            prop_assert!(((at(h).first - at(-h).first) / (2.0 * h) - at(0.0).second).abs() < 1e-3 * scale);
        }

        #[test]
        fn the_edge_covers_its_reach_while_it_rocks(
            radius in prop::option::of(0.3f64..3.0), rock in -0.4f64..0.4,
        ) {
            let blade = Blade { belly_radius_m: radius, ..Blade::default() };
            let x = |along: f64| {
                let [x, y] = blade.point(along);
                x * rock.cos() - y * rock.sin()
            };
            let reach = blade.reach_m(0.4);
            prop_assert!(x(0.5 * blade.usable_m()) >= reach - 1e-12 && x(-0.5 * blade.usable_m()) <= -reach + 1e-12);
        }
    }

    #[test]
    fn sections_that_are_not_cut_downward_and_blades_without_edge_are_refused() {
        let level = Section { world_from_section: Isometry3::identity(), width_m: 0.03, height_m: 0.03 };
        assert_eq!(level.validate().unwrap_err().field, "world_from_section");
        assert_eq!(Blade { spare_m: 0.09, ..Blade::default() }.validate().unwrap_err().field, "spare_m");
        let round = Blade { belly_radius_m: Some(0.05), ..Blade::default() };
        assert_eq!(round.validate().unwrap_err().field, "belly_radius_m");
    }
}
