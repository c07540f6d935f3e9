//! Theorem 1 as corrected: its Lyapunov function falls, and an implicit step always has a solution.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use proptest::prelude::*;

use super::*;

// bounds and motion about the middle of a corridor that moves, breathes and bends
fn case() -> impl Strategy<Value = (Bounds, PathState)> {
    let rates = || (-2.0..2.0f64, -5.0..5.0f64);
    (rates(), rates(), 0.2..3.0f64, 0.02..0.98f64, -3.0..3.0f64).prop_map(|(low, high, width, place, first)| {
        let state = |position, (first, second)| PathState { position, first, second };
        let bounds = Bounds { lower: state(-0.3, low), upper: state(width - 0.3, high) };
        (bounds, PathState { position: width * place - 0.3, first, second: 0.0 })
    })
}

// state after a time t under constant accelerations
fn drift(state: PathState, t: f64) -> PathState {
    let first = state.first + t * state.second;
    PathState { position: state.position + t * (state.first + 0.5 * t * state.second), first, ..state }
}

fn drift_bounds(bounds: &Bounds, t: f64) -> Bounds {
    Bounds { lower: drift(bounds.lower, t), upper: drift(bounds.upper, t) }
}

proptest! {
    #[test]
    fn lyapunov_rate_is_the_difference_quotient_along_the_law_and_never_positive(
        (bounds, motion) in case(), duration_s in 0.5..2.0f64, k_lambda in 0.5..20.0f64, k_n in 0.2..5.0f64, k_z in 0.0..2.0f64,
    ) {
        let law = TheoremOne { k_lambda, k_n, k_z, ..TheoremOne::default() };
        let motion = PathState { second: law.acceleration(duration_s, &bounds, motion), ..motion };
        let rate = law.lyapunov_rate(duration_s, &bounds, motion);
        let value = |t: f64| law.lyapunov(duration_s, &drift_bounds(&bounds, t), drift(motion, t));
        prop_assert!(rate <= 0.0 && value(0.0) >= 0.0);
        // the time scale of the state is clearance over speed and speed over acceleration; the quotient errs by its square
        let scale = bounds.margin(motion.position) / (5.0 + motion.first.abs());
        let scale = scale.min((1.0 + motion.first.abs()) / (1.0 + motion.second.abs()));
        let step = 1e-4 * scale;
        let quotient = (value(step) - value(-step)) / (2.0 * step);
        let noise = 1e-14 * (1.0 + value(0.0)) / step;
        prop_assert!((quotient - rate).abs() <= 1e-5 * (1.0 + rate.abs()) + noise, "{quotient} {rate}");
    }

    #[test]
    fn an_implicit_step_is_solved_and_stays_inside_for_every_length(
        place in -0.999_999..0.999_999f64, z2 in -1e3..1e3f64, ratio in 1e-6..1e3f64, width in 0.01..10.0f64,
    ) {
        let eta = f64::atanh(place);
        let step = ImplicitStep::new(&TheoremOne::default(), eta, z2, ratio, width, 1.0);
        let solved = step.solve();
        prop_assert!(solved.abs() <= LARGEST_ETA && solved.tanh().abs() < 1.0);
        // rounding of the terms times the slope
        let (defect, slope) = step.defect(solved);
        prop_assert!(defect.abs() <= 1e-11 * (1.0 + slope.abs()) * (1.0 + solved.abs()), "{defect} {slope}");
    }
}

#[test]
fn both_integrations_agree_for_small_steps() {
    let at = |t: f64| {
        let wave = PathState { position: 0.5 * t.sin(), first: 0.5 * t.cos(), second: -0.5 * t.sin() };
        let bounds = Bounds {
            lower: PathState { position: wave.position - 1.0, ..wave },
            upper: PathState {
                position: 0.3 * wave.position + 1.0,
                first: 0.3 * wave.first,
                second: 0.3 * wave.second,
            },
        };
        AxisSample { skill: PathState::default(), bounds }
    };
    let run = |integration, step: f64| {
        let law = TheoremOne { integration, ..TheoremOne::default() };
        let goal_bounds = Bounds::still(-1.0, 1.0);
        let task = AxisTask { coordinate: 0, start: 0.8, goal: 0.0, goal_bounds, duration_s: 1.0 };
        let (mut axis, mut motion) = law.begin(&task, &at(0.0));
        for row in 1..=(0.3 / step).round() as u32 {
            motion = axis.step(motion, &at(step * f64::from(row)), step);
        }
        motion
    };
    let (explicit, transformed) = (run(Integration::Explicit, 1e-5), run(Integration::Transformed, 1e-5));
    // both are of first order
    assert_abs_diff_eq!(explicit.position, transformed.position, epsilon = 1e-4);
    assert_abs_diff_eq!(explicit.first, transformed.first, epsilon = 1e-3);
    let coarse = run(Integration::Transformed, 1e-3);
    assert_abs_diff_eq!(coarse.position, transformed.position, epsilon = 1e-2);
}

#[test]
fn velocity_on_the_virtual_one_follows_the_corridor_to_its_middle() {
    // z₂ = 0: τ d(x − M)/dt = −k_λ(x − M) + τ(x − M)Ẇ/W, here with Ẇ = 0
    let law = TheoremOne::default();
    let bounds = Bounds::still(-1.0, 1.0);
    assert_relative_eq!(law.virtual_velocity(2.0, &bounds, 0.5), -5.0);
    let motion = PathState { position: 0.5, first: -2.5, second: 0.0 };
    assert_abs_diff_eq!(law.z2(2.0, &bounds, motion), 0.0);
    // then τẍ = λ̇ = −k_λẋ
    assert_relative_eq!(law.acceleration(2.0, &bounds, motion), 12.5);
}
