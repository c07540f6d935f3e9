//! The maps of Eqs. (16)–(20) and Algorithm 2: reference vectors, errata, statistics, properties and recovery of what
//! was intended.

// helpers of tests may stop at the first surprise, as tests do
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

mod errata;
mod properties;
mod recovery;
mod separation;
mod validity;
mod vectors;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use skills::corridor::Bounds;
use skills::corridor_map::{ClosedForm, CorridorMap, CorridorMapConfig, MForm, MotionEnds, Proximal};

/// Start and goal at the shares p of the widths W above the lower bounds L.
fn ends(start: [f64; 3], goal: [f64; 3]) -> MotionEnds {
    let at = |[share, lower, width]: [f64; 3]| (lower + share * width, Bounds::still(lower, lower + width));
    let ((start, start_bounds), (goal, goal_bounds)) = (at(start), at(goal));
    MotionEnds { start, start_bounds, goal, goal_bounds }
}

/// Unit-size problems: shares uniform in [0.02, 0.98], lower bounds uniform in [-1, 1], width 1 at the start and a
/// width at the goal whose logarithm is uniform in ±ln `ratio`.
fn random_ends(seed: u64, ratio: f64) -> impl Iterator<Item = MotionEnds> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    std::iter::repeat_with(move || {
        let mut uniform = |from: f64, to: f64| from + (to - from) * random.random_range(0.0..1.0);
        let width = uniform(-1.0, 1.0) * ratio.ln();
        ends([uniform(0.02, 0.98), uniform(-1.0, 1.0), 1.0], [uniform(0.02, 0.98), uniform(-1.0, 1.0), width.exp()])
    })
}

/// Greater of the distances by which the map moves start and goal.
fn end_error(map: &dyn CorridorMap, ends: &MotionEnds) -> f64 {
    let start = map.unconstrained(&ends.start_bounds, 0.0, ends.start) - ends.start;
    let goal = map.unconstrained(&ends.goal_bounds, 1.0, ends.goal) - ends.goal;
    start.abs().max(goal.abs())
}

/// The kinds that keep the ends.
fn kinds() -> [CorridorMapConfig; 3] {
    [
        CorridorMapConfig::Proximal(Proximal::default()),
        CorridorMapConfig::MForm(MForm::default()),
        CorridorMapConfig::ClosedForm(ClosedForm::default()),
    ]
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
