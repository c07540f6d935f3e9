//! Cutting as a process of the engine: the law acts before each step, pieces come apart after it.

use nalgebra::{Isometry3, Point3, Vector3, Vector6};
use rapier3d::prelude::{ColliderHandle, SharedShape};

use super::board_force::BoardForce;
use super::drawings;
use super::held::knife_from_tool;
use super::incision::{Incision, Refused};
use super::knife_motion::{KnifeMotion, least_mass_kg};
use super::piece::{Lie, Piece};
use super::record::{CutRecord, CuttingRecord};
use super::setup::{BOARD_GROUPS, CuttingSetup, KNIFE_GROUPS};
use crate::SimError;
use crate::cutting::mechanics::Failure;
use crate::spatial::{
    BodyDrawing, Drawing, Event, EventLevel, News, Observer, Process, Series, SpatialWorld, Step, wrench_of,
};

/// Time between two looks at the roughness of a face, s.
const LOOK_S: f64 = 0.02;

/// A food on a board that is cut by the knife in the arm's hand.
pub struct CuttingProcess {
    setup: CuttingSetup,
    board: ColliderHandle,
    tool_from_knife: Isometry3<f64>,
    pieces: Vec<Piece>,
    /// Cuts that are over.
    records: Vec<CutRecord>,
    /// Pieces that were ever made, for their names.
    made: usize,
    failure: Option<Failure>,
    /// The first failure that ends the run.
    fatal: Option<String>,
    board_force: BoardForce,
    slip_m: f64,
    roll_rad: f64,
    /// Ra of the face that is being cut, or was cut last.
    roughness_m: f64,
    /// When that is looked at next, s.
    next_look_s: f64,
    tool_wrench: Vector6<f64>,
    wanted_heel: Option<Point3<f64>>,
    prepared: bool,
    news: News,
}

impl CuttingProcess {
    /// Puts board and food into `world`.
    ///
    /// # Errors
    /// A field error naming a number of the setup that cannot be used.
    pub fn insert(world: &mut SpatialWorld, setup: &CuttingSetup) -> Result<Self, SimError> {
        setup.validate()?;
        let [x, y, z] = setup.board.half_extents_m;
        let middle = setup.board.world_from_middle();
        let board = world.insert_fixed(SharedShape::cuboid(x, y, z), &middle, setup.board.friction);
        if let Some(collider) = world.physics.colliders.get_mut(board) {
            collider.set_collision_groups(BOARD_GROUPS);
        }
        let still = Lie {
            world_from_food: setup.world_from_food,
            velocity: Vector3::zeros(),
            angular_velocity: Vector3::zeros(),
            center: Point3::origin(),
        };
        let food = &setup.food;
        let whole = Piece::insert(world, food.name.clone(), food.solid.clone(), &food.material, &still, true);
        Ok(Self {
            tool_from_knife: knife_from_tool(&setup.knife).inverse(),
            setup: setup.clone(),
            board,
            pieces: vec![whole],
            records: Vec::new(),
            made: 0,
            failure: None,
            fatal: None,
            board_force: BoardForce::default(),
            slip_m: 0.0,
            roll_rad: 0.0,
            roughness_m: 0.0,
            next_look_s: 0.0,
            tool_wrench: Vector6::zeros(),
            wanted_heel: None,
            prepared: false,
            news: News::default(),
        })
    }

    /// Everything that happened so far. What was wanted and is not through counts as missed or not through, so ask for it at
    /// the end.
    #[must_use]
    pub fn record(&self) -> CuttingRecord {
        let open = self.pieces.iter().flat_map(|piece| &piece.incisions).map(|incision| incision.record(1, None));
        let mut cuts: Vec<CutRecord> = self.records.iter().cloned().chain(open).collect();
        cuts.sort_by(|one, other| one.begun_s.total_cmp(&other.begun_s));
        let failure = self.failure.clone().or_else(|| unfinished(&cuts, self.setup.planned.len()));
        CuttingRecord {
            cuts,
            pieces: self.pieces.iter().map(Piece::record).collect(),
            failure,
            food_slip_m: self.slip_m,
            food_roll_rad: self.roll_rad,
            board_force_peak_n: self.board_force.peak_n,
        }
    }

