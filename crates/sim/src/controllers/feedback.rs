//! What a controller makes of small errors at rest: M ë = −D ė − K e, seen at the joints, at the tool, and by a loop that
//! runs at sampled instants.

use nalgebra::{DMatrix, DVector, Matrix3, Matrix6xX};
use robot::{FrameId, RobotError, Workspace};

use super::gains::{listed, significant};

/// Share of a step's error below which it counts as settled.
const SETTLED: f64 = 0.02;
/// Errors that take longer than this do not settle within a run, s.
const LONGEST_SETTLING_S: f64 = 60.0;
/// Compliance below which the tool does not give way, m/N: far stiffer than any arm.
const RIGID_M_PER_N: f64 = 1e-12;
/// Squarings of a transition whose growth is sought: after 2⁴⁸ periods the start no longer tells.
const SQUARINGS: usize = 48;
/// Halvings of an interval of periods: a relative accuracy of a millionth.
const HALVINGS: usize = 20;

/// The linear closed loop of an arm and its controller about rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Feedback {
    /// M(q), n × n, kg m².
    pub mass: DMatrix<f64>,
    /// K: torque per position error of each joint, N m/rad (N/m).
    pub stiffness: DVector<f64>,
    /// D: torque per velocity error, n × n, N m s/rad (N s/m).
    pub damping: DMatrix<f64>,
}

impl Feedback {
    /// Factor by which errors grow from one control period of `period_s` to the next: the spectral radius of the loop with
    /// torques held over the period. Stable below 1; infinite if the mass matrix is singular or a number not finite.
    #[must_use]
    pub fn growth_per_period(&self, period_s: f64) -> f64 {
        self.transition(period_s).map_or(f64::INFINITY, spectral_radius)
    }

    /// Longest control period, s, for which the loop is stable, found below `period_s` where it is not. Zero if there is none:
    /// the loop is unstable in continuous time.
    #[must_use]
    pub fn longest_stable_period_s(&self, period_s: f64) -> f64 {
        let (mut stable, mut unstable) = (0.0, period_s);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (stable + unstable);
            if self.growth_per_period(middle) < 1.0 {
                stable = middle;
            } else {
                unstable = middle;
            }
        }
        stable
    }

    /// Time, s, after which the errors of a step in all joints stay below 2 % of it; `None` if they do not.
    #[must_use]
    pub fn settling_s(&self, period_s: f64) -> Option<f64> {
        if self.growth_per_period(period_s) >= 1.0 {
            return None;
        }
        let (transition, joints) = (self.transition(period_s)?, self.stiffness.len());
        let mut state = DVector::from_fn(2 * joints, |row, _| if row < joints { 1.0 } else { 0.0 });
        let mut next = state.clone();
        let (mut settled, periods) = (0, (LONGEST_SETTLING_S / period_s).ceil() as usize);
        for period in 1..=periods {
            next.gemv(1.0, &transition, &state, 0.0);
            std::mem::swap(&mut state, &mut next);
            if state.rows(0, joints).amax() > SETTLED {
                settled = period;
            }
        }
        (settled < periods).then_some((settled + 1) as f64 * period_s)
    }

    /// Index of the joint whose velocity errors are fed back fastest: the first to go unstable.
    #[must_use]
    pub fn fastest_joint(&self) -> usize {
        let rates = self.mass.clone().try_inverse().map(|inverse| (inverse * &self.damping).diagonal().abs());
        rates.map_or(0, |rates| rates.imax())
    }

    /// Compliance J K⁻¹ Jᵀ of a point, m/N, from the Jacobian of a frame there (base axes): how far it gives way to a force.
    #[must_use]
    pub fn point_compliance(&self, jacobian: &Matrix6xX<f64>) -> Matrix3<f64> {
        let mut compliance = Matrix3::zeros();
        for (column, stiffness) in jacobian.column_iter().zip(self.stiffness.iter()) {
            let linear = column.fixed_rows::<3>(0);
            compliance += linear * linear.transpose() / *stiffness;
        }
        compliance
    }

    /// Step from one control instant to the next, (e, ė dt) → (e, ė dt), with the acceleration held in between. Times dt, so
    /// that both halves are of one size however short the period is.
    fn transition(&self, period_s: f64) -> Option<DMatrix<f64>> {
        let joints = self.stiffness.len();
        let inverse = self.mass.clone().try_inverse()?;
        let by_position = &inverse * DMatrix::from_diagonal(&self.stiffness);
        let by_velocity = inverse * &self.damping;
        let mut step = DMatrix::identity(2 * joints, 2 * joints);
        for row in 0..joints {
            step[(row, joints + row)] = 1.0;
        }
        for (offset, part, factor) in [(0, &by_position, period_s * period_s), (joints, &by_velocity, period_s)] {
            for (row, column) in (0..joints).flat_map(|row| (0..joints).map(move |column| (row, column))) {
                let change = factor * part[(row, column)];
                step[(row, offset + column)] -= 0.5 * change;
                step[(joints + row, offset + column)] -= change;
            }
        }
        step.iter().all(|value| value.is_finite()).then_some(step)
    }
}

