//! Demonstrations and shorthands shared by the tests of the movement primitive.

// each test program uses a part of it
#![allow(dead_code)]

use std::sync::LazyLock;

use nalgebra::{DMatrix, DVector, dvector};
use skills::regression::{Lwr, RegressionConfig};
use skills::time_law::minimum_jerk;
use skills::{Dmp, DmpConfig, DmpForm, MovementPrimitive, Rollout, RolloutRequest, Trajectory};

/// Samples one coordinate of a motion of `duration_s`, told over r = t/T, at `samples` instants.
pub fn sampled(duration_s: f64, samples: usize, position: impl Fn(f64) -> f64) -> Trajectory {
    let last = (samples - 1) as f64;
    let table = DMatrix::from_fn(samples, 1, |row, _| position(row as f64 / last));
    Trajectory::uniform(duration_s / last, table).unwrap()
}

/// Position, mm, of a 200 mm motion with a 30 mm weave over r = t/T, at rest at both ends.
pub fn weave_mm(r: f64) -> f64 {
    200.0 * minimum_jerk(r) + 30.0 * (3.0 * std::f64::consts::PI * r).sin() * 16.0 * (r * (1.0 - r)).powi(2)
}

/// The weave over 2 s at 500 Hz, mm.
pub fn demonstration() -> Trajectory {
    sampled(2.0, 1001, weave_mm)
}

/// Default options in the given form.
pub fn config(form: DmpForm) -> DmpConfig {
    DmpConfig { form, ..DmpConfig::default() }
}

/// Default options in the given form with locally weighted regression.
pub fn locally_weighted(form: DmpForm) -> DmpConfig {
    DmpConfig { form, regression: RegressionConfig::Lwr(Lwr {}), ..DmpConfig::default() }
}

/// The primitive learned from the weave in the given form; learned once per test program.
pub fn learn(form: DmpForm) -> Dmp {
    static LEARNT: LazyLock<Vec<Dmp>> = LazyLock::new(|| {
        let forms = [DmpForm::Residual, DmpForm::Eq1Literal, DmpForm::Scaled];
        forms.map(|form| Dmp::learn(&config(form), &[demonstration()]).unwrap()).to_vec()
    });
    LEARNT.iter().find(|dmp| dmp.form() == form).unwrap().clone()
}

/// Asks for one coordinate.
pub fn request(start: f64, goal: f64, duration_s: f64, time_step_s: f64) -> RolloutRequest {
    RolloutRequest::new(dvector![start], dvector![goal], duration_s, time_step_s)
}

/// Rolls one coordinate out.
pub fn rollout(dmp: &Dmp, start: f64, goal: f64, duration_s: f64, time_step_s: f64) -> Rollout {
    dmp.rollout(&request(start, goal, duration_s, time_step_s)).unwrap()
}

/// Root mean square of a table.
pub fn rms(table: &DMatrix<f64>) -> f64 {
    (table.norm_squared() / table.len() as f64).sqrt()
}

/// Last value of a one-coordinate rollout.
pub fn last(rollout: &Rollout) -> f64 {
    let end: DVector<f64> = rollout.positions().end();
    end[0]
}
