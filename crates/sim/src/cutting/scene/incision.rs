//! One cut of one piece: the section that is frozen in the piece, the law that acts in it, and what is told of it.

use nalgebra::{Isometry3, Point2, Point3, UnitQuaternion, Vector3};

use super::edge_grip::{EdgeGrip, GripLimits};
use super::knife_motion::KnifeMotion;
use super::piece::{Lie, Piece};
use super::record::CutRecord;
use super::section_frame::{board_line, came_through_the_top, section_frame};
use super::setup::CuttingSetup;
use super::tally::Tally;
use crate::SimError;
use crate::cutting::geometry::{MassProperties, Section, polygon};
use crate::cutting::knife::Edge;
use crate::cutting::mechanics::{Cut, CutStep, CuttingConfig, EdgeMotion, Failure, FailureMonitor, Observation, Stage};

/// Sections of less area are grazed, not cut, m².
const SMALLEST_SECTION_M2: f64 = 1e-6;
/// Parts of a section of less area are left out, m².
const SMALLEST_PART_M2: f64 = 1e-9;
/// A blade this near to an old cut follows it, m and rad.
const SAME_CUT_M: f64 = 2e-3;
const SAME_CUT_RAD: f64 = 0.1;
/// A blade this near to a wanted cut makes it, m.
const WANTED_M: f64 = 0.010;
/// A knife whose reference is this far ahead is driven, m.
const AHEAD_M: f64 = 1e-3;

/// What the food does to the knife in one step, world axes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Exchange {
    /// Force, N.
    pub force: Vector3<f64>,
    /// Moment about the heel of the edge, N m.
    pub moment: Vector3<f64>,
}

/// What curves show of a cut.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shown {
    pub depth_m: f64,
    pub slice_push_ratio: f64,
    pub lateral_m: f64,
}

/// A cut of a piece.
pub(super) struct Incision {
    pub planned: Option<usize>,
    pub shown: Shown,
    food_from_section: Isometry3<f64>,
    world_from_section: Isometry3<f64>,
    cut: Cut,
    monitor: FailureMonitor,
    grip: EdgeGrip,
    /// The piece that is cut, in the food's frame.
    mass: MassProperties,
    /// Where the edge pressed in the last step.
    pressed_in_knife: Vector3<f64>,
    tally: Tally,
    begun_s: f64,
    /// Where the piece lay at the first touch.
    center: Point3<f64>,
    turn: UnitQuaternion<f64>,
    /// How far it moved since, m and rad.
    pub slip_m: f64,
    pub roll_rad: f64,
}

/// Why a touch began no cut.
pub(super) enum Refused {
    /// The blade hardly grazes the piece.
    Grazed,
    /// The edge is in the piece without having come through its top.
    FromTheSide,
}

impl Incision {
    /// Freezes the blade's plane in the piece and begins a cut of that section; `mass_kg` is what the arm shows at the edge.
    pub fn begin(
        setup: &CuttingSetup,
        piece: &Piece,
        knife: &KnifeMotion,
        mass_kg: f64,
        time_s: f64,
    ) -> Result<Result<Self, Refused>, SimError> {
        let world_from_section = section_frame(&knife.world_from_knife, &setup.board);
        let food_from_section = piece.lie.world_from_food.inv_mul(&world_from_section);
        let mut section = piece.solid.section(&food_from_section);
        section.polygons.retain(|outline| polygon::area(outline) > SMALLEST_PART_M2);
        if section.area_m2() < SMALLEST_SECTION_M2 {
            return Ok(Err(Refused::Grazed));
        }
        let edge = &setup.knife.edge;
        let section_from_knife = world_from_section.inv_mul(&knife.world_from_knife);
        if !came_through_the_top(&section, &section_from_knife, edge) {
            return Ok(Err(Refused::FromTheSide));
        }
        let board = board_line(&world_from_section, &setup.board);
        let shown_kg = shown_kg(piece, &section, &food_from_section);
        let config = CuttingConfig { effective_mass_kg: mass_kg, free_food_kg: Some(shown_kg), ..setup.config.clone() };
        let planned = nearest(&setup.planned, &world_from_section, &section);
        Ok(Ok(Self {
            planned,
            shown: Shown::default(),
            food_from_section,
            world_from_section,
            cut: Cut::new(&section.polygons, &setup.food.material, edge, board, &config)?,
            monitor: FailureMonitor::new(setup.thresholds.clone())?,
            grip: EdgeGrip::default(),
            mass: piece.mass,
            pressed_in_knife: knife_middle(edge),
            tally: Tally::default(),
            begun_s: time_s,
            center: piece.lie.center,
            turn: piece.lie.world_from_food.rotation,
            slip_m: 0.0,
            roll_rad: 0.0,
        }))
    }

