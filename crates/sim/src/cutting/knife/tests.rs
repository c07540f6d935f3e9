//! Knives of the shipped files, and what a file may not state.

use super::*;
use approx::assert_relative_eq;

const FILES: [&str; 5] = [
    include_str!("../../../../../assets/knives/chef.toml"),
    include_str!("../../../../../assets/knives/paring.toml"),
    include_str!("../../../../../assets/knives/cleaver.toml"),
    include_str!("../../../../../assets/knives/serrated.toml"),
    include_str!("../../../../../assets/knives/wire.toml"),
];

fn file(text: &str) -> KnifeFile {
    toml::from_str(text).unwrap()
}

#[test]
fn shipped_knives_have_the_mass_of_kitchen_knives() {
    for (text, range) in FILES.iter().zip([0.10..0.25, 0.03..0.08, 0.3..0.7, 0.10..0.2, 0.08..0.2]) {
        let knife = file(text).knife().unwrap();
        assert!(range.contains(&knife.mass.mass_kg), "{}: {} kg", knife.name, knife.mass.mass_kg);
        let principal = knife.mass.inertia_in_knife_kg_m2.symmetric_eigenvalues();
        assert!(principal.min() > 0.0 && principal.max() < principal.sum() - principal.max() + 1e-12);
    }
}

#[test]
fn a_straight_blade_weighs_what_its_cross_section_says() {
    let cleaver = file(FILES[2]);
    let BladeFamily::Cleaver(blade) = &cleaver.blade else { panic!("a cleaver") };
    // a rectangle above a triangle, by hand: the triangle's height is 1.5 mm / tan 0.218
    let ground = 0.0015 / 0.218_f64.tan();
    let section = 0.003 * (blade.height_m - ground) + 0.5 * 0.003 * ground;
    let expected = 7750.0 * section * 0.180 + 0.120;
    assert_relative_eq!(cleaver.knife().unwrap().mass.mass_kg, expected, max_relative = 1e-9);
}

#[test]
fn bodies_add_up_like_the_halves_of_a_box() {
    let whole = MassOf::hull(&solid::cuboid([0.0, 0.0, 0.0], [0.2, 0.04, 0.01]), 1000.0).unwrap();
    let left = MassOf::hull(&solid::cuboid([0.0, 0.0, 0.0], [0.07, 0.04, 0.01]), 1000.0).unwrap();
    let right = MassOf::hull(&solid::cuboid([0.07, 0.0, 0.0], [0.2, 0.04, 0.01]), 1000.0).unwrap();
    let both = left.and(&right);
    assert_relative_eq!(whole.mass_kg, 0.08, max_relative = 1e-9);
    assert_relative_eq!(both.center_in_knife, whole.center_in_knife, epsilon = 1e-9);
    assert_relative_eq!(both.inertia_in_knife_kg_m2, whole.inertia_in_knife_kg_m2, epsilon = 1e-9);
    // m (a² + b²)/12 by hand, about z
    assert_relative_eq!(whole.inertia_in_knife_kg_m2[(2, 2)], 0.08 * (0.04 + 0.0016) / 12.0, max_relative = 1e-6);
}

#[test]
fn the_edge_is_the_lowest_part_of_the_blade_and_the_grip_lies_behind_the_heel() {
    for text in FILES {
        let knife = file(text).knife().unwrap();
        let lowest = knife.pieces.iter().flatten().map(|corner| corner.y).fold(f64::MIN, f64::max);
        assert_relative_eq!(lowest, 0.0, epsilon = 1e-12);
        for point in &knife.edge.points {
            let on_blade = |corner: &nalgebra::Point3<f64>| (corner.xy() - point).norm() < 1e-9;
            assert!(knife.pieces.iter().flatten().any(on_blade), "{}: {point}", knife.name);
        }
        assert!(knife.knife_from_grip.translation.x < 0.0 && knife.knife_from_grip.translation.y < 0.0);
    }
}

#[test]
fn a_belly_is_an_arc_of_its_radius() {
    let chef = file(FILES[0]).knife().unwrap();
    let tip = chef.edge.points.last().unwrap();
    // the arc begins at 70 mm: rise R − √(R² − 130²) = 21.7 mm
    assert_relative_eq!(tip.y, -(0.4 - (0.16_f64 - 0.0169).sqrt()), epsilon = 1e-12);
    for point in &chef.edge.points[1..] {
        assert_relative_eq!((point - nalgebra::Point2::new(0.07, -0.4)).norm(), 0.4, epsilon = 1e-12);
    }
}

#[test]
fn serrated_edges_and_wires_say_how_they_differ() {
    let (serrated, wire) = (file(FILES[3]).knife().unwrap().edge, file(FILES[4]).knife().unwrap().edge);
    assert_eq!((serrated.tooth_ratio, serrated.roughness_factor), (0.3, 2.0));
    assert_eq!((wire.radius_m, wire.blade_height_m), (0.00025, 0.0005));
}

#[test]
fn a_wrong_value_is_named_by_its_key() {
    let refused = |from: &str, to: &str, which: usize| {
        let text = FILES[which].replace(from, to);
        assert_ne!(text, FILES[which]);
        file(&text).knife().unwrap_err().field
    };
    assert_eq!(refused("length_m = 0.200", "length_m = 200.0", 0), "blade.chef.length_m");
    assert_eq!(refused("belly_radius_m = 0.400", "belly_radius_m = 0.140", 0), "blade.chef.belly_radius_m");
    assert_eq!(refused("tooth_depth_m = 0.0015", "tooth_depth_m = 0.1", 3), "blade.serrated.tooth_depth_m");
    assert_eq!(refused("mass_kg = 0.040", "mass_kg = -1.0", 4), "handle.mass_kg");
    assert_eq!(refused("friction = 0.30", "friction = nan", 1), "friction");
}

#[test]
fn an_unknown_key_is_refused() {
    let error = toml::from_str::<KnifeFile>(&FILES[1].replace("[blade.paring]", "[blade.paring]\nsharp = true"));
    assert!(error.unwrap_err().to_string().contains("unknown field `sharp`"));
}
