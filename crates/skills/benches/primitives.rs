//! Cost of a movement primitive: learning, a whole rollout, one tick of a control loop, one sample absorbed on line.
//!
//! The demonstration is the closed formula by which other libraries were measured: 1000 samples over 1 s in d coordinates.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::DMatrix;
use skills::basis::GaussianBasis;
use skills::canonical::CanonicalSystem;
use skills::coupling::{Coupling, PointObstacle, PotentialConfig, PotentialCoupling};
use skills::regression::{Lwr, Recursive, RecursiveFit, RegressionConfig};
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, DmpStepper, MovementPrimitive, RolloutRequest, Trajectory};

const SAMPLES: usize = 1000;
const BASES: [usize; 3] = [10, 50, 100];
const DIMENSIONS: [usize; 2] = [2, 7];

/// y_d(t) = (0.5 + 0.1d)·mj(t) + 0.3·64t³(1 − t)³·sin(2π(1 + 0.5d)t + 0.3d).
fn demonstration(dimension: usize, samples: usize) -> Trajectory {
    let last = (samples - 1) as f64;
    let position = |row: usize, d: usize| {
        let (t, d) = (row as f64 / last, d as f64);
        let window = 64.0 * (t * (1.0 - t)).powi(3);
        (0.5 + 0.1 * d) * minimum_jerk(t) + 0.3 * window * (2.0 * PI * (1.0 + 0.5 * d) * t + 0.3 * d).sin()
    };
    Trajectory::uniform(last.recip(), DMatrix::from_fn(samples, dimension, position)).expect("a valid demonstration")
}

fn config(bases: usize) -> DmpConfig {
    DmpConfig { bases, ..DmpConfig::default() }
}

fn request(shown: &Trajectory) -> RolloutRequest {
    RolloutRequest::new(shown.start(), shown.end(), 1.0, 1.0 / (SAMPLES - 1) as f64)
}

fn learning(criterion: &mut Criterion) {
    for dimension in DIMENSIONS {
        let mut group = criterion.benchmark_group(format!("learn {dimension}-D"));
        let shown = [demonstration(dimension, SAMPLES)];
        for bases in BASES {
            let ridge = config(bases);
            let lwr = DmpConfig { regression: RegressionConfig::Lwr(Lwr {}), ..config(bases) };
            for config in [ridge, lwr] {
                let id = BenchmarkId::new(config.regression.name(), bases);
                group.bench_function(id, |bench| bench.iter(|| Dmp::learn(&config, &shown).expect("learnable")));
            }
        }
        group.finish();
    }
}

fn rollout(criterion: &mut Criterion) {
    for dimension in DIMENSIONS {
        let mut group = criterion.benchmark_group(format!("rollout of 999 steps {dimension}-D"));
        let shown = demonstration(dimension, SAMPLES);
        let request = request(&shown);
        for bases in BASES {
            let dmp = Dmp::learn(&config(bases), std::slice::from_ref(&shown)).expect("learnable");
            group.bench_function(BenchmarkId::from_parameter(bases), |bench| {
                bench.iter(|| dmp.rollout(black_box(&request)).expect("in range"));
            });
        }
        group.finish();
    }
}

/// A motion that is stepped for ever and begins anew each time it has ended.
fn ticking(dmp: &Dmp, request: &RolloutRequest, mut tick: impl FnMut(&mut DmpStepper)) -> impl FnMut() {
    let fresh = dmp.stepper(request).expect("in range");
    let mut stepper = fresh.clone();
    move || {
        if stepper.progress() > 1.0 {
            stepper.clone_from(&fresh);
        }
        tick(&mut stepper);
    }
}

fn tick(criterion: &mut Criterion) {
    for dimension in DIMENSIONS {
        let mut group = criterion.benchmark_group(format!("one tick {dimension}-D"));
        let shown = demonstration(dimension, SAMPLES);
        let request = request(&shown);
        let step_s = request.time_step_s;
        for bases in BASES {
            let dmp = Dmp::learn(&config(bases), std::slice::from_ref(&shown)).expect("learnable");
            group.bench_function(BenchmarkId::new("free", bases), |bench| {
                bench.iter(ticking(&dmp, &request, |stepper| stepper.step(black_box(step_s)).expect("in range")));
            });
            let obstacle = PointObstacle { center: vec![0.25; dimension], radius: 0.0 };
            let coupling =
                PotentialCoupling::new(PotentialConfig::default(), vec![obstacle], dimension).expect("valid");
            group.bench_function(BenchmarkId::new("coupled", bases), |bench| {
                let couplings: [&dyn Coupling; 1] = [&coupling];
                bench.iter(ticking(&dmp, &request, |stepper| {
                    stepper.step_coupled(black_box(step_s), &couplings).expect("in range");
                }));
            });
        }
        group.finish();
    }
}

/// One sample taken in by a recursive fit, over and over through the motion.
fn absorbing(criterion: &mut Criterion) {
    for dimension in DIMENSIONS {
        let mut group = criterion.benchmark_group(format!("absorb one sample {dimension}-D"));
        for bases in BASES {
            let canonical = CanonicalSystem::new(DmpConfig::default().gamma);
            let basis = GaussianBasis::uniform_in_time(bases, canonical, 0.5);
            let mut fit = RecursiveFit::new(&Recursive::default(), basis, dimension).expect("valid");
            let (target, mut row) = (vec![0.3; dimension], 0);
            group.bench_function(BenchmarkId::from_parameter(bases), |bench| {
                bench.iter(|| {
                    row = (row + 1) % SAMPLES;
                    fit.absorb(canonical.phase(row as f64 / SAMPLES as f64), black_box(&target), 1.0)
                        .expect("in range");
                });
            });
        }
        group.finish();
    }
}

fn growth(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("learn 7-D with 50 bases by samples");
    for samples in [1_000, 10_000, 100_000] {
        let shown = [demonstration(7, samples)];
        group.bench_function(BenchmarkId::from_parameter(samples), |bench| {
            bench.iter(|| Dmp::learn(&config(50), &shown).expect("learnable"));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    targets = learning, rollout, tick, absorbing, growth
}
criterion_main!(benches);
