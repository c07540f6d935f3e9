//! How well the maps recover one intention from demonstrations that different corridors bent, for two models of the
//! person.

use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use skills::corridor::Bounds;
use skills::corridor_map::{AsPublished, CorridorMap, CorridorMapConfig, MForm, MotionEnds, NormalForm, Proximal};
use skills::time_law::minimum_jerk;

use super::median;

const TASKS: usize = 120;
const DEMONSTRATIONS: usize = 6;
const SAMPLES: usize = 201;
/// Strength of the reaction of model A, in widths.
const REACTION: f64 = 0.01;

/// One motion of unit size: what was intended, the bounds, and what was shown.
struct Shown {
    intended: Vec<f64>,
    bounds: Vec<Bounds>,
    x: Vec<f64>,
}

impl Shown {
    fn ends(&self) -> MotionEnds {
        let last = SAMPLES - 1;
        MotionEnds {
            start: self.x[0],
            start_bounds: self.bounds[0],
            goal: self.x[last],
            goal_bounds: self.bounds[last],
        }
    }

    fn mapped(&self, map: &dyn CorridorMap) -> Vec<f64> {
        let progress = |row: usize| row as f64 / (SAMPLES - 1) as f64;
        (0..SAMPLES).map(|row| map.unconstrained(&self.bounds[row], progress(row), self.x[row])).collect()
    }
}

/// Push of model A away from the bounds, μW(1/p − 1/(1 − p)), at the position `x`.
fn push(bounds: &Bounds, x: f64) -> f64 {
    let width = bounds.width().position;
    let p = (x - bounds.lower.position) / width;
    REACTION * width * (1.0 / p - 1.0 / (1.0 - p))
}

/// Solves x = `intended` + push(x) by bisection.
fn pushed(bounds: &Bounds, intended: f64) -> f64 {
    let (mut low, mut high) = (bounds.lower.position, bounds.upper.position);
    for _ in 0..60 {
        let x = 0.5 * (low + high);
        if x - intended > push(bounds, x) {
            high = x;
        } else {
            low = x;
        }
    }
    0.5 * (low + high)
}

/// How the corridors of a task lie about what is intended.
#[derive(Debug, Clone, Copy)]
enum Corridors {
    /// They go along with it, less wide than its length: walls to either side of the way.
    Following,
    /// They stay nearly where they are, wider than its length: the edges of a table.
    Standing,
}

/// Demonstrations of one random intention in random corridors, one coordinate each; the ends are inside, and the
/// intention passes the bounds at times between them.
fn task(random: &mut ChaCha8Rng, corridors: Corridors, person: Person) -> Vec<Shown> {
    let mut uniform = |from: f64, to: f64| from + (to - from) * random.random_range(0.0..1.0);
    let progress = |row: usize| row as f64 / (SAMPLES - 1) as f64;
    let (sway, turns) = (uniform(-0.6, 0.6), uniform(1.0, 2.5));
    let intend = |r: f64| minimum_jerk(r) + sway * (0.5 * TAU * turns * r).sin() * 16.0 * (r * (1.0 - r)).powi(2);
    let intended: Vec<f64> = (0..SAMPLES).map(|row| intend(progress(row))).collect();
    let mut show = || {
        let (width, change) = (uniform(0.4, 0.8), uniform(-0.3, 0.3));
        let (share, drift) = (uniform(0.2, 0.8), uniform(-0.3, 0.3));
        let (wave, rate, phase) = (uniform(0.1, 0.6), uniform(0.5, 1.5), uniform(0.0, TAU));
        let (below, above, tilt) = (uniform(0.1, 0.4), uniform(0.1, 0.4), uniform(-0.05, 0.05));
        let at = |row: usize| {
            let r = progress(row);
            match corridors {
                Corridors::Following => {
                    let width = width * (1.0 + change * (TAU * 0.5 * r).cos());
                    let inside = (share + drift * (r - 0.5)).clamp(0.12, 0.88);
                    let p = inside + wave * (TAU * rate * r + phase).sin() * 4.0 * r * (1.0 - r);
                    let lower = intended[row] - p * width;
                    Bounds::still(lower, lower + width)
                }
                Corridors::Standing => Bounds::still(-below + tilt * r, 1.0 + above - tilt * r),
            }
        };
        let bounds: Vec<Bounds> = (0..SAMPLES).map(at).collect();
        Shown { x: person(&bounds, &intended), intended: intended.clone(), bounds }
    };
    (0..DEMONSTRATIONS).map(|_| show()).collect()
}

/// What a person shows who intends a motion between bounds, one of each per sample.
type Person = fn(&[Bounds], &[f64]) -> Vec<f64>;

