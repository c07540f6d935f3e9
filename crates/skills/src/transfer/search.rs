//! Exact search for the phases of a push: which surface, which place on it, from where to where.
//!
//! States are (cell of the object's center, hold); a push leads one step along the hold's direction, a switch to another
//! surface on the spot. The best-first search is exact for its cost: the bound on what is to come never exceeds it.

use std::cmp::Ordering;
use std::collections::{BTreeSet, BinaryHeap};

use nalgebra::{Matrix2, Point2, Vector2};
use serde::{Deserialize, Serialize};

use super::bound::CostToGo;
use super::cells::Cells;
use super::holds::{Hold, holds, scaled};
use super::workplace::Workplace;
use crate::field::{FieldError, not_negative, positive, within};

/// Options of the search; costs are lengths, m.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SearchConfig {
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Places on each surface that may be held, 1 to 21.
    pub places: usize,
    /// Cost per length and squared distance from the reference path, 1/m².
    pub deviation_per_m2: f64,
    /// Cost of a change of surface, m.
    pub switch_cost_m: f64,
    /// Cost per distance of a hold from the middle of its surface.
    pub off_center: f64,
    /// Cost per distance that the tool goes round the object in a change of surface.
    pub flip: f64,
}

impl Default for SearchConfig {
    fn default() -> Self {
        Self { cell_m: 0.001, places: 5, deviation_per_m2: 1500.0, switch_cost_m: 0.06, off_center: 0.5, flip: 0.3 }
    }
}

impl SearchConfig {
    /// Checks every option.
    ///
    /// # Errors
    /// A [`FieldError`] with the field relative to this struct.
    pub fn validate(&self) -> Result<(), FieldError> {
        within("cell_m", self.cell_m, 1e-5, 1.0)?;
        if !(1..=21).contains(&self.places) {
            return Err(FieldError::new("places", self.places, "a whole number from 1 to 21"));
        }
        not_negative("deviation_per_m2", self.deviation_per_m2)?;
        positive("switch_cost_m", self.switch_cost_m)?;
        not_negative("off_center", self.off_center)?;
        not_negative("flip", self.flip)
    }
}

/// A run of pushes with one hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Phase {
    /// The hold.
    pub hold: Hold,
    /// Where the object's center begins, world frame.
    pub from_world: Point2<f64>,
    /// Where it ends, world frame.
    pub to_world: Point2<f64>,
}

/// Phases from start to goal.
#[derive(Debug, Clone, PartialEq)]
pub struct Phases {
    /// The phases in their order, at least one.
    pub phases: Vec<Phase>,
    /// Cost of the way, m.
    pub cost_m: f64,
    /// States that were looked at.
    pub expanded: usize,
}

impl Phases {
    /// Changes the lengths of the phases, by as little as possible, so that they end at `goal`.
    ///
    /// A search over oblique steps ends within a step of its goal only.
    pub(super) fn settle(&mut self, goal: &Point2<f64>) {
        let Some(last) = self.phases.last() else { return };
        let left = goal - last.to_world;
        let normal: Matrix2<f64> =
            self.phases.iter().map(|phase| phase.hold.direction * phase.hold.direction.transpose()).sum();
        // one direction alone cannot mend what is left beside it
        let Ok(inverse) = normal.pseudo_inverse(1e-9) else { return };
        let multiplier = inverse * left;
        let mut moved = Vector2::zeros();
        for phase in &mut self.phases {
            phase.from_world += moved;
            moved += phase.hold.direction * phase.hold.direction.dot(&multiplier);
            phase.to_world += moved;
        }
    }
}

/// A hold may press this far into the object, m: the rounding of the files.
const DEEPEST_M: f64 = 1e-4;

/// A search of one task; keeps what it learns of the world from call to call.
pub struct PhaseSearch<'a> {
    workplace: &'a Workplace<'a>,
    config: &'a SearchConfig,
    world: Cells,
    holds: Vec<Hold>,
    /// Index of each hold's direction in the bound.
    headings: Vec<usize>,
    bound: CostToGo,
    goal: [i32; 2],
    goal_tolerance_m: f64,
    /// A switch that turned out to be impossible: at a cell, between two holds.
    barred: BTreeSet<([i32; 2], usize, usize)>,
}