    /// The pieces as they are now, in the order of their poses: skin, in shades that tell neighbors apart, and cut faces in the
    /// color of the flesh.
    #[must_use]
    pub fn drawings(&self) -> Vec<BodyDrawing> {
        let drawing = |piece: &Piece| BodyDrawing {
            name: piece.name.clone(),
            drawings: vec![drawings::piece(&piece.solid, &self.setup.food.look, piece.shade)],
        };
        self.pieces.iter().map(drawing).collect()
    }

    /// The curves that the process adds, in the order of their values.
    #[must_use]
    pub fn series() -> Vec<Series> {
        drawings::series()
    }

    /// What never moves: the board, and where cuts are wanted.
    #[must_use]
    pub fn fixed(&self) -> Vec<Drawing> {
        let CuttingSetup { food, world_from_food, planned, board, .. } = &self.setup;
        let wanted = planned.iter().flat_map(|cut| drawings::wanted(&food.solid, world_from_food, cut));
        std::iter::once(drawings::board(board)).chain(wanted).collect()
    }

    /// Lets the edge enter pieces and old cuts, and leave them.
    fn touch(&mut self, step: &Step<'_>, knife: &KnifeMotion) -> Result<(), SimError> {
        for index in 0..self.pieces.len() {
            let piece = &mut self.pieces[index];
            let edge = &self.setup.knife.edge;
            let meets = piece.meets(&knife.world_from_knife, edge);
            piece.armed |= !meets && !piece.near(&knife.world_from_knife, edge);
            if let Some(active) = piece.active {
                if !meets && piece.incisions.get(active).is_none_or(Incision::is_left) {
                    piece.active = None;
                }
                continue;
            }
            if !(meets && piece.armed) {
                continue;
            }
            if let Some(old) = piece.incisions.iter().position(|old| old.fits(&piece.lie, knife)) {
                piece.incisions[old].resume(&piece.lie);
                piece.active = Some(old);
            } else {
                self.begin(index, step, knife)?;
            }
        }
        Ok(())
    }

    /// Begins a cut of a piece that the edge has just entered.
    fn begin(&mut self, index: usize, step: &Step<'_>, knife: &KnifeMotion) -> Result<(), SimError> {
        let mass = least_mass_kg(step.arm, step.world, &self.setup.knife.edge, &self.tool_from_knife)?;
        let piece = &mut self.pieces[index];
        let refused = match Incision::begin(&self.setup, piece, knife, mass, step.time_s)? {
            Ok(incision) => {
                let text = match incision.planned {
                    Some(wanted) => format!("the knife touches {} for cut {}", piece.name, wanted + 1),
                    None => format!("the knife touches {} away from all wanted cuts", piece.name),
                };
                self.news.event(Event { time_s: step.time_s, level: EventLevel::Info, text });
                piece.active = Some(piece.incisions.len());
                piece.incisions.push(incision);
                return Ok(());
            }
            Err(refused) => refused,
        };
        piece.armed = false;
        if matches!(refused, Refused::FromTheSide) {
            let text = format!("the blade came into {} from the side: it passes without force", piece.name);
            self.news.event(Event { time_s: step.time_s, level: EventLevel::Warning, text });
        }
        Ok(())
    }

