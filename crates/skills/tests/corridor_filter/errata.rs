//! Errata of Eqs. (31), (32), Theorem 1 and its proof: what is printed fails, what is used holds.

use proptest::prelude::*;
use skills::corridor::{Bounds, Corridor};
use skills::corridor_filter::{
    AxisFilter, AxisSample, AxisTask, CorridorFilter, CorridorFilterConfig, Integration, Logit, Published, TheoremOne,
    barrier,
};
use skills::time_law::PathState;

use crate::cases::{Wave, run, skill, still};

const STEP_S: f64 = 1e-3;

fn theorem(k_lambda: f64) -> TheoremOne {
    TheoremOne { k_lambda, k_z: 1e-3, ..TheoremOne::default() }
}

fn between(lower: f64, upper: f64, position: f64, first: f64) -> AxisSample {
    AxisSample { skill: PathState { position, first, second: 0.0 }, bounds: Bounds::still(lower, upper) }
}

/// V̇ of Eq. (31) by differences along the printed law, τ = 1, bounds and velocity of the skill constant.
fn printed_lyapunov_rate(law: &Published, at: &AxisSample, motion: PathState) -> f64 {
    let value = |t: f64| {
        let attraction =
            law.alpha * (0.25 * law.alpha * (motion.position - at.skill.position) + motion.first - at.skill.first);
        let second = law.additional_term(1.0, at, motion) - attraction;
        let first = motion.first + t * second;
        let position = motion.position + t * (motion.first + 0.5 * t * second);
        let skill = PathState { position: at.skill.position + t * at.skill.first, ..at.skill };
        let z2 = first - law.virtual_velocity(1.0, &AxisSample { skill, ..*at }, position);
        barrier::lyapunov(&at.bounds, position, law.k_n, 1.0, z2)
    };
    (value(1e-7) - value(-1e-7)) / 2e-7
}

/// Largest |x^N| between bounds at ±1 from the middle with z₂(0) = `speed`, skill at rest.
fn farthest(law: &CorridorFilterConfig, speed: f64) -> f64 {
    let task =
        AxisTask { coordinate: 0, start: 0.0, goal: 0.0, goal_bounds: Bounds::still(-1.0, 1.0), duration_s: 1.0 };
    let mut axis = AxisFilter::begin(law, &task, &between(-1.0, 1.0, 0.0, speed)).unwrap();
    let at_rest = between(-1.0, 1.0, 0.0, 0.0);
    (0..5000).map(|_| axis.step(&at_rest, STEP_S).unwrap().position.abs()).fold(0.0, f64::max)
}

#[test]
fn e6_the_printed_gain_is_too_small_near_a_bound_and_the_used_one_is_not() {
    // on the way out close to a bound, where x − M = z₂/2 leaves nothing but z₂² terms: V̇ = (1/4D − k_z − 1/W²)z₂²
    let (at, motion) = (between(-1.0, 1.0, 0.0, 0.0), PathState { position: 0.99, first: 0.99, second: 0.0 });
    let printed = printed_lyapunov_rate(&Published::default(), &at, motion);
    assert!((printed - (0.25 / (0.01 * 1.99) - 1e-3 - 0.25) * 1.98 * 1.98).abs() < 1e-3, "{printed}");
    assert!(printed > 40.0);
    let used = theorem(1.0).lyapunov_rate(1.0, &at.bounds, motion);
    assert!((used + 1e-3 * 1.98 * 1.98).abs() < 1e-12, "{used}");
}

#[test]
fn e6_a_fast_start_leaves_under_the_printed_gain_only() {
    // z₁ = z₂(0)(e^{−Kt} − e^{−t})/(1 − K) passes 1 from z₂(0) = 1.589 on, K = 0.251
    let printed = CorridorFilterConfig::Published(Published::default());
    assert!(farthest(&printed, 1.57) < 1.0);
    assert!(farthest(&printed, 1.61) > 1.0);
    for integration in [Integration::Explicit, Integration::Transformed] {
        let used = TheoremOne { integration, ..theorem(1.0) };
        assert!(farthest(&CorridorFilterConfig::TheoremOne(used), 1.61) < 1.0);
    }
}

