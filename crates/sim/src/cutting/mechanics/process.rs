//! One cut from the first touch until the food comes apart.

use nalgebra::{Point2, Vector3};
use skills::field::FieldError;

use super::config::{Board, CuttingConfig};
use super::elements::{EdgeElement, EdgeSums, PlanarWrench};
use super::energy::Energy;
use super::flank_grip::FlankGrip;
use super::front::Front;
use super::grid::SectionGrid;
use super::kinks::Kinks;
use super::motion::EdgeMotion;
use super::surface::Surface;
use crate::SimError;
use crate::cutting::knife::Edge;
use crate::cutting::material::Material;

mod books;
mod forces;
mod resistance;
mod told;

use forces::sum;

/// Where a cut stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The edge has not touched the food, or has left it before a cut began.
    Approaching,
    /// The edge dents the food and has not entered it.
    Indenting,
    /// The edge presses on the end of the cut.
    Cutting,
    /// The blade is in the cut and presses on nothing: it is withdrawn, or follows the cut again.
    InCut,
    /// The blade has left a cut that is not through.
    Withdrawn,
    /// The food is cut through.
    Separated,
    /// The brittle food broke along the plane.
    Fractured,
}

/// What the food does to the knife in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutStep {
    /// Force on the knife, N; the food feels the opposite.
    pub force_in_section: Vector3<f64>,
    /// Moment on the knife about the origin of its frame (the heel of the edge), N m.
    pub moment_in_section: Vector3<f64>,
    /// Where the cut stands after this step.
    pub stage: Stage,
    /// Length of edge, along x, that presses on the food, m.
    pub width_m: f64,
    /// Speed along the edge by speed across it, where the edge presses; zero where it does not advance.
    pub slice_push_ratio: f64,
    /// Speed along the cutting direction, at the middle of what presses or of the blade in the cut, m/s.
    pub advance_m_per_s: f64,
    /// Least height of the edge above the board over the section's width, m; infinite without a board.
    pub board_gap_m: f64,
}

/// A cut in progress: one section of a food, one edge.
#[derive(Clone, Debug)]
pub struct Cut {
    grid: SectionGrid,
    front: Front,
    /// The edge at each node, and how the food gives way along the flanks in each column.
    elements: Vec<EdgeElement>,
    flanks: Vec<FlankGrip>,
    surface: Surface,
    kinks: Kinks,
    material: Material,
    edge: Edge,
    board: Option<Board>,
    config: CuttingConfig,
    stage: Stage,
    energy: Energy,
    previous: PlanarWrench,
    /// Energy in the food that gives way along edge and flanks, J.
    stored_along_j: f64,
    begun: bool,
    touched: bool,
    time_s: f64,
    cut_area_m2: f64,
    /// Speed that sets the toughness, m/s: that of the edge, smoothed while it cuts.
    rate_speed_m_per_s: f64,
    /// How far the edge slid along itself since it touched, m.
    slid_m: f64,
    deepest_dent_m: f64,
    crush_work_j: f64,
    torn_area_m2: f64,
}

/// A food is apart when less than this share of its section is uncut.
pub(super) const THROUGH_SHARE: f64 = 0.02;
/// … and the cut has come this near to the board everywhere, m.
const BOARD_NEARNESS_M: f64 = 0.0005;
/// Time in which the toughness follows the speed, s: a few steps, so that their product is stable.
const RATE_RESPONSE_S: f64 = 0.005;

impl Cut {
    /// Begins a cut of a section: convex `polygons` with disjoint interiors in the section's frame.
    ///
    /// # Errors
    /// A [`FieldError`] naming what cannot be used of the polygons, the food, the edge, the board or the settings.
    pub fn new(
        polygons: &[Vec<Point2<f64>>],
        material: &Material,
        edge: &Edge,
        board: Option<Board>,
        config: &CuttingConfig,
    ) -> Result<Self, FieldError> {
        config.validate().map_err(|error| error.within("cutting"))?;
        material.validate().map_err(|error| error.within("material"))?;
        edge.validate().map_err(|error| error.within("edge"))?;
        board.iter().try_for_each(Board::validate).map_err(|error| error.within("board"))?;
        let grid = SectionGrid::new(polygons, config.cell_m)?;
        Ok(Self {
            front: Front::new(&grid, edge),
            elements: vec![EdgeElement::default(); grid.columns() + 1],
            flanks: vec![FlankGrip::default(); grid.columns()],
            surface: Surface::new(&grid, config.cell_m),
            kinks: Kinks::default(),
            material: material.clone(),
            edge: edge.clone(),
            board,
            config: config.clone(),
            stage: Stage::Approaching,
            energy: Energy::default(),
            previous: PlanarWrench::default(),
            stored_along_j: 0.0,
            begun: false,
            touched: false,
            time_s: 0.0,
            cut_area_m2: 0.0,
            rate_speed_m_per_s: material.reference_speed_m_per_s,
            slid_m: 0.0,
            deepest_dent_m: 0.0,
            crush_work_j: 0.0,
            torn_area_m2: 0.0,
            grid,
        })
    }

