//! The smooth saturation S_{d,m} that keeps a place in the corridor off its bounds.

use crate::error::SkillError;
use crate::time_law::PathState;

/// Smooth saturation of a place p in the corridor: the identity on [m, 1 − m], C², with range (d, 1 − d):
/// S(p) = m − (m − d)·tanh((m − p)/(m − d)) for p < m, mirrored above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmoothSaturation {
    margin: f64,
    least: f64,
}

impl SmoothSaturation {
    /// Makes the saturation with margin m and least place d.
    ///
    /// # Errors
    /// If not 0 < d < m < ½.
    pub fn new(margin: f64, least: f64) -> Result<Self, SkillError> {
        let operation = "build saturation";
        if !(margin > 0.0 && margin < 0.5) {
            let (argument, expected) = ("margin", "a number above 0 and below 0.5");
            return Err(SkillError::InvalidArgument { operation, argument, found: margin, expected });
        }
        if !(least > 0.0 && least < margin) {
            let (argument, expected) = ("least", "a number above 0 and below the margin");
            return Err(SkillError::InvalidArgument { operation, argument, found: least, expected });
        }
        Ok(Self { margin, least })
    }

    /// Fits m and d = m/4 to the ends of a motion, so that it is left alone there: m is at most 9/10 of the distance of
    /// either place from its nearer bound. A place outside (0, 1) is not regarded. `margin` is in (0, ½).
    pub(super) fn fitted(margin: f64, ends: [f64; 2]) -> Self {
        let distances = ends.into_iter().map(|place| place.min(1.0 - place)).filter(|distance| *distance > 0.0);
        let margin = distances.fold(margin, |margin, distance| margin.min(0.9 * distance));
        Self { margin, least: 0.25 * margin }
    }

    /// Tells whether the saturation leaves `place` as it is.
    #[must_use]
    pub fn is_identity_at(&self, place: f64) -> bool {
        (self.margin..=1.0 - self.margin).contains(&place)
    }

    /// Saturates a place and its derivatives.
    #[must_use]
    pub fn apply(&self, place: PathState) -> PathState {
        if self.is_identity_at(place.position) {
            return place;
        }
        // above the middle in the mirrored coordinate 1 − p
        let below = place.position < 0.5;
        let (distance, sign) = if below { (place.position, 1.0) } else { (1.0 - place.position, -1.0) };
        let reach = self.margin - self.least;
        let bend = ((self.margin - distance) / reach).tanh();
        let slope = 1.0 - bend * bend;
        let curvature = sign * 2.0 * bend * slope / reach;
        let saturated = self.margin - reach * bend;
        PathState {
            position: if below { saturated } else { 1.0 - saturated },
            first: slope * place.first,
            second: slope * place.second + curvature * place.first * place.first,
        }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_saturation_without_room_is_refused() {
        assert!(SmoothSaturation::new(0.5, 0.1).is_err());
        assert!(SmoothSaturation::new(0.3, 0.3).is_err());
        assert!(SmoothSaturation::new(0.3, 0.0).is_err());
        assert!(SmoothSaturation::new(f64::NAN, 0.1).is_err());
    }

    #[test]
    fn a_fitted_saturation_leaves_the_ends_alone() {
        let fitted = SmoothSaturation::fitted(0.3, [0.1, 0.8]);
        assert_eq!(fitted, SmoothSaturation::new(0.9 * 0.1, 0.25 * (0.9 * 0.1)).unwrap());
        assert_eq!(SmoothSaturation::fitted(0.3, [0.5, 1.2]), SmoothSaturation::new(0.3, 0.075).unwrap());
    }

    proptest! {
        #[test]
        fn derivatives_are_those_of_a_motion_through_the_saturation(
            position in -1.0..2.0f64, first in -1.0..1.0f64, second in -1.0..1.0f64,
        ) {
            let saturation = SmoothSaturation::new(0.3, 0.075).unwrap();
            let step = 1e-4;
            let at = |t: f64| saturation.apply(PathState {
                position: position + t * (first + 0.5 * t * second),
                first: first + t * second,
                second,
            });
            let found = at(0.0);
            // error of the central differences: derivatives of third order are below 100, and S is C² only at m
            assert_relative_eq!(found.first, (at(step).position - at(-step).position) / (2.0 * step), epsilon = 1e-5);
            assert_relative_eq!(found.second, (at(step).first - at(-step).first) / (2.0 * step), epsilon = 1e-2);
            prop_assert!(found.position >= 0.075 && found.position <= 0.925);
        }
    }
}