    /// Is the knife in the plane of this cut?
    pub fn fits(&self, lie: &Lie, knife: &KnifeMotion) -> bool {
        let section_from_tool =
            (lie.world_from_food * self.food_from_section).inverse_transform_point(&knife.tool_in_world);
        let normal = lie.world_from_food * (self.food_from_section * Vector3::z());
        let blade = knife.world_from_knife * Vector3::z();
        section_from_tool.z.abs() < SAME_CUT_M && blade.angle(&normal) < SAME_CUT_RAD
    }

    /// The knife comes back into this cut.
    pub fn resume(&mut self, lie: &Lie) {
        self.tally.resume();
        (self.center, self.turn) = (lie.center, lie.world_from_food.rotation);
    }

    /// Lets the law act for one step. Allocates nothing.
    pub fn step(
        &mut self,
        setup: &CuttingSetup,
        lie: &Lie,
        knife: &KnifeMotion,
        dt: f64,
    ) -> Result<Exchange, SimError> {
        let world_from_section = lie.world_from_food * self.food_from_section;
        let into_section = world_from_section.rotation.inverse();
        let sliding = into_section * (knife.heel_velocity - lie.velocity_at(&knife.heel()));
        let turning = into_section * (knife.angular_velocity - lie.angular_velocity);
        let section_from_knife = world_from_section.inv_mul(&knife.world_from_knife);
        let along = section_from_knife.rotation * Vector3::x();
        let from_heel = section_from_knife.rotation * self.pressed_in_knife;
        let slide = along.dot(&(sliding + turning.cross(&from_heel)));
        let Some(motion) = EdgeMotion::from_pose(&section_from_knife, sliding, turning) else {
            return Ok(Exchange::default());
        };
        let step = self.cut.step(&motion, dt)?;
        self.pressed_in_knife = pressed_point(&section_from_knife, &step, &setup.knife.edge);
        let (mut force, mut moment) = (step.force_in_section, step.moment_in_section);
        let from_heel = section_from_knife.rotation * self.pressed_in_knife;
        let pressed_in_food = self.food_from_section * section_from_knife * Point3::from(self.pressed_in_knife);
        let across = self.food_from_section * Vector3::z();
        let shown_kg = self.mass.shown_along(&pressed_in_food, &across);
        let side = self.hold_sideways(setup, shown_kg, &step, (sliding + turning.cross(&from_heel)).z, dt);
        force.z += side;
        moment += from_heel.cross(&Vector3::new(0.0, 0.0, side));
        self.tally.add(&step, force.norm(), slide, dt);
        self.watch(setup, &world_from_section, lie, knife, &step, dt);
        self.shown = Shown {
            depth_m: self.cut.depth_m(),
            slice_push_ratio: step.slice_push_ratio,
            lateral_m: (section_from_knife * Point3::from(knife_middle(&setup.knife.edge))).z,
        };
        let turn = world_from_section.rotation;
        Ok(Exchange { force: turn * force, moment: turn * moment })
    }

    /// Friction across the edge where it presses.
    fn hold_sideways(&mut self, setup: &CuttingSetup, shown_kg: f64, step: &CutStep, speed: f64, dt: f64) -> f64 {
        if step.width_m <= 0.0 {
            self.grip.release();
            return 0.0;
        }
        let limits = GripLimits {
            stiffness_n_per_m: setup.food.material.indentation_stiffness_pa * step.width_m,
            friction_n: setup.knife.edge.friction * step.force_in_section.xy().norm(),
            mass_kg: shown_kg,
        };
        self.grip.hold(speed, &limits, dt)
    }

    /// Looks for failures.
    fn watch(
        &mut self,
        setup: &CuttingSetup,
        world_from_section: &Isometry3<f64>,
        lie: &Lie,
        knife: &KnifeMotion,
        step: &CutStep,
        dt: f64,
    ) {
        let cutting = world_from_section.rotation * Vector3::y();
        let ahead = cutting.dot(&(knife.wanted_heel - knife.heel()));
        let turned = (lie.world_from_food.rotation * self.turn.inverse()).scaled_axis();
        let (slip, roll) = (self.slid(setup, lie, &turned), turned.norm());
        (self.slip_m, self.roll_rad) = (self.slip_m.max(slip), self.roll_rad.max(roll));
        let seen = Observation {
            driven: ahead > AHEAD_M || cutting.dot(&knife.wanted_velocity) > 0.0,
            advance_m_per_s: step.advance_m_per_s,
            food_translation_m: slip,
            food_rotation_rad: roll,
            board_force_n: 0.0,
            pieces: 1,
        };
        self.monitor.observe(&self.cut, &seen, dt);
    }

