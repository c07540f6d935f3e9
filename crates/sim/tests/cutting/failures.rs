//! Ways in which a cut fails, each provoked.

use std::f64::consts::FRAC_PI_2;

use sim::cutting::mechanics::Failure;

use super::fixture::*;

#[test]
fn a_soft_arm_stalls_in_a_tough_food() {
    let mut block = food(BLOCK);
    block.material.toughness_j_per_m2 = 700.0;
    // a stalled edge that gives way sideways would slice, or take the food along
    block.material.slice_efficiency = 0.0;
    block.material.indentation_stiffness_pa = 4e6;
    let down = upright(0.0, 0.0, 0.0);
    let script = Script::from(upright(0.0, 0.0, 0.035)).to(2.0, down).to(3.0, down);
    let options = Options { gains: soft(), ..Options::default() };
    let outcome = run_with(&setup(block, FRAC_PI_2), &script, &options);
    assert!(matches!(outcome.record.failure, Some(Failure::Stalled { .. })), "{:?}", outcome.events);
    let told = outcome.episode.interruption.expect("the run is broken off");
    assert!(told.contains("allow it more force"), "{told}");
}

#[test]
fn a_round_food_rolls_away_from_a_knife_beside_its_axis() {
    let mut setup = setup(food(CYLINDER), 0.0);
    setup.board.friction = 0.05;
    setup.knife.edge.friction = 0.05;
    let outcome = run(&setup, &press(0.010, 0.05, 0.001, 2.0));
    let failure = outcome.record.failure.expect("fails");
    assert!(matches!(failure, Failure::Rolled { .. } | Failure::Slipped { .. }), "{failure:?}");
    assert_eq!(outcome.record.pieces.len(), 1);
}

#[test]
fn a_sliced_food_slips_on_a_smooth_board() {
    let slip = |friction: f64| {
        let mut setup = setup(food(BLOCK), FRAC_PI_2);
        setup.board.friction = friction;
        let script = Script::from(upright(-0.004, 0.0, 0.035)).to(2.0, upright(0.004, 0.0, 0.012));
        run(&setup, &script).record
    };
    let smooth = slip(0.05);
    assert!(matches!(smooth.failure, Some(Failure::Slipped { .. })), "{smooth:?}");
    let rough = slip(0.4);
    assert!(rough.food_slip_m < 0.2 * smooth.food_slip_m, "{} {}", rough.food_slip_m, smooth.food_slip_m);
}

#[test]
fn a_stroke_beside_the_food_misses_it_and_a_short_one_leaves_it_whole() {
    let mut setup = setup(food(BANANA), FRAC_PI_2);
    setup.planned = vec![upright(0.0, 0.0, 0.03)];
    let beside = run(&setup, &press(0.12, 0.035, -0.001, 1.0));
    assert_eq!(beside.record.failure, Some(Failure::Missed));
    assert!(beside.record.cuts.is_empty());
    // flanks that stick would lift the food with the knife
    setup.food.material.flank_shear_pa = 300.0;
    let short = run(&setup, &press(0.0, 0.035, -0.01, 1.0));
    assert!(matches!(short.record.failure, Some(Failure::NotThrough { ligament_share }) if ligament_share > 0.1));
    assert_eq!(short.record.pieces.len(), 1);
}

#[test]
fn a_biscuit_breaks_at_once_in_two() {
    let mut biscuit = food(BISCUIT);
    // the arm gives way forwards by half a millimeter, which would slice
    biscuit.material.slice_efficiency = 0.0;
    let setup = setup(biscuit, FRAC_PI_2);
    let outcome = run(&setup, &press(0.0, 0.015, 0.001, 1.5));
    let record = &outcome.record;
    assert_eq!(record.pieces.len(), 2);
    let cut = &record.cuts[0];
    assert!(cut.ligament_share() > 0.5, "{cut:?}");
    // crushing 0.3 mm at 1 MPa over the flat top of 57 mm
    assert!((cut.force_peak_n / 17.1 - 1.0).abs() < 0.05, "{cut:?}");
}

#[test]
fn soft_foods_with_a_skin_are_cut_where_they_lie() {
    for text in [GRAPE, STRAWBERRY, MEATBALL] {
        let outcome = run(&setup(food(text), FRAC_PI_2), &press(0.0, 0.045, 0.001, 2.0));
        println!("{:#?} {:#?} {}", outcome.events, outcome.record.cuts, outcome.record.food_roll_rad);
        assert_eq!(outcome.record.pieces.len(), 2, "{:?}", outcome.events);
    }
}
