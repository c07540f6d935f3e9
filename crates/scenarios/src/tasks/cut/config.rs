//! The table `[task.cut]`: where the food lies, what is wanted of it, how the knife moves.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use serde::{Deserialize, Serialize};
use skills::cutting::CutOptions;
use skills::field::{FieldError, finite, within};

/// Cut a food on a board.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CutConfig {
    /// Where the origin of the food's frame lies on the board, x and y of the world, m.
    #[schemars(inner(range(min = -FARTHEST_M, max = FARTHEST_M)))]
    pub food_at_m: [f64; 2],
    /// Turn of the food about the vertical, rad: a food's long axis is its x axis, and the edge is held across it, its tip
    /// along the world's x axis at the default of a quarter turn.
    #[serde(default = "default_food_angle_rad")]
    pub food_angle_rad: f64,
    /// What the food is to be cut into.
    pub wanted: Wanted,
    /// Angle by which each cut leans about the edge, rad: none, one for all, or one for each.
    #[serde(default)]
    pub tilts_rad: Vec<f64>,
    /// Where the knife waits before, the middle of the straight part of its edge, world frame, m.
    #[schemars(inner(range(min = -FARTHEST_M, max = FARTHEST_M)))]
    pub home_m: [f64; 3],
    /// How the knife moves.
    #[serde(default)]
    pub motion: CutOptions,
    /// Time that the pieces are given to come to rest after the last cut, s.
    #[serde(default = "default_settle_s")]
    #[schemars(range(min = 0.0, max = LONGEST_SETTLE_S))]
    pub settle_s: f64,
}

/// Where a food is to be cut, along its long axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Wanted {
    /// Into this many pieces of the same length.
    EqualPieces(usize),
    /// At these shares of the length, increasing.
    AtShares(Vec<f64>),
    /// At these distances from the end, increasing, m.
    AtM(Vec<f64>),
}

/// Edge across the world's x axis would point the knife sideways: along it, away from the arm.
fn default_food_angle_rad() -> f64 {
    FRAC_PI_2
}

fn default_settle_s() -> f64 {
    0.5
}

/// Places on a board, m, and the longest rest after a run, s.
const FARTHEST_M: f64 = 10.0;
const LONGEST_SETTLE_S: f64 = 60.0;
/// Most pieces: more are thinner than what counts as a success.
const MOST_PIECES: usize = 50;
/// A cut that leans by more than this does not go down any more, rad.
const LARGEST_TILT_RAD: f64 = 0.9 * FRAC_PI_4;

impl Wanted {
    /// Number of cuts.
    #[must_use]
    pub fn cuts(&self) -> usize {
        match self {
            Self::EqualPieces(count) => count.saturating_sub(1),
            Self::AtShares(places) | Self::AtM(places) => places.len(),
        }
    }

    /// Distances of the cuts from the end of a food of `length_m`, increasing, m.
    #[must_use]
    pub fn places_m(&self, length_m: f64) -> Vec<f64> {
        match self {
            Self::EqualPieces(count) => (1..*count).map(|k| length_m * k as f64 / *count as f64).collect(),
            Self::AtShares(shares) => shares.iter().map(|share| share * length_m).collect(),
            Self::AtM(places_m) => places_m.clone(),
        }
    }

    fn validate(&self) -> Result<(), FieldError> {
        match self {
            Self::EqualPieces(count) if (2..=MOST_PIECES).contains(count) => Ok(()),
            Self::EqualPieces(count) => {
                Err(FieldError::new("equal_pieces", count, format!("a whole number from 2 to {MOST_PIECES}")))
            }
            Self::AtShares(shares) => increasing("at_shares", shares, 1.0),
            Self::AtM(places_m) => increasing("at_m", places_m, FARTHEST_M),
        }
    }
}

/// Checks that places increase strictly between 0 and `end`.
fn increasing(field: &str, places: &[f64], end: f64) -> Result<(), FieldError> {
    if places.is_empty() || places.len() >= MOST_PIECES {
        let expected = format!("from 1 to {} places", MOST_PIECES - 1);
        return Err(FieldError::new(field, format!("{} places", places.len()), expected));
    }
    let mut before = 0.0;
    for (index, &place) in places.iter().enumerate() {
        // a place that is not a number is not within bounds either
        if !(place > before && place < end) {
            let expected =
                format!("a number greater than {before} and less than {end}: places increase from end to end");
            return Err(FieldError::new(format!("{field}.{index}"), place, expected));
        }
        before = place;
    }
    Ok(())
}

