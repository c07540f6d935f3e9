//! Each way to fail is reported when it happens, and not before.

use nalgebra::Vector2;
use sim::cutting::mechanics::{
    Board, Cut, CuttingConfig, EdgeMotion, Failure, FailureMonitor, Observation, Thresholds,
};

use super::stroke::{DT_S, SPEED_M_PER_S, block, cut, food, heel, long_edge, push};

fn monitor() -> FailureMonitor {
    FailureMonitor::new(Thresholds::default()).expect("valid")
}

/// A cut that is half through.
fn half() -> Cut {
    let mut cut = cut(&block(0.04, 0.03), &food(200.0));
    push(&mut cut, 0.015, SPEED_M_PER_S, 0.0);
    cut
}

fn first(cut: &Cut, seen: Observation) -> Option<Failure> {
    monitor().observe(cut, &seen, DT_S).cloned()
}

#[test]
fn a_stall_is_reported_after_half_a_second_only() {
    let (cut, mut monitor) = (half(), monitor());
    let stands = Observation { driven: true, ..Observation::default() };
    for _ in 0..495 {
        assert_eq!(monitor.observe(&cut, &stands, DT_S), None);
    }
    for _ in 0..10 {
        monitor.observe(&cut, &stands, DT_S);
    }
    let message = monitor.observe(&cut, &stands, DT_S).expect("stalled").to_string();
    assert!(message.starts_with("cut: the knife stalled 0.01") && message.contains("slice instead"), "{message}");
}

#[test]
fn a_knife_that_is_not_driven_or_moves_is_not_stalled() {
    let (cut, mut monitor) = (half(), monitor());
    for k in 0..2000 {
        let seen = Observation { driven: k % 400 != 0, ..Observation::default() };
        assert_eq!(monitor.observe(&cut, &seen, DT_S), None);
    }
}

#[test]
fn food_that_moves_and_boards_that_are_struck_are_reported_beyond_their_limits() {
    let cut = half();
    let calm = Observation {
        food_translation_m: 0.0029,
        food_rotation_rad: 0.26,
        board_force_n: 19.0,
        pieces: 3,
        ..Observation::default()
    };
    // a food that is not brittle may come in pieces
    assert_eq!(first(&cut, calm), None);
    assert!(matches!(first(&cut, Observation { food_translation_m: 0.0031, ..calm }), Some(Failure::Slipped { .. })));
    assert!(matches!(first(&cut, Observation { food_rotation_rad: -0.27, ..calm }), Some(Failure::Rolled { .. })));
    assert!(matches!(first(&cut, Observation { board_force_n: 21.0, ..calm }), Some(Failure::BoardImpact { .. })));
}

#[test]
fn a_brittle_food_in_three_pieces_is_shattered() {
    let biscuit =
        sim::cutting::material::Material { brittle_depth_share: Some(0.2), yield_stress_pa: 1e6, ..food(5.0) };
    let cut = cut(&block(0.06, 0.007), &biscuit);
    let seen = |pieces| first(&cut, Observation { pieces, ..Observation::default() });
    assert_eq!((seen(2), seen(3)), (None, Some(Failure::Shattered { pieces: 3 })));
}

#[test]
fn a_food_that_is_squeezed_by_a_third_is_crushed() {
    // so soft that a dull edge does not enter within 0.3 h: 2 · 200 / 3e4 = 13 mm of 30
    let soft = sim::cutting::material::Material { indentation_stiffness_pa: 3e4, ..food(200.0) };
    let edge = sim::cutting::knife::Edge { radius_m: 60e-6, ..long_edge() };
    let mut cut = Cut::new(&block(0.04, 0.03), &soft, &edge, None, &CuttingConfig::default()).expect("valid");
    push(&mut cut, 0.0085, SPEED_M_PER_S, 0.0);
    assert_eq!(first(&cut, Observation::default()), None);
    let motion = EdgeMotion::translating(heel(0.0, 0.0095), Vector2::new(0.0, SPEED_M_PER_S));
    cut.step(&motion, DT_S).expect("finite");
    assert!(matches!(first(&cut, Observation::default()), Some(Failure::Crushed { .. })));
}

#[test]
fn the_end_of_a_stroke_tells_missed_from_not_through_and_from_done() {
    let untouched = cut(&block(0.04, 0.03), &food(200.0));
    assert_eq!(monitor().finish(&untouched), Some(&Failure::Missed));
    let message = monitor().finish(&half()).expect("not through").to_string();
    assert!(message.starts_with("cut: 50.") && message.contains("of the section is uncut"), "{message}");
    let board = Some(Board::level(0.03));
    let mut done =
        Cut::new(&block(0.04, 0.03), &food(200.0), &long_edge(), board, &CuttingConfig::default()).expect("valid");
    push(&mut done, 0.03, SPEED_M_PER_S, 0.0);
    assert_eq!(monitor().finish(&done), None);
}
