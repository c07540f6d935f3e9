//! Cost of the cutting law for one simulated millisecond: divide a millisecond by the printed time for the real-time factor.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::f64::consts::TAU;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Point2, Vector2, Vector3};
use sim::cutting::food::FoodFile;
use sim::cutting::knife::{Edge, KnifeFile};
use sim::cutting::material::Material;
use sim::cutting::mechanics::{Board, Cut, CuttingConfig, EdgeMotion};

const MILLISECOND_S: f64 = 0.001;

fn chef() -> Edge {
    let file: KnifeFile = toml::from_str(include_str!("../../../assets/knives/chef.toml")).expect("a valid file");
    file.knife().expect("a valid knife").edge
}

fn banana() -> Material {
    let file: FoodFile = toml::from_str(include_str!("../../../assets/foods/banana.toml")).expect("a valid file");
    file.material
}

fn disc(diameter: f64) -> Vec<Vec<Point2<f64>>> {
    let at = |k: i32| TAU * f64::from(k) / 64.0;
    let corner = |k: i32| Point2::new(at(k).cos(), 1.0 + at(k).sin()) * (0.5 * diameter);
    vec![(0..64).map(corner).collect()]
}

/// Slices through a round section of `diameter` with a rocking knife, again and again.
fn slicing(diameter: f64) -> impl FnMut() {
    let board = Some(Board::level(diameter));
    let fresh = move || Cut::new(&disc(diameter), &banana(), &chef(), board, &CuttingConfig::default()).expect("valid");
    let (mut cut, mut count) = (fresh(), 0_u32);
    move || {
        let depth = 2e-5 * f64::from(count);
        if depth > 0.9 * diameter {
            (cut, count) = (fresh(), 0);
        }
        count += 1;
        let heel = Point2::new(-0.05 - 0.5 * depth, depth);
        let slicing = EdgeMotion::translating(heel, Vector2::new(-0.01, 0.02));
        let motion = EdgeMotion { angular_velocity_in_section: Vector3::new(0.0, 0.0, 0.01), ..slicing };
        cut.step(&motion, MILLISECOND_S).expect("finite");
    }
}

fn cutting(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("cutting");
    group.bench_function("30 mm", |bencher| bencher.iter(slicing(0.03)));
    group.bench_function("60 mm", |bencher| bencher.iter(slicing(0.06)));
    group.finish();
}

criterion_group!(benches, cutting);
criterion_main!(benches);
