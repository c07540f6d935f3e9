//! Cost of the model-based separation: demonstrations of 501 samples in, skill and obstacle term out.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::{DMatrix, dvector};
use skills::coupling::{Coupling, Hoffmann, MotionState};
use skills::separation::model_based::{
    AlgorithmOneConfig, IdentificationConfig, LogForm, ModelBasedConfig, ObstructedDemonstration, identify,
};
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, RolloutRequest, Trajectory};

const SAMPLES: usize = 501;
const STEP_S: f64 = 2.0 / (SAMPLES - 1) as f64;

/// A reach of 1 along x past an obstacle at `obstacle`, if any.
fn demonstrate(obstacle: Option<[f64; 2]>) -> ObstructedDemonstration {
    let table = DMatrix::from_fn(SAMPLES, 2, |row, k| match k {
        0 => minimum_jerk(row as f64 / (SAMPLES - 1) as f64),
        _ => 0.0,
    });
    let reach = Trajectory::uniform(STEP_S, table.clone()).expect("a valid trajectory");
    let intention = Dmp::learn(&DmpConfig::default(), &[reach]).expect("a learned reach");
    let request = RolloutRequest::new(dvector![0.0, 0.0], dvector![1.0, 0.0], 2.0, STEP_S);
    let mut stepper = intention.stepper(&request).expect("a valid request");
    let obstacles = obstacle.iter().map(|point| point.to_vec()).collect();
    let law = Hoffmann::new(60.0, 2.5, obstacles).expect("valid parameters");
    let mut shown = table;
    for row in 0..SAMPLES {
        shown.row_mut(row).tr_copy_from(stepper.position());
        let mut coupling = [0.0; 2];
        let (position, velocity) = (stepper.position().as_slice(), stepper.velocity().as_slice());
        let state = MotionState { position, velocity, elapsed_s: stepper.elapsed_s(), duration_s: 2.0 };
        law.add_to(&state, &mut coupling);
        stepper.step_with_coupling(STEP_S, &coupling).expect("a valid step");
    }
    ObstructedDemonstration {
        trajectory: Trajectory::uniform(STEP_S, shown).expect("a valid trajectory"),
        obstacle: obstacle.map(|point| point.to_vec()),
        goal: Some(vec![1.0, 0.0]),
    }
}

/// One demonstration without obstacle, the others past obstacles on alternate sides.
fn demonstrations(count: usize) -> Vec<ObstructedDemonstration> {
    let obstacle = |k: usize| {
        let side = if k.is_multiple_of(2) { 0.12 } else { -0.12 };
        (k > 0).then_some([0.3 + 0.05 * k as f64, side])
    };
    (0..count).map(|k| demonstrate(obstacle(k))).collect()
}

fn algorithm_one(form: LogForm) -> IdentificationConfig {
    // as many rounds for each form, so that they compare
    IdentificationConfig::AlgorithmOne(AlgorithmOneConfig { form, rounds: 30, tolerance: 1e-300, ..Default::default() })
}

fn model_based(criterion: &mut Criterion) {
    let methods = [
        ("variable projection", IdentificationConfig::default()),
        ("30 rounds, weighted", algorithm_one(LogForm::Weighted)),
        ("30 rounds, projected", algorithm_one(LogForm::Projected)),
        ("30 rounds, literal", algorithm_one(LogForm::LiteralLog)),
    ];
    let mut group = criterion.benchmark_group("model-based separation");
    for count in [2, 8] {
        let shown = demonstrations(count);
        for (name, identification) in &methods {
            let config = ModelBasedConfig { identification: identification.clone(), ..Default::default() };
            group.bench_with_input(BenchmarkId::new(*name, count), &shown, |bench, shown| {
                bench.iter(|| identify(&config, shown).expect("identifiable"));
            });
        }
    }
    group.finish();
}

fn coupling(criterion: &mut Criterion) {
    let law = Hoffmann::new(60.0, 2.5, vec![vec![0.5, 0.12, 0.1]]).expect("valid parameters");
    let state = MotionState { position: &[0.0; 3], velocity: &[1.0, 0.2, 0.1], elapsed_s: 0.0, duration_s: 2.0 };
    criterion.bench_function("obstacle term, one obstacle in space", |bench| {
        bench.iter(|| {
            let mut sum = [0.0; 3];
            law.add_to(std::hint::black_box(&state), &mut sum);
            sum
        });
    });
}

criterion_group!(benches, model_based, coupling);
criterion_main!(benches);
