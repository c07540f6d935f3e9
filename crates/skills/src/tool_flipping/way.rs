//! A way of the object in the tool's frame over time over duration, continuous in place and velocity.

use nalgebra::Vector3;

use crate::plan::PlanarMotion;

/// Place (x, y in m, angle in rad) and its derivative by time over duration at a knot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Knot {
    pub(super) position: Vector3<f64>,
    pub(super) slope: Vector3<f64>,
}

/// Cubic pieces through knots at equal intervals of time over duration.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Way {
    knots: Vec<Knot>,
}

impl Way {
    /// Pieces of a way.
    pub(super) const PIECES: usize = 400;

    /// Builds a way from what is to be at time over duration at each of its knots.
    pub(super) fn new(knot: impl Fn(usize) -> Knot) -> Self {
        Self { knots: (0..=Self::PIECES).map(knot).collect() }
    }

    /// Time over duration of a knot.
    pub(super) fn ratio(knot: usize) -> f64 {
        knot as f64 / Self::PIECES as f64
    }

    /// Evaluates place and derivatives by time over duration at `ratio`, held outside [0, 1].
    pub(super) fn at(&self, ratio: f64) -> PlanarMotion {
        let piece = ((ratio.clamp(0.0, 1.0) * Self::PIECES as f64) as usize).min(Self::PIECES - 1);
        self.on_piece(piece, ratio.clamp(0.0, 1.0))
    }

    /// Evaluates the cubic of a piece, so that at a knot the second derivative is the one towards that piece.
    pub(super) fn on_piece(&self, piece: usize, ratio: f64) -> PlanarMotion {
        let (Some(from), Some(to)) = (self.knots.get(piece), self.knots.get(piece + 1)) else {
            return PlanarMotion::default();
        };
        let h = 1.0 / Self::PIECES as f64;
        let u = (ratio - Self::ratio(piece)) / h;
        let rise = to.position - from.position;
        let (into, out) = (from.slope * h, to.slope * h);
        PlanarMotion {
            position: from.position + rise * (u * u * (3.0 - 2.0 * u)) + into * (u * (1.0 - u) * (1.0 - u))
                - out * (u * u * (1.0 - u)),
            velocity: (rise * (6.0 * u * (1.0 - u))
                + into * ((1.0 - u) * (1.0 - 3.0 * u))
                + out * (u * (3.0 * u - 2.0)))
                / h,
            acceleration: (rise * (6.0 - 12.0 * u) + into * (6.0 * u - 4.0) + out * (6.0 * u - 2.0)) / (h * h),
        }
    }
}
