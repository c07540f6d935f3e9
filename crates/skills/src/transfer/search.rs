//! Exact search for the phases of a push: which surface, which place on it, from where to where.
//!
//! States are (cell of the object's center, hold); a push leads one step along the hold's direction, a change of surface
//! stays on the spot. The best-first search is exact for its cost: the bound on what is to come never exceeds it.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use nalgebra::{Point2, Vector2};

use super::barring::{Barring, Bars};
use super::bound::CostToGo;
use super::cells::{Barred, Cells};
use super::config::SearchConfig;
use super::grid::{Grid, MOST_STATES};
use super::holds::{Hold, holds};
use super::phases::{Phase, PhaseState, Phases, settled};
use super::workplace::Workplace;
use crate::field::FieldError;

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
    goal_world: Point2<f64>,
    goal: [i32; 2],
    goal_tolerance_m: f64,
    bars: Bars,
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
        let grid = Grid::new(workplace, config.cell_m, start, goal)?;
        let world = Cells::new(workplace, grid, reference);
        let mut holds = holds(workplace, config.places, &world.grid);
        // another part of the tool may be where the object is
        holds.retain(|hold| world.gap_m(hold) >= -DEEPEST_M);
        let states = world.grid.len().saturating_mul(holds.len());
        if states > MOST_STATES {
            let found = format!("{} m, which makes {} cells of {} holds", config.cell_m, world.grid.len(), holds.len());
            return Err(FieldError::new("cell_m", found, format!("at most {MOST_STATES} of both together")));
        }
        let mut directions: Vec<Vector2<f64>> = Vec::new();
        let headings = holds.iter().map(|hold| heading(&mut directions, &hold.direction)).collect();
        // a lattice of oblique steps does not pass through every cell
        let oblique = holds.iter().filter(|hold| hold.step[0] != 0 && hold.step[1] != 0);
        let goal_tolerance_m = oblique.map(|hold| world.grid.way(hold.step).norm()).fold(0.0, f64::max);
        let bound = CostToGo::new(directions, config.switch_cost_m, goal_tolerance_m);
        let goal_world = goal;
        let goal = world.grid.nearest_cell(&goal);
        let bars = Bars::default();
        Ok(Self { workplace, config, world, holds, headings, bound, goal_world, goal, goal_tolerance_m, bars })
    }

    /// The holds that are searched over.
    #[must_use]
    pub fn holds(&self) -> &[Hold] {
        &self.holds
    }

    /// What bars the object from `place`, if anything does.
    pub(super) fn barred(&self, place: &Point2<f64>) -> Option<Barred> {
        self.world.barred(self.workplace, place)
    }

    /// Whether the goal is in the cell of the start.
    pub(super) fn is_at_goal(&self) -> bool {
        self.goal == [0, 0]
    }

    /// Whether pushes in the directions of the holds add up to the way, whatever stands in it.
    pub(super) fn directions_lead_there(&self) -> bool {
        let way = self.world.grid.way(self.goal);
        self.headings.iter().any(|heading| self.bound.at(&way, *heading).is_finite())
    }

    /// Gives up a part of `phases`, which this search found, because no way of the tool was found there.
    pub fn bar(&mut self, phases: &Phases, barring: Barring) {
        let states = &phases.states;
        // a search may come to a hold by another one on the spot, which is then the change that it took
        let changes = |index: usize| match states.get(index..).unwrap_or_default() {
            [before, after, ..] if before.hold == after.by => vec![[before.hold, after.hold]],
            [before, after, ..] => vec![[before.hold, after.hold], [after.by, after.hold]],
            _ => Vec::new(),
        };
        match barring {
            Barring::Start => states.first().into_iter().for_each(|state| self.bars.bar_start(state.hold)),
            Barring::End => states.last().into_iter().for_each(|state| self.bars.bar_end(state.hold)),
            Barring::Change(index) => {
                for pair in changes(index) {
                    self.bars.bar_change(pair);
                }
            }
            Barring::ChangeNearby(index) => {
                let cell = states.get(index).map_or([0, 0], |before| before.end);
                for pair in changes(index) {
                    let surfaces = pair.map(|hold| self.holds.get(hold).map_or(usize::MAX, |hold| hold.surface));
                    self.bars.bar_nearby(surfaces, cell);
                }
            }
        }
    }

    /// Finds the phases of least cost; nothing if there are none.
    pub fn solve(&mut self) -> Option<Phases> {
        if self.is_at_goal() {
            return None;
        }
        let mut open = BinaryHeap::new();
        let mut costs = vec![f64::INFINITY; self.world.grid.len() * self.holds.len()];
        let mut before = vec![u32::MAX; costs.len()];
        for hold in 0..self.holds.len() {
            if self.is_start([0, 0], hold) {
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
            if self.is_near_goal(cell)
                && self.bars.allows_end(hold)
                && let Some(found) = self.phases(&before, state, cost, expanded)
            {
                return Some(found);
            }
            if let Some((next, length_m)) = self.pushed(cell, hold) {
                let dearer = 1.0 + self.config.deviation_per_m2 * self.world.squared_deviation(next);
                self.offer(&mut open, &mut costs, &mut before, (next, hold), cost + length_m * dearer, state);
            }
            for other in 0..self.holds.len() {
                let Some(cost) = self.switch_cost(cell, hold, other).map(|switch| cost + switch) else { continue };
                // what is no gain need not be possible
                let is_gain = self.state(cell, other).is_some_and(|state| cost < costs[state as usize]);
                if is_gain && self.is_held(cell, other) {
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
        let left = self.world.grid.way([self.goal[0] - cell[0], self.goal[1] - cell[1]]);
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
        Some((next, self.world.grid.way(step).norm()))
    }

    /// What a change of hold costs, m, if the surfaces differ and it is not barred.
    fn switch_cost(&self, cell: [i32; 2], from: usize, to: usize) -> Option<f64> {
        let (a, b) = (&self.holds[from], &self.holds[to]);
        if a.surface == b.surface || !self.bars.allows_change([from, to], [a.surface, b.surface], cell) {
            return None;
        }
        let round = (a.center_from_tool.translation.vector - b.center_from_tool.translation.vector).norm();
        Some(self.config.switch_cost_m + self.config.off_center * b.place_m.abs() + self.config.flip * round)
    }

    /// Whether the way may begin with a hold.
    fn is_start(&mut self, cell: [i32; 2], hold: usize) -> bool {
        self.bars.allows_start(hold) && self.world.object_is_free(self.workplace, cell) && self.is_held(cell, hold)
    }

    fn is_near_goal(&self, cell: [i32; 2]) -> bool {
        cell == self.goal
            || self.world.grid.way([cell[0] - self.goal[0], cell[1] - self.goal[1]]).norm() <= self.goal_tolerance_m
    }

    /// Whether the tool may stand where it holds the object of a cell.
    fn is_held(&mut self, cell: [i32; 2], hold: usize) -> bool {
        self.world.tool_is_free(self.workplace, &self.holds, cell, hold)
    }

    fn state(&self, cell: [i32; 2], hold: usize) -> Option<u32> {
        Some((self.world.grid.index(cell)? * self.holds.len() + hold) as u32)
    }

    fn place(&self, state: u32) -> ([i32; 2], usize) {
        let holds = self.holds.len();
        (self.world.grid.cell(state as usize / holds), state as usize % holds)
    }

    /// The phases that lead to a state: runs of one hold that move the object, settled on the goal; nothing if they do not
    /// settle there, or not past the obstacles.
    fn phases(&self, before: &[u32], last: u32, cost_m: f64, expanded: usize) -> Option<Phases> {
        let mut trace = vec![last];
        while let Some(&state) = trace.last().filter(|state| before[**state as usize] != u32::MAX) {
            trace.push(before[state as usize]);
        }
        let places: Vec<_> = trace.iter().rev().map(|state| self.place(*state)).collect();
        let (mut lattice, mut states) = (Vec::new(), Vec::new());
        let mut by = places.first()?.1;
        for run in places.chunk_by(|a, b| a.1 == b.1) {
            let from = std::mem::replace(&mut by, run.first()?.1);
            let [first, .., last] = run else { continue };
            let (from_world, to_world) = (self.world.grid.center(first.0), self.world.grid.center(last.0));
            lattice.push(Phase { hold: self.holds[first.1].clone(), from_world, to_world });
            states.push(PhaseState { hold: first.1, by: from, end: last.0 });
        }
        let (phases, changed) = settled(lattice, &self.goal_world)?;
        let miss_m = (phases.last()?.to_world - self.goal_world).norm();
        let free =
            |phase: &Phase| self.world.is_push_free(self.workplace, &phase.hold, &phase.from_world, &phase.to_world);
        let met = miss_m <= self.world.grid.cell_m.norm() / 2.0 && (!changed || phases.iter().all(free));
        met.then_some(Phases { phases, cost_m, miss_m, expanded, states })
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