proptest! {
    #[test]
    fn e6_the_inequality_points_the_other_way(lower in -5.0..5.0f64, width in 1e-3..10.0f64, place in 0.001..0.999f64) {
        let bounds = Bounds::still(lower, lower + width);
        let clearance = barrier::clearance(&bounds, lower + place * width);
        prop_assert!(0.25 / clearance >= (1.0 - 1e-9) / (width * width));
    }

    #[test]
    fn the_lyapunov_function_is_at_least_zero_and_infinite_outside(
        lower in -5.0..5.0f64, width in 1e-3..10.0f64, place in -1.0..2.0f64, z2 in -10.0..10.0f64,
    ) {
        let value = barrier::lyapunov(&Bounds::still(lower, lower + width), lower + place * width, 1.0, 1.0, z2);
        // ½·log(1) of a rounded 1
        prop_assert!(value >= 0.5 * z2 * z2 - 1e-9);
        prop_assert!(value.is_finite() == (place > 0.0 && place < 1.0));
    }
}

#[test]
fn e7_a_moving_skill_makes_the_printed_function_rise_though_its_bounds_stand_still() {
    // x^NL and x^NH are fixed, h̄ and h̲ are not: they contain x^u. z₂ = 0, so that the gain has no part in it:
    // V̇ = (x − M)ẋ/D with ẋ = ẋ^u − (x − M)
    let (at, motion) = (between(-1.0, 1.0, 0.0, 2.0), PathState { position: 0.5, first: 1.5, second: 0.0 });
    let printed = printed_lyapunov_rate(&Published::default(), &at, motion);
    assert!((printed - 0.5 * 1.5 / 0.75).abs() < 1e-5, "{printed}");
    assert!(theorem(1.0).lyapunov_rate(1.0, &at.bounds, motion) < 0.0);
}

#[test]
fn e7_moving_bounds_are_left_without_their_derivatives_in_the_law() {
    // the corridor swings with a speed of 4 about a skill at rest, half as wide as it swings
    let at = |t: f64| {
        let swing = |mean: f64| PathState {
            position: mean + (4.0 * t).sin(),
            first: 4.0 * (4.0 * t).cos(),
            second: -16.0 * (4.0 * t).sin(),
        };
        AxisSample { skill: still(0.0), bounds: Bounds { lower: swing(-0.25), upper: swing(0.25) } }
    };
    let step = 1e-4;
    let times = |row: u32| step * f64::from(row);
    // the printed λ with the corrected gain
    let fixed_gain = |at: &AxisSample, motion: PathState| {
        let clearance = barrier::clearance(&at.bounds, motion.position);
        let z2 = motion.first - (at.bounds.middle().position - motion.position);
        -motion.first - (1e-3 + 0.25 / clearance) * z2
    };
    let mut motion = PathState::default();
    let left = (1..10_000).any(|row| {
        motion.first += step * fixed_gain(&at(times(row - 1)), motion);
        motion.position += step * motion.first;
        at(times(row)).bounds.margin(motion.position) <= 0.0
    });
    assert!(left);
    for integration in [Integration::Explicit, Integration::Transformed] {
        let law = CorridorFilterConfig::TheoremOne(TheoremOne { integration, ..theorem(1.0) });
        let task = AxisTask { coordinate: 0, start: 0.0, goal: 0.0, goal_bounds: at(1.0).bounds, duration_s: 1.0 };
        let mut axis = AxisFilter::begin(&law, &task, &at(0.0)).unwrap();
        for row in 1..10_000 {
            let motion = axis.step(&at(times(row)), step).unwrap();
            assert!(at(times(row)).bounds.margin(motion.position) > 0.0, "{row}");
        }
    }
}

#[test]
fn e8_the_printed_law_leads_to_the_middle_of_the_corridor_and_the_default_to_the_skill() {
    // a skill that rests at its goal, 0.3, between −1 and 0.6: the middle is −0.2
    let at_goal = skill(0.01, 40.0, |_| still(0.3));
    let corridor = Corridor::still(&[-1.0], &[0.6]).unwrap();
    let end = |law: &CorridorFilterConfig| run(law, &at_goal, &corridor, 0.3).unwrap().rollout.positions().end()[0];
    assert!((end(&CorridorFilterConfig::Published(Published::default())) + 0.2).abs() < 1e-3);
    assert!((end(&CorridorFilterConfig::TheoremOne(TheoremOne::default())) + 0.2).abs() < 1e-3);
    assert_eq!(end(&CorridorFilterConfig::default()), 0.3);
}