    /// How far the piece slid over the board since it was touched, m: without the way that it rolled.
    fn slid(&self, setup: &CuttingSetup, lie: &Lie, turned: &Vector3<f64>) -> f64 {
        let up = setup.board.up_in_world().into_inner();
        let height = up.dot(&(lie.center - setup.board.top_in_world()));
        let way = lie.center - self.center - turned.cross(&(up * height));
        (way - up * up.dot(&way)).norm()
    }

    /// The first failure so far.
    pub fn failure(&self) -> Option<&Failure> {
        self.monitor.failure()
    }

    /// Has the knife left the cut, or never entered?
    pub fn is_left(&self) -> bool {
        matches!(self.cut.stage(), Stage::Approaching | Stage::Withdrawn)
    }

    /// Is the piece to come apart?
    pub fn is_through(&self) -> bool {
        matches!(self.cut.stage(), Stage::Separated | Stage::Fractured)
    }

    /// Mean deviation Ra of what is cut so far, m. Allocates nothing.
    pub fn mean_deviation_m(&self) -> f64 {
        self.cut.mean_deviation_m()
    }

    /// The parts of `piece` beside the cut.
    pub fn divide(&self, piece: &Piece) -> Result<Vec<crate::cutting::geometry::Solid>, SimError> {
        let surface = self.cut.cut_surface(&self.food_from_section);
        let surface = surface.map_err(|error| SimError::Cutting { reason: error.to_string() })?;
        Ok(piece.solid.split_along(&surface).into_iter().map(|part| part.solid).collect())
    }

    /// What is told of the cut when it made `pieces` at `separated_s`, or is left.
    pub fn record(&self, pieces: usize, separated_s: Option<f64>) -> CutRecord {
        CutRecord {
            planned: self.planned,
            begun_s: self.begun_s,
            separated_s,
            world_from_section: self.world_from_section,
            pieces,
            quality: self.cut.quality(),
            energy: self.cut.energy(),
            force_peak_n: self.tally.force_peak_n,
            force_mean_n: self.tally.force_mean_n(),
            section_area_m2: self.cut.section_area_m2(),
            cut_area_m2: self.cut.cut_area_m2(),
            slice_push_ratio_mean: self.tally.slice_push_ratio(),
            strokes: self.tally.strokes,
            pressing_s: self.tally.pressing_s,
        }
    }
}

/// Least mass that a piece shows at the corners of its section, and so anywhere in it, kg.
fn shown_kg(piece: &Piece, section: &Section, food_from_section: &Isometry3<f64>) -> f64 {
    let corners = section.polygons.iter().flatten();
    let shown = corners.map(|corner| piece.mass.shown_at(&(food_from_section * Point3::new(corner.x, corner.y, 0.0))));
    shown.fold(piece.mass.mass_kg, f64::min)
}

/// Middle of the edge in the knife's frame.
fn knife_middle(edge: &Edge) -> Vector3<f64> {
    Vector3::new(0.5 * edge.length_m(), 0.0, 0.0)
}

/// Where the edge presses, in the knife's frame: the point of the edge on the line of action of the force.
fn pressed_point(section_from_knife: &Isometry3<f64>, step: &CutStep, edge: &Edge) -> Vector3<f64> {
    let force = section_from_knife.rotation.inverse_transform_vector(&step.force_in_section);
    if force.y >= 0.0 {
        return knife_middle(edge);
    }
    let x = (step.moment_in_section.z / force.y).clamp(0.0, edge.length_m());
    Vector3::new(x, height_at(edge, x), 0.0)
}

/// y of the edge at `x`, knife's frame.
fn height_at(edge: &Edge, x: f64) -> f64 {
    let on = |pair: &&[Point2<f64>]| x <= pair[1].x;
    let pair = edge.points.windows(2).find(on);
    pair.map_or(0.0, |pair| pair[0].y + (pair[1].y - pair[0].y) * (x - pair[0].x) / (pair[1].x - pair[0].x))
}

/// The wanted cut whose plane is nearest to the middle of a section.
fn nearest(planned: &[Isometry3<f64>], world_from_section: &Isometry3<f64>, section: &Section) -> Option<usize> {
    let (low, high) = section.bounds()?;
    let middle = world_from_section * Point3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), 0.0);
    let distance = |wanted: &Isometry3<f64>| wanted.inverse_transform_point(&middle).z.abs();
    let near = planned.iter().enumerate().map(|(index, wanted)| (index, distance(wanted)));
    near.filter(|(_, away)| *away < WANTED_M).min_by(|one, other| one.1.total_cmp(&other.1)).map(|(index, _)| index)
}