/// Largest absolute eigenvalue, as lim ‖Aᴺ‖^(1/N) (Gelfand) along N = 2, 4, 8, …: unlike an iteration for the eigenvalues
/// themselves it always ends, also where many of them are equal or almost one. Infinite if a number is not finite.
fn spectral_radius(matrix: DMatrix<f64>) -> f64 {
    let (mut power, mut logarithm, mut weight) = (matrix, 0.0, 1.0);
    for _ in 0..=SQUARINGS {
        let size = power.norm();
        if size == 0.0 {
            return 0.0;
        }
        if !size.is_finite() {
            return f64::INFINITY;
        }
        logarithm += weight * size.ln();
        weight *= 0.5;
        power /= size;
        power = &power * &power;
    }
    logarithm.exp()
}

/// Stiffness of the origin of `frame` under the feedback at posture `q`: force per displacement, N/m, along the base's x, y, z
/// when nothing else pushes; infinite where the arm cannot give way.
///
/// # Errors
/// [`RobotError::WrongLength`].
pub fn tip_stiffness_n_per_m(
    feedback: &Feedback,
    workspace: &mut Workspace,
    q: &DVector<f64>,
    frame: FrameId,
) -> Result<[f64; 3], RobotError> {
    workspace.set_positions(q)?;
    let mut jacobian = Matrix6xX::zeros(q.len());
    workspace.jacobian_into(frame, &mut jacobian);
    let compliance = feedback.point_compliance(&jacobian);
    let stiffness = |axis: usize| {
        let gives_way = compliance[(axis, axis)];
        if gives_way.abs() < RIGID_M_PER_N { f64::INFINITY } else { gives_way.recip() }
    };
    Ok([0, 1, 2].map(stiffness))
}

