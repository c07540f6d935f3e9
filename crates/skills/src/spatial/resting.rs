//! A sampled motion brought to rest exactly at its start and goal.

use crate::corridor::quintic;
use crate::error::SkillError;
use crate::primitive::{Rollout, RolloutRequest};
use crate::time_law::PathState;
use crate::trajectory::Trajectory;

/// Part of the time at each end over which what misses there is taken out.
const WINDOW: f64 = 0.25;

/// Differentiates a motion, and makes it begin at the requested start and end at the goal, at rest at both: what place and
/// velocity miss there is taken out by a quintic over the quarter of the time next to it.
///
/// Accelerations at the ends are set to zero only: that of a difference at an end is too rough to be carried on.
///
/// # Errors
/// If a derivative overflows.
pub(crate) fn resting(motion: &Trajectory, request: &RolloutRequest) -> Result<Rollout, SkillError> {
    let mut samples = motion.samples().clone();
    let (mut velocities, mut accelerations) = (motion.first_derivative(), motion.second_derivative());
    let last = samples.nrows() - 1;
    let (duration_s, window_s) = (request.duration_s, WINDOW * request.duration_s);
    for k in 0..samples.ncols() {
        let miss = |row: usize, wanted: f64| PathState {
            position: samples[(row, k)] - wanted,
            first: velocities[(row, k)],
            second: 0.0,
        };
        let (from, to) = (miss(0, request.start[k]), miss(last, request.goal[k]));
        for (row, time_s) in motion.times_s().iter().enumerate() {
            let left_s = duration_s - time_s;
            let error = if *time_s < window_s {
                quintic(from, PathState::default(), window_s, time_s / window_s)
            } else if left_s < window_s {
                quintic(PathState::default(), to, window_s, 1.0 - left_s / window_s)
            } else {
                continue;
            };
            samples[(row, k)] -= error.position;
            velocities[(row, k)] -= error.first;
            accelerations[(row, k)] -= error.second;
        }
        // rounding is not left to the joints
        for (row, wanted) in [(0, request.start[k]), (last, request.goal[k])] {
            (samples[(row, k)], velocities[(row, k)], accelerations[(row, k)]) = (wanted, 0.0, 0.0);
        }
    }
    Rollout::new(Trajectory::new(motion.times_s().to_vec(), samples)?, velocities, accelerations)
}
