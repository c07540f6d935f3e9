//! The clock of a rollout stretched: as slow as limits of velocity and acceleration ask for, along the same path.
//!
//! The paper bounds positions only. A primitive rolled out over k times the duration from rest goes the same path with 1/k
//! of the velocities and 1/k² of the accelerations, so that limits on both cost one rollout and one factor.

use nalgebra::{DMatrix, DVector};

use super::Rollout;
use crate::error::SkillError;
use crate::trajectory::Trajectory;

/// Greatest velocities and accelerations, d values each, as of an arm's joints; infinity where there is no limit.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionLimits {
    /// Greatest |ẋ_k| (> 0), unit of the motion per second.
    pub velocity: DVector<f64>,
    /// Greatest |ẍ_k| (> 0), unit of the motion per second squared.
    pub acceleration: DVector<f64>,
}

impl MotionLimits {
    fn validate(&self, dimension: usize) -> Result<(), SkillError> {
        for (argument, limits) in [("limits.velocity", &self.velocity), ("limits.acceleration", &self.acceleration)] {
            if limits.len() != dimension {
                return Err(SkillError::Dimension { operation: OPERATION, found: limits.len(), expected: dimension });
            }
            if let Some(found) = limits.iter().find(|limit| limit.is_nan() || **limit <= 0.0) {
                return Err(refused(argument, *found, "positive numbers, or infinity for no limit"));
            }
        }
        Ok(())
    }
}

impl Rollout {
    /// Finds the least factor k by which time must be stretched so that every sample keeps the limits:
    /// k = max(max |ẋ|/ẋ_max, √(max |ẍ|/ẍ_max)) over samples and coordinates.
    ///
    /// Above 1 the motion is too fast, below 1 it may be faster; 0 is that of a motion at rest. Either stretch the samples
    /// by [`Rollout::stretched`], or roll the primitive out anew with k times the duration, which goes the same path if it
    /// starts at rest. Between samples nothing is checked.
    ///
    /// # Errors
    /// If the limits have another dimension, or one is not positive.
    pub fn least_stretch(&self, limits: &MotionLimits) -> Result<f64, SkillError> {
        limits.validate(self.positions().dimension())?;
        let velocity = largest_share(self.velocities(), &limits.velocity);
        let acceleration = largest_share(self.accelerations(), &limits.acceleration);
        Ok(velocity.max(acceleration.sqrt()))
    }

    /// Stretches the clock by `factor` k (slower above 1) about the first sample: the same positions at times k apart,
    /// velocities divided by k and accelerations by k².
    ///
    /// A motion that starts or ends in motion does so with 1/k of its velocity: where another one joins, stretch both.
    ///
    /// # Errors
    /// If the factor is not a positive finite number, or so far from 1 that times vanish in rounding or a number overflows.
    pub fn stretched(&self, factor: f64) -> Result<Self, SkillError> {
        if !(factor > 0.0 && factor.is_finite()) {
            return Err(refused("factor", factor, "a positive finite number"));
        }
        let begin_s = self.positions().start_time_s();
        let times_s = self.positions().times_s().iter().map(|time_s| begin_s + (time_s - begin_s) * factor).collect();
        let positions = Trajectory::new(times_s, self.positions().samples().clone())?;
        Self::new(positions, self.velocities() / factor, self.accelerations() / factor / factor)
    }
}

// the greatest part of its limit that a number of the table takes
fn largest_share(table: &DMatrix<f64>, limits: &DVector<f64>) -> f64 {
    let columns = table.column_iter().zip(limits.iter());
    columns.map(|(column, limit)| column.amax() / limit).fold(0.0, f64::max)
}

const OPERATION: &str = "stretch motion";