impl<'a> PhaseSearch<'a> {
    /// Prepares to bring the object's center from `start` to `goal`, near the path `reference` where that is cheap.
    ///
    /// # Errors
    /// A [`FieldError`] if an option or margin is out of its range or the map has too many cells for its size.
    pub fn new(
        workplace: &'a Workplace<'a>,
        config: &'a SearchConfig,
        reference: &'a [Point2<f64>],
        start: Point2<f64>,
        goal: Point2<f64>,
    ) -> Result<Self, FieldError> {
        config.validate()?;
        workplace.validate()?;
        let world = Cells::new(workplace, config.cell_m, reference, start, goal)?;
        let mut holds = holds(workplace, config.places, &world.cell_m);
        // another part of the tool may be where the object is
        holds.retain(|hold| world.gap_m(hold) >= -DEEPEST_M);
        let mut directions: Vec<Vector2<f64>> = Vec::new();
        let headings = holds.iter().map(|hold| heading(&mut directions, &hold.direction)).collect();
        // a lattice of oblique steps does not pass through every cell
        let oblique = holds.iter().filter(|hold| hold.step[0] != 0 && hold.step[1] != 0);
        let goal_tolerance_m = oblique.map(|hold| scaled(hold.step, &world.cell_m).norm()).fold(0.0, f64::max);
        let bound = CostToGo::new(directions, config.switch_cost_m, goal_tolerance_m);
        let goal = world.nearest_cell(&goal);
        Ok(Self { workplace, config, world, holds, headings, bound, goal, goal_tolerance_m, barred: BTreeSet::new() })
    }

    /// The holds that are searched over.
    #[must_use]
    pub fn holds(&self) -> &[Hold] {
        &self.holds
    }

    /// Distance of the object from the nearest obstacle, m, if it cannot be at `place`.
    pub(super) fn refused_place_m(&self, place: &Point2<f64>) -> Option<f64> {
        self.world.refused_place_m(self.workplace, place)
    }

    /// Whether pushes in the directions of the holds add up to the way, whatever stands in it.
    pub(super) fn directions_lead_there(&self) -> bool {
        let way = scaled(self.goal, &self.world.cell_m);
        self.headings.iter().any(|heading| self.bound.at(&way, *heading).is_finite())
    }

    /// Bars the switch after phase `index` of `phases`, because no way of the tool was found there.
    pub fn bar_switch(&mut self, phases: &Phases, index: usize) {
        let hold_of = |phase: &Phase| self.holds.iter().position(|hold| *hold == phase.hold);
        if let [before, after, ..] = phases.phases.get(index..).unwrap_or_default()
            && let (Some(from), Some(to)) = (hold_of(before), hold_of(after))
        {
            self.barred.insert((self.world.nearest_cell(&before.to_world), from, to));
        }
    }

    /// Finds the phases of least cost; nothing if there are none.
    pub fn solve(&mut self) -> Option<Phases> {
        let mut open = BinaryHeap::new();
        let mut costs = vec![f64::INFINITY; self.world.len() * self.holds.len()];
        let mut before = vec![u32::MAX; costs.len()];
        for hold in 0..self.holds.len() {
            if self.world.object_is_free(self.workplace, [0, 0]) && self.is_held([0, 0], hold) {
                let cost = self.config.off_center * self.holds[hold].place_m.abs();
                self.offer(&mut open, &mut costs, &mut before, ([0, 0], hold), cost, u32::MAX);
            }
        }
        let mut expanded = 0;
        while let Some(Open { cost, state, .. }) = open.pop() {
            let (cell, hold) = self.place(state);
            if cost > costs[state as usize] {
                continue;
            }
            expanded += 1;
            if scaled([cell[0] - self.goal[0], cell[1] - self.goal[1]], &self.world.cell_m).norm()
                <= self.goal_tolerance_m
            {
                return Some(Phases { phases: self.phases(&before, state), cost_m: cost, expanded });
            }
            if let Some((next, length_m)) = self.pushed(cell, hold) {
                let dearer = 1.0 + self.config.deviation_per_m2 * self.world.squared_deviation(next);
                self.offer(&mut open, &mut costs, &mut before, (next, hold), cost + length_m * dearer, state);
            }
            for other in 0..self.holds.len() {
                let Some(cost) = self.switch_cost(cell, hold, other).map(|switch| cost + switch) else { continue };
                // what is no gain need not be possible
                if self.is_gain(&costs, (cell, other), cost) && self.is_held(cell, other) {
                    self.offer(&mut open, &mut costs, &mut before, (cell, other), cost, state);
                }
            }
        }
        None
    }