/// Model A reacts only near the bounds: x minimizes ½(x − x_i)² − μW²·(ln p + ln(1 − p)), which is none of the maps.
///
/// Start and goal are those of the task: what is pushed at the ends is intended more by as much, faded linearly
/// between.
fn model_a(bounds: &[Bounds], intended: &[f64]) -> Vec<f64> {
    let last = SAMPLES - 1;
    let [start, goal] = [0, last].map(|row| push(&bounds[row], intended[row]));
    let at = |row: usize| {
        let r = row as f64 / last as f64;
        pushed(&bounds[row], intended[row] - start * (1.0 - r) - goal * r)
    };
    (0..=last).map(at).collect()
}

/// Model B is the sigmoid about the middle of the corridor.
fn model_b(bounds: &[Bounds], intended: &[f64]) -> Vec<f64> {
    let last = SAMPLES - 1;
    let ends =
        MotionEnds { start: intended[0], start_bounds: bounds[0], goal: intended[last], goal_bounds: bounds[last] };
    let map = CorridorMapConfig::MForm(MForm::default()).map(&ends, 0.01).unwrap().map;
    let at = |row: usize| map.constrained(&bounds[row], row as f64 / last as f64, intended[row]);
    (0..=last).map(at).collect()
}

/// Median over the tasks of the root mean square distance to the intention, and to the mean of the task's
/// demonstrations.
fn measure(tasks: &[Vec<Shown>], map: impl Fn(&Shown) -> Vec<f64>) -> [f64; 2] {
    let rms = |sum: f64| (sum / (DEMONSTRATIONS * SAMPLES) as f64).sqrt();
    let (mut distances, mut spreads) = (vec![], vec![]);
    for task in tasks {
        let mapped: Vec<Vec<f64>> = task.iter().map(&map).collect();
        let (mut distance, mut spread) = (0.0, 0.0);
        for row in 0..SAMPLES {
            let mean = mapped.iter().map(|x| x[row]).sum::<f64>() / DEMONSTRATIONS as f64;
            spread += mapped.iter().map(|x| (x[row] - mean).powi(2)).sum::<f64>();
            distance += mapped.iter().map(|x| (x[row] - task[0].intended[row]).powi(2)).sum::<f64>();
        }
        distances.push(rms(distance));
        spreads.push(rms(spread));
    }
    [median(distances), median(spreads)]
}

/// Raw, solved Proposition 1, as printed, M-form, proximal with S = 0.02 and 0.05.
fn table(name: &str, corridors: Corridors, person: Person) -> [[f64; 2]; 6] {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let tasks: Vec<Vec<Shown>> = (0..TASKS).map(|_| task(&mut random, corridors, person)).collect();
    let by = |config: CorridorMapConfig| {
        measure(&tasks, |shown| {
            let ends = shown.ends();
            shown.mapped(config.map(&ends, ends.delta(0.0, 1.0)).unwrap().map.as_ref())
        })
    };
    let rows = [
        measure(&tasks, |shown| shown.x.clone()),
        measure(&tasks, |shown| {
            let ends = shown.ends();
            shown.mapped(&NormalForm::solve(&ends, ends.delta(0.0, 1.0)).unwrap())
        }),
        by(CorridorMapConfig::AsPublished(AsPublished::default())),
        by(CorridorMapConfig::MForm(MForm::default())),
        by(CorridorMapConfig::Proximal(Proximal { strength: 0.02 })),
        by(CorridorMapConfig::Proximal(Proximal::default())),
    ];
    let names = ["raw", "Proposition 1", "as printed", "M-form", "proximal 0.02", "proximal 0.05"];
    for (kind, [distance, spread]) in names.iter().zip(rows) {
        println!("{name}, {corridors:?}, {kind}: {distance:.4} to the intention, {spread:.4} between demonstrations");
    }
    rows
}

#[test]
fn who_reacts_near_bounds_only_is_made_consistent_by_the_proximal_map_and_not_by_proposition_1() {
    for corridors in [Corridors::Following, Corridors::Standing] {
        let [raw, solved, printed, _, weak, proximal] = table("model A", corridors, model_a);
        assert!(weak[0] < raw[0] && weak[1] < raw[1], "{corridors:?}");
        assert!(proximal[1] < raw[1], "{corridors:?}");
        assert!(solved[0] > raw[0] && solved[1] > raw[1], "{corridors:?}");
        assert!(printed[0] > raw[0] && printed[1] > raw[1], "{corridors:?}");
    }
}

#[test]
fn who_moves_by_the_sigmoid_is_recovered_by_the_m_form() {
    for corridors in [Corridors::Following, Corridors::Standing] {
        let [raw, solved, _, m_form, _, _] = table("model B", corridors, model_b);
        assert!(m_form[0] < 0.1 * raw[0] && m_form[1] < 0.1 * raw[1], "{corridors:?}");
        assert!(solved[1] > m_form[1], "{corridors:?}");
    }
}
