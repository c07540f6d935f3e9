//! What a pour differs in from its scenario: drawn anew from each seed.

use serde::{Deserialize, Serialize};
use sim::pouring::{FillAmount, GrainConfig};
use sim::random::{Purpose, stream, symmetric};
use skills::field::{FieldError, within};

use crate::outcome::Measure;

/// How far a run may differ from the scenario. Everything is uniform about the stated value; nothing differs by default.
///
/// Planner and controller believe what the scenario states, but for the place of the target, which is seen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct PourVariation {
    /// Diameter of the grains: largest difference, as a share of the stated one.
    #[schemars(range(min = 0.0, max = LARGEST_SHARE))]
    pub bean_diameter_share: f64,
    /// Friction between grains: largest difference, as a share of the stated one.
    #[schemars(range(min = 0.0, max = LARGEST_SHARE))]
    pub bean_friction_share: f64,
    /// Number of grains or height of the fill: largest difference, as a share of the stated one.
    #[schemars(range(min = 0.0, max = LARGEST_SHARE))]
    pub fill_share: f64,
    /// Place of the target: largest difference in each coordinate, m.
    #[schemars(range(min = 0.0, max = FARTHEST_M))]
    pub target_m: f64,
}

/// What one run differs in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnPour {
    diameter: f64,
    friction: f64,
    fill: f64,
    target_m: [f64; 2],
}

/// Largest share: sizes and fills beyond it are another task.
const LARGEST_SHARE: f64 = 0.5;
/// A target farther from its place than this is another task, m.
const FARTHEST_M: f64 = 0.2;

impl PourVariation {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("bean_diameter_share", self.bean_diameter_share, 0.0, LARGEST_SHARE)?;
        within("bean_friction_share", self.bean_friction_share, 0.0, LARGEST_SHARE)?;
        within("fill_share", self.fill_share, 0.0, LARGEST_SHARE)?;
        within("target_m", self.target_m, 0.0, FARTHEST_M)
    }

    /// Draws what the run with `seed` differs in.
    #[must_use]
    pub fn draw(&self, seed: u64) -> DrawnPour {
        let mut random = stream(seed, Purpose::Variation, 0);
        // every number is drawn, wanted or not: what varies already does not change when a key is added
        let [diameter, friction, fill, x, y] = [(); 5].map(|()| symmetric(&mut random));
        DrawnPour {
            diameter: 1.0 + self.bean_diameter_share * diameter,
            friction: 1.0 + self.bean_friction_share * friction,
            fill: 1.0 + self.fill_share * fill,
            target_m: [self.target_m * x, self.target_m * y],
        }
    }
}

impl DrawnPour {
    /// The grains that are really there.
    #[must_use]
    pub fn bean(&self, stated: &GrainConfig) -> GrainConfig {
        GrainConfig {
            diameter_m: stated.diameter_m * self.diameter,
            friction: stated.friction * self.friction,
            ..stated.clone()
        }
    }

    /// The fill that is really there.
    #[must_use]
    pub fn fill(&self, stated: FillAmount) -> FillAmount {
        match stated {
            FillAmount::Count(count) => FillAmount::Count(((count as f64 * self.fill).round() as usize).max(1)),
            FillAmount::HeightM(height_m) => FillAmount::HeightM(height_m * self.fill),
        }
    }

    /// Where the target really stands, m.
    #[must_use]
    pub fn place_m(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x + self.target_m[0], y + self.target_m[1]]
    }

    /// What differs, as far as `config` lets it.
    #[must_use]
    pub fn measures(&self, config: &PourVariation, stated: &GrainConfig) -> Vec<Measure> {
        let bean = self.bean(stated);
        let [x_mm, y_mm] = self.target_m.map(|offset_m| offset_m * 1e3);
        let differs = |bound: f64, name: &str, label: &str, value: f64, unit: &str| {
            (bound > 0.0).then(|| Measure::reported(name, label, value, unit))
        };
        [
            differs(
                config.bean_diameter_share,
                "varied_bean_diameter_mm",
                "diameter of the beans, as drawn",
                bean.diameter_m * 1e3,
                "mm",
            ),
            differs(
                config.bean_friction_share,
                "varied_bean_friction",
                "friction of the beans, as drawn",
                bean.friction,
                "1",
            ),
            differs(config.fill_share, "varied_fill", "fill over the stated one, as drawn", self.fill, "1"),
            differs(config.target_m, "varied_target_x_mm", "target off its stated place, x", x_mm, "mm"),
            differs(config.target_m, "varied_target_y_mm", "target off its stated place, y", y_mm, "mm"),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_differs_by_default() {
        let drawn = PourVariation::default().draw(7);
        let bean = GrainConfig::default();
        assert_eq!(drawn.bean(&bean), bean);
        assert_eq!(drawn.fill(FillAmount::Count(300)), FillAmount::Count(300));
        assert_eq!(drawn.place_m([0.5, 0.1]), [0.5, 0.1]);
        assert!(drawn.measures(&PourVariation::default(), &bean).is_empty());
    }

    #[test]
    fn a_key_changes_only_what_it_names() {
        let only = PourVariation { fill_share: 0.2, ..PourVariation::default() };
        let all = PourVariation { fill_share: 0.2, target_m: 0.01, ..PourVariation::default() };
        let count = |drawn: DrawnPour| drawn.fill(FillAmount::Count(1000));
        assert_eq!(count(only.draw(3)), count(all.draw(3)));
        assert_ne!(all.draw(3).place_m([0.0; 2]), [0.0; 2]);
    }
}
