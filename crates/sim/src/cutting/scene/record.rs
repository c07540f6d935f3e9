//! What a scene of cutting leaves behind: every cut, every piece, what failed.

use nalgebra::{Isometry3, Point3, Vector3};

use crate::cutting::mechanics::{Energy, Failure, IncisionQuality};

/// One cut of one piece, from the first touch until it came apart or was left.
#[derive(Clone, Debug, PartialEq)]
pub struct CutRecord {
    /// Index of the wanted cut whose plane is nearest; none if all are far.
    pub planned: Option<usize>,
    /// Simulated time of the first touch, s.
    pub begun_s: f64,
    /// Simulated time at which the piece came apart, s; none if it did not.
    pub separated_s: Option<f64>,
    /// Plane of the blade at the first touch, `world_from_section`: z is its normal.
    pub world_from_section: Isometry3<f64>,
    /// Pieces that it made of one.
    pub pieces: usize,
    /// Form and roughness of the cut surface.
    pub quality: IncisionQuality,
    /// Work of the knife and its parts.
    pub energy: Energy,
    /// Greatest force on the knife, N.
    pub force_peak_n: f64,
    /// Mean force on the knife while the edge pressed on the food, N.
    pub force_mean_n: f64,
    /// Area of the section, m².
    pub section_area_m2: f64,
    /// Area that was cut, m².
    pub cut_area_m2: f64,
    /// How far the edge slid along itself by how far it went into the food, while it pressed.
    pub slice_push_ratio_mean: f64,
    /// Strokes: one, and one more for each turn of the knife along its edge and for each return into the cut.
    pub strokes: usize,
    /// Time in which the edge pressed on the food, s.
    pub pressing_s: f64,
}

impl CutRecord {
    /// Share of the section that the knife did not cut.
    #[must_use]
    pub fn ligament_share(&self) -> f64 {
        (1.0 - self.cut_area_m2 / self.section_area_m2).max(0.0)
    }
}

/// A piece of the food.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceRecord {
    /// Name, as drawings and events call it.
    pub name: String,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Volume, m³.
    pub volume_m3: f64,
    /// Center of mass in the world, m.
    pub center_in_world: Point3<f64>,
    /// Center of mass in the food's frame, where it was before anything was cut, m.
    pub center_in_food: Point3<f64>,
    /// Extent along the axes of the food's frame, m; x is the axis of long foods, so that its entry is a slice's thickness.
    pub extent_in_food_m: Vector3<f64>,
    /// Number of convex cells that it is made of.
    pub cells: usize,
    /// Whether it is too thin to collide; it stays where it came off.
    pub crumb: bool,
}

/// What a scene of cutting leaves behind.
#[derive(Clone, Debug, PartialEq)]
pub struct CuttingRecord {
    /// Cuts in the order in which they began.
    pub cuts: Vec<CutRecord>,
    /// Pieces, crumbs too; together they are the food.
    pub pieces: Vec<PieceRecord>,
    /// The first thing that failed; none if all wanted cuts are through.
    pub failure: Option<Failure>,
    /// Longest way of a piece's center over the board while it was cut, m.
    pub food_slip_m: f64,
    /// Greatest turn of a piece while it was cut, rad.
    pub food_roll_rad: f64,
    /// Greatest force between knife and board, N, without what passes within 5 ms.
    pub board_force_peak_n: f64,
}
