//! How close rollouts come to the solution of Eq. (1) and to the demonstration.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, DmpForm, MovementPrimitive, RolloutRequest, Trajectory};

/// Reproduction asked for by the comparison with other libraries, unit of the demonstration (range 2.5 in seven
/// dimensions).
const REPRODUCTION: f64 = 5e-5;
/// Steps of the Runge-Kutta solution that counts as exact; its own error is below 1e-11.
const FINE_STEPS: usize = 8000;

/// y_d(t) = (0.5 + 0.1d)·mj(t) + 0.3·64t³(1 − t)³·sin(2π(1 + 0.5d)t + 0.3d), 1000 samples over 1 s: the demonstration by
/// which other libraries were measured.
pub fn compared(dimension: usize) -> Trajectory {
    let position = |row: usize, d: usize| {
        let (t, d) = (row as f64 / 999.0, d as f64);
        let window = 64.0 * (t * (1.0 - t)).powi(3);
        (0.5 + 0.1 * d) * minimum_jerk(t) + 0.3 * window * (2.0 * PI * (1.0 + 0.5 * d) * t + 0.3 * d).sin()
    };
    Trajectory::uniform(1.0 / 999.0, DMatrix::from_fn(1000, dimension, position)).unwrap()
}

fn learn(form: DmpForm, bases: usize, shown: &Trajectory) -> Dmp {
    Dmp::learn(&DmpConfig { form, bases, ..DmpConfig::default() }, std::slice::from_ref(shown)).unwrap()
}

// root mean square over the rows of the Euclidean distance
fn rmse(difference: &DMatrix<f64>) -> f64 {
    (difference.norm_squared() / difference.nrows() as f64).sqrt()
}

// Eq. (1) as printed, solved by the classical Runge-Kutta method with the phase of each stage; rows as many as `steps`
fn solved(dmp: &Dmp, request: &RolloutRequest, steps: usize) -> DMatrix<f64> {
    let (alpha, beta, step) = (25.0, 25.0 / 4.0, 1.0 / steps as f64);
    let mut activations = DVector::zeros(dmp.basis().count());
    let mut forcing = |progress: f64| {
        dmp.basis().activate_into(dmp.canonical().phase(progress), &mut activations);
        dmp.weights().tr_mul(&activations)
    };
    let rate = |x: &DVector<f64>, v: &DVector<f64>, f: &DVector<f64>| alpha * (beta * (&request.goal - x) - v) + f;
    let (mut x, mut v) = (request.start.clone(), DVector::zeros(request.start.len()));
    let mut path = DMatrix::zeros(steps + 1, x.len());
    path.row_mut(0).tr_copy_from(&x);
    for k in 0..steps {
        let [f0, f1, f2] = [0.0, 0.5, 1.0].map(|part| forcing((k as f64 + part) * step));
        let a0 = rate(&x, &v, &f0);
        let v1 = &v + &a0 * (0.5 * step);
        let a1 = rate(&(&x + &v * (0.5 * step)), &v1, &f1);
        let v2 = &v + &a1 * (0.5 * step);
        let a2 = rate(&(&x + &v1 * (0.5 * step)), &v2, &f1);
        let v3 = &v + &a2 * step;
        let a3 = rate(&(&x + &v2 * step), &v3, &f2);
        x += (&v + 2.0 * &v1 + 2.0 * &v2 + &v3) * (step / 6.0);
        v += (&a0 + 2.0 * &a1 + 2.0 * &a2 + &a3) * (step / 6.0);
        path.row_mut(k + 1).tr_copy_from(&x);
    }
    path
}

#[test]
fn rollouts_converge_to_the_solution_of_equation_1_with_order_2() {
    let shown = compared(2);
    let dmp = learn(DmpForm::Eq1Literal, 50, &shown);
    let request = |step_s| RolloutRequest::new(shown.start(), shown.end(), 1.0, step_s);
    let exact = solved(&dmp, &request(1.0), FINE_STEPS);
    let errors = [0.02, 0.005, 0.00125].map(|step_s| {
        let found = dmp.rollout(&request(step_s)).unwrap().into_positions();
        let stride = FINE_STEPS / (found.len() - 1);
        rmse(&DMatrix::from_fn(found.len(), 2, |row, k| found.samples()[(row, k)] - exact[(row * stride, k)]))
    });
    println!("errors {errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2() / 2.0;
        assert!((1.9..2.1).contains(&order), "order {order} from errors {errors:?}");
    }
}

fn reproduction(config: &DmpConfig, dimension: usize) -> f64 {
    let shown = compared(dimension);
    let dmp = Dmp::learn(config, std::slice::from_ref(&shown)).unwrap();
    let found = dmp.rollout(&RolloutRequest::new(shown.start(), shown.end(), 1.0, 1.0 / 999.0)).unwrap();
    rmse(&(found.positions().samples() - shown.samples()))
}

#[test]
fn the_compared_demonstration_is_reproduced() {
    for (dimension, bases, largest) in [
        (2, 10, 4e-3),
        (2, 50, 6.5e-6),
        (2, 100, 6e-6),
        (7, 10, 0.1),
        // 3.8e-5 of it are the second differences of the demonstration, 0.9e-5 the hold over 1 ms
        (7, 50, REPRODUCTION),
        (7, 100, REPRODUCTION),
    ] {
        let found = reproduction(&DmpConfig { bases, ..DmpConfig::default() }, dimension);
        assert!(found <= largest, "{dimension}-D, {bases} bases: {found:e}");
    }
}
