//! Potential fields: forces against differences of the potential, and cases known by hand.

use approx::assert_relative_eq;
use proptest::prelude::*;

use super::*;

/// A few roundings.
const ROUNDING: f64 = 1e-12;
/// Step of the central differences, of lengths of order one.
const STEP: f64 = 1e-6;
/// Error of those differences, relative to the potential's curvature over distances of a tenth and more.
const DIFFERENCE: f64 = 1e-6;

fn dynamic() -> PotentialConfig {
    PotentialConfig::Dynamic(DynamicPotential { strength: 0.7, exponent: 2.5, closest: 0.01 })
}

fn fixed() -> PotentialConfig {
    PotentialConfig::Static(StaticPotential { strength: 0.3, reach: 2.0, closest: 0.01 })
}

fn about(potential: PotentialConfig, center: &[f64], radius: f64) -> PotentialCoupling {
    let obstacle = PointObstacle { center: center.to_vec(), radius };
    PotentialCoupling::new(potential, vec![obstacle], center.len()).unwrap()
}

fn state<'a>(position: &'a [f64], velocity: &'a [f64]) -> MotionState<'a> {
    MotionState { position, velocity, elapsed_s: 0.0, duration_s: 2.0 }
}

fn force(coupling: &PotentialCoupling, state: &MotionState<'_>) -> Vec<f64> {
    let mut sum = vec![0.0; state.position.len()];
    coupling.add_to(state, &mut sum);
    sum
}

#[test]
fn a_head_on_approach_is_braked_by_a_force_known_by_hand() {
    // v = τẋ = 2·0.5, p = 3 − 1 = 2, cos θ = −1: U = λ‖v‖/p = 0.35, −U' = λ‖v‖/p² = 0.175
    let coupling = about(dynamic(), &[0.0, 0.0], 1.0);
    let state = state(&[-3.0, 0.0], &[0.5, 0.0]);
    assert_relative_eq!(coupling.potential(&state), 0.35, max_relative = ROUNDING);
    let found = force(&coupling, &state);
    assert_relative_eq!(found[0], -0.175, max_relative = ROUNDING);
    assert_eq!(found[1], 0.0);
}

#[test]
fn the_static_force_is_known_by_hand_and_ends_at_its_reach() {
    // p = 1, p0 = 2: η(1 − ½)/1
    let coupling = about(fixed(), &[0.0], 0.5);
    assert_relative_eq!(force(&coupling, &state(&[1.5], &[0.0]))[0], 0.15, max_relative = ROUNDING);
    assert_eq!(force(&coupling, &state(&[2.5], &[0.0])), [0.0]);
}

#[test]
fn what_leaves_or_stands_still_is_not_pushed_by_the_dynamic_field() {
    let coupling = about(dynamic(), &[0.0, 0.0], 0.0);
    assert_eq!(force(&coupling, &state(&[-0.3, 0.1], &[-1.0, 0.2])), [0.0, 0.0]);
    assert_eq!(force(&coupling, &state(&[-0.3, 0.1], &[0.0, 0.0])), [0.0, 0.0]);
}

#[test]
fn forces_are_finite_inside_an_obstacle_and_at_its_center() {
    for potential in [dynamic(), fixed()] {
        let coupling = about(potential, &[0.0, 0.0], 0.5);
        for position in [[0.0, 0.0], [1e-300, 0.0], [0.2, -0.1], [0.5, 0.0]] {
            let found = force(&coupling, &state(&position, &[-1.0, 0.3]));
            assert!(found.iter().all(|value| value.is_finite()), "{position:?}: {found:?}");
        }
    }
}

#[test]
fn obstacles_add_up() {
    let obstacle = |x: f64| PointObstacle { center: vec![x, 0.2], radius: 0.1 };
    let of = |obstacles| PotentialCoupling::new(fixed(), obstacles, 2).unwrap();
    let state = state(&[0.3, 0.0], &[1.0, 0.0]);
    let both = force(&of(vec![obstacle(0.0), obstacle(1.0)]), &state);
    let (one, other) = (force(&of(vec![obstacle(0.0)]), &state), force(&of(vec![obstacle(1.0)]), &state));
    for k in 0..2 {
        assert_relative_eq!(both[k], one[k] + other[k], max_relative = ROUNDING);
    }
}

#[test]
fn options_and_obstacles_out_of_range_are_refused_by_name() {
    let field = |potential, obstacles| match PotentialCoupling::new(potential, obstacles, 1) {
        Err(SkillError::InvalidConfig(error)) => error.field,
        other => panic!("{other:?}"),
    };
    let steep = PotentialConfig::Dynamic(DynamicPotential { exponent: 1.0, ..DynamicPotential::default() });
    assert_eq!(field(steep, vec![]), "dynamic.exponent");
    let near = PotentialConfig::Static(StaticPotential { reach: 0.0, ..StaticPotential::default() });
    assert_eq!(field(near, vec![]), "static.reach");
    let inverted = PointObstacle { center: vec![0.0], radius: -1.0 };
    assert_eq!(field(dynamic(), vec![inverted]), "obstacles[0].radius");
    let flat = PointObstacle { center: vec![0.0, 0.0], radius: 0.0 };
    let refused = PotentialCoupling::new(dynamic(), vec![flat], 1);
    assert!(matches!(refused, Err(SkillError::Dimension { found: 2, expected: 1, .. })));
}

proptest! {
    #[test]
    fn the_force_is_the_negative_gradient_of_the_potential(
        position in prop::array::uniform3(-1.5f64..1.5), velocity in prop::array::uniform3(-1.0f64..1.0),
        radius in 0.0f64..0.3, moving in any::<bool>(),
    ) {
        let coupling = about(if moving { dynamic() } else { fixed() }, &[0.1, -0.2, 0.3], radius);
        let near = Nearness::of(&coupling.obstacles[0], &state(&position, &velocity));
        // away from the clamp, the reach and the bend at θ = π/2, where the potential has no third derivative
        prop_assume!(near.distance(0.0) > 0.1 && (near.distance(0.0) - 2.0).abs() > 0.01);
        prop_assume!(!moving || near.cosine.abs() > 0.01);
        let found = force(&coupling, &state(&position, &velocity));
        for k in 0..3 {
            let at = |shift: f64| {
                let mut position = position;
                position[k] += shift;
                coupling.potential(&state(&position, &velocity))
            };
            let slope = (at(STEP) - at(-STEP)) / (2.0 * STEP);
            prop_assert!((found[k] + slope).abs() < DIFFERENCE * (1.0 + slope.abs()), "{} {}", found[k], slope);
        }
    }
}
