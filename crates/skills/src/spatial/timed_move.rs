//! Moves of a stated duration from rest to rest, and rests.

use nalgebra::Isometry3;

use super::motion::SpatialMotion;
use super::refusal::SpatialError;
use super::track::{SpatialKnot, SpatialTrack};
use crate::field::positive;

/// Moves from rest at one pose to rest at another within `duration_s`, minimum jerk in place and in turn about one axis; the
/// tool turns by 3 rad at most.
///
/// # Errors
/// [`SpatialError`] if the duration is not above zero, a pose is not finite, or the turn is larger.
pub fn timed_move(from: &Isometry3<f64>, to: &Isometry3<f64>, duration_s: f64) -> Result<SpatialTrack, SpatialError> {
    positive("duration_s", duration_s)?;
    let knot = |time_s: f64, pose: &Isometry3<f64>| SpatialKnot { time_s, motion: SpatialMotion::at_rest(*pose) };
    // the quintic between two rests is the movement of minimum jerk
    SpatialTrack::new(vec![knot(0.0, from), knot(duration_s, to)])
}

/// Rests at a pose for `duration_s`.
///
/// # Errors
/// As [`timed_move`].
pub fn rest(pose: &Isometry3<f64>, duration_s: f64) -> Result<SpatialTrack, SpatialError> {
    timed_move(pose, pose, duration_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_law::minimum_jerk;
    use nalgebra::Vector3;

    /// Rounding of a quintic evaluated in another form.
    const ROUNDING: f64 = 1e-12;

    #[test]
    fn a_timed_move_is_minimum_jerk_in_place_and_turn() {
        let to = Isometry3::new(Vector3::new(0.3, -0.1, 0.2), Vector3::new(0.0, 1.2, 0.0));
        let track = timed_move(&Isometry3::identity(), &to, 2.0).unwrap();
        for step in 0..=20 {
            let time_s = 0.1 * f64::from(step);
            let share = minimum_jerk(time_s / 2.0);
            let motion = track.at(time_s);
            assert!((motion.pose.translation.vector - to.translation.vector * share).norm() < ROUNDING);
            assert!((motion.pose.rotation.scaled_axis() - Vector3::new(0.0, 1.2 * share, 0.0)).norm() < ROUNDING);
        }
    }

    #[test]
    fn a_rest_stays_and_a_move_without_time_is_refused() {
        let pose = Isometry3::translation(0.1, 0.2, 0.3);
        assert_eq!(rest(&pose, 1.0).unwrap().at(0.4), SpatialMotion::at_rest(pose));
        assert!(timed_move(&pose, &pose, 0.0).is_err());
    }
}
