//! Cost of learning and rolling out each further kind of primitive, and of one control tick of the pose primitive.
//!
//! Demonstrations have 1000 samples over 1 s and rollouts 1000 steps; `dmp` is there to compare with.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{DMatrix, Isometry3, Vector3};
use skills::primitive::generalizing::GeneralizingConfig;
use skills::primitive::kernelized::KernelizedConfig;
use skills::primitive::pose::{PoseDmp, PoseRequest, PoseStepper, PoseTrajectory};
use skills::{DmpConfig, PrimitiveConfig, RolloutRequest, Trajectory};

const SAMPLES: usize = 1000;
const TIME_STEP_S: f64 = 0.001;

/// Six demonstrations of a weave in d coordinates that differ in their goals and heights.
fn demonstrations(dimension: usize) -> Vec<Trajectory> {
    let shown = |number: usize| {
        let at = |row: usize, k: usize| {
            let r = row as f64 / (SAMPLES - 1) as f64;
            let (reach, height) = (1.0 + 0.1 * (number + k) as f64, 0.3 + 0.05 * number as f64);
            reach * r * r * (3.0 - 2.0 * r) + height * (9.0 * r + k as f64).sin() * (r * (1.0 - r)).powi(2)
        };
        Trajectory::uniform(TIME_STEP_S, DMatrix::from_fn(SAMPLES, dimension, at)).expect("a trajectory")
    };
    (0..6).map(shown).collect()
}

fn kinds() -> [(&'static str, PrimitiveConfig); 3] {
    [
        ("dmp", PrimitiveConfig::Dmp(DmpConfig::default())),
        ("kernelized", PrimitiveConfig::Kernelized(KernelizedConfig::default())),
        ("generalizing", PrimitiveConfig::Generalizing(GeneralizingConfig::default())),
    ]
}

fn learn_and_roll_out(criterion: &mut Criterion) {
    for (name, config) in kinds() {
        for dimension in [2, 7] {
            let shown = demonstrations(dimension);
            let mut group = criterion.benchmark_group(format!("{name}, {dimension} coordinates"));
            for count in [1, 6] {
                let shown = &shown[..count];
                group.bench_function(format!("learn {count}"), |bench| {
                    bench.iter(|| config.learn(black_box(shown)).expect("a primitive"));
                });
            }
            let primitive = config.learn(&shown).expect("a primitive");
            let request = RolloutRequest::new(shown[0].start(), shown[3].end(), 1.0, TIME_STEP_S);
            group.bench_function("roll out", |bench| {
                bench.iter(|| primitive.rollout(black_box(&request)).expect("a rollout"));
            });
            group.finish();
        }
    }
}

/// A turn of 350 degrees along an arch.
fn screw() -> PoseTrajectory {
    let pose = |row: usize| {
        let r = row as f64 / (SAMPLES - 1) as f64;
        let along = r * r * (3.0 - 2.0 * r);
        Isometry3::new(Vector3::new(0.3 * along, r * (1.0 - r), 0.0), Vector3::z() * (350_f64.to_radians() * along))
    };
    let times_s = (0..SAMPLES).map(|row| row as f64 * TIME_STEP_S).collect();
    PoseTrajectory::new(times_s, (0..SAMPLES).map(pose).collect()).expect("a trajectory")
}

fn pose(criterion: &mut Criterion) {
    let shown = screw();
    let mut group = criterion.benchmark_group("pose");
    group.bench_function("learn 1", |bench| {
        bench.iter(|| {
            PoseDmp::learn(&DmpConfig::default(), black_box(std::slice::from_ref(&shown))).expect("a primitive")
        });
    });
    let primitive = PoseDmp::learn(&DmpConfig::default(), std::slice::from_ref(&shown)).expect("a primitive");
    let request = PoseRequest::new(shown.poses()[0], shown.poses()[SAMPLES - 1], 1.0, TIME_STEP_S);
    group.bench_function("roll out", |bench| {
        bench.iter(|| primitive.rollout(black_box(&request)).expect("a rollout"));
    });
    group.bench_function("tick", |bench| {
        let fresh = || primitive.stepper(&request).expect("a stepper");
        let mut stepper: PoseStepper = fresh();
        bench.iter(|| {
            if stepper.progress() >= 1.0 {
                stepper = fresh();
            }
            stepper.step(black_box(TIME_STEP_S)).expect("a step");
        });
    });
    group.finish();
}

criterion_group!(benches, learn_and_roll_out, pose);
criterion_main!(benches);
