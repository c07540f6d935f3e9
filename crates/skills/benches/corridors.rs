//! Cost of keeping a skill inside a corridor: one step of each law for one coordinate on the same inputs, alone and
//! with the primitive that makes the skill, and the cost of smoothing bounds and of a certificate.
//!
//! "lite" of the paper is `published`, its predecessor is only there as `original_reconstruction`. What the faster of
//! them does not guarantee is told in `skills::corridor_filter`.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{DMatrix, dvector};
use skills::corridor::smoothing::{SmoothingConfig, smooth};
use skills::corridor::{Bounds, Corridor};
use skills::corridor_filter::{
    AxisFilter, AxisSample, AxisTask, CorridorFilterConfig, Ecbf, FilterRequest, Integration, Logit,
    OriginalReconstruction, Published, SmoothSaturation, TheoremOne, constrain,
};
use skills::time_law::{PathState, minimum_jerk};
use skills::{Dmp, DmpConfig, DmpStepper, MovementPrimitive, RolloutRequest, Trajectory};

const STEP_S: f64 = 0.001;
const STEPS: usize = 1000;
/// α of the plain attractor.
const ALPHA: f64 = 25.0;

/// Bounds that move about a skill from 0 to 1, which touches them for part of the time.
fn bounds(t: f64) -> Bounds {
    let swing = |mean: f64, height: f64, rate: f64| {
        let angle = rate * t;
        PathState {
            position: mean + height * angle.sin(),
            first: height * rate * angle.cos(),
            second: -height * rate * rate * angle.sin(),
        }
    };
    Bounds { lower: swing(-0.3, 0.2, 3.0), upper: swing(0.9, 0.3, 5.0) }
}

fn demonstration() -> Trajectory {
    let position = |row: usize| {
        let t = row as f64 / 500.0;
        minimum_jerk(t) + 0.3 * (3.0 * std::f64::consts::PI * t).sin() * 16.0 * (t * (1.0 - t)).powi(2)
    };
    Trajectory::uniform(0.002, DMatrix::from_fn(501, 1, |row, _| position(row))).expect("a valid trajectory")
}

fn learned(bases: usize) -> Dmp {
    Dmp::learn(&DmpConfig { bases, ..DmpConfig::default() }, &[demonstration()]).expect("a valid demonstration")
}

fn request() -> RolloutRequest {
    RolloutRequest::new(dvector![0.0], dvector![1.0], 1.0, STEP_S)
}

fn stepper(dmp: &Dmp) -> DmpStepper {
    dmp.stepper(&request()).expect("a valid request")
}

fn state(stepper: &DmpStepper) -> PathState {
    let (position, first) = (stepper.position()[0], stepper.velocity()[0]);
    PathState { position, first, second: stepper.acceleration()[0] }
}

fn samples() -> Vec<AxisSample> {
    let mut stepper = stepper(&learned(50));
    let mut samples = vec![AxisSample { skill: state(&stepper), bounds: bounds(0.0) }];
    for row in 1..=STEPS {
        stepper.step(STEP_S).expect("a valid step");
        samples.push(AxisSample { skill: state(&stepper), bounds: bounds(row as f64 * STEP_S) });
    }
    samples
}

fn laws() -> Vec<(&'static str, CorridorFilterConfig)> {
    let explicit = TheoremOne { integration: Integration::Explicit, ..TheoremOne::default() };
    let late = Logit { feed_forward: false, ..Logit::default() };
    vec![
        ("published", CorridorFilterConfig::Published(Published::default())),
        ("original_reconstruction", CorridorFilterConfig::OriginalReconstruction(OriginalReconstruction::default())),
        ("theorem_one_explicit", CorridorFilterConfig::TheoremOne(explicit)),
        ("theorem_one_transformed", CorridorFilterConfig::TheoremOne(TheoremOne::default())),
        ("logit", CorridorFilterConfig::Logit(Logit::default())),
        ("logit_no_feed_forward", CorridorFilterConfig::Logit(late)),
        ("ecbf_sampled", CorridorFilterConfig::Ecbf(Ecbf::default())),
    ]
}