    /// Forces of all cuts in which the knife is.
    fn act(&mut self, step: &mut Step<'_>, knife: &KnifeMotion) -> Result<(), SimError> {
        let heel = knife.heel();
        for piece in &mut self.pieces {
            let Some(incision) = piece.active.and_then(|active| piece.incisions.get_mut(active)) else { continue };
            let lie = piece.lie;
            let given = incision.step(&self.setup, &lie, knife, step.time_step_s)?;
            (self.slip_m, self.roll_rad) = (self.slip_m.max(incision.slip_m), self.roll_rad.max(incision.roll_rad));
            if let Some(failure) = incision.failure().filter(|_| self.failure.is_none()) {
                let time_s = step.time_s;
                self.news.event(Event { time_s, level: EventLevel::Error, text: failure.to_string() });
                self.fatal = Some(failure.to_string());
                self.failure = Some(failure.clone());
            }
            self.tool_wrench += wrench_of(&given.force, &heel, &knife.tool_in_world)
                + Vector6::new(0.0, 0.0, 0.0, given.moment.x, given.moment.y, given.moment.z);
            piece.push(step.world, &-given.force, &heel, &-given.moment);
        }
        Ok(())
    }

    /// Lets pieces come apart whose cut is through.
    fn separate(&mut self, world: &mut SpatialWorld) -> Result<(), SimError> {
        let mut index = 0;
        while index < self.pieces.len() {
            let piece = &self.pieces[index];
            let through = piece.active.and_then(|active| piece.incisions.get(active)).is_some_and(Incision::is_through);
            index += if through { self.divide(index, world)? } else { 1 };
        }
        Ok(())
    }

    /// Replaces a piece by its parts and returns their number.
    fn divide(&mut self, index: usize, world: &mut SpatialWorld) -> Result<usize, SimError> {
        let time_s = world.time_s();
        let piece = self.pieces.remove(index);
        let mut parts = Vec::new();
        for (number, incision) in piece.incisions.iter().enumerate() {
            if Some(number) != piece.active {
                self.records.push(incision.record(1, None));
                continue;
            }
            parts = incision.divide(&piece)?;
            let separated_s = (parts.len() > 1).then_some(time_s);
            self.records.push(incision.record(parts.len(), separated_s));
            self.shatter(parts.len(), time_s);
        }
        piece.remove(world);
        let count = parts.len();
        let text = match count {
            1 => format!("{} is cut through at one place and holds together at another", piece.name),
            _ => format!("{} came apart into {count} pieces", piece.name),
        };
        self.news.event(Event { time_s, level: EventLevel::Info, text });
        let shades = drawings::shades(piece.shade, self.pieces.get(index).map(|next| next.shade), count);
        for (offset, (solid, shade)) in parts.into_iter().zip(shades).enumerate() {
            self.made += 1;
            let name = format!("{} {}", self.setup.food.name, self.made);
            let mut part = Piece::insert(world, name, solid, &self.setup.food.material, &piece.lie, false);
            part.shade = shade;
            self.pieces.insert(index + offset, part);
        }
        self.news.bodies(self.drawings());
        Ok(count)
    }

    /// Notes a brittle food that broke into more pieces than it may.
    fn shatter(&mut self, pieces: usize, time_s: f64) {
        if pieces <= self.setup.thresholds.pieces || self.setup.food.material.brittle_depth_share.is_none() {
            return;
        }
        let failure = Failure::Shattered { pieces };
        self.news.event(Event { time_s, level: EventLevel::Error, text: failure.to_string() });
        self.fatal.get_or_insert_with(|| failure.to_string());
        self.failure.get_or_insert(failure);
    }

    /// Looks now and then at how rough the face is that is being cut, for the curves. Allocates nothing.
    fn look_at_faces(&mut self, time_s: f64) {
        if time_s < self.next_look_s {
            return;
        }
        self.next_look_s = time_s + LOOK_S;
        let mut active = self.pieces.iter().filter_map(|piece| piece.incisions.get(piece.active?));
        if let Some(incision) = active.rfind(|incision| incision.shown.depth_m > 0.0) {
            self.roughness_m = incision.mean_deviation_m();
        }
    }

