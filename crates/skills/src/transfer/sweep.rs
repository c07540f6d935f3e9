//! Certified clearance of a track, between its motions too.
//!
//! A distance changes by no more than the points of the tool move, so that of two looks with distances a and b and a way ℓ
//! between them nothing comes nearer than (a + b − ℓ)/2. Looks are far apart where there is room.

use nalgebra::Isometry2;

use crate::plan::{PlanarMotion, Track};

/// Where a track comes too near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Near {
    /// Time of the track, s.
    pub(super) time_s: f64,
    /// Lower bound of the distance there, m.
    pub(super) clearance_m: f64,
}

/// The first place at which `clearance_m` is not certified to stay at `least_m` or more along a track, if there is one.
///
/// `lever_m` is the greatest distance of a point of the body from its origin.
pub(super) fn first_near(
    track: &Track,
    lever_m: f64,
    least_m: f64,
    clearance_m: impl Fn(&Isometry2<f64>) -> f64,
) -> Option<Near> {
    let motions = track.motions();
    let at = |row: usize| motions.get(row).map(|motion| clearance_m(&motion.pose()));
    let near = |row: usize, clearance_m: f64| Near { time_s: row as f64 * track.time_step_s(), clearance_m };
    let (mut row, mut here_m) = (0, at(0)?);
    if here_m < least_m || here_m.is_nan() {
        return Some(near(row, here_m));
    }
    while row + 1 < motions.len() {
        let (mut next, mut way_m) = (row, 0.0);
        for pair in motions.get(row..).unwrap_or_default().windows(2) {
            let step_m = step_m(pair, lever_m, track.time_step_s());
            // at least one step; more of them while they cannot lead out of what is free here
            if next > row && way_m + step_m > here_m - least_m {
                break;
            }
            (next, way_m) = (next + 1, way_m + step_m);
        }
        let there_m = at(next)?;
        let bound_m =
            if way_m <= here_m - least_m { there_m } else { 0.5 * (here_m + there_m - way_m).min(2.0 * there_m) };
        if bound_m < least_m || bound_m.is_nan() {
            return Some(near(next, bound_m));
        }
        (row, here_m) = (next, there_m);
    }
    None
}

/// Upper bound of the way of any point between two motions, m: the chord, and what a bounded acceleration bends it by.
fn step_m(pair: &[PlanarMotion], lever_m: f64, step_s: f64) -> f64 {
    let [from, to] = pair else { return f64::INFINITY };
    let length = |of: fn(&PlanarMotion) -> nalgebra::Vector3<f64>| {
        let of_both = [from, to].map(|motion| of(motion).xy().norm() + lever_m * of(motion).z.abs());
        of_both[0].max(of_both[1])
    };
    let chord = to.position - from.position;
    // |v − v̄| ≤ a·h/2 on the step, in the mean half of that
    chord.xy().norm() + lever_m * chord.z.abs() + 0.25 * length(|motion| motion.acceleration) * step_s * step_s
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::*;

    const STEP_S: f64 = 0.01;

    /// Along x at 1 m/s, 1 cm from motion to motion.
    fn line(rows: usize) -> Track {
        let motion = |row: usize| PlanarMotion {
            position: Vector3::new(row as f64 * STEP_S, 0.0, 0.0),
            velocity: Vector3::x(),
            acceleration: Vector3::zeros(),
        };
        Track::new(STEP_S, (0..rows).map(motion).collect()).unwrap()
    }

    #[test]
    fn a_point_between_two_motions_is_noticed() {
        // a pole of no size at 0.505 m, between two motions and 1 mm aside
        let clearance = |pose: &Isometry2<f64>| (pose.translation.x - 0.505).hypot(0.001);
        assert!(first_near(&line(101), 0.0, 0.002, clearance).is_some());
        let near = first_near(&line(101), 0.0, 0.0008, clearance).unwrap();
        assert!((near.time_s - 0.51).abs() < 1e-9 && near.clearance_m < 0.0008);
        // from 5 mm on either side the bound is hypot(5, 1) − 5 = 0.099 mm
        assert!(first_near(&line(101), 0.0, 0.00009, clearance).is_none());
    }

    #[test]
    fn a_track_that_begins_too_near_or_nowhere_is_told_at_its_beginning() {
        let near = first_near(&line(3), 0.0, 0.1, |_| 0.05).unwrap();
        assert_eq!((near.time_s, near.clearance_m), (0.0, 0.05));
        assert!(first_near(&line(3), 0.0, 0.1, |_| f64::NAN).is_some());
        assert!(first_near(&line(1), 0.0, 0.1, |_| 0.1).is_none());
    }

    proptest! {
        #[test]
        fn what_is_certified_holds_at_every_look_however_fine(
            x in 0.0f64..1.0, y in -0.05f64..0.05, least in 0.0f64..0.05,
        ) {
            let clearance = |pose: &Isometry2<f64>| (pose.translation.x - x).hypot(pose.translation.y - y);
            let track = line(101);
            let truth = (0..=10_000).map(|look| clearance(&track.at(f64::from(look) * 1e-4).pose()));
            let truth = truth.fold(f64::INFINITY, f64::min);
            if first_near(&track, 0.0, least, clearance).is_none() {
                prop_assert!(truth >= least - 1e-12, "{truth} {least}");
            }
            // and it is not much more careful than the step asks for
            if truth > least + STEP_S {
                prop_assert_eq!(first_near(&track, 0.0, least, clearance), None);
            }
        }
    }
}
