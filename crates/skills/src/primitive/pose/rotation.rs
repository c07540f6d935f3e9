//! Rotation vectors: their branches, and the angular velocity and acceleration of e^ρ.

use std::f64::consts::TAU;

use nalgebra::{UnitQuaternion, Vector3};

/// Angle below which the coefficients are summed as series, rad.
const SERIES_BELOW_RAD: f64 = 0.3;
/// Terms of the series; the next one is below 0.3^16/18! of the first.
const SERIES_TERMS: u32 = 8;

/// Returns the rotation vector of `rotation`, rad, that lies nearest to `near`, rad, of all that differ by whole turns
/// about its axis.
pub(super) fn nearest_branch(rotation: &UnitQuaternion<f64>, near: &Vector3<f64>) -> Vector3<f64> {
    let shortest = rotation.scaled_axis();
    let angle = shortest.norm();
    if angle <= f64::EPSILON {
        // every axis is one of the identity
        let turns = (near.norm() / TAU).round();
        return if turns == 0.0 { shortest } else { near.normalize() * (TAU * turns) + shortest };
    }
    let axis = shortest / angle;
    shortest + axis * (TAU * ((near.dot(&axis) - angle) / TAU).round())
}

/// Angular velocity ω of e^ρ and its derivative for a rotation vector ρ, rad, that moves with ρ̇ and ρ̈ (per unit of time
/// or progress): ω = J(ρ)ρ̇ with J = I + a[ρ] + b[ρ]², a = (1 − cos φ)/φ², b = (φ − sin φ)/φ³, φ = |ρ|; in the frame that e^ρ
/// leads into.
pub(crate) fn angular_motion(
    rho: &Vector3<f64>,
    rate: &Vector3<f64>,
    second: &Vector3<f64>,
) -> (Vector3<f64>, Vector3<f64>) {
    let Coefficients { a, b, a_rate, b_rate } = coefficients(rho.norm());
    let jacobian = |x: &Vector3<f64>| {
        let once = rho.cross(x);
        x + once * a + rho.cross(&once) * b
    };
    let growth = rho.dot(rate);
    let across = rho.cross(rate);
    let turning = across * (a_rate * growth) + rho.cross(&across) * (b_rate * growth) + rate.cross(&across) * b;
    (jacobian(rate), jacobian(second) + turning)
}

struct Coefficients {
    a: f64,
    b: f64,
    /// (da/dφ)/φ.
    a_rate: f64,
    /// (db/dφ)/φ.
    b_rate: f64,
}

fn coefficients(angle: f64) -> Coefficients {
    let square = angle * angle;
    if angle >= SERIES_BELOW_RAD {
        let (sin, cos) = angle.sin_cos();
        return Coefficients {
            a: (1.0 - cos) / square,
            b: (angle - sin) / (square * angle),
            a_rate: (angle * sin - 2.0 * (1.0 - cos)) / (square * square),
            b_rate: (3.0 * sin - angle * cos - 2.0 * angle) / (square * square * angle),
        };
    }
    // a = Σ (−φ²)^k/(2k + 2)!, b = Σ (−φ²)^k/(2k + 3)!, and their derivatives over φ
    let mut sum = Coefficients { a: 0.5, b: 1.0 / 6.0, a_rate: 0.0, b_rate: 0.0 };
    let (mut even, mut odd) = (0.5, 1.0 / 6.0);
    let mut power = 1.0;
    for k in 1..=SERIES_TERMS {
        let twice = f64::from(2 * k);
        even /= -(twice + 1.0) * (twice + 2.0);
        odd /= -(twice + 2.0) * (twice + 3.0);
        sum.a_rate += twice * even * power;
        sum.b_rate += twice * odd * power;
        power *= square;
        sum.a += even * power;
        sum.b += odd * power;
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn series_and_closed_form_meet() {
        let (below, above) = (coefficients(SERIES_BELOW_RAD * (1.0 - 1e-15)), coefficients(SERIES_BELOW_RAD));
        assert_relative_eq!(below.a, above.a, max_relative = 1e-13);
        assert_relative_eq!(below.b, above.b, max_relative = 1e-12);
        // the closed forms cancel four and five digits
        assert_relative_eq!(below.a_rate, above.a_rate, max_relative = 1e-11);
        assert_relative_eq!(below.b_rate, above.b_rate, max_relative = 1e-10);
    }

    #[test]
    fn the_nearest_branch_keeps_on_turning() {
        let turned = |angle: f64| UnitQuaternion::from_scaled_axis(Vector3::z() * angle);
        for (angle, near, expected) in [
            (0.2, 0.0, 0.2),
            (PI + 0.1, PI - 0.1, PI + 0.1),
            (-PI + 0.1, PI - 0.1, PI + 0.1),
            (-0.2, 6.0, TAU - 0.2),
            (0.0, 6.0, TAU),
            (0.3, -7.0, 0.3 - TAU),
        ] {
            let found = nearest_branch(&turned(angle), &(Vector3::z() * near));
            assert_relative_eq!(found, Vector3::z() * expected, epsilon = 1e-12);
        }
    }

    proptest! {
        #[test]
        fn angular_velocity_and_acceleration_are_those_of_the_rotation(
            rho in prop::array::uniform3(-3.0f64..3.0), rate in prop::array::uniform3(-2.0f64..2.0),
            second in prop::array::uniform3(-2.0f64..2.0), size in prop::sample::select(vec![1e-9, 1e-3, 0.08, 1.0]),
        ) {
            let (rho, rate, second) = (Vector3::from(rho) * size, Vector3::from(rate), Vector3::from(second));
            let at = |t: f64| (rho + rate * t + second * (0.5 * t * t), rate + second * t);
            let h = 1e-4;
            let turn = |t: f64| UnitQuaternion::from_scaled_axis(at(t).0);
            let by_difference = (turn(h) * turn(-h).inverse()).scaled_axis() / (2.0 * h);
            let omega = |t: f64| angular_motion(&at(t).0, &at(t).1, &second).0;
            let (velocity, acceleration) = angular_motion(&rho, &rate, &second);
            // central differences over 1e-4 of functions whose third derivatives are some hundred
            prop_assert!((velocity - by_difference).norm() < 1e-5);
            prop_assert!((acceleration - (omega(h) - omega(-h)) / (2.0 * h)).norm() < 1e-5);
        }
    }
}
