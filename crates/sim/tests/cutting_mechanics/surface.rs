//! Quality of the incision against surfaces of known form.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector2;
use sim::cutting::knife::Edge;
use sim::cutting::mechanics::{Cut, CuttingConfig, EdgeMotion, IncisionQuality};

use super::stroke::{DT_S, SPEED_M_PER_S, block, food, heel, long_edge};

/// Pushes through a block of 30 mm while the blade is led aside by `aside(depth)`.
fn quality(edge: &Edge, aside: impl Fn(f64) -> f64) -> IncisionQuality {
    let mut cut = Cut::new(&block(0.04, 0.03), &food(200.0), edge, None, &CuttingConfig::default()).expect("valid");
    for k in 1..=1520 {
        let depth = f64::from(k) * 2e-5;
        let straight = EdgeMotion::translating(heel(0.0, depth), Vector2::new(0.0, SPEED_M_PER_S));
        cut.step(&EdgeMotion { lateral_m: aside(depth), ..straight }, DT_S).expect("finite");
    }
    cut.quality()
}

fn wave(amplitude: f64, wavelength: f64) -> impl Fn(f64) -> f64 {
    move |depth| amplitude * (TAU * depth / wavelength).cos()
}

#[test]
fn a_wave_has_the_mean_and_total_deviation_of_a_sine() {
    // whole periods on 30 mm, even about its middle so that the best plane does not lean, 24 cells each; amplitude 0.5 mm: Ra = 2 A/π, Rt = 2 A
    let found = quality(&long_edge(), wave(0.0005, 0.006));
    approx::assert_relative_eq!(found.mean_deviation_m, 0.001 / PI, max_relative = 0.02);
    approx::assert_relative_eq!(found.total_deviation_m, 0.001, max_relative = 0.02);
    assert!(found.tilt_rad < 0.002, "{found:?}");
    assert_eq!(found.kinks, 0);
}

#[test]
fn waviness_keeps_long_waves_and_not_short_ones() {
    let (short, long) = (quality(&long_edge(), wave(0.0005, 0.0015)), quality(&long_edge(), wave(0.0005, 0.015)));
    // the filter of ISO 16610-21 passes exp(-π (α 5/λ)²): 4e-4 at 1.5 mm, 0.926 at 15 mm
    assert!(short.waviness_m < 0.1 * short.mean_deviation_m, "{short:?}");
    assert!((0.85..1.0).contains(&(long.waviness_m / long.mean_deviation_m)), "{long:?}");
}

#[test]
fn teeth_leave_the_surface_twice_as_rough() {
    let toothed = Edge { roughness_factor: 2.0, ..long_edge() };
    let (plain, rough) = (quality(&long_edge(), wave(0.0003, 0.003)), quality(&toothed, wave(0.0003, 0.003)));
    approx::assert_relative_eq!(rough.mean_deviation_m, 2.0 * plain.mean_deviation_m, max_relative = 1e-12);
    assert_eq!(rough.waviness_m, plain.waviness_m);
}

#[test]
fn a_straight_cut_has_no_deviation() {
    let found = quality(&long_edge(), |_| 0.0);
    assert_eq!((found.mean_deviation_m, found.total_deviation_m, found.tilt_rad), (0.0, 0.0, 0.0));
}
