//! Motions that arrive exactly: what a rolled-out primitive leaves at its end is taken up on the way there.

use nalgebra::{Isometry2, Point2, Rotation2, Vector2, Vector3};

use crate::plan::{PlanarMotion, Track};
use crate::time_law::{
    MinimumJerkTransfer, PathState, minimum_jerk, minimum_jerk_first_derivative, minimum_jerk_second_derivative,
};

/// What is left at the end of a motion is taken up over this last share of it.
const CLOSING_SHARE: f64 = 0.3;

/// Motions of `track`, the last share of them bent so that they end at `goal` with zero velocity and acceleration.
pub(super) fn closed(track: &Track, goal: &Vector3<f64>) -> Vec<PlanarMotion> {
    let end = track.end();
    let horizon_s = track.duration_s() * CLOSING_SHARE;
    if horizon_s <= 0.0 {
        return vec![PlanarMotion::at_rest(*goal)];
    }
    // run backwards, the correction is a transfer from what is left at the end to nothing
    let left = |axis: usize| PathState {
        position: goal[axis] - end.position[axis],
        first: end.velocity[axis],
        second: -end.acceleration[axis],
    };
    let corrections = [0, 1, 2].map(|axis| MinimumJerkTransfer::new(0.0, left(axis), 0.0, horizon_s));
    let rows = track.motions().len();
    let bent = track.motions().iter().enumerate().map(|(row, motion)| {
        let until_end_s = (rows - 1 - row) as f64 * track.time_step_s();
        let mut bent = *motion;
        for (axis, correction) in corrections.iter().enumerate() {
            let state = correction.at(until_end_s);
            bent.position[axis] += state.position;
            bent.velocity[axis] -= state.first;
            bent.acceleration[axis] += state.second;
        }
        bent
    });
    bent.collect()
}

/// A motion seen from a frame that is turned by `turn` and has its origin at `origin`, with an angle of its own.
pub(super) fn turned(
    motion: &PlanarMotion,
    turn: &Rotation2<f64>,
    origin: &Point2<f64>,
    angle_rad: f64,
) -> PlanarMotion {
    let at = Isometry2::new(origin.coords, turn.angle()) * motion.point();
    let free = |vector: &Vector3<f64>| (turn * vector.xy()).push(0.0);
    PlanarMotion {
        position: Vector3::new(at.x, at.y, angle_rad),
        velocity: free(&motion.velocity),
        acceleration: free(&motion.acceleration),
    }
}

/// A motion with all its lengths multiplied by `share`; angles stay.
pub(super) fn shrunk(motion: &PlanarMotion, share: f64) -> PlanarMotion {
    let shrink = Vector3::new(share, share, 1.0);
    PlanarMotion {
        position: motion.position.component_mul(&shrink),
        velocity: motion.velocity.component_mul(&shrink),
        acceleration: motion.acceleration.component_mul(&shrink),
    }
}

/// Share of the largest speed with which a motion may go back: what a fit to a motion that begins at rest swings by.
const BACKWARD_SHARE: f64 = 0.05;

/// Whether motions never go back along `way`.
pub(super) fn goes_on(motions: &[PlanarMotion], way: &Vector2<f64>) -> bool {
    let speeds = || motions.iter().map(|motion| motion.velocity.xy().dot(way));
    speeds().all(f64::is_finite)
        && speeds().fold(f64::INFINITY, f64::min) >= -BACKWARD_SHARE * speeds().fold(0.0, f64::max)
}

/// The motion at time over duration `ratio` from rest to rest along a straight line, of minimum jerk.
pub(crate) fn straight_on((from, to): &(Vector3<f64>, Vector3<f64>), ratio: f64, duration_s: f64) -> PlanarMotion {
    let way = to - from;
    PlanarMotion {
        position: from + way * minimum_jerk(ratio),
        velocity: way * (minimum_jerk_first_derivative(ratio) / duration_s),
        acceleration: way * (minimum_jerk_second_derivative(ratio) / (duration_s * duration_s)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// A few roundings of numbers of order one.
    const ROUNDING: f64 = 1e-12;
    const STEP_S: f64 = 0.01;

    /// Moves on at constant acceleration: arrives nowhere and at no rest.
    fn moving(rows: usize) -> Track {
        let motion = |row: usize| {
            let time = row as f64 * STEP_S;
            PlanarMotion {
                position: Vector3::new(time * time, -time, 0.0),
                velocity: Vector3::new(2.0 * time, -1.0, 0.0),
                acceleration: Vector3::new(2.0, 0.0, 0.0),
            }
        };
        Track::new(STEP_S, (0..rows).map(motion).collect()).unwrap()
    }

    #[test]
    fn a_closed_motion_ends_at_its_goal_at_rest_and_keeps_its_beginning() {
        let goal = Vector3::new(3.0, 4.0, 0.5);
        for rows in [2, 3, 11, 201] {
            let motions = closed(&moving(rows), &goal);
            assert_eq!(motions.len(), rows);
            assert_eq!(motions[0], moving(rows).start());
            let end = motions[rows - 1];
            assert_relative_eq!(end.position, goal, epsilon = ROUNDING);
            assert_eq!((end.velocity, end.acceleration), (Vector3::zeros(), Vector3::zeros()));
        }
    }

    #[test]
    fn a_closed_motion_has_the_velocity_and_acceleration_of_its_places() {
        let motions = closed(&moving(201), &Vector3::new(3.0, 4.0, 0.5));
        for three in motions.windows(3) {
            let slope = |of: fn(&PlanarMotion) -> Vector3<f64>| (of(&three[2]) - of(&three[0])) / (2.0 * STEP_S);
            // the jerk sets in at once, with 60·6/0.6³: h²/12 of it in the velocity, h/4 of it in the acceleration
            assert_relative_eq!(slope(|motion| motion.position), three[1].velocity, epsilon = 0.03);
            assert_relative_eq!(slope(|motion| motion.velocity), three[1].acceleration, epsilon = 5.0);
        }
    }

    #[test]
    fn a_motion_that_turns_back_is_told_from_one_that_hesitates() {
        let along = Vector2::new(3.0, 4.0);
        let with = |speeds: [f64; 3]| {
            let motion = |speed: f64| PlanarMotion { velocity: (along * speed).push(0.0), ..PlanarMotion::default() };
            goes_on(&speeds.map(motion), &along)
        };
        assert!(with([0.0, 1.0, 0.0]) && with([-0.04, 1.0, 0.0]));
        assert!(!with([-0.06, 1.0, 0.0]) && !with([0.0, f64::NAN, 0.0]));
    }

    #[test]
    fn a_motion_without_duration_is_at_its_goal() {
        assert_eq!(closed(&moving(1), &Vector3::x()), vec![PlanarMotion::at_rest(Vector3::x())]);
    }
}