fn refused(argument: &'static str, found: f64, expected: &'static str) -> SkillError {
    SkillError::InvalidArgument { operation: OPERATION, argument, found, expected }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::{DMatrix, dvector};
    use proptest::prelude::*;

    use super::*;
    use crate::primitive::{Dmp, DmpConfig, Kernelized, KernelizedConfig, MovementPrimitive, RolloutRequest};
    use crate::time_law::minimum_jerk;

    /// A few roundings.
    const ROUNDING: f64 = 1e-12;
    /// A primitive of a straight way has a forcing term that its regression fits to zero within this share of peaks.
    const STRAIGHT: f64 = 1e-5;

    fn unlimited(dimension: usize) -> DVector<f64> {
        DVector::repeat(dimension, f64::INFINITY)
    }

    fn shown(swing: f64) -> Trajectory {
        let samples = DMatrix::from_fn(401, 2, |row, k| {
            let r = row as f64 / 400.0;
            minimum_jerk(r) * (1.0 + k as f64) + swing * (r * (1.0 - r)).powi(3) * (9.0 * r + k as f64).sin()
        });
        Trajectory::uniform(0.005, samples).unwrap()
    }

    fn request() -> RolloutRequest {
        RolloutRequest::new(dvector![0.0, 0.0], dvector![1.0, 2.0], 2.0, 1e-3)
    }

    // x = d·mj(t/T): |ẋ| ≤ 15d/8T at T/2, |ẍ| ≤ 10d/(√3·T²) at T(3 ± √3)/6
    #[test]
    fn a_straight_way_needs_the_factor_of_the_minimum_jerk_law() {
        let straight = Dmp::learn(&DmpConfig::default(), &[shown(0.0)]).unwrap().rollout(&request()).unwrap();
        let (distance, duration_s) = (2.0, 2.0_f64);
        let (peak, limit) = (1.875 * distance / duration_s, 0.7);
        let limits = MotionLimits { velocity: dvector![9.0, limit], acceleration: unlimited(2) };
        assert_relative_eq!(straight.least_stretch(&limits).unwrap(), peak / limit, max_relative = STRAIGHT);
        let peak = 10.0 * distance / (3f64.sqrt() * duration_s * duration_s);
        let limits = MotionLimits { velocity: unlimited(2), acceleration: dvector![99.0, limit] };
        assert_relative_eq!(straight.least_stretch(&limits).unwrap(), (peak / limit).sqrt(), max_relative = STRAIGHT);
    }

    #[test]
    fn a_primitive_rolled_out_over_the_stretched_duration_is_the_stretched_rollout() {
        let dmp = Dmp::learn(&DmpConfig::default(), &[shown(2.0)]).unwrap();
        let kernelized = Kernelized::learn(&KernelizedConfig::default(), &[shown(2.0)]).unwrap();
        for primitive in [&dmp as &dyn MovementPrimitive, &kernelized] {
            let factor = 1.7;
            let stretched = primitive.rollout(&request()).unwrap().stretched(factor).unwrap();
            let (duration_s, time_step_s) = (2.0 * factor, 1e-3 * factor);
            let slow = primitive.rollout(&RolloutRequest { duration_s, time_step_s, ..request() }).unwrap();
            for (found, expected) in [
                (stretched.positions().samples(), slow.positions().samples()),
                (stretched.velocities(), slow.velocities()),
                (stretched.accelerations(), slow.accelerations()),
            ] {
                // the attractor's stiffness of 156 magnifies rounding
                assert_relative_eq!(found, expected, epsilon = 1e4 * ROUNDING);
            }
        }
    }

    #[test]
    fn limits_that_are_none_and_factors_that_are_none_are_refused_by_name() {
        let motion = Dmp::learn(&DmpConfig::default(), &[shown(1.0)]).unwrap().rollout(&request()).unwrap();
        let named = |found: Result<f64, SkillError>| match found {
            Err(SkillError::InvalidArgument { argument, .. }) => argument,
            other => panic!("{other:?}"),
        };
        let limits = |velocity: f64, acceleration: f64| MotionLimits {
            velocity: dvector![1.0, velocity],
            acceleration: dvector![1.0, acceleration],
        };
        assert_eq!(named(motion.least_stretch(&limits(0.0, 1.0))), "limits.velocity");
        assert_eq!(named(motion.least_stretch(&limits(1.0, f64::NAN))), "limits.acceleration");
        let three = MotionLimits { velocity: unlimited(3), acceleration: unlimited(2) };
        assert!(matches!(motion.least_stretch(&three), Err(SkillError::Dimension { found: 3, expected: 2, .. })));
        assert_eq!(motion.least_stretch(&MotionLimits { velocity: unlimited(2), acceleration: unlimited(2) }), Ok(0.0));
        for factor in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(named(motion.stretched(factor).map(|_| 0.0)), "factor");
        }
        // squares that overflow, times that vanish
        assert!(motion.stretched(1e-200).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn the_stretched_motion_keeps_every_limit_and_touches_one(
            swing in 0.0f64..30.0, limits in prop::array::uniform4(0.05f64..20.0),
        ) {
            let motion = Dmp::learn(&DmpConfig::default(), &[shown(swing)]).unwrap().rollout(&request()).unwrap();
            let [vx, vy, ax, ay] = limits;
            let limits = MotionLimits { velocity: dvector![vx, vy], acceleration: dvector![ax, ay] };
            let stretched = motion.stretched(motion.least_stretch(&limits).unwrap()).unwrap();
            let share = |table: &DMatrix<f64>, k: usize, limit: f64| table.column(k).amax() / limit;
            let (velocities, accelerations) = (stretched.velocities(), stretched.accelerations());
            let shares = [share(velocities, 0, vx), share(velocities, 1, vy), share(accelerations, 0, ax),
                share(accelerations, 1, ay)];
            let largest = shares.into_iter().fold(0.0, f64::max);
            prop_assert!((largest - 1.0).abs() < ROUNDING, "{:?}", shares);
            prop_assert_eq!(stretched.positions().samples(), motion.positions().samples());
        }
    }
}
