//! Tests of the flanks' friction: a light food on a blade that is withdrawn, held still, and rocked on.

use super::*;

const CREEP_M_PER_S: f64 = 0.001;
/// Friction of both flanks of a blade in a meatball, N.
const STRENGTH_N: f64 = 2.5;

/// Speeds of a food of `mass_kg` on a blade that moves at `blade` for a second in steps of `dt`, under a load of `load_n`.
fn carried(mass_kg: f64, dt: f64, blade: f64, load_n: f64) -> Vec<f64> {
    let (mut grip, mut food) = (FlankGrip::default(), 0.0);
    let elasticity = Elasticity::new(4e3, mass_kg, dt);
    let friction = FlankFriction { strength: STRENGTH_N, creep_speed: CREEP_M_PER_S, share: 1.0 };
    let step = |_| {
        let sliding = grip.slide(Vector2::new(0.0, blade - food), &friction, &elasticity);
        let force = STRENGTH_N * (sliding.norm() / CREEP_M_PER_S).min(1.0) * sliding.y.signum();
        food += (force + load_n) / mass_kg * dt;
        food
    };
    (0..(1.0 / dt) as usize).map(step).collect()
}

#[test]
fn a_light_food_rides_on_a_blade_that_is_withdrawn_and_does_not_tremble() {
    for mass_kg in [0.001, 0.005, 0.03, 0.1] {
        for dt in [0.001, 0.00025] {
            let load_n = -9.81 * mass_kg;
            let speeds = carried(mass_kg, dt, 0.05, load_n);
            // it creeps down the blade by its weight's share of the friction
            let rest = 0.05 + CREEP_M_PER_S * load_n / STRENGTH_N;
            assert!((speeds[speeds.len() - 1] - rest).abs() < 1e-6, "{mass_kg} kg, {dt} s: {speeds:?}");
            // an elastic start swings over by less than itself, and reverses some times, not in every step
            assert!(speeds.iter().all(|speed| (-0.01..0.1).contains(speed)), "{mass_kg} kg, {dt} s");
            let turns =
                speeds.windows(3).filter(|three| (three[1] - three[0]) * (three[2] - three[1]) < -1e-12).count();
            assert!(turns < 20, "{mass_kg} kg, {dt} s: {turns} turns");
        }
    }
}

#[test]
fn a_load_beyond_friction_slides_with_what_is_left() {
    let speeds = carried(0.1, 0.001, 0.0, -4.5);
    // 2 N on 0.1 kg for a second, but for the elastic start
    assert!((speeds[999] / -20.0 - 1.0).abs() < 0.01, "{}", speeds[999]);
}

#[test]
fn a_held_food_feels_all_of_the_friction_against_the_motion() {
    let (mut grip, elasticity) = (FlankGrip::default(), Elasticity::new(4e3, 0.03, 0.001));
    let friction = FlankFriction { strength: STRENGTH_N, creep_speed: CREEP_M_PER_S, share: 0.5 };
    let velocity = Vector2::new(0.012, -0.016);
    for _ in 0..2000 {
        grip.slide(velocity, &friction, &elasticity);
    }
    let sliding = grip.slide(velocity, &friction, &elasticity);
    assert!((sliding - velocity).norm() < 1e-9, "{sliding}");
    // the spring holds what slides: F²/(2 k) with half of the stiffness of 0.25 m/dt²
    let stiffness = 0.5 * 4e3_f64.min(0.25 * 0.03 / 1e-6);
    assert!((grip.stored_j() / (0.5 * STRENGTH_N * STRENGTH_N / stiffness) - 1.0).abs() < 1e-6);
}

#[test]
fn nothing_to_hold_to_slides_at_once() {
    let friction = FlankFriction { strength: STRENGTH_N, creep_speed: CREEP_M_PER_S, share: 0.0 };
    let velocity = Vector2::new(0.01, 0.02);
    assert_eq!(FlankGrip::default().slide(velocity, &friction, &Elasticity::new(4e3, 0.03, 0.001)), velocity);
}