    /// Moves the knife to where it is after `dt` (s) and returns what the food does to it.
    ///
    /// # Errors
    /// [`SimError::Diverged`] if the motion or the step is not finite, or the step is not positive.
    pub fn step(&mut self, motion: &EdgeMotion, dt: f64) -> Result<CutStep, SimError> {
        let step = (!(dt.is_finite() && dt > 0.0)).then_some(("time step (s)", dt));
        if let Some((quantity, value)) = motion.not_finite().or(step) {
            return Err(SimError::Diverged { quantity: quantity.into(), value, time_s: self.time_s });
        }
        self.time_s += dt;
        if matches!(self.stage, Stage::Separated | Stage::Fractured) {
            return Ok(self.report(motion, PlanarWrench::default(), [Vector3::zeros(); 2], None));
        }
        self.front.place(&self.grid, motion);
        let pressing = self.front.pressing(&self.grid);
        let edge = self.press(motion, pressing, dt);
        self.cut_area_m2 = self.area_above_crack();
        let flanks = self.rub(motion, dt);
        // edge and flanks share the momentum that a step may take
        let mass = 0.5 * self.config.effective_mass_kg;
        let (along, friction) = (edge.opposing.bounded(mass, dt), flanks.opposing.bounded(mass, dt));
        let wrench = sum([edge.pressing, along, friction]);
        self.keep_books(motion, &edge, [&along, &friction], &wrench, dt);
        let lateral = self.walls(dt).wrench(motion, flanks.area, &flanks.middle());
        self.proceed(pressing.is_some(), flanks.area);
        let middle = pressing.or_else(|| (flanks.area > 0.0).then(|| (0.0, flanks.middle())));
        let report = self.report(motion, wrench, lateral, middle);
        self.kinks.note(self.begun && (pressing.is_some() || flanks.area > 0.0), report.advance_m_per_s, dt);
        Ok(report)
    }

    /// Area of the section above the crack, m².
    fn area_above_crack(&self) -> f64 {
        (0..self.grid.columns()).map(|column| self.front.cut_area(&self.grid, column)).sum()
    }

    /// Forces of the edge; begins the cut when the dent bears no more.
    fn press(&mut self, motion: &EdgeMotion, pressing: Option<(f64, Point2<f64>)>, dt: f64) -> EdgeSums {
        let Some((width, middle)) = pressing else {
            self.rate_speed_m_per_s = motion.velocity_at(self.edge_middle(motion).x, self.edge_middle(motion).y).norm();
            // a dent that is left before the cut began has sprung back
            if !self.begun {
                (self.slid_m, self.deepest_dent_m) = (0.0, 0.0);
            }
            return EdgeSums::default();
        };
        self.touched = true;
        let velocity = motion.velocity_at(middle.x, middle.y);
        let follow = (dt / RATE_RESPONSE_S).min(1.0);
        self.rate_speed_m_per_s += follow * (velocity.norm() - self.rate_speed_m_per_s);
        if !self.begun {
            self.slid_m += velocity.x.abs() * dt;
            let sums = self.act(motion, &self.zone(width, f64::INFINITY, dt));
            let dent = self.mean_dent(width);
            self.deepest_dent_m = self.deepest_dent_m.max(dent);
            if sums.load < self.initiation_n_per_m(dent) * self.pressing_length() {
                return sums;
            }
            self.begun = true;
            self.crush_work_j = sums.elastic + self.energy.friction_j;
            // what the dent held and the running crack does not take is lost
            let running = self.act(motion, &self.zone(width, self.resistance_n_per_m(), dt));
            self.energy.crush_j += (sums.elastic - running.elastic - running.fracture).max(0.0);
            return running;
        }
        self.act(motion, &self.zone(width, self.resistance_n_per_m(), dt))
    }

    fn edge_middle(&self, motion: &EdgeMotion) -> Point2<f64> {
        let (sin, cos) = motion.angle_rad.sin_cos();
        motion.position + nalgebra::Vector2::new(cos, sin) * (0.5 * self.edge.length_m())
    }

    /// Decides where the cut stands after a step.
    fn proceed(&mut self, pressing: bool, blade_area: f64) {
        let breaks = self.material.brittle_depth_share.filter(|_| self.begun);
        self.stage = if breaks.is_some_and(|share| self.depth_m() > share * self.grid.height()) {
            Stage::Fractured
        } else if self.begun && self.through() {
            Stage::Separated
        } else {
            match (self.begun, pressing) {
                (false, false) => Stage::Approaching,
                (false, true) => Stage::Indenting,
                (true, true) => Stage::Cutting,
                (true, false) if blade_area > 0.0 => Stage::InCut,
                (true, false) => Stage::Withdrawn,
            }
        };
        if matches!(self.stage, Stage::Separated | Stage::Fractured) {
            self.torn_area_m2 = (self.grid.area() - self.cut_area_m2).max(0.0);
            self.energy.crush_j += std::mem::take(&mut self.energy.elastic_j);
        }
    }

    /// Whether hardly any of the section is uncut, and nothing of it away from the board.
    fn through(&self) -> bool {
        let reached = |node: usize| {
            let near = self.board.map_or(f64::INFINITY, |board| board.depth_at(self.grid.x(node)) - BOARD_NEARNESS_M);
            let lowest = self.grid.spans(node).last().map_or(f64::NEG_INFINITY, |span| span.1);
            self.front.crack[node] >= near.min(lowest - f64::EPSILON)
        };
        self.ligament_share() < THROUGH_SHARE && (0..=self.grid.columns()).all(reached)
    }
}
