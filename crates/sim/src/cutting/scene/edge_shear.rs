//! The edge zone of a food gives way along the edge, too: what a light food feels of a knife that slides along itself.
//!
//! Slicing resists like a damper that is the harder the slower the edge sinks: R w/v for a push at speed v, a kilonewton by
//! meter per second. Held directly against a slice of some grams, it would throw the slice to and fro in every step. In series
//! with the elasticity of the edge zone (the same as that of the dent) the force of steady motion is the law's, and a light
//! food is carried along instead.

/// The speed at which the edge slides over the end of the crack, while the food between gives way (Maxwell's element).
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeShear {
    speed: f64,
    /// Force of the law by that speed, N s/m; none before the first sliding.
    damping: Option<f64>,
}

/// Slowest answer, s: the damping is read off the law's force, of which a part along the edge may not come from sliding.
/// A food on which the damping would be above 50 ms times what the step bears (10 g at 500 N s/m) is moved jerkily.
const LONGEST_S: f64 = 0.05;
/// Share of the largest stiffness that a step of semi-implicit integration bears.
const STIFFNESS_SHARE: f64 = 0.25;
/// Slower speeds tell nothing of the damping, m/s.
const SLOWEST_M_PER_S: f64 = 1e-7;

impl EdgeShear {
    /// An edge that does not slide yet.
    pub fn at_rest() -> Self {
        Self { speed: 0.0, damping: None }
    }

    /// Speed of sliding when the knife moves along its edge at `speed` (m/s) over a food of `mass_kg` whose edge zone has
    /// `stiffness` (N/m); zero where the edge does not press, and the flanks alone hold the blade.
    pub fn follow(&mut self, speed: f64, stiffness: f64, mass_kg: f64, dt: f64) -> f64 {
        let stiffness = stiffness.min(STIFFNESS_SHARE * mass_kg / (dt * dt));
        let answer_s = match self.damping {
            Some(damping) if stiffness > 0.0 => (damping / stiffness).min(LONGEST_S),
            _ => LONGEST_S,
        };
        self.speed += (speed - self.speed) * dt / (answer_s + dt);
        self.speed
    }

    /// Notes the force of the law at the speed of sliding, N.
    pub fn note(&mut self, force: f64) {
        if self.speed.abs() > SLOWEST_M_PER_S {
            self.damping = Some(force.abs() / self.speed.abs());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.001;
    const STIFFNESS: f64 = 1e4;

    /// A food of `mass` before a knife that slides at 20 mm/s, with the law's force `damping` times speed; `held` says whether
    /// the board holds it. Returns the forces.
    fn forces(mass: f64, damping: f64, held: bool) -> Vec<f64> {
        let (mut shear, mut food) = (EdgeShear::at_rest(), 0.0);
        let step = |_| {
            let force = damping * shear.follow(0.02 - food, STIFFNESS, mass, DT_S);
            shear.note(force);
            food += if held { 0.0 } else { force / mass * DT_S };
            force
        };
        (0..2000).map(step).collect()
    }

    #[test]
    fn a_held_food_feels_the_force_of_the_law() {
        for mass in [0.01, 0.1, 1.0] {
            let force = forces(mass, 500.0, true);
            assert!((force[1999] - 10.0).abs() < 1e-9, "{mass}: {}", force[1999]);
        }
    }

    #[test]
    fn a_free_food_is_carried_along_without_chatter() {
        for (mass, damping) in [(0.01, 300.0), (0.06, 1500.0), (0.5, 1500.0)] {
            let force = forces(mass, damping, false);
            let carried: f64 = force.iter().sum::<f64>() * DT_S;
            assert!((carried - 0.02 * mass).abs() < 1e-3 * 0.02 * mass, "{mass}: {carried}");
            let greatest = force.iter().copied().fold(0.0, f64::max);
            // a spring as hard as the step bears stops the relative motion within some steps
            assert!(greatest <= mass * 0.02 / DT_S, "{mass}: {greatest}");
            assert!(force.iter().all(|force| *force > -greatest), "{mass}: reversed harder than pushed");
        }
    }
}
