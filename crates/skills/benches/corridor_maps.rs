//! Cost of the maps of Eqs. (16)–(20), and of Algorithm 2 next to plain learning.
//!
//! The paper claims that the constraint-based method adds only Eq. (17) to learning a primitive.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::{DMatrix, DVector};
use skills::corridor::{Bounds, Corridor};
use skills::corridor_map::{AsPublished, ClosedForm, CorridorMap, CorridorMapConfig, MForm, MotionEnds, Proximal};
use skills::separation::constraint_based::{
    ConstrainedDemonstration, ConstraintBased, ConstraintBasedConfig, MappingOrder,
};
use skills::time_law::minimum_jerk;
use skills::{PrimitiveConfig, RolloutRequest, Trajectory};

const SAMPLES: usize = 1000;
const DEMONSTRATIONS: usize = 5;

fn kinds() -> [CorridorMapConfig; 4] {
    [
        CorridorMapConfig::Proximal(Proximal::default()),
        CorridorMapConfig::MForm(MForm::default()),
        CorridorMapConfig::ClosedForm(ClosedForm::default()),
        CorridorMapConfig::AsPublished(AsPublished::default()),
    ]
}

fn bounds(r: f64) -> Bounds {
    Bounds::still(0.5 * r - 0.4, 0.7 * r + 0.5)
}

fn position(r: f64) -> f64 {
    0.6 * minimum_jerk(r) + 0.2 * (6.0 * r).sin() * r * (1.0 - r)
}

fn map(kind: &CorridorMapConfig) -> Box<dyn CorridorMap> {
    let ends =
        MotionEnds { start: position(0.0), start_bounds: bounds(0.0), goal: position(1.0), goal_bounds: bounds(1.0) };
    kind.map(&ends, 0.01).expect("a map").map
}

fn one_sample(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("one sample");
    for kind in kinds() {
        let (map, bounds, x) = (map(&kind), bounds(0.4), position(0.4));
        group.bench_function(BenchmarkId::new("map", kind.name()), |bench| {
            bench.iter(|| map.unconstrained(black_box(&bounds), black_box(0.4), black_box(x)));
        });
        let unconstrained = map.unconstrained(&bounds, 0.4, x);
        group.bench_function(BenchmarkId::new("inverse", kind.name()), |bench| {
            bench.iter(|| map.constrained(black_box(&bounds), black_box(0.4), black_box(unconstrained)));
        });
    }
    group.finish();
}

/// 1000 samples of `dimension` coordinates, one map each, with the bounds at hand.
fn thousand_samples(criterion: &mut Criterion) {
    let progress: Vec<f64> = (0..SAMPLES).map(|row| row as f64 / (SAMPLES - 1) as f64).collect();
    let corridor: Vec<Bounds> = progress.iter().map(|r| bounds(*r)).collect();
    let shown: Vec<f64> = progress.iter().map(|r| position(*r)).collect();
    for dimension in [2, 7] {
        let mut group = criterion.benchmark_group(format!("1000 samples, {dimension} coordinates"));
        for kind in kinds() {
            let maps: Vec<Box<dyn CorridorMap>> = (0..dimension).map(|_| map(&kind)).collect();
            let mut mapped = vec![0.0; SAMPLES];
            let rows = || progress.iter().zip(&corridor).zip(&shown);
            group.bench_function(BenchmarkId::new("map", kind.name()), |bench| {
                bench.iter(|| {
                    for map in &maps {
                        for (((r, bounds), x), mapped) in rows().zip(&mut mapped) {
                            *mapped = map.unconstrained(bounds, *r, *x);
                        }
                        black_box(&mapped);
                    }
                });
            });
            group.bench_function(BenchmarkId::new("inverse", kind.name()), |bench| {
                bench.iter(|| {
                    for map in &maps {
                        for (((r, bounds), x), mapped) in rows().zip(&mut mapped) {
                            *mapped = map.constrained(bounds, *r, *x);
                        }
                        black_box(&mapped);
                    }
                });
            });
        }
        group.finish();
    }
}

fn demonstrations(dimension: usize) -> Vec<(Trajectory, Corridor)> {
    let demonstration = |index: usize| {
        let amplitude = 1.0 + 0.02 * index as f64;
        let time = |row: usize| 2.0 * row as f64 / (SAMPLES - 1) as f64;
        let samples =
            DMatrix::from_fn(SAMPLES, dimension, |row, k| amplitude * position(time(row) / 2.0) + 0.01 * k as f64);
        let times_s: Vec<f64> = (0..SAMPLES).map(time).collect();
        let trajectory = Trajectory::new(times_s.clone(), samples).expect("a trajectory");
        (trajectory, Corridor::sampled(times_s, dimension, |time_s, _| bounds(time_s / 2.0)).expect("a corridor"))
    };
    (0..DEMONSTRATIONS).map(demonstration).collect()
}

fn algorithm_2(criterion: &mut Criterion) {
    for dimension in [2, 7] {
        let (shown, noise) = (demonstrations(dimension), vec![0.0; dimension]);
        let trajectories: Vec<Trajectory> = shown.iter().map(|(trajectory, _)| trajectory.clone()).collect();
        let constrained: Vec<ConstrainedDemonstration<'_>> = shown
            .iter()
            .map(|(trajectory, corridor)| ConstrainedDemonstration { trajectory, corridor, noise: &noise })
            .collect();
        let mut group = criterion.benchmark_group(format!("5 demonstrations of 1000 samples, {dimension} coordinates"));
        group.sample_size(20);
        group.bench_function("plain learning", |bench| {
            bench.iter(|| PrimitiveConfig::default().learn(black_box(&trajectories)).expect("a primitive"));
        });
        for kind in kinds() {
            let config = ConstraintBasedConfig { map: kind, ..ConstraintBasedConfig::default() };
            group.bench_function(BenchmarkId::new("algorithm 2", config.map.name()), |bench| {
                bench.iter(|| ConstraintBased::learn(&config, black_box(&constrained)).expect("a skill"));
            });
        }
        let first = ConstraintBasedConfig { order: MappingOrder::LearnFirst, ..ConstraintBasedConfig::default() };
        group.bench_function("algorithm 2, learned first", |bench| {
            bench.iter(|| ConstraintBased::learn(&first, black_box(&constrained)).expect("a skill"));
        });
        let skill = ConstraintBased::learn(&ConstraintBasedConfig::default(), &constrained).expect("a skill");
        let (start, goal) = (trajectories[0].start(), trajectories[0].end());
        let request = RolloutRequest::new(DVector::clone(&start), goal, 2.0, 0.002);
        group.bench_function("generate 1000 samples", |bench| {
            bench.iter(|| skill.generate(black_box(&request), &shown[0].1).expect("a motion"));
        });
        group.finish();
    }
}

criterion_group!(benches, one_sample, thousand_samples, algorithm_2);
criterion_main!(benches);
