//! The search for the smallest factor k2 of Eq. (28) with which the object stays clear of the tool.
//!
//! Departs from the paper, which takes k2 = 1 and advises to enlarge it: the clearance is Lipschitz in k2, so a scan that
//! steps by what is missing over that constant passes no factor that would do.

use nalgebra::{Point2, Vector2};

use super::certificate::Checked;
use super::clearance::Bodies;
use super::learning::OwnWay;
use super::options::{FlipOptions, SecondFactor};
use super::refusal::FlipError;
use super::virtual_motion::{Hold, VirtualMotion};
use super::way::{Knot, Way};
use crate::time_law::{minimum_jerk, minimum_jerk_first_derivative};

/// Part of a way over which the object may turn without haste.
const SHORTEST_TURN: f64 = 0.1;

/// The summands of Eq. (28) at the knots of a way.
pub(super) struct Parts {
    start: Point2<f64>,
    /// x0 + (q_B − q_A)·mj(r): the goal part of x^t, for k2 = 0.
    straight: Vec<(Vector2<f64>, Vector2<f64>)>,
    /// x^o − x0.
    object: Vec<(Vector2<f64>, Vector2<f64>)>,
    own: OwnWay,
    /// Angle of the object in the tool's frame, rad, and its slope.
    turned: Vec<(f64, f64)>,
}

impl Parts {
    pub(super) fn new(holds: &[Hold; 2], object: &VirtualMotion, own: OwnWay) -> Self {
        let [first, second] = holds;
        let (start, displacement) = (first.center, second.center - first.center);
        let [lift, land] = object.lifting;
        let turn_rad = second.angle_rad - first.angle_rad;
        // between the contacts only, for an edge that touches does not turn; over the whole way if that leaves no time
        let between = 1.0 - lift - land;
        let (turn_from, turn_over) = if between > SHORTEST_TURN { (lift, between) } else { (0.0, 1.0) };
        let knots = || (0..=Way::PIECES).map(|knot| progress(Way::ratio(knot)));
        Self {
            start,
            straight: knots().map(|(part, rate)| (displacement * part, displacement * rate)).collect(),
            object: knots()
                .map(|(part, rate)| {
                    let (place, slope) = object.at(part);
                    (place - start, slope * rate)
                })
                .collect(),
            own,
            turned: knots()
                .map(|(part, rate)| {
                    let within = (part - turn_from) / turn_over;
                    let slope = minimum_jerk_first_derivative(within) * rate / turn_over;
                    (first.angle_rad + turn_rad * minimum_jerk(within), turn_rad * slope)
                })
                .collect(),
        }
    }

    /// x^Tf of Eq. (28) with k1 = I.
    fn way(&self, k2: f64, share: f64) -> Way {
        Way::new(|knot| {
            let part = |parts: &[(Vector2<f64>, Vector2<f64>)]| parts.get(knot).copied().unwrap_or_default();
            let (straight, object, own) = (part(&self.straight), part(&self.object), part(&self.own.knots));
            let (angle_rad, spin) = self.turned.get(knot).copied().unwrap_or_default();
            let place = self.start.coords + straight.0 * (1.0 - k2) + object.0 * k2 + own.0 * share;
            let slope = straight.1 * (1.0 - k2) + object.1 * k2 + own.1 * share;
            Knot { position: place.push(angle_rad), slope: slope.push(spin) }
        })
    }

    /// max‖x^o − x0 − (q_B − q_A)·mj‖: how fast a place moves with k2, m.
    fn reach_m(&self) -> f64 {
        let bulges = self.object.iter().zip(&self.straight).map(|(object, straight)| (object.0 - straight.0).norm());
        bulges.fold(0.0, f64::max)
    }
}

fn progress(ratio: f64) -> (f64, f64) {
    (minimum_jerk(ratio), minimum_jerk_first_derivative(ratio))
}

/// The search for the smallest k2.
pub(super) struct Search<'a> {
    pub(super) bodies: &'a Bodies,
    pub(super) parts: &'a Parts,
    /// Part of the way on which the object leaves the first contact, and that on which it comes to the second.
    pub(super) lifting: [f64; 2],
    pub(super) options: &'a FlipOptions,
}

/// A certified way with the factor k2 and the part of the tool's own way that led to it.
pub(super) struct Found {
    pub(super) way: Way,
    pub(super) k2: f64,
    pub(super) share: f64,
}

/// Parts of the tool's own way tried in turn.
const SHARES: [f64; 4] = [1.0, 0.5, 0.25, 0.0];
/// Step of k2 where the clearance misses by too little to tell a larger one.
const SMALLEST_STEP: f64 = 1e-3;

impl Search<'_> {
    /// Finds a way and says how many clearances were computed.
    ///
    /// # Errors
    /// [`FlipError::Collides`] with the numbers of the virtual object movement alone.
    pub(super) fn run(&self) -> Result<(Found, usize), FlipError> {
        let mut samples = 0;
        // without a way of its own there is nothing to fade
        let shares = if self.parts.own.is_straight() { SHARES.get(3..) } else { SHARES.get(..) };
        for &share in shares.unwrap_or_default() {
            if let Some(found) = self.scan(share, &mut samples) {
                return Ok((found, samples));
            }
        }
        Err(self.refusal())
    }

    /// Enlarges k2 until the way is certified; what is skipped is too small by the Lipschitz bound of the clearance in k2.
    fn scan(&self, share: f64, samples: &mut usize) -> Option<Found> {
        let (mut k2, largest) = match self.options.k2 {
            SecondFactor::Smallest => (0.0, self.options.largest_k2),
            SecondFactor::Fixed(k2) => (k2, k2),
        };
        let tolerance_m = self.options.contact_tolerance_m;
        let reach_m = self.parts.reach_m();
        while k2 <= largest {
            let way = self.parts.way(k2, share);
            let lowest =
                self.checked(&way).lowest(|from, to| self.required_m(from, to), (0, Way::PIECES), -0.5 * tolerance_m);
            *samples += lowest.samples;
            if lowest.bound_m >= -tolerance_m {
                return Some(Found { way, k2, share });
            }
            k2 += (-lowest.sampled_m / reach_m).max(SMALLEST_STEP);
        }
        None
    }

    fn refusal(&self) -> FlipError {
        let k2 = match self.options.k2 {
            SecondFactor::Smallest => 1.0,
            SecondFactor::Fixed(k2) => k2,
        };
        let way = self.parts.way(k2, 0.0);
        let required = |from, to| self.required_m(from, to);
        let lowest = self.checked(&way).lowest(required, (0, Way::PIECES), f64::NEG_INFINITY);
        let tolerance_m = -self.options.contact_tolerance_m;
        FlipError::Collides { k2, clearance_m: lowest.bound_m, at_ratio: lowest.at_ratio, tolerance_m }
    }

    fn checked<'b>(&'b self, way: &'b Way) -> Checked<'b> {
        Checked { bodies: self.bodies, way, resolution_m: 0.5 * self.options.contact_tolerance_m }
    }

    /// The largest clearance required between two ratios of the duration, m.
    fn required_m(&self, from: f64, to: f64) -> f64 {
        let [lift, land] = self.lifting;
        let risen = |part: f64, over: f64| if over > 0.0 { (part / over).min(1.0) } else { 1.0 };
        let (left, coming) = (risen(minimum_jerk(to), lift), risen(1.0 - minimum_jerk(from), land));
        self.options.least_clearance_m * left.min(coming)
    }
}
