//! One cut from the first touch until the food comes apart.

use nalgebra::{Point2, Vector3};
use skills::field::FieldError;

use super::config::{Board, CuttingConfig};
use super::elements::{EdgeElement, EdgeSums, EdgeZone, FlankPatch, FlankStress, FlankSums, PlanarWrench};
use super::energy::Energy;
use super::front::Front;
use super::giving::{Elasticity, Giving};
use super::grid::SectionGrid;
use super::kinks::Kinks;
use super::lateral::{Walls, flank_stiffness_n_per_m, plane_strain, shear_share};
use super::motion::EdgeMotion;
use super::quality::IncisionQuality;
use super::surface::Surface;
use crate::SimError;
use crate::cutting::knife::Edge;
use crate::cutting::material::Material;

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
    flanks: Vec<Giving>,
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
/// Angle by which skin dips under the edge when it bursts, rad: estimate, which gives the forces measured on grapes.
const SKIN_ANGLE_RAD: f64 = std::f64::consts::FRAC_PI_6;
/// Width on which an edge crushes a brittle food before it breaks, m: size of the pores of biscuits, estimate.
const BRITTLE_WIDTH_M: f64 = 0.0003;
/// Foods at least this stiff press on the flanks of the blade that spreads them, Pa.
const STIFF_FOOD_PA: f64 = 1e6;
/// Time in which the toughness follows the speed, s: a few steps, so that their product is stable.
const RATE_RESPONSE_S: f64 = 0.005;
/// The power law of the speed holds within this factor of the reference speed.
const RATE_RANGE: f64 = 100.0;
/// Share of the largest stiffness that a step of semi-implicit integration bears; 4 is the limit of stability.
const STIFFNESS_SHARE: f64 = 0.5;

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
            flanks: vec![Giving::default(); grid.columns()],
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

    /// Resistance to a running crack, N/m: R (v/v₀)ⁿ + (1 + μ) σ 2ρ, ρ the radius of the edge.
    fn resistance_n_per_m(&self) -> f64 {
        let material = &self.material;
        let speed = self.rate_speed_m_per_s / material.reference_speed_m_per_s;
        let rate = speed.clamp(1.0 / RATE_RANGE, RATE_RANGE).powf(material.rate_exponent);
        material.toughness_j_per_m2 * rate + self.bluntness_n_per_m()
    }

    /// What a blunt edge or a wire adds by crushing (law of wire cutting: linear in the diameter), N/m.
    fn bluntness_n_per_m(&self) -> f64 {
        (1.0 + self.edge.friction) * self.material.yield_stress_pa * 2.0 * self.edge.radius_m
    }

    /// Load per length at which a cut begins under a mean dent, N/m; slicing lowers it as it lowers a running cut's.
    fn initiation_n_per_m(&self, dent: f64) -> f64 {
        let material = &self.material;
        let load = if self.brittle() {
            material.yield_stress_pa * BRITTLE_WIDTH_M.max(2.0 * self.edge.radius_m)
        } else {
            let skin = 2.0 * material.skin_tension_n_per_m * SKIN_ANGLE_RAD.sin();
            let running = material.initiation_factor(self.edge.radius_m) * self.resistance_n_per_m();
            running.max(skin)
        };
        let ratio = material.slice_efficiency * self.slid_m / dent.max(f64::MIN_POSITIVE) + self.edge.tooth_ratio;
        load / (1.0 + ratio * ratio)
    }

    fn mean_dent(&self, width: f64) -> f64 {
        self.front.engaged().map(|node| self.front.dent[node] * self.front.width[node]).sum::<f64>() / width
    }

    /// Length of the edge that presses, along the edge, m.
    fn pressing_length(&self) -> f64 {
        let length = |node: usize| self.front.width[node] * (1.0 + self.front.slope[node].powi(2)).sqrt();
        self.front.engaged().map(length).sum()
    }

    fn zone(&self, width: f64, resistance: f64, dt: f64) -> EdgeZone {
        let largest_stiffness = STIFFNESS_SHARE * self.config.effective_mass_kg / (dt * dt * width);
        EdgeZone {
            resistance,
            stiffness: self.material.indentation_stiffness_pa.min(largest_stiffness),
            largest_stiffness,
            efficiency: self.material.slice_efficiency,
            tooth_ratio: self.edge.tooth_ratio,
            friction: self.edge.friction,
            creep_speed: self.config.creep_speed_m_per_s,
            squeeze_ratio: self.config.squeeze_ratio,
            board: self.board,
            elasticity: self.config.free_food_kg.map(|mass_kg| {
                let stiffness = shear_share() * self.material.indentation_stiffness_pa * width;
                (Elasticity::new(stiffness, mass_kg, dt), width)
            }),
            dt,
        }
    }

    fn act(&mut self, motion: &EdgeMotion, zone: &EdgeZone) -> EdgeSums {
        let mut sums = EdgeSums::default();
        for node in 0..=self.grid.columns() {
            let element = &mut self.elements[node];
            if self.front.dent[node] <= 0.0 || self.front.width[node] <= 0.0 {
                *element = EdgeElement::default();
            } else {
                let at = Point2::new(self.grid.x(node), self.front.edge[node]);
                zone.act(node, &mut self.front, element, at, motion, &mut sums);
            }
        }
        sums
    }

    /// Friction of the flanks in the cut, both together: 2 (τ + μ p) with the pressure p of a spread stiff food.
    fn rub(&mut self, motion: &EdgeMotion, dt: f64) -> FlankSums {
        let shear = 2.0 * (self.material.flank_shear_pa + self.edge.friction * self.spreading_pressure_pa());
        let blade_area = |column: usize| self.front.blade_area(&self.grid, column, self.edge.blade_height_m);
        let elasticity = self.config.free_food_kg.map(|mass_kg| {
            let whole: f64 = (0..self.grid.columns()).map(blade_area).sum();
            let stiffness = flank_stiffness_n_per_m(self.material.youngs_modulus_pa, whole);
            (Elasticity::new(stiffness, mass_kg, dt), whole)
        });
        let stress = FlankStress { shear, creep_speed: self.config.creep_speed_m_per_s, elasticity };
        let mut sums = FlankSums::default();
        for column in 0..self.grid.columns() {
            self.surface.record(&self.grid, &self.front, column, motion);
            let area = self.front.blade_area(&self.grid, column, self.edge.blade_height_m);
            if area <= 0.0 {
                self.flanks[column].release();
            } else {
                let ends = [column, column + 1].map(|node| self.front.edge[node].min(self.front.crack[node]));
                let depth = (0.5 * (ends[0] + ends[1])).min(self.grid.bottom());
                sums.add(column, &self.grid, FlankPatch { area, depth }, &stress, &mut self.flanks[column], motion);
            }
        }
        sums
    }

    /// Pressure of a stiff food on the blade that spreads it, Pa: E* t/(2 h).
    fn spreading_pressure_pa(&self) -> f64 {
        let modulus = self.material.youngs_modulus_pa;
        // a brittle food opens before the blade and does not grip it
        if modulus < STIFF_FOOD_PA || self.brittle() {
            return 0.0;
        }
        plane_strain(modulus) * self.edge.thickness_m / (2.0 * self.grid.height())
    }

    fn walls(&self, dt: f64) -> Walls {
        Walls {
            modulus: self.material.youngs_modulus_pa,
            yield_stress: self.material.yield_stress_pa,
            freedom: self.config.blade_freedom_m,
            largest_stiffness: STIFFNESS_SHARE * self.config.effective_mass_kg / (dt * dt),
        }
    }

    /// Adds one step to the energies; work is taken with the mean of the forces before and after.
    fn keep_books(
        &mut self,
        motion: &EdgeMotion,
        edge: &EdgeSums,
        [along, friction]: [&PlanarWrench; 2],
        wrench: &PlanarWrench,
        dt: f64,
    ) {
        let stored =
            self.elements.iter().map(|element| &element.giving).chain(&self.flanks).map(Giving::stored_j).sum();
        let newly_stored = stored - std::mem::replace(&mut self.stored_along_j, stored);
        self.energy.work_j -= 0.5 * (wrench.power(motion) + self.previous.power(motion)) * dt;
        self.energy.friction_j -= friction.power(motion) * dt + newly_stored;
        // what a free food gives way by along the edge is lost but for what its springs store
        self.energy.friction_j += if self.begun { edge.giving * dt } else { -along.power(motion) * dt };
        self.energy.fracture_j += edge.fracture;
        self.energy.elastic_j = edge.elastic + stored;
        self.previous = *wrench;
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

    fn report(
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

/// Accessors.
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
    pub(super) fn best_plane(&self) -> Option<Vector3<f64>> {
        self.surface.best_plane(&self.grid)
    }

    /// Depth and deviation of the surface that was cut so far, in bands; see [`Surface::bands`].
    pub(super) fn bands(&self, along: f64, bands: usize) -> Vec<Point2<f64>> {
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

fn sum(wrenches: [PlanarWrench; 3]) -> PlanarWrench {
    wrenches.iter().fold(PlanarWrench::default(), |total, wrench| PlanarWrench {
        force: total.force + wrench.force,
        moment: total.moment + wrench.moment,
    })
}
