//! What one cut costs: sections, splits and colliders of the largest food and of a sphere.
#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use nalgebra::{Isometry3, Point2, Vector3};
use sim::cutting::food::FoodFile;
use sim::cutting::geometry::{CutSurface, Plane, Solid};

fn food(text: &str) -> Solid {
    toml::from_str::<FoodFile>(text).expect("a food file").food().expect("a food").solid
}

/// An oblique frame across the middle of a food; its x-y plane is the cut.
fn across() -> Isometry3<f64> {
    Isometry3::new(Vector3::new(0.003, 0.001, 0.002), Vector3::new(0.1, 1.4, 0.2))
}

/// A cut of ten strips that wanders by a millimeter.
fn wandering() -> CutSurface {
    let point = |step: usize| Point2::new(0.004 * step as f64 - 0.02, 0.001 * (step as f64).sin());
    CutSurface::from_profile(&across(), &(0..=10).map(point).collect::<Vec<_>>()).expect("points that go forward")
}

fn cutting(criterion: &mut Criterion) {
    let foods = [
        ("banana", food(include_str!("../../../assets/foods/banana.toml"))),
        ("meatball", food(include_str!("../../../assets/foods/meatball.toml"))),
    ];
    let (frame, cut) = (across(), wandering());
    let plane = Plane::of_frame(&frame);
    for (name, solid) in &foods {
        let mut group = criterion.benchmark_group(*name);
        group.bench_function("section", |bench| bench.iter(|| solid.section(&frame)));
        group.bench_function("split by a plane", |bench| bench.iter(|| solid.split(&plane)));
        group.bench_function("split by ten strips", |bench| bench.iter(|| solid.split_along(&cut)));
        group.bench_function("mass properties", |bench| bench.iter(|| solid.mass_properties(1000.0)));
        let halves = solid.split(&plane);
        group.bench_function("colliders of the halves", |bench| {
            bench.iter_batched(
                || &halves,
                |halves| halves.iter().map(Solid::hulls).collect::<Vec<_>>(),
                BatchSize::SmallInput,
            );
        });
        group.bench_function("mesh", |bench| bench.iter(|| solid.mesh()));
        group.finish();
    }
}

criterion_group!(benches, cutting);
criterion_main!(benches);
