//! Whether a round food rolls away under a knife: two contacts, each with friction.

/// Largest distance of the knife's plane from the axis of a round food at which it stays, m: r sin(2 atan μ).
///
/// Knife and board press on the food at two points. Without weight the two forces lie on the line through both, which leans
/// by φ/2 from either normal, sin φ = offset/r: both contacts hold while φ/2 lies within their cones of friction.
#[must_use]
pub fn roll_limit_offset_m(radius_m: f64, knife_friction: f64, board_friction: f64) -> f64 {
    radius_m * (2.0 * knife_friction.min(board_friction).atan()).min(std::f64::consts::FRAC_PI_2).sin()
}

/// Whether a round food of `radius_m` rolls away under a knife `offset_m` beside its axis.
#[must_use]
pub fn rolls(offset_m: f64, radius_m: f64, knife_friction: f64, board_friction: f64) -> bool {
    offset_m.abs() > roll_limit_offset_m(radius_m, knife_friction, board_friction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// Half a unit of the last digit of the values worked by hand.
    const DIGIT_M: f64 = 0.5e-5;

    #[test]
    fn a_round_food_stays_within_the_cones_of_both_contacts() {
        for (friction, offset) in [(0.1, 0.00198), (0.2, 0.00385), (0.3, 0.00550)] {
            assert_abs_diff_eq!(roll_limit_offset_m(0.01, friction, friction), offset, epsilon = DIGIT_M);
            assert_abs_diff_eq!(roll_limit_offset_m(0.01, 0.9, friction), offset, epsilon = DIGIT_M);
        }
        assert!(rolls(-0.0039, 0.01, 0.2, 0.4) && !rolls(0.0038, 0.01, 0.4, 0.2));
    }

    #[test]
    fn the_limit_is_where_the_balance_of_forces_leaves_a_cone() {
        // independent: the knife touches where its normal leans by φ; the force along the chord of both contacts
        let (radius, friction) = (0.012_f64, 0.25_f64);
        let limit = roll_limit_offset_m(radius, friction, friction);
        let needed = |offset: f64| {
            let knife = nalgebra::Vector2::new(offset, -(radius * radius - offset * offset).sqrt());
            let board = nalgebra::Vector2::new(0.0, radius);
            let line = (board - knife).normalize();
            let tangent = |contact: nalgebra::Vector2<f64>| {
                let normal = contact.normalize();
                (line.perp(&normal) / line.dot(&normal)).abs()
            };
            tangent(knife).max(tangent(board))
        };
        assert!(needed(0.999 * limit) < friction && needed(1.001 * limit) > friction);
    }

    #[test]
    fn friction_beyond_one_holds_at_every_offset() {
        assert_eq!(roll_limit_offset_m(0.01, 2.0, 2.0), 0.01);
    }
}