impl CutConfig {
    /// Angle by which cut number `cut` leans, rad.
    #[must_use]
    pub fn tilt_rad(&self, cut: usize) -> f64 {
        let all = self.tilts_rad.first().filter(|_| self.tilts_rad.len() == 1);
        self.tilts_rad.get(cut).or(all).copied().unwrap_or(0.0)
    }

    /// Checks the numbers on their own.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.food_at_m.iter().try_for_each(|value| within("food_at_m", *value, -FARTHEST_M, FARTHEST_M))?;
        finite("food_angle_rad", &[self.food_angle_rad])?;
        self.wanted.validate().map_err(|error| error.within("wanted"))?;
        if ![0, 1, self.wanted.cuts()].contains(&self.tilts_rad.len()) {
            let expected = format!("none, one for all cuts, or {}: one for each cut", self.wanted.cuts());
            return Err(FieldError::new("tilts_rad", format!("{} angles", self.tilts_rad.len()), expected));
        }
        for (index, &tilt) in self.tilts_rad.iter().enumerate() {
            within(&format!("tilts_rad.{index}"), tilt, -LARGEST_TILT_RAD, LARGEST_TILT_RAD)?;
        }
        self.home_m.iter().try_for_each(|value| within("home_m", *value, -FARTHEST_M, FARTHEST_M))?;
        self.motion.validate().map_err(|error| error.within("motion"))?;
        within("settle_s", self.settle_s, 0.0, LONGEST_SETTLE_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config(wanted: Wanted, tilts_rad: Vec<f64>) -> CutConfig {
        CutConfig {
            food_at_m: [0.5, 0.0],
            food_angle_rad: default_food_angle_rad(),
            wanted,
            tilts_rad,
            home_m: [0.5, 0.0, 0.2],
            motion: CutOptions::default(),
            settle_s: 0.5,
        }
    }

    #[test]
    fn equal_pieces_are_equal_and_shares_scale() {
        let thirds = Wanted::EqualPieces(3).places_m(0.15);
        assert!((thirds[0] - 0.05).abs() < 1e-15 && (thirds[1] - 0.10).abs() < 1e-15);
        assert_eq!(Wanted::AtShares(vec![0.5]).places_m(0.15), [0.075]);
        assert_eq!(Wanted::AtM(vec![0.02, 0.03]).places_m(0.15), [0.02, 0.03]);
    }

    #[test]
    fn places_that_make_no_pieces_are_refused_by_name() {
        let field = |wanted, tilts| config(wanted, tilts).validate().unwrap_err().field;
        assert_eq!(field(Wanted::EqualPieces(1), vec![]), "wanted.equal_pieces");
        assert_eq!(field(Wanted::AtShares(vec![0.5, 0.5]), vec![]), "wanted.at_shares.1");
        assert_eq!(field(Wanted::AtShares(vec![1.0]), vec![]), "wanted.at_shares.0");
        assert_eq!(field(Wanted::AtM(vec![f64::NAN]), vec![]), "wanted.at_m.0");
        assert_eq!(field(Wanted::AtM(vec![]), vec![]), "wanted.at_m");
        assert_eq!(field(Wanted::EqualPieces(4), vec![0.1, 0.2]), "tilts_rad");
        assert_eq!(field(Wanted::EqualPieces(4), vec![1.0]), "tilts_rad.0");
    }

    #[test]
    fn one_tilt_serves_all_cuts() {
        let one = config(Wanted::EqualPieces(4), vec![0.2]);
        assert_eq!([0, 2].map(|cut| one.tilt_rad(cut)), [0.2, 0.2]);
        let each = config(Wanted::EqualPieces(3), vec![0.1, -0.1]);
        assert_eq!([0, 1].map(|cut| each.tilt_rad(cut)), [0.1, -0.1]);
        assert_eq!(config(Wanted::EqualPieces(3), vec![]).tilt_rad(1), 0.0);
    }
}
