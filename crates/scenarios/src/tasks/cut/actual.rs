//! What lies on the board in a run, and what the planner takes it for.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use sim::cutting::food::{Food, FoodFile, FoodSample};
use sim::random::{Purpose, normal, stream};
use skills::field::FieldError;

use super::places::lying;
use super::scenario::CutScenario;
use super::sections::LookConfig;
use super::variation::Variation;
use crate::outcome::Measure;

/// A food on a board.
#[derive(Clone, Debug)]
pub(super) struct Lying {
    /// The food.
    pub food: Food,
    /// Its pose.
    pub world_from_food: Isometry3<f64>,
}

/// What is there, and what is taken to be there.
#[derive(Clone, Debug)]
pub(super) struct Actual {
    /// What lies on the board.
    pub there: Lying,
    /// What the planner takes it for: of its true size, where it sees it or, if it does not look, where the scenario states.
    pub believed: Lying,
    variation: Variation,
    /// Where the planner believes it to lie, less the stated place.
    seen: Offset,
}

/// A place and an angle less the stated ones, m and rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Offset {
    place_m: [f64; 2],
    angle_rad: f64,
}

impl Offset {
    /// What a look at a food finds that lies `variation` off its stated place; nothing without a look.
    fn seen(look: Option<&LookConfig>, variation: &Variation, seed: u64) -> Self {
        let Some(look) = look else { return Self::default() };
        let mut random = stream(seed, Purpose::Camera, 0);
        let [x, y, angle] = [(); 3].map(|()| normal(&mut random));
        let [true_x, true_y] = variation.place_m;
        Self {
            place_m: [true_x + look.place_noise_m * x, true_y + look.place_noise_m * y],
            angle_rad: variation.angle_rad + look.angle_noise_rad * angle,
        }
    }

    /// A food at rest where the scenario lays it, moved and turned by this.
    fn moved(&self, rest: &Isometry3<f64>) -> Isometry3<f64> {
        let ([x, y], at) = (self.place_m, rest.translation);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.angle_rad);
        Isometry3::from_parts(Translation3::new(at.x + x, at.y + y, at.z), turn * rest.rotation)
    }
}

impl Actual {
    /// Draws what the run with `seed` cuts.
    ///
    /// # Errors
    /// A [`FieldError`] if no food can be as large or as tough as that.
    pub fn new(scenario: &CutScenario, file: &FoodFile, seed: u64) -> Result<Self, FieldError> {
        let (task, top_m) = (scenario.cut(), scenario.board.top_m());
        let variation = scenario.variation.draw(file, scenario.food.scale, seed);
        let stated = FoodSample { scale: variation.sample.scale, ..FoodSample::of(&file.material) };
        let believed = file.specimen(&stated)?;
        let mut food = file.specimen(&variation.sample)?;
        food.material.board_friction *= variation.board_friction;
        let [x, y] = task.food_at_m;
        let [dx, dy] = variation.place_m;
        let lies = |food: Food, at_m, angle_rad| Lying { world_from_food: lying(&food, at_m, angle_rad, top_m), food };
        Ok(Self {
            there: lies(food, [x + dx, y + dy], task.food_angle_rad + variation.angle_rad),
            believed: lies(believed, task.food_at_m, task.food_angle_rad),
            seen: Offset::seen(scenario.look.as_ref(), &variation, seed),
            variation,
        })
    }

    /// The same with the food at rest at `world_from_rest` where the scenario lays it.
    pub fn settled(mut self, world_from_rest: Isometry3<f64>) -> Self {
        let Variation { place_m, angle_rad, .. } = self.variation;
        self.believed.world_from_food = self.seen.moved(&world_from_rest);
        self.there.world_from_food = Offset { place_m, angle_rad }.moved(&world_from_rest);
        self
    }

    /// What the run differs in, as far as the scenario asks for differences.
    pub fn measures(&self, scenario: &CutScenario) -> Vec<Measure> {
        let (asked, drawn) = (&scenario.variation, &self.variation);
        let [x, y] = drawn.place_m.map(|offset| offset * 1e3);
        let friction = self.there.food.material.board_friction;
        let all = [
            (
                asked.size_share != 0.0,
                "varied_scale",
                "size of the food over that of its file",
                drawn.sample.scale,
                "1",
            ),
            (
                asked.toughness,
                "varied_toughness_j_per_m2",
                "toughness of the food",
                drawn.sample.toughness_j_per_m2,
                "J/m2",
            ),
            (asked.place_m != 0.0, "varied_place_x_mm", "food beside its stated place, x", x, "mm"),
            (asked.place_m != 0.0, "varied_place_y_mm", "food beside its stated place, y", y, "mm"),
            (
                asked.angle_rad != 0.0,
                "varied_angle_mrad",
                "food turned from its stated angle",
                drawn.angle_rad * 1e3,
                "mrad",
            ),
            (
                asked.board_friction_share != 0.0,
                "varied_board_friction",
                "friction between food and board",
                friction,
                "1",
            ),
        ];
        let wanted = all.into_iter().filter(|(asked, ..)| *asked);
        wanted.map(|(_, name, label, value, unit)| Measure::reported(name, label, value, unit)).collect()
    }
}
