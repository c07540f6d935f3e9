//! Motions that arrive exactly: what a rolled-out primitive leaves at its end is taken up on the way there.

use nalgebra::{Isometry2, Point2, Rotation2, Vector3};

use crate::plan::{PlanarMotion, Track};
use crate::time_law::{MinimumJerkTransfer, PathState};

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
    fn a_motion_without_duration_is_at_its_goal() {
        assert_eq!(closed(&moving(1), &Vector3::x()), vec![PlanarMotion::at_rest(Vector3::x())]);
    }
}
