//! The shipped foods, and refusals of files that cannot be used.

use super::*;
use crate::random::{Purpose, stream};

/// Shipped foods, and the mass that such a food has, g.
const FOODS: [(&str, f64); 7] = [
    (include_str!("../../../../../assets/foods/banana.toml"), 105.0),
    (include_str!("../../../../../assets/foods/biscuit.toml"), 11.0),
    (include_str!("../../../../../assets/foods/grape.toml"), 4.5),
    (include_str!("../../../../../assets/foods/strawberry.toml"), 14.0),
    (include_str!("../../../../../assets/foods/meatball.toml"), 24.0),
    // 0.1 m × 0.04 m × 0.03 m of water, and π/4 (37.08 mm)² 0.15 m at 1110 kg/m³
    (include_str!("../../../../../assets/foods/block.toml"), 120.0),
    (include_str!("../../../../../assets/foods/cylinder.toml"), 179.8),
];

fn file(text: &str) -> FoodFile {
    toml::from_str(text).unwrap()
}

#[test]
fn shipped_foods_weigh_what_such_foods_weigh() {
    for (text, mass_g) in FOODS {
        let food = file(text).food().unwrap();
        let found_g = 1e3 * food.solid.mass_properties(food.material.density_kg_per_m3).mass_kg;
        // specimens of a kind differ by more than this
        assert!((found_g / mass_g - 1.0).abs() < 0.03, "{}: {found_g} g", food.name);
    }
}

#[test]
fn specimens_lie_within_the_ranges_and_differ() {
    for (text, _) in FOODS {
        let file = file(text);
        let [low, high] = file.range.toughness_j_per_m2.unwrap();
        let mut random = stream(1, Purpose::Variation, 0);
        let samples = (0..50).map(|_| file.range.draw(&file.material, &mut random)).collect::<Vec<_>>();
        assert!(samples.iter().all(|sample| (low..=high).contains(&sample.toughness_j_per_m2)));
        assert!(samples.windows(2).all(|pair| pair[0].scale != pair[1].scale));
        let food = file.specimen(&samples[0]).unwrap();
        assert_eq!(food.material.toughness_j_per_m2, samples[0].toughness_j_per_m2);
        let growth = food.solid.volume_m3() / file.food().unwrap().solid.volume_m3();
        assert!((growth - samples[0].scale.powi(3)).abs() < 1e-12);
    }
}

#[test]
fn a_food_without_ranges_has_no_variation() {
    let stated = FoodFile { range: FoodRange::default(), ..file(FOODS[0].0) };
    let mut random = stream(1, Purpose::Variation, 0);
    assert_eq!(stated.range.draw(&stated.material, &mut random), FoodSample::of(&stated.material));
}

#[test]
fn a_file_survives_being_written_and_read() {
    for (text, _) in FOODS {
        let read = file(text);
        assert_eq!(file(&toml::to_string(&read).unwrap()), read);
    }
}

#[test]
fn values_that_cannot_be_are_refused_by_name() {
    let banana = FOODS[0].0;
    let refused = |from: &str, to: &str| {
        assert!(banana.contains(from));
        file(&banana.replace(from, to)).food().unwrap_err().field
    };
    assert_eq!(refused("diameter_m = 0.030", "diameter_m = 30.0"), "shape.banana.diameter_m");
    assert_eq!(refused("toughness_j_per_m2 = 150.0", "toughness_j_per_m2 = -1.0"), "material.toughness_j_per_m2");
    assert_eq!(refused("skin_tension = \"peeled\"", "skin_tension = \"\""), "material.basis.skin_tension");
    assert_eq!(
        refused("rate_exponent = 0.1", "rate_exponent = 0.1\nbrittle_depth_share = nan"),
        "material.brittle_depth_share"
    );
    assert_eq!(refused("flesh_rgb = [0.98, 0.95, 0.80]", "flesh_rgb = [0.98, 0.95, 80.0]"), "look.flesh_rgb");
    assert_eq!(refused("scale = [0.9, 1.1]", "scale = [1.1, 0.9]"), "range.scale");
}

#[test]
fn a_key_that_is_not_known_is_refused() {
    let text = FOODS[0].0.replace("board_friction = 0.4", "board_friction = 0.4\nbord_friction = 0.4");
    let error = toml::from_str::<FoodFile>(&text).unwrap_err().to_string();
    assert!(error.contains("unknown field `bord_friction`"), "{error}");
}
