//! The law of one element of the edge: fracture shared between pushing and slicing.

/// Forces per length of edge that oppose pushing and slicing, N/m: R/(1+ξ²) and R sξᵥ/(1+ξ²) with the ratio of motions
/// `ratio` = v_t/v_n, ξᵥ its absolute value, and the effective ratio ξ = s ξᵥ + ξ_teeth.
///
/// With s = 1 and no teeth this is the frictionless law of Atkins, Xu and Jeronimidis ("Cutting, by 'pressing and slicing',
/// of thin floppy slices of materials illustrated by experiments on cheddar cheese and salami", 2004): the force opposes the
/// velocity and works R for each area cut, whatever the ratio. Teeth lower the pushing force; their own forces along the edge
/// cancel between the two sides of a tooth.
#[must_use]
pub fn edge_force_n_per_m(resistance_n_per_m: f64, ratio: f64, efficiency: f64, tooth_ratio: f64) -> [f64; 2] {
    let helpful = efficiency * ratio.abs();
    let push = resistance_n_per_m / (1.0 + (helpful + tooth_ratio).powi(2));
    [push, push * helpful]
}

/// Slice-push ratio above which a free food on a board slides along the edge instead of being cut; none if it never does.
///
/// The food is pressed on the board by its weight and the pushing force and pulled along by the slicing force:
/// P ξ/(1+ξ²) = μ (P/(1+ξ²) + W) with P the force of a push without slicing.
#[must_use]
pub fn slicing_ratio_at_which_food_slides(push_n: f64, weight_n: f64, board_friction: f64) -> Option<f64> {
    let heaviness = board_friction * weight_n / push_n;
    if heaviness <= 0.0 {
        return Some(board_friction);
    }
    let discriminant = 1.0 - 4.0 * heaviness * (board_friction + heaviness);
    (discriminant >= 0.0).then(|| (1.0 - discriminant.sqrt()) / (2.0 * heaviness))
}

/// A dent before the edge, and what lets the crack run into it; lengths along the cutting direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dent {
    /// Depth of the dent with the crack where it was, m.
    pub gap: f64,
    /// Depth that a crack bears that is not sliced, m.
    pub capacity: f64,
    /// How far the edge slid along itself in this step, times the efficiency of slicing, m.
    pub slip: f64,
    /// What teeth add to the slice-push ratio.
    pub tooth_ratio: f64,
}

/// Newton's rounds, at most; a bracket halves whenever Newton leaves it.
const ROUNDS: usize = 60;
/// Share of the dent to which the advance is solved.
const ACCURACY: f64 = 1e-11;

impl Dent {
    /// How far the crack runs in this step: solves (gap − dc)(1 + (slip/dc + ξ_teeth)²) = capacity for dc.
    ///
    /// Implicit in the ratio of motions: the left side falls and the right side is constant in dc, so there is one solution,
    /// from a sawing stroke that sinks under the smallest load to a push that stands still below the full one.
    pub(super) fn advance(&self) -> f64 {
        let Self { gap, capacity, slip, tooth_ratio } = *self;
        let push_capacity = capacity / (1.0 + tooth_ratio * tooth_ratio);
        if slip <= ACCURACY * gap {
            return (gap - push_capacity).max(0.0);
        }
        // times dc², so that it is a polynomial: positive at 0, negative at the gap
        let excess = |dc: f64| (gap - dc) * (dc * dc + (slip + tooth_ratio * dc).powi(2)) - capacity * dc * dc;
        let slope = |dc: f64| {
            let along = slip + tooth_ratio * dc;
            (gap - dc) * (2.0 * dc + 2.0 * tooth_ratio * along) - (dc * dc + along * along) - 2.0 * capacity * dc
        };
        let (mut low, mut high) = (0.0, gap);
        let mut dc = self.first_guess();
        for _ in 0..ROUNDS {
            let value = excess(dc);
            if value > 0.0 {
                low = dc;
            } else {
                high = dc;
            }
            let newton = dc - value / slope(dc);
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - dc).abs() <= ACCURACY * gap {
                return next;
            }
            dc = next;
        }
        dc
    }

    /// Solution for an advance that is small beside the dent, or for one that slicing hardly helps.
    fn first_guess(&self) -> f64 {
        let Self { gap, capacity, slip, tooth_ratio } = *self;
        let spare = capacity - gap * (1.0 + tooth_ratio * tooth_ratio);
        let guess = if spare > 0.0 {
            slip * (gap * tooth_ratio + (gap * gap * tooth_ratio * tooth_ratio + spare * gap).sqrt()) / spare
        } else {
            gap - capacity / (1.0 + tooth_ratio * tooth_ratio)
        };
        if guess > 0.0 && guess < gap { guess } else { 0.5 * gap }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn pushing_and_slicing_share_the_resistance() {
        for (ratio, push, slice) in [(0.0, 1.0, 0.0), (0.5, 0.8, 0.4), (1.0, 0.5, 0.5), (-2.0, 0.2, 0.4)] {
            let [found_push, found_slice] = edge_force_n_per_m(1.0, ratio, 1.0, 0.0);
            assert_relative_eq!(found_push, push, epsilon = 1e-12);
            assert_relative_eq!(found_slice, slice, epsilon = 1e-12);
        }
    }

    #[test]
    fn teeth_lower_the_pushing_force_and_slicing_without_effect_leaves_it() {
        assert_relative_eq!(edge_force_n_per_m(1.0, 0.0, 1.0, 0.3)[0], 1.0 / 1.09, epsilon = 1e-12);
        assert_eq!(edge_force_n_per_m(1.0, 3.0, 0.0, 0.0), [1.0, 0.0]);
    }

    #[test]
    fn a_light_food_slides_at_smaller_slicing_ratios_on_a_smoother_board() {
        // worked by hand from the balance of forces: 4.5 N of resistance, 1.18 N of weight
        assert_relative_eq!(slicing_ratio_at_which_food_slides(4.5, 1.18, 0.4).unwrap(), 0.535, epsilon = 1e-3);
        assert_relative_eq!(slicing_ratio_at_which_food_slides(4.5, 1.18, 0.3).unwrap(), 0.391, epsilon = 1e-3);
        assert_relative_eq!(slicing_ratio_at_which_food_slides(4.5, 0.0, 0.3).unwrap(), 0.3);
        assert_eq!(slicing_ratio_at_which_food_slides(4.5, 20.0, 0.4), None);
    }

    #[test]
    fn the_advance_solves_its_equation_for_every_dent() {
        for gap in [1e-7, 1e-5, 3e-4, 2e-3] {
            for capacity in [1e-6, 1e-4, 1e-3] {
                for slip in [0.0, 1e-9, 1e-6, 2e-5, 1e-3] {
                    for tooth_ratio in [0.0, 0.3] {
                        let dent = Dent { gap, capacity, slip, tooth_ratio };
                        let dc = dent.advance();
                        assert!((0.0..=gap).contains(&dc), "{dent:?} {dc}");
                        let borne = capacity / (1.0 + (slip / dc + tooth_ratio).powi(2));
                        if dc > 1e-3 * gap {
                            assert!((gap - dc - borne).abs() < 1e-7 * capacity.max(gap), "{dent:?} {dc} {borne}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_pushed_edge_stands_below_its_capacity_and_a_sawn_one_sinks() {
        let pushed = Dent { gap: 1e-4, capacity: 1.01e-4, slip: 0.0, tooth_ratio: 0.0 };
        assert_eq!(pushed.advance(), 0.0);
        assert!(Dent { slip: 1e-5, ..pushed }.advance() > 1e-5);
    }
}
