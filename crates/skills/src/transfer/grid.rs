//! The grid of a search: cells about the start, along the axes of the tool as it is held.
//!
//! The surfaces of most tools push along the tool's axes. On a grid that is turned with the tool such pushes lead from
//! cell to cell at any angle, and the goal is a cell of its own.

use nalgebra::{Point2, UnitComplex, Vector2};

use super::workplace::Workplace;
use crate::field::{FieldError, finite};

/// Most cells of a map, and most states: cells times holds. They are numbered in 32 bits and take 13 bytes each.
pub(super) const MOST_STATES: usize = 20_000_000;

/// A grid whose cell (0, 0) has its center at the start.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grid {
    start: Point2<f64>,
    /// Angle of the grid's axes in the world.
    pub(super) turn: UnitComplex<f64>,
    /// Sides of a cell, m, such that the goal is the center of a cell too.
    pub(super) cell_m: Vector2<f64>,
    first: [i32; 2],
    count: [usize; 2],
}

impl Grid {
    /// A grid over the map of `workplace` with cells of about `cell_m`.
    ///
    /// A goal that lies less than half a cell aside of the start is taken for straight ahead.
    pub(super) fn new(
        workplace: &Workplace<'_>,
        cell_m: f64,
        start: Point2<f64>,
        goal: Point2<f64>,
    ) -> Result<Self, FieldError> {
        finite("start_world", start.coords.as_slice())?;
        finite("goal_world", goal.coords.as_slice())?;
        let turn = UnitComplex::new(workplace.tool_angle_rad);
        let sides = (turn.inverse() * (goal - start)).map(|length: f64| match (length.abs() / cell_m).round() {
            0.0 => cell_m,
            cells => length.abs() / cells,
        });
        let [low, high] = [workplace.map_min, workplace.map_max];
        let corners = [low, Point2::new(high.x, low.y), high, Point2::new(low.x, high.y)]
            .map(|corner| (turn.inverse() * (corner - start)).component_div(&sides));
        let range = |axis: usize| {
            let low = corners.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min).ceil();
            let high = corners.iter().map(|corner| corner[axis]).fold(f64::NEG_INFINITY, f64::max).floor();
            (low, (high - low + 1.0).max(0.0))
        };
        let [(first_x, count_x), (first_y, count_y)] = [range(0), range(1)];
        let farthest = f64::from(i32::MAX / 4);
        let numbered = [first_x, first_y].iter().all(|first| first.abs() < farthest);
        if !numbered || count_x * count_y > MOST_STATES as f64 {
            let found = format!("{cell_m} m, which makes {count_x} by {count_y} cells");
            return Err(FieldError::new("cell_m", found, format!("at most {MOST_STATES} cells in the map")));
        }
        Ok(Self {
            start,
            turn,
            cell_m: sides,
            first: [first_x as i32, first_y as i32],
            count: [count_x as usize, count_y as usize],
        })
    }

    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.count[0] * self.count[1]
    }

    pub(super) fn index(&self, cell: [i32; 2]) -> Option<usize> {
        let column = usize::try_from(cell[0] - self.first[0]).ok().filter(|column| *column < self.count[0])?;
        let row = usize::try_from(cell[1] - self.first[1]).ok().filter(|row| *row < self.count[1])?;
        Some(row * self.count[0] + column)
    }

    /// The cell of an index below [`len`](Self::len).
    pub(super) fn cell(&self, index: usize) -> [i32; 2] {
        [self.first[0] + (index % self.count[0]) as i32, self.first[1] + (index / self.count[0]) as i32]
    }

    pub(super) fn center(&self, cell: [i32; 2]) -> Point2<f64> {
        self.start + self.way(cell)
    }

    /// A step of whole cells as a displacement in the world, m.
    pub(super) fn way(&self, step: [i32; 2]) -> Vector2<f64> {
        self.turn * Vector2::new(f64::from(step[0]) * self.cell_m.x, f64::from(step[1]) * self.cell_m.y)
    }

    pub(super) fn nearest_cell(&self, place: &Point2<f64>) -> [i32; 2] {
        let cells = (self.turn.inverse() * (place - self.start)).component_div(&self.cell_m);
        [cells.x.round() as i32, cells.y.round() as i32]
    }

    /// Half of the longer side of a cell, m: no place on the way to a neighbor is farther from both.
    pub(super) fn half_m(&self) -> f64 {
        self.cell_m.max() / 2.0
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    use super::super::fixtures::{DISC, ell, workplace};
    use super::*;

    #[test]
    fn a_map_with_too_many_cells_is_refused_with_their_number() {
        let tool = ell();
        let place = workplace(&tool, &DISC, &[]);
        let refused = Grid::new(&place, 1e-5, Point2::origin(), Point2::new(0.01, 0.02)).unwrap_err();
        assert_eq!(refused.field, "cell_m");
        assert!(refused.to_string().contains(" by 18000 cells; expected at most"), "{refused}");
        assert!(Grid::new(&place, 0.001, Point2::new(f64::NAN, 0.0), Point2::origin()).is_err());
        assert!(Grid::new(&place, 0.001, Point2::new(1e9, 0.0), Point2::origin()).is_err());
    }

    proptest! {
        #[test]
        fn start_and_goal_are_centers_of_cells_at_every_angle_of_the_tool(
            angle in -3.0f64..3.0, from in [-0.08f64..0.08, 0.01f64..0.17], to in [-0.08f64..0.08, 0.01f64..0.17],
        ) {
            let tool = ell();
            let place = Workplace { tool_angle_rad: angle, ..workplace(&tool, &DISC, &[]) };
            let (start, goal) = (Point2::from(from), Point2::from(to));
            let grid = Grid::new(&place, 0.001, start, goal).unwrap();
            assert_relative_eq!(grid.center([0, 0]), start);
            let cell = grid.nearest_cell(&goal);
            let left = UnitComplex::new(-angle) * (grid.center(cell) - goal);
            // what is less than half a cell aside is left
            prop_assert!((0..2).all(|axis| left[axis].abs() < 1e-12 || cell[axis] == 0 && left[axis].abs() <= 0.0005));
            let index = grid.index(cell).unwrap();
            prop_assert_eq!(grid.cell(index), cell);
        }
    }
}
