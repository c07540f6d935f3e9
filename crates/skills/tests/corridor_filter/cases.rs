//! Skills and corridors shared by the tests, and runs of a filter on them.

use nalgebra::{DMatrix, dvector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use skills::corridor::{Bounds, Corridor};
use skills::corridor_filter::{Constrained, CorridorFilterConfig, FilterError, FilterRequest, constrain};
use skills::time_law::{MinimumJerkTransfer, PathState};
use skills::{Rollout, Trajectory};

/// Duration of the random skills and τ of every run, s.
pub const DURATION_S: f64 = 1.0;

/// Samples a path of one coordinate every `step` until `end_s`.
pub fn skill(step: f64, end_s: f64, path: impl Fn(f64) -> PathState) -> Rollout {
    let rows = (end_s / step).round() as usize + 1;
    let table = |of: fn(PathState) -> f64| DMatrix::from_fn(rows, 1, |row, _| of(path(row as f64 * step)));
    let positions = Trajectory::uniform(step, table(|at| at.position)).unwrap();
    Rollout::new(positions, table(|at| at.first), table(|at| at.second)).unwrap()
}

/// A path at rest.
pub fn still(position: f64) -> PathState {
    PathState { position, ..PathState::default() }
}

/// Constrains a skill that ends at the goal, with τ = 1.
pub fn run(
    config: &CorridorFilterConfig,
    skill: &Rollout,
    corridor: &Corridor,
    goal: f64,
) -> Result<Constrained, FilterError> {
    let request = FilterRequest { start: None, goal: dvector![goal], duration_s: DURATION_S };
    constrain(config, skill, corridor, &request)
}

/// Sum of sinusoids under a bump that vanishes with three derivatives at 0 and 1, and is 0 outside.
#[derive(Debug, Clone)]
pub struct Wave {
    // height, angular rate, phase
    terms: Vec<[f64; 3]>,
}

impl Wave {
    pub fn random(rng: &mut ChaCha8Rng, height: f64, rates: std::ops::Range<f64>, terms: usize) -> Self {
        let term = |_| {
            let phase = rng.random_range(0.0..std::f64::consts::TAU);
            [rng.random_range(-height..height), rng.random_range(rates.clone()), phase]
        };
        Self { terms: (0..terms).map(term).collect() }
    }

    pub fn at(&self, t: f64) -> PathState {
        let r = t.clamp(0.0, 1.0);
        let q = r * (1.0 - r);
        // 64q³ and its derivatives
        let slope = 1.0 - 2.0 * r;
        let bump = [64.0 * q.powi(3), 192.0 * q * q * slope, 384.0 * q * (slope * slope - q)];
        let mut sum = PathState::default();
        for [height, rate, phase] in &self.terms {
            let (sine, cosine) = (rate * r + phase).sin_cos();
            sum.position += height * bump[0] * sine;
            sum.first += height * (bump[1] * sine + bump[0] * rate * cosine);
            sum.second += height * ((bump[2] - bump[0] * rate * rate) * sine + 2.0 * bump[1] * rate * cosine);
        }
        sum
    }
}

/// How the bounds of a random case move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Class {
    Constant,
    Slow,
    Fast,
}

/// Random skill from 0 to 1 in unit time, and bounds that contain both ends; everything rests after that.
#[derive(Debug, Clone)]
pub struct Case {
    class: Class,
    skill: Wave,
    middle: Wave,
    // distance of each bound from the middle at the ends, and how much it breathes
    distances: [f64; 2],
    breath: [Wave; 2],
}

impl Case {
    /// Draws case `number` of a class, its skill weaving up to about three times `amplitude`.
    pub fn random(class: Class, amplitude: f64, number: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(number);
        let tau = std::f64::consts::TAU;
        let rates = if class == Class::Fast { 2.0 * tau..5.0 * tau } else { 0.5 * tau..tau };
        Self {
            class,
            skill: Wave::random(&mut rng, amplitude, 0.5 * tau..1.5 * tau, 3),
            middle: Wave::random(&mut rng, 0.2, rates.clone(), 2),
            distances: [rng.random_range(0.15..0.5), rng.random_range(0.15..0.5)],
            breath: [(); 2].map(|()| Wave::random(&mut rng, 0.2, rates.clone(), 2)),
        }
    }

    pub fn path(&self, t: f64) -> PathState {
        plus(transfer(t), self.skill.at(t), 1.0)
    }

    pub fn bounds(&self, t: f64) -> Bounds {
        let [below, above] = self.distances;
        if self.class == Class::Constant {
            return Bounds::still(-below, 1.0 + above);
        }
        let middle = plus(transfer(t), self.middle.at(t), 1.0);
        let side = |k: usize, sign: f64| {
            let distance = self.distances[k];
            let moved = plus(middle, self.breath[k].at(t), sign * distance);
            PathState { position: moved.position + sign * distance, ..moved }
        };
        Bounds { lower: side(0, -1.0), upper: side(1, 1.0) }
    }

    /// Samples the skill and its corridor every `step` until `end_s`.
    pub fn sampled(&self, step: f64, end_s: f64) -> (Rollout, Corridor) {
        let times = (0..=100).map(|row| 0.01 * f64::from(row)).collect();
        let corridor = Corridor::sampled(times, 1, |t, _| self.bounds(t)).unwrap();
        (skill(step, end_s, |t| self.path(t)), corridor)
    }
}

/// The minimum-jerk transfer from 0 to 1.
pub fn transfer(t: f64) -> PathState {
    MinimumJerkTransfer::new(0.0, PathState::default(), 1.0, 1.0).at(t)
}

pub fn plus(one: PathState, other: PathState, factor: f64) -> PathState {
    PathState {
        position: one.position + factor * other.position,
        first: one.first + factor * other.first,
        second: one.second + factor * other.second,
    }
}