    /// Takes down that a state can be had for `cost`, if that is less than before.
    fn offer(
        &self,
        open: &mut BinaryHeap<Open>,
        costs: &mut [f64],
        before: &mut [u32],
        (cell, hold): ([i32; 2], usize),
        cost: f64,
        from: u32,
    ) {
        let Some(state) = self.state(cell, hold) else { return };
        let left = scaled([self.goal[0] - cell[0], self.goal[1] - cell[1]], &self.world.cell_m);
        let total = cost + self.bound.at(&left, self.headings[hold]);
        if total.is_finite() && cost < costs[state as usize] {
            costs[state as usize] = cost;
            before[state as usize] = from;
            open.push(Open { total, cost, state });
        }
    }

    /// The cell to which one push with a hold leads, and its length, m, if nothing stands in the way.
    fn pushed(&mut self, cell: [i32; 2], hold: usize) -> Option<([i32; 2], f64)> {
        let step = self.holds[hold].step;
        let next = [cell[0] + step[0], cell[1] + step[1]];
        let free = self.world.object_is_free(self.workplace, next) && self.is_held(next, hold);
        if !free || !self.world.is_way_free(self.workplace, &self.holds[hold], cell) {
            return None;
        }
        Some((next, scaled(step, &self.world.cell_m).norm()))
    }

    /// Whether a state was not to be had for as little as `cost` before.
    fn is_gain(&self, costs: &[f64], (cell, hold): ([i32; 2], usize), cost: f64) -> bool {
        self.state(cell, hold).is_some_and(|state| cost < costs[state as usize])
    }

    /// What a change of hold costs, m, if the surfaces differ and it is not barred.
    fn switch_cost(&self, cell: [i32; 2], from: usize, to: usize) -> Option<f64> {
        let (a, b) = (&self.holds[from], &self.holds[to]);
        if a.surface == b.surface || self.barred.contains(&(cell, from, to)) {
            return None;
        }
        let round = (a.center_from_tool.translation.vector - b.center_from_tool.translation.vector).norm();
        Some(self.config.switch_cost_m + self.config.off_center * b.place_m.abs() + self.config.flip * round)
    }

    /// Whether the tool may stand where it holds the object of a cell.
    fn is_held(&mut self, cell: [i32; 2], hold: usize) -> bool {
        self.world.tool_is_free(self.workplace, &self.holds, cell, hold)
    }

    fn state(&self, cell: [i32; 2], hold: usize) -> Option<u32> {
        Some((self.world.index(cell)? * self.holds.len() + hold) as u32)
    }

    fn place(&self, state: u32) -> ([i32; 2], usize) {
        let holds = self.holds.len();
        (self.world.cell(state as usize / holds), state as usize % holds)
    }

    /// The phases that lead to a state: runs of one hold that move the object.
    fn phases(&self, before: &[u32], last: u32) -> Vec<Phase> {
        let mut states = vec![last];
        while let Some(&state) = states.last().filter(|state| before[**state as usize] != u32::MAX) {
            states.push(before[state as usize]);
        }
        let places: Vec<_> = states.iter().rev().map(|state| self.place(*state)).collect();
        let runs = places.chunk_by(|a, b| a.1 == b.1);
        let phase = |run: &[([i32; 2], usize)]| {
            let (first, last) = (run.first()?, run.last()?);
            let (from_world, to_world) = (self.world.center(first.0), self.world.center(last.0));
            let hold = self.holds[first.1].clone();
            (first.0 != last.0).then_some(Phase { hold, from_world, to_world })
        };
        runs.filter_map(phase).collect()
    }
}

/// Index of a direction among those known, to which it is added if it is new.
fn heading(directions: &mut Vec<Vector2<f64>>, direction: &Vector2<f64>) -> usize {
    let known = directions.iter().position(|other| (other - direction).norm() < 1e-9);
    known.unwrap_or_else(|| {
        directions.push(*direction);
        directions.len() - 1
    })
}

/// A state to be looked at: the one of least total cost first, of equal ones the one that has got farthest.
struct Open {
    total: f64,
    cost: f64,
    state: u32,
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_total = other.total.total_cmp(&self.total);
        by_total.then(self.cost.total_cmp(&other.cost)).then(other.state.cmp(&self.state))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}

#[cfg(test)]
#[path = "search_tests.rs"]
mod tests;
