//! Forces of the law as the arm feels them, and the momentum that they hand on.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;

use super::fixture::*;

/// Height of the edge above the board.
fn height(sample: &sim::spatial::EpisodeSample) -> f64 {
    sample.world_from_tool.translation.z - BOARD[2]
}

#[test]
fn a_block_resists_with_its_toughness_times_its_width_and_the_arm_feels_it() {
    let mut block = food(BLOCK);
    block.material.flank_shear_pa = 0.0;
    let outcome = run(&setup(block, FRAC_PI_2), &press(0.0, 0.035, 0.001, 3.0));
    assert_eq!(outcome.record.failure, None, "{:?}", outcome.events);
    // R w, and what the cleaver's edge of 15 µm adds by crushing: (1 + μ) σ 2ρ
    let expected = (200.0 + 1.3 * 2e4 * 3e-5) * 0.04;
    let steady: Vec<_> =
        outcome.episode.samples.iter().filter(|s| s.time_s < 3.8 && (0.003..0.028).contains(&height(s))).collect();
    assert!(steady.len() > 500, "{}", steady.len());
    let mean = steady.iter().map(|s| s.process_wrench.z).sum::<f64>() / steady.len() as f64;
    assert!((mean / expected - 1.0).abs() < 0.01, "{mean} N, expected {expected} N");
    for sample in &steady {
        let off = (sample.tool_wrench - sample.process_wrench).fixed_rows::<3>(0).norm();
        // the reading of forces takes the acceleration over a period, the law its beginning
        assert!(off < 0.15, "{off} N at {} s", sample.time_s);
    }
    let cut = &outcome.record.cuts[0];
    assert!((cut.force_mean_n / expected - 1.0).abs() < 0.05, "{cut:?}");
    assert!((cut.energy.fracture_j / (expected / 0.04 * 0.04 * 0.03) - 1.0).abs() < 0.03, "{cut:?}");
    assert!(cut.energy.balance_j().abs() < 0.02 * cut.energy.work_j, "{cut:?}");
}

#[test]
fn a_second_pass_in_an_open_cut_feels_only_the_flanks() {
    let mut block = food(BLOCK);
    // less than the weight in all, so that the block stays on the board when the knife is drawn out
    block.material.flank_shear_pa = 400.0;
    let setup = setup(block, FRAC_PI_2);
    let script = press(0.0, 0.04, -0.005, 2.0).to(2.0, upright(0.0, 0.0, 0.012)).to(0.5, upright(0.0, 0.0, 0.04));
    let outcome = run(&setup, &script);
    assert_eq!(outcome.record.cuts.len(), 1, "{:?}", outcome.events);
    assert_eq!(outcome.record.pieces.len(), 1);
    let second: Vec<_> = outcome
        .episode
        .samples
        .iter()
        .filter(|s| (4.0..5.9).contains(&s.time_s) && (0.014..0.026).contains(&height(s)))
        .collect();
    assert!(second.len() > 100, "{}", second.len());
    for sample in second {
        let expected = 2.0 * 400.0 * 0.04 * (0.03 - height(sample));
        assert!((sample.process_wrench.z / expected - 1.0).abs() < 0.02, "{} {expected}", sample.process_wrench.z);
    }
}

#[test]
fn what_the_knife_loses_the_food_gains() {
    let mut block = food(BLOCK);
    block.material.toughness_j_per_m2 = 50.0;
    let mut setup = setup(block, FRAC_PI_2);
    // it floats, so that nothing but the knife acts on it
    setup.world_from_food.translation.z += 0.1;
    let gravity = Vector3::zeros();
    let script = Script::from(upright(0.02, 0.01, 0.14)).to(0.6, upright(0.03, 0.01, 0.11));
    let mut rig = super::steps::Rig::new(&setup, &script, &gravity);
    let (mut impulse, dt) = (Vector3::zeros(), PERIOD_S);
    for _ in 0..600 {
        rig.step();
        impulse += rig.wrench().fixed_rows::<3>(0) * dt;
        let (mass, velocity) = rig.food();
        assert!((velocity * mass + impulse).norm() < 1e-9 + 1e-9 * impulse.norm(), "{velocity:?} {impulse:?}");
    }
    assert!(impulse.norm() > 1e-3, "{impulse:?}");
}