fn begin(config: &CorridorFilterConfig, samples: &[AxisSample]) -> AxisFilter {
    let goal_bounds = bounds(1.0);
    let task = AxisTask { coordinate: 0, start: samples[0].skill.position, goal: 0.5, goal_bounds, duration_s: 1.0 };
    AxisFilter::begin(config, &task, &samples[0]).expect("a start inside")
}

/// A thousand steps of the law alone; the printed time over a thousand is that of a step.
fn law_alone(criterion: &mut Criterion) {
    let samples = samples();
    let mut group = criterion.benchmark_group("thousand_steps_of_the_law");
    for (name, config) in laws() {
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let mut axis = begin(&config, &samples);
                for sample in &samples[1..] {
                    black_box(axis.step(black_box(sample), STEP_S).expect("a step"));
                }
            });
        });
    }
    group.bench_function("static_saturation", |bencher| {
        let saturation = SmoothSaturation::new(0.3, 0.075).expect("valid margins");
        bencher.iter(|| {
            for sample in &samples[1..] {
                let (sample, lower) = (black_box(sample), sample.bounds.lower.position);
                let place = saturation.apply(sample.place()).position;
                black_box(lower + sample.bounds.width().position * place);
            }
        });
    });
    group.bench_function("plain_attractor", |bencher| {
        bencher.iter(|| {
            let (mut position, mut velocity) = (0.0, 0.0);
            for sample in &samples[1..] {
                // the skill's acceleration stands for the forcing term
                let forcing = black_box(sample).skill.second;
                velocity += STEP_S * (ALPHA * (0.25 * ALPHA * (1.0 - position) - velocity) + forcing);
                position += STEP_S * velocity;
                black_box(position);
            }
        });
    });
    group.finish();
}

/// A thousand steps of the primitive with n bases, and of the law on what it yields.
fn with_forcing_term(criterion: &mut Criterion) {
    let samples = samples();
    for bases in [20, 50] {
        let dmp = learned(bases);
        let mut group = criterion.benchmark_group(format!("thousand_steps_with_{bases}_bases"));
        group.bench_function("plain", |bencher| {
            bencher.iter(|| {
                let mut stepper = stepper(&dmp);
                for _ in 0..STEPS {
                    stepper.step(STEP_S).expect("a step");
                }
                black_box(state(&stepper))
            });
        });
        for (name, config) in laws() {
            group.bench_function(name, |bencher| {
                bencher.iter(|| {
                    let (mut stepper, mut axis) = (stepper(&dmp), begin(&config, &samples));
                    for sample in &samples[1..] {
                        stepper.step(STEP_S).expect("a step");
                        let sample = AxisSample { skill: state(&stepper), bounds: sample.bounds };
                        black_box(axis.step(&sample, STEP_S).expect("a step"));
                    }
                });
            });
        }
        group.finish();
    }
}

/// A whole constrained rollout with its certificate, and smoothing of 1001 samples of bounds.
fn whole(criterion: &mut Criterion) {
    let skill = learned(50).rollout(&request()).expect("a valid request");
    let times: Vec<f64> = (0..=100).map(|row| 0.01 * f64::from(row)).collect();
    let corridor = Corridor::sampled(times, 1, |t, _| bounds(t)).expect("open bounds");
    let task = FilterRequest { start: None, goal: dvector![0.5], duration_s: 1.0 };
    criterion.bench_function("constrain_and_certify_thousand_steps", |bencher| {
        let config = CorridorFilterConfig::default();
        bencher.iter(|| black_box(constrain(&config, &skill, &corridor, &task).expect("a start inside")));
    });
    let times: Vec<f64> = (0..=STEPS).map(|row| row as f64 * STEP_S).collect();
    let table = |of: fn(Bounds) -> f64| DMatrix::from_fn(times.len(), 1, |row, _| of(bounds(times[row])));
    let (lower, upper) = (table(|at| at.lower.position), table(|at| at.upper.position));
    criterion.bench_function("smooth_thousand_bounds", |bencher| {
        let config = SmoothingConfig { half_window_s: 0.01, ..SmoothingConfig::default() };
        bencher.iter(|| black_box(smooth(&config, &times, &lower, &upper).expect("open bounds")));
    });
}

criterion_group!(benches, law_alone, with_forcing_term, whole);
criterion_main!(benches);
