//! Certified clearance of a moving body: a lower bound that holds between the samples, by branch and bound.

use nalgebra::Isometry3;

use super::track::SpatialTrack;

/// Span of time below which an interval is not halved again, s.
const SHORTEST_S: f64 = 1e-7;

/// Clearance that a moving body keeps, at every instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpatialClearance {
    /// No instant is closer than this, m.
    pub bound_m: f64,
    /// Smallest clearance that was computed, m.
    pub sampled_m: f64,
    /// Its time, s of the track.
    pub at_s: f64,
    /// Number of instants at which the clearance was computed.
    pub samples: usize,
}

/// Bounds from below the clearance of a body that follows `track`, to `resolution_m`.
///
/// `clearance` gives a lower bound of the distance, m, at a pose `world_from_tool` that is 1-Lipschitz in the motion of
/// the body's points, none of which is farther than `reach_m` from the tool's origin. Between two instants it is at least
/// (d_i + d_j − V·Δt)/2, V being a certified bound of the speed of the body's points there. Gives up where it falls below
/// `give_up_m`: the bound is −∞ then.
pub fn certified_clearance(
    track: &SpatialTrack,
    reach_m: f64,
    resolution_m: f64,
    give_up_m: f64,
    clearance: impl Fn(&Isometry3<f64>) -> f64,
) -> SpatialClearance {
    let mut found = SpatialClearance { bound_m: f64::INFINITY, sampled_m: f64::INFINITY, at_s: 0.0, samples: 0 };
    // the knots first: what is far from the smallest of them needs no halving
    let knots = track.knots().iter().map(|knot| (knot.time_s, found.note(track, knot.time_s, &clearance)));
    let knots: Vec<(f64, f64)> = knots.collect();
    let mut open: Vec<[(f64, f64); 2]> = Vec::new();
    for pair in knots.windows(2) {
        open.push([pair[0], pair[1]]);
        while let Some([from, to]) = open.pop() {
            if found.sampled_m < give_up_m {
                return SpatialClearance { bound_m: f64::NEG_INFINITY, ..found };
            }
            let bounds = track.bounds(from.0, to.0);
            let speed = bounds.speed_m_per_s + reach_m * bounds.angular_speed_rad_per_s;
            let bound_m = (0.5 * (from.1 + to.1 - speed * (to.0 - from.0))).min(from.1.min(to.1));
            if bound_m >= found.sampled_m - resolution_m || to.0 - from.0 < SHORTEST_S {
                found.bound_m = found.bound_m.min(bound_m);
                continue;
            }
            let time_s = 0.5 * (from.0 + to.0);
            let middle = (time_s, found.note(track, time_s, &clearance));
            open.extend([[middle, to], [from, middle]]);
        }
    }
    found
}

impl SpatialClearance {
    fn note(&mut self, track: &SpatialTrack, time_s: f64, clearance: &impl Fn(&Isometry3<f64>) -> f64) -> f64 {
        let at_m = clearance(&track.at(time_s).pose);
        self.samples += 1;
        // a clearance that is not a number is none
        let at_m = if at_m.is_nan() { f64::NEG_INFINITY } else { at_m };
        if at_m < self.sampled_m {
            (self.sampled_m, self.at_s) = (at_m, time_s);
        }
        at_m
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Vector3};

    use super::*;
    use crate::spatial::{FreeMoveConfig, free_move};

    #[test]
    fn a_pass_between_the_knots_is_seen() {
        // one leg of a meter past a point 0.1 m beside its middle
        let ends = [Isometry3::identity(), Isometry3::translation(1.0, 0.0, 0.0)];
        let track = free_move(&FreeMoveConfig::default(), &ends).unwrap();
        let beside = Vector3::new(0.5, 0.1, 0.0);
        let clearance = |pose: &Isometry3<f64>| (pose.translation.vector - beside).norm();
        let found = certified_clearance(&track, 0.0, 1e-4, 0.0, clearance);
        assert!(found.bound_m <= 0.1 && found.bound_m > 0.1 - 2e-4, "{found:?}");
        assert!(certified_clearance(&track, 0.0, 1e-4, 0.2, clearance).bound_m == f64::NEG_INFINITY);
    }
}
