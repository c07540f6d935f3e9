//! The logit law: never outside, the skill to the bit where it is well inside.

use approx::assert_abs_diff_eq;
use proptest::prelude::*;

use super::*;

fn state(position: f64, first: f64, second: f64) -> PathState {
    PathState { position, first, second }
}

fn task(start: f64) -> AxisTask {
    AxisTask { coordinate: 0, start, goal: 0.0, goal_bounds: Bounds::still(-1.0, 1.0), duration_s: 1.0 }
}

// skill and bounds that move smoothly, the skill out of the bounds at times
fn wave(t: f64) -> AxisSample {
    let sine = |mean: f64, height: f64, rate: f64, phase: f64| {
        let angle = rate * t + phase;
        state(mean + height * angle.sin(), height * rate * angle.cos(), -height * rate * rate * angle.sin())
    };
    AxisSample {
        skill: sine(0.0, 1.1, 2.0, 0.0),
        bounds: Bounds { lower: sine(-1.0, 0.3, 1.5, 0.4), upper: sine(1.0, 0.2, 2.5, 1.0) },
    }
}

#[test]
fn a_skill_well_inside_is_kept_to_the_bit() {
    let sample = |t: f64| AxisSample { skill: state(0.1 * t, 0.1, 0.0), bounds: Bounds::still(-1.0, 1.0) };
    let (mut axis, motion) = Logit::default().begin(&task(0.0), &sample(0.0));
    assert_eq!(motion, sample(0.0).skill);
    for row in 1..30 {
        let to = sample(0.1 * f64::from(row));
        assert_eq!(axis.step(motion, &to, 0.1), to.skill);
    }
}

#[test]
fn a_start_beside_the_skill_decays_onto_it() {
    let at = AxisSample { skill: state(0.1, 0.0, 0.0), bounds: Bounds::still(-1.0, 1.0) };
    let (mut axis, first) = Logit::default().begin(&task(0.7), &at);
    assert_eq!((first.position, first.first), (0.7, 0.0));
    // e(t) = (1 + λt)e^{−λt}·e(0) with λ = α/2τ, in one step or in many
    let logit = |x: f64| f64::ln((1.0 + x) / (1.0 - x));
    let left = 13.5 * (-12.5f64).exp() * (logit(0.7) - logit(0.1));
    assert_abs_diff_eq!(logit(axis.step(first, &at, 1.0).position), logit(0.1) + left, epsilon = 1e-14);
    let (mut axis, mut motion) = Logit::default().begin(&task(0.7), &at);
    for _ in 0..100 {
        motion = axis.step(motion, &at, 0.01);
    }
    assert_abs_diff_eq!(logit(motion.position), logit(0.1) + left, epsilon = 1e-12);
}

#[test]
fn velocity_and_acceleration_are_those_of_the_position() {
    for feed_forward in [true, false] {
        let law = Logit { feed_forward, ..Logit::default() };
        let h = 1e-4;
        let (mut axis, mut motion) = law.begin(&task(0.5), &wave(0.0));
        let mut path = vec![motion];
        for row in 1..20_000 {
            motion = axis.step(motion, &wave(h * f64::from(row)), h);
            path.push(motion);
        }
        for around in path.windows(3) {
            let [before, at, after] = around else { panic!() };
            // the differences err by h² times derivatives of third order, of up to some ten thousand, at the kinks of S''
            // and of the linear reference without feed-forward by h times their jump
            let first = (after.position - before.position) / (2.0 * h);
            assert_abs_diff_eq!(at.first, first, epsilon = 1e-5);
            let second = (after.first - before.first) / (2.0 * h);
            assert_abs_diff_eq!(at.second, second, epsilon = 0.05);
        }
    }
}

#[test]
fn without_feed_forward_a_still_skill_is_reached_and_a_moving_one_followed_late() {
    let law = Logit { feed_forward: false, ..Logit::default() };
    let still = AxisSample { skill: state(0.3, 0.0, 0.0), bounds: Bounds::still(-1.0, 1.0) };
    let (mut axis, first) = law.begin(&task(-0.5), &still);
    assert_abs_diff_eq!(axis.step(first, &still, 10.0).position, 0.3, epsilon = 1e-15);
    // y_r = 0.2t, up to m: y is late by 4τ/α = 0.16 s
    let ramp = |t: f64| {
        let position = (0.1 * t).tanh();
        let first = 0.1 * (1.0 - position * position);
        AxisSample { skill: state(position, first, -0.2 * position * first), bounds: Bounds::still(-1.0, 1.0) }
    };
    let (mut axis, mut motion) = law.begin(&task(0.0), &ramp(0.0));
    for row in 1..=30 {
        motion = axis.step(motion, &ramp(0.1 * f64::from(row)), 0.1);
    }
    assert_abs_diff_eq!(2.0 * motion.position.atanh(), 0.2 * (3.0 - 0.16), epsilon = 1e-12);
}

proptest! {
    #[test]
    fn jumping_bounds_and_skills_are_never_left_whatever_the_step(
        jumps in prop::collection::vec((-10.0..10.0f64, 1e-3..5.0f64, -30.0..30.0f64, 1e-6..1e3f64), 1..40),
        start in 1e-6..0.999_999f64, feed_forward: bool, margin in 0.001..0.49f64,
    ) {
        let sample = |(lower, width, skill): (f64, f64, f64)| AxisSample {
            skill: state(skill, 0.0, 0.0),
            bounds: Bounds::still(lower, lower + width),
        };
        let law = Logit { margin, feed_forward, ..Logit::default() };
        let (mut axis, mut motion) = law.begin(&task(2.0 * start - 1.0), &sample((-1.0, 2.0, 0.3)));
        for (lower, width, skill, step) in jumps {
            let to = sample((lower, width, skill));
            motion = axis.step(motion, &to, step);
            prop_assert!(to.bounds.margin(motion.position) > 0.0);
            prop_assert!(motion.first.is_finite() && motion.second.is_finite());
        }
    }
}