    /// Reads the force on the board, and notes a blow.
    fn feel_board(&mut self, step: &Step<'_>) {
        self.board_force.read(step.world, step.arm.tool_colliders(), self.board);
        if self.failure.is_some() || self.board_force.now_n <= self.setup.thresholds.board_force_n {
            return;
        }
        let failure = Failure::BoardImpact { force_n: self.board_force.now_n };
        self.news.event(Event { time_s: step.time_s, level: EventLevel::Warning, text: failure.to_string() });
        self.failure = Some(failure);
    }
}

/// What a plan's end leaves undone: a wanted cut that was never touched, or is not through.
fn unfinished(cuts: &[CutRecord], planned: usize) -> Option<Failure> {
    (0..planned).find_map(|wanted| {
        let mut of_it = cuts.iter().filter(|cut| cut.planned == Some(wanted)).peekable();
        if of_it.peek().is_none() {
            return Some(Failure::Missed);
        }
        let open = of_it.clone().all(|cut| cut.separated_s.is_none());
        let least = of_it.map(CutRecord::ligament_share).fold(1.0, f64::min);
        open.then_some(Failure::NotThrough { ligament_share: least })
    })
}

impl Process for CuttingProcess {
    fn before_step(&mut self, step: &mut Step<'_>) -> Result<(), SimError> {
        if !self.prepared {
            for piece in step.arm.tool_colliders() {
                if let Some(collider) = step.world.physics.colliders.get_mut(*piece) {
                    collider.set_collision_groups(KNIFE_GROUPS);
                }
            }
            self.prepared = true;
        }
        let knife = KnifeMotion::read(step, &self.tool_from_knife, self.wanted_heel);
        self.wanted_heel = Some(knife.wanted_heel);
        self.tool_wrench = Vector6::zeros();
        self.pieces.iter().for_each(|piece| piece.relax(step.world));
        self.touch(step, &knife)?;
        self.act(step, &knife)?;
        step.arm.load_tool(step.world, &self.tool_wrench);
        Ok(())
    }

    fn after_step(&mut self, step: &mut Step<'_>) -> Result<(), SimError> {
        self.feel_board(step);
        self.look_at_faces(step.time_s);
        self.pieces.iter_mut().for_each(|piece| piece.refresh(step.world));
        if let Some(piece) = self.pieces.iter().find(|piece| !piece.lie.center.coords.norm().is_finite()) {
            let quantity = format!("the place of {} (m)", piece.name);
            return Err(SimError::Diverged { quantity, value: piece.lie.center.coords.norm(), time_s: step.time_s });
        }
        self.separate(step.world)
    }

    fn tool_wrench(&self) -> Vector6<f64> {
        self.tool_wrench
    }

    fn bodies(&self, _: &SpatialWorld, poses: &mut Vec<Isometry3<f64>>) {
        poses.extend(self.pieces.iter().map(|piece| piece.lie.world_from_food));
    }

    fn series(&self, values: &mut Vec<f64>) {
        let active = self.pieces.iter().filter_map(|piece| piece.incisions.get(piece.active?));
        let deepest = active.map(|incision| incision.shown).max_by(|one, other| one.depth_m.total_cmp(&other.depth_m));
        let shown = deepest.unwrap_or_default();
        let force = self.tool_wrench.fixed_rows::<3>(0).norm();
        values.extend([
            force,
            self.board_force.now_n,
            1e3 * shown.depth_m,
            shown.slice_push_ratio,
            1e3 * shown.lateral_m,
            1e6 * self.roughness_m,
        ]);
    }

    fn tell(&mut self, time_s: f64, observer: &mut dyn Observer) {
        self.news.tell(time_s, observer);
    }

    fn digest(&self, _: &SpatialWorld, digest: &mut blake3::Hasher) {
        for piece in &self.pieces {
            let pose = &piece.lie.world_from_food;
            for value in pose.translation.vector.iter().chain(pose.rotation.coords.iter()) {
                digest.update(&value.to_bits().to_le_bytes());
            }
        }
    }

    fn gives_up(&self) -> Option<String> {
        self.fatal.clone()
    }
}
