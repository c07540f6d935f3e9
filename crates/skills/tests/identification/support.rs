//! Samples told by formulas, and demonstrations rolled out past obstacles.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector, dvector};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use skills::basis::GaussianBasis;
use skills::canonical::CanonicalSystem;
use skills::coupling::{Coupling, Hoffmann, MotionState};
use skills::primitive::RolloutRequest;
use skills::regression::ForcingSamples;
use skills::separation::model_based::{
    AlgorithmOneConfig, IdentificationConfig, IdentificationData, LogForm, ModelBasedConfig, ObstructedDemonstration,
    Parameters,
};
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, Trajectory};

/// Parameters behind all samples and demonstrations.
pub const TRUTH: Parameters = Parameters { gamma: 60.0, beta: 2.5 };
/// Samples of each demonstration told by formulas.
pub const SAMPLES: usize = 101;
/// Bases of the samples told by formulas.
pub const BASES: usize = 8;

/// Options for the samples told by formulas.
pub fn config(identification: IdentificationConfig) -> ModelBasedConfig {
    let primitive = DmpConfig { bases: BASES, overlap: Some(0.5), ..DmpConfig::default() };
    ModelBasedConfig { primitive, identification, ..ModelBasedConfig::default() }
}

/// Algorithm 1 in one of its forms.
pub fn algorithm_one(form: LogForm) -> IdentificationConfig {
    IdentificationConfig::AlgorithmOne(AlgorithmOneConfig { form, ..AlgorithmOneConfig::default() })
}

/// φ of demonstration j at r = t/T: 0.15 + 1.2 exp(−((r − 0.3 − 0.2j)/0.15)²) + 0.1j.
pub fn angle(j: usize, r: f64) -> f64 {
    let j = j as f64;
    0.15 + 1.2 * (-((r - 0.3 - 0.2 * j) / 0.15).powi(2)).exp() + 0.1 * j
}

/// n of demonstration j: φ r(1 − r)(sin(2πr + j), cos(2πr + j)).
pub fn direction(j: usize, r: f64) -> [f64; 2] {
    let turn = 2.0 * PI * r + j as f64;
    let size = angle(j, r) * r * (1.0 - r);
    [size * turn.sin(), size * turn.cos()]
}

/// F = Ψw + γ n e^{−βφ} of `demonstrations`, w_i = (50 sin(i + 1), 40 cos(i + 1)), with n by `direction(j, r)`.
pub fn samples(demonstrations: usize, direction: impl Fn(usize, f64) -> [f64; 2]) -> IdentificationData {
    let rows = demonstrations * SAMPLES;
    let place = |row: usize| (row / SAMPLES, (row % SAMPLES) as f64 / (SAMPLES - 1) as f64);
    let canonical = CanonicalSystem::new(100f64.ln());
    let phases = DVector::from_fn(rows, |row, _| canonical.phase(place(row).1));
    let basis = GaussianBasis::uniform_in_time(BASES, canonical, 0.5);
    let weights = DMatrix::from_fn(BASES, 2, |i, k| match k {
        0 => 50.0 * (i as f64 + 1.0).sin(),
        _ => 40.0 * (i as f64 + 1.0).cos(),
    });
    let directions = DMatrix::from_fn(rows, 2, |row, k| direction(place(row).0, place(row).1)[k]);
    let angles = DVector::from_fn(rows, |row, _| angle(place(row).0, place(row).1));
    let intended = basis.design_matrix(&phases) * weights;
    let samples = |targets| ForcingSamples { phases: phases.clone(), targets, weights: DVector::repeat(rows, 1.0) };
    let free = IdentificationData::new(samples(intended.clone()), directions.clone(), angles.clone()).unwrap();
    IdentificationData::new(samples(intended + free.coupling(TRUTH)), directions, angles).unwrap()
}

/// Skill that all demonstrators intend: 1 along x with a weave of 0.1 along y.
pub fn intention() -> Dmp {
    let table = DMatrix::from_fn(501, 2, |row, k| {
        let r = row as f64 / 500.0;
        match k {
            0 => minimum_jerk(r),
            _ => 0.1 * (2.0 * PI * r).sin() * 16.0 * (r * (1.0 - r)).powi(2),
        }
    });
    Dmp::learn(&DmpConfig::default(), &[Trajectory::uniform(0.004, table).unwrap()]).unwrap()
}

