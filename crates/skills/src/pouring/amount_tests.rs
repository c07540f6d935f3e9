//! The law of the amount against streams that are known: steady ones, and fills that leave in slides.

use super::*;

const STEP_S: f64 = 0.002;

fn control(target_kg: f64, change: impl Fn(&mut AmountOptions)) -> AmountControl {
    let mut options = AmountOptions::default();
    change(&mut options);
    AmountControl::new(target_kg, 0.12, options).unwrap()
}

/// A cup from which the mass up to a tilt leaves in slides: as it is passed by `slide_rad`, all that is due leaves at a
/// rate, until the cup is tilted back by as much; what has left lands after a fall. Returns what has landed in the end, kg.
fn poured(control: &mut AmountControl, slide_rad: f64, flow_kg_per_s: f64, fall_s: f64) -> f64 {
    const KG_PER_RAD: f64 = 0.3;
    let delay = (fall_s / STEP_S).round() as usize;
    let mut air = std::collections::VecDeque::from(vec![0.0; delay]);
    let (mut tilt, mut left, mut landed, mut flows) = (1.5, 0.0, 0.0, false);
    for _ in 0..30_000 {
        let due = KG_PER_RAD * (tilt - 1.5_f64).max(0.0) - left;
        flows = if flows { due > 0.0 } else { due > KG_PER_RAD * slide_rad };
        let out = if flows { flow_kg_per_s * STEP_S } else { 0.0 };
        left += out;
        air.push_back(out);
        landed += air.pop_front().unwrap();
        match control.step(STEP_S, landed, tilt, tilt >= 2.0) {
            TiltCommand::Rate(rate) => tilt = (tilt + rate.clamp(-0.8, 0.8) * STEP_S).min(2.0),
            TiltCommand::Back => tilt = (tilt - 0.8 * STEP_S).max(0.0),
        }
    }
    assert_eq!(control.step(STEP_S, landed, tilt, false), TiltCommand::Back, "it ends");
    landed
}

#[test]
fn an_amount_is_met_within_a_slide_whatever_its_size() {
    for slide_rad in [0.002, 0.01, 0.02] {
        for flow in [0.02, 0.05] {
            let mut control = control(0.08, |_| ());
            let landed = poured(&mut control, slide_rad, flow, 0.12);
            // what a slide holds beyond the tolerance, and a bean's time of its flow
            let slide_kg = 0.3 * slide_rad + flow * 0.05;
            assert!((landed - 0.08).abs() < 0.001 + slide_kg, "{slide_rad} {flow}: {landed}");
        }
    }
}

#[test]
fn without_a_dribble_a_quick_pour_overshoots_by_what_it_cannot_foresee() {
    let [with, without] = [0.02, 0.0].map(|dribble_kg| {
        let mut control = control(0.08, |options| {
            options.dribble_kg = dribble_kg;
            // nothing is foreseen
            (options.fall_s, options.stop_s) = (0.0, 0.0);
        });
        poured(&mut control, 0.004, 0.05, 0.12) - 0.08
    });
    assert!(without > 0.003 && with < 0.5 * without, "{with} {without}");
}

#[test]
fn a_cup_that_is_empty_or_a_law_that_takes_too_long_ends() {
    let mut empty = control(0.5, |_| ());
    assert!(poured(&mut empty, 0.01, 0.05, 0.12) < 0.16);
    let mut slow = control(0.05, |options| options.longest_s = 1.0);
    for _ in 0..499 {
        assert!(matches!(slow.step(STEP_S, 0.0, 1.5, false), TiltCommand::Rate(_)));
    }
    for _ in 0..3 {
        let _ = slow.step(STEP_S, 0.0, 1.5, false);
    }
    assert_eq!(slow.step(STEP_S, 0.0, 1.5, false), TiltCommand::Back);
}

#[test]
fn the_cup_rests_while_beans_land_and_numbers_that_are_none_are_passed_over() {
    let mut control = control(0.05, |options| options.dribble_kg = 0.05);
    // the quick pour has nothing to do: retreat, wait, dribble
    let mut rate = |landed: f64, tilt: f64| match control.step(0.1, landed, tilt, false) {
        TiltCommand::Rate(rate) => rate,
        TiltCommand::Back => f64::NAN,
    };
    assert!(rate(0.0, 1.6) < 0.0);
    assert_eq!(rate(0.0, 1.4), 0.0);
    assert!(rate(0.0, 1.4) > 0.0);
    assert_eq!(rate(0.0002, 1.45), 0.0, "a bean has landed");
    assert_eq!(rate(f64::NAN, 1.45), 0.0);
    assert_eq!(AmountControl::new(0.0, 0.1, AmountOptions::default()).unwrap_err().field, "target_kg");
}
