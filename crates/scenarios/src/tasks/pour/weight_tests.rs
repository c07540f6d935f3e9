//! The weight of the beans in the hand: what the arm's motion tells of it, and what the controller makes of it.

use std::path::Path;

use super::*;
use crate::assets::Assets;
use crate::scenario::load;
use crate::tasks::ResolvedTask;

/// The force is that of the beans within this, N, over a second of the approach: 1 %, and what moves them along.
const FORCE_N: f64 = 0.01;

/// Mean force along the vertical, N, and mean height of the tool over its reference, m, from 0.5 to 1.5 s of the shipped pour with
/// 100 beans, and their weight, N.
fn carried(feed_forward: bool) -> (f64, f64, f64) {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut scenario =
        load(&project.join("scenarios/pour_wide_bowl.toml"), &Assets::at(project.join("assets"))).unwrap();
    let ResolvedTask::Pour(pour) = &mut scenario.task else { panic!("a scenario of another kind") };
    pour.scenario.grains.fill = sim::pouring::FillAmount::Count(100);
    let PourTable::Pour(config) = &mut pour.scenario.task;
    config.feed_forward = feed_forward;
    let pour = pour.clone();
    let task = PourTask::new(&scenario, &pour, 1);
    let skill = task.learn(&task.demonstrations(&|_, _| {}).unwrap()).unwrap();
    let done = task.simulate(&task.plan(&skill).unwrap(), &mut ()).unwrap();
    let second: Vec<_> = done.episode.samples.iter().filter(|sample| (0.5..1.5).contains(&sample.time_s)).collect();
    let mean = |value: &dyn Fn(&sim::spatial::EpisodeSample) -> f64| {
        second.iter().map(|sample| value(sample)).sum::<f64>() / second.len() as f64
    };
    let above = |sample: &sim::spatial::EpisodeSample| {
        sample.world_from_tool.translation.z - sample.world_from_tool_reference.translation.z
    };
    let masses = done.poured.masses;
    let weight_n = 9.81 * (masses.source_kg + masses.target_kg + masses.flying_kg + masses.spilt_kg);
    (mean(&|sample| sample.tool_wrench[2]), mean(&above), weight_n)
}

#[test]
fn the_arm_feels_the_weight_of_the_beans_and_an_expected_weight_keeps_the_cup_up() {
    let [(force_n, told_m, weight_n), (_, sagged_m, _)] = [true, false].map(carried);
    assert!((force_n + weight_n).abs() < FORCE_N, "{force_n} N for {weight_n} N of beans");
    // 0.21 N on a stiffness of some 2 N/mm
    assert!(sagged_m < -5e-5 && told_m.abs() < 0.2 * sagged_m.abs(), "{told_m} {sagged_m}");
}
