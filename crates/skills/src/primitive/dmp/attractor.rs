//! The linear attractor of Eq. (1) and its exact step under a forcing term that is linear in time over the step.
//!
//! The paper does not say how Eq. (1) is integrated. Explicit Euler is unstable for steps above 4τ/α and loses two
//! decades of accuracy before; the first-order hold here is exact for a linear forcing term and stable for every step.

/// Critically damped attractor τv̇ = −α(βu + v) + f, τu̇ = v, with β = α/4 and u = x − g (or ξ): Eq. (1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Attractor {
    alpha: f64,
}

/// Exact map of (u, v) over a step h: (u, v)⁺ = Φ(u, v) + Γ0·f_k + Γ1·(f_{k+1} − f_k).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Propagator {
    /// The step h/τ this was made for.
    pub(super) ratio: f64,
    /// Φ, rows u and v.
    pub(super) transition: [[f64; 2]; 2],
    /// Γ0, response to a constant forcing term.
    pub(super) constant: [f64; 2],
    /// Γ1, response to a forcing term that rises from 0 to 1 over the step.
    pub(super) ramp: [f64; 2],
}

impl Attractor {
    pub(super) fn new(alpha: f64) -> Self {
        Self { alpha }
    }

    pub(super) fn alpha(&self) -> f64 {
        self.alpha
    }

    fn stiffness(&self) -> f64 {
        // αβ with β = α/4
        0.25 * self.alpha * self.alpha
    }

    /// Evaluates τv̇ = τ²ẍ of Eq. (1) at u, v and forcing term f.
    pub(super) fn acceleration(&self, u: f64, v: f64, forcing: f64) -> f64 {
        forcing - self.stiffness() * u - self.alpha * v
    }

    /// Evaluates the forcing target of Eq. (5) that gives τ²ẍ = `acceleration` at u and v.
    pub(super) fn forcing_target(&self, u: f64, v: f64, acceleration: f64) -> f64 {
        acceleration + self.stiffness() * u + self.alpha * v
    }

    /// Builds Φ, Γ0 and Γ1 for a step h with `ratio` = h/τ.
    ///
    /// With a = αh/(2τ), E = e^{−a}: Φ = E[[1 + a, h/τ], [−αβh/τ, 1 − a]], Γ0 = [(1 − E(1 + a))/αβ, Eh/τ],
    /// Γ1 = [(1 − (2 − E(2 + a))/a)/αβ, (1 − E(1 + a))/a²·h/τ]. The bracketed differences cancel for small a and are then
    /// summed as series.
    pub(super) fn propagator(&self, ratio: f64) -> Propagator {
        let a = 0.5 * self.alpha * ratio;
        let decay = (-a).exp();
        let stiffness = self.stiffness();
        let (second, third) = remainders(a);
        Propagator {
            ratio,
            transition: [[decay * (1.0 + a), decay * ratio], [-decay * stiffness * ratio, decay * (1.0 - a)]],
            constant: [second / stiffness, decay * ratio],
            ramp: [third / (a * stiffness), second / (a * a) * ratio],
        }
    }
}

impl Propagator {
    /// Steps (u, v) under a forcing term that runs from `from` to `to`.
    pub(super) fn step(&self, u: f64, v: f64, from: f64, to: f64) -> (f64, f64) {
        let rise = to - from;
        let [[uu, uv], [vu, vv]] = self.transition;
        (
            uu * u + uv * v + self.constant[0] * from + self.ramp[0] * rise,
            vu * u + vv * v + self.constant[1] * from + self.ramp[1] * rise,
        )
    }
}

/// Argument below which the remainders are summed as series.
const SERIES_BELOW: f64 = 0.5;
/// Terms of the series; the next one is below 0.5^16/16! of the first.
const SERIES_TERMS: u32 = 16;

/// Evaluates 1 − e^{−a}(1 + a) and a − 2 + e^{−a}(2 + a) for a > 0 without cancellation.
fn remainders(a: f64) -> (f64, f64) {
    if a >= SERIES_BELOW {
        let decay = (-a).exp();
        return (1.0 - decay * (1.0 + a), a - 2.0 + decay * (2.0 + a));
    }
    // Σ (−1)^k (k − 1) a^k/k! and Σ (−1)^{k+1} (k − 2) a^k/k! from k = 2, smallest terms last
    let (mut second, mut third) = (0.0, 0.0);
    let mut power = -a;
    for k in 2..2 + SERIES_TERMS {
        power *= -a / f64::from(k);
        second += power * f64::from(k - 1);
        third -= power * f64::from(k - 2);
    }
    (second, third)
}

#[cfg(test)]
mod tests {
    use approx::{assert_abs_diff_eq, assert_relative_eq};
    use nalgebra::{Matrix2, Matrix4, Vector2};

    use super::*;

