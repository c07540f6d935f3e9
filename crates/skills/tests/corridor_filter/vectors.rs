//! Reference vectors made with an independent Python program: `data/barrier.json`, `data/cdmp_literal_closed_loop.json`
//! and the saturation in `data/sigmoid.json`.

use approx::assert_relative_eq;
use nalgebra::dvector;
use serde_json::Value;
use skills::corridor::{Bounds, Corridor};
use skills::corridor_filter::{
    AxisSample, CorridorFilterConfig, Ecbf, FilterRequest, Logit, Published, SmoothSaturation, TheoremOne,
    additional_term, barrier, constrain,
};
use skills::time_law::PathState;

use crate::cases::{plus, run, skill, still, transfer};

/// Both programs work in double precision; sums of numbers of order 100 cancel to order one.
const VECTORS: f64 = 1e-12;
/// Agreement asked of a rollout: 50 steps of exact maps.
const ROLLOUT: f64 = 1e-9;

fn barrier_file() -> Value {
    serde_json::from_str(include_str!("../data/barrier.json")).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

struct State {
    duration_s: f64,
    sample: AxisSample,
    motion: PathState,
    k_n: f64,
    k_z: f64,
    k_lambda: f64,
    goal: f64,
    forcing: f64,
    expected: Value,
}

fn states() -> Vec<State> {
    let states = barrier_file()["states"].as_array().unwrap().clone();
    let state = |file: &Value| {
        let at = |key: &str| number(&file[key]);
        let path = |keys: [&str; 3]| PathState { position: at(keys[0]), first: at(keys[1]), second: at(keys[2]) };
        let bounds = Bounds { lower: path(["L", "Ld", "Ldd"]), upper: path(["H", "Hd", "Hdd"]) };
        State {
            duration_s: at("tau"),
            sample: AxisSample { skill: path(["xu", "xud", "xudd"]), bounds },
            motion: PathState { position: at("xN"), first: at("vN") / at("tau"), second: 0.0 },
            k_n: at("kn"),
            k_z: at("kz"),
            k_lambda: at("kl"),
            goal: at("g"),
            forcing: at("fu"),
            expected: file["out"].clone(),
        }
    };
    states.iter().map(state).collect()
}

fn assert_entry(found: f64, expected: &Value, key: &str) {
    assert_relative_eq!(found, number(&expected[key]), max_relative = VECTORS, epsilon = VECTORS);
}

#[test]
fn the_published_law_agrees_with_the_reference() {
    for State { duration_s, sample, motion, k_n, k_z, expected, .. } in states() {
        let law = Published { k_n, k_z, alpha: 25.0 };
        let lambda = law.virtual_velocity(duration_s, &sample, motion.position);
        let z2 = duration_s * motion.first - lambda;
        assert_entry(lambda, &expected, "lambda_pub");
        assert_entry(z2, &expected, "z2_pub");
        assert_entry(law.additional_term(duration_s, &sample, motion), &expected, "du_pub");
        assert_entry(barrier::lyapunov(&sample.bounds, motion.position, k_n, duration_s, z2), &expected, "V_pub");
    }
}

#[test]
fn the_corrected_law_agrees_with_the_reference() {
    for State { duration_s, sample, motion, k_n, k_z, k_lambda, goal, forcing, expected } in states() {
        let (law, bounds) = (TheoremOne { k_lambda, k_n, k_z, ..TheoremOne::default() }, sample.bounds);
        assert_entry(law.virtual_velocity(duration_s, &bounds, motion.position), &expected, "lambda_cor");
        assert_entry(law.virtual_velocity_rate(duration_s, &bounds, motion), &expected, "lambda_dot_cor");
        assert_entry(law.z2(duration_s, &bounds, motion), &expected, "z2_cor");
        let motion = PathState { second: law.acceleration(duration_s, &bounds, motion), ..motion };
        assert_entry(duration_s * duration_s * motion.second, &expected, "tau_vdot_cor");
        assert_entry(additional_term(25.0, duration_s, goal, forcing, motion), &expected, "du_cor");
        assert_entry(law.lyapunov(duration_s, &bounds, motion), &expected, "V_cor");
        assert_entry(law.lyapunov_rate(duration_s, &bounds, motion), &expected, "Vdot_cor");
    }
}

#[test]
fn the_barrier_conditions_agree_with_the_reference() {
    for State { sample, motion, expected, .. } in states() {
        let rate = number(&expected["ecbf_c"]);
        let filter = Ecbf { rate_1: rate, rate_2: rate, ..Ecbf::default() };
        let [least, greatest] = filter.admitted(&sample.bounds, motion);
        assert_entry(least, &expected, "ecbf_lo");
        assert_entry(greatest, &expected, "ecbf_hi");
    }
}

#[test]
fn the_saturation_agrees_with_the_reference() {
    let file: Value = serde_json::from_str(include_str!("../data/sigmoid.json")).unwrap();
    let file = &file["smooth_sat"];
    let saturation = SmoothSaturation::new(number(&file["m"]), number(&file["d"])).unwrap();
    for (place, expected) in file["p"].as_array().unwrap().iter().zip(file["out"].as_array().unwrap()) {
        let found = saturation.apply(still(number(place))).position;
        assert_relative_eq!(found, number(expected), max_relative = VECTORS);
    }
}

// a·sin(πt)^2 with derivatives
fn sine_squared(t: f64) -> PathState {
    let pi = std::f64::consts::PI;
    let (sine, cosine) = (pi * t).sin_cos();
    let second = 2.0 * pi * pi * (cosine * cosine - sine * sine);
    PathState { position: sine * sine, first: 2.0 * pi * sine * cosine, second }
}

fn sine(t: f64) -> PathState {
    let pi = std::f64::consts::PI;
    let (sine, cosine) = (pi * t).sin_cos();
    PathState { position: sine, first: pi * cosine, second: -pi * pi * sine }
}

#[test]
fn the_logit_rollout_agrees_with_the_reference() {
    let file = &barrier_file()["logit_rollout"];
    let path = |t: f64| plus(transfer(t), sine_squared(t), 0.4);
    let bounds = |t: f64| Bounds {
        lower: plus(plus(transfer(t), sine(t), -0.1), still(1.0), -0.35),
        upper: plus(plus(transfer(t), sine_squared(t), -0.15), still(1.0), 0.35),
    };
    let step = number(&file["dt"]);
    let times = (0..=50).map(|row| f64::from(row) * step).collect();
    let corridor = Corridor::sampled(times, 1, |t, _| bounds(t)).unwrap();
    let law = Logit { margin: number(&file["m"]), alpha: number(&file["alpha"]), feed_forward: true };
    let start = Some(dvector![number(&file["x_start"])]);
    let request = FilterRequest { start, goal: dvector![1.0], duration_s: number(&file["tau"]) };
    let skill = skill(step, 1.0, path);
    let found = constrain(&CorridorFilterConfig::Logit(law), &skill, &corridor, &request).unwrap();
    for (row, expected) in file["idx"].as_array().unwrap().iter().zip(file["xN"].as_array().unwrap()) {
        let row = row.as_u64().unwrap() as usize;
        assert_relative_eq!(found.rollout.positions().samples()[(row, 0)], number(expected), epsilon = ROLLOUT);
    }
    let axis = found.certificate.axes[0];
    let at_samples = axis.lower.at_samples.min(axis.upper.at_samples);
    assert_relative_eq!(at_samples, number(&file["min_margin"]), epsilon = ROLLOUT);
    assert_relative_eq!(axis.goal_error, number(&file["end_err"]), epsilon = ROLLOUT);
    assert!(found.certificate.holds());
}

#[test]
fn the_printed_closed_loop_has_the_poles_of_the_reference_whatever_alpha() {
    let file: Value = serde_json::from_str(include_str!("../data/cdmp_literal_closed_loop.json")).unwrap();
    let (k_n, k_z, width) = (number(&file["kn"]), number(&file["kz"]), number(&file["Delta"]));
    let poles: Vec<f64> = file["poles"].as_array().unwrap().iter().map(number).collect();
    let gain = (k_z + 1.0 / (width * width)) / k_n;
    assert_relative_eq!(gain, number(&file["K"]), max_relative = VECTORS);
    // from z₁(0) = −Δ/4 below the middle, at rest: z₁ is a sum of both modes
    let (step, end_s) = (1e-4, 2.0);
    let at_rest = skill(step, end_s, |_| still(-0.25 * width));
    let corridor = Corridor::still(&[-0.5 * width], &[0.5 * width]).unwrap();
    let response = |alpha: f64| {
        let law = CorridorFilterConfig::Published(Published { k_n, k_z, alpha });
        run(&law, &at_rest, &corridor, 0.0).unwrap().rollout.positions().samples().clone()
    };
    let found = response(25.0);
    for row in [2_000, 5_000, 10_000, 20_000] {
        let t = row as f64 * step;
        let modes = (poles[1] * (poles[0] * t).exp() - poles[0] * (poles[1] * t).exp()) / (poles[1] - poles[0]);
        // Euler's steps err by their length times the second derivative, of order one
        assert_relative_eq!(found[(row, 0)], -0.25 * width * modes, epsilon = 0.25 * width * step);
    }
    // α and β cancel up to rounding
    assert_relative_eq!(response(3.0), found, epsilon = 1e-10);
}
