//! Signs by mental arithmetic, limits, symmetry, and the steered push in the rolling law that the module states.

use approx::assert_relative_eq;
use proptest::prelude::*;

use super::*;
use crate::pushing::HoldRenewalConfig;

/// Disc of 12 mm radius on a surface with c/R = 2/3, as the ellipsoid of a uniform disc has it.
const OBJECT_RADIUS_M: f64 = 0.012;
const FRICTION_LENGTH_M: f64 = 0.008;
/// κ = 1/(1 + 4/9).
const ROLLING_SHARE: f64 = 9.0 / 13.0;
/// Radius of the stick's head.
const HEAD_M: f64 = 0.006;
const SPEED_M_PER_S: f64 = 0.02;
/// A few roundings of lengths and speeds of some centimeters.
const ROUNDING: f64 = 1e-15;

/// Steers along +y through the origin with a surface of the given radius, 5 mm usable to either side.
fn steering(surface_radius_m: f64) -> Steering {
    steering_with(SteeringConfig::default(), surface_radius_m, 0.005)
}

fn steering_with(config: SteeringConfig, surface_radius_m: f64, half_length_m: f64) -> Steering {
    let along = Unit::new_unchecked(Vector2::y());
    let line = Point2::origin();
    Steering::new(&config, line, along, surface_radius_m, half_length_m, OBJECT_RADIUS_M, FRICTION_LENGTH_M)
}

/// Command for an object of this deviation and offset, both positive to the left, that touches the surface.
fn command(steering: &Steering, deviation_m: f64, offset_m: f64) -> SteeringCommand {
    let center = Point2::new(-deviation_m, 0.1);
    let rise = steering.reach_m().map_or(OBJECT_RADIUS_M, |reach_m| {
        reach_m.signum() * (reach_m * reach_m - offset_m * offset_m).sqrt() - steering.surface_radius_m
    });
    let contact = Point2::new(center.x + offset_m, center.y - rise);
    steering.command(&contact, &Unit::new_unchecked(Vector2::y()), &center, SPEED_M_PER_S)
}

#[test]
fn an_object_in_the_middle_and_on_its_line_is_pushed_straight() {
    for radius_m in [f64::INFINITY, HEAD_M, -0.03] {
        let straight = command(&steering(radius_m), 0.0, 0.0);
        assert_relative_eq!(straight.velocity_world, Vector2::new(0.0, SPEED_M_PER_S), epsilon = ROUNDING);
        assert_eq!((straight.offset_m, straight.deviation_m), (0.0, 0.0));
    }
}

#[test]
fn left_is_negative_x_of_a_push_along_y() {
    let found = command(&steering(HEAD_M), 0.003, 0.001);
    assert_relative_eq!(found.offset_m, 0.001, epsilon = ROUNDING);
    assert_relative_eq!(found.deviation_m, 0.003, epsilon = ROUNDING);
}

#[test]
fn a_tool_follows_an_object_that_is_left_on_its_surface_to_the_left() {
    for radius_m in [f64::INFINITY, HEAD_M, -0.03] {
        assert!(command(&steering(radius_m), 0.0, 0.0005).velocity_world.x < 0.0, "{radius_m}");
    }
}

#[test]
fn a_face_goes_right_to_roll_and_drag_an_object_that_is_left_of_its_line() {
    // uᵈ = e/(4/9) = 0.9 mm for e = 0.4 mm; slope = −0.9/(9/13·10) = −0.13
    let found = command(&steering(f64::INFINITY), 0.0004, 0.0);
    assert_relative_eq!(found.velocity_world, Vector2::new(0.13, 1.0) * SPEED_M_PER_S, epsilon = ROUNDING);
}

#[test]
fn a_head_goes_left_to_lean_an_object_that_is_left_of_its_line_to_the_right() {
    // uᵈ = −0.1·18/20 = −0.09 mm; slope = 0.09/(9/13·10) = 0.013
    let found = command(&steering(HEAD_M), 0.0001, 0.0);
    assert_relative_eq!(found.velocity_world, Vector2::new(-0.013, 1.0) * SPEED_M_PER_S, epsilon = ROUNDING);
}

#[test]
fn a_hollow_goes_right_to_lean_an_object_that_is_left_of_its_line_to_the_right() {
    // the object hangs in the hollow: ρ = −18 mm, and the sign of uᵈ with it
    let found = command(&steering(-0.03), 0.0001, 0.0);
    assert_relative_eq!(found.velocity_world, Vector2::new(0.013, 1.0) * SPEED_M_PER_S, epsilon = ROUNDING);
}

