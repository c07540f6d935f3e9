//! What a run differs in from the scenario: drawn anew from each seed, unknown to planner and controller.

use serde::{Deserialize, Serialize};
use sim::random::{Purpose, stream, symmetric};
use skills::field::{FieldError, within};

/// How far the world of a run may differ from the scenario, which states what planner and controller believe.
///
/// Everything is uniform about the stated value; nothing differs by default. Demonstrations are shown in the world as
/// stated: they were made before.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct VariationConfig {
    /// Friction between object and table: largest difference, as a share of the stated one.
    #[schemars(range(min = 0.0, max = LARGEST_SHARE))]
    pub table_friction_share: f64,
    /// Friction between tool and object: largest difference, as a share of the stated one.
    #[schemars(range(min = 0.0, max = LARGEST_SHARE))]
    pub tool_friction_share: f64,
    /// Mass of the object: largest difference, as a share of the stated one.
    #[schemars(range(min = 0.0, max = LARGEST_SHARE))]
    pub mass_share: f64,
    /// Place where the object starts: largest difference in each coordinate, m. The camera sees where it is.
    #[schemars(range(min = 0.0, max = FARTHEST_START_M))]
    pub start_m: f64,
}

/// What one run differs in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation {
    /// Friction between object and table over the stated one.
    pub table_friction: f64,
    /// Friction between tool and object over the stated one.
    pub tool_friction: f64,
    /// Mass of the object over the stated one.
    pub mass: f64,
    /// Place of the object at the start less the stated one, world frame, m.
    pub start_m: [f64; 2],
}

/// Largest share: more would leave next to nothing of a mass.
const LARGEST_SHARE: f64 = 0.9;
/// An object put farther from its place than this is another task, m.
const FARTHEST_START_M: f64 = 0.1;

impl VariationConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("table_friction_share", self.table_friction_share, 0.0, LARGEST_SHARE)?;
        within("tool_friction_share", self.tool_friction_share, 0.0, LARGEST_SHARE)?;
        within("mass_share", self.mass_share, 0.0, LARGEST_SHARE)?;
        within("start_m", self.start_m, 0.0, FARTHEST_START_M)
    }

    /// Draws what the run with `seed` differs in.
    #[must_use]
    pub fn draw(&self, seed: u64) -> Variation {
        let mut random = stream(seed, Purpose::Variation, 0);
        // every number is drawn, wanted or not: what varies already does not change when a key is added
        let [table_friction, tool_friction, mass, x, y] = [(); 5].map(|()| symmetric(&mut random));
        Variation {
            table_friction: 1.0 + self.table_friction_share * table_friction,
            tool_friction: 1.0 + self.tool_friction_share * tool_friction,
            mass: 1.0 + self.mass_share * mass,
            start_m: [self.start_m * x, self.start_m * y],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: VariationConfig =
        VariationConfig { table_friction_share: 0.2, tool_friction_share: 0.3, mass_share: 0.1, start_m: 0.001 };

    #[test]
    fn nothing_differs_by_default() {
        let expected = Variation { table_friction: 1.0, tool_friction: 1.0, mass: 1.0, start_m: [0.0; 2] };
        assert_eq!(VariationConfig::default().draw(7), expected);
    }

    #[test]
    fn a_key_changes_only_what_it_names() {
        let only = VariationConfig { mass_share: ALL.mass_share, ..VariationConfig::default() };
        let without = VariationConfig { mass_share: 0.0, ..ALL };
        let (all, only, without) = (ALL.draw(3), only.draw(3), without.draw(3));
        assert_eq!((only.mass, only.table_friction, only.start_m), (all.mass, 1.0, [0.0; 2]));
        assert_eq!(Variation { mass: all.mass, ..without }, all);
    }

    #[test]
    fn draws_fill_their_range_evenly_and_stay_inside() {
        let shares: Vec<f64> = (0..2000).map(|seed| ALL.draw(seed).table_friction - 1.0).collect();
        assert!(shares.iter().all(|share| share.abs() <= 0.2));
        // a quarter of a uniform distribution lies in each quarter of its range: 500 of 2000, standard deviation 19
        let in_first_quarter = shares.iter().filter(|share| **share < -0.1).count();
        assert!((400..600).contains(&in_first_quarter), "{in_first_quarter}");
        let starts = (0..2000).map(|seed| ALL.draw(seed).start_m);
        assert!(starts.flatten().all(|offset_m| offset_m.abs() <= 0.001));
    }

    #[test]
    fn shares_that_leave_no_mass_are_refused_by_name() {
        assert!(ALL.validate().is_ok());
        let refused = VariationConfig { mass_share: 1.0, ..ALL }.validate().unwrap_err();
        assert_eq!(refused.field, "mass_share");
        let refused = VariationConfig { start_m: -0.001, ..ALL }.validate().unwrap_err();
        assert_eq!(refused.field, "start_m");
    }
}
