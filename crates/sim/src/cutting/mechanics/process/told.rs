//! What a cut tells of itself.

use nalgebra::{Point2, Vector3};

use super::{Cut, CutStep, Stage};
use crate::cutting::mechanics::config::Board;
use crate::cutting::mechanics::elements::PlanarWrench;
use crate::cutting::mechanics::energy::Energy;
use crate::cutting::mechanics::motion::EdgeMotion;
use crate::cutting::mechanics::quality::IncisionQuality;

/// Of one step.
impl Cut {
    /// What the food does to the knife, and where the cut stands.
    pub(super) fn report(
        &self,
        motion: &EdgeMotion,
        wrench: PlanarWrench,
        [force, moment]: [Vector3<f64>; 2],
        middle: Option<(f64, Point2<f64>)>,
    ) -> CutStep {
        let (width_m, at) = middle.unwrap_or((0.0, self.edge_middle(motion)));
        let velocity = motion.velocity_at(at.x, at.y);
        let (sin, cos) = motion.angle_rad.sin_cos();
        let (slice, push) = (velocity.x * cos + velocity.y * sin, velocity.y * cos - velocity.x * sin);
        let gap = |board: Board| {
            let heights =
                (0..=self.grid.columns()).map(|node| board.depth_at(self.grid.x(node)) - self.front.edge[node]);
            heights.fold(f64::INFINITY, f64::min)
        };
        CutStep {
            force_in_section: force + Vector3::new(wrench.force.x, wrench.force.y, 0.0),
            moment_in_section: moment + Vector3::new(0.0, 0.0, wrench.moment),
            stage: self.stage,
            width_m,
            slice_push_ratio: if width_m > 0.0 && push > 0.0 { slice / push } else { 0.0 },
            advance_m_per_s: velocity.y,
            board_gap_m: self.board.map_or(f64::INFINITY, gap),
        }
    }
}

/// Of the whole cut.
impl Cut {
    /// Where the cut stands.
    #[must_use]
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// Whether the edge has touched the food.
    #[must_use]
    pub fn touched(&self) -> bool {
        self.touched
    }

    /// Whether the edge presses on food now.
    #[must_use]
    pub fn pressing(&self) -> bool {
        matches!(self.stage, Stage::Indenting | Stage::Cutting)
    }

    /// Whether the food breaks at once below a shallow cut.
    #[must_use]
    pub fn brittle(&self) -> bool {
        self.material.brittle_depth_share.is_some()
    }

    /// Energies so far.
    #[must_use]
    pub fn energy(&self) -> Energy {
        self.energy
    }

    /// Area of the section that is cut, m².
    #[must_use]
    pub fn cut_area_m2(&self) -> f64 {
        self.cut_area_m2
    }

    /// Area of the section, m².
    #[must_use]
    pub fn section_area_m2(&self) -> f64 {
        self.grid.area()
    }

    /// Uncut share of the section.
    #[must_use]
    pub fn ligament_share(&self) -> f64 {
        (1.0 - self.cut_area_m2 / self.grid.area()).max(0.0)
    }

    /// Greatest depth of the cut below the food's upper side, m.
    #[must_use]
    pub fn depth_m(&self) -> f64 {
        self.front.depth(&self.grid)
    }

    /// Deepest mean dent before the cut began, as a share of the section's height; zero after that.
    #[must_use]
    pub fn indentation_share(&self) -> f64 {
        if self.begun { 0.0 } else { self.deepest_dent_m / self.grid.height() }
    }

    /// Plane through the surface that was cut so far, z = c₀ + c₁ x + c₂ y.
    pub(in crate::cutting::mechanics) fn best_plane(&self) -> Option<Vector3<f64>> {
        self.surface.best_plane(&self.grid)
    }

    /// Depth and deviation of the surface that was cut so far, in bands; see [`Surface::bands`].
    pub(in crate::cutting::mechanics) fn bands(&self, along: f64, bands: usize) -> Vec<Point2<f64>> {
        self.surface.bands(&self.grid, along, bands)
    }

    /// Form and roughness of the surface that was cut so far; allocates, so it is no part of a control step.
    #[must_use]
    pub fn quality(&self) -> IncisionQuality {
        IncisionQuality {
            kinks: self.kinks.count(),
            crush_work_j: self.crush_work_j,
            torn_area_m2: self.torn_area_m2,
            ..IncisionQuality::of(&self.surface, &self.grid, self.edge.roughness_factor)
        }
    }

    /// Mean absolute deviation Ra of what is cut so far, m, as [`Self::quality`] tells it. Allocates nothing.
    #[must_use]
    pub fn mean_deviation_m(&self) -> f64 {
        IncisionQuality::mean_deviation_m(&self.surface, &self.grid, self.edge.roughness_factor)
    }
}
