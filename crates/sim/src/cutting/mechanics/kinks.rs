//! Reversals and stops of a blade in the food: each leaves a kink in the cut surface.

/// A blade stands below this speed, m/s.
const STANDING_M_PER_S: f64 = 0.0005;
/// A stop counts from this duration, s.
const STOP_S: f64 = 0.050;

/// Counts kinks while a blade is in the food.
#[derive(Clone, Debug, Default)]
pub(super) struct Kinks {
    count: u32,
    standing_s: f64,
    /// Sign of the last motion along the cutting direction; zero outside the food.
    direction: f64,
}

impl Kinks {
    /// Notes the speed along the cutting direction over one step.
    pub(super) fn note(&mut self, inside: bool, speed_m_per_s: f64, dt: f64) {
        if !inside {
            (self.standing_s, self.direction) = (0.0, 0.0);
            return;
        }
        if speed_m_per_s.abs() < STANDING_M_PER_S {
            let before = self.standing_s;
            self.standing_s += dt;
            // a blade that has not moved in the food yet has not stopped in it
            if self.direction != 0.0 && before <= STOP_S && self.standing_s > STOP_S {
                self.count += 1;
            }
            return;
        }
        let direction = speed_m_per_s.signum();
        // withdrawing ends a stroke; cutting on after it is the kink, unless the stop before it has counted already
        if self.direction < 0.0 && direction > 0.0 && self.standing_s <= STOP_S {
            self.count += 1;
        }
        (self.standing_s, self.direction) = (0.0, direction);
    }

    /// Kinks so far.
    pub(super) fn count(&self) -> u32 {
        self.count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinks(strokes: &[(bool, f64, u32)]) -> u32 {
        let mut kinks = Kinks::default();
        for &(inside, speed, steps) in strokes {
            for _ in 0..steps {
                kinks.note(inside, speed, 0.001);
            }
        }
        kinks.count()
    }

    #[test]
    fn one_stroke_leaves_none() {
        assert_eq!(kinks(&[(false, 0.02, 100), (true, 0.02, 1000), (true, -0.02, 500), (false, -0.02, 100)]), 0);
    }

    #[test]
    fn cutting_on_after_a_retreat_leaves_one_and_a_long_stop_another() {
        assert_eq!(kinks(&[(true, 0.02, 100), (true, -0.02, 50), (true, 0.02, 100)]), 1);
        assert_eq!(kinks(&[(true, 0.02, 100), (true, 0.0, 49), (true, 0.02, 100)]), 0);
        assert_eq!(kinks(&[(true, 0.02, 100), (true, 0.0, 300), (true, 0.02, 100)]), 1);
        assert_eq!(kinks(&[(true, 0.02, 100), (true, -0.02, 20), (true, 0.0, 300), (true, 0.02, 100)]), 1);
    }
}