    /// Rounding of a Padé matrix exponential of norm up to some hundreds.
    const EXPONENTIAL: f64 = 1e-12;

    // Φ, Γ0, Γ1 by Van Loan's augmented exponential: state (u, v, f, slope of f)
    fn by_matrix_exponential(alpha: f64, ratio: f64) -> (Matrix2<f64>, Vector2<f64>, Vector2<f64>) {
        let mut generator = Matrix4::zeros();
        generator[(0, 1)] = ratio;
        generator[(1, 0)] = -0.25 * alpha * alpha * ratio;
        generator[(1, 1)] = -alpha * ratio;
        generator[(1, 2)] = ratio;
        generator[(2, 3)] = 1.0;
        let map = generator.exp();
        (
            map.fixed_view::<2, 2>(0, 0).into_owned(),
            map.fixed_view::<2, 1>(0, 2).into_owned(),
            map.fixed_view::<2, 1>(0, 3).into_owned(),
        )
    }

    #[test]
    fn the_closed_form_equals_the_matrix_exponential() {
        for alpha in [4.0, 25.0, 100.0] {
            for ratio in [1e-5, 1e-3, 5e-3, 0.0399, 0.041, 0.3] {
                let step = Attractor::new(alpha).propagator(ratio);
                let (transition, constant, ramp) = by_matrix_exponential(alpha, ratio);
                for row in 0..2 {
                    for column in 0..2 {
                        assert_abs_diff_eq!(
                            step.transition[row][column],
                            transition[(row, column)],
                            epsilon = EXPONENTIAL * alpha * alpha
                        );
                    }
                    assert_relative_eq!(step.constant[row], constant[row], max_relative = EXPONENTIAL * 1e3);
                    assert_relative_eq!(step.ramp[row], ramp[row], max_relative = EXPONENTIAL * 1e3);
                }
            }
        }
    }

    #[test]
    fn the_closed_form_agrees_with_the_reference_program() {
        let file: serde_json::Value = serde_json::from_str(include_str!("../../../tests/data/dmp.json")).unwrap();
        let number = |value: &serde_json::Value| value.as_f64().unwrap();
        let step = Attractor::new(25.0).propagator(0.01 / 2.0);
        for row in 0..2 {
            for column in 0..2 {
                let expected = number(&file["Phi"][row][column]);
                assert_relative_eq!(step.transition[row][column], expected, max_relative = 1e-12);
            }
            assert_relative_eq!(step.constant[row], number(&file["G0"][row]), max_relative = 1e-12);
            // the reference does not sum the series: its difference cancels to one part in 1e10
            assert_relative_eq!(step.ramp[row], number(&file["G1"][row]), max_relative = 1e-9);
        }
    }

    #[test]
    fn series_and_closed_form_of_the_remainders_meet() {
        let below = remainders(SERIES_BELOW * (1.0 - 1e-15));
        let above = remainders(SERIES_BELOW);
        assert_relative_eq!(below.0, above.0, max_relative = 1e-13);
        assert_relative_eq!(below.1, above.1, max_relative = 1e-13);
    }

    #[test]
    fn a_constant_forcing_term_moves_the_rest_to_its_quotient_by_the_stiffness() {
        let attractor = Attractor::new(25.0);
        let step = attractor.propagator(0.01);
        let rest = 7.0 / 156.25;
        let (u, v) = step.step(rest, 0.0, 7.0, 7.0);
        assert_abs_diff_eq!(u, rest, epsilon = 1e-16);
        assert_abs_diff_eq!(v, 0.0, epsilon = 1e-15);
        assert_abs_diff_eq!(attractor.acceleration(rest, 0.0, 7.0), 0.0, epsilon = 1e-14);
    }

    #[test]
    fn one_long_step_without_forcing_equals_many_short_ones() {
        let attractor = Attractor::new(25.0);
        let (mut u, mut v) = (1.0, 0.0);
        let short = attractor.propagator(0.01);
        for _ in 0..100 {
            (u, v) = short.step(u, v, 0.0, 0.0);
        }
        let (u_long, v_long) = attractor.propagator(1.0).step(1.0, 0.0, 0.0, 0.0);
        assert_relative_eq!(u, u_long, max_relative = 1e-12);
        assert_relative_eq!(v, v_long, max_relative = 1e-12);
        // (1 + α/2)e^{−α/2}, the part of the distance left at T
        assert_relative_eq!(u_long, 13.5 * (-12.5f64).exp(), max_relative = 1e-12);
    }

    #[test]
    fn the_forcing_target_inverts_the_dynamics() {
        let attractor = Attractor::new(25.0);
        let forcing = attractor.forcing_target(0.3, -0.2, 1.7);
        assert_relative_eq!(attractor.acceleration(0.3, -0.2, forcing), 1.7, max_relative = 1e-12);
    }
}