/// Sentences on a feedback: stiffness at joints and tool, settling, how near the sampled loop is to instability.
pub(super) fn sentences(name: &str, feedback: &Feedback, tip_n_per_m: [f64; 3], period_s: f64) -> Vec<String> {
    let tip = tip_n_per_m.map(|value| if value.is_finite() { significant(value) } else { "rigid".into() }).join(" / ");
    let settling = feedback.settling_s(period_s).map_or_else(
        || format!("{name}: errors do not settle within {LONGEST_SETTLING_S} s"),
        |time_s| format!("{name}: errors settle to 2 % in {time_s:.2} s"),
    );
    let growth = feedback.growth_per_period(period_s);
    vec![
        format!("{name}: joint stiffness {} N m/rad", listed(&feedback.stiffness)),
        format!("{name}: stiffness at the tool {tip} N/m along the base's x / y / z at the start"),
        settling,
        format!(
            "{name}: sampled every {period_s} s, errors change by a factor of {growth:.4} per period at the start (stable below 1)"
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One joint of inertia 0.1 kg m² under stiffness and damping.
    fn one(stiffness: f64, damping: f64) -> Feedback {
        Feedback {
            mass: DMatrix::from_element(1, 1, 0.1),
            stiffness: DVector::from_element(1, stiffness),
            damping: DMatrix::from_element(1, 1, damping),
        }
    }

    #[test]
    fn held_damping_is_stable_up_to_two_periods_per_time_constant() {
        // Jury's criterion for a double integrator under held PD: D dt/m < 2 for small stiffness
        for (damping, stable) in [(199.0, true), (201.0, false)] {
            assert_eq!(one(1e-3, damping).growth_per_period(1e-3) < 1.0, stable, "damping {damping}");
        }
        let longest = one(1e-3, 400.0).longest_stable_period_s(1e-3);
        assert!((longest - 0.5e-3).abs() < 1e-8, "{longest}");
    }

    #[test]
    fn the_spectral_radius_is_that_of_known_eigenvalues() {
        // a rotation by 0.3 rad scaled by 0.9, beside a shear with a double eigenvalue of 0.5
        let (sine, cosine) = 0.3_f64.sin_cos();
        let mut matrix = DMatrix::zeros(4, 4);
        matrix.view_mut((0, 0), (2, 2)).copy_from_slice(&[0.9 * cosine, 0.9 * sine, -0.9 * sine, 0.9 * cosine]);
        matrix.view_mut((2, 2), (2, 2)).copy_from_slice(&[0.5, 0.0, 7.0, 0.5]);
        assert!((spectral_radius(matrix) - 0.9).abs() < 1e-12);
        assert_eq!(spectral_radius(DMatrix::zeros(2, 2)), 0.0);
        assert_eq!(spectral_radius(DMatrix::from_element(2, 2, f64::MAX)), f64::INFINITY);
    }

    #[test]
    fn a_short_period_is_not_taken_for_instability() {
        // sampled finely, the slow root of m s² + D s + K decides: exp(−dt (D − √(D² − 4 m K)) / 2 m)
        let feedback = one(30.0, 10.3);
        let slow = (10.3 - (10.3_f64 * 10.3 - 4.0 * 0.1 * 30.0).sqrt()) / 0.2;
        for period_s in [1e-4, 1e-5, 1e-6] {
            let growth = feedback.growth_per_period(period_s);
            assert!(growth < 1.0 && ((1.0 - growth) / (slow * period_s) - 1.0).abs() < 1e-2, "{period_s}: {growth}");
        }
    }

    #[test]
    fn sixty_equal_joints_are_as_stable_as_one() {
        let (single, joints) = (one(30.0, 10.3), 60);
        let many = Feedback {
            mass: DMatrix::from_diagonal_element(joints, joints, 0.1),
            stiffness: DVector::from_element(joints, 30.0),
            damping: DMatrix::from_diagonal_element(joints, joints, 10.3),
        };
        assert!((many.growth_per_period(1e-3) - single.growth_per_period(1e-3)).abs() < 1e-12);
    }

    #[test]
    fn negative_stiffness_has_no_stable_period() {
        assert_eq!(one(-1.0, 1.0).longest_stable_period_s(1e-3), 0.0);
        assert_eq!(one(-1.0, 1.0).settling_s(1e-3), None);
    }

    #[test]
    fn an_overdamped_error_settles_with_its_slow_time_constant() {
        // m ë + (m k + ξ) ė + k ξ e = 0 has roots −k and −ξ/m; from rest e = (ξ/m e^{−kt} − k e^{−ξt/m})/(ξ/m − k)
        let (rate, fast) = (3.0, 100.0);
        let settled = one(rate * fast * 0.1, (rate + fast) * 0.1).settling_s(1e-4).expect("stable");
        let expected = (50.0_f64 * fast / (fast - rate)).ln() / rate;
        assert!((settled - expected).abs() < 2e-3, "{settled} {expected}");
    }

    #[test]
    fn a_tool_at_the_end_of_a_lever_is_as_stiff_as_its_joint_over_the_length_squared() {
        let mut jacobian = Matrix6xX::zeros(1);
        jacobian[(1, 0)] = 0.5;
        let compliance = one(30.0, 1.0).point_compliance(&jacobian);
        assert!((compliance[(1, 1)].recip() - 120.0).abs() < 1e-12);
        assert_eq!(compliance[(0, 0)], 0.0);
    }
}