#[test]
fn the_slope_and_the_wanted_offset_keep_their_limits() {
    let config = SteeringConfig { largest_slope: 0.25, ..SteeringConfig::default() };
    let found = command(&steering_with(config, f64::INFINITY, 0.005), 0.0, 0.004);
    assert_relative_eq!(found.velocity_world, Vector2::new(-0.25, 1.0) * SPEED_M_PER_S, epsilon = ROUNDING);
    // 0.9 of 5 mm on a face; 0.9·5·18/6 mm on the head
    assert_relative_eq!(steering(f64::INFINITY).wanted_offset_m(1.0), 0.0045, epsilon = ROUNDING);
    assert_relative_eq!(steering(HEAD_M).wanted_offset_m(1.0), -0.0135, epsilon = ROUNDING);
    assert_relative_eq!(steering(-0.03).wanted_offset_m(1.0), 0.0027, epsilon = ROUNDING);
}

#[test]
fn a_socket_without_room_to_roll_is_pushed_without_leaning() {
    let socket = steering(-OBJECT_RADIUS_M);
    for offset_m in [-1e-6, 0.0, 1e-6] {
        let found = socket.command(
            &Point2::new(offset_m, -OBJECT_RADIUS_M),
            &Unit::new_unchecked(Vector2::y()),
            &Point2::origin(),
            SPEED_M_PER_S,
        );
        assert_relative_eq!(found.velocity_world, Vector2::new(0.0, SPEED_M_PER_S), epsilon = 1e-5);
    }
}

/// Tool (middle of its surface) and object under the rolling law, both in the plane, the surface facing +y.
struct Rolling {
    surface_radius_m: f64,
    contact: Point2<f64>,
    center: Point2<f64>,
}

/// Way between two steps, m: the error of Euler steps over the lengths here is a thousandth.
const STEP_M: f64 = 1e-5;

impl Rolling {
    fn new(surface_radius_m: f64, deviation_m: f64, offset_m: f64) -> Self {
        let mut rolling = Self { surface_radius_m, contact: Point2::origin(), center: Point2::origin() };
        rolling.center.x = -deviation_m;
        rolling.contact.x = -deviation_m + offset_m;
        rolling.touch();
        rolling
    }

    fn reach_m(&self) -> f64 {
        self.surface_radius_m + OBJECT_RADIUS_M
    }

    /// Lateral offset of the object, positive to the left.
    fn offset_m(&self) -> f64 {
        self.contact.x - self.center.x
    }

    /// Puts the object back on the surface along y, which Euler steps leave.
    fn touch(&mut self) {
        let rise = if self.surface_radius_m.is_finite() {
            let (reach, offset) = (self.reach_m(), self.offset_m());
            reach.signum() * (reach * reach - offset * offset).sqrt() - self.surface_radius_m
        } else {
            OBJECT_RADIUS_M
        };
        self.center.y = self.contact.y + rise;
    }

    /// Moves the tool: the object goes along with the normal part, and with 1 − κ of the tangential part.
    fn step(&mut self, tool: &Vector2<f64>) {
        let lean = if self.surface_radius_m.is_finite() { self.offset_m() / self.reach_m() } else { 0.0 };
        let normal = Vector2::new(-lean, (1.0 - lean * lean).sqrt());
        let tangent = Vector2::new(-normal.y, normal.x);
        self.center += normal * tool.dot(&normal) + tangent * (tool.dot(&tangent) * (1.0 - ROLLING_SHARE));
        self.contact += *tool;
        self.touch();
    }

    /// Pushes along +y by `way_m`; returns deviation and offset at the end.
    fn push(mut self, steering: Option<&Steering>, way_m: f64) -> (f64, f64) {
        for _ in 0..(way_m / STEP_M).round() as usize {
            let normal = Unit::new_unchecked(Vector2::y());
            let tool = steering.map_or_else(Vector2::y, |steering| {
                steering.command(&self.contact, &normal, &self.center, 1.0).velocity_world
            });
            self.step(&(tool * STEP_M));
        }
        (-self.center.x, self.offset_m())
    }
}

#[test]
fn without_steering_the_offset_on_a_head_grows_with_the_e_folding_length_of_the_law() {
    // ρ/κ = 18 mm·13/9 = 26 mm
    let (_, offset_m) = Rolling::new(HEAD_M, 0.0, 0.0001).push(None, 0.026);
    // Euler steps and a lean of up to 0.015 rad
    assert_relative_eq!(offset_m, 0.0001 * std::f64::consts::E, max_relative = 2e-3);
}

#[test]
fn without_steering_the_offset_in_a_hollow_fades_and_on_a_face_it_stays() {
    let (_, hollow) = Rolling::new(-0.03, 0.0, 0.0001).push(None, 0.026);
    assert_relative_eq!(hollow, 0.0001 / std::f64::consts::E, max_relative = 2e-3);
    let (_, face) = Rolling::new(f64::INFINITY, 0.0, 0.0001).push(None, 0.026);
    assert_relative_eq!(face, 0.0001, max_relative = 1e-9);
}

#[test]
fn on_a_round_surface_offset_and_deviation_both_fade() {
    // a tenth of the object's radius aside, on any round surface
    for radius_m in [HEAD_M, 0.03, 0.10, -0.03] {
        let steering = steering(radius_m);
        for (deviation_m, offset_m) in [(0.0012, 0.0), (0.0, 0.0012), (-0.0012, 0.0006)] {
            let (deviation, offset) = Rolling::new(radius_m, deviation_m, offset_m).push(Some(&steering), 0.5);
            assert!(deviation.abs() < 1e-5 && offset.abs() < 1e-5, "{radius_m}: {deviation} {offset}");
        }
    }
}