#[test]
fn e9_the_printed_law_is_still_under_way_at_the_end_and_the_default_is_not() {
    // both start beside the point they lead to, 0, between −0.5 and 0.5
    let at_rest = |start: f64| skill(STEP_S, 1.0, move |_| still(start));
    let corridor = Corridor::still(&[-0.5], &[0.5]).unwrap();
    let printed = CorridorFilterConfig::Published(Published::default());
    let left = run(&printed, &at_rest(-0.25), &corridor, -0.25).unwrap().rollout.positions().end()[0] / -0.25;
    assert!(left > (-1.0f64).exp(), "{left}");
    // the default's own deviation, (1 + α/2)e^{−α/2} in the logit
    let task =
        AxisTask { coordinate: 0, start: -0.25, goal: 0.0, goal_bounds: Bounds::still(-0.5, 0.5), duration_s: 1.0 };
    let at = between(-0.5, 0.5, 0.0, 0.0);
    let mut axis = AxisFilter::begin(&CorridorFilterConfig::default(), &task, &at).unwrap();
    let used = axis.step(&at, 1.0).unwrap().position / -0.25;
    assert!(used < 1e-4, "{used}");
}

#[test]
fn e9_a_fast_virtual_velocity_alone_does_not_make_the_corrected_law_fast() {
    let beside = skill(STEP_S, 1.0, |_| still(-0.25));
    let corridor = Corridor::still(&[-0.5], &[0.5]).unwrap();
    let left = |k_lambda: f64, k_z: f64| {
        let law = CorridorFilterConfig::TheoremOne(TheoremOne { k_lambda, k_z, ..TheoremOne::default() });
        run(&law, &beside, &corridor, -0.25).unwrap().rollout.positions().end()[0] / -0.25
    };
    // z₂ decays with (k_z + 1/(4k_λτD))/(k_nτ), here at most k_z + 4/(3k_λ) to k_z + 1/k_λ
    assert!(left(10.0, 1e-3) > left(1.0, 1e-3) && left(10.0, 1e-3) > 0.8);
    // both modes at 10/τ or faster: less than (1 + 10)e^{−10}
    assert!(left(10.0, 10.0) < 5.0e-4, "{}", left(10.0, 10.0));
}

#[test]
fn e10_it_is_k_z_that_has_to_be_positive() {
    // where x − M = z₂/(2k_λ), V̇ = −k_z·z₂²: z₂ = 2, x = 0.1, k_λ = 10
    let bounds = Bounds::still(-1.0, 1.0);
    let rate = |k_z: f64| {
        let law = TheoremOne { k_z, ..TheoremOne::default() };
        let motion = PathState { position: 0.1, first: 2.0 - 1.0, second: 0.0 };
        assert!((law.z2(1.0, &bounds, motion) - 2.0).abs() < 1e-12);
        law.lyapunov_rate(1.0, &bounds, motion)
    };
    assert!((rate(0.5) + 2.0).abs() < 1e-12);
    assert!(rate(0.0).abs() < 1e-12);
    assert!(rate(-0.5) > 0.0);
    assert!(TheoremOne { k_z: -0.5, ..TheoremOne::default() }.validate().is_err());
    assert!(Published { k_z: -0.5, ..Published::default() }.validate().is_err());
}

#[test]
fn neither_form_of_theorem_1_regards_the_skill_inside_the_corridor() {
    use rand::SeedableRng;
    // the corrected law yields the same motion for another skill with the same start
    let wave = Wave::random(&mut rand_chacha::ChaCha8Rng::seed_from_u64(1), 0.2, 3.0..6.0, 2);
    let (one, other) = (skill(0.01, 1.0, |t| wave.at(t)), skill(0.01, 1.0, |_| still(0.0)));
    let corridor = Corridor::still(&[-1.0], &[0.5]).unwrap();
    let law = CorridorFilterConfig::TheoremOne(TheoremOne::default());
    let end = |skill| run(&law, skill, &corridor, 0.0).unwrap().rollout;
    assert_eq!(end(&one), end(&other));
    let law = CorridorFilterConfig::Logit(Logit::default());
    let end = |skill| run(&law, skill, &corridor, 0.0).unwrap().rollout;
    assert_ne!(end(&one), end(&other));
}
