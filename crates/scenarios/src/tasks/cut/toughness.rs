//! How much tougher a food is than stated, found from how far the knife falls behind.

use nalgebra::Vector3;

/// How fast the estimate follows, N/(m s): a knife that is late by the force that is missing over the stiffness of the arm at
/// the knife, 3 to 10 kN/m, is caught up with in 0.06 to 0.2 s.
const CATCH_UP_N_PER_M_S: f64 = 5e4;
/// Expected forces that are small beside this tell little, N.
const TELLING_N: f64 = 2.0;

/// Force of the food over that which is expected of the stated toughness, found from how far the knife falls behind.
///
/// The knife falls behind its reference along the force that is missing, e = (θ − θ̂) F/k with k the stiffness of the arm:
/// dθ̂/dt = g e·F/(F² + F₀²) brings the estimate to the truth within k/g. Nothing is learned where no force is expected.
#[derive(Clone, Copy, Debug)]
pub(super) struct Toughness {
    /// That force over the stated one.
    pub factor: f64,
    /// That of the toughest food of its kind.
    most: f64,
    time_s: Option<f64>,
}

impl Toughness {
    /// As tough as stated, and at most `most` times so.
    pub fn stated(most: f64) -> Self {
        Self { factor: 1.0, most: most.max(1.0), time_s: None }
    }

    /// Takes in how far the tool is `behind` its reference (m, from the reference to the tool) where `expected` (N) is.
    pub fn learn(&mut self, time_s: f64, behind: &Vector3<f64>, expected: &Vector3<f64>) {
        let dt = self.time_s.replace(time_s).map_or(0.0, |before| time_s - before);
        let told = behind.dot(expected) / (expected.norm_squared() + TELLING_N * TELLING_N);
        self.factor = (self.factor + CATCH_UP_N_PER_M_S * told * dt).clamp(0.0, self.most);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 0.001;

    /// The factor after `seconds` of cutting a food with `truth` times the expected 10 N, with an arm of 5 kN/m.
    fn learned(truth: f64, seconds: f64) -> f64 {
        let (mut toughness, expected) = (Toughness::stated(4.0), Vector3::new(0.0, 0.0, 10.0));
        for step in 0..(seconds / STEP_S) as usize {
            let behind = expected * ((truth - toughness.factor) / 5e3);
            toughness.learn(step as f64 * STEP_S, &behind, &expected);
        }
        toughness.factor
    }

    #[test]
    fn the_toughness_is_found_in_some_tenths_of_a_second() {
        for truth in [0.4, 1.0, 3.0] {
            // e^(−10) of the error is left: 1 s over k/g = 0.1 s, 4 % slower for the forces that tell little
            assert!((learned(truth, 1.0) / truth - 1.0).abs() < 2e-3, "{truth}: {}", learned(truth, 1.0));
        }
    }

    #[test]
    fn no_food_is_taken_to_be_tougher_than_the_toughest_of_its_kind() {
        assert_eq!(learned(9.0, 5.0), 4.0);
    }

    #[test]
    fn a_board_that_holds_the_knife_up_teaches_nothing() {
        let mut toughness = Toughness::stated(4.0);
        for step in 0..1000 {
            toughness.learn(f64::from(step) * STEP_S, &Vector3::new(0.0, 0.0, 0.002), &Vector3::zeros());
        }
        assert_eq!(toughness.factor, 1.0);
    }
}