#[test]
fn a_deviation_fades_over_the_line_length_once_the_offset_has_settled() {
    let head = steering(HEAD_M);
    let after = |way_m| Rolling::new(HEAD_M, 0.0001, 0.0).push(Some(&head), way_m).0;
    // two coupled modes, e'' + 60 e' + 5000 e = 0 in 1/m: an envelope of e^(−30 s)
    assert!((after(0.10) / 0.0001).abs() < 2.0 * (-3.0_f64).exp());
    assert!((after(0.20) / 0.0001).abs() < 2.0 * (-6.0_f64).exp());
}

#[test]
fn on_a_face_half_of_a_deviation_is_traded_for_an_offset() {
    // e + (4/9) u stays: 0.4 mm = 0.2 mm + (4/9)·0.45 mm
    let (deviation_m, offset_m) = Rolling::new(f64::INFINITY, 0.0004, 0.0).push(Some(&steering(f64::INFINITY)), 0.1);
    assert_relative_eq!(deviation_m, 0.0002, max_relative = 1e-3);
    assert_relative_eq!(offset_m, 0.00045, max_relative = 1e-3);
}

#[test]
fn on_a_face_a_hold_on_the_other_side_mends_all_of_a_deviation() {
    let steering = steering(f64::INFINITY);
    // half of 3 mm is left at uᵈ = 1.5·9/4 mm
    let (spent_m, offset_m) = Rolling::new(f64::INFINITY, 0.003, 0.0).push(Some(&steering), 0.1);
    assert_relative_eq!(spent_m, 0.0015, max_relative = 1e-3);
    let config = HoldRenewalConfig::default();
    let renewed_m = steering.renewed_offset_m(&config, offset_m, spent_m).unwrap();
    assert_relative_eq!(renewed_m, -0.003375, max_relative = 1e-3);
    let (deviation_m, offset_m) = Rolling::new(f64::INFINITY, spent_m, renewed_m).push(Some(&steering), 0.1);
    assert!(deviation_m.abs() < 1e-6 && offset_m.abs() < 1e-6, "{deviation_m} {offset_m}");
}

#[test]
fn a_hold_off_the_middle_has_more_room_on_one_side() {
    for (radius_m, per_place) in [(f64::INFINITY, 1.0), (HEAD_M, -3.0)] {
        let aside = steering(radius_m).held_at(0.003);
        let sign = f64::signum(per_place);
        // 2 mm to the left and 8 mm to the right, nine tenths of them
        assert_relative_eq!(aside.wanted_offset_m(sign), 0.0018 * per_place.abs(), epsilon = ROUNDING);
        assert_relative_eq!(aside.wanted_offset_m(-sign), -0.0072 * per_place.abs(), epsilon = ROUNDING);
    }
    assert_eq!(steering(f64::INFINITY).held_at(0.006).wanted_offset_m(1.0), 0.0);
    assert_eq!(steering(f64::INFINITY).held_at(0.0), steering(f64::INFINITY));
}

fn any_radius_m() -> impl Strategy<Value = f64> {
    prop_oneof![Just(f64::INFINITY), 0.001f64..0.5, -0.5f64..-0.001]
}

proptest! {
    #[test]
    fn the_command_of_a_mirrored_push_is_mirrored(
        radius_m in any_radius_m(), deviation_m in -0.01f64..0.01, share in -0.9f64..0.9,
    ) {
        let steering = steering(radius_m);
        let offset_m = share * steering.reach_m().map_or(0.005, |reach_m| reach_m.abs().min(0.005));
        let (left, right) = (command(&steering, deviation_m, offset_m), command(&steering, -deviation_m, -offset_m));
        let mirrored = Vector2::new(-right.velocity_world.x, right.velocity_world.y);
        prop_assert!((left.velocity_world - mirrored).norm() < ROUNDING);
    }

    #[test]
    fn the_command_is_finite_and_no_faster_than_its_limit(
        radius_m in any_radius_m(), deviation_m in -1.0f64..1.0, offset_m in -1.0f64..1.0,
        half_length_m in prop_oneof![Just(0.0), Just(f64::NAN), 0.0f64..0.1],
    ) {
        let steering = steering_with(SteeringConfig::default(), radius_m, half_length_m);
        let center = Point2::new(-deviation_m, 0.0);
        let contact = Point2::new(offset_m - deviation_m, -0.01);
        let found = steering.command(&contact, &Unit::new_unchecked(Vector2::y()), &center, SPEED_M_PER_S);
        let limit = SPEED_M_PER_S * 1.0_f64.hypot(SteeringConfig::default().largest_slope);
        prop_assert!(found.velocity_world.norm() <= limit + ROUNDING);
    }
}
