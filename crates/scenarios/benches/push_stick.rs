//! The execution of `scenarios/push_stick.toml` (the stage `simulate`), with and without its recording.
//!
//! Times are for the whole episode; its simulated duration is printed first, so that the real-time factor follows.

#![expect(clippy::expect_used, reason = "a bench stops at the first surprise")]

use std::path::Path;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use scenarios::assets::Assets;
use scenarios::pipeline::{Report, run};
use scenarios::recording::{Recorder, RecorderOptions};
use scenarios::scenario::{ResolvedScenario, load};

fn scenario() -> ResolvedScenario {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let file = root.join("scenarios/push_stick.toml");
    load(&file, &Assets::at(root.join("assets"))).map_err(|problems| problems.len()).expect("a valid scenario")
}

/// Clock time of the stage that simulates.
fn simulate_s(report: &Report) -> Duration {
    let stage = report.timings_s.iter().find(|(stage, _)| *stage == "simulate");
    Duration::from_secs_f64(stage.map_or(0.0, |(_, seconds)| *seconds))
}

fn bare(scenario: &ResolvedScenario) -> Duration {
    simulate_s(&run(scenario, 1, &mut (), &|_, _| {}).expect("no crash"))
}

fn recorded(scenario: &ResolvedScenario, file: &Path) -> Duration {
    let options = RecorderOptions { file: Some(file.to_path_buf()), ..RecorderOptions::default() };
    let mut recorder = Recorder::start(&options, scenario, 1).expect("a writable file");
    let report = run(scenario, 1, &mut recorder, &|_, _| {}).expect("no crash");
    let summary = recorder.finish(&report.outcome);
    assert!(summary.warnings.is_empty(), "{:?}", summary.warnings);
    simulate_s(&report)
}

fn push_stick(criterion: &mut Criterion) {
    let scenario = scenario();
    let simulated_s = run(&scenario, 1, &mut (), &|_, _| {}).expect("no crash").simulated_s;
    println!("simulated: {simulated_s} s");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("recording.rrd");
    let mut group = criterion.benchmark_group("push_stick");
    group.sample_size(10);
    group.bench_function("simulate", |bench| bench.iter_custom(|runs| (0..runs).map(|_| bare(&scenario)).sum()));
    group.bench_function("simulate and record", |bench| {
        bench.iter_custom(|runs| (0..runs).map(|_| recorded(&scenario, &file)).sum());
    });
    group.finish();
}

criterion_group!(benches, push_stick);
criterion_main!(benches);
