//! What a scene of cutting is made of.

use nalgebra::{Isometry3, Point3, Unit, Vector3};
use rapier3d::prelude::{Group, InteractionGroups, InteractionTestMode};
use skills::field::{FieldError, finite, positive, within};

use crate::cutting::food::Food;
use crate::cutting::knife::Knife;
use crate::cutting::mechanics::{CuttingConfig, Thresholds};

const BOARD: Group = Group::GROUP_30;
const FOOD: Group = Group::GROUP_31;
const KNIFE: Group = Group::GROUP_32;

/// Food touches everything but the knife, which the cutting law handles.
pub(super) const FOOD_GROUPS: InteractionGroups =
    InteractionGroups::new(FOOD, Group::ALL.difference(KNIFE), InteractionTestMode::And);
/// The knife touches everything but food.
pub(super) const KNIFE_GROUPS: InteractionGroups =
    InteractionGroups::new(KNIFE, Group::ALL.difference(FOOD), InteractionTestMode::And);
/// The board touches everything.
pub(super) const BOARD_GROUPS: InteractionGroups = InteractionGroups::new(BOARD, Group::ALL, InteractionTestMode::And);

/// A board to cut on: a cuboid that never moves.
#[derive(Clone, Debug, PartialEq)]
pub struct CuttingBoard {
    /// Pose of the board, `world_from_board`: the origin in the middle of its upper side, z out of it.
    pub world_from_board: Isometry3<f64>,
    /// Half lengths along x, y, z, m.
    pub half_extents_m: [f64; 3],
    /// Coefficient of friction: of the knife on the board, and the most that any food has on it.
    pub friction: f64,
}

impl CuttingBoard {
    /// Checks the numbers.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        finite("world_from_board", self.world_from_board.to_homogeneous().as_slice())?;
        self.half_extents_m.iter().try_for_each(|half| within("half_extents_m", *half, 1e-3, 2.0))?;
        within("friction", self.friction, 0.0, 2.0)
    }

    /// Direction out of the upper side, in the world.
    pub(super) fn up_in_world(&self) -> Unit<Vector3<f64>> {
        self.world_from_board.rotation * Vector3::z_axis()
    }

    /// Middle of the upper side, in the world.
    pub(super) fn top_in_world(&self) -> Point3<f64> {
        Point3::from(self.world_from_board.translation.vector)
    }

    /// Pose of the cuboid's middle.
    pub(super) fn world_from_middle(&self) -> Isometry3<f64> {
        self.world_from_board * Isometry3::translation(0.0, 0.0, -self.half_extents_m[2])
    }
}

/// Everything that a scene of cutting is made of, but for the arm.
#[derive(Clone, Debug)]
pub struct CuttingSetup {
    /// What is cut.
    pub food: Food,
    /// Where it lies at first.
    pub world_from_food: Isometry3<f64>,
    /// What it is cut with; the arm holds it as [`super::held_knife`].
    pub knife: Knife,
    /// What it lies on.
    pub board: CuttingBoard,
    /// Numbers of the cutting law; the mass that the arm shows at the knife is measured at the beginning of each cut.
    pub config: CuttingConfig,
    /// What counts as failure.
    pub thresholds: Thresholds,
    /// Sections of the wanted cuts, `world_from_section`, in their order: x along the chord, y the direction of the cut, z the
    /// normal. Only their planes count, to tell which cut is which.
    pub planned: Vec<Isometry3<f64>>,
}

impl CuttingSetup {
    /// Checks every number.
    ///
    /// # Errors
    /// A [`FieldError`] naming the offending value.
    pub fn validate(&self) -> Result<(), FieldError> {
        self.food.material.validate().map_err(|error| error.within("material"))?;
        finite("world_from_food", self.world_from_food.to_homogeneous().as_slice())?;
        self.knife.edge.validate().map_err(|error| error.within("knife.edge"))?;
        positive("knife.mass_kg", self.knife.mass.mass_kg)?;
        self.board.validate().map_err(|error| error.within("board"))?;
        self.config.validate().map_err(|error| error.within("cutting"))?;
        self.thresholds.validate().map_err(|error| error.within("thresholds"))?;
        self.planned.iter().enumerate().try_for_each(|(index, pose)| {
            finite("world_from_section", pose.to_homogeneous().as_slice())
                .map_err(|error| error.within(format!("planned.{index}")))
        })
    }
}
