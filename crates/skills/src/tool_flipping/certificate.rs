//! Certified clearance of a way: a lower bound that holds between the samples, by branch and bound.

use nalgebra::{Point2, Vector3};

use super::clearance::Bodies;
use super::way::Way;

/// Clearance that a flip is certified to keep, at every instant and not only at samples.
///
/// Between two instants i and j the clearance d is at least (d_i + d_j − l)/2 − b: d is 1-Lipschitz in the motion of the
/// object's points, l = ‖Δq‖ + ρ|Δφ| is the way between the instants along the chord, and b = max‖q̈‖Δr²/8 bounds how far
/// the way leaves the chord. Intervals are halved until the bound is as close to a sample as the contact tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlipCertificate {
    /// Lower bound of the clearance over the whole flip, m: about 0 if it starts or ends in contact.
    pub smallest_clearance_m: f64,
    /// Time over duration of the smallest sample.
    pub smallest_at_ratio: f64,
    /// Lower bound of the clearance from a quarter to three quarters of the duration, m, to a hundredth of a millimeter.
    pub middle_clearance_m: f64,
    /// Clearance at the first and the second contact, m.
    pub contact_clearances_m: [f64; 2],
    /// Distance ρ by which the object's points turn with it, m: 0 for a disc.
    pub lever_m: f64,
    /// Number of instants at which the clearance was computed.
    pub samples: usize,
}

/// Lowest value of clearance minus requirement over a part of a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lowest {
    /// No value is below this, m.
    pub(super) bound_m: f64,
    /// Lowest value that was computed, m.
    pub(super) sampled_m: f64,
    /// Where.
    pub(super) at_ratio: f64,
    pub(super) samples: usize,
}

/// An instant with the clearance there.
#[derive(Debug, Clone, Copy)]
struct Sample {
    ratio: f64,
    clearance_m: f64,
    position: Vector3<f64>,
    // ‖q̈‖ + ρ|φ̈|
    bend_m: f64,
}

/// Part of the duration below which an interval is not halved again.
const SHORTEST: f64 = 1e-9;

/// Distance within which the bound over the middle of a way is to meet the samples, m.
const MIDDLE_RESOLUTION_M: f64 = 1e-5;

/// Clearance of a way from the tool.
#[derive(Clone, Copy)]
pub(super) struct Checked<'a> {
    pub(super) bodies: &'a Bodies,
    pub(super) way: &'a Way,
    /// Distance within which bounds are to meet samples, m.
    pub(super) resolution_m: f64,
}

impl Checked<'_> {
    /// Bounds clearance minus `required` over the ratios from `from` to `to`, knots both.
    ///
    /// `required` gives the largest clearance required between two ratios, m. Bounds stay open, at −∞, if a sample falls
    /// below `give_up_m`.
    pub(super) fn lowest(
        &self,
        required: impl Fn(f64, f64) -> f64,
        (from, to): (usize, usize),
        give_up_m: f64,
    ) -> Lowest {
        let mut lowest = Lowest { bound_m: f64::INFINITY, sampled_m: f64::INFINITY, at_ratio: 0.0, samples: 0 };
        for knot in from..=to {
            let sample = self.sample(knot.min(to.saturating_sub(1)), Way::ratio(knot));
            lowest.note(&sample, &required);
        }
        let mut open = Vec::new();
        for piece in from..to {
            open.push((self.sample(piece, Way::ratio(piece)), self.sample(piece, Way::ratio(piece + 1))));
            while let Some((a, b)) = open.pop() {
                if lowest.sampled_m < give_up_m {
                    return Lowest { bound_m: f64::NEG_INFINITY, ..lowest };
                }
                let bound_m = self.between(&a, &b) - required(a.ratio, b.ratio);
                if bound_m >= lowest.sampled_m - self.resolution_m || b.ratio - a.ratio < SHORTEST {
                    lowest.bound_m = lowest.bound_m.min(bound_m);
                    continue;
                }
                let middle = self.sample(piece, 0.5 * (a.ratio + b.ratio));
                lowest.note(&middle, &required);
                open.extend([(middle, b), (a, middle)]);
            }
        }
        lowest
    }

    /// Certifies a way; `searched` samples were spent on finding it.
    pub(super) fn certificate(&self, searched: usize) -> FlipCertificate {
        let nothing = |_: f64, _: f64| 0.0;
        let whole = self.lowest(nothing, (0, Way::PIECES), f64::NEG_INFINITY);
        // along an offset curve every sample is nearly the smallest, which costs samples
        let coarser = Checked { resolution_m: self.resolution_m.max(MIDDLE_RESOLUTION_M), ..*self };
        let middle = coarser.lowest(nothing, (Way::PIECES / 4, Way::PIECES * 3 / 4), f64::NEG_INFINITY);
        let at = |ratio: f64| self.clearance_m(&self.way.at(ratio).position);
        FlipCertificate {
            smallest_clearance_m: whole.bound_m,
            smallest_at_ratio: whole.at_ratio,
            middle_clearance_m: middle.bound_m,
            contact_clearances_m: [at(0.0), at(1.0)],
            lever_m: self.bodies.lever_m(),
            samples: searched + whole.samples + middle.samples,
        }
    }

    /// Bound of the clearance between two instants of one piece.
    fn between(&self, a: &Sample, b: &Sample) -> f64 {
        let chord = b.position - a.position;
        let length_m = chord.xy().norm() + self.bodies.lever_m() * chord.z.abs();
        // the second derivative of a cubic is linear, its norm largest at an end
        let bulge_m = a.bend_m.max(b.bend_m) * (b.ratio - a.ratio).powi(2) / 8.0;
        0.5 * (a.clearance_m + b.clearance_m - length_m) - bulge_m
    }

    fn sample(&self, piece: usize, ratio: f64) -> Sample {
        let motion = self.way.on_piece(piece, ratio);
        let bend_m = motion.acceleration.xy().norm() + self.bodies.lever_m() * motion.acceleration.z.abs();
        Sample { ratio, clearance_m: self.clearance_m(&motion.position), position: motion.position, bend_m }
    }

    fn clearance_m(&self, position: &Vector3<f64>) -> f64 {
        self.bodies.gap(&Point2::from(position.xy()), position.z).distance_m
    }
}

impl Lowest {
    fn note(&mut self, sample: &Sample, required: &impl Fn(f64, f64) -> f64) {
        self.samples += 1;
        let value_m = sample.clearance_m - required(sample.ratio, sample.ratio);
        if value_m < self.sampled_m {
            (self.sampled_m, self.at_ratio) = (value_m, sample.ratio);
        }
    }
}
