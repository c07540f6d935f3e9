//! Friction that keeps an edge from sliding sideways over the food on which it presses.

/// Coulomb friction across the edge with an elastic start: the dent gives way sideways before the edge slides.
///
/// The elastic start lets a light food rest under the edge in steps of any length, which friction by speed alone would not.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EdgeGrip {
    stretch_m: f64,
}

/// What limits a grip in one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct GripLimits {
    /// Stiffness of the dent sideways, N/m.
    pub stiffness_n_per_m: f64,
    /// Friction, N.
    pub friction_n: f64,
    /// Mass of what is held, kg: bounds stiffness and damping to what a step bears.
    pub mass_kg: f64,
}

/// Share of the critical damping of the held mass.
const DAMPING_RATIO: f64 = 0.5;
/// Share of the largest stiffness that a step of semi-implicit integration bears.
const STIFFNESS_SHARE: f64 = 0.25;

impl EdgeGrip {
    /// Lets go.
    pub fn release(&mut self) {
        self.stretch_m = 0.0;
    }

    /// Force on the knife along the blade's normal, N, when it moves sideways over the food at `speed` (m/s) for `dt` (s).
    pub fn hold(&mut self, speed: f64, limits: &GripLimits, dt: f64) -> f64 {
        let stiffness = limits.stiffness_n_per_m.min(STIFFNESS_SHARE * limits.mass_kg / (dt * dt));
        if stiffness <= 0.0 {
            return 0.0;
        }
        let damping = 2.0 * DAMPING_RATIO * (stiffness * limits.mass_kg).sqrt();
        self.stretch_m += speed * dt;
        let most = limits.friction_n / stiffness;
        self.stretch_m = self.stretch_m.clamp(-most, most);
        -(stiffness * self.stretch_m + damping * speed).clamp(-limits.friction_n, limits.friction_n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f64 = 0.001;

    fn slide(force_n: f64, mass_kg: f64, steps: usize) -> (f64, f64) {
        let limits = GripLimits { stiffness_n_per_m: 1e4, friction_n: 1.0, mass_kg };
        let (mut grip, mut speed, mut way) = (EdgeGrip::default(), 0.0, 0.0);
        for _ in 0..steps {
            // what moves here is the knife, so that the force on it opposes its motion
            speed += (force_n + grip.hold(speed, &limits, DT_S)) / mass_kg * DT_S;
            way += speed * DT_S;
        }
        (speed, way)
    }

    #[test]
    fn below_friction_the_edge_rests_where_its_dent_holds_it() {
        for mass in [0.01, 0.1, 1.0] {
            // a load that sets in at once swings to less than twice itself: half the friction
            let (speed, way) = slide(0.5, mass, 3000);
            assert!(speed.abs() < 1e-9, "{mass}: {speed}");
            let stiffness = 1e4_f64.min(STIFFNESS_SHARE * mass / (DT_S * DT_S));
            assert!((way - 0.5 / stiffness).abs() < 1e-9, "{mass}: {way}");
        }
    }

    #[test]
    fn beyond_friction_it_slides_with_what_is_left() {
        let (speed, _) = slide(1.5, 0.1, 1000);
        // 0.5 N on 0.1 kg for a second, but for the elastic start of some milliseconds
        assert!((speed - 5.0).abs() < 0.05, "{speed}");
    }
}
