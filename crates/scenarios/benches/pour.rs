//! The execution of `scenarios/pour_wide_bowl.toml` (the stage `simulate`) with 100, 300 and 1000 beans: arm, controller,
//! rolling resistance and monitor included. The throughput is in beans times steps of 2 ms; its inverse is the cost of each.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::path::Path;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use scenarios::assets::Assets;
use scenarios::pipeline::run;
use scenarios::scenario::{Change, ResolvedScenario, load_text};

/// Inner radius and height of the shipped cup, m, and the beans in it.
const CUP_M: (f64, f64) = (0.035, 0.090);
const BEANS_IN_CUP: f64 = 300.0;
/// Time step of the engine, s.
const STEP_S: f64 = 0.002;

/// The shipped pour out of a cup that is as full with `beans` as the shipped one with 300.
fn scenario(beans: u32) -> ResolvedScenario {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let file = root.join("scenarios/pour_wide_bowl.toml");
    let text = std::fs::read_to_string(&file).expect("the shipped scenario");
    let scale = (f64::from(beans) / BEANS_IN_CUP).cbrt();
    let changes = [
        Change::new("grains.fill.count", i64::from(beans)),
        Change::new("source.asset:profile.straight.radius_m", CUP_M.0 * scale),
        Change::new("source.asset:profile.straight.height_m", CUP_M.1 * scale),
    ];
    let assets = Assets::at(root.join("assets"));
    load_text(&file, &text, &changes, &assets).map_err(|problems| problems.len()).expect("a valid scenario")
}

/// Clock time of the stage that simulates, and the steps that it took.
fn simulated(scenario: &ResolvedScenario) -> (Duration, u64) {
    let report = run(scenario, 1, &mut (), &|_, _| {}).expect("no crash");
    let stage = report.timings_s.iter().find(|(stage, _)| *stage == "simulate");
    let steps = (report.simulated_s / STEP_S).round() as u64;
    (Duration::from_secs_f64(stage.map_or(0.0, |(_, seconds)| *seconds)), steps)
}

fn pours(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("pour into the wide bowl");
    group.sample_size(10);
    for beans in [100, 300, 1000] {
        let scenario = scenario(beans);
        let (_, steps) = simulated(&scenario);
        println!("{beans} beans: {} s simulated", steps as f64 * STEP_S);
        group.throughput(Throughput::Elements(u64::from(beans) * steps));
        group.bench_function(format!("{beans} beans"), |bench| {
            bench.iter_custom(|runs| (0..runs).map(|_| simulated(&scenario).0).sum());
        });
    }
    group.finish();
}

criterion_group!(benches, pours);
criterion_main!(benches);
