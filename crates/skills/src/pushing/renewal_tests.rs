//! When a hold is renewed, and where: by mental arithmetic on a disc with (1 − κ)/κ = 4/9.

use nalgebra::{Point2, Unit, Vector2};
use proptest::prelude::*;

use super::*;
use crate::pushing::SteeringConfig;

/// Radius of the stick's head.
const HEAD_M: f64 = 0.006;
const SOON_M: f64 = 1e-6;

/// Steers a disc of 12 mm radius along +y through the origin; 0.9 of the usable surface may be asked for.
fn steering(surface_radius_m: f64, half_length_m: f64) -> Steering {
    let along = Unit::new_unchecked(Vector2::y());
    let config = SteeringConfig::default();
    Steering::new(&config, Point2::origin(), along, surface_radius_m, half_length_m, 0.012, 0.008)
}

/// A face with 5 mm usable to either side.
fn face() -> Steering {
    steering(f64::INFINITY, 0.005)
}

fn renewed_mm(steering: &Steering, offset_mm: f64, deviation_mm: f64) -> Option<f64> {
    let found = steering.renewed_offset_m(&HoldRenewalConfig::default(), offset_mm * 1e-3, deviation_mm * 1e-3);
    found.map(|offset_m| (offset_m * 1e9).round() / 1e6)
}

#[test]
fn a_spent_hold_goes_to_the_other_side_where_rolling_mends_all() {
    // uᵈ = 1.6·9/4 = 3.6 mm is reached
    assert_eq!(renewed_mm(&face(), 3.6, 1.6), Some(-3.6));
    assert_eq!(renewed_mm(&face(), -3.6, -1.6), Some(3.6));
    // 3 mm would need 6.75 mm; 0.9·5 mm may be asked for
    assert_eq!(renewed_mm(&face(), 4.4, 3.0), Some(-4.5));
}

#[test]
fn a_hold_that_steering_has_not_used_up_is_kept() {
    // 0.8·3.6 mm = 2.88 mm
    assert_eq!(renewed_mm(&face(), 2.87, 1.6), None);
    assert_eq!(renewed_mm(&face(), 2.89, 1.6), Some(-3.6));
    assert_eq!(renewed_mm(&face(), -3.6, 1.6), None);
}

#[test]
fn a_deviation_below_the_limit_is_left_alone() {
    assert_eq!(renewed_mm(&face(), 2.25, 0.99), None);
    assert_eq!(renewed_mm(&face(), 2.25, 1.01), Some(-2.2725));
}

#[test]
fn a_surface_too_short_to_mend_anything_is_not_shifted() {
    // from one end to the other of 2·0.5·0.9 mm mends 0.4 mm, less than half of the limit
    assert_eq!(renewed_mm(&steering(f64::INFINITY, 0.0005), 0.45, 3.0), None);
    assert_eq!(renewed_mm(&steering(f64::INFINITY, 0.0007), 0.63, 3.0), Some(-0.63));
}

#[test]
fn an_object_that_leaves_its_surface_is_taken_back() {
    assert_eq!(renewed_mm(&face(), 5.9, 0.0), None);
    assert_eq!(renewed_mm(&face(), 6.1, 0.0), Some(0.0));
    // on the head the object's center goes three times as far as the contact: (0.48 + 1) mm·18/6
    let head = steering(HEAD_M, 0.00048);
    assert_eq!(renewed_mm(&head, 4.43, 3.0), None);
    assert_eq!(renewed_mm(&head, -4.45, 3.0), Some(0.0));
}

#[test]
fn in_a_hollow_no_hold_is_renewed() {
    assert_eq!(renewed_mm(&steering(-0.03, 0.005), 20.0, 5.0), None);
    assert_eq!(renewed_mm(&steering(-0.012, 0.005), 20.0, 5.0), None);
}

#[test]
fn off_the_middle_the_surface_ends_sooner_on_one_side() {
    // 3 mm to the left of the middle: 2 mm are left there, 8 mm to the right
    let aside = face().held_at(0.003);
    assert_eq!(renewed_mm(&aside, 2.9, 0.0), None);
    assert_eq!(renewed_mm(&aside, 3.1, 0.0), Some(0.0));
    assert_eq!(renewed_mm(&aside, -8.9, 0.0), None);
    assert_eq!(renewed_mm(&aside, 1.8, 3.0), Some(-6.75));
    assert_eq!(renewed_mm(&aside, -6.75, -3.0), Some(1.8));
}

#[test]
fn numbers_that_make_no_sense_are_refused_by_name() {
    let field = |config: HoldRenewalConfig| config.validate().map_err(|error| error.field);
    let usual = HoldRenewalConfig::default;
    assert_eq!(field(usual()), Ok(()));
    assert_eq!(field(HoldRenewalConfig { most_per_push: 0, ..usual() }), Ok(()));
    assert_eq!(field(HoldRenewalConfig { deviation_m: 0.0, ..usual() }), Err("deviation_m".into()));
    assert_eq!(field(HoldRenewalConfig { used_share: 1.1, ..usual() }), Err("used_share".into()));
    assert_eq!(field(HoldRenewalConfig { overhang_m: f64::NAN, ..usual() }), Err("overhang_m".into()));
    assert_eq!(field(HoldRenewalConfig { lift_m: 0.0, ..usual() }), Err("lift_m".into()));
    assert_eq!(field(HoldRenewalConfig { least_remaining_m: -0.001, ..usual() }), Err("least_remaining_m".into()));
}

proptest! {
    #[test]
    fn a_renewed_hold_is_usable_and_does_not_call_for_another(
        radius_m in prop_oneof![Just(f64::INFINITY), 0.001f64..0.5], half_length_m in 0.0f64..0.02,
        place_share in -1.0f64..1.0, offset_m in -0.03f64..0.03, deviation_m in -0.03f64..0.03,
    ) {
        let steering = steering(radius_m, half_length_m).held_at(place_share * half_length_m);
        let config = HoldRenewalConfig::default();
        if let Some(renewed_m) = steering.renewed_offset_m(&config, offset_m, deviation_m) {
            prop_assert!(steering.overhang_m(renewed_m) <= SOON_M);
            prop_assert_eq!(steering.renewed_offset_m(&config, renewed_m, deviation_m), None);
        }
    }
}