/// Duration of a demonstration, s.
pub const DURATION_S: f64 = 2.0;
/// Steps of the demonstrator between two samples, so that holding Δu over a step is no error of note.
const STEPS_PER_SAMPLE: usize = 10;

/// Rolls the intention out from `start` to `goal` past an obstacle or none, 501 samples.
pub fn demonstrate(start: [f64; 2], goal: [f64; 2], obstacle: Option<[f64; 2]>) -> ObstructedDemonstration {
    let step_s = DURATION_S / (500 * STEPS_PER_SAMPLE) as f64;
    let request = RolloutRequest::new(dvector![start[0], start[1]], dvector![goal[0], goal[1]], DURATION_S, step_s);
    let mut stepper = intention().stepper(&request).unwrap();
    let obstacles = obstacle.iter().map(|point| point.to_vec()).collect();
    let law = Hoffmann::new(TRUTH.gamma, TRUTH.beta, obstacles).unwrap();
    let mut table = DMatrix::zeros(501, 2);
    for row in 0..501 {
        table.row_mut(row).tr_copy_from(stepper.position());
        for _ in 0..STEPS_PER_SAMPLE {
            let mut coupling = [0.0; 2];
            let state = MotionState {
                position: stepper.position().as_slice(),
                velocity: stepper.velocity().as_slice(),
                elapsed_s: stepper.elapsed_s(),
                duration_s: stepper.duration_s(),
            };
            law.add_to(&state, &mut coupling);
            stepper.step_with_coupling(step_s, &coupling).unwrap();
        }
    }
    let trajectory = Trajectory::uniform(DURATION_S / 500.0, table).unwrap();
    ObstructedDemonstration { trajectory, obstacle: obstacle.map(|point| point.to_vec()), goal: Some(goal.to_vec()) }
}

/// Standard deviation of the smoothing of a noisy demonstration, samples.
const SMOOTHING: f64 = 2.0;

/// Adds white noise of the given standard deviation to every position but the ends, and smooths it as a user would.
pub fn measured(shown: &ObstructedDemonstration, noise: f64, random: &mut ChaCha8Rng) -> ObstructedDemonstration {
    let mut table = shown.trajectory.samples().clone();
    let last = table.nrows() - 1;
    for row in 1..last {
        for k in 0..table.ncols() {
            table[(row, k)] += noise * normal(random);
        }
    }
    let reach = (4.0 * SMOOTHING) as isize;
    let weight = |offset: isize| (-0.5 * (offset as f64 / SMOOTHING).powi(2)).exp();
    let total: f64 = (-reach..=reach).map(weight).sum();
    let smooth = DMatrix::from_fn(table.nrows(), table.ncols(), |row, k| {
        let value = |offset: isize| {
            let wanted = row as isize + offset;
            let inside = wanted.clamp(0, last as isize);
            let mirrored = table[((2 * inside - wanted) as usize, k)];
            if wanted == inside { mirrored } else { 2.0 * table[(inside as usize, k)] - mirrored }
        };
        (-reach..=reach).map(|offset| weight(offset) * value(offset)).sum::<f64>() / total
    });
    let trajectory = Trajectory::new(shown.trajectory.times_s().to_vec(), smooth).unwrap();
    ObstructedDemonstration { trajectory, ..shown.clone() }
}

/// Draws from the standard normal distribution, by Box and Muller.
pub fn normal(random: &mut ChaCha8Rng) -> f64 {
    let (a, b): (f64, f64) = (random.random_range(f64::MIN_POSITIVE..1.0), random.random_range(0.0..1.0));
    (-2.0 * a.ln()).sqrt() * (2.0 * PI * b).cos()
}

/// Relative errors of γ and β.
pub fn errors(found: Parameters) -> [f64; 2] {
    [(found.gamma / TRUTH.gamma - 1.0).abs(), (found.beta / TRUTH.beta - 1.0).abs()]
}
