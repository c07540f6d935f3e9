//! Sections, foods and strokes that the tests share.

use std::f64::consts::TAU;

use nalgebra::{Point2, Vector2};
use sim::cutting::knife::Edge;
use sim::cutting::material::{Material, MaterialBasis};
use sim::cutting::mechanics::{Cut, CutStep, CuttingConfig, EdgeMotion};

/// Step of all tests, s.
pub const DT_S: f64 = 0.001;
/// Speed of measured cuts, and the reference speed of the foods here, m/s.
pub const SPEED_M_PER_S: f64 = 0.02;

/// A tough food without skin or friction, stiff enough that its dent is about 0.1 mm.
pub fn food(toughness_j_per_m2: f64) -> Material {
    Material {
        toughness_j_per_m2,
        skin_tension_n_per_m: 0.0,
        flank_shear_pa: 0.0,
        youngs_modulus_pa: 1e5,
        indentation_stiffness_pa: toughness_j_per_m2 / 1e-4,
        rate_exponent: 0.0,
        reference_speed_m_per_s: SPEED_M_PER_S,
        slice_efficiency: 1.0,
        initiation_factor_sharp: 1.1,
        initiation_factor_dull: 2.0,
        yield_stress_pa: 0.0,
        brittle_depth_share: None,
        board_friction: 0.4,
        density_kg_per_m3: 1000.0,
        basis: MaterialBasis::of_all("closed form"),
    }
}

/// A block with its upper side at y = 0, centered at x = 0.
pub fn block(width: f64, height: f64) -> Vec<Vec<Point2<f64>>> {
    let half = 0.5 * width;
    vec![vec![Point2::new(-half, 0.0), Point2::new(half, 0.0), Point2::new(half, height), Point2::new(-half, height)]]
}

/// A disc that touches y = 0 from below.
pub fn disc(diameter: f64) -> Vec<Vec<Point2<f64>>> {
    let radius = 0.5 * diameter;
    let corner = |k: i32| TAU * f64::from(k) / 720.0;
    vec![(0..720).map(|k| Point2::new(radius * corner(k).cos(), radius * (1.0 + corner(k).sin()))).collect()]
}

/// A straight edge of 400 mm, longer than any stroke here, with a blade of 100 mm.
pub fn long_edge() -> Edge {
    Edge::ideal(0.4, 0.1)
}

/// A cut without board.
pub fn cut(polygons: &[Vec<Point2<f64>>], food: &Material) -> Cut {
    Cut::new(polygons, food, &long_edge(), None, &CuttingConfig::default()).expect("valid")
}

/// The long edge's heel when its middle is at (x, y).
pub fn heel(x: f64, y: f64) -> Point2<f64> {
    Point2::new(x - 0.2, y)
}

/// Moves the long edge from just above the food straight down to `depth`, sliding by `ratio` times its way, and notes
/// depth of the edge and answer of every step.
pub fn push(cut: &mut Cut, depth: f64, speed: f64, ratio: f64) -> Vec<(f64, CutStep)> {
    let steps = (depth / (speed * DT_S)).round() as u32;
    let at = |k: u32| speed * DT_S * f64::from(k);
    let motion = |k: u32| EdgeMotion::translating(heel(ratio * at(k), at(k)), Vector2::new(ratio * speed, speed));
    (1..=steps).map(|k| (at(k), cut.step(&motion(k), DT_S).expect("finite"))).collect()
}

/// Largest force against the push, N.
pub fn peak_push_n(answers: &[(f64, CutStep)]) -> f64 {
    answers.iter().map(|(_, step)| -step.force_in_section.y).fold(0.0, f64::max)
}
