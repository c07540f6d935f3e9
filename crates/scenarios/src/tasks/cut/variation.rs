//! What a run differs in from the scenario: drawn anew from each seed, unknown to planner and controller but for the size.

use serde::{Deserialize, Serialize};
use sim::cutting::food::{FoodFile, FoodRange, FoodSample};
use sim::random::{Purpose, stream, symmetric};
use skills::field::{FieldError, within};

/// How far food and board of a run may differ from the scenario.
///
/// Nothing differs by default. The food's size is seen by the planner, as by anyone who cuts; its toughness, its place to the
/// millimeter and the friction of the board are not.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct VariationConfig {
    /// Largest difference of all lengths of the food, as a share of the stated ones, all equally likely.
    #[schemars(range(min = 0.0, max = LARGEST_SIZE_SHARE))]
    pub size_share: f64,
    /// Whether the toughness is drawn from the range in the food's file; equal ratios are equally likely.
    pub toughness: bool,
    /// Largest difference of each coordinate of the food's place, m, all equally likely.
    #[schemars(range(min = 0.0, max = FARTHEST_M))]
    pub place_m: f64,
    /// Largest difference of the food's angle, rad, all equally likely.
    #[schemars(range(min = 0.0, max = LARGEST_ANGLE_RAD))]
    pub angle_rad: f64,
    /// Largest difference of the friction between food and board, as a share of the stated one, all equally likely.
    #[schemars(range(min = 0.0, max = LARGEST_FRICTION_SHARE))]
    pub board_friction_share: f64,
}

/// What one run differs in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation {
    /// Lengths and toughness of the food.
    pub sample: FoodSample,
    /// Friction on the board over the stated one.
    pub board_friction: f64,
    /// Place of the food less the stated one, world frame, m.
    pub place_m: [f64; 2],
    /// Angle of the food less the stated one, rad.
    pub angle_rad: f64,
}

/// Shares and lengths beyond which it is another food, or another task.
const LARGEST_SIZE_SHARE: f64 = 0.4;
const LARGEST_FRICTION_SHARE: f64 = 0.9;
const FARTHEST_M: f64 = 0.02;
const LARGEST_ANGLE_RAD: f64 = 0.5;

impl VariationConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("size_share", self.size_share, 0.0, LARGEST_SIZE_SHARE)?;
        within("place_m", self.place_m, 0.0, FARTHEST_M)?;
        within("angle_rad", self.angle_rad, 0.0, LARGEST_ANGLE_RAD)?;
        within("board_friction_share", self.board_friction_share, 0.0, LARGEST_FRICTION_SHARE)
    }

    /// Draws what the run with `seed` differs in, of a food as stated by a file, `scale` times as large.
    #[must_use]
    pub fn draw(&self, file: &FoodFile, scale: f64, seed: u64) -> Variation {
        let mut random = stream(seed, Purpose::Variation, 0);
        // every number is drawn, wanted or not: what varies already does not change when a key is added
        let [size, friction, x, y, angle] = [(); 5].map(|()| symmetric(&mut random));
        let range = if self.toughness { file.range.toughness_j_per_m2 } else { None };
        let range = FoodRange { scale: None, toughness_j_per_m2: range };
        let drawn = range.draw(&file.material, &mut random);
        Variation {
            sample: FoodSample { scale: scale * (1.0 + self.size_share * size), ..drawn },
            board_friction: 1.0 + self.board_friction_share * friction,
            place_m: [self.place_m * x, self.place_m * y],
            angle_rad: self.angle_rad * angle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: VariationConfig =
        VariationConfig { size_share: 0.1, toughness: true, place_m: 0.002, angle_rad: 0.1, board_friction_share: 0.2 };

    fn banana() -> FoodFile {
        toml::from_str(include_str!("../../../../../assets/foods/banana.toml")).unwrap()
    }

    #[test]
    fn nothing_differs_by_default() {
        let (file, drawn) = (banana(), VariationConfig::default().draw(&banana(), 1.1, 7));
        let stated = FoodSample { scale: 1.1, ..FoodSample::of(&file.material) };
        assert_eq!(drawn, Variation { sample: stated, board_friction: 1.0, place_m: [0.0; 2], angle_rad: 0.0 });
    }

    #[test]
    fn a_key_changes_only_what_it_names() {
        let only = VariationConfig { toughness: true, ..VariationConfig::default() };
        let without = VariationConfig { toughness: false, ..ALL };
        let (all, only, without) =
            (ALL.draw(&banana(), 1.0, 3), only.draw(&banana(), 1.0, 3), without.draw(&banana(), 1.0, 3));
        assert_eq!(only.sample.toughness_j_per_m2, all.sample.toughness_j_per_m2);
        assert_eq!((only.sample.scale, only.place_m), (1.0, [0.0; 2]));
        assert_eq!(Variation { sample: all.sample, ..without }, all);
        assert_eq!(without.sample.scale, all.sample.scale);
    }

    #[test]
    fn draws_stay_inside_and_fill_the_foods_range_of_toughness() {
        let draws: Vec<Variation> = (0..1000).map(|seed| ALL.draw(&banana(), 1.0, seed)).collect();
        let inside = |drawn: &Variation| {
            (drawn.sample.scale - 1.0).abs() <= 0.1
                && (80.0..=300.0).contains(&drawn.sample.toughness_j_per_m2)
                && drawn.place_m.iter().all(|offset| offset.abs() <= 0.002)
                && drawn.angle_rad.abs() <= 0.1
                && (drawn.board_friction - 1.0).abs() <= 0.2
        };
        assert!(draws.iter().all(inside));
        // half of the draws lie below the geometric mean of the range: 500 of 1000, standard deviation 16
        let median = (80.0_f64 * 300.0).sqrt();
        let below = draws.iter().filter(|drawn| drawn.sample.toughness_j_per_m2 < median).count();
        assert!((420..580).contains(&below), "{below}");
    }

    #[test]
    fn shares_that_make_another_food_are_refused_by_name() {
        assert!(ALL.validate().is_ok());
        let field = |config: VariationConfig| config.validate().unwrap_err().field;
        assert_eq!(field(VariationConfig { size_share: 0.5, ..ALL }), "size_share");
        assert_eq!(field(VariationConfig { place_m: f64::NAN, ..ALL }), "place_m");
    }
}
