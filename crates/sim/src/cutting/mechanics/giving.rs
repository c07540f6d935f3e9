//! How a free food gives way along the edge: Maxwell elements between the knife and the end of the crack.
//!
//! Slicing resists like a damper that is the harder the slower the edge sinks, R w/v for a push at speed v: kilonewtons by meter
//! per second. Held directly against a food of some grams, it would throw it to and fro in every step. In series with the
//! elasticity of the food the force of steady motion is the law's, and a light food is carried along instead. There is no time
//! constant to choose: the dampers are the law's, the springs those of the food.

/// Share of the critical damping of the food's mass: moist foods are lossy.
const DAMPING_RATIO: f64 = 0.5;
/// Share of the largest stiffness that a step of semi-implicit integration bears.
const STIFFNESS_SHARE: f64 = 0.25;

/// Spring and loss of all elements of one kind together; each has its share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elasticity {
    pub(super) stiffness: f64,
    pub(super) loss: f64,
    pub(super) dt: f64,
}

impl Elasticity {
    /// A food of `mass_kg` that gives way by `stiffness` (N/m), or as far as a step of `dt` bears.
    pub(super) fn new(stiffness: f64, mass_kg: f64, dt: f64) -> Self {
        let stiffness = stiffness.min(STIFFNESS_SHARE * mass_kg / (dt * dt));
        Self { stiffness, loss: 2.0 * DAMPING_RATIO * (stiffness * mass_kg).sqrt(), dt }
    }

    /// Damping that a step sees of a damper of `damping` (N s/m) behind this `share` of the elasticity, N s/m: the two in
    /// series, and so less than the food's mass bears however hard the damper is.
    pub(super) fn damping_in_series(&self, damping: f64, share: f64) -> f64 {
        let own = (self.stiffness * self.dt + self.loss) * share;
        if own > 0.0 { damping * own / (damping + own) } else { 0.0 }
    }
}

/// One spring, with the law's damper behind it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Giving {
    stretch_m: f64,
    /// Energy in the spring, J.
    stored_j: f64,
}

impl Giving {
    /// Speed of sliding when the knife moves at `speed` (m/s) over an element that has this `share` of the elasticity: the
    /// speed at which a damper of `damping` (N s/m) takes the spring's force.
    pub(super) fn follow(&mut self, speed: f64, damping: f64, share: f64, elasticity: &Elasticity) -> f64 {
        if damping <= 0.0 || share <= 0.0 {
            *self = Self::default();
            return speed;
        }
        let Elasticity { dt, .. } = *elasticity;
        let (stiffness, loss) = (elasticity.stiffness * share, elasticity.loss * share);
        let force = stiffness * (self.stretch_m + speed * dt) + loss * speed;
        let sliding = force / (damping + stiffness * dt + loss);
        self.stretch_m += (speed - sliding) * dt;
        self.stored_j = 0.5 * stiffness * self.stretch_m * self.stretch_m;
        sliding
    }

    /// Energy in the spring, J.
    pub(super) fn stored_j(&self) -> f64 {
        self.stored_j
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.001;

    /// A food of `mass` before a knife that slides at 20 mm/s, with the law's force `damping` times speed; `held` says whether
    /// the board holds it. Returns the forces.
    fn forces(mass: f64, damping: f64, held: bool) -> Vec<f64> {
        let (mut giving, mut food) = (Giving::default(), 0.0);
        let elasticity = Elasticity::new(1e4, mass, DT_S);
        let step = |_| {
            let force = damping * giving.follow(0.02 - food, damping, 1.0, &elasticity);
            food += if held { 0.0 } else { force / mass * DT_S };
            force
        };
        (0..20_000).map(step).collect()
    }

    #[test]
    fn a_held_food_feels_the_force_of_the_law() {
        for mass in [0.01, 0.1, 1.0] {
            let force = forces(mass, 500.0, true);
            assert!((force[19_999] - 10.0).abs() < 1e-6, "{mass}: {}", force[19_999]);
        }
    }

    #[test]
    fn a_free_food_is_carried_along_without_chatter_however_light_and_tough() {
        for (mass, damping) in [(0.001, 3000.0), (0.007, 1800.0), (0.01, 300.0), (0.06, 1500.0), (0.5, 1500.0)] {
            let force = forces(mass, damping, false);
            let carried: f64 = force.iter().sum::<f64>() * DT_S;
            assert!((carried - 0.02 * mass).abs() < 1e-3 * 0.02 * mass, "{mass}: {carried}");
            let greatest = force.iter().copied().fold(0.0, f64::max);
            // a spring as hard as the step bears stops the relative motion within some steps
            assert!(greatest <= mass * 0.02 / DT_S, "{mass}: {greatest}");
            // with half the critical damping a swing back has 16 % of the swing before
            assert!(force.iter().all(|force| *force > -0.2 * greatest), "{mass}: thrown back");
        }
    }

    #[test]
    fn a_food_that_nothing_rubs_is_slid_over_at_once() {
        let mut giving = Giving::default();
        assert_eq!(giving.follow(0.02, 0.0, 1.0, &Elasticity::new(1e4, 0.1, DT_S)), 0.02);
    }
}
